"""Describe the gas in each end of the cylinders: work, volumetric efficiency and capacity."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

from ..engine.engine import CylinderNumber, Engine
from ..engine.gas import EngineGas


@dataclass(frozen=True, kw_only=True)
class End:
    """Gas in one end of a cylinder.

    Attributes:
        cylinder: Number of the cylinder.
        end: "head" (away from the crank) or "crank".
        swept_volume_m3: Swept volume of this end.
        volumetric_efficiency: Volume drawn in over swept volume; left out unless the end has a
            compressor cycle.
        capacity_m3_per_s: Volume drawn in per second, at the state of the suction; left out unless
            the end has a compressor cycle.
        imep_Pa: Work of the gas on the piston in a cycle of this end over its swept volume;
            negative where the gas takes work.
        power_W: Power of the gas of this end; negative where the gas takes power.
    """

    cylinder: CylinderNumber
    end: Literal["head", "crank"]
    swept_volume_m3: float
    volumetric_efficiency: float | None = None
    capacity_m3_per_s: float | None = None
    imep_Pa: float
    power_W: float


def list_ends(engine: Engine, gas: EngineGas) -> tuple[End, ...] | None:
    """Return the ends of all cylinders by cylinder, head first; None if no cylinder has a crank end
    or a compressor cycle.
    """
    if not gas.has_pump_ends:
        return None
    rows = sorted(range(len(engine.numbers)), key=lambda row: engine.numbers[row])
    return tuple(end for row in rows for end in _describe_ends(engine, gas, row))


def _describe_ends(engine: Engine, gas: EngineGas, row: int) -> Iterator[End]:
    cylinder = gas.cylinders[row]
    turns_per_second = float(engine.speed_rpm) / 60
    for end in cylinder.torque.ends:
        work = cylinder.share * end.work
        efficiency = end.volumetric_efficiency
        capacity = None
        if efficiency is not None:
            capacity = efficiency * end.swept * turns_per_second
        yield End(
            cylinder=engine.numbers[row],
            end="head" if end.name == "head" else "crank",
            swept_volume_m3=end.swept,
            volumetric_efficiency=efficiency,
            capacity_m3_per_s=capacity,
            imep_Pa=work / end.swept,
            power_W=work * turns_per_second / end.turns,
        )

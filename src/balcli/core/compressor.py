"""Compute the pressure in one end of a compressor cylinder with ideal valves.

From the end of the discharge, at the dead centre where the volume V of the end is smallest:

    re-expansion   p = p_d (V_c / V)^ne             down to p_s
    suction        p = p_s                          to the other dead centre
    compression    p = p_s ((V_c + V_s) / V)^nc     up to p_d
    discharge      p = p_d                          to the end

V_s is the swept volume, V_c the clearance volume. The volumetric efficiency is `1 + c - c
(p_d/p_s)^(1/ne)` with `c = V_c / V_s` (API 618, and every textbook on compressors).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .cylinder_pressure import GasError, GasPiston
from .phasors import Array
from .piecewise import PiecewiseCurve, resolved


class Compression(NamedTuple):
    """Process in one end of a compressor cylinder.

    Attributes:
        suction: Pressure of the suction, Pa.
        discharge: Pressure of the discharge, Pa.
        clearance: Clearance volume over swept volume.
        compression_index: Index nc of the compression.
        expansion_index: Index ne of the re-expansion.
    """

    suction: float
    discharge: float
    clearance: float
    compression_index: float
    expansion_index: float

    @property
    def ratio(self) -> float:
        """Pressure ratio."""
        return self.discharge / self.suction

    @property
    def expanded(self) -> float:
        """Travel at the end of the re-expansion, as a share of the stroke."""
        return self.clearance * (self.ratio ** (1 / self.expansion_index) - 1)

    @property
    def compressed(self) -> float:
        """Travel left when the compression reaches the discharge, as a share of the stroke."""
        return (1 + self.clearance) * self.ratio ** (-1 / self.compression_index) - self.clearance

    @property
    def volumetric_efficiency(self) -> float:
        """Volume drawn in, at the pressure of the suction, over swept volume."""
        return 1 - self.expanded


def _check_valves(process: Compression) -> None:
    """Raise GasError if the clearance leaves no suction or no discharge."""
    ratio = process.ratio
    for name, left, index in (
        ("suction", process.volumetric_efficiency, process.expansion_index),
        ("discharge", process.compressed, process.compression_index),
    ):
        if left <= 0:
            most = 1 / (ratio ** (1 / index) - 1)
            raise GasError(
                "clearance",
                f"{process.clearance:g} leaves no {name} at a pressure ratio of {ratio:.4g}; it "
                f"has to be below {most:.4g}",
            )


def compress(piston: GasPiston, process: Compression, *, crank_end: bool) -> PiecewiseCurve:
    """Return the absolute pressure in one end over a revolution, Pa, by the angle from the outer
    dead centre, rad.

    Args:
        piston: Kinematics of the cylinder.
        process: Process in the end.
        crank_end: Whether the end is the one towards the crank.

    Raises:
        GasError: No suction or no discharge is left.
    """
    _check_valves(process)
    stroke = float(piston.stroke)
    expanded = process.expanded * stroke
    compressed = process.compressed * stroke
    if crank_end:
        start = piston.bottom
        turn = 2 * np.pi
        low = piston.angle_of(stroke - expanded, upward=True)
        high = turn + piston.angle_of(stroke - compressed)
    else:
        start = 0.0
        turn = piston.bottom
        low = piston.angle_of(expanded)
        high = piston.angle_of(compressed, upward=True)
    breaks = np.array([start, low, turn, high, start + 2 * np.pi])
    c = process.clearance

    def pressure(angle: Array) -> Array:
        share = piston.travel(angle) / stroke
        volume = c + (1 - share if crank_end else share)  # over the swept volume
        expansion = process.discharge * (c / volume) ** process.expansion_index
        compression = process.suction * ((1 + c) / volume) ** process.compression_index
        phases = [angle < low, angle < turn, angle < high]
        return np.select(phases, [expansion, process.suction, compression], process.discharge)

    return resolved(pressure, breaks)

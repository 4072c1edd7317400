"""Gas in an engine's cylinders: the torque over the cycle and the firing angle of each. The cycle
angle of a cylinder is 0 at the upper dead centre at which it fires. In a four-stroke engine, the
firing order tells in which of the two revolutions that is.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..core.cylinder_pressure import GasPiston, GasTorque
from ..core.phasors import Array
from ..errors import BalcliError


class CylinderGas(NamedTuple):
    """Gas of one cylinder.

    Attributes:
        piston: Mechanism, with the area of the bore.
        torque: Torque over the cycle angle, not yet multiplied by `share`.
        nominal_deg: Crank angle, in [0, 720) or [0, 360), at which the crank pin points along the
            axis of the cylinder when it fires.
        share: Factor of the gas force; 0 is a misfire.
        heat: Heat supplied in a computed cycle, J; None if the file gives none.
        like: Row of the first cylinder with an equal mechanism, diagram and heat. The two differ
            at most in `nominal_deg` and `share`.
    """

    piston: GasPiston
    torque: GasTorque
    nominal_deg: float
    share: float
    heat: float | None
    like: int

    @property
    def fires(self) -> float:
        """Crank angle of the firing dead centre, rad: cycle angle = crank angle - `fires`."""
        return math.radians(self.nominal_deg) + self.piston.top

    def find_pressure(self, angle: Array) -> Array:
        """Return the effective pressure at cycle angles (rad), Pa: the pressure under the piston
        plus `share` of the pressure difference.

        Raises:
            BalcliError: The file gives harmonics of the torque but no pressures.
        """
        if self.torque.pressure is None:
            raise BalcliError("the file has harmonics of the torque, and no pressures")
        under = self.torque.crankcase
        return under + self.share * (self.torque.pressure.at(angle) - under)


@dataclass(frozen=True, eq=False)
class EngineGas:
    """Gas of an engine.

    Attributes:
        cylinders: Gas of each row of `Engine.cylinders`.
        cycle_deg: Length of a cycle: 720, or 360 for a two-stroke engine.
        mechanical_efficiency: Brake work over indicated work; None if the file gives none.
        compression_ratio: Compression ratio; None if the file gives none.
        doubts: Warnings, each with its path in the file.
    """

    cylinders: tuple[CylinderGas, ...]
    cycle_deg: int
    mechanical_efficiency: float | None = None
    compression_ratio: float | None = None
    doubts: tuple[str, ...] = ()

    @property
    def cycle(self) -> float:
        """Length of a cycle, rad."""
        return math.radians(self.cycle_deg)

    @property
    def fires(self) -> Array:
        """Firing dead centre of each cylinder, rad, shape (cylinders,)."""
        return np.array([cylinder.fires for cylinder in self.cylinders])

    @property
    def shares(self) -> Array:
        """Factor of each cylinder's gas force, shape (cylinders,)."""
        return np.array([cylinder.share for cylinder in self.cylinders])

    def group_equal(self) -> list[tuple[GasTorque, list[int]]]:
        """Return each torque with the rows of the cylinders that have it."""
        rows: dict[int, list[int]] = {}
        for row, cylinder in enumerate(self.cylinders):
            rows.setdefault(cylinder.like, []).append(row)
        return [(self.cylinders[first].torque, own) for first, own in rows.items()]

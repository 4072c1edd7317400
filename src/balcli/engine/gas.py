"""Gas in an engine's cylinders: which torque it makes in each, and when each fires.

The cycle angle of a cylinder is 0 at the upper dead centre of its own mechanism next to which it
fires; which of the two revolutions of a four-stroke cycle that is, the firing order says.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ..core.cylinder_pressure import GasPiston, GasTorque
from ..core.phasors import Array
from ..errors import BalcliError


class CylinderGas(NamedTuple):
    """Gas of one cylinder.

    Attributes:
        piston: its mechanism, with the area of the bore.
        torque: by cycle angle, without the share.
        nominal_deg: crank angle, in [0, 720) or [0, 360), at which its crank pin stands along its
            axis when it fires.
        share: by which the gas force is multiplied; 0 is a misfire.
        heat: supplied in a computed cycle, J, where the file says so.
        like: row of the first cylinder with an equal mechanism, the same diagram and the same heat:
            what they have but for `nominal_deg` and `share` is equal.
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
        """Return the pressure that counts at cycle angles (rad), Pa: that under the piston, and the
        share of what is above it.

        Raises:
            BalcliError: The file has harmonics of the torque.
        """
        if self.torque.pressure is None:
            raise BalcliError("the file has harmonics of the torque, and no pressures")
        under = self.torque.crankcase
        return under + self.share * (self.torque.pressure.at(angle) - under)


@dataclass(frozen=True, eq=False)
class EngineGas:
    """Gas of an engine.

    Attributes:
        cylinders: one for each row of `Engine.cylinders`.
        cycle_deg: 720, or 360 of a two-stroke engine.
        mechanical_efficiency: brake over indicated work; None: not known.
        compression_ratio: None where the file does not say.
        doubts: what is suspicious of the file, in words, each by its path.
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
        """`CylinderGas.fires` of each, rad, shape (cylinders,)."""
        return np.array([cylinder.fires for cylinder in self.cylinders])

    @property
    def shares(self) -> Array:
        """`CylinderGas.share` of each, shape (cylinders,)."""
        return np.array([cylinder.share for cylinder in self.cylinders])

    def group_equal(self) -> list[tuple[GasTorque, list[int]]]:
        """Return each torque with the rows of the equal cylinders that have it."""
        rows: dict[int, list[int]] = {}
        for row, cylinder in enumerate(self.cylinders):
            rows.setdefault(cylinder.like, []).append(row)
        return [(self.cylinders[first].torque, own) for first, own in rows.items()]

    def without_share_of(self, row: int) -> EngineGas:
        """Return the gas of the engine where that of the cylinder in one row does nothing."""
        changed = list(self.cylinders)
        changed[row] = changed[row]._replace(share=0.0)
        return replace(self, cylinders=tuple(changed))

"""Describe the gas in an engine's cylinders: torque over the cycle and firing angle.

The cycle angle of a cylinder is 0 at the upper dead centre at which it fires. In a four-stroke
engine, the firing order determines in which of the two revolutions the cylinder fires.

The gas of several variants of an engine has curves with a figure (`core.piecewise`), which has the
shape of the variants; heat and compression ratio are then arrays of this shape.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..core.cylinder_pressure import GasEnd, GasPiston, GasTorque
from ..core.phasors import Array, Figure
from ..core.piecewise import PiecewiseCurve, polyline, resolved
from ..errors import BalcliError
from ..file.doubt import Doubt


class CylinderGas(NamedTuple):
    """Gas of one cylinder.

    Attributes:
        piston: Mechanism, with the area of the bore.
        torque: Torque over the cycle angle, not yet multiplied by `share`.
        nominal_deg: Crank angle, in [0, 720) or [0, 360), at which the crank pin points along the
            axis of the cylinder when it fires.
        share: Factor by which the gas force is multiplied; 0 is a misfire.
        heat: Heat supplied in a computed cycle, J; None if the file gives none.
        like: Row of the first cylinder with an equal mechanism, bore, diagram and heat. The gas of
            this cylinder differs from the gas of that row at most in `nominal_deg` and `share`.
        compresses: Whether the head end has a compressor cycle.
    """

    piston: GasPiston
    torque: GasTorque
    nominal_deg: float
    share: float
    heat: Figure | None
    like: int
    compresses: bool = False

    @property
    def fires(self) -> float:
        """Crank angle of the firing dead centre, rad: cycle angle = crank angle - `fires`."""
        return math.radians(self.nominal_deg) + self.piston.top

    def find_pressure(self, angle: Array) -> Array:
        """Return the effective pressure at cycle angles (rad), Pa: the pressure under the piston
        plus `share` times the pressure difference between the two sides of the piston.

        Raises:
            BalcliError: The file gives harmonics of the torque but no pressures.
        """
        if self.torque.pressure is None:
            raise BalcliError("the file has harmonics of the torque, and no pressures")
        return self._share_pressure(self.torque.pressure.at(angle))

    def find_end_pressure(self, end: GasEnd, angle: Array) -> Array:
        """Return the effective pressure in one end, Pa, as `find_pressure`."""
        return self._share_pressure(end.pressure.at(angle))

    def _share_pressure(self, pressure: Array) -> Array:
        under = self.torque.crankcase
        return under + self.share * (pressure - under)


@dataclass(frozen=True, eq=False)
class EngineGas:
    """Gas of an engine.

    Attributes:
        cylinders: Gas of each row of `Engine.cylinders`.
        cycle_deg: Length of a cycle: 720, or 360 for a two-stroke engine.
        mechanical_efficiency: Brake work over indicated work; None if the file gives none.
        compression_ratio: Compression ratio; None if the file gives none.
        doubts: Warnings of unlikely figures of the gas.
        law: Law for the gas at other speeds; None: the gas is the same at all speeds.
    """

    cylinders: tuple[CylinderGas, ...]
    cycle_deg: int
    mechanical_efficiency: float | None = None
    compression_ratio: Figure | None = None
    doubts: tuple[Doubt, ...] = ()
    law: GasLaw | None = None

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

    @property
    def has_pump_ends(self) -> bool:
        """Whether any cylinder has a crank end or a compressor cycle."""
        return any(each.compresses or each.torque.is_double_acting for each in self.cylinders)

    @property
    def swept(self) -> float:
        """Swept volume of all ends, m3."""
        return sum(end.swept for each in self.cylinders for end in each.torque.ends)

    @property
    def work(self) -> float:
        """Work of all cylinders in a cycle, J."""
        return sum(cylinder.share * cylinder.torque.work for cylinder in self.cylinders)

    def at(self, speed_rpm: float) -> EngineGas:
        """Return the gas at another speed; the cylinders keep their shares.

        Raises:
            InputError: No cycle can be computed at this speed.
        """
        if self.law is None:
            return self
        found = self.law.solve(speed_rpm).cylinders
        pairs = zip(found, self.cylinders, strict=True)
        return replace(self, cylinders=tuple(new._replace(share=own.share) for new, own in pairs))

    def follow(self, find: Callable[[EngineGas], ArrayLike]) -> Callable[[ArrayLike], Array]:
        """Return a function that computes a figure of the gas for an array of speeds (rpm). The
        array that it returns has the axes of the array of speeds, then the axes of the figure.

        Args:
            find: Function that returns the figure for the gas at one speed. The figure has to be
                linear in the pressures.
        """
        if (law := self.law) is None:
            figure = np.asarray(find(self))
            return lambda speeds_rpm: np.broadcast_to(figure, np.shape(speeds_rpm) + figure.shape)
        nodes = np.array(law.nodes_rpm) ** law.power

        def find_each(grown: Array) -> Array:
            speeds = grown.ravel() ** (1 / law.power)
            figures = np.array([find(self.at(speed)) for speed in speeds.tolist()])
            return figures.reshape(grown.shape + figures.shape[1:])

        @cache
        def find_curve() -> PiecewiseCurve:
            if law.linear:
                return polyline(nodes, find_each(nodes))
            return resolved(find_each, nodes, math.inf)

        def find_at_all(speeds_rpm: ArrayLike) -> Array:
            grown = np.asarray(speeds_rpm, float) ** law.power
            values = find_curve().within(grown)
            beyond = grown > nodes[-1]
            if law.power > 1 and beyond.any():
                values[beyond] = find_each(grown[beyond])
            return values

        return find_at_all

    @property
    def nodes_rpm(self) -> tuple[float, ...]:
        """Speeds (rpm) between which the gas is a smooth function of the speed; empty if the gas is
        the same at all speeds.
        """
        return () if self.law is None else self.law.nodes_rpm

    @property
    def variants(self) -> tuple[int, ...]:
        """Shape of the variants; empty for the gas of one engine."""
        return self.cylinders[0].torque.curve.figure

    def group_equal(self) -> list[tuple[GasTorque, list[int]]]:
        """Return each torque with the rows of the cylinders that have it."""
        rows: dict[int, list[int]] = {}
        for row, cylinder in enumerate(self.cylinders):
            rows.setdefault(cylinder.like, []).append(row)
        return [(self.cylinders[first].torque, own) for first, own in rows.items()]


@dataclass(frozen=True, eq=False)
class GasLaw:
    """Gas of an engine as a function of its speed, smooth between nodes. Outside the points of
    [[gas.at]], the gas of the first or last point is used.

    Attributes:
        solve: Function that returns the gas at a speed, rpm; InputError if no cycle can be
            computed.
        nodes_rpm: Rising speeds. For [[gas.at]]: speeds of its points. For the propeller law: 0,
            the speeds at which a cycle begins to burn or to reach `max_pressure`, the rated speed,
            and an overspeed.
        linear: Whether all pressures are linear in the speed between the nodes.
        power: Exponent p for which mean pressures are linear in speed^p between the nodes: 1 for
            [[gas.at]], 2 for the propeller law, which holds beyond the last node as well.
        least_rpm: Speed up to which the propeller law demands less imep than a cycle has without
            heat.
    """

    solve: Callable[[float], EngineGas]
    nodes_rpm: tuple[float, ...]
    linear: bool
    power: int = 1
    least_rpm: float = 0.0

    def list_doubts(self, speeds_rpm: ArrayLike) -> Iterator[Doubt]:
        """Yield warnings if some of these speeds (rpm) are outside the points of [[gas.at]], or if
        the propeller law demands less imep there than a cycle has without heat.
        """
        low = np.min(speeds_rpm)
        high = np.max(speeds_rpm)
        least = self.least_rpm
        first = self.nodes_rpm[0]
        last = self.nodes_rpm[-1]
        ends = []
        if low < first:
            ends.append(f"the gas of {first:g} rpm is used at {low:g} rpm")
        if high > last:
            ends.append(f"the gas of {last:g} rpm is used at {high:g} rpm")
        if ends and self.power == 1:
            yield Doubt("gas.at", f"outside its points {' and '.join(ends)}")
        if low < least:
            message = (
                f"up to {least:.4g} rpm it demands less imep than the cycle has without heat; the "
                "cycle without heat is used there"
            )
            yield Doubt("gas.law", message)

"""Gas on a piston: from the pressure over a cycle to torque, work and harmonics.

Angles are cycle angles in radians: 0 at the cylinder's own firing dead centre, a period of 4 pi
(four-stroke) or 2 pi (two-stroke). The dead centres are those of the mechanism: an offset or an
articulated one does not reach them at crank angles 0 and 180 degrees. With x the travel of the
piston from its upper dead centre, the gas does the work P dx, so that its torque is `P dx/dc`
whatever the mechanism (virtual work); of the piston pin's path s (docs/theory.md), x' = -s'.

Pressures are absolute. Where they come from is told by `pressure_diagram` (measured), `gas_cycle`
(computed) and `tangential_force` (harmonics of the torque itself, without a pressure).
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from . import strokes
from .cylinders import Cylinders
from .mechanisms import slidercrank
from .mechanisms.articulated import Articulated
from .mechanisms.linkage import Linkage
from .mechanisms.rotary import Rotary
from .phasors import Array, Complex
from .piecewise import Extreme, Function, PiecewiseCurve, merged_breaks, resolved

_SAME = 1e-8  # rad; a highest pressure so near to a corner is at the corner


class GasError(ValueError):
    """What cannot be computed, in a full sentence; `field` names the value that is to blame."""

    def __init__(self, field: str, message: str) -> None:
        self.field = field
        super().__init__(message)


# ---------------------------------------------------------------- the piston
@dataclass(frozen=True)
class GasPiston:
    """The mechanism of one cylinder, as the gas in it knows it.

    Attributes:
        area: of the bore, m2.
        stroke: between its dead centres, m.
        top: the mechanism's crank angle (0: pin along the axis) at its upper dead centre, rad.
        bottom: cycle angle of its lower dead centre, rad, in (0, 2 pi).
        travel: x, distance from the upper dead centre, m, at cycle angles.
        rate: dx/dc, m/rad.
    """

    area: float
    stroke: float
    top: float
    bottom: float
    travel: Function
    rate: Function

    @property
    def swept(self) -> float:
        """Swept volume, m3."""
        return self.area * self.stroke

    def clearance(self, compression_ratio: float) -> float:
        """Volume at the upper dead centre, m3."""
        return self.swept / (compression_ratio - 1)

    def volume(self, angle: ArrayLike, compression_ratio: float) -> Array:
        """Volume at cycle angles, m3, of their shape."""
        travel = self.travel(np.asarray(angle, float))
        return self.clearance(compression_ratio) + self.area * travel

    def angle_of(self, travel: float, *, upward: bool = False) -> float:
        """Cycle angle in [0, 2 pi] at which the piston has moved so far (m) down, or is so far down
        on its way up.
        """
        low, high = (self.bottom, 2 * np.pi) if upward else (0.0, self.bottom)
        for _ in range(7):
            grid = np.linspace(low, high, 257)
            down = np.maximum.accumulate((-1 if upward else 1) * self.travel(grid))
            after = int(np.searchsorted(down, -travel if upward else travel))
            low, high = grid[max(after - 1, 0)], grid[min(after, 256)]
        return float(high)


def pistons(cylinders: Cylinders, area: ArrayLike) -> list[GasPiston]:
    """The piston of every cylinder, for arrays without trailing axes; `area` of the bores, m2, one
    or one each.
    """
    c, linkage, radius = cylinders, _articulation(cylinders.linkage), float(cylinders.radius)
    areas, lam, eps = (np.broadcast_to(a, (c.count,)) for a in (area, c.lam, c.eps))
    on_crank = [linkage is None or linkage.master[row] == row for row in range(c.count)]
    travel = None if all(on_crank) else strokes.find_travel(c)
    found = []
    for row, plain in enumerate(on_crank):
        if plain or linkage is None or travel is None:
            found.append(_plain_piston(radius, lam[row], eps[row], areas[row]))
            continue
        pair = np.array([row, linkage.master[row]])
        own = replace(
            linkage,
            mass=np.zeros(1),
            master=np.array([1, 1]),
            knuckle=linkage.knuckle[pair],
            lead_deg=linkage.lead_deg[pair],
        )
        stroke, top, bottom = (float(values[row]) for values in travel)
        moves, rate = _slung(radius, own, lam[pair], eps[pair], math.radians(top))
        bottom = math.radians(bottom + 180 - top)
        found.append(GasPiston(float(areas[row]), stroke, math.radians(top), bottom, moves, rate))
    return found


def _articulation(linkage: Linkage | None) -> Articulated | None:
    """What moves the pistons along their axes where not all rods are on the crank pin; in rotary
    engines it is the same.
    """
    if isinstance(linkage, Rotary):
        return linkage.hung
    return linkage if isinstance(linkage, Articulated) else None


def _plain_piston(radius: float, lam: float, eps: float, area: float) -> GasPiston:
    top, bottom = math.asin(eps / (1 + lam)), math.pi + math.asin(eps / (1 - lam))
    return GasPiston(
        area=float(area),
        stroke=radius * float(slidercrank.displacement(bottom, lam, eps)),
        top=top,
        bottom=bottom - top,
        travel=_Plain(slidercrank.displacement, radius, lam, eps, top),
        rate=_Plain(slidercrank.velocity, radius, lam, eps, top),
    )


def _slung(
    radius: float, linkage: Articulated, lam: Array, eps: Array, top: float
) -> tuple[Function, Function]:
    """Travel and its rate of the piston in the first row of a linkage."""
    place = _Slung("place", radius, linkage, lam, eps, top)
    travel = replace(place, highest=-float(place(np.zeros(1))[0]))
    return travel, replace(place, name="velocity")


@dataclass(frozen=True)
class _Plain:
    """A function of the crank mechanism over the cycle angle, m; a class, which can be pickled."""

    of: Callable[[Array, float, float], Array]
    radius: float
    lam: float
    eps: float
    top: float

    def __call__(self, angle: Array) -> Array:
        return self.radius * self.of(angle + self.top, self.lam, self.eps)


@dataclass(frozen=True, eq=False)
class _Slung:
    """Place or velocity of the piston in the first row of a linkage, downward from the highest, m,
    over the cycle angle.
    """

    name: str
    radius: float
    linkage: Articulated
    lam: Array
    eps: Array
    top: float
    highest: float = 0.0

    def __call__(self, angle: Array) -> Array:
        moved = self.linkage.motion((angle + self.top).reshape(-1), self.lam, self.eps)
        values = getattr(moved, self.name)
        return np.asarray(self.highest - self.radius * values[0].reshape(angle.shape))


# ---------------------------------------------------------------- pressure and torque
class CycleCurve(ABC):
    """A figure of one cylinder over its cycle, smooth between breakpoints."""

    @property
    @abstractmethod
    def breaks(self) -> Array:
        """Cycle angles, rad, rising; the last a period after the first."""

    @abstractmethod
    def at(self, angle: ArrayLike, *, before: bool = False) -> Array:
        """The figure at any cycle angles (rad), of their shape; at a jump the value after it, or
        `before`.
        """

    @cached_property
    def curve(self) -> PiecewiseCurve:
        """The same as polynomials on panels."""
        return resolved(self.at, self.breaks)


class CylinderPressure(CycleCurve):
    """Absolute pressure, Pa."""

    def highest(self) -> Extreme:
        """The highest pressure, Pa, and the first cycle angle (rad, in [-period/2, period/2)) at
        which it is reached.
        """
        angle, period = self.curve.extremes()[1].angle, self.curve.period
        corner = float(self.breaks[np.argmin(np.abs(self.breaks - angle))])
        angle = corner if abs(corner - angle) < _SAME else angle
        value = max(float(self.at(angle)), float(self.at(angle, before=True)))
        return Extreme((angle + period / 2) % period - period / 2, value)


class GasTorque(CycleCurve):
    """Torque of the gas on the crankshaft, N m."""

    @property
    def work(self) -> float:
        """Work of one cycle, J; over the swept volume, the indicated mean effective pressure."""
        return self.curve.integral

    def harmonics(self, halves: ArrayLike) -> Complex:
        """Coefficients t_h, N m, of `Re sum t_h e^{i h c/2}` for whole numbers h, shape (orders,):
        h is twice the order, t_0 the mean torque. A two-stroke engine has even h alone.
        """
        half_orders = np.asarray(halves)
        every = round(4 * np.pi / self.curve.period)
        found = self.curve.harmonics(half_orders // every)
        return np.where(half_orders % every == 0, found, 0)


@dataclass(frozen=True)
class PressureOnPiston(GasTorque):
    """The gas of one cylinder, with its piston; `crankcase` is the pressure under it, Pa."""

    piston: GasPiston
    pressure: CylinderPressure
    crankcase: float = 1e5

    @property
    def breaks(self) -> Array:
        return self.pressure.breaks

    def force(self, angle: ArrayLike, *, before: bool = False) -> Array:
        """Gas force on the piston, N, towards the crankshaft, at any cycle angles (rad)."""
        return self.force_under(self.pressure.at(angle, before=before))

    def force_under(self, pressure: Array) -> Array:
        """The same under pressures in the cylinder (Pa)."""
        return self.piston.area * (pressure - self.crankcase)

    def at(self, angle: ArrayLike, *, before: bool = False) -> Array:
        angles = np.asarray(angle, float)
        return self.force(angles, before=before) * self.piston.rate(angles)

    @property
    def imep(self) -> float:
        """Indicated mean effective pressure, Pa, pumping included."""
        return self.work / self.piston.swept


def crank_torque(
    cylinders: Sequence[tuple[GasTorque, float, float]], period: float | None = None
) -> PiecewiseCurve:
    """Torque of several cylinders over one cycle, N m, at crank angles in [0, period].

    Args:
        cylinders: each with the crank angle (rad) of its firing dead centre and its share, by which
            its gas torque is multiplied.
        period: after which all of it repeats itself, rad; None: after a cycle.
    """
    span = cylinders[0][0].curve.period if period is None else period

    def total(angle: Array) -> Array:
        each = (share * gas.curve.at(angle - fires) for gas, fires, share in cylinders)
        return sum(each, np.zeros(angle.shape))

    return resolved(total, merged_breaks([(g.breaks, fires) for g, fires, _ in cylinders], span))

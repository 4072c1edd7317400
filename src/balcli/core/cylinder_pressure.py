"""Compute torque, work and harmonics of the gas in a cylinder from its pressure over the cycle.

Angles are cycle angles in radians. They are 0 at the cylinder's own firing dead centre, and a cycle
is 4 pi (four-stroke) or 2 pi (two-stroke). A piston with an offset or an articulated rod does not
reach its dead centres at crank angles of 0 and 180 degrees from the cylinder's axis.

With c the cycle angle, x the piston's travel from its upper dead centre, and P the gas force,
virtual work gives the torque `P dx/dc` for every mechanism; x' = -s', where s is the position of
the piston pin (docs/theory.md).

The pressures of several variants of a cylinder are a curve with a figure (`core.piecewise`), whose
axes the torque and its harmonics then have as well.

Pressures are absolute. They are measured (`engine.indicator`) or computed (`gas_cycle`). Tables of
engine builders give only harmonics of the torque, without a pressure.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property, reduce
from operator import add

import numpy as np
from numpy.typing import ArrayLike

from .cylinders import Cylinders, find_travel
from .mechanisms import slidercrank
from .mechanisms.linkage import Articulated, Rotary
from .phasors import Array, Complex, Figure, open_axes
from .piecewise import Extreme, PiecewiseCurve, merged_breaks, resolved

_SAME = 1e-8  # rad; a pressure peak this close to a breakpoint is placed at the breakpoint


class GasError(ValueError):
    """A cycle cannot be computed.

    Attributes:
        field: Name of the wrong value.
        share: The value over the least value that is possible; nan if it is not too small.
    """

    def __init__(self, field: str, message: str, share: float = math.nan) -> None:
        self.field = field
        self.share = share
        super().__init__(message)


# ---------------------------------------------------------------- the piston
@dataclass(frozen=True, eq=False)
class GasPiston:
    """Bore and kinematics of one cylinder, or of variants of one that have the same dead centres.
    Area, stroke, radius, `lam` and `eps` of variants are arrays of the shape of the variants. Cycle
    angles then end with as many axes of length 1 (`open_axes`), and results with the axes of the
    variants.

    Attributes:
        area: Area of the bore, m2.
        rod_area: Area of the piston rod's cross-section, m2; 0 without piston rod.
        stroke: Distance between the dead centres, m.
        top: Angle of the crank from the cylinder's axis when the piston is at its upper dead
            centre, rad.
        bottom: Cycle angle of the lower dead centre, rad, in (0, 2 pi).
        radius: Crank radius, m.
        lam: Crank radius over rod length; with a linkage, an array with the values of the cylinder
            and of its master cylinder.
        eps: Offset over rod length, in the form of `lam`.
        linkage: Linkage of the cylinder and its master cylinder; None if the rod is on the
            crank pin.
    """

    area: Figure
    stroke: Figure
    top: float
    bottom: float
    radius: Figure
    lam: Array
    eps: Array
    linkage: Articulated | None = None
    rod_area: float = 0.0

    @property
    def back_area(self) -> Figure:
        """Area of the piston at the crank end, m2."""
        return self.area - self.rod_area

    @property
    def swept(self) -> Figure:
        """Swept volume of the cylinder, m3."""
        return self.area * self.stroke

    @property
    def variants(self) -> tuple[int, ...]:
        """Shape of the variants; empty for one cylinder."""
        sizes = [self.area, self.stroke, self.radius]
        if self.linkage is None:
            sizes += [self.lam, self.eps]
        return np.broadcast_shapes(*map(np.shape, sizes))

    def travel(self, angle: Array) -> Array:
        """Return the piston's distance from its upper dead centre at cycle angles, m."""
        if self.linkage is None:
            return self.radius * slidercrank.displacement(angle + self.top, self.lam, self.eps)
        psi = np.append(0.0, angle) + self.top
        place = self.linkage.motion(psi, self.lam, self.eps).place[0]
        return np.asarray(self.radius * (place[0] - place[1:]).reshape(angle.shape))

    def rate(self, angle: Array) -> Array:
        """Return the derivative of `travel` by the cycle angle, m/rad."""
        if self.linkage is None:
            return self.radius * slidercrank.velocity(angle + self.top, self.lam, self.eps)
        psi = angle.reshape(-1) + self.top
        velocity = self.linkage.motion(psi, self.lam, self.eps).velocity[0]
        return np.asarray(-self.radius * velocity.reshape(angle.shape))

    def end_volume(self, angle: ArrayLike, end: GasEnd) -> Array:
        """Return the volume of one end, m3, in the shape of the angles; above its smallest volume
        if the clearance is not known.

        Args:
            angle: Cycle angles, rad, any shape.
            end: End of this cylinder.
        """
        travel = self.travel(np.asarray(angle, float))
        swept = end.area * (self.stroke - travel if end.is_crank_end else travel)
        return (end.clearance or 0.0) * end.swept + swept

    def clearance(self, compression_ratio: Figure) -> Figure:
        """Return the volume of the cylinder at the upper dead centre, m3."""
        return self.swept / (compression_ratio - 1)

    def volume(self, angle: ArrayLike, compression_ratio: Figure) -> Array:
        """Return the volume of the cylinder, m3.

        Args:
            angle: Cycle angles, rad, any shape.
            compression_ratio: Largest volume over smallest volume; a number, or an array in the
                shape of the variants.
        """
        travel = self.travel(np.asarray(angle, float))
        return self.clearance(compression_ratio) + self.area * travel

    def angle_of(self, travel: float, *, upward: bool = False) -> float:
        """Return the cycle angle in [0, 2 pi] at which the piston is `travel` (m) below its upper
        dead centre, on its way down or (`upward`) on its way up.
        """
        low, high = (self.bottom, 2 * np.pi) if upward else (0.0, self.bottom)
        for _ in range(7):
            grid = np.linspace(low, high, 257)
            down = np.maximum.accumulate((-1 if upward else 1) * self.travel(grid))
            after = int(np.searchsorted(down, -travel if upward else travel))
            low = grid[max(after - 1, 0)]
            high = grid[min(after, 256)]
        return float(high)


def pistons(cylinders: Cylinders, area: ArrayLike, rod_area: ArrayLike = 0.0) -> list[GasPiston]:
    """Return the piston of every cylinder.

    Args:
        cylinders: Cylinders of one engine, not of an array of variants.
        area: Area of the bores, m2: one value, or one for each cylinder.
        rod_area: Area of the piston rods, m2: one value, or one for each cylinder.
    """
    # In a rotary engine, the pistons move along their axes as in a stationary one.
    kind = cylinders.linkage.hung if isinstance(cylinders.linkage, Rotary) else cylinders.linkage
    linkage = kind if isinstance(kind, Articulated) else None
    c = replace(cylinders, linkage=linkage)
    gas_pistons = []
    figures = (c.lam, c.eps, area, *find_travel(c), c.radius, rod_area)
    lam, eps, *sizes = (np.broadcast_to(figure, c.count) for figure in figures)
    for row in range(c.count):
        rows = np.array(row)
        own = None
        if linkage is not None and linkage.master[row] != row:
            rows = np.array([row, linkage.master[row]])
            own = replace(
                linkage,
                mass=np.zeros(1),
                master=np.array([1, 1]),
                knuckle=linkage.knuckle[rows],
                lead_deg=linkage.lead_deg[rows],
            )
        bore, stroke, top, bottom, radius, rod = (float(size[row]) for size in sizes)
        lower = math.radians(bottom + 180 - top)
        upper = math.radians(top)
        gas_pistons.append(
            GasPiston(bore, stroke, upper, lower, radius, lam[rows], eps[rows], own, rod)
        )
    return gas_pistons


# ---------------------------------------------------------------- pressure and torque
HEAD_END = "head"
CRANK_END = "crank"


@dataclass(frozen=True, eq=False)
class GasEnd:
    """Gas in one end of a cylinder. Area, swept volume and work exist for one cylinder, not for
    variants of it.

    Attributes:
        name: `HEAD_END` (away from the crank) or `CRANK_END`.
        piston: Piston on which the gas acts.
        pressure: Absolute pressure over the cycle angle, Pa.
        volumetric_efficiency: Volume drawn in over swept volume; None unless the end compresses.
        clearance: Smallest volume of this end over swept volume; None if it is not known.
    """

    name: str
    piston: GasPiston
    pressure: PiecewiseCurve
    volumetric_efficiency: float | None = None
    clearance: Figure | None = None

    @property
    def is_crank_end(self) -> bool:
        """Whether the end is the one towards the crank."""
        return self.name == CRANK_END

    @property
    def area(self) -> float:
        """Area of the piston in this end, m2."""
        return float(self.piston.back_area if self.is_crank_end else self.piston.area)

    @property
    def swept(self) -> float:
        """Swept volume of this end, m3."""
        return self.area * float(self.piston.stroke)

    @cached_property
    def work(self) -> float:
        """Work of the gas on the piston in one revolution of a compressor, or in one cycle of any
        other end, J.
        """
        sense = -1 if self.is_crank_end else 1

        def find_rate(angle: Array) -> Array:
            return sense * self.area * self.pressure.at(angle) * self.piston.rate(angle)

        return resolved(find_rate, self.pressure.breaks).integral

    @property
    def turns(self) -> float:
        """Turns of the crank in one cycle of this end."""
        return self.pressure.period / (2 * math.pi)


@dataclass(frozen=True, eq=False)
class GasTorque:
    """Torque of the gas of one cylinder on the crankshaft. Work and mean pressure exist for one
    cylinder, not for variants of it.

    Attributes:
        piston: Piston on which the gas acts.
        breaks: Cycle angles between which torque and pressure are smooth, rad; the last is one
            period after the first.
        curve: Torque over the cycle angle, N m.
        pressure: Absolute pressure over the cycle angle, Pa; None if only the torque is known.
            With a crank end, it is the pressure in the head end that would cause the same force on
            a single-acting piston, which may be negative.
        crankcase: Absolute pressure under the piston, Pa.
        ends: Gas in the ends of the cylinder, head first; empty if only the torque is known.
    """

    piston: GasPiston
    breaks: Array
    curve: PiecewiseCurve
    pressure: PiecewiseCurve | None = None
    crankcase: float = 1e5
    ends: tuple[GasEnd, ...] = ()

    @property
    def is_double_acting(self) -> bool:
        """Whether there is gas at the crank end."""
        return len(self.ends) > 1

    def force_under(self, pressure: Array) -> Array:
        """Return the gas force on the piston towards the crankshaft, N, for pressures in the
        cylinder (Pa).
        """
        return self.piston.area * (pressure - self.crankcase)

    @property
    def work(self) -> float:
        """Work of one cycle, J."""
        return self.curve.integral

    @property
    def imep(self) -> float:
        """Indicated mean effective pressure, Pa, pumping included."""
        return self.work / float(self.piston.swept)

    def harmonics(self, halves: ArrayLike) -> Complex:
        """Return the coefficients t_h, N m, of the torque `Re sum t_h e^{i h c/2}`, where c is the
        cycle angle, shape (orders, *figure). The whole number h is twice the order; t_0 is the
        mean torque. In a two-stroke engine, t_h is 0 for odd h.
        """
        half_orders = np.asarray(halves)
        every = round(4 * np.pi / self.curve.period)
        found = self.curve.harmonics(half_orders // every)
        there = open_axes(half_orders % every == 0, self.curve.figure)
        return np.where(there, found, 0)


def press(
    piston: GasPiston, pressure: PiecewiseCurve, breaks: Array, crankcase: float = 1e5
) -> GasTorque:
    """Return the torque of a pressure over the cycle.

    Args:
        piston: Piston on which the pressure acts.
        pressure: Absolute pressure, Pa, over the cycle angle.
        breaks: Cycle angles, rad, between which the pressure is smooth, shape (breaks,).
        crankcase: Absolute pressure below the piston, Pa.
    """

    def torque(angle: Array) -> Array:
        arm = piston.rate(open_axes(angle, pressure.figure))
        return piston.area * (pressure.at(angle) - crankcase) * arm

    return GasTorque(piston, breaks, resolved(torque, breaks, each=True), pressure, crankcase)


def press_both(
    piston: GasPiston, ends: Sequence[GasEnd], breaks: Array, crankcase: float, period: float
) -> GasTorque:
    """Return the torque of the gas in the ends of a cylinder.

    Args:
        piston: Piston on which the gas acts.
        ends: Head end, and the crank end if there is one.
        breaks: Cycle angles, rad, between which the pressure in the head end is smooth.
        crankcase: Absolute pressure on the cross-section of the piston rod, or below a
            single-acting piston, Pa.
        period: Length of the cycle of the engine, rad.
    """
    head, *others = ends
    if not others and round(head.pressure.period / period, 6) == 1:
        return replace(press(piston, head.pressure, breaks, crankcase), ends=tuple(ends))
    parts = [_repeat_breaks(each.pressure.breaks, period) for each in ends]
    merged = merged_breaks([(part, 0.0) for part in parts], period)

    def effective(angle: Array) -> Array:
        pressure = head.pressure.at(angle)
        for crank in others:
            pressure = pressure - (crank.pressure.at(angle) - crankcase) * crank.area / piston.area
        return pressure

    pressure = resolved(effective, merged)
    return replace(press(piston, pressure, merged, crankcase), ends=tuple(ends))


def _repeat_breaks(breaks: Array, period: float) -> Array:
    """Return breakpoints of a curve over one or more of its periods, as far as `period`."""
    own = breaks[-1] - breaks[0]
    times = np.arange(max(round(period / own), 1))
    return np.asarray((breaks[:-1] + own * times[:, None]).ravel())


def blend(first: GasTorque, second: GasTorque, share: float) -> GasTorque:
    """Return the gas torque for a pressure between the pressures of two gas torques.

    Args:
        first: Gas torque for the share 0.
        second: Gas torque on the same piston, for the share 1.
        share: Share of the way from the first to the second pressure; above 1, it extrapolates.
    """
    breaks = merged_breaks([(first.breaks, 0.0), (second.breaks, 0.0)], first.curve.period)

    def mix(one: PiecewiseCurve, other: PiecewiseCurve) -> PiecewiseCurve:
        def value(angle: Array) -> Array:
            return (1 - share) * one.at(angle) + share * other.at(angle)

        return resolved(value, breaks)

    pressure = first.pressure and second.pressure and mix(first.pressure, second.pressure)
    curve = mix(first.curve, second.curve)
    ends: tuple[GasEnd, ...] = ()
    if pressure:
        clearance = first.ends[0].clearance if first.ends else None
        ends = (GasEnd(HEAD_END, first.piston, pressure, clearance=clearance),)
    return replace(first, breaks=breaks, curve=curve, pressure=pressure, ends=ends)


def find_highest(pressure: PiecewiseCurve) -> Extreme:
    """Return the highest pressure, Pa, and the first cycle angle (rad, in [-period/2, period/2)) at
    which it is reached.
    """
    angle, value = pressure.extremes()[1]
    period = pressure.period
    corner = float(pressure.breaks[np.argmin(np.abs(pressure.breaks - angle))])
    angle = corner if abs(corner - angle) < _SAME else angle
    return Extreme((angle + period / 2) % period - period / 2, value)


def crank_torque(
    cylinders: Sequence[tuple[GasTorque, float, float]], period: float
) -> PiecewiseCurve:
    """Return the torque of several cylinders, N m, at crank angles in [0, period].

    Args:
        cylinders: For each cylinder its gas torque, the crank angle (rad) of its firing dead
            centre, and the factor by which its torque is multiplied (0 for a misfire). The curves
            of all torques have the same figure.
        period: Angle after which the sum repeats itself, rad.
    """

    def total(angle: Array) -> Array:
        each = (share * gas.curve.at(angle - fires) for gas, fires, share in cylinders)
        return reduce(add, each)

    breaks = merged_breaks([(gas.breaks, fires) for gas, fires, _ in cylinders], period)
    return resolved(total, breaks, each=True)

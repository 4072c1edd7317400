"""Compute the cylinder pressure of Otto, Diesel, dual (limited pressure) and Wiebe cycles.

A four-stroke cycle has five parts: expansion from the firing dead centre to `exhaust_opens`,
exhaust pressure to the gas-exchange dead centre, intake pressure to `intake_closes`, compression by
`p V^nc = constant` (nc is the index of compression), and the burn. In a two-stroke cycle, the
intake (scavenge) pressure lasts from `exhaust_opens` until the rising piston is back at the
position where the exhaust opened.

Heat Q raises the pressure by `d(p V^n) = (n - 1) V^(n-1) dQ`, n being the index of expansion. So `p
V^n` after the burn follows directly from the heat, and the pressure during the burn is an integral,
which needs no time steps. The only unknown of a cycle is its heat. Burn and expansion together do
the work `X Q - (p_2 V_2 - p_1 V_1)/(n - 1)`: the released heat, a share X of Q, less the energy
that the gas gains from the start of the burn (1) to the opening of the exhaust (2).
Compression is a polytrope, and pressures are constant while the valves are open, so imep has a
closed form.

Variants of a cycle are computed as one cycle whose figures are arrays. All laws then hold between
the same cycle angles, so that figures that move these angles must be numbers.

Sources: the ideal cycles are those of every textbook (Heywood, Internal Combustion Engine
Fundamentals, 1988, 5.4); Wiebe's law is `x = 1 - exp(-6.908 xi^(m+1))` (1956): 99.9 % of the heat
is released within the duration of the burn. x is the burnt share of the fuel, xi the elapsed share
of the duration.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Literal, NamedTuple

import numpy as np

from .cylinder_pressure import GasError, GasPiston
from .phasors import Array, Figure, open_axes
from .piecewise import Function, PiecewiseCurve, find_zeros, join, resolved

_BURNT = 6.908  # -ln 0.001
_PANEL = 0.25  # rad; on narrower panels, few burns and expansions need any halving

# Figures that a user can prescribe for each kind of cycle; the heat follows from them.
GOALS = {
    "otto": ("imep", "heat", "max_pressure"),
    "diesel": ("imep", "heat", "cut_off"),
    "dual": ("imep", "heat", "cut_off"),
    "wiebe": ("imep", "heat", "max_pressure"),
}


# ---------------------------------------------------------------- input and result
@dataclass(frozen=True)
class Process:
    """Figures of a cycle except its heat: absolute pressures in Pa, cycle angles in deg. Figures
    other than angles may be arrays of variants (`align`).

    Attributes:
        cycle: Law of the burn: "otto", all heat at the dead centre; "diesel", at the constant
            pressure that compression reaches; "dual", at the dead centre up to `max_pressure`, then
            at that pressure; "wiebe", by Wiebe's law.
        exhaust_opens: Angle at which the exhaust opens; None: the lower dead centre.
        intake_closes: Angle at which the intake closes; None: the lower dead centre. In a
            two-stroke cycle the ports close at the piston position at which they opened.
        burn_start: Angle at which the burn of Wiebe's law starts.
        burn_duration: Crank angle over which the burn of Wiebe's law lasts.
        burn_shape: Exponent m >= 0 of Wiebe's law.
        max_pressure: Highest pressure of a dual cycle.
    """

    compression_ratio: Figure
    cycle: str = "otto"
    strokes: int = 4
    compression_index: Figure = 1.32
    expansion_index: Figure = 1.28
    intake: Figure = 1.0e5
    exhaust: Figure = 1.05e5
    exhaust_opens: float | None = None
    intake_closes: float | None = None
    burn_start: float = -15.0
    burn_duration: float = 50.0
    burn_shape: Figure = 2.0
    max_pressure: float | None = None

    def align(self, shape: tuple[int, ...]) -> Process:
        """Return the process with all figures that may vary as arrays of the shape of the variants;
        as plain numbers, if the shape is empty.
        """
        aligned: dict[str, Any] = {}
        for key in _VARYING:
            aligned[key] = np.broadcast_to(getattr(self, key), shape)[()]
        return replace(self, **aligned)


_VARYING = (
    *("compression_ratio", "compression_index", "expansion_index"),
    *("intake", "exhaust", "burn_shape"),
)


class Goal(NamedTuple):
    """Figure that a cycle must reach: `imep` or `max_pressure` (Pa), `heat` supplied per cycle (J),
    or `cut_off`, the volume at the end of the burn at constant pressure divided by the volume at
    the start of this burn. The value may be an array of variants.
    """

    name: Literal["imep", "heat", "max_pressure", "cut_off"]
    value: Figure


class GasCycle(NamedTuple):
    """A computed cycle, or several variants of it.

    Attributes:
        pressure: Absolute pressure at cycle angles, Pa; the figure of the curve has the shape of
            the variants.
        breaks: Cycle angles between which the pressure is smooth, rad.
        heat: Heat supplied in a cycle, J.
        imep: Indicated mean effective pressure, Pa, pumping included.
    """

    pressure: PiecewiseCurve
    breaks: Array
    heat: Figure
    imep: Figure


def gas_cycle(piston: GasPiston, process: Process, goal: Goal) -> GasCycle:
    """Return the cycle that reaches a goal.

    Args:
        piston: Piston of the cylinder.
        process: Laws of compression, combustion and expansion. Figures of an Otto or Wiebe cycle
            may be arrays of variants, and so may figures of the piston in four strokes.
        goal: Figure that the cycle must reach; it determines the heat.

    Raises:
        GasError: The process has a mistake (the error names the first), or no heat reaches the
            goal.
    """
    _check(piston, process, goal)
    varying = (getattr(process, key) for key in _VARYING)
    of_process = np.broadcast_shapes(np.shape(goal.value), *map(np.shape, varying))
    shape = np.broadcast_shapes(of_process, piston.variants)
    cycle = _Cycle(piston, process.align(shape))
    heat = cycle.find_heat(goal)
    breaks = [cycle.closes]
    curves = []
    for end, law in cycle.list_laws(heat):
        if end > breaks[-1]:
            curves.append(resolved(law, [breaks[-1], end], _PANEL, each=True))
            breaks.append(end)
    return GasCycle(join(curves), np.array(breaks), heat, cycle.find_imep(heat))


def find_least_imep(piston: GasPiston, process: Process) -> float:
    """Return the indicated mean effective pressure (Pa) of the cycle with the least heat: no heat,
    or the heat with which a dual cycle reaches its `max_pressure`.

    Args:
        piston: Piston of the cylinder.
        process: Laws of compression, combustion and expansion, whose figures are numbers.
    """
    cycle = _Cycle(piston, process)
    return float(cycle.find_imep(cycle.least))


# ---------------------------------------------------------------- checks
def _check(piston: GasPiston, process: Process, goal: Goal) -> None:
    """Raise GasError for the first mistake in a cycle before it is computed."""
    p = process
    goals = GOALS[process.cycle]
    if goal.name not in goals:
        hint = f"give {', '.join(goals[:-1])} or {goals[-1]}"
        raise GasError(goal.name, f"does not determine the {p.cycle} cycle: {hint}")
    index = float(np.min(p.expansion_index))
    if not index > 1:
        raise GasError("expansion_index", f"is {index:g}: give more than 1")
    lowest = math.degrees(piston.bottom)
    burnt = p.burn_start + p.burn_duration
    if p.strokes == 2 and p.exhaust_opens is not None and p.exhaust_opens > lowest:
        message = f"is {p.exhaust_opens:g}°: give up to {lowest:g}°, the lower dead centre"
        raise GasError("exhaust_opens", message)
    opens, closes = (math.degrees(angle) for angle in _find_valves(piston, process))
    if p.cycle == "wiebe" and burnt > opens:
        message = f"makes the burn end at {burnt:g}°, past {opens:g}°, where the exhaust opens"
        raise GasError("burn_duration", message)
    if p.cycle == "wiebe" and p.burn_start <= closes:
        message = f"is {p.burn_start:g}°, before {closes:g}°, where compression begins"
        raise GasError("burn_start", message)


def _find_valves(piston: GasPiston, process: Process) -> tuple[float, float]:
    """Return the cycle angles (rad) at which the exhaust opens and at which compression begins; the
    latter is negative, before the firing dead centre.
    """
    opens_deg = process.exhaust_opens
    closes_deg = process.intake_closes
    opens = piston.bottom if opens_deg is None else math.radians(opens_deg)
    if process.strokes == 2:
        down = float(piston.travel(np.array(opens)))
        return opens, piston.angle_of(down, upward=True) - 2 * math.pi
    closes = piston.bottom - 2 * math.pi if closes_deg is None else math.radians(closes_deg - 720)
    return opens, closes


# ---------------------------------------------------------------- cycles
class _Cycle:
    """A cycle whose heat is not known yet.

    Laws are functions of cycle angles of any shape; their values have the axes of the angles, then
    the axes of the variants (`variants`), if the process has arrays.
    """

    def __init__(self, piston: GasPiston, process: Process) -> None:
        p = process
        self.piston = piston
        self.process = process
        self.index = process.expansion_index
        self.start = math.radians(p.burn_start) if p.cycle == "wiebe" else 0.0
        self.opens, self.closes = _find_valves(piston, process)
        self.begins = min(self.start, 0.0)
        self.variants = np.shape(p.compression_ratio)
        places = np.array([self.closes, self.begins, self.opens])
        self.closed, self.charge, self.opened = self.find_volume(places)
        self.pressure = p.intake * (self.closed / self.charge) ** p.compression_index
        self.constant = self.pressure * self.charge**self.index  # p V^n of the charge
        self.unit = self.pressure * self.charge  # of heat, J
        self.least: Figure = 0.0  # heat, J
        self.most: Figure = math.inf  # heat, J
        self.released = 1.0  # share of the heat
        self.grown = self.charge ** (self.index - 1)  # integral of V^(n-1) dx, x: burnt share
        self.limit = self.pressure if p.cycle == "diesel" else None
        if p.cycle == "dual":
            self.limit = p.max_pressure or 0.0
            self._refuse_beyond("max_pressure", self.limit, self.pressure, math.inf)
        if self.limit is not None:
            self.least = (self.limit - self.pressure) * self.charge / (self.index - 1)
            self.share = self.index / (self.index - 1) * self.limit  # heat over added volume, J/m3
            self.most = self.least + self.share * (self.opened - self.charge)
        if p.cycle == "wiebe":
            self.end = self.start + math.radians(p.burn_duration)
            self.released = -math.expm1(-_BURNT)
            during = [self.start, self.end]
            self.lost = resolved(self._widen, during, _PANEL, each=True).antiderivative()
            end = np.array(self.end)
            self.grown = self._grow(end, self.find_volume(end))

    def find_volume(self, angle: Array) -> Array:
        """Return the volume (m3) at cycle angles."""
        angles = open_axes(angle, self.variants)
        return self.piston.volume(angles, self.process.compression_ratio)

    # ------------------------------------------------------------ the burn
    def burn(self, heat: Figure) -> Figure:
        """Return p V^n after the burn with this heat."""
        if self.limit is not None:
            return self.limit * self._find_last(heat) ** self.index
        return self.constant + (self.index - 1) * self.grown * heat

    def list_burning(self, heat: Figure) -> list[tuple[float, Function]]:
        """Return the pressure laws from the start to the end of the burn, in the form of
        `list_laws`.
        """
        if self.limit is not None:
            travel = float((self._find_last(heat) - self.charge) / self.piston.area)
            return [(self.piston.angle_of(travel), _hold(self.limit))]
        if self.process.cycle != "wiebe":
            return []

        def burn(angle: Array) -> Array:
            volume = self.find_volume(angle)
            constant = self.constant + (self.index - 1) * heat * self._grow(angle, volume)
            return constant / volume**self.index

        return [(self.start, self._expand(self.constant, self.index)), (self.end, burn)]

    def _find_last(self, heat: Figure) -> Figure:
        """Return the volume at the end of the burn at constant pressure, m3."""
        return self.charge + (heat - self.least) / self.share

    def _find_burnt(self, angle: Array) -> Array:
        elapsed = np.clip((angle - self.start) / (self.end - self.start), 0, 1)
        xi = open_axes(elapsed, self.variants)
        return -np.expm1(-_BURNT * xi ** (self.process.burn_shape + 1))

    def _widen(self, angle: Array) -> Array:
        rate = self.piston.area * self.piston.rate(open_axes(angle, self.variants))
        power = self.find_volume(angle) ** (self.index - 2)
        return (self.index - 1) * self._find_burnt(angle) * power * rate

    def _grow(self, angle: Array, volume: Array) -> Array:
        """Return the integral of V^(n-1) dx from the start of the burn to cycle angles during the
        burn, where x is the burnt share. It is integrated by parts, `x V^(n-1) - (n-1) integral of
        x V^(n-2) dV`, because x is smoother than its derivative.

        Args:
            angle: Cycle angles, rad.
            volume: Volumes at these angles, m3.
        """
        power = volume ** (self.index - 1)
        return self._find_burnt(angle) * power - self.lost.within(angle)

    # ------------------------------------------------------------ the whole cycle
    def list_laws(self, heat: Figure) -> list[tuple[float, Function]]:
        """Return the pressure laws in sequence from the start of compression on, as pairs: cycle
        angle (rad) at which the law ends, and the law (Pa, a function of cycle angles). A law may
        end where it begins.
        """
        p = self.process
        period = self.process.strokes * math.pi
        closed = p.intake * self.closed**p.compression_index
        return [
            (self.begins, self._expand(closed, p.compression_index)),
            *self.list_burning(heat),
            (self.opens, self._expand(self.burn(heat), self.index)),
            *([(2 * math.pi, _hold(p.exhaust))] if p.strokes == 4 else []),
            (self.closes + period, _hold(p.intake)),
        ]

    def _expand(self, constant: Figure, index: Figure) -> Function:
        """Return the pressure law p V^n = `constant` with the index n."""
        return lambda angle: constant / self.find_volume(angle) ** index

    def find_imep(self, heat: Figure) -> Figure:
        """Return the indicated mean effective pressure with this heat, Pa."""
        p = self.process
        n = self.index
        gained = self.burn(heat) * self.opened ** (1 - n) - self.pressure * self.charge
        work = self.released * heat - gained / (n - 1)
        over = np.asarray(p.compression_index - 1)
        steps = np.log(self.closed / self.charge)
        isothermal = over == 0
        compressed = np.expm1(over * steps) / np.where(isothermal, 1.0, over)
        work -= p.intake * self.closed * np.where(isothermal, steps, compressed)
        if p.strokes == 4:  # the ports of a two-stroke close at the volume at which they opened
            clearance = self.piston.clearance(p.compression_ratio)
            work += p.intake * (self.closed - clearance) - p.exhaust * (self.opened - clearance)
        return work / self.piston.swept

    def find_goal(self, name: str, heat: Figure) -> Figure:
        """Return the value that the figure of a goal has in the cycle with this heat.

        Args:
            name: Name of the figure: `heat` (J), `imep`, `max_pressure` (Pa) or `cut_off`.
            heat: Heat supplied per cycle, J.
        """
        if name == "heat":
            return heat
        if name == "imep":
            return self.find_imep(heat)
        if name == "cut_off":
            return self._find_last(heat) / self.charge
        if self.process.cycle == "otto":
            return self.burn(heat) / self.charge**self.index
        share = heat / self.unit
        cold, hot = np.moveaxis(self._peak.series, -1, 0)
        peak = PiecewiseCurve(self._peak.breaks, (1 - share) * cold + share * hot)
        return np.maximum(self.pressure, peak.find_range()[1])

    @cached_property
    def _peak(self) -> PiecewiseCurve:
        """Pressure of a Wiebe cycle where it may be highest, without heat and with the heat `unit`
        (last axis of the figure). At every angle the pressure is a linear function of the heat.
        """
        heats = 0.0, self.unit
        during = [self.start, self.end]
        laws = [self.list_burning(heat)[1][1] for heat in heats]
        if self.end < 0:
            during = [self.end, 0.0]
            laws = [self._expand(self.burn(heat), self.index) for heat in heats]

        def find_both(angle: Array) -> Array:
            return np.stack([law(angle) for law in laws], axis=-1)

        return resolved(find_both, during, _PANEL, each=True)

    def find_heat(self, goal: Goal) -> Figure:
        """Return the heat (J) with which the cycle reaches the goal."""
        name, value = goal
        lowest = self.find_goal(name, self.least)
        highest: Figure = math.inf
        if self.limit is not None:
            highest = self.find_goal(name, self.most)
        guess = np.minimum(self.unit, self.most - self.least)
        if name == "imep":  # more heat may not raise it
            rises = self.find_imep(self.least + guess) > lowest
            highest = np.where(rises, highest, lowest)
        self._refuse_beyond(name, value, lowest, highest)
        if np.all(value == highest) and np.all(value > lowest):
            return self.most

        def exceed(above: Array) -> Array:
            return np.asarray(self.find_goal(name, self.least + above) - value)

        return self.least + find_zeros(exceed, guess, np.asarray(lowest - value))

    def _refuse_beyond(self, name: str, value: Figure, lowest: Figure, highest: Figure) -> None:
        """Raise GasError if a value is outside the range that the cycle can reach."""
        size, unit = (1e5, " bar") if name in ("imep", "max_pressure") else (1.0, "")
        for wanted, least, most in np.broadcast(value, lowest, highest):
            if not (wanted < least or wanted > most):
                continue
            bound, end = ("at least", least) if wanted < least else ("at most", most)
            message = f"is {wanted / size:g}{unit}: this cycle has {bound} {end / size:.4g}{unit}"
            share = wanted / least if 0 < wanted < least else math.nan
            raise GasError(name, message, share)


def _hold(pressure: Figure) -> Function:
    """Return the law of constant pressure."""
    return lambda angle: np.full(angle.shape + np.shape(pressure), pressure)

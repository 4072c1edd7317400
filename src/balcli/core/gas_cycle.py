"""Computed cycles: Otto, Diesel, dual (limited pressure), Wiebe.

Four-stroke: expansion from the firing dead centre to `exhaust_opens`, the exhaust pressure to the
gas-exchange dead centre, the intake pressure to `intake_closes`, compression `p V^nc`, and the
burn. Two-stroke: expansion, from `exhaust_opens` the intake (scavenge) pressure until the piston
stands there again on its way up, compression.

Heat Q acts by `d(p V^n) = (n - 1) V^(n-1) dQ`, n the index of expansion. So `p V^n` after the burn
follows from the heat alone, and the pressure under way is a quadrature: nothing is stepped in time.
The one unknown of a cycle is its heat. Burn and expansion together do the work `X Q - [p V]/(n -
1)`, the released heat less what the gas gains; with the polytrope of compression and constant
pressures while the valves are open, imep is known in closed form.

Sources: the ideal cycles are those of every textbook (Heywood, Internal Combustion Engine
Fundamentals, 1988, 5.4); Wiebe's law is `x = 1 - exp(-6.908 xi^(m+1))` (1956), by which 99.9 % of
the heat are released within the duration.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar, Literal, NamedTuple, TypeAlias

import numpy as np

from .cylinder_pressure import GasError, GasPiston
from .phasors import Array
from .piecewise import Function, PiecewiseCurve, find_zero, join, resolved

_BURNT = 6.908  # -ln 0.001


# ---------------------------------------------------------------- what is given
@dataclass(frozen=True)
class Otto:
    """All heat at the dead centre."""

    goals: ClassVar = ("imep", "heat", "max_pressure")


@dataclass(frozen=True)
class Dual:
    """Heat at the dead centre up to `max_pressure` (Pa), then at that pressure."""

    max_pressure: float
    goals: ClassVar = ("imep", "heat", "cut_off")


@dataclass(frozen=True)
class Diesel(Dual):
    """Heat at the constant pressure that compression reaches."""

    max_pressure: float = 0.0


@dataclass(frozen=True)
class Wiebe:
    """Heat by Wiebe's law; cycle angles in deg, `shape` is its exponent m >= 0."""

    start_deg: float
    duration_deg: float
    shape: float = 2.0
    goals: ClassVar = ("imep", "heat", "max_pressure")


Burn: TypeAlias = Otto | Diesel | Dual | Wiebe


@dataclass(frozen=True)
class Process:
    """All of a cycle but its burn: absolute pressures in Pa, cycle angles in deg.

    Attributes:
        exhaust_opens_deg, intake_closes_deg: None: at the lower dead centre. In a two-stroke cycle
            the ports close where the exhaust opened.
    """

    compression_ratio: float
    strokes: int = 4
    compression_index: float = 1.32
    expansion_index: float = 1.28
    intake: float = 1.0e5
    exhaust: float = 1.05e5
    exhaust_opens_deg: float | None = None
    intake_closes_deg: float | None = None


class Goal(NamedTuple):
    """What a cycle is to have: `imep` or `max_pressure` in Pa, `heat` supplied a cycle in J, or
    `cut_off`, the ratio of the volumes at the end and at the start of constant pressure.
    """

    name: Literal["imep", "heat", "max_pressure", "cut_off"]
    value: float


class GasCycle(NamedTuple):
    """A computed cycle.

    Attributes:
        pressure: Absolute pressure at cycle angles, Pa.
        breaks: Cycle angles between which the pressure is smooth, rad.
        heat: Heat supplied in a cycle, J.
        imep: Indicated mean effective pressure, Pa, pumping included.
    """

    pressure: PiecewiseCurve
    breaks: Array
    heat: float
    imep: float


def gas_cycle(piston: GasPiston, process: Process, burn: Burn, goal: Goal) -> GasCycle:
    """Return the cycle that has what `goal` asks for.

    Raises:
        GasError: The first that `find_cycle_mistakes` finds, or a goal that no heat can reach.
    """
    for mistake in find_cycle_mistakes(piston, process, burn, goal):
        raise mistake
    if isinstance(burn, Dual):
        cycle: _Cycle = _LimitedPressure(piston, process, burn)
    elif isinstance(burn, Wiebe):
        cycle = _Gradual(piston, process, burn)
    else:
        cycle = _Cycle(piston, process)
    heat = cycle.find_heat(goal)
    breaks, curves = [cycle.closes], []
    for end, law in cycle.list_laws(heat):
        if end > breaks[-1]:
            curves.append(resolved(law, [breaks[-1], end]))
            breaks.append(end)
    return GasCycle(join(curves), np.array(breaks), heat, cycle.find_imep(heat))


# ---------------------------------------------------------------- what is wrong
def find_cycle_mistakes(
    piston: GasPiston, process: Process, burn: Burn, goal: Goal
) -> Iterator[GasError]:
    """Yield all that is wrong with a cycle before it is computed."""
    p = process
    if goal.name not in burn.goals:
        *most, last = burn.goals
        kind = type(burn).__name__.lower()
        hint = f"give {', '.join(most)} or {last}"
        yield GasError(goal.name, f"does not make the {kind} cycle: {hint}")
    if not p.expansion_index > 1:
        yield GasError("expansion_index", f"is {p.expansion_index:g}: give more than 1")
    valves = list(_find_wrong_valves(piston, p))
    yield from valves
    if isinstance(burn, Wiebe) and not valves:
        opens, closes = (math.degrees(angle) for angle in _find_valves(piston, process))
        end = burn.start_deg + burn.duration_deg
        if end > opens:
            yield GasError(
                "burn_duration",
                f"a burn over {burn.duration_deg:g}° from {burn.start_deg:g}° ends at {end:g}°, "
                f"past {opens:g}°, where the exhaust opens",
            )
        if burn.start_deg <= closes:
            message = f"is {burn.start_deg:g}°, before {closes:g}°, where compression begins"
            yield GasError("burn_start", message)


def _find_wrong_valves(piston: GasPiston, process: Process) -> Iterator[GasError]:
    opens, closes = process.exhaust_opens_deg, process.intake_closes_deg
    latest, dead_centre = 360.0, "gas-exchange"
    if process.strokes == 2:
        latest, dead_centre = math.degrees(piston.bottom), "lower"
    if opens is not None and not 0 < opens <= latest:
        yield GasError(
            "exhaust_opens",
            f"is {opens:g}°: give a cycle angle above 0° and up to {latest:g}°, "
            f"the {dead_centre} dead centre",
        )
    if closes is not None and process.strokes == 2:
        yield GasError(
            "intake_closes",
            "has no meaning in a two-stroke cycle, whose ports close where the exhaust opened: "
            "leave it out",
        )
    elif closes is not None and not 360 <= closes < 720:
        yield GasError(
            "intake_closes",
            f"is {closes:g}°: give a cycle angle from 360°, the gas-exchange dead centre, to below "
            "720°",
        )


def _find_valves(piston: GasPiston, process: Process) -> tuple[float, float]:
    """Return the cycle angles (rad) at which the exhaust opens, and at which, before the firing
    dead centre, compression begins.
    """
    opens_deg, closes_deg = process.exhaust_opens_deg, process.intake_closes_deg
    opens = piston.bottom if opens_deg is None else math.radians(opens_deg)
    if process.strokes == 2:
        down = float(piston.travel(np.array(opens)))
        return opens, piston.angle_of(down, upward=True) - 2 * math.pi
    closes = piston.bottom - 2 * math.pi if closes_deg is None else math.radians(closes_deg - 720)
    return opens, closes


# ---------------------------------------------------------------- cycles
class PressureLaw(NamedTuple):
    """A law of pressure (Pa at cycle angles, rad), and where it ends."""

    end: float
    law: Function


class _Cycle:
    """A cycle whose heat is not known yet; here with all heat at the dead centre."""

    least = 0.0  # heat with which the cycle is one, J
    most = math.inf
    released = 1.0  # share of the heat
    begins = 0.0  # cycle angle of the charge, rad

    def __init__(self, piston: GasPiston, process: Process) -> None:
        self.piston, self.process, self.index = piston, process, process.expansion_index
        self.opens, self.closes = _find_valves(piston, process)
        places = np.array([self.closes, self.begins, self.opens])
        self.closed, self.charge, self.opened = self.find_volume(places).tolist()
        steps = math.log(self.closed / self.charge)
        self.pressure = process.intake * math.exp(process.compression_index * steps)
        self.constant = self.pressure * self.charge**self.index  # p V^n of the charge

    def find_volume(self, angle: Array) -> Array:
        """Return the volume (m3) at cycle angles."""
        return self.piston.volume(angle, self.process.compression_ratio)

    def expand(self, constant: float, index: float | None = None) -> Function:
        """Return the law p V^n = const."""
        return lambda angle: constant / self.find_volume(angle) ** (index or self.index)

    # ------------------------------------------------------------ the burn
    def burn(self, heat: float) -> float:
        """Return p V^n after the burn."""
        return self.constant + (self.index - 1) * self.charge ** (self.index - 1) * heat

    def list_burning(self, heat: float) -> list[PressureLaw]:
        """Return the laws of pressure from the charge to the end of the burn."""
        return []

    def find_heat_for_shape(self, wanted: float) -> float:
        """Return the heat for the goal that is neither heat nor imep; here a highest pressure."""
        self.refuse_low(wanted, self.pressure)
        return (wanted - self.pressure) * self.charge / (self.index - 1)

    def refuse_low(self, wanted: float, compressed: float) -> None:
        """Raise GasError if compression alone exceeds a highest pressure (Pa)."""
        if wanted < compressed:
            wanted, compressed = wanted / 1e5, compressed / 1e5
            message = f"is {wanted:g} bar, below the {compressed:.4g} bar of compression alone"
            raise GasError("max_pressure", message)

    # ------------------------------------------------------------ the whole cycle
    def list_laws(self, heat: float) -> list[PressureLaw]:
        """Return the laws of pressure from the begin of compression on; some may have no length."""
        p, period = self.process, self.process.strokes * math.pi
        closed = p.intake * self.closed**p.compression_index
        opened = [PressureLaw(2 * math.pi, _hold(p.exhaust))] if p.strokes == 4 else []
        return [
            PressureLaw(self.begins, self.expand(closed, p.compression_index)),
            *self.list_burning(heat),
            PressureLaw(self.opens, self.expand(self.burn(heat))),
            *opened,
            PressureLaw(self.closes + period, _hold(p.intake)),
        ]

    def find_imep(self, heat: float) -> float:
        """Return the indicated mean effective pressure with this heat, Pa."""
        p, n = self.process, self.index
        gained = self.burn(heat) * self.opened ** (1 - n) - self.pressure * self.charge
        work = self.released * heat - gained / (n - 1)
        over, steps = p.compression_index - 1, math.log(self.closed / self.charge)
        work -= p.intake * self.closed * (math.expm1(over * steps) / over if over else steps)
        if p.strokes == 4:  # the ports of a two-stroke close at the volume at which they opened
            clearance = self.piston.clearance(p.compression_ratio)
            work += p.intake * (self.closed - clearance) - p.exhaust * (self.opened - clearance)
        return work / self.piston.swept

    def find_heat(self, goal: Goal) -> float:
        """Return the heat (J) with which the cycle has what is asked for."""
        if goal.name == "imep":
            return self._find_heat_for_imep(goal.value)
        of_heat = goal.name == "heat"
        heat = goal.value if of_heat else self.find_heat_for_shape(goal.value)
        if heat < self.least:
            least = self.least if of_heat else 1
            raise GasError(goal.name, f"is {goal.value:g}: this cycle needs {least:.4g} or more")
        if heat > self.most:
            most = self.most if of_heat else self.opened / self.charge
            raise GasError(
                goal.name,
                f"is {goal.value:g}: with more than {most:.4g} the exhaust opens during the burn",
            )
        return heat

    def _find_heat_for_imep(self, imep: float) -> float:
        lowest = self.find_imep(self.least)
        if imep < lowest:
            raise self._miss(imep, "least", lowest)
        highest = math.inf if self.most == math.inf else self.find_imep(self.most)
        guess = min((imep - lowest) * self.piston.swept, self.most - self.least)
        if imep > highest or (guess and self.find_imep(self.least + guess) <= lowest):
            raise self._miss(imep, "most", highest)
        if not guess:
            return self.least
        above = find_zero(
            lambda heat: self.find_imep(self.least + heat) - imep, guess, lowest - imep
        )
        return self.least + above

    def _miss(self, imep: float, which: str, bound: float) -> GasError:
        return GasError(
            "imep",
            f"is {imep / 1e5:g} bar: with the {which} heat the cycle has {bound / 1e5:.4g} bar",
        )


class _LimitedPressure(_Cycle):
    """Heat at constant volume up to a pressure, the rest at that pressure."""

    def __init__(self, piston: GasPiston, process: Process, burn: Dual) -> None:
        super().__init__(piston, process)
        self.limit = self.pressure if isinstance(burn, Diesel) else burn.max_pressure
        self.refuse_low(self.limit, self.pressure)
        self.least = (self.limit - self.pressure) * self.charge / (self.index - 1)
        self.share = self.index / (self.index - 1) * self.limit  # J that widen the charge by 1 m3
        self.most = self.least + self.share * (self.opened - self.charge)

    def burn(self, heat: float) -> float:
        return float(self.limit * self._find_last(heat) ** self.index)

    def list_burning(self, heat: float) -> list[PressureLaw]:
        travel = (self._find_last(heat) - self.charge) / self.piston.area
        return [PressureLaw(self.piston.angle_of(travel), _hold(self.limit))]

    def find_heat_for_shape(self, wanted: float) -> float:
        return self.least + self.share * (wanted - 1) * self.charge

    def _find_last(self, heat: float) -> float:
        """Return the volume at the end of the burn, m3."""
        return self.charge + (heat - self.least) / self.share


class _Gradual(_Cycle):
    """Heat by Wiebe's law."""

    released = -math.expm1(-_BURNT)

    def __init__(self, piston: GasPiston, process: Process, burn: Wiebe) -> None:
        self.start = math.radians(burn.start_deg)
        self.end = self.start + math.radians(burn.duration_deg)
        self.begins, self.shape = min(self.start, 0.0), burn.shape
        super().__init__(piston, process)
        self.lost = resolved(self._widen, [self.start, self.end]).antiderivative()
        self.grown = float(self._grow(np.array(self.end)))

    def burn(self, heat: float) -> float:
        return self.constant + (self.index - 1) * self.grown * heat

    def list_burning(self, heat: float) -> list[PressureLaw]:
        before, by_heat = self.expand(self.constant), self._rise
        return [
            PressureLaw(self.start, before),
            PressureLaw(self.end, lambda angle: before(angle) + heat * by_heat(angle)),
        ]

    def find_heat_for_shape(self, wanted: float) -> float:
        """Return the heat for a highest pressure: everywhere the pressure is linear in the heat, so
        that it is first reached where the least heat will do.
        """
        before = self.expand(self.constant)
        self.refuse_low(wanted * (1 - 1e-12), float(before(np.clip(0.0, self.begins, self.end))))
        breaks = [self.start, self.end] if self.end >= 0 else [self.start, self.end, 0.0]
        rise = resolved(lambda angle: self._rise(angle) / (wanted - before(angle)), breaks)
        return 1 / rise.extremes()[1].value

    def _rise(self, angle: Array) -> Array:
        """Return the pressure that one unit of heat adds."""
        return (self.index - 1) * self._grow(angle) / self.find_volume(angle) ** self.index

    def _find_burnt(self, angle: Array) -> Array:
        xi = np.clip((angle - self.start) / (self.end - self.start), 0, 1)
        return -np.expm1(-_BURNT * xi ** (self.shape + 1))

    def _widen(self, angle: Array) -> Array:
        rate = self.piston.area * self.piston.rate(angle)
        power = self.find_volume(angle) ** (self.index - 2)
        return (self.index - 1) * self._find_burnt(angle) * power * rate

    def _grow(self, angle: Array) -> Array:
        """Return the integral of V^(n-1) dx from the start on. By parts it is `x V^(n-1) - (n-1)
        integral of x V^(n-2) dV`: x is smoother than its rate, whatever the exponent.
        """
        at = np.clip(angle, self.start, self.end)
        power = self.find_volume(at) ** (self.index - 1)
        return self._find_burnt(at) * power - self.lost.within(at)


def _hold(pressure: float) -> Function:
    """Return the law p = const."""
    return lambda angle: np.full(angle.shape, pressure)

"""Computed cycles.

Four-stroke: expansion from the firing dead centre to `exhaust_opens`, the exhaust pressure to the
gas-exchange dead centre, the intake pressure to `intake_closes`, compression `p V^nc`, and the burn
(`combustion`). Two-stroke: expansion, from `exhaust_opens` the intake (scavenge) pressure until the
piston stands there again on its way up, compression.

The one unknown of a cycle is its heat Q. Burn and expansion together do the work `X Q - [p V]/(n -
1)`, the released heat less what the gas gains; with the polytrope of compression and constant
pressures while the valves are open, imep is known in closed form.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from .combustion import (
    Burn,
    Charge,
    Combustion,
    PressureLaw,
    Wiebe,
    combustion,
    constant,
    polytrope,
)
from .cylinder_pressure import CylinderPressure, GasError, GasPiston
from .phasors import Array
from .piecewise import Function, piece_of, wrapped


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


@dataclass(frozen=True)
class GasCycle(CylinderPressure):
    """A computed cycle.

    Attributes:
        corners: breakpoints, rad, shape (pieces + 1,).
        laws: pressure (Pa) at cycle angles within each piece.
        heat: supplied in a cycle, J.
        imep: indicated mean effective pressure, Pa, pumping included.
        asked: what `gas_cycle` made it of, and makes it of again where it was pickled.
    """

    corners: Array
    laws: tuple[Function, ...]
    heat: float
    imep: float
    asked: tuple[GasPiston, Process, Burn, Goal]

    def __reduce__(self) -> tuple[Callable[..., GasCycle], tuple[GasPiston, Process, Burn, Goal]]:
        return gas_cycle, self.asked

    @property
    def breaks(self) -> Array:
        return self.corners

    def at(self, angle: ArrayLike, *, before: bool = False) -> Array:
        angles = wrapped(angle, self.corners, before=before)
        piece = piece_of(angles, self.corners, before=before)
        found = np.empty(angles.shape)
        for number in np.flatnonzero(np.bincount(piece.reshape(-1))):
            own = piece == number
            found[own] = self.laws[number](angles[own])
        return found


def gas_cycle(piston: GasPiston, process: Process, burn: Burn, goal: Goal) -> GasCycle:
    """The cycle that has what `goal` asks for.

    Raises:
        GasError: the first that `find_cycle_mistakes` finds, or a goal that no heat can reach.
    """
    for mistake in find_cycle_mistakes(piston, process, burn, goal):
        raise mistake
    cycle = _Cycle(piston, process, getattr(burn, "start_deg", 0.0))
    burning = combustion(cycle.charge, burn)
    heat = _heat(cycle, burning, goal)
    corners, laws = [cycle.closes], []
    for end, law in cycle.pieces(burning, heat):
        if end > corners[-1]:
            corners.append(end)
            laws.append(law)
    imep = cycle.imep(burning, heat)
    return GasCycle(np.array(corners), tuple(laws), heat, imep, (piston, process, burn, goal))


# ---------------------------------------------------------------- what is wrong
def find_cycle_mistakes(
    piston: GasPiston, process: Process, burn: Burn, goal: Goal
) -> Iterator[GasError]:
    """All that is wrong with a cycle before it is computed."""
    p = process
    if goal.name not in burn.goals:
        *most, last = burn.goals
        kind = type(burn).__name__.lower()
        hint = f"give {', '.join(most)} or {last}"
        yield GasError(goal.name, f"does not make the {kind} cycle: {hint}")
    if not p.compression_ratio > 1:
        yield GasError("compression_ratio", f"is {p.compression_ratio:g}: give more than 1")
    if not p.intake > 0:
        yield GasError("intake", f"is {p.intake / 1e5:g} bar: give more, for it is compressed")
    if not p.compression_index >= 1:
        yield GasError("compression_index", f"is {p.compression_index:g}: give 1 or more")
    if not p.expansion_index > 1:
        yield GasError("expansion_index", f"is {p.expansion_index:g}: give more than 1")
    valves = list(_wrong_valves(piston, p))
    yield from valves
    if isinstance(burn, Wiebe) and not valves:
        yield from _wrong_burn(piston, p, burn)


def _wrong_valves(piston: GasPiston, process: Process) -> Iterator[GasError]:
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


def _wrong_burn(piston: GasPiston, process: Process, burn: Wiebe) -> Iterator[GasError]:
    if not burn.shape >= 0:
        yield GasError("burn_shape", f"is {burn.shape:g}: give 0 or more")
    if not burn.duration_deg > 0:
        yield GasError("burn_duration", f"is {burn.duration_deg:g}°: give more than 0°")
        return
    opens, closes = (math.degrees(angle) for angle in _valves(piston, process))
    end = burn.start_deg + burn.duration_deg
    if end > opens:
        yield GasError(
            "burn_duration",
            f"a burn over {burn.duration_deg:g}° from {burn.start_deg:g}° ends at {end:g}°, past "
            f"{opens:g}°, where the exhaust opens",
        )
    if burn.start_deg <= closes:
        yield GasError(
            "burn_start", f"is {burn.start_deg:g}°, before {closes:g}°, where compression begins"
        )


# ---------------------------------------------------------------- what is known before the heat
def _valves(piston: GasPiston, process: Process) -> tuple[float, float]:
    """Cycle angles (rad) at which the exhaust opens, and at which, before the firing dead centre,
    compression begins.
    """
    opens_deg, closes_deg = process.exhaust_opens_deg, process.intake_closes_deg
    opens = piston.bottom if opens_deg is None else math.radians(opens_deg)
    if process.strokes == 2:
        down = float(piston.travel(np.array(opens)))
        return opens, piston.angle_of(down, upward=True) - 2 * math.pi
    closes = piston.bottom - 2 * math.pi if closes_deg is None else math.radians(closes_deg - 720)
    return opens, closes


class _Cycle:
    """A cycle without its heat."""

    def __init__(self, piston: GasPiston, process: Process, start_deg: float) -> None:
        self.piston, self.process = piston, process
        self.opens, self.closes = _valves(piston, process)
        begins = min(math.radians(start_deg), 0.0)
        closed, charge, opened = map(self._volume, (self.closes, begins, self.opens))
        self.compression = process.intake * closed**process.compression_index
        self.begins = begins
        self.charge = Charge(
            pressure=self.compression / charge**process.compression_index,
            volume=charge,
            exponent=process.expansion_index,
            final=opened,
            piston=piston,
            volume_at=self.volume_at,
        )
        self.fixed_work = self._compression_work(closed) + self._pumping_work(closed)

    def volume_at(self, angle: Array) -> Array:
        """Volume (m3) at cycle angles."""
        return self.piston.volume(angle, self.process.compression_ratio)

    def _volume(self, angle: float) -> float:
        return float(self.volume_at(np.array(angle)))

    def imep(self, burning: Combustion, heat: float) -> float:
        """Indicated mean effective pressure with this heat, Pa."""
        n, c = self.charge.exponent, self.charge
        gained = burning.after(heat)[0] * c.final ** (1 - n) - c.pressure * c.volume
        work = burning.released * heat - gained / (n - 1)
        return (self.fixed_work + work) / self.piston.swept

    def imep_rate(self, burning: Combustion, heat: float) -> float:
        """Its derivative by the heat, Pa/J."""
        n, c = self.charge.exponent, self.charge
        gained = burning.after(heat)[1] * c.final ** (1 - n)
        return (burning.released - gained / (n - 1)) / self.piston.swept

    def pieces(self, burning: Combustion, heat: float) -> list[PressureLaw]:
        """The laws of pressure from the begin of compression on; some may be of no length."""
        p, period = self.process, self.process.strokes * math.pi
        expansion = polytrope(self.volume_at, burning.after(heat)[0], p.expansion_index)
        compression = polytrope(self.volume_at, self.compression, p.compression_index)
        opened = [PressureLaw(2 * math.pi, constant(p.exhaust))] if p.strokes == 4 else []
        return [
            PressureLaw(self.begins, compression),
            *burning.pieces(heat),
            PressureLaw(self.opens, expansion),
            *opened,
            PressureLaw(self.closes + period, constant(p.intake)),
        ]

    def _compression_work(self, closed: float) -> float:
        """From the intake to the charge, J: negative. -p V (y^(n-1) - 1)/(n - 1), y = V/V'."""
        over = self.process.compression_index - 1
        steps = math.log(closed / self.charge.volume)
        grown = math.expm1(over * steps) / over if over else steps
        return -self.process.intake * closed * grown

    def _pumping_work(self, closed: float) -> float:
        """While the valves are open, J; the ports of a two-stroke close at the same volume."""
        p, clearance = self.process, self.piston.clearance(self.process.compression_ratio)
        if p.strokes == 2:
            return 0.0
        return p.intake * (closed - clearance) - p.exhaust * (self.charge.final - clearance)


# ---------------------------------------------------------------- the heat
def _heat(cycle: _Cycle, burning: Combustion, goal: Goal) -> float:
    """Heat (J) with which the cycle has what is asked for."""
    if goal.name == "imep":
        return _heat_for_imep(cycle, burning, goal.value)
    heat = goal.value if goal.name == "heat" else burning.heat_for(goal.value)
    if heat < burning.least:
        least = 1 if goal.name == "cut_off" else burning.least
        raise GasError(goal.name, f"is {goal.value:g}: this cycle needs {least:.4g} or more")
    if heat > burning.most:
        most = cycle.charge.final / cycle.charge.volume
        most = most if goal.name == "cut_off" else burning.most
        raise GasError(
            goal.name,
            f"is {goal.value:g}: with more than {most:.4g} the exhaust opens during the burn",
        )
    return heat


def _heat_for_imep(cycle: _Cycle, burning: Combustion, imep: float) -> float:
    """By Newton's method from the least heat on: imep is concave in it, no step leads too far."""
    heat = burning.least
    lowest = cycle.imep(burning, heat)
    if imep < lowest:
        raise GasError(
            "imep",
            f"is {imep / 1e5:g} bar: with the least heat the cycle has {lowest / 1e5:.4g} bar",
        )
    highest = cycle.imep(burning, burning.most) if burning.most < math.inf else math.inf
    if imep > highest or cycle.imep_rate(burning, heat) <= 0:
        raise GasError(
            "imep",
            f"is {imep / 1e5:g} bar: with the most heat the cycle has {highest / 1e5:.4g} bar",
        )
    for _ in range(100):
        step = (imep - cycle.imep(burning, heat)) / cycle.imep_rate(burning, heat)
        heat += step
        if step <= 1e-15 * heat:
            break
    return heat

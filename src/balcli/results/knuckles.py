"""Knuckle angles that make strokes, or dead centres, of articulated rods even."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ..core.mechanisms.articulated import Articulated
from ..core.phasors import Array, unit
from ..core.strokes import Travel, find_travel
from ..engine.build import build
from ..engine.layout import plan_cylinders
from ..enginefile.model import EngineFile
from ..errors import BalcliError
from ..sizing.remedy import Remedy
from ..sizing.schemes import KNUCKLES
from .balance import Balance, analyze_both

Goal = Literal["dead-centres", "strokes"]
GOALS: tuple[Goal, ...] = ("dead-centres", "strokes")
_STEP_DEG = 1e-3  # for the slope
_STAYS_DEG = 1e-9  # what a pin is turned by less is rounding
_FARTHEST_DEG = 30.0  # a knuckle pin that would have to move farther is no answer
_CLOSE = {"dead-centres": 1e-9, "strokes": 1e-12}  # degrees; metres


@dataclass(frozen=True)
class Knuckles:
    """Knuckle angles that make an engine even.

    Attributes:
        model: the engine file with the new `articulation.knuckle_angles`.
        angles_deg: the angle of each bank's knuckle pin.
        before, after: strokes and dead centres of all cylinders.
        reasons: what was done, and for which banks nothing can be.
    """

    goal: Goal
    model: EngineFile
    angles_deg: tuple[float, ...]
    before: Travel
    after: Travel
    reasons: tuple[str, ...]


def even_knuckles(model: EngineFile, goal: Goal = "dead-centres") -> Knuckles:
    """Turn each knuckle pin about the crank pin, at the radius of the file, until its cylinders are
    even.

    "dead-centres": every articulated piston is at the top when the crank pin stands as the master
    piston's did; "strokes": every stroke is the master piston's. Both at once would need a radius
    for each pin too. A bank of several rows is set by the first of them. Banks that no angle within
    30 degrees makes even keep theirs.

    Raises:
        BalcliError: the engine has no articulated rods.
        InputError: it cannot be built.
    """
    engine = build(model)
    c, linkage = engine.cylinders, engine.cylinders.linkage
    if model.articulation is not None and model.layout.rotary:
        raise BalcliError(
            "knuckles: this engine is rotary; even knuckle angles are looked for where the crank "
            "turns only"
        )
    if model.articulation is None or not isinstance(linkage, Articulated):
        raise BalcliError(
            "knuckles: this engine has no articulated rods; an engine file says so with "
            "[articulation]"
        )
    masters, close = linkage.master, _CLOSE[goal]
    hung = masters != np.arange(c.count)

    def measure(found: Travel) -> Array:
        """Return how far each cylinder is from its master, degrees or metres."""
        values = found.top_deg if goal == "dead-centres" else found.stroke
        return np.where(hung, values - values[masters], 0.0)

    def find_error(turn_deg: Array) -> Array:
        turned = replace(linkage, knuckle=linkage.knuckle * unit(turn_deg))
        return measure(find_travel(replace(c, linkage=turned)))

    turn_deg = _solve(find_error, c.count)
    done = np.abs(find_error(turn_deg)) <= close
    rows = _find_first_rows(model, engine.numbers)
    old_deg = np.degrees(np.angle(linkage.knuckle[rows]))
    new_deg = (old_deg + np.where(done, turn_deg, 0.0)[rows]) % 360
    angles_deg = tuple(map(float, np.where(hung[rows], new_deg, 0.0)))
    better = model.with_table("articulation", knuckle_angles=angles_deg)
    after = find_travel(build(better).cylinders)
    reasons = _explain(goal, hung[rows], done[rows], turn_deg[rows])
    uneven = np.abs(measure(after)) > 10 * close
    uneven[rows] = False  # of these the reasons list the banks
    if others := sorted(engine.numbers[row] for row in np.flatnonzero(uneven)):
        told = f"cylinder{'s' * (len(others) > 1)} {', '.join(map(str, others))}"
        alike = "the knuckle pins of a bank turn alike, as its first throw asks"
        reasons = (*reasons, f"not so {told}: {alike}")
    return Knuckles(goal, better, angles_deg, find_travel(c), after, reasons)


def balance_knuckles(
    model: EngineFile,
    goal: Goal = "dead-centres",
    orders: Iterable[float] | None = None,
    speed_rpm: float | None = None,
) -> Balance:
    """Even knuckles as a remedy, and the engine before and after, at the speed of the file or
    another.

    Raises as `even_knuckles` does.
    """
    found = even_knuckles(model, goal)
    remedy = Remedy(
        KNUCKLES,
        reasons=found.reasons,
        details={
            "even": goal,
            "knuckle_angles_deg": list(found.angles_deg),
            "stroke_mm": _find_range(1e3 * found.after.stroke),
            "top_deg": _find_range(found.after.top_deg),
        },
        knuckle_angles_deg=found.angles_deg,
    )
    old, new = build(model), build(found.model)
    if speed_rpm is not None:
        old, new = replace(old, speed_rpm=speed_rpm), replace(new, speed_rpm=speed_rpm)
    before, after = analyze_both(old, new, orders)
    return Balance(remedy, before, after, every_order=orders is not None)


def _find_range(values: Array) -> dict[str, float]:
    return {"least": float(values.min()), "largest": float(values.max())}


def _solve(find_error: Callable[[Array], Array], count: int) -> Array:
    """Return the turn of each cylinder's knuckle pin, degrees, at which its error vanishes if it
    can: Newton's method, for all at once.
    """
    turn_deg = np.zeros(count)
    for _ in range(20):
        rise = find_error(turn_deg + _STEP_DEG) - find_error(turn_deg - _STEP_DEG)
        slope = rise / (2 * _STEP_DEG)
        move = -find_error(turn_deg) / np.where(slope, slope, 1.0)
        turn_deg = np.clip(turn_deg + np.clip(move, -5, 5), -_FARTHEST_DEG, _FARTHEST_DEG)
        if np.max(np.abs(move)) < 1e-12:
            break
    return turn_deg


def _find_first_rows(model: EngineFile, numbers: tuple[int, ...]) -> list[int]:
    """Row of the first cylinder of each bank."""
    cells = plan_cylinders(model.crank, model.layout).cells
    first = {cell.bank: cell.number for cell in sorted(cells, key=lambda cell: -cell.throw)}
    return [numbers.index(first[bank]) for bank in sorted(first)]


def _explain(
    goal: Goal, hung: NDArray[np.bool_], done: NDArray[np.bool_], turn_deg: Array
) -> tuple[str, ...]:
    """What was done, and for which banks nothing can be; all arrays by banks."""
    result = "strokes equal to the master's"
    if goal == "dead-centres":
        result = "top dead centres as even as the master's"
    largest = float(np.abs(np.where(hung & done, turn_deg, 0)).max(initial=0.0))
    turned = f"turned by up to {largest:.3g} deg" if largest > _STAYS_DEG else "stay where they are"
    reasons = [f"knuckle pins {turned}: {result}"]
    if left := [str(bank + 1) for bank in np.flatnonzero(hung & ~done)]:
        reasons.append(
            f"no angle makes bank {', '.join(left)} even: the knuckle pin stays where it is"
        )
    return tuple(reasons)

"""Knuckle angles that make the strokes, or the dead centres, of an engine with articulated rods
even.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ..core.cylinders import Cylinders
from ..core.mechanisms.articulated import Articulated
from ..core.phasors import Array, unit
from ..core.strokes import Travel, find_travel
from ..engine.build import build
from ..engine.layout import plan_cylinders
from ..enginefile.model import EngineFile
from ..errors import BalcliError
from ..sizing.schemes import KNUCKLES
from ..sizing.sizing import Remedy
from .analysis import QUANTITIES, analyze
from .balance import Balance

Goal = Literal["dead-centres", "strokes"]
GOALS: tuple[Goal, ...] = ("dead-centres", "strokes")
_STEP = 1e-3  # degrees, for the slope
_FAR = 30.0  # degrees: a knuckle pin that would have to move farther is no answer
_CLOSE = {"dead-centres": 1e-9, "strokes": 1e-12}  # degrees; metres


@dataclass(frozen=True)
class Knuckles:
    """What was found.

    Attributes:
        file: the engine file with the new `articulation.knuckle_angles`.
        angles_deg: the angle of each bank's knuckle pin.
        before, after: strokes and dead centres of all cylinders.
        reasons: what was done, and for which banks nothing can be.
    """

    goal: Goal
    file: EngineFile
    angles_deg: tuple[float, ...]
    before: Travel
    after: Travel
    reasons: tuple[str, ...]


def even_knuckles(file: EngineFile, goal: Goal = "dead-centres") -> Knuckles:
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
    engine = build(file)
    c, linkage = engine.cylinders, engine.cylinders.linkage
    if file.articulation is not None and file.layout.rotary:
        raise BalcliError(
            "knuckles: this engine is rotary; even knuckle angles are looked for where the crank "
            "turns only"
        )
    if file.articulation is None or not isinstance(linkage, Articulated):
        raise BalcliError(
            "knuckles: this engine has no articulated rods; an engine file says so with "
            "[articulation]"
        )
    hung = linkage.master != np.arange(c.count)
    turn, done = _solved(
        lambda angle: np.where(hung, _error(_turned(c, linkage, angle), linkage, goal), 0.0),
        c.count,
        _CLOSE[goal],
    )
    rows = _first_rows(file, engine.numbers)
    angles = np.degrees(np.angle(linkage.knuckle[rows])) + np.where(done, turn, 0.0)[rows]
    angles = np.where(hung[rows], angles % 360, 0.0)
    found = tuple(map(float, angles))
    table = file.articulation.model_copy(update={"knuckle_angles": found})
    better = file.model_copy(update={"articulation": table})
    return Knuckles(
        goal,
        better,
        found,
        find_travel(c),
        find_travel(build(better).cylinders),
        _reasons(goal, hung[rows], done[rows], turn[rows]),
    )


def balanced(
    file: EngineFile,
    goal: Goal = "dead-centres",
    orders: Iterable[float] | None = None,
    speed_rpm: Any = None,
) -> Balance:
    """The same as a scheme of `balance`: the engine before and after, at the speed of the file or
    another.

    Raises as `even_knuckles` does.
    """
    found = even_knuckles(file, goal)
    details = {
        "even": goal,
        "knuckle_angles_deg": list(found.angles_deg),
        "stroke_mm": _range(found.after.stroke * 1e3),
        "top_deg": _range(found.after.top_deg),
    }
    shown = set(QUANTITIES) - {"sizing"}
    old, new = (
        build(f) if speed_rpm is None else replace(build(f), speed_rpm=speed_rpm)
        for f in (file, found.file)
    )
    before = analyze(old, orders, shown)
    after = analyze(new, before.orders, shown)
    return Balance(Remedy(KNUCKLES, reasons=found.reasons, details=details), before, after, ())


def _range(values: Array) -> dict[str, float]:
    return {"least": float(values.min()), "largest": float(values.max())}


def _turned(c: Cylinders, linkage: Articulated, angle_deg: Array) -> Travel:
    turned = replace(linkage, knuckle=linkage.knuckle * unit(angle_deg))
    return find_travel(replace(c, linkage=turned))


def _error(found: Travel, linkage: Articulated, goal: Goal) -> Array:
    """How far each cylinder is from its master: degrees or metres."""
    values = found.top_deg if goal == "dead-centres" else found.stroke
    return np.asarray(values - values[linkage.master])


def _solved(
    error: Callable[[Array], Array], count: int, close: float
) -> tuple[Array, NDArray[np.bool_]]:
    """Newton's method, for all cylinders at once; and where it has arrived."""
    angle = np.zeros(count)
    for _ in range(20):
        here = error(angle)
        slope = (error(angle + _STEP) - error(angle - _STEP)) / (2 * _STEP)
        move = -here / np.where(slope, slope, 1.0)
        angle = np.clip(angle + np.clip(move, -5, 5), -_FAR, _FAR)
        if np.max(np.abs(move)) < 1e-12:
            break
    return angle, np.abs(error(angle)) <= close


def _first_rows(file: EngineFile, numbers: tuple[int, ...]) -> list[int]:
    """Row of the first cylinder of each bank."""
    cells = plan_cylinders(file.crank, file.layout).cells
    first = {c.bank: c.number for c in sorted(cells, key=lambda c: -c.throw)}
    return [numbers.index(first[bank]) for bank in sorted(first)]


def _reasons(
    goal: Goal, hung: NDArray[np.bool_], done: NDArray[np.bool_], turn: Array
) -> tuple[str, ...]:
    what = (
        "top dead centres as even as the master's"
        if goal == "dead-centres"
        else "strokes equal to the master's"
    )
    largest = float(np.abs(np.where(hung & done, turn, 0)).max(initial=0.0))
    told = [f"knuckle pins turned by up to {largest:.3g} deg: {what}"]
    if left := [str(bank + 1) for bank in np.flatnonzero(hung & ~done)]:
        told.append(
            f"no angle makes bank {', '.join(left)} even: the knuckle pin stays where it is"
        )
    return tuple(told)

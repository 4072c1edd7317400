"""Search over the bank angle of a vee or the splay of its pins."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ...core.phasors import Array
from ...engine.layout import plan_cylinders
from ...enginefile.model import EngineFile
from ...errors import BalcliError
from ...forces.quantity import Quantity
from .angles import STEP, Curve, Span, find_minima
from .designs import Found, build_candidates, evaluate_candidates, find_buildable, rank_candidates
from .even_firing import find_even_angles
from .objective import Objective
from .task import Task

Angle = Literal["bank_angle", "splay"]
SPANS: dict[str, Span] = {"bank_angle": Span(0.0, 180.0), "splay": Span(-180.0, 180.0)}
_LOCK_STEP = 5.0  # deg: bank angles at which it is first tried whether the mechanism locks


def find_locked(model: EngineFile, what: str) -> tuple[tuple[float, float], ...]:
    """From where to where a bank angle leaves articulated rods that cannot follow, deg, to
    `angles.STEP`; nothing of what else is searched over.
    """
    if what != "bank_angle" or model.articulation is None or model.layout.bank_angle is None:
        return ()
    grid = SPANS[what].divide(_LOCK_STEP)
    there = find_buildable(model, what, grid)
    runs = np.split(np.arange(len(grid)), np.flatnonzero(np.diff(there)) + 1)
    return tuple(
        (_find_lock(model, grid, run[0], -1), _find_lock(model, grid, run[-1], 1))
        for run in runs
        if not there[run[0]]
    )


def _find_lock(model: EngineFile, grid: Array, row: np.intp, side: int) -> float:
    """How far a locked bank angle of the grid may go to a side and stay locked, deg."""
    locked = float(grid[row])
    if not 0 <= row + side < len(grid):
        return locked
    free = float(grid[row + side])
    while abs(free - locked) > STEP:
        middle = (free + locked) / 2
        if find_buildable(model, "bank_angle", np.array([middle]))[0]:
            free = middle
        else:
            locked = middle
    return locked


def search_angle(key: Angle, task: Task) -> Iterator[Found]:
    """Over an angle of the engine file."""
    span = SPANS[key]
    model, objective = task.model, task.objective
    check_angle(model, key)
    even = find_even_angles(model, key, span) if task.even_firing else None
    angles = _find_best_angles(key, task) if even is None else even
    return rank_candidates(model, {key: angles}, objective)


def check_angle(model: EngineFile, key: Angle) -> None:
    """Nothing, unless the engine has no such angle, or its crank follows from it."""
    name = key.replace("_", " ")
    one_bank = plan_cylinders(model.crank, model.layout).banks < 2
    if one_bank or (key == "bank_angle" and model.layout.bank_angle is None):
        raise BalcliError(
            f"there is no {name} to look for: the engine is no vee (give layout.bank_angle)"
        )
    if model.crank.throws is None and model.layout.firing_order is not None:
        raise BalcliError(
            f"the crank follows from the firing order, which fits no other {name}: give "
            "crank.throws, so that the crank stays as it is"
        )


def _find_best_angles(key: Angle, task: Task) -> Array:
    """All local minima of the objective where the limits are kept and nothing locks, deg."""
    model, objective = task.model, task.objective

    def can_be(angles: Array) -> NDArray[np.bool_]:
        there = np.ones(len(angles), bool)
        if model.articulation is not None:
            for low, high in task.locked:
                there &= (angles < low) | (angles > high)
            there[there] = find_buildable(model, key, angles[there])
        return there

    def draw(weights: Mapping[Quantity, float]) -> Curve:
        """A weighted sum over the angle."""
        alone = Objective(dict(weights), {})

        def evaluate(angles: Array) -> Array:
            there = can_be(angles)
            values = np.full(len(angles), np.inf)
            if there.any():
                engine = build_candidates(model, {key: angles[there]})
                values[there] = evaluate_candidates(engine, alone, int(there.sum()))[1]
            return values

        return evaluate

    limits = [(draw({q: 1.0}), limit) for q, limit in objective.limits.items()]
    highest = max(q.order for q in objective.quantities)
    return find_minima(draw(objective.weights), limits, SPANS[key], highest)

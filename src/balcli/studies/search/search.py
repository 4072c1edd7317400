"""Best arrangements of an engine: throws along the crank, firing order, bank angle, splay; or the
best value of any number of its file.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from itertools import islice
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...core.phasors import Array
from ...core.telling import Tell, tell_nobody
from ...engine.build import Engine, assemble, build
from ...engine.layout import cycle_deg, plan_cylinders
from ...engine.vary import vary_engine
from ...enginefile.fields import nearest
from ...enginefile.model import EngineFile
from ...errors import BalcliError
from ...forces.orders import merge_orders
from ...forces.quantity import Quantity, refuse_unknown
from ...forces.textbook import TextbookUnits, find_textbook_units
from ...result import Result
from ..parameters import parse as parse_parameter
from ..quantities import AnyQuantity, choose_of_engine, refuse_unknown_of_chapters
from .angles import STEP, Curve, Span, find_minima
from .designs import (
    Design,
    Found,
    build_candidates,
    drop_firing_order,
    evaluate_engine,
    find_buildable,
    rank_candidates,
)
from .even_firing import find_even_angles, fires_evenly
from .firing_orders import Slots
from .mirror_images import drop_mirror_images
from .objective import Objective, choose_sums
from .one_by_one import list_numbers, list_throws, rank_one_by_one
from .throws import count_from, find_best_throws

Angle = Literal["bank_angle", "splay"]
What = Literal["throws", "firing_order", "bank_angle", "splay"]
SPANS: dict[str, Span] = {"bank_angle": Span(0.0, 180.0), "splay": Span(-180.0, 180.0)}
_LOCK_STEP = 5.0  # deg: bank angles at which it is first tried whether the mechanism locks
NEAR_AN_END = 1e-4  # of a range: as close as a minimum is found
IMAGES = 8  # candidates kept for each that is asked for, as many are mirror images


@dataclass(frozen=True, repr=False)
class Search(Result):
    """The best arrangements of an engine file, best first.

    Attributes:
        over: what was arranged.
        scale: what textbooks measure its forces and moments by.
        locked: from where to where (deg, to STEP) the mechanism locks, so that no angle there was a
            candidate.
        ends: of the range in which a number of the file was searched for; None for anything else.
    """

    model: EngineFile
    over: str
    objective: Objective[AnyQuantity]
    results: tuple[Found, ...]
    scale: TextbookUnits
    locked: tuple[tuple[float, float], ...] = ()
    ends: tuple[float, float] | None = None

    @property
    def best_at_end(self) -> bool:
        """Whether the best value is an end of the range, beyond which there may be a better one."""
        design = self.results[0].design
        if self.ends is None or design.number is None:
            return False
        low, high = self.ends
        value, near = design.number[1], NEAR_AN_END * (high - low)
        return bool(min(abs(value - low), abs(value - high)) <= near)

    @property
    def summary(self) -> str:
        """Over what, and how many were found."""
        found = f"{len(self.results)} result{'s' * (len(self.results) != 1)}"
        return f"over {self.over} of {self.model.name or 'an engine'}: {found}"

    @property
    def of_engine(self) -> tuple[Quantity, ...]:
        """Those quantities of its objective that are of forces and moments."""
        return choose_of_engine(self.objective.quantities)

    def engine(self, rank: int = 1) -> Engine:
        """The engine with the arrangement of this rank, the best being 1. A firing order that its
        throws no longer fit is left out.

        Raises:
            IndexError: so many were not found.
        """
        if not 1 <= rank <= len(self.results):
            raise IndexError(f"rank {rank}: there are {len(self.results)}, from 1")
        return vary_engine(build(self.model), self.results[rank - 1].design.changes())


class _Task(NamedTuple):
    """What to search in, by what, for how many, and whether they have to fire evenly; where the
    mechanism locks.
    """

    model: EngineFile
    objective: Objective[Quantity]
    wanted: int
    even_firing: bool
    locked: tuple[tuple[float, float], ...]
    tell: Tell


def search_arrangements(
    model: EngineFile,
    over: str,
    objective: Objective[AnyQuantity],
    count: int = 10,
    even_firing: bool = False,
    tell: Tell = tell_nobody,
) -> Search:
    """The best arrangements, mirror images and rotations once.

    Args:
        over: throws (permutes those of the file, or those that its firing order asks for),
            firing_order (all even ones; cranks follow where the file gives no throws), bank_angle
            (of a vee), splay; or a number of the file and its range, `mount.left.loss=0.05:0.3`.
        count: at most so many.
        even_firing: only arrangements that can fire evenly.
        tell: of what takes long: `throws.find_best_throws`, and designs one by one.

    Raises:
        BalcliError: an engine that has nothing to arrange, or no arrangement that keeps the limits,
        a moment of an engine whose file does not say where its throws stand.
    """
    engine = build(model)
    refuse_unknown(engine, choose_of_engine(objective.quantities))
    refuse_unknown_of_chapters(model, objective.quantities)
    key, is_number, _ = over.partition("=")
    what = None if is_number else _parse_over(over)
    sums = choose_sums(objective)
    locked: tuple[tuple[float, float], ...] = ()
    ends = None
    fires_at_will = model.gas is None and model.crank.throws is not None and what != "firing_order"
    base = drop_firing_order(model) if fires_at_will or what == "throws" else model
    if what is None:
        key, ends = _read_range(model, over)
        designs = list_numbers(base, partial(_design_number, key), *ends, objective, tell)
        candidates = rank_one_by_one(base, designs, objective, tell_nobody)
    elif sums is None:
        designs = _list_designs(model, what, objective, even_firing, tell)
        candidates = rank_one_by_one(base, designs, objective, tell)
    else:
        locked = _find_locked(model, what)
        candidates = _SEARCHES[what](_Task(model, sums, count, even_firing, locked, tell))
    found = tuple(islice(drop_mirror_images(candidates, model), count))
    if not found:
        also = " and fires evenly" if even_firing else ""
        named = key if is_number else key.replace("_", " ")
        raise BalcliError(f"no {named} keeps these limits{also}")
    orders = merge_orders(q.order for q in choose_of_engine(objective.quantities))
    scale = find_textbook_units(engine, orders)
    return Search(model, key, objective, found, scale, locked, ends)


def _read_range(model: EngineFile, over: str) -> tuple[str, tuple[float, float]]:
    """Dotted name of a number of the file and the ends of its range: `mount.left.loss=0.1:0.4`.

    Raises:
        BalcliError: what is no number and range.
    """
    path, _, ends = over.partition("=")
    if ends.count(":") != 1:
        raise BalcliError(
            f'--over "{over}": give the ends of a range, such as {path}=from:to; balcli sweep '
            "takes steps and lists"
        )
    number = parse_parameter(f"{path}={ends.replace(':', ',')}", model)
    return number.path, (float(number.values.min()), float(number.values.max()))


def _list_designs(
    model: EngineFile,
    what: What,
    objective: Objective[AnyQuantity],
    even_firing: bool,
    tell: Tell,
) -> Iterator[Design]:
    """What there is to arrange, for figures that take each arrangement by itself."""
    if what == "firing_order":
        slots, cranks = _find_slots(model)
        return (
            Design(firing_order=order, throws=tuple(throws))
            for throws in cranks.tolist()
            for order in slots.find_orders(throws)
        )
    if what == "throws":
        designs = list_throws(_give_throws(model))
        return (one for one in designs if not even_firing or _fires_evenly(model, one))
    _check_angle(model, what)
    even = find_even_angles(model, what, SPANS[what]) if even_firing else None
    if even is not None:
        return (_design_angle(what, angle) for angle in even.tolist())
    low, high = SPANS[what].low, SPANS[what].high
    return list_numbers(model, partial(_design_angle, what), low, high, objective, tell)


def _design_number(path: str, value: float) -> Design:
    return Design(number=(path, value))


def _design_angle(key: Angle, angle: float) -> Design:
    return Design(bank_angle=angle) if key == "bank_angle" else Design(splay=angle)


def _fires_evenly(model: EngineFile, design: Design) -> bool:
    engine = build_candidates(model, {"throws": np.array([design.throws])})
    return bool(fires_evenly(engine, model)[0])


def _parse_over(text: str) -> What:
    for what in _SEARCHES:
        if what == text:
            return what
    near = nearest(text, tuple(_SEARCHES))
    raise BalcliError(
        f'--over "{text}": choose from '
        f"{', '.join(_SEARCHES)}, or give a number of the file with its range, such as "
        f"mount.left.loss=0.05:0.3{f'; did you mean {near}?' if near else ''}"
    )


# ------------------------------------------------------------------ the four searches
def _search_throws(task: _Task) -> Iterator[Found]:
    model, objective = _give_throws(task.model), task.objective
    if peaks := [q.name for q in objective.quantities if q.part == "peak"]:
        raise BalcliError(
            f"a search over throws adds up orders, which {peaks[0]} does not allow; name orders, "
            "such as force.1.major"
        )

    def can_fire(throws: Array) -> NDArray[np.bool_]:
        return fires_evenly(build_candidates(model, {"throws": throws}), model)

    allowed = can_fire if task.even_firing else None
    throws = find_best_throws(model, objective, IMAGES * task.wanted, allowed, task.tell)
    if len(throws):
        throws = count_from(throws[:, :1], throws)
    return rank_candidates(model, {"throws": throws}, objective)


def _give_throws(model: EngineFile) -> EngineFile:
    """The same with the throws that its firing order asks for, where it gives none.

    Raises:
        BalcliError: the crank has one throw.
    """
    if model.crank.throws is None and model.layout.firing_order:
        found = assemble(model).throws_deg
        throws = [float(found[throw]) for throw in range(len(found))]
        crank = model.crank.model_copy(update={"throws": throws})
        model = model.model_copy(update={"crank": crank})
    if len(model.crank.throws or ()) < 2:
        raise BalcliError(
            "there is nothing to permute: the crank has one throw; give crank.throws, or a "
            "layout.firing_order they follow from"
        )
    return model


def _find_slots(model: EngineFile) -> tuple[Slots, Array]:
    """The firings of a cycle, and the cranks with even firing orders, shape (cranks, throws), deg,
    cylinder 1's throw at 0.

    Raises:
        BalcliError: cylinders with throws of their own; there is no even firing order.
    """
    layout = plan_cylinders(model.crank, model.layout)
    top_deg = assemble(model).tops_deg
    if any(own.throw is not None for own in model.cylinder.values()):
        raise BalcliError(
            "cylinders with throws of their own leave no firing order to look for: give "
            "crank.throws and splay alone"
        )
    at_throw = {
        cell.number: float(top_deg[cell.number]) - cell.bank * model.crank.splay
        for cell in layout.cells
    }
    sense = -1 if model.layout.rotary else 1
    slots = Slots(layout.cells, at_throw, cycle_deg(model.layout), sense)
    possible = [model.crank.throws] if model.crank.throws else slots.find_cranks()
    if not possible or next(slots.find_orders(possible[0]), None) is None:
        raise BalcliError("these throws allow no even firing order")
    throws = np.array(possible)
    return slots, count_from(throws[:, :1], throws)


def _search_firing_order(task: _Task) -> Iterator[Found]:
    model = task.model
    slots, from_first = _find_slots(model)
    return (
        one._replace(design=one.design._replace(firing_order=order))
        for one in rank_candidates(model, {"throws": from_first}, task.objective)
        for order in slots.find_orders(one.design.throws or ())
    )


def _find_locked(model: EngineFile, what: What) -> tuple[tuple[float, float], ...]:
    """From where to where a bank angle leaves articulated rods that cannot follow, deg, to STEP."""
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
    """How far a locked bank angle of the grid may go to a side and stay locked, deg, to STEP."""
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


def _search_angle(key: Angle, task: _Task) -> Iterator[Found]:
    """Over an angle of the engine file."""
    span = SPANS[key]
    model, objective = task.model, task.objective
    _check_angle(model, key)
    even = find_even_angles(model, key, span) if task.even_firing else None
    angles = _find_best_angles(key, task) if even is None else even
    return rank_candidates(model, {key: angles}, objective)


def _check_angle(model: EngineFile, key: Angle) -> None:
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


def _find_best_angles(key: Angle, task: _Task) -> Array:
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
                values[there] = evaluate_engine(engine, alone, int(there.sum()))[1]
            return values

        return evaluate

    limits = [(draw({q: 1.0}), limit) for q, limit in objective.limits.items()]
    highest = max(q.order for q in objective.quantities)
    return find_minima(draw(objective.weights), limits, SPANS[key], highest)


_SEARCHES: dict[What, Callable[[_Task], Iterator[Found]]] = {
    "throws": _search_throws,
    "firing_order": _search_firing_order,
    "bank_angle": partial(_search_angle, "bank_angle"),
    "splay": partial(_search_angle, "splay"),
}

"""Best arrangements of an engine: throws along the crank, firing order, bank angle, splay; or the
best value of any number of its file.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from itertools import islice
from typing import Literal

import numpy as np

from ...core.telling import Tell, tell_nobody
from ...engine.build import Engine, build
from ...engine.load import parse_dict
from ...engine.vary import vary_engine
from ...enginefile.fields import nearest
from ...enginefile.model import EngineFile
from ...enginefile.plain_tables import change_tables
from ...errors import BalcliError, check_type
from ...forces.orders import merge_orders
from ...forces.quantity import Quantity, refuse_unknown
from ...forces.textbook import TextbookUnits, find_textbook_units
from ...result import Result
from ..parameters import Parameter, find_numbers, parse_parameter
from ..quantities import AnyQuantity, choose_of_engine, refuse_unknown_of_chapters
from .angles import Span
from .designs import Design, Found, drop_firing_order
from .even_firing import find_even_angles, fires_evenly
from .mirror_images import drop_mirror_images
from .objective import Objective, choose_sums
from .one_by_one import BestNumbers, find_best_designs, list_throws, rank_one_by_one
from .over_angle import SPANS, check_angle, find_locked, search_angle
from .over_firing_order import find_slots, search_firing_order
from .over_throws import give_throws, search_throws
from .task import Task

What = Literal["throws", "firing_order", "bank_angle", "splay"]
NEAR_AN_END = 1e-4  # of a range: as close as a minimum is found


@dataclass(frozen=True, repr=False)
class Search(Result):
    """The best arrangements of an engine file, best first.

    Attributes:
        model: the engine file.
        over: what was arranged.
        objective: what was made small, and its limits.
        results: best first, each with its `design`, the value of its `objective` and its `figures`.
        scale: what textbooks measure its forces and moments by.
        locked: from where to where (deg, to `angles.STEP`) the mechanism locks, so that no angle
            there was a candidate.
        ends: of the range in which a number of the file was searched for; None for anything else.
        constant: whether that number changes nothing of the objective.
        refused: a value of that range that makes no engine, and why; empty if all do.
    """

    model: EngineFile
    over: str
    objective: Objective[AnyQuantity]
    results: tuple[Found, ...]
    scale: TextbookUnits
    locked: tuple[tuple[float, float], ...] = ()
    ends: tuple[float, float] | None = None
    constant: bool = False
    refused: str = ""

    @property
    def best_at_end(self) -> bool:
        """Whether the best value is an end of the range, beyond which there may be a better one,
        and not as far as its number goes at all.
        """
        design = self.results[0].design
        if self.ends is None or design.number is None or self.constant:
            return False
        low, high = self.ends
        (path, value), near = design.number, NEAR_AN_END * (high - low)
        number = find_numbers(self.model).get(path)
        last = () if number is None else (number.least, number.most)
        return any(abs(value - end) <= near for end in self.ends if end not in last)

    def find_unit(self, key: str) -> str:
        """That of an angle, and of a number of the file by its dotted name; else empty."""
        if key in ("bank_angle", "splay"):
            return "deg"
        number = find_numbers(self.model).get(key)
        return "" if number is None else number.dimension.unit

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
            TypeError: the rank is no whole number.
        """
        check_type("rank", rank, (int, np.integer), "give a whole number from 1")
        if not 1 <= rank <= len(self.results):
            raise IndexError(f"rank {rank}: there are {len(self.results)}, from 1")
        return vary_engine(build(self.model), self.results[rank - 1].design.changes())


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
    ends, constant, refused = None, False, ""
    fires_at_will = model.gas is None and model.crank.throws is not None and what != "firing_order"
    base = drop_firing_order(model) if fires_at_will or what == "throws" else model
    if what is None:
        number = read_range(model, over)
        key, ends = number.path, (float(number.values.min()), float(number.values.max()))
        best = _find_best(base, key, Span(*ends), objective, even_firing, tell)
        constant, refused = best.constant, best.refused
        candidates = rank_one_by_one(base, best.designs, objective, tell_nobody)
    elif sums is None:
        designs = _list_designs(model, base, what, objective, even_firing, tell)
        candidates = rank_one_by_one(base, designs, objective, tell)
    else:
        locked = find_locked(model, what)
        candidates = _SEARCHES[what](Task(model, sums, count, even_firing, locked, tell))
    found = tuple(islice(drop_mirror_images(candidates, model), count))
    if not found:
        wanted = ["keep these limits"] * bool(objective.limits) + ["fire evenly"] * even_firing
        named = key if is_number else key.replace("_", " ")
        raise BalcliError(f"no {named} can {' and '.join(wanted or ['be computed'])}")
    orders = merge_orders(q.order for q in choose_of_engine(objective.quantities))
    scale = find_textbook_units(engine, orders)
    return Search(model, key, objective, found, scale, locked, ends, constant, refused)


def read_range(model: EngineFile, over: str) -> Parameter:
    """A number of the file and the ends of its range: `mount.left.loss=0.1:0.4`.

    Raises:
        BalcliError: what is no number and range.
    """
    path, _, ends = over.partition("=")
    if ends.count(":") != 1:
        raise BalcliError(
            f'--over "{over}": give the ends of a range, such as {path}=from:to; balcli sweep '
            "takes steps and lists"
        )
    return parse_parameter(f"{path}={ends.replace(':', ',')}", model)


def _list_designs(
    model: EngineFile,
    free: EngineFile,
    what: What,
    objective: Objective[AnyQuantity],
    even_firing: bool,
    tell: Tell,
) -> Iterator[Design]:
    """What there is to arrange in a file, for figures that take each arrangement by itself; `free`
    is the file with what may be changed for it.
    """
    if what == "firing_order":
        slots, cranks = find_slots(model)
        return (
            Design(firing_order=order, throws=tuple(throws))
            for throws in cranks.tolist()
            for order in slots.find_orders(throws)
        )
    if what == "throws":
        designs = list_throws(give_throws(model))
        return (one for one in designs if not even_firing or _fires_evenly(free, one))
    check_angle(model, what)
    return iter(_find_best(free, what, SPANS[what], objective, even_firing, tell).designs)


def _find_best(
    model: EngineFile,
    key: str,
    span: Span,
    objective: Objective[AnyQuantity],
    even_firing: bool,
    tell: Tell,
) -> BestNumbers:
    """Designs with the best values of a number of the file (bank_angle, splay, or its dotted name)
    in a span; of those with which the cylinders fire evenly, if that is asked for.
    """
    even = find_even_angles(model, key, span) if even_firing and _moves_dead_centres(key) else None
    if even is not None:
        return BestNumbers([_name_design(key, value) for value in even.tolist()], False, "")
    ends = span.low, span.high
    best = find_best_designs(model, partial(_name_design, key), *ends, objective, tell)
    found = best.designs
    if key in SPANS and span.ring:
        first, last = (_name_design(key, end) for end in ends)
        found = [*dict.fromkeys(last if one == first else one for one in found)]
    kept = [one for one in found if not even_firing or _fires_evenly(model, one)]
    return best._replace(designs=kept)


def _name_design(key: str, value: float) -> Design:
    if key == "bank_angle":
        return Design(bank_angle=value)
    return Design(splay=value) if key == "splay" else Design(number=(key, value))


def _moves_dead_centres(key: str) -> bool:
    """Whether it is an angle of the crank or of cylinders."""
    if key.startswith("cylinder."):
        return key.endswith((".throw", ".bank"))
    return key in SPANS or key.startswith(("crank.throws.", "crank.splay", "layout.bank"))


def _fires_evenly(model: EngineFile, design: Design) -> bool:
    changed = parse_dict(change_tables(model, design.changes()), model.folder)
    return bool(fires_evenly(build(changed), changed).all())


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


_SEARCHES: dict[What, Callable[[Task], Iterator[Found]]] = {
    "throws": search_throws,
    "firing_order": search_firing_order,
    "bank_angle": partial(search_angle, "bank_angle"),
    "splay": partial(search_angle, "splay"),
}

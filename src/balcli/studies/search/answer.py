"""Search for the best arrangements of an engine (`search`): the sequence of the throw angles, the
firing order, or values of numbers of its file.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from types import NoneType
from typing import Annotated, Literal

import numpy as np

from ...core.phases import TURN
from ...core.records import HIDDEN, WrittenAs
from ...engine.build import build
from ...engine.engine import Engine, check_engine, refuse_geared, take_model
from ...engine.layout import plan_cylinders
from ...engine.load import vary_engine
from ...errors import ArgumentError, BalcliError, InputError, check_type, wrong_type
from ...file.assumed import Assumed
from ...file.fields import counted, suggest_nearest
from ...file.model import EngineFile
from ...limits import MOST_FOUND
from ...process import Tell, tell_nobody
from ...shell.arguments import Words, check_count, join_names
from ...show.figures import name_engine
from ...show.result import Result
from ..parameters import Parameter, find_numbers, parse_parameter
from ..quantities import choose_of_engine, list_assumed, refuse_unknown
from .designs import (
    PATHS,
    Found,
    NumbersJudge,
    Objective,
    drop_firing_order,
    drop_mirror_images,
    list_changes,
    parse_objective,
    rank_designs,
)
from .firing_orders import search_firing_order
from .local import Box, Effort, find_local_optima
from .throws import search_throws

ARRANGED = ("throws", "firing_order")
_ARRANGED = {"crank.throws", "layout.firing_intervals"}  # numbers that searches over ARRANGED vary
ANGLES = {"bank_angle": (0.0, 180.0), "splay": (-180.0, 180.0)}  # searched ranges, deg
NEAR_AN_END = 1e-4  # a value closer to an end than this share of the range counts as the end
_ROUNDING = 1e-13  # objectives that differ by less than this ratio are equal
_GRID = 720
_SPREAD = 2048  # number of candidates for one number, and for several
_SLOW = 32  # number of candidates for each number if quantities are no sums over the cylinders


@dataclass(frozen=True, kw_only=True, repr=False)
class Search(Result):
    """The best arrangements of an engine file, best first.

    Attributes:
        model: The engine file.
        assumed: Values assumed because the engine file leaves them out.
        over: Searched keys: `throws`, `firing_order`, or numbers separated by commas.
        results: Arrangements, best first.
        objective: Quantities with their weights and limits.
        ranges: Searched numbers with the ends of their ranges, ascending, by the keys that the user
            wrote.
        constant: Whether the searched numbers have no effect on the objective.
        refused: Message with an example of values for which the engine is impossible; empty if
            there are none.
        even_firing: Whether only arrangements that can fire evenly were considered.
        start: Engine that was searched; None: the engine of `model`.
    """

    format: Literal["balcli.search/1"] = "balcli.search/1"
    model: Annotated[EngineFile, WrittenAs(name_engine, "engine")]
    assumed: tuple[Assumed, ...] | None = None
    over: str
    results: tuple[Found, ...]
    objective: Annotated[Objective, HIDDEN]
    ranges: Annotated[Mapping[str, Parameter], HIDDEN]
    constant: Annotated[bool, HIDDEN] = False
    refused: Annotated[str, HIDDEN] = ""
    even_firing: Annotated[bool, HIDDEN] = False
    start: Annotated[Engine | None, HIDDEN] = None

    @property
    def at_ends(self) -> tuple[str, ...]:
        """Numbers whose best value is an end of their range, so that a better value may lie
        outside.
        """
        if self.constant:
            return ()
        numbers = find_numbers(self.model)
        best = self.results[0].design
        return tuple(
            key
            for key, number in self.ranges.items()
            if key not in ANGLES
            for end in number.values.tolist()
            if end not in (numbers[key].least, numbers[key].most)
            if abs(best[key] - end) <= NEAR_AN_END * np.ptp(number.values)
        )

    @property
    def summary(self) -> str:
        """Searched keys, and the number of results."""
        found = counted(len(self.results), "result")
        return f"over {self.over} of {self.model.name or 'an engine'}: {found}"

    def engine(self, rank: int = 1) -> Engine:
        """Return the engine with the arrangement of this rank; rank 1 is the best. A firing order
        that no longer fits the throws is removed.

        Raises:
            IndexError: There are fewer arrangements.
            TypeError: The rank is not a whole number.
        """
        check_type("rank", rank, (int, np.integer), "give a whole number from 1")
        if not 1 <= rank <= len(self.results):
            raise IndexError(f"rank {rank}: there are {len(self.results)} results, from 1")
        start = build(self.model) if self.start is None else self.start
        return vary_engine(start, list_changes(self.results[rank - 1].design))


def search_arrangements(
    model: EngineFile,
    over: str | Sequence[str],
    objective: Objective,
    count: int = 10,
    even_firing: bool = False,
    tell: Tell = tell_nobody,
) -> Search:
    """Return the best arrangements; equivalent mirror images and rotations appear once.

    Args:
        over: `throws` (permutes the throw angles of the file, or those that its firing order
            needs); or `firing_order` (tries all even firing orders and, if the file gives no
            throws, all cranks that allow them); or one or several of `bank_angle` (of a vee),
            `splay`, and numbers of the file with ranges, such as `mount.left.loss=0.05:0.3`.
        count: Largest number of arrangements.
        even_firing: Whether only arrangements that can fire evenly are considered.
        tell: Called with the share of the work done so far; if it returns True, a search over
            throws or firing orders stops.

    Raises:
        BalcliError: The engine has nothing to arrange, no arrangement satisfies the limits, or a
            moment is requested and the file does not give the positions of the throws.
    """
    refuse_geared(model)
    wanted = [over] if isinstance(over, str) else list(over)
    refuse_unknown(model, build(model), objective.quantities)
    ranges = read_ranges(model, wanted)
    named = ", ".join(ranges) or wanted[0]
    varied = {number.path for number in ranges.values()} or _ARRANGED
    constant = False
    refused = ""
    if ranges:
        candidates, constant, refused = _search_numbers(model, ranges, objective, even_firing, tell)
    elif named == "throws":
        candidates = search_throws(model, objective, count, even_firing, tell)
    else:
        candidates = search_firing_order(model, objective, tell)
    arrangements = tuple(islice(drop_mirror_images(candidates, model), count))
    if not arrangements:
        limits = []
        if objective.limits:
            limits.append("keep these limits")
        if even_firing:
            limits.append("fire evenly")
        words = named if "." in named else named.replace("_", " ")
        raise BalcliError(f"no {words} can {' and '.join(limits or ['make an engine'])}")
    return Search(
        model=model,
        assumed=list_assumed(model, objective.quantities, varied),
        over=named,
        results=arrangements,
        objective=objective,
        ranges=ranges,
        constant=constant,
        refused=refused,
        even_firing=even_firing,
    )


# ------------------------------------------------------------------ numbers
def read_ranges(model: EngineFile, over: Sequence[str]) -> dict[str, Parameter]:
    """Return the searched numbers with the ends of their ranges, by the keys that the user wrote;
    empty for throws and firing orders.

    Raises:
        BalcliError: A name is unknown or a range wrong, keys cannot be combined, or a number is
            given twice.
    """
    arranged = [text for text in over if text in ARRANGED]
    if arranged and len(over) == 1:
        return {}
    if arranged:
        other = next((text for text in over if text != arranged[0]), arranged[0])
        raise ArgumentError(
            "{over} {first} cannot be combined with another {over} ({other}); only numbers and "
            "angles can be searched together",
            first=arranged[0],
            other=other,
        )
    ranges: dict[str, Parameter] = {}
    for text in over:
        number = _read_range(model, text)
        if number.path in [other.path for other in ranges.values()]:
            raise ArgumentError("{over} {path} is given twice; give one range", path=number.path)
        ranges[text if text in ANGLES else number.path] = number
    return ranges


def _read_range(model: EngineFile, text: str) -> Parameter:
    if text in ANGLES:
        _check_angle(model, text)
        return Parameter(PATHS[text], np.array(ANGLES[text]), "deg")
    path, is_number, ends = text.partition("=")
    if not is_number:
        ranged = "or give a number of the file with its range, such as mount.left.loss=0.05:0.3"
        known = (*ARRANGED, *ANGLES)
        hint = suggest_nearest(text, known, f"choose from {', '.join(known)}, {ranged}")
        raise ArgumentError('{over} "{text}": {hint}', text=text, hint=hint)
    if ends.count(":") != 1:
        raise ArgumentError(
            '{over} "{text}": give the ends of a range, such as {path}=from:to; balcli sweep takes '
            "steps and lists",
            text=text,
            path=path,
        )
    number = parse_parameter(f"{path}={ends.replace(':', ',')}", model)
    return replace(number, values=np.sort(number.values))


def _check_angle(model: EngineFile, key: str) -> None:
    """Raise BalcliError if the engine has no such angle, or if its crank depends on the angle."""
    name = key.replace("_", " ")
    plan = plan_cylinders(model)
    if plan.banks < 2 or (key == "bank_angle" and model.layout.bank_angle is None):
        raise BalcliError(
            f"there is no {name} to search: the engine is not a vee (give layout.bank_angle)"
        )
    has_crank_of_order = model.crank.throws is None and model.layout.firing_order is not None
    if has_crank_of_order and plan.throws > 1:
        raise BalcliError(
            f"the crank follows from the firing order, which fits no other {name}: give "
            "crank.throws, so that the crank stays as it is"
        )


def _search_numbers(
    model: EngineFile,
    ranges: Mapping[str, Parameter],
    objective: Objective,
    even_firing: bool,
    tell: Tell,
) -> tuple[Iterator[Found], bool, str]:
    """Return the local optima over some numbers, best first; whether the numbers have no effect;
    and a message with an example of values for which the engine is impossible.

    Raises:
        InputError: The engine is impossible with all tried values.
    """
    if model.gas is None and model.crank.throws is not None:
        model = drop_firing_order(model)
    numbers = ranges.values()
    low, high = np.transpose([number.values for number in numbers])
    turns = [number.unit == "deg" and np.ptp(number.values) == TURN for number in numbers]
    box = Box(low, high, np.array(turns))
    effort = _choose_effort(box, objective)
    if even_firing:  # a slightly worse but rounder angle may fire exactly evenly
        effort = replace(effort, as_good=1e-9)
    total = effort.count_evaluations(box.size)
    paths = [number.path for number in numbers]
    judge = NumbersJudge(model, paths, objective, even_firing, lambda n: tell(min(n / total, 1.0)))
    optima = find_local_optima(judge, box, effort)
    refused = judge.refused
    if refused is not None and not np.isfinite(optima.costs).any():
        raise InputError(refused.problems)
    designs = [dict(zip(ranges, place, strict=True)) for place in optima.places.tolist()]
    designs_found: Iterator[Found] = iter(())
    if designs:
        designs_found = rank_designs(designs, judge.evaluate(optima.places), objective)
    same = np.ptp(optima.costs) <= _ROUNDING * np.abs(optima.costs).max()
    why = "" if refused is None else f"{refused.file}: {refused.problems[0]}"
    return designs_found, bool(not why and same and np.all(low < high)), why


def _choose_effort(box: Box, objective: Objective) -> Effort:
    """Return the effort of the search, which is smaller if quantities are no sums over the
    cylinders.
    """
    if not objective.is_sum_over_cylinders:
        if box.size == 1:
            return Effort(_SLOW, 3, 1e-10, steps=5)
        return Effort(2 * _SLOW * box.size, 3, 1e-8, same=1e-2, steps=5)
    if box.size > 1:
        return Effort(_SPREAD, 24, 1e-15)
    highest = max(q.order for q in choose_of_engine(objective.quantities))
    return Effort(max(_GRID, 16 * (math.ceil(highest) + 1)), _GRID, 1e-13)


def search(
    engine: Engine,
    over: Words,
    minimise: Words | Mapping[str, float] | None = None,
    *,
    maximise: Words | Mapping[str, float] | None = None,
    limit: Mapping[str, float] | None = None,
    require: Literal["even-firing"] | None = None,
    top: int = 10,
) -> Search:
    """Find the best crank, firing order, bank angle, splay or values of any numbers of an engine.
    Equivalent mirror images and rotations appear once.

    Args:
        engine: Engine, from `load`.
        over: What to vary: the sequence of the file's throw angles along the crank ("throws"), its
            "firing_order", its "bank_angle" or the "splay" of its split pins; or a number of the
            file with a range ("mount.left.loss=0.05:0.3"). Angles and numbers in a list are
            searched together.
        minimise: Quantity to minimise (`moment.1.major`), several quantities, which are added up,
            or a dict of weights by quantity.
        maximise: Quantities to maximise, in the same form; give exactly one of `minimise` and
            `maximise`.
        limit: Upper limits by quantity, in SI units.
        require: "even-firing": only arrangements with even firing intervals are considered.
        top: Largest number of results, at most 1000.

    Returns:
        The arrangements, best first: `result.results[0]` has `design`, `objective` and
        `quantities`; `result.engine(1)` is the engine with the best arrangement.

    Raises:
        BalcliError: There is nothing to arrange, no arrangement satisfies the limits, or a quantity
            is unknown.
        TypeError: An argument has the wrong type.

    Example:
        >>> search(engine, "throws", "moment.1.major").to_pandas()
    """
    model = take_model(check_engine("search", engine))
    if not isinstance(over, (str, list, tuple)):
        raise wrong_type("search", over, 'give what to arrange, such as "throws"')
    texts = (join_names("search", over) or "").split(",")
    bounds = {} if limit is None else limit
    check_type("search", bounds, Mapping, 'give a dict, such as {"moment.2.major": 100}')
    check_type("require", require, (str, NoneType), 'give "even-firing"')
    if require not in (None, "even-firing"):
        raise ArgumentError('{require} {other!r}: give "even-firing"', other=require)
    kept = [f"{name}<{bound}" for name, bound in bounds.items()]
    objective = parse_objective(
        _join_goal(minimise), kept, maximise=_join_goal(maximise), with_gas=model.gas is not None
    )
    count = check_count("top", top, most=MOST_FOUND)
    found = search_arrangements(model, texts, objective, count, require is not None)
    return replace(found, start=engine)


def _join_goal(goal: Words | Mapping[str, float] | None) -> str | None:
    """Return quantities with weights as one text, as on the command line; None for None."""
    if isinstance(goal, Mapping):
        return ",".join(f"{name}={weight}" for name, weight in goal.items())
    return join_names("search", goal)

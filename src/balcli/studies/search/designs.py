"""Define the arrangements (designs) of a search and its objective, a weighted sum of quantities
with limits; compute quantities and costs of candidates; write engine files with a design.

Candidates are computed together if the quantities are sums over the cylinders, or if the variants
of all varied figures can be joined (`Evaluator.computes_jointly`); otherwise one by one.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from itertools import islice
from typing import Annotated, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from ...core.phases import TURN
from ...core.phasors import Array, Figure
from ...core.records import INLINE
from ...engine.build import build
from ...engine.engine import Engine, take_model
from ...engine.figures import ranked
from ...engine.layout import TOLERANCE_DEG, cycle_deg, plan_cylinders
from ...engine.load import vary_engine
from ...engine.parse import parse, parse_dict
from ...engine.parts import Parts
from ...errors import Argument, ArgumentError, BalcliError, InputError
from ...file.edit import set_keys
from ...file.model import EngineFile
from ...file.plain_tables import change_tables
from ...file.units import Dimension, convert
from ...forces.kinds import GAS_KINDS
from ...forces.quantity import Quantity
from ...limits import MOST_DESIGNS_ONE_BY_ONE
from ...process import Tell
from ..parameters import find_numbers, resolve_name, tell_variant
from ..quantities import AnyQuantity, Evaluator, parse_quantities

# A design: the values that differ from the file, by a key of PATHS or the dotted name of a number.
# Throws (deg) and firing orders are lists.
Design: TypeAlias = Mapping[str, Any]
PATHS = {
    "throws": "crank.throws",
    "firing_order": "layout.firing_order",
    "bank_angle": "layout.bank_angle",
    "splay": "crank.splay",
}
NOTE = "found by balcli"
SAME = 1e-9  # largest relative difference of the objectives of mirror images


@dataclass(frozen=True)
class Found:
    """One arrangement that a search found.

    Attributes:
        design: Values by searched key, such as `throws`, `firing_order`, `bank_angle` or the dotted
            name of a number.
        objective: Value of the objective.
        quantities: Value of each quantity by its name.
    """

    design: Annotated[Design, INLINE]
    objective: float
    quantities: Mapping[str, float]


def list_paths(model: EngineFile, over: Iterable[str]) -> list[str]:
    """Return the dotted names of what a search varies.

    Args:
        model: Engine file.
        over: Arrangements (`throws`), and numbers with a range (`rod.length=150:170`).
    """
    known = find_numbers(model)
    names = [text.partition("=")[0].strip() for text in over]
    return [PATHS.get(name) or resolve_name(name, known) for name in names]


def list_changes(design: Design) -> dict[str, object]:
    """Return the values of a design by dotted file keys, as arguments for `Engine.vary`."""
    changed = {PATHS.get(key, key): value for key, value in design.items()}
    if "firing_order" in design:
        changed["layout.firing_intervals"] = None
    return changed


def drop_mirror_images(arrangements: Iterable[Found], model: EngineFile) -> Iterator[Found]:
    """Yield the arrangements, except mirror images of earlier ones: the same crank seen from the
    other end or turning the other way, with the same objective.
    """
    cells = plan_cylinders(model).cells
    numbers = {(cell.bank, cell.throw): cell.number for cell in cells}
    last = max(cell.throw for cell in cells)
    other_end = {c.number: numbers.get((c.bank, last - c.throw), c.number) for c in cells}
    strokes = Parts(model).strokes
    masses = model.crank.throw_masses
    alike = all(strokes[number] == strokes[other] for number, other in other_end.items())
    alike = alike and masses == masses[::-1]
    seen: dict[tuple[float, ...], float] = {}
    for arrangement in arrangements:
        images = list(_find_images(arrangement.design, other_end if alike else {}))
        cost = arrangement.objective
        earlier = [seen[image] for image in images if image in seen]
        if not any(abs(value - cost) <= SAME * abs(cost) for value in earlier):
            yield arrangement
        seen |= dict.fromkeys(images, cost)


def _find_images(design: Design, other_end: Mapping[int, int]) -> Iterator[tuple[float, ...]]:
    """Yield a firing order or throws, and their mirror images: seen from the other end of the
    crank, turning the other way, and both.

    Args:
        design: Arrangement.
        other_end: For each cylinder, the one that takes its position if the crank is seen from the
            other end; empty if strokes or masses of the throws differ when seen from there.
    """
    if (order := design.get("firing_order")) is not None:
        for row in (order, [other_end.get(number, number) for number in order]):
            start = row.index(min(row))
            turned = row[start:] + row[:start]
            yield tuple(turned)
            yield (turned[0], *reversed(turned[1:]))
    elif (throws := design.get("throws")) is not None:
        for angles in (throws, throws[::-1] if other_end else throws):
            for sign in (1, -1):
                from_first = ((sign * (angle - angles[0])) % 360.0 for angle in angles)
                yield tuple(round(angle, 6) % 360.0 for angle in from_first)


def write_design(text: bytes, design: Design, name: str = "") -> str:
    """Return the text of an engine file with the values of a design. Comments are kept; a firing
    order that does not fit the design is removed.

    Args:
        text: Text of the file.
        design: Throws, a firing order or angles.
        name: Path of the engine file; files that it refers to are in the same folder.

    Raises:
        BalcliError: The firing order does not fit but is needed, or a key is not in PATHS.
    """
    if any(key not in PATHS for key in design):
        settings = ", ".join(f"{path} = {best:.9g}" for path, best in design.items())
        raise ArgumentError(
            "{write} takes throws, firing orders and angles; edit the file: {settings}",
            settings=settings,
        )
    new = text.decode("utf-8-sig")
    changes = list_changes(design)
    try:
        engine = vary_engine(build(parse(new, name)), changes)
    except InputError:
        raise ArgumentError(
            "{write}: the firing order of the file does not fit the result, and [gas] needs a "
            "firing order: search with {over} firing_order, or leave [gas] out"
        ) from None
    if take_model(engine).layout.firing_order is None:
        changes |= {"layout.firing_order": None, "layout.firing_intervals": None}
    for path, value in changes.items():
        table, _, last = path.partition(".")
        new = set_keys(new, table, {last: value}, NOTE)
    return new


BROKEN = 1e200  # cost above those of all candidates that satisfy the limits
_SIGNED = ("mean", "min")  # endings of quantities that may be negative


@dataclass(frozen=True)
class Objective:
    """Weights and upper limits (SI) by quantity, and whether the sum is maximised."""

    weights: Mapping[AnyQuantity, float]
    limits: Mapping[AnyQuantity, float]
    maximise: bool = False

    @property
    def quantities(self) -> tuple[AnyQuantity, ...]:
        """All quantities of the sum and of the limits, without repetition."""
        return tuple(dict.fromkeys((*self.weights, *self.limits)))

    @property
    def is_sum_over_cylinders(self) -> bool:
        """Whether all quantities belong to forces or moments by inertia alone, which are sums of
        contributions of the cylinders.
        """
        return all(isinstance(q, Quantity) and q.kind not in GAS_KINDS for q in self.quantities)

    def add_up(self, value: Callable[[AnyQuantity], Figure]) -> Figure:
        """Return the weighted sum; `value` returns the value of a quantity."""
        return sum(weight * value(q) for q, weight in self.weights.items())

    def judge(self, values: Mapping[AnyQuantity, Array]) -> Array:
        """Return the costs of candidates, shape (candidates,), from their quantities, each of this
        shape. The cost is the weighted sum, or minus the sum if it is maximised. If a limit is
        broken, the cost is BROKEN times the largest ratio of a quantity to its limit.
        """
        total = np.asarray(self.add_up(values.__getitem__), float)
        excess = np.zeros_like(total)
        for q, limit in self.limits.items():
            share = values[q] / limit
            excess = np.where(share < 1, excess, np.maximum(excess, share))
        return np.where(excess > 0, BROKEN * excess, -total if self.maximise else total)


def parse_objective(
    minimise: str | None,
    limits: Sequence[str] = (),
    *,
    maximise: str | None = None,
    with_gas: bool = False,
) -> Objective:
    """Return the objective that texts state: a sum such as `moment.1.major=1,force.2.major=0.5`,
    and limits such as `moment.2.major<100`.

    Args:
        minimise: Weighted sum to minimise.
        limits: Upper limits of quantities.
        maximise: Weighted sum to maximise; exactly one of the two sums is given.
        with_gas: Whether the engine has gas.

    Raises:
        BalcliError: A quantity is unknown, a weight or limit is wrong, or quantities have different
            units and one of these quantities has no weight.
    """
    if (minimise is None) == (maximise is None):
        raise ArgumentError("give exactly one of {minimise} and {maximise}")
    terms = [term.partition("=") for term in (maximise or minimise or "").split(",")]
    weights: dict[AnyQuantity, float] = {}
    for name, _, weight in terms:
        share = _parse_positive(weight, f"{name}={weight}") if weight else 1.0
        weights |= dict.fromkeys(_parse_sizes(name, with_gas), share)
    if not all(weight for *_, weight in terms):
        _refuse_several_units(weights, "maximise" if maximise else "minimise")
    bounds: dict[AnyQuantity, float] = {}
    for text in limits:
        name, less, bound = text.partition("<")
        if not less:
            raise ArgumentError(
                '{limit} "{text}": give a quantity and its upper limit, such as '
                '"moment.2.major<100"',
                text=text,
            )
        limited = _parse_sizes(name, with_gas)
        bounds |= dict.fromkeys(limited, _parse_positive(bound, text, limited[0].unit))
    return Objective(weights, bounds, maximise is not None)


def _refuse_several_units(quantities: Iterable[AnyQuantity], argument: str) -> None:
    """Raise ArgumentError if quantities to be added have different units."""
    units = {q.name: q.unit or "1" for q in quantities}
    first, *others = dict.fromkeys(units.values())
    if others:
        weights = (f"{name}={1 if unit == first else 8}" for name, unit in units.items())
        raise ArgumentError(
            "{argument} adds up {units}; give weights, such as {weights}",
            argument=Argument(argument),
            units=" and ".join([first, *others]),
            weights=",".join(weights),
        )


def _parse_sizes(name: str, with_gas: bool) -> tuple[AnyQuantity, ...]:
    """Return the quantities of these names; raise BalcliError if one is no magnitude."""
    sizes = parse_quantities(name, with_gas=with_gas)
    for q in sizes:
        if isinstance(q, Quantity) and (q.signed or q.part == "axis"):
            raise BalcliError(
                f"{q.name} has a sign or a direction; name a magnitude such as "
                f"{q.kind}.{q.order:g}.major"
            )
        if q.part in _SIGNED:
            size = f"{q.name.rpartition('.')[0]}.max"
            raise BalcliError(f"{q.name} may be negative; name a quantity such as {size}")
    return sizes


def _parse_positive(text: str, whole: str, unit: str = "") -> float:
    """Return the positive number in a text, converted to `unit`; bare numbers are in this unit.

    Args:
        text: Number, or a figure with a unit such as `60 N/mm^2`.
        whole: Text that contains it, for messages.
        unit: Unit of the result.
    """
    number = math.nan
    for read in (float, lambda each: convert(each, Dimension(unit.replace("·", " "), "a limit"))):
        with suppress(ValueError):
            number = read(text)
            break
    if not 0 < number < math.inf:
        raise BalcliError(f'"{whole}": {text.strip() or "nothing"} is not a positive number')
    return number


AT_ONCE = 256  # largest number of candidates that are built as one engine
_EVEN_DEG = 1e-9  # firings with a smaller deviation count as even


@dataclass
class NumbersJudge:
    """Function that returns the costs of an engine for different values of numbers of its file.

    Attributes:
        model: Engine file.
        paths: Dotted names of the numbers.
        objective: Objective of the search.
        even_firing: Whether the cylinders have to fire evenly.
        tell: Called with the number of candidates computed so far.
        refused: Error of the first candidate whose engine is impossible; its attribute `file` has
            the candidate's values. None if there is no such candidate.
    """

    model: EngineFile
    paths: Sequence[str]
    objective: Objective
    even_firing: bool
    tell: Tell
    refused: InputError | None = None
    _count: int = 0

    @cached_property
    def _evaluator(self) -> Evaluator:
        return Evaluator(self.model, self.objective.quantities)

    def __call__(self, points: Array) -> Array:
        """Return the costs of points, shape (points, numbers); infinite for points with an
        impossible engine.
        """
        size = self._at_once
        parts = [self._judge(points[k : k + size]) for k in range(0, len(points), size)]
        return np.concatenate([np.empty(0), *parts])

    @cached_property
    def _at_once(self) -> int:
        """Number of points that are computed together."""
        if self.objective.is_sum_over_cylinders:
            return AT_ONCE
        joint = self._evaluator.computes_jointly(self.paths, self.paths)
        return AT_ONCE if joint else 1

    def _judge(self, points: Array) -> Array:
        columns = dict(zip(self.paths, points.T, strict=True))
        try:
            engine = self._evaluator.build(columns, 1) if self.even_firing else None
            costs = self.objective.judge(self.evaluate(points, engine))
            if engine is not None:
                uneven = find_unevenness(engine, self.model)
                missed = np.where(uneven > _EVEN_DEG, BROKEN * (1 + uneven), -np.inf)
                costs = np.maximum(costs, missed)
        except InputError as error:
            if len(points) > 1:
                return np.concatenate([self._judge(half) for half in np.array_split(points, 2)])
            figures = {path: column.item() for path, column in columns.items()}
            self.refused = self.refused or InputError(error.problems, tell_variant(figures))
            costs = np.array([np.inf])
        self._count += len(points)
        self.tell(self._count)
        return costs

    def evaluate(self, points: Array, engine: Engine | None = None) -> dict[AnyQuantity, Array]:
        """Return the values of each quantity, shape (points,).

        Args:
            points: Values of the numbers, shape (points, numbers).
            engine: All points as one engine, if it is built already.

        Raises:
            InputError: The engine of a point is impossible.
        """
        columns = dict(zip(self.paths, points.T, strict=True))
        return self._evaluator.evaluate(columns, (len(points),), engine)


def find_unevenness(engine: Engine, model: EngineFile) -> Array:
    """Return the largest deviation of top dead centres from even intervals, deg, shape
    (candidates,).
    """
    c = engine.cylinders
    # shift of top dead centre by an offset (eps: offset, lam: crank radius, both over rod length);
    # for articulated rods, `Pins.tops_deg` contains the shift
    late = 0.0 if model.articulation else np.degrees(np.arcsin(c.eps / (1 + c.lam)))
    own = {} if model.gas is not None else model.cylinder  # without [gas], gas = 0 marks a dummy
    firing = [row for row, n in enumerate(engine.numbers) if n not in own or own[n].gas != 0]
    tops = np.asarray(c.axis_of_each_deg + late - c.pin_deg)[firing]
    tops = tops - tops[0]
    count = len(tops)
    ready = np.sort(np.mod(tops + TOLERANCE_DEG, TURN), axis=0) - TOLERANCE_DEG
    slots = np.sort(np.mod(cycle_deg(model.layout) * np.arange(count) / count, TURN))
    return np.asarray(np.abs(ready - slots.reshape(-1, *(1,) * (ready.ndim - 1))).max(axis=0))


def fires_evenly(engine: Engine, model: EngineFile) -> NDArray[np.bool_]:
    """Return whether the cylinders fire evenly within TOLERANCE_DEG, shape (candidates,)."""
    return np.asarray(find_unevenness(engine, model) <= TOLERANCE_DEG)


def drop_firing_order(model: EngineFile) -> EngineFile:
    """Return the file without firing order and with explicit throws, so that any throws can be
    tried.
    """
    throws = model.crank.throws or (0.0,) * plan_cylinders(model).throws
    model = model.with_table("crank", throws=throws)
    return model.with_table("layout", firing_order=None, firing_intervals=None)


def name_throws(throws: Array) -> dict[str, Array]:
    """Return throws (deg, shape (candidates, throws)) as figures of the file by dotted name."""
    return {f"crank.throws.{n}": column for n, column in enumerate(throws.T, 1)}


def rank_throws(model: EngineFile, throws: Array, objective: Objective) -> Iterator[Found]:
    """Yield the throws that satisfy the limits, best first, with the quantities of the whole
    engine.
    """
    if not len(throws):
        return
    found = Evaluator(model, objective.quantities).evaluate(name_throws(throws), throws.shape[:1])
    yield from rank_designs([{"throws": row} for row in throws.tolist()], found, objective)


def rank_designs(
    designs: Sequence[Design], values: Mapping[AnyQuantity, Array], objective: Objective
) -> Iterator[Found]:
    """Yield the designs that satisfy the limits, best first, with their quantities.

    Args:
        designs: Arrangements.
        values: Values of each quantity, shape (designs,).
        objective: Objective of the search.
    """
    costs = objective.judge(values)
    for k in np.argsort(ranked(costs), kind="stable"):
        if costs[k] < BROKEN:
            figures = {q.name: float(value[k]) for q, value in values.items()}
            total = -costs[k] if objective.maximise else costs[k]
            yield Found(designs[k], float(total), figures)


def rank_one_by_one(
    model: EngineFile, designs: Iterable[Design], objective: Objective, tell: Tell
) -> Iterator[Found]:
    """Return the designs that satisfy the limits, best first, computed one by one.

    Args:
        model: Engine file.
        designs: Arrangements.
        objective: Objective of the search.
        tell: Called with the share of the work done so far; it returns whether to stop.

    Raises:
        BalcliError: There are more than MOST_DESIGNS_ONE_BY_ONE designs.
    """
    every = list(islice(designs, MOST_DESIGNS_ONE_BY_ONE + 1))
    refuse_many(len(every))
    rows: list[dict[AnyQuantity, Array]] = []
    for k, design in enumerate(every, 1):
        changed = parse_dict(change_tables(model, list_changes(design)), model.folder)
        rows.append(Evaluator(changed, objective.quantities).evaluate({}, (1,)))
        if tell(k / len(every)):
            break
    values = {q: np.ravel([row[q] for row in rows]) for q in objective.quantities}
    return rank_designs(every[: len(rows)], values, objective)


def refuse_many(count: int) -> None:
    """Raise BalcliError for more arrangements than can be computed one by one."""
    if count > MOST_DESIGNS_ONE_BY_ONE:
        raise BalcliError(
            f"more than {MOST_DESIGNS_ONE_BY_ONE} arrangements, too many to compute one by one; "
            "give crank.throws, or search by inertia forces or moments such as moment.1.major"
        )

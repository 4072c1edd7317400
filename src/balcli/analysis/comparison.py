"""Compare engines side by side: `compare`, its result, and the tables that show it."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import chain
from math import nan
from typing import TYPE_CHECKING, Annotated, Literal, NamedTuple

from ..core.phasors import Array, Phasors
from ..core.records import HIDDEN
from ..engine.engine import Engine, check_engine
from ..errors import BalcliError, list_words
from ..file.assumed import Assumed, join_assumed
from ..file.fields import order_number
from ..forces.kinds import EVERY_KIND, FREE, GAS, MOMENT, Kind
from ..forces.spectrum import merge_orders
from ..limits import SMALL
from ..show.engine_facts import tell_speed
from ..show.formats import Renderer, Rows, name_cell
from ..show.result import Result
from ..show.sheet import (
    NEGLIGIBLE,
    UNKNOWN,
    Column,
    Facts,
    Grid,
    Sheet,
    Text,
    assumed_facts,
    capitalized,
    number,
    order_name,
    size_cell,
)
from ..sizing.ladder import Ladder
from .answer import UNASKED, Analysis, analyze
from .ladder_show import ladder_grid, list_ladder
from .sections import list_loads

if TYPE_CHECKING:
    from ..forces.guide import GuideMoments
    from ..show.units import ShownUnit, System


GUIDES = (
    Kind("guide_h", "H-type guide moment", "M_H", "guide_h_Nm"),
    Kind("guide_x", "X-type guide moment", "M_X", "guide_x_Nm"),
)
LEFT = {
    kind: kind._replace(
        name=f"{kind.name} with devices",
        label=f"{kind.label} with the devices of scheme auto",
        key=f"with_devices_{kind.key}",
    )
    for kind in FREE
}
_BEFORE = {left: kind for kind, left in LEFT.items()}  # same scale: that of one cylinder
_MOST_LETTERS = 54  # of all names together that head the columns of a table of 80 places


@dataclass(frozen=True, kw_only=True)
class Line:
    """One figure of every engine in SI units: the amplitude of an order, or the peak over a
    revolution.

    Attributes:
        quantity: Name of the figure, with the unit at its end.
        order: Order; null for a peak.
        values: Value for each engine; null for moments that are not known.
        ratios: Ratios to the first engine's value; null if that value is 0.
        kind: Kind of force or moment.
        single: Scale of each value, such as the value of one cylinder; a value is negligible if it
            is below 0.1 % of its scale. 0: there is no scale.
    """

    quantity: str
    order: float | None
    values: tuple[float, ...]
    ratios: tuple[float, ...]
    kind: Annotated[Kind, HIDDEN]
    single: Annotated[tuple[float, ...], HIDDEN]

    @property
    def label(self) -> str:
        """Heading of its row or column in a table."""
        return "peak" if self.order is None else f"order {order_name(self.order)}"

    @property
    def largest(self) -> float:
        """Largest value that is known."""
        return max((value for value in self.values if not math.isnan(value)), default=0.0)

    @property
    def negligible(self) -> list[bool]:
        """Whether each value is 0, or below 0.1 % of its scale `single`."""
        pairs = zip(self.values, self.single, strict=True)
        return [value == 0 or value < NEGLIGIBLE * single for value, single in pairs]

    @property
    def low(self) -> bool:
        """Whether the figure is a peak, or an order up to 2."""
        return self.order is None or self.order <= 2


@dataclass(frozen=True, kw_only=True, repr=False)
class Comparison(Result):
    """Engines side by side.

    Attributes:
        format: Name and version of the document.
        engines: Names of the engines.
        speeds_rpm: Speed of each engine.
        assumed: Values that are used because the files leave them out, with the engine's name if
            they do not hold for all engines.
        figures: Figures of all engines.
        ladders: Devices that balance each engine, step by step.
        compared: Engines that are compared.
        whole: Whether tables show negligible orders as well.
    """

    format: Literal["balcli.compare/1"] = "balcli.compare/1"
    engines: tuple[str, ...]
    speeds_rpm: tuple[float, ...]
    assumed: tuple[Assumed, ...] | None = None
    figures: tuple[Line, ...]
    ladders: tuple[Ladder, ...] | None = None
    compared: Annotated[tuple[Engine, ...], HIDDEN]
    whole: Annotated[bool, HIDDEN]

    @property
    def summary(self) -> str:
        """Names of the engines, in words."""
        return f"of {', '.join(self.engines)}"


def analyze_alike(
    engines: Iterable[Engine],
    orders: Iterable[float] | None,
    analyze_one: Callable[[Engine, Iterable[float] | None], Analysis],
) -> tuple[Analysis, ...]:
    """Return analyses of several engines, or of one engine at several speeds, for the same orders.

    Args:
        engines: Single engines, not arrays of variants.
        orders: Orders to show; None: all orders that at least one analysis shows by default.
        analyze_one: Function that analyzes an engine for given orders.
    """
    analyses = tuple(analyze_one(engine, orders) for engine in engines)
    if orders is not None:
        return analyses
    every = merge_orders(*chain.from_iterable(map(_list_orders, analyses)))
    return tuple(analyze_one(analysis.engine, every) for analysis in analyses)


def make_line(
    kind: Kind, order: float | None, values: tuple[float, ...], single: tuple[float, ...]
) -> Line:
    """Return one figure of every engine with its ratios to the first value.

    Args:
        kind: Kind of force or moment.
        order: Order; None for a peak.
        values: Values, SI, one for each engine.
        single: Scale of each value, as in `Line`.
    """
    name = f"peak_{kind.key}" if order is None else kind.key
    ratios = tuple(value / values[0] if values[0] else nan for value in values)
    return Line(quantity=name, order=order, values=values, ratios=ratios, kind=kind, single=single)


def list_lines(analyses: Sequence[Analysis], *, every_order: bool = False) -> tuple[Line, ...]:
    """Return every figure of several analyses side by side.

    Args:
        analyses: Analyses for the same orders.
        every_order: Whether to include orders above 2 that are balanced in all analyses.
    """
    guides = _list_guides(analyses)
    with_gas = all(guide is None or guide.with_gas for guide in guides)
    alone = "" if with_gas else " of inertia only"
    tables = []
    for analysis, guide in zip(analyses, guides, strict=True):
        sizes = _list_sizes(analysis, guide)
        tables.append({(size.kind, size.order): size.value for size in sizes})
    lines = []
    for kind, order in tables[0]:
        if not all((kind, order) in table for table in tables):
            continue  # no bearing loads are known for a crank with one throw
        values = tuple(table[kind, order] for table in tables)
        shown = kind._replace(label=f"{kind.label}{alone}") if kind in GUIDES else kind
        scale = _BEFORE.get(kind, kind).name
        single = tuple(analysis.of_one_cylinder.get(scale, 0.0) for analysis in analyses)
        line = make_line(shown, order, values, single)
        free = kind.name in EVERY_KIND
        due = line.low if free else order is None or order % 1 == 0
        if due or any(values) or kind in GUIDES or (every_order and free):
            lines.append(line)
    return tuple(lines)


def _list_orders(analysis: Analysis) -> Iterator[Array]:
    yield analysis.orders
    if hasattr(analysis, "inner"):
        for _, along in list_loads(analysis.inner):
            yield along.phasors.orders
    if hasattr(analysis, "guide"):
        yield analysis.guide.h.orders


class _Size(NamedTuple):
    """A figure of one engine; order None: a peak."""

    kind: Kind
    order: float | None
    value: float


def _list_sizes(analysis: Analysis, guide: GuideMoments | None) -> Iterator[_Size]:
    """Yield the figures of an analysis."""
    for kind, phasors in analysis.spectra.with_moment_if(analysis.moments_known).items():
        yield from _list_by_order(kind, phasors)
    yield from _list_peaks(analysis)
    if hasattr(analysis, "inner"):
        for kind, along in list_loads(analysis.inner):
            yield from _list_by_order(kind, along.phasors)
            yield _Size(kind, None, max(peak.value for peak in along.peaks))
    moments = () if guide is None else zip(GUIDES, (guide.h, guide.x), strict=True)
    for kind, moment in moments:
        if moment is not None:
            yield from _list_by_order(kind, moment)
    if hasattr(analysis, "sizing"):
        for peak in _list_peaks(analysis.sizing.after):
            yield peak._replace(kind=LEFT[peak.kind])


def _list_by_order(kind: Kind, phasors: Phasors) -> Iterator[_Size]:
    """Yield the amplitude of each order, along the crank the largest."""
    sizes = phasors.major.reshape(len(phasors.orders), -1).max(axis=1)
    for order, size in zip(phasors.orders, sizes.tolist(), strict=True):
        yield _Size(kind, order_number(order), size)


def _list_peaks(analysis: Analysis) -> Iterator[_Size]:
    """Yield the peaks of force and moment; a moment that is not known is nan."""
    for kind, peak in analysis.peaks:
        known = analysis.moments_known or kind is not MOMENT
        yield _Size(kind, None, peak.value if known else nan)


def _list_guides(analyses: Sequence[Analysis]) -> list[GuideMoments | None]:
    """Return each engine's guide moments: with gas if all engines have gas, else without. None if
    they were not asked for.
    """
    if not all(hasattr(analysis, "guide") for analysis in analyses):
        return [None] * len(analyses)
    guides = [analysis.guide for analysis in analyses]
    if len({guide.with_gas for guide in guides}) < 2:
        return [*guides]
    engines = [analysis.engine for analysis in analyses]
    of_inertia = partial(analyze, orders=guides[0].h.orders, only="guide", beside=engines)
    return [of_inertia(replace(engine, gas=None)).guide for engine in engines]


def compare(
    *engines: Engine,
    names: Sequence[str] | None = None,
    orders: Iterable[float] | None = None,
    only: str | Collection[str] | None = None,
    all: bool = False,  # noqa: A002 - the name of the option
    small: float = SMALL,
) -> Comparison:
    """Compare engines side by side: free forces and moments by order, peaks, and their ratios to
    the first engine's.

    Args:
        engines: Two or more engines from `load`.
        names: Names of the engines; default: the names in their files, or "engine 1", "engine 2",
            ... if a name is missing or occurs twice.
        orders: Orders to show; default: all orders that `analyze` shows for at least one engine.
        only: Any of force, moment, couple, torque, roll, peak, sizing, ladder, inner, guide, gas;
            default: the first six (force to peak), and gas if all engines have gas.
        all: Whether tables show negligible orders as well; if `orders` is given, they always do.
        small: Share of one cylinder's first order. Ladder and sizing leave a rotating force or
            moment below this share unbalanced.

    Returns:
        The comparison. Its `figures` have the values of all engines in SI units, and the ratios of
        these values to the first engine's.

    Raises:
        BalcliError: There are fewer than two engines, there are more or fewer names than engines,
            or a quantity is unknown.
        TypeError: An argument is not an engine, or names are not texts.

    Example:
        >>> compare(load("i4.toml"), load("i6.toml")).to_pandas()
    """
    checked = [check_engine("compare", engine) for engine in engines]
    called = [engine.name for engine in checked]
    if names is not None:
        called = list_words("names", names, '["before", "after"]')
    elif "" in called or len(set(called)) < len(called):
        called = [f"engine {k}" for k in range(1, len(checked) + 1)]
    if len(called) != len(checked):
        raise BalcliError(f"{len(called)} names for {len(checked)} engines; give one for each")
    if len(checked) < 2:
        raise BalcliError("compare needs at least two engines")
    wanted = set(UNASKED) if only is None else set(list_words("only", only))
    without_gas = [engine for engine in checked if engine.gas is None]
    if only is None and not without_gas:
        wanted.add(GAS.name)
    ask = partial(analyze, only=wanted, beside=checked, small=small)
    analyses = analyze_alike(checked, orders, ask)
    return Comparison(
        engines=tuple(called),
        speeds_rpm=tuple(float(engine.speed_rpm) for engine in checked),
        assumed=join_assumed(called, [one.assumed for one in analyses]) or None,
        figures=list_lines(analyses, every_order=orders is not None),
        ladders=tuple(one.ladder for one in analyses if hasattr(one, "ladder")) or None,
        compared=tuple(checked),
        whole=all or orders is not None,
    )


def rows(result: Comparison, system: System) -> Rows:
    """Return the rows of CSV: a line for each figure, a column for each engine. Figures of ladder
    steps come last, in SI units; a cell is empty if the engine's ladder does not have this step.

    Args:
        result: Comparison of the engines.
        system: System of units.
    """
    lines: list[tuple[object, ...]] = []
    for line in result.figures:
        unit = system.unit(line.kind)
        name = line.kind.name if line.order is not None else f"peak {line.kind.name}"
        lines.append((name, line.order, unit.name, *map(unit.of, line.values)))
    steps: dict[tuple[str, str], dict[int, object]] = {}
    for k, ladder in enumerate(result.ladders or ()):
        for step, name, value, si in list_ladder(ladder):
            steps.setdefault((f"{step}: {name}", si), {})[k] = value
    for (name, si), values in steps.items():
        lines.append((name, None, si, *map(values.get, range(len(result.engines)))))
    return Rows(("quantity", "order", "unit", *map(name_cell, result.engines)), lines)


def sheet(result: Comparison, system: System) -> Sheet:
    """Return tables of amplitudes, with ratios to those of the first engine.

    Args:
        result: Comparison of the engines.
        system: System of units.
    """
    texts = [tell_speed(engine) for engine in result.compared]
    speeds = ("speeds", "; ".join(texts)) if len(set(texts)) > 1 else ("speed", texts[0])
    heads = _choose_heads(result.engines)
    parts: list[Facts | Grid | Text] = [Facts((speeds,))]
    if heads != result.engines:
        parts.insert(0, Facts(tuple(zip(heads, result.engines, strict=True))))
    nothing: list[str] = []
    for kind in dict.fromkeys(line.kind for line in result.figures):
        every = [line for line in result.figures if line.kind == kind]
        lines = every if result.whole else find_lines_that_matter(every)
        if not lines:
            nothing.append(kind.label)
            continue
        parts.append(_lay_out_kind(kind, lines, result, heads, system))
    for name, engine, ladder in zip(
        result.engines, result.compared, result.ladders or (), strict=False
    ):
        grid = ladder_grid(ladder, engine, system)
        parts.append(grid._replace(title=f"{name}: {grid.title}"))
    if nothing:
        parts.append(Text("", (f"Balanced or negligible in all engines: {', '.join(nothing)}.",)))
    parts += assumed_facts(result.assumed)  # of several engines: long, so below the figures
    return Sheet("Engines side by side", tuple(parts))


def fit_unit(kind: Kind, lines: Iterable[Line], system: System) -> ShownUnit:
    """Return the unit that fits the largest known value.

    Args:
        kind: Kind of force or moment.
        lines: Lines with values of this kind.
        system: System of units.
    """
    return system.unit(kind).fit_values(line.largest for line in lines)


def find_lines_that_matter(lines: list[Line]) -> list[Line]:
    """Return the lines whose largest value is above 0.1 % of the largest value of all lines, unless
    each of their values is below 0.1 % of its scale (`Line.single`). Orders up to 2 and the peak
    are also kept if a value is not known.
    """
    least = NEGLIGIBLE * max((line.largest for line in lines), default=0.0)
    kept = []
    for line in lines:
        unknown = any(map(math.isnan, line.values))
        matters = line.largest > least and not all(line.negligible)
        if matters or (line.low and unknown):
            kept.append(line)
    return kept


def show_sizes(line: Line, unit: ShownUnit, *, every: bool, digits: int | None = None) -> list[str]:
    """Return amplitudes in their unit, or a word for negligible ones.

    Args:
        line: Amplitudes of all engines.
        unit: Unit of the column.
        every: Whether negligible amplitudes are shown as numbers.
        digits: As for `number`.
    """
    return [
        size_cell(value, unit, negligible=small and not every, digits=digits)
        for value, small in zip(line.values, line.negligible, strict=True)
    ]


def _choose_heads(names: Sequence[str]) -> tuple[str, ...]:
    """Return the heads of the columns of engines: their names, or numbers if the names together are
    too long for a line.
    """
    if sum(map(len, names)) <= _MOST_LETTERS:
        return tuple(names)
    return tuple(f"engine {number}" for number in range(1, len(names) + 1))


def _lay_out_kind(
    kind: Kind, lines: list[Line], result: Comparison, heads: Sequence[str], system: System
) -> Grid:
    """Return a table of the values of each engine and, after the first engine, of their ratios to
    its values, unless these are negligible.

    Args:
        kind: Kind of force or moment.
        lines: Lines of the table.
        result: Comparison of the engines.
        heads: Heads of the columns of the engines.
        system: System of units.
    """
    unit = fit_unit(kind, lines, system)
    cells = [show_sizes(line, unit, every=result.whole) for line in lines]
    columns = [Column("", [line.label for line in lines], words=True)]
    for k, head in enumerate(heads):
        columns.append(Column(head, [row[k] for row in cells]))
        if k > 0:
            columns.append(Column("ratio", [_show_ratio(line, k) for line in lines]))
    title = f"{capitalized(kind.label)}, {unit.name}"
    if any(line.order is not None for line in lines):
        title += ": largest by order"
    return Grid(title, columns)


def _show_ratio(line: Line, k: int) -> str:
    """Return the ratio of an engine's value to that of the first engine, unless the latter is
    negligible.
    """
    if line.negligible[0]:
        return UNKNOWN
    return number(line.ratios[k])


RENDERER = Renderer(sheet=sheet, rows=rows)

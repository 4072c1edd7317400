"""Engines side by side: `compare`, its result, and how it is shown."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from math import nan
from typing import TYPE_CHECKING, Annotated, Literal

from ..core.phasors import Array
from ..core.records import HIDDEN
from ..engine.engine import Engine, check_engine
from ..errors import BalcliError, list_values, list_words, wrong_type
from ..file.fields import order_number
from ..forces.kinds import EVERY_KIND, GAS, MOMENT, TORQUE, VECTORS, Kind
from ..forces.spectrum import merge_orders
from ..limits import SMALL
from ..show.csv import Rows, name_cell
from ..show.engine_facts import tell_speed
from ..show.figures import list_assumed
from ..show.formats import Renderer
from ..show.result import Result
from ..show.sheet import (
    NEGLIGIBLE,
    UNKNOWN,
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
from .devices_show import ladder_grid, list_ladder

if TYPE_CHECKING:
    from ..forces.crankshaft import AlongCrank, InnerLoads
    from ..forces.guide import GuideMoments
    from ..show.units import ShownUnit, System


SHEAR = Kind("shear", "shear force in the crankshaft", "Q", "shear_N", True, "force")
BENDING = Kind("bending", "bending moment in the crankshaft", "M_b", "bending_Nm", True, "moment")
BEARING = Kind("bearing", "load of a main bearing", "R", "bearing_N", True, "force")
WITH_GAS = (  # in the order of `crankshaft.LoadsWithGas`
    Kind("shaft_shear", "shear of the shaft with gas", "Q", "shaft_shear_N", True, "force"),
    Kind("shaft_bending", "bending of the shaft with gas", "M", "shaft_bending_Nm", True, "moment"),
    Kind("main", "load of a main bearing with gas", "R", "main_N", True, "force"),
    Kind("block_shear", "shear of the block with gas", "Q", "block_shear_N", True, "force"),
    Kind("block_bending", "bending of the block with gas", "M", "block_bending_Nm", True, "moment"),
)
GUIDE_H = Kind("guide_h", "H-type guide moment", "M_H", "guide_h_Nm", False, "moment")
GUIDE_X = Kind("guide_x", "X-type guide moment", "M_X", "guide_x_Nm", False, "moment")
GUIDES = (GUIDE_H, GUIDE_X)
KINDS = tuple(EVERY_KIND.values())
LEFT = {
    kind: kind._replace(
        name=f"{kind.name} with devices",
        label=f"{kind.label} with the devices of auto",
        key=f"with_devices_{kind.key}",
    )
    for kind in VECTORS
}


@dataclass(frozen=True, kw_only=True)
class Line:
    """One figure of every engine, SI: the amplitude of an order, or the peak of the whole curve.

    Attributes:
        quantity: Name of the figure, which ends in its unit.
        order: Order; null for a peak.
        values: One an engine; null for moments that are not known.
        ratios: Ratios to the first engine's value; null where that is 0.
        kind: Kind of force or moment.
        single: Value for one cylinder of each engine, against which a value may be negligible; 0
            where there is no such measure.
    """

    quantity: str
    order: float | None
    values: tuple[float, ...]
    ratios: tuple[float, ...]
    kind: Annotated[Kind, HIDDEN]
    single: Annotated[tuple[float, ...], HIDDEN]


@dataclass(frozen=True, kw_only=True, repr=False)
class Comparison(Result):
    """Engines side by side.

    Attributes:
        format: Name and version of the document.
        engines: Names of the engines.
        speeds_rpm: Speed at which each is compared.
        assumed: Values taken because the files leave them out; with the engine's name where one
            does not hold for all.
        figures: Figures of all engines.
        ladders: Devices that balance each engine, step by step.
        compared: The engines.
       whole: Whether tables show negligible orders as well.
    """

    format: Literal["balcli.compare/1"] = "balcli.compare/1"
    engines: tuple[str, ...]
    speeds_rpm: tuple[float, ...]
    assumed: tuple[str, ...] | None = None
    figures: tuple[Line, ...]
    ladders: tuple[Ladder, ...] | None = None
    compared: Annotated[tuple[Engine, ...], HIDDEN]
    whole: Annotated[bool, HIDDEN]

    @property
    def summary(self) -> str:
        """Names of the engines, in words."""
        return f"of {', '.join(self.engines)}"


def compare_engines(
    engines: Sequence[Engine],
    names: Sequence[str],
    orders: Iterable[float] | None = None,
    only: Collection[str] | None = None,
    whole: bool = False,
    small: float = SMALL,
) -> Comparison:
    """Return the free forces and moments of several engines: the largest of each order, and peaks.

    Args:
        engines: without trailing axes, at least two.
        names: what to call them.
        orders: default: all that `analyze` shows for one of them.
        only: as in `analyze`; of sizing, the peaks that are left with the devices; default: the
            usual ones, and gas where all engines have some.
        whole: whether tables show negligible orders as well; they do if orders are given.
        small: as in `analyze`.

    Raises:
        BalcliError: fewer than two engines.
    """
    if len(engines) < 2:
        raise BalcliError("compare needs at least two engine files")
    wanted = set(UNASKED) if only is None else set(only)
    if only is None and all(engine.gas is not None for engine in engines):
        wanted.add(GAS.name)
    analyses = analyze_alike(
        engines, orders, partial(analyze, only=wanted, beside=engines, small=small)
    )
    lines = list_lines(analyses, every_order=orders is not None)
    return Comparison(
        engines=tuple(names),
        speeds_rpm=tuple(float(engine.speed_rpm) for engine in engines),
        assumed=list_assumed(names, engines, [GAS.name] if GAS.name in wanted else []),
        figures=lines,
        ladders=tuple(one.ladder for one in analyses if one.ladder is not None) or None,
        compared=tuple(engines),
        whole=whole or orders is not None,
    )


def analyze_alike(
    engines: Iterable[Engine],
    orders: Iterable[float] | None,
    analyze_one: Callable[[Engine, Iterable[float] | None], Analysis],
) -> tuple[Analysis, ...]:
    """Return analyses of several engines, or of one at several speeds, all by the same orders.

    Args:
        engines: Engines without trailing axes.
        orders: Orders to show; None: each that one of the analyses shows by default.
        analyze_one: Function that analyzes an engine by such orders.
    """
    analyses = tuple(analyze_one(engine, orders) for engine in engines)
    if orders is not None:
        return analyses
    every = merge_orders(*(orders for one in analyses for orders in _list_orders(one)))
    return tuple(analyze_one(one.engine, every) for one in analyses)


def list_lines(analyses: Sequence[Analysis], *, every_order: bool = False) -> tuple[Line, ...]:
    """Return every figure of analyses by the same orders side by side.

    Args:
        every_order: also orders above 2 that are balanced in all of them.
    """
    guides = _list_guides(analyses)
    tables = [
        {(kind, order): float(size) for kind, order, size in _list_sizes(one, guide)}
        for one, guide in zip(analyses, guides, strict=True)
    ]
    alone = "" if all(guide is None or guide.with_gas for guide in guides) else " of inertia alone"
    lines = []
    for kind, order in tables[0]:
        values = tuple(table.get((kind, order), nan) for table in tables)
        there = all((kind, order) in table for table in tables)  # one throw has no known bearings
        least = order is None or order <= 2 if kind in KINDS else order is None or order % 1 == 0
        if there and (least or any(values) or kind in GUIDES or (every_order and kind in KINDS)):
            shown = kind._replace(label=f"{kind.label}{alone}") if kind in GUIDES else kind
            lines.append(_make_line(shown, order, values, analyses))
    return tuple(lines)


def _make_line(
    kind: Kind, order: float | None, values: tuple[float, ...], analyses: Sequence[Analysis]
) -> Line:
    return Line(
        quantity=f"peak_{kind.key}" if order is None else kind.key,
        order=order,
        values=values,
        ratios=tuple(value / values[0] if values[0] else nan for value in values),
        kind=kind,
        single=tuple(one.of_one_cylinder.get(kind.name, 0.0) for one in analyses),
    )


def _list_orders(one: Analysis) -> Iterator[Array]:
    yield one.orders
    if one.inner is not None:
        yield one.inner.bending.phasors.orders
        if one.inner.with_gas is not None:
            yield one.inner.with_gas.bending.phasors.orders
    if one.guide is not None:
        yield one.guide.h.orders


def _list_sizes(
    one: Analysis, guide: GuideMoments | None
) -> Iterator[tuple[Kind, float | None, float]]:
    """Yield the figures of an analysis: kind, order (None for a peak), and size."""
    for kind, phasors in one.spectra.with_moment_if(one.moments_known).items():
        yield from _list_by_order(kind, one.orders, phasors.major)
    yield from _list_peaks(one)
    if one.inner is not None:
        loads = zip((SHEAR, BENDING, BEARING, *WITH_GAS), _list_loads(one.inner), strict=False)
        for kind, along in loads:
            if along is not None:
                sizes = along.phasors.major.max(axis=1)
                yield from _list_by_order(kind, along.phasors.orders, sizes)
                yield kind, None, max(peak.value for peak in along.peaks)
    if guide is not None:
        for kind, moment in zip(GUIDES, (guide.h, guide.x), strict=True):
            if moment is not None:
                yield from _list_by_order(kind, moment.orders, moment.major)
    if one.sizing is not None:
        for kind, _, peak in _list_peaks(one.sizing.after):
            yield LEFT[kind], None, peak


def _list_peaks(one: Analysis) -> Iterator[tuple[Kind, None, float]]:
    for kind, peak in one.peaks:
        yield kind, None, peak.value if one.moments_known or kind is not MOMENT else nan


def _list_by_order(
    kind: Kind, orders: Array, sizes: Array
) -> Iterator[tuple[Kind, float | None, float]]:
    for order, size in zip(orders.tolist(), sizes.tolist(), strict=True):
        yield kind, order_number(order), size


def _list_loads(inner: InnerLoads) -> tuple[AlongCrank | None, ...]:
    """Return the largest loads along the crank, by order and of all orders."""
    return inner.shear, inner.bending, inner.bearings, *(inner.with_gas or ())


def _list_guides(analyses: Sequence[Analysis]) -> list[GuideMoments | None]:
    """Return guide moments with gas where all engines have some, else of inertia alone."""
    found = [one.guide for one in analyses]
    known = [guide for guide in found if guide is not None]
    if len({guide.with_gas for guide in known}) < 2:
        return found
    engines = [one.engine for one in analyses]
    of_inertia = partial(analyze, orders=known[0].h.orders, only="guide", beside=engines)
    return [of_inertia(replace(engine, gas=None)).guide for engine in engines]


def compare(
    *engines: Engine,
    names: Sequence[str] | None = None,
    orders: Iterable[float] | None = None,
    only: str | Collection[str] | None = None,
) -> Comparison:
    """Compare engines side by side: free forces and moments by order, peaks, and their ratios to
    the first engine's.

    Args:
        engines: two or more, as `load` makes them.
        names: what to call them; default: as their files do, or by number where names are missing
            or stand for several.
        orders: which to show; default: all that are not negligible in one of them.
        only: any of force, moment, couple, torque, roll, peak, sizing, ladder, inner, guide, gas;
            default: all but the four after peak.

    Returns:
        Every figure in `result.figures`, with the values of all engines in SI units and their
        ratios.

    Raises:
        BalcliError: fewer than two engines; other than one name for each; an unknown quantity.
        TypeError: one that is no engine; names that are no texts.

    Example:
        >>> compare(load("i4.toml"), load("i6.toml")).to_pandas()
    """
    checked = [check_engine("compare", engine) for engine in engines]
    called = [engine.name for engine in checked] if names is None else _check_names(names)
    if names is None and ("" in called or len(set(called)) < len(called)):
        called = [f"engine {k}" for k in range(1, len(checked) + 1)]
    if len(called) != len(checked):
        raise BalcliError(f"{len(called)} names for {len(checked)} engines; give one for each")
    wanted = None if only is None else list_words("only", only)
    return compare_engines(checked, called, orders, wanted)


def _check_names(names: object) -> list[str]:
    if isinstance(names, Iterable) and not isinstance(names, str):
        listed = list_values("names", names)
        if all(isinstance(name, str) for name in listed):
            return listed
    raise wrong_type("names", names, 'give a text for each engine, such as ["before", "after"]')


TITLES = {TORQUE: "inertia torque"}


def rows(result: Comparison, system: System) -> Rows:
    """Return CSV: a figure a line, a column an engine.

    Args:
        result: Comparison of the engines.
        system: System of units.
    """
    header = ("quantity", "order", "unit", *map(name_cell, result.engines))
    lines = [_csv_line(line, system) for line in result.figures]
    return Rows(header, [*lines, *_list_ladders(result)])


def _list_ladders(result: Comparison) -> Iterator[tuple[object, ...]]:
    """Yield a line for every figure of a step, SI: empty for an engine without this step."""
    found: dict[tuple[str, str], dict[int, object]] = {}
    for k, ladder in enumerate(result.ladders or ()):
        for step, name, value, unit in list_ladder(ladder):
            found.setdefault((f"{step}: {name}", unit), {})[k] = value
    for (name, unit), values in found.items():
        yield name, None, unit, *map(values.get, range(len(result.engines)))


def _csv_line(line: Line, system: System) -> tuple[object, ...]:
    unit = system.unit(line.kind)
    name = line.kind.name if line.order is not None else f"peak {line.kind.name}"
    return name, line.order, unit.name, *map(unit.of, line.values)


def sheet(result: Comparison, system: System) -> Sheet:
    """Return tables of amplitudes, with ratios to the first engine's below their size.

    Args:
        result: Comparison of the engines.
        system: System of units.
    """
    heads = (
        "",
        result.engines[0],
        *(head for name in result.engines[1:] for head in (name, "ratio")),
    )
    grids: list[Grid | Text] = []
    nothing: list[str] = []
    for kind in dict.fromkeys(line.kind for line in result.figures):
        every = [line for line in result.figures if line.kind == kind]
        lines = every if result.whole else find_lines_that_matter(every)
        if not lines:
            nothing.append(TITLES.get(kind, kind.label))
            continue
        unit = fit_unit(kind, lines, system)
        title = f"{capitalized(TITLES.get(kind, kind.label))}, {unit.name}: largest by order"
        grids.append(
            Grid(title, heads, tuple(_row(line, unit, every=result.whole) for line in lines))
        )
    for name, engine, ladder in zip(
        result.engines, result.compared, result.ladders or (), strict=False
    ):
        grid = ladder_grid(ladder, engine, system)
        grids.append(grid._replace(title=f"{name}: {grid.title}"))
    if nothing:
        grids.append(Text("", (f"Balanced or negligible in all of them: {', '.join(nothing)}.",)))
    head = (_tell_speeds(result), *assumed_facts(result.assumed))
    return Sheet("Engines side by side", (*head, *grids))


def _tell_speeds(result: Comparison) -> Facts:
    """Return one speed for all engines, or each in their order."""
    told = [tell_speed(engine) for engine in result.compared]
    one_for_all = len(set(told)) == 1
    return Facts((("speed", told[0]) if one_for_all else ("speeds", "; ".join(told)),))


def fit_unit(kind: Kind, lines: Iterable[Line], system: System) -> ShownUnit:
    """Return the unit that fits the largest of all known values.

    Args:
        kind: Kind of force or moment.
        lines: Lines with its values.
        system: System of units.
    """
    known = (v for line in lines for v in _list_known(line))
    return system.unit(kind).fit(max(known, default=0.0))


def find_lines_that_matter(lines: list[Line]) -> list[Line]:
    """Return the orders that are not small against the largest or against one cylinder's, and the
    peak; none if all are 0. Low orders are kept where one engine's are not known.
    """
    largest = max((v for line in lines for v in _list_known(line)), default=0.0)
    return [line for line in lines if _matters(line, NEGLIGIBLE * largest)]


def _list_known(line: Line) -> list[float]:
    return [value for value in line.values if not math.isnan(value)]


def _matters(line: Line, least: float) -> bool:
    known = _list_known(line)
    if len(known) < len(line.values) and (line.order is None or line.order <= 2):
        return True
    return max(known, default=0.0) > least and not all(_tell_negligible(line))


def show_sizes(line: Line, unit: ShownUnit, *, every: bool) -> list[str]:
    """Return amplitudes in their unit, or a word for one that is negligible.

    Args:
        line: Amplitudes of all engines.
        unit: Unit of the column.
        every: Whether negligible amplitudes are shown as numbers.
    """
    small = [False] * len(line.values) if every else _tell_negligible(line)
    sizes = zip(line.values, small, strict=True)
    return [size_cell(value, unit, negligible=s, digits=None) for value, s in sizes]


def _tell_negligible(line: Line) -> list[bool]:
    """Return whether each value is 0, or small against that of one cylinder of its engine."""
    single = line.single or (0.0,) * len(line.values)
    pairs = zip(line.values, single, strict=True)
    return [value == 0 or value < NEGLIGIBLE * one for value, one in pairs]


def _row(line: Line, unit: ShownUnit, *, every: bool) -> tuple[str, ...]:
    """Return sizes, and ratios to the first engine's unless that is negligible."""
    first, *others = show_sizes(line, unit, every=every)
    to_nothing = _tell_negligible(line)[0]
    ratios = [UNKNOWN if to_nothing else number(ratio, 4) for ratio in line.ratios[1:]]
    return (
        "peak" if line.order is None else f"order {order_name(line.order)}",
        first,
        *(cell for pair in zip(others, ratios, strict=True) for cell in pair),
    )


RENDERER = Renderer(sheet=sheet, rows=rows)

"""Engines side by side."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from ..documents.records import to_document
from ..forces.kinds import TORQUE
from .csv import Rows, name_cell
from .engine_facts import tell_speed
from .formats import Renderer
from .sheet import (
    NEGLIGIBLE,
    UNKNOWN,
    Facts,
    Grid,
    Sheet,
    Text,
    capitalized,
    number,
    order_name,
    size_cell,
)

TITLES = {TORQUE: "inertia torque"}

if TYPE_CHECKING:
    from ..forces.kinds import Kind
    from ..results.comparison import Comparison, Line
    from .units import ShownUnit, System


def document(result: Comparison) -> dict[str, Any]:
    """Return `balcli.compare/1`: SI, ratios to the first engine (null where that has none)."""
    return to_document(result)


def rows(result: Comparison, system: System) -> Rows:
    """CSV: a figure a line, a column an engine."""
    header = ("quantity", "order", "unit", *map(name_cell, result.engines))
    return Rows(header, [_csv_line(line, system) for line in result.figures])


def _csv_line(line: Line, system: System) -> tuple[Any, ...]:
    unit = system.unit(line.kind)
    name = line.kind.name if line.order is not None else f"peak {line.kind.name}"
    return name, line.order, unit.name, *map(unit.of, line.values)


def sheet(result: Comparison, system: System) -> Sheet:
    """Amplitudes, with ratios to the first engine's below their size."""
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
    if nothing:
        grids.append(Text("", (f"Balanced or negligible in all of them: {', '.join(nothing)}.",)))
    return Sheet("Engines side by side", (_tell_speeds(result), *grids))


def _tell_speeds(result: Comparison) -> Facts:
    """One for all, or each in the order of the engines."""
    told = [tell_speed(engine) for engine in result.compared]
    one_for_all = len(set(told)) == 1
    return Facts((("speed", told[0]) if one_for_all else ("speeds", "; ".join(told)),))


def fit_unit(kind: Kind, lines: Iterable[Line], system: System) -> ShownUnit:
    """The unit for the largest of all that is known, if anything is."""
    known = (v for line in lines for v in _list_known(line))
    return system.unit(kind).fit(max(known, default=0.0))


def find_lines_that_matter(lines: list[Line]) -> list[Line]:
    """Orders that are not small beside the largest or beside one cylinder's, and the peak; none if
    all are 0. What is not known of one engine is told of low orders.
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
    """Amplitudes in their unit, or a word where none counts, unless `every` one is wanted."""
    small = [False] * len(line.values) if every else _tell_negligible(line)
    sizes = zip(line.values, small, strict=True)
    return [size_cell(value, unit, negligible=s, digits=None) for value, s in sizes]


def _tell_negligible(line: Line) -> list[bool]:
    """Of each value whether it is 0, or small beside what one cylinder of its engine makes."""
    single = line.single or (0.0,) * len(line.values)
    pairs = zip(line.values, single, strict=True)
    return [value == 0 or value < NEGLIGIBLE * one for value, one in pairs]


def _row(line: Line, unit: ShownUnit, *, every: bool) -> tuple[str, ...]:
    """Sizes, and ratios to the first engine's unless that is negligible."""
    first, *others = show_sizes(line, unit, every=every)
    to_nothing = _tell_negligible(line)[0]
    ratios = [UNKNOWN if to_nothing else number(ratio, 4) for ratio in line.ratios[1:]]
    return (
        "peak" if line.order is None else f"order {order_name(line.order)}",
        first,
        *(cell for pair in zip(others, ratios, strict=True) for cell in pair),
    )


RENDERER = Renderer(sheet=sheet, document=document, rows=rows)

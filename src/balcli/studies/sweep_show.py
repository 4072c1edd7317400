"""Show the variants of a sweep: CSV and JSON in full precision, written chunk by chunk (as the
variants are computed); a table of the first variants; data frames; and pictures over one or two
parameters.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import cycle
from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np

from ..core.phasors import Array
from ..core.records import Axes, Node, WrittenAs, to_document
from ..errors import BalcliError
from ..file.assumed import Assumed
from ..file.model import EngineFile
from ..limits import MOST_PICTURE_VARIANTS
from ..show import plot_style as style
from ..show.figures import name_engine
from ..show.formats import Columnar, Columns, json_text
from ..show.sheet import NAMELESS, Column, Grid, Sheet, assumed_facts, count_name, given, number
from ..show.units import ShownUnit, name_with_unit, unit_of_name
from .quantity_names import tell_speeds
from .sweep import split_columns

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from .parameters import Parameter
    from .sweep import Chunk, Sweep, Swept


@dataclass(frozen=True, kw_only=True)
class SweepDocument:
    """Variants of an engine. A row has the varied figures, in the units of the file, then the
    quantities, in the units of `balcli numbers`. Null marks a quantity without a value, such as the
    direction of the long axis of a vector that turns in a circle.

    Attributes:
        engine: The engine file.
        assumed: Values assumed because the engine file leaves them out.
        columns: Names of the varied figures, then of the quantities.
        rows: One row for each variant.
    """

    format: Literal["balcli.sweep/1"] = "balcli.sweep/1"
    engine: Annotated[EngineFile, WrittenAs(name_engine)]
    assumed: tuple[Assumed, ...] | None = None
    columns: list[str]
    rows: Annotated[Array, Axes(2)]


def columns(result: Swept) -> Columns:
    """Return one row for each variant, with its parameters and quantities."""
    sweep = result.sweep
    grids = np.meshgrid(*(p.values for p in sweep.parameters), indexing="ij")
    every = (value.ravel() for value in (*grids, *result.values))
    return Columns(dict(zip(sweep.columns, every, strict=True)), sweep.units)


def document(result: Swept) -> Node:
    """Return the JSON document `balcli.sweep/1`."""
    cells = np.column_stack([*columns(result).values.values()])
    return to_document(_describe(result.sweep, cells))


def _describe(sweep: Sweep, rows: Array) -> SweepDocument:
    return SweepDocument(engine=sweep.file, assumed=sweep.assumed, columns=sweep.columns, rows=rows)


def sweep_csv(sweep: Sweep, chunks: Iterable[Chunk]) -> Iterator[str]:
    """Yield CSV: a header, and one line for each variant. Quantities without a value, such as the
    direction of the long axis of a vector that turns in a circle, are empty cells.
    """
    yield ",".join(sweep.columns) + "\n"
    for chunk in chunks:
        yield "\n".join(_lines(sweep, chunk, "")) + "\n"


def sweep_json(sweep: Sweep, chunks: Iterable[Chunk]) -> Iterator[str]:
    """Yield the JSON document `balcli.sweep/1` as text."""
    head = to_document(_describe(sweep, np.empty((0, 0))))
    yield json_text(head).removesuffix("]}")
    before = ""
    for chunk in chunks:
        yield before + ",\n".join(f"[{line}]" for line in _lines(sweep, chunk, "null"))
        before = ",\n"
    yield "]}\n"


def _lines(sweep: Sweep, chunk: Chunk, nothing: str) -> Iterator[str]:
    """Yield the rows of a chunk, separated by commas. Each number is the shortest text that reads
    back to the same value.
    """
    for row in np.column_stack(split_columns(sweep, chunk)).tolist():
        cells = [nothing if math.isnan(value) else repr(value) for value in row]
        yield ",".join(cells)


def make_sheet(sweep: Sweep, figures: Array) -> Sheet:
    """Return the table, with each column in a fitting unit.

    Args:
        sweep: Sweep of the variants.
        figures: Parameters and quantities of the first variants, shape (variants, columns).
    """
    shown: list[Column] = []
    varied = [parameter.path for parameter in sweep.parameters]
    for name, values in zip(sweep.columns, figures.T, strict=True):
        largest = float(np.nanmax(np.abs(values), initial=0))
        unit = unit_of_name(sweep.units[name]).fit(largest)
        sizes = (values / unit.size).tolist()
        if name in varied:
            cells = [given(size, 8) for size in sizes]
        else:
            cells = [number(size) for size in sizes]
        is_first = not shown
        shown.append(Column(name_with_unit(name, unit.name), cells, words=is_first))
    note = tell_speeds((q.name for q in sweep.quantities), sweep.columns)
    if missing := sweep.variants - len(figures):
        whole = count_name(sweep.variants)
        others = count_name(missing)
        note = f"{whole} variants, {others} of them not shown; -o X.csv writes all. {note}"
    grid = Grid("", shown, note.rstrip())
    head = assumed_facts(sweep.assumed)
    return Sheet(f"{sweep.file.name or NAMELESS}: variants", (*head, grid))


RENDERER = Columnar(document=document, columns=columns)


LEVELS = 12


def check_drawable(sweep: Sweep) -> None:
    """Check that a picture of the sweep is possible, before anything is computed.

    Raises:
        BalcliError: No parameter or more than two have several values, or there are too many
            variants.
    """
    several = len(_varied_parameters(sweep))
    if not 0 < several <= 2:
        raise BalcliError(
            f"{several} parameters have several values; a picture shows one or two of them"
        )
    if sweep.variants > MOST_PICTURE_VARIANTS:
        raise BalcliError(
            f"{count_name(sweep.variants)} variants are too many for a picture; give at most "
            f"{count_name(MOST_PICTURE_VARIANTS)}"
        )


def _varied_parameters(sweep: Sweep) -> list[Parameter]:
    return [p for p in sweep.parameters if len(p) > 1]


def make_sweep(sweep: Sweep, values: Sequence[Array]) -> Figure:
    """Return the picture of a sweep that `check_drawable` accepts.

    Args:
        sweep: Sweep of the variants.
        values: Values of each quantity on the whole grid.
    """
    first, *others = _varied_parameters(sweep)
    name = style.fit_name(sweep.file.name)
    shown = [*zip(sweep.quantities, values, strict=True)]
    if others:
        (second,) = others
        with style.open_figure(6 * len(values), 5.1) as page:
            style.put_title(page, name)
            places = page.subplots(1, len(values), squeeze=False)[0]
            for axes, (quantity, value) in zip(places, shown, strict=True):
                fit = _fit(quantity.unit, value)
                figures = value.squeeze() / fit.size
                page.colorbar(axes.contourf(second.values, first.values, figures, LEVELS), ax=axes)
                axes.set_title(name_with_unit(quantity.name, fit.name))
                axes.set_xlabel(name_with_unit(second.path, second.unit))
                axes.set_ylabel(name_with_unit(first.path, first.unit))
        return page
    units = list(dict.fromkeys(quantity.unit for quantity in sweep.quantities))
    with style.open_figure(7, 1.2 + 3 * len(units)) as page:
        places = page.subplots(len(units), 1, sharex=True, squeeze=False)[:, 0]
        for axes, unit in zip(places, units, strict=True):
            curves = {q.name: value.ravel() for q, value in shown if q.unit == unit}
            fit = _fit(unit, np.concatenate([*curves.values()]))
            looks = zip(curves.items(), cycle(style.MANY_LOOKS), strict=False)
            for (label, curve), (line, colour) in looks:
                drawn = curve / fit.size
                axes.plot(first.values, drawn, color=colour, linestyle=line, label=label)
            axes.set(xlabel=name_with_unit(first.path, first.unit), ylabel=fit.name)
            axes.ticklabel_format(axis="y", useOffset=False, style="plain")
            axes.legend()
            axes.label_outer()
        places[0].set_title(name)
    return page


def _fit(name: str, value: Array) -> ShownUnit:
    """Return the unit that fits the largest magnitude in `value`; `name` is the SI unit."""
    return unit_of_name(name).fit(float(np.nan_to_num(abs(value)).max(initial=0)))

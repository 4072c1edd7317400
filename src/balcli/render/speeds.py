"""One engine at several speeds: for people a table a kind, a speed a row; for programs the analyses
themselves.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from ..forces.kinds import FORCE, MOMENT, ROLL, ROLL_TOTAL
from . import analysis_document, symmetry
from .comparison import TITLES, find_lines_that_matter, fit_unit, show_sizes
from .csv import Rows, name_cell
from .engine_facts import engine_facts
from .formats import Renderer
from .sheet import NAMELESS, Facts, Grid, Sheet, Text, capitalized, given, order_name, size_text
from .view import NamedResult

if TYPE_CHECKING:
    from ..forces.kinds import Kind
    from ..results.comparison import Line
    from ..results.speeds import SpeedSeries
    from .units import System


def sheet(one: NamedResult[SpeedSeries], system: System) -> Sheet:
    """What the engine is, and what it does at each speed."""
    engine = one.result.analyses[0].engine
    return Sheet(engine.name or NAMELESS, tuple(_parts(one, system)))


def document(one: NamedResult[SpeedSeries]) -> dict[str, Any]:
    """`balcli.speeds/1`: the analysis at each speed, as `balcli.analysis/1`."""
    return {
        "format": "balcli.speeds/1",
        "engine": {"name": one.result.analyses[0].engine.name},
        "analyses": [analysis_document.document(each) for each in one.result.analyses],
    }


def rows(one: NamedResult[SpeedSeries], system: System) -> Rows:
    """CSV: the rows of each analysis after the engine's name and the speed."""
    devices = "sizing" in one.view.parts
    every = [analysis_document.rows(each, system, devices=devices) for each in one.result.analyses]
    lines = (
        (name_cell(one.name), speed, *line)
        for speed, rows_of_one in zip(one.result.speeds_rpm, every, strict=True)
        for line in rows_of_one.lines
    )
    return Rows(("engine", "speed_rpm", *every[0].header), lines)


def _parts(one: NamedResult[SpeedSeries], system: System) -> Iterator[Facts | Grid | Text]:
    series, view, speeds = one.result, one.view, one.result.speeds_rpm
    first = series.analyses[0]
    if not view.parts or view.whole:
        higher = first.has_higher_orders
        yield engine_facts(first.engine, system, higher=higher, whole=view.whole, speeds_rpm=speeds)
    kinds = dict.fromkeys(line.kind for line in series.lines)
    if not (view.parts or view.whole):  # in brief
        roll = ROLL if first.engine.gas is None else ROLL_TOTAL
        kinds = dict.fromkeys(kind for kind in kinds if kind in (FORCE, MOMENT, roll))
    for kind in kinds:
        own = [line for line in series.lines if line.kind == kind]
        yield _kind_part(kind, own, speeds, system, whole=view.whole or view.every_order)
    if first.why is not None:
        yield from symmetry.sheet_parts(first.why)


def _kind_part(
    kind: Kind, lines: list[Line], speeds_rpm: list[float], system: System, *, whole: bool
) -> Grid | Text:
    """One kind by speed, a column an order, and the peak; one sentence where nothing matters."""
    title = TITLES.get(kind, kind.label)
    shown = lines if whole else find_lines_that_matter(lines)
    if not shown:
        largest = max(v for line in lines for v in line.values)
        most = f" (at most {size_text(largest, system.unit(kind), 2)})" if largest else ""
        return Text("", (f"{'Negligible' if largest else 'Balanced'}: {title}{most}.",))
    unit = fit_unit(kind, shown, system)
    heads = ("peak" if line.order is None else f"order {order_name(line.order)}" for line in shown)
    columns = [show_sizes(line, unit, every=whole) for line in shown]
    table = tuple(
        (given(speed), *cells) for speed, *cells in zip(speeds_rpm, *columns, strict=True)
    )
    title = f"{capitalized(title)}, {unit.name}: largest by order"
    return Grid(title, ("rpm", *heads), table, words=())


RENDERER = Renderer(sheet=sheet, document=document, rows=rows)

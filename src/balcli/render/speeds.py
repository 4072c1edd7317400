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
    told = [(float(each.engine.speed_rpm), each) for each in one.result.analyses]
    devices = "sizing" in one.view.parts
    every = [
        (speed, *analysis_document.rows(each, system, devices=devices)) for speed, each in told
    ]
    lines = (
        (name_cell(one.name), speed, *line) for speed, _, own_lines in every for line in own_lines
    )
    return Rows(("engine", "speed_rpm", *every[0][1]), lines)


def _parts(one: NamedResult[SpeedSeries], system: System) -> Iterator[Facts | Grid | Text]:
    series, view = one.result, one.view
    first = series.analyses[0]
    if not view.parts or view.whole:
        yield engine_facts(
            first.engine,
            system,
            higher=first.has_higher_orders,
            whole=view.whole,
            speeds_rpm=series.speeds_rpm,
        )
    roll = ROLL if first.engine.gas is None else ROLL_TOTAL
    in_brief = not (view.parts or view.whole)
    lines = series.lines
    whole = view.whole or view.every_order
    for kind in dict.fromkeys(line.kind for line in lines):
        if not in_brief or kind in (FORCE, MOMENT, roll):
            own = [line for line in lines if line.kind == kind]
            yield _kind_part(kind, own, series.speeds_rpm, system, whole=whole)
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

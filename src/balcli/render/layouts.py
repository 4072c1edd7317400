"""The table of common layouts: for people orders 1 and 2, an engine a line; JSON and CSV as of any
recomputed table.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from . import printed_table
from .formats import Renderer
from .sheet import UNKNOWN, Grid, Sheet, number

if TYPE_CHECKING:
    from ..printed_tables.layouts import Layouts
    from ..printed_tables.recomputed import Row
    from .csv import Rows
    from .units import System

_SHOWN = ("F1", "F2", "M1", "M2")
_NOTE = (
    "Largest values: F1 in m r ω² of one cylinder's reciprocating mass, F2 in A2 m r ω² (A2 ≈ λ), "
    "M1 and M2 in these times the distance of neighbouring throws. Orders 4 and 6, smallest "
    "values: --format csv. As files: balcli engines."
)


def sheet(result: Layouts, _system: System) -> Sheet:
    """Force and moment of orders 1 and 2, and how evenly each engine fires."""
    columns = result.table.columns
    places = [columns.index(f"{name}_major") for name in _SHOWN]

    def cells(row: Row) -> tuple[str, ...]:
        name, title, *_ = map(str, row)
        multiples = (number(float(row[k] or 0.0), 4) for k in places)
        gaps = "/".join(f"{gap:g}" for gap in result.gaps_deg[name])  # 90/150: it fires unevenly
        return title.partition(" (")[0], *multiples, gaps or UNKNOWN

    rows = tuple(map(cells, result.table.exact))
    grid = Grid("", ("engine", *_SHOWN, "fires every"), rows, note=_NOTE)
    return Sheet("Free forces and moments of common engines", (grid,))


def document(result: Layouts) -> dict[str, Any]:
    """`balcli.table/1`."""
    return printed_table.document(result.table)


def rows(result: Layouts, system: System) -> Rows:
    """CSV: the exact figures of all orders."""
    return printed_table.rows(result.table, system)


RENDERER = Renderer(sheet=sheet, document=document, rows=rows)

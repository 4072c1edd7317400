"""One printed table, recomputed: laid out as the print is, each figure rounded to the printed
digits or to as many as are asked for; where the print deviates it follows: `.4313 ≠ .4312`.
JSON and CSV hold full precision.
"""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from ..printed_tables.recomputed import (
    Cell,
    Table,
    deviates,
    parse_decimal,
    parse_number,
    round_like,
)
from .csv import Rows
from .formats import Renderer
from .sheet import Facts, Grid, Sheet
from .units import System


def sheet(table: Table, _system: System) -> Sheet:
    """Return source, the table as printed, and how many figures deviate."""
    columns = range(len(table.columns))
    rows = tuple(tuple(_shown(table, i, j) for j in columns) for i in range(len(table.exact)))
    wrong = frozenset((e.row, table.columns.index(e.column)) for e in table.errata)
    words = tuple(
        j
        for j in columns
        if j == 0 or all(isinstance(row[j], str) and not _is_figure(row[j]) for row in table.exact)
    )
    grid = Grid("", table.columns, rows, note=count_deviations(table), marked=wrong, words=words)
    return Sheet(f"{table.name}: {table.title}", (Facts((("source", table.source),)), grid))


def document(table: Table) -> dict[str, Any]:
    """Return `balcli.table/1`: the exact figures, the printed texts, and the errata."""
    return {
        "format": "balcli.table/1",
        "name": table.name,
        "title": table.title,
        "source": table.source,
        "columns": table.columns,
        "rows": table.exact,
        "printed": table.printed,
        "errata": [asdict(e) for e in table.errata],
    }


def rows(table: Table, _system: System) -> Rows:
    """Return the exact figures as CSV, with as many decimals as the table asks for."""

    def cell(value: Cell) -> Cell:
        rounded = table.digits is not None and isinstance(value, float)
        return f"{value:.{table.digits}f}" if rounded else value

    return Rows(table.columns, [[cell(value) for value in row] for row in table.exact])


def count_deviations(table: Table) -> str:
    """Return a sentence on how many of the printed figures are not the exact ones rounded."""
    printed = sum(_is_figure(text) for row in table.printed for text in row[table.stub :])
    wrong = len(table.errata)
    if not printed:
        return "no printed source"
    if not wrong:
        return f"all {printed} printed figures agree"
    return f"{wrong} of {printed} printed figures deviate (exact ≠ printed)"


# ------------------------------------------------------------------ cells
def _is_figure(cell: Cell) -> bool:
    return parse_decimal(str(cell)) is not None or parse_number(cell) is not None


def _shown(table: Table, i: int, j: int) -> str:
    """Return a cell as the print would have it, followed by the print where that deviates."""
    value, text = table.exact[i][j], table.printed[i][j]
    like = text or next((row[j] for row in table.printed if row[j]), None)
    if not isinstance(value, (int, float)):
        shown = value or ""
    elif table.digits is not None and j >= table.stub and not _is_whole(like, value):
        shown = f"{value:.{table.digits}f}"
    else:
        shown = _round_as_printed(value, text or "")
    return f"{shown} ≠ {text}" if text is not None and deviates(value, text) else shown


def _is_whole(text: str | None, value: float) -> bool:
    """Return whether a whole number is printed as one, such as an angle."""
    return text is not None and text.lstrip("+-").isdigit() and float(value).is_integer()


def _round_as_printed(value: float, text: str) -> str:
    """Return a value as the printed text has it: its decimals, its sign, and whether a 0 stands
    before the point.
    """
    like = parse_decimal(text)
    if like is None:
        return f"{value:.6g}"
    shown = f"{round_like(value, like):f}"
    if text.lstrip("+-").startswith(".") and abs(value) < 1:
        shown = shown.replace("0.", ".", 1)
    return f"+{shown}" if text.startswith("+") else shown


RENDERER = Renderer(sheet=sheet, document=document, rows=rows)

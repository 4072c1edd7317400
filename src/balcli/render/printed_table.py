"""One printed table, recomputed: laid out as the print is, each figure rounded to the printed
digits or to as many as are asked for; where the print deviates it follows: `.4313 ≠ .4312`.
JSON and CSV hold full precision.
"""

from __future__ import annotations

from dataclasses import asdict
from typing import Any, NamedTuple

from ..printed_tables.recomputed import (
    Cell,
    Table,
    deviates,
    parse_decimal,
    parse_fraction,
    round_like,
)
from .csv import Rows
from .sheet import Facts, Grid, Sheet
from .units import System


class RoundedTable(NamedTuple):
    """A table, and how many decimals its figures are to have (None: as printed)."""

    table: Table
    digits: int | None = None


def sheet(result: RoundedTable, _system: System) -> Sheet:
    """Source, the table as printed, and how many figures deviate."""
    table, digits = result
    columns = range(len(table.columns))
    rows = tuple(
        tuple(_shown(table, i, j, digits) for j in columns) for i in range(len(table.exact))
    )
    wrong = frozenset((e.row, table.columns.index(e.column)) for e in table.errata)
    words = tuple(j for j in columns if j == 0 or all(_is_word(row[j]) for row in table.exact))
    grid = Grid("", table.columns, rows, note=count_deviations(table), marked=wrong, words=words)
    return Sheet(f"{table.name}: {table.title}", (Facts((("source", table.source),)), grid))


def document(result: RoundedTable) -> dict[str, Any]:
    """`balcli.table/1`: the exact figures, the printed texts, and the errata."""
    table = result.table
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


def rows(result: RoundedTable, _system: System) -> Rows:
    """CSV: the exact figures, or with the decimals that are asked for."""
    table, digits = result

    def cell(value: Cell) -> Cell:
        return value if digits is None or not isinstance(value, float) else f"{value:.{digits}f}"

    return Rows(table.columns, [[cell(value) for value in row] for row in table.exact])


def count_deviations(table: Table) -> str:
    """A sentence on how many of the printed figures are not the exact ones rounded."""
    words = [text for row in table.printed for text in row[table.stub :] if text is not None]
    printed = sum(
        parse_decimal(text) is not None or parse_fraction(text) is not None for text in words
    )
    wrong = len(table.errata)
    if not printed:
        return "no printed source"
    if not wrong:
        return f"all {printed} printed figures agree"
    return f"{wrong} of {printed} printed figures deviate (exact ≠ printed)"


# ------------------------------------------------------------------ cells
def _shown(table: Table, i: int, j: int, digits: int | None) -> str:
    """A cell as the print would have it, followed by the print where that deviates."""
    value, text = table.exact[i][j], table.printed[i][j]
    like = text or next((row[j] for row in table.printed if row[j]), None)
    named = j < table.stub or (text is None and _is_whole(like, value))
    shown = _rounded_like(text, value, None if named else digits)
    return f"{shown} ≠ {text}" if text is not None and deviates(value, text) else shown


def _is_word(cell: Cell) -> bool:
    return isinstance(cell, str) and parse_decimal(cell) is None and parse_fraction(cell) is None


def _is_whole(text: str | None, value: Cell) -> bool:
    """Whether a whole number is printed as one, such as an angle."""
    printed = text is not None and text.lstrip("+-").isdigit()
    return printed and isinstance(value, (int, float)) and float(value).is_integer()


def _rounded_like(text: str | None, value: Cell, digits: int | None) -> str:
    """A value with these decimals, or as the printed text has it: its decimals, its sign, and
    whether a 0 stands before the point.
    """
    if not isinstance(value, (int, float)):
        return value or ""
    like = parse_decimal(text) if text else None
    if digits is not None and not _is_whole(text, value):
        return f"{value:.{digits}f}"
    if like is None or text is None:
        return f"{value:.6g}"
    shown = f"{round_like(value, like):f}"
    if text.lstrip("+-").startswith(".") and abs(value) < 1:
        shown = shown.replace("0.", ".", 1)
    return f"+{shown}" if text.startswith("+") else shown

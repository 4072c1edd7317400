"""The recomputed tables: sheets for terminal and Markdown, JSON, CSV.

Sheets are laid out as the print is, each figure rounded to the printed digits (or to `digits` decimals); where the
print deviates it follows: `.4313 ≠ .4312`. JSON and CSV hold full precision.
"""
from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterable, Sequence
from dataclasses import asdict

from ..tables.table import Cell, Erratum, Table, deviates, figure, rational, rounded
from .sheet import Facts, Grid, Sheet

ERRATA = ("table", "row", "column", "printed", "exact", "kind")
NAMES = ("name", "title", "source", "errata")


def table_json(table: Table) -> str:
    """One table: recomputed and printed rows, errata."""
    return _json({
        "format": "balcli.table/1", "name": table.name, "title": table.title, "source": table.source,
        "columns": table.columns, "rows": table.rows, "printed": table.printed,
        "errata": [asdict(e) for e in table.errata],
    })


def table_csv(table: Table, digits: int | None = None) -> str:
    """Headings and recomputed rows, in full precision unless digits are asked for."""
    def text(value: Cell) -> Cell:
        return value if digits is None or not isinstance(value, float) else f"{value:.{digits}f}"
    return _csv([table.columns, *([text(value) for value in row] for row in table.rows)])


def table_sheet(table: Table, digits: int | None = None) -> Sheet:
    """Source, the table as printed, and how many figures deviate."""
    rows = tuple(tuple(_shown(table, i, j, digits) for j in range(len(table.columns))) for i in range(len(table.rows)))
    wrong = frozenset((e.row, table.columns.index(e.column)) for e in table.errata)
    grid = Grid("", table.columns, rows, note=count(table), marked=wrong)
    return Sheet(f"{table.name}: {table.title}", (Facts((("source", table.source),)), grid))


def count(table: Table) -> str:
    """How many of the printed figures deviate."""
    words = [text for row in table.printed for text in row[table.stub:] if text is not None]
    printed, wrong = sum(figure(text) is not None or rational(text) is not None for text in words), len(table.errata)
    if not printed:
        return "nothing printed to compare with"
    return f"{wrong} of {printed} printed figures deviate (exact ≠ printed)" if wrong else f"all {printed} figures agree"


# ------------------------------------------------------------------ lists over tables
def errata_json(tables: Iterable[Table]) -> str:
    """One list over all tables, each item with its table's name."""
    return _json([{"name": table.name, **asdict(e)} for table in tables for e in table.errata])


def errata_csv(tables: Iterable[Table]) -> str:
    """One line an erratum."""
    return _csv([ERRATA, *_errata(tables)])


def errata_sheet(tables: Iterable[Table]) -> Sheet:
    """The same, and their number."""
    rows = tuple(_errata(tables))
    note = f"{len(rows)} printed figures are not the exact ones rounded"
    return Sheet("Errata", (Grid("", ERRATA, rows, note=note),))


def names_json(tables: Iterable[Table]) -> str:
    """Name, title, source and number of errata of each table."""
    return _json([dict(zip(NAMES, (t.name, t.title, t.source, len(t.errata)), strict=True)) for t in tables])


def names_csv(tables: Iterable[Table]) -> str:
    """The same, one line a table."""
    return _csv([NAMES, *((t.name, t.title, t.source, str(len(t.errata))) for t in tables)])


def names_sheet(tables: Iterable[Table]) -> Sheet:
    """The tables under their sources."""
    listed = list(tables)
    rows = tuple((t.name, str(len(t.errata)), t.title, t.source) for t in listed)
    note = f"{sum(len(t.errata) for t in listed)} errata; balcli tables NAME shows a table, --errata lists them"
    return Sheet("Printed tables, recomputed", (Grid("", ("name", "errata", "title", "source"), rows, note=note),))


# ------------------------------------------------------------------ cells
def _errata(tables: Iterable[Table]) -> list[tuple[str, ...]]:
    return [(t.name, t.label(e.row), e.column, e.printed, _exact(e), e.kind) for t in tables for e in t.errata]


def _exact(erratum: Erratum) -> str:
    return f"{erratum.exact:.8g}" if isinstance(erratum.exact, float) else str(erratum.exact)


def _shown(table: Table, i: int, j: int, digits: int | None) -> str:
    """A cell as the print would have it, followed by the print where that deviates."""
    value, text = table.rows[i][j], table.printed[i][j]
    shown = _cell(value, text, None if j < table.stub else digits)
    return f"{shown} ≠ {text}" if text is not None and deviates(value, text) else shown


def _cell(value: Cell, text: str | None, digits: int | None) -> str:
    if not isinstance(value, (int, float)):
        return value or ""
    like = figure(text) if text else None
    whole = like is not None and like == like.to_integral_value() and value.is_integer()
    if digits is not None and not whole:
        return f"{value:.{digits}f}"
    if like is None or text is None:
        return f"{value:.6g}"
    shown = f"{rounded(value, like):f}"
    shown = shown.replace("0.", ".", 1) if text.lstrip("+-").startswith(".") and abs(value) < 1 else shown
    return f"+{shown}" if text.startswith("+") else shown


def _json(document: object) -> str:
    return json.dumps(document, ensure_ascii=False, allow_nan=False)


def _csv(rows: Iterable[Sequence[Cell]]) -> str:
    out = io.StringIO()
    csv.writer(out, lineterminator="\n").writerows(rows)
    return out.getvalue()

"""The recomputed tables: sheets for terminal and Markdown, JSON, CSV.

Sheets are laid out as the print is, each figure rounded to the printed digits (or to `digits`
decimals); where the print deviates it follows: `.4313 ≠ .4312`. JSON and CSV hold full precision.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict
from typing import Any

from ..tables.recomputed import (
    Cell,
    Erratum,
    Table,
    deviates,
    parse_decimal,
    parse_fraction,
    round_like,
)
from .csv import write
from .formats import Format, render
from .sheet import Facts, Grid, Sheet

ERRATA = ("table", "row", "column", "printed", "exact", "kind")
NAMES = ("name", "title", "source", "errata")


def table(
    result: Table, form: Format, digits: int | None = None, *, into_file: bool = False
) -> str:
    """One table."""

    def text(value: Cell) -> Cell:
        return value if digits is None or not isinstance(value, float) else f"{value:.{digits}f}"

    return render(
        form,
        sheets=lambda: [table_sheet(result, digits)],
        documents=lambda: [_document(result)],
        rows=lambda: write(result.columns, ([text(value) for value in row] for row in result.rows)),
        into_file=into_file,
    )


def errata(results: Sequence[Table], form: Format, *, into_file: bool = False) -> str:
    """The errata of some tables; JSON is one list, each item with its table's name."""
    return render(
        form,
        sheets=lambda: [errata_sheet(results)],
        documents=lambda: [[{"name": t.name, **asdict(e)} for t in results for e in t.errata]],
        rows=lambda: write(ERRATA, _errata(results)),
        into_file=into_file,
    )


def names(results: Sequence[Table], form: Format, *, into_file: bool = False) -> str:
    """Which tables there are, and how many errata each has."""
    lines = [(t.name, t.title, t.source, len(t.errata)) for t in results]
    return render(
        form,
        sheets=lambda: [names_sheet(results)],
        rows=lambda: write(NAMES, lines),
        into_file=into_file,
        documents=lambda: [[dict(zip(NAMES, line, strict=True)) for line in lines]],
    )


# ------------------------------------------------------------------ sheets and documents
def _document(result: Table) -> dict[str, Any]:
    return {
        "format": "balcli.table/1",
        "name": result.name,
        "title": result.title,
        "source": result.source,
        "columns": result.columns,
        "rows": result.rows,
        "printed": result.printed,
        "errata": [asdict(e) for e in result.errata],
    }


def table_sheet(table: Table, digits: int | None = None) -> Sheet:
    """Source, the table as printed, and how many figures deviate."""
    rows = tuple(
        tuple(_shown(table, i, j, digits) for j in range(len(table.columns)))
        for i in range(len(table.rows))
    )
    wrong = frozenset((e.row, table.columns.index(e.column)) for e in table.errata)
    words = tuple(
        j
        for j in range(len(table.columns))
        if j == 0 or all(_is_word(row[j]) for row in table.rows)
    )
    grid = Grid("", table.columns, rows, note=count(table), marked=wrong, words=words)
    return Sheet(f"{table.name}: {table.title}", (Facts((("source", table.source),)), grid))


def count(table: Table) -> str:
    """How many of the printed figures deviate."""
    words = [text for row in table.printed for text in row[table.stub :] if text is not None]
    printed, wrong = (
        sum(parse_decimal(text) is not None or parse_fraction(text) is not None for text in words),
        len(table.errata),
    )
    if not printed:
        return "nothing printed to compare with"
    if not wrong:
        return f"all {printed} printed figures agree"
    return f"{wrong} of {printed} printed figures deviate (exact ≠ printed)"


def errata_sheet(tables: Iterable[Table]) -> Sheet:
    """All errata, and their number."""
    rows = tuple(_errata(tables))
    note = f"{len(rows)} printed figures are not the exact ones rounded"
    return Sheet("Errata", (Grid("", ERRATA, rows, note=note, words=(0, 1, 2, 5)),))


def names_sheet(tables: Iterable[Table]) -> Sheet:
    """The tables under their sources."""
    listed = list(tables)
    rows = tuple((t.name, str(len(t.errata)), t.title, t.source) for t in listed)
    note = (
        f"{sum(len(t.errata) for t in listed)} errata; balcli tables NAME shows a table, "
        "--errata "
        "lists them"
    )
    return Sheet(
        "Printed tables, recomputed",
        (Grid("", ("name", "errata", "title", "source"), rows, note=note, words=(0, 2, 3)),),
    )


# ------------------------------------------------------------------ cells
def _errata(tables: Iterable[Table]) -> Iterator[tuple[str, ...]]:
    return (
        (t.name, t.label(e.row), e.column, e.printed, _exact(e), e.kind)
        for t in tables
        for e in t.errata
    )


def _exact(erratum: Erratum) -> str:
    return f"{erratum.exact:.8g}" if isinstance(erratum.exact, float) else str(erratum.exact)


def _shown(table: Table, i: int, j: int, digits: int | None) -> str:
    """A cell as the print would have it, followed by the print where that deviates."""
    value, text = table.rows[i][j], table.printed[i][j]
    shown = _cell(value, text, None if j < table.stub else digits)
    return f"{shown} ≠ {text}" if text is not None and deviates(value, text) else shown


def _is_word(cell: Cell) -> bool:
    return isinstance(cell, str) and parse_decimal(cell) is None and parse_fraction(cell) is None


def _cell(value: Cell, text: str | None, digits: int | None) -> str:
    if not isinstance(value, (int, float)):
        return value or ""
    like = parse_decimal(text) if text else None
    whole = text is not None and text.lstrip("+-").isdigit() and float(value).is_integer()
    if digits is not None and not whole:
        return f"{value:.{digits}f}"
    if like is None or text is None:
        return f"{value:.6g}"
    shown = f"{round_like(value, like):f}"
    shown = (
        shown.replace("0.", ".", 1)
        if text.lstrip("+-").startswith(".") and abs(value) < 1
        else shown
    )
    return f"+{shown}" if text.startswith("+") else shown

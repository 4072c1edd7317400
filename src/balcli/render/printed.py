"""The recomputed tables as text: one function a format, result in, text out.

Tables and Markdown are laid out as the print is, each figure rounded to the printed digits (or to `digits` decimals); a
figure that the print has wrong is followed by a star and by what is printed. JSON and CSV hold full precision.
"""
from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict

from ..tables.table import Cell, Erratum, Table, deviates, figure, rounded

ERRATA = ("table", "row", "column", "printed", "exact", "kind")
NAMES = ("name", "title", "source", "errata")


def as_json(table: Table) -> str:
    """The document of CONTRACT 5."""
    return _json({
        "format": "balcli.table/1", "name": table.name, "title": table.title, "source": table.source,
        "columns": table.columns, "rows": table.rows, "printed": table.printed,
        "errata": [asdict(e) for e in table.errata],
    })


def as_csv(table: Table, digits: int | None = None) -> str:
    """Headings and recomputed rows, in full precision unless digits are asked for."""
    def text(value: Cell) -> Cell:
        return value if digits is None or not isinstance(value, float) else _fixed(value, digits)
    return _csv([table.columns, *([text(value) for value in row] for row in table.rows)])


def as_markdown(table: Table, digits: int | None = None) -> str:
    """Source, table, and the number of deviating figures."""
    grid = _markdown(table.columns, _shown(table, digits))
    return "\n\n".join([f"**{table.name}**: {table.title}", table.source, grid, count(table)]) + "\n"


def as_text(table: Table, digits: int | None = None, *, width: int | None = None, colour: bool = False) -> str:
    """For the terminal; without a width nothing is cut or wrapped."""
    body = _grid(table.columns, _shown(table, digits), table.stub, width, colour)
    return f"{table.name}: {table.title}\n{table.source}\n{body}{count(table)}\n"


def count(table: Table) -> str:
    """How many printed figures deviate."""
    printed = sum(text is not None and figure(text) is not None for row in table.printed for text in row[table.stub:])
    wrong = len(table.errata)
    return f"{wrong or 'none'} of {printed} printed figures deviate{' (*)' if wrong else 's'}"


# ------------------------------------------------------------------ lists
def errata_rows(tables: Iterable[Table]) -> list[tuple[str, ...]]:
    """The errata of some tables as words: table, row, column, printed, exact, kind."""
    return [(table.name, table.label(e.row), e.column, e.printed, _exact(e), e.kind)
            for table in tables for e in table.errata]


def errata_json(tables: Iterable[Table]) -> str:
    """One list over all tables, each item with its table's name."""
    return _json([{"name": table.name, **asdict(e)} for table in tables for e in table.errata])


def names_rows(tables: Iterable[Table]) -> list[tuple[str, ...]]:
    """Name, title, source and number of errata of each table."""
    return [(t.name, t.title, t.source, str(len(t.errata))) for t in tables]


def names_json(tables: Iterable[Table]) -> str:
    return _json([{"name": t.name, "title": t.title, "source": t.source, "errata": len(t.errata)} for t in tables])


def list_csv(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    return _csv([head, *rows])


def list_markdown(head: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    return _markdown(head, rows) + "\n"


def list_text(head: Sequence[str], rows: Sequence[Sequence[str]], *, width: int | None = None,
              colour: bool = False) -> str:
    return _grid(head, rows, len(head), width, colour)


# ------------------------------------------------------------------ cells
def _shown(table: Table, digits: int | None) -> list[list[str]]:
    return [list(_row(row, words, table.stub, digits)) for row, words in zip(table.rows, table.printed, strict=True)]


def _row(row: Sequence[Cell], words: Sequence[str | None], stub: int, digits: int | None) -> Iterator[str]:
    for j, (value, text) in enumerate(zip(row, words, strict=True)):
        shown = _cell(value, text, None if j < stub else digits)
        yield f"{shown}* ({text})" if text is not None and deviates(value, text) else shown


def _cell(value: Cell, text: str | None, digits: int | None) -> str:
    """The exact value as the print would have it."""
    if not isinstance(value, (int, float)):
        return value or ""
    like = figure(text) if text else None
    if digits is not None and not (value.is_integer() and (like is None or like == like.to_integral_value())):
        return _fixed(value, digits)
    if like is None or text is None:
        return f"{value:.6g}"
    shown = f"{rounded(value, like):f}"
    shown = shown.replace("0.", ".", 1) if text.lstrip("+-").startswith(".") and abs(value) < 1 else shown
    return f"+{shown}" if text.startswith("+") else shown


def _fixed(value: float, digits: int) -> str:
    return f"{value:.{digits}f}"


def _exact(erratum: Erratum) -> str:
    return f"{erratum.exact:.8g}" if isinstance(erratum.exact, float) else str(erratum.exact)


# ------------------------------------------------------------------ grids
def _json(document: object) -> str:
    return json.dumps(document, ensure_ascii=False, allow_nan=False) + "\n"


def _csv(rows: Iterable[Sequence[Cell]]) -> str:
    out = io.StringIO()
    csv.writer(out, lineterminator="\n").writerows(rows)
    return out.getvalue()


def _markdown(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    def line(cells: Iterable[str]) -> str:
        return "| " + " | ".join(cell.replace("|", r"\|") for cell in cells) + " |"
    return "\n".join([line(head), "|" + " --- |" * len(head), *map(line, rows)])


def _grid(head: Sequence[str], rows: Iterable[Sequence[str]], stub: int, width: int | None, colour: bool) -> str:
    from rich import box
    from rich.console import Console
    from rich.table import Table as Grid
    from rich.text import Text
    grid = Grid(box=box.SIMPLE, pad_edge=False)
    for j, heading in enumerate(head):
        grid.add_column(Text(heading), justify="left" if j < stub else "right", no_wrap=width is None)
    for row in rows:
        grid.add_row(*(Text(cell, style="bold red" if "* (" in cell else "") for cell in row))
    out = io.StringIO()
    Console(file=out, width=width or 10_000, force_terminal=colour, no_color=not colour).print(grid)
    return "\n".join(line.rstrip() for line in out.getvalue().splitlines()) + "\n"

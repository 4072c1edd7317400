"""Which printed tables there are, and how many errata each has."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ..printed_tables.recomputed import Table
from .csv import Rows
from .formats import Renderer
from .sheet import Grid, Sheet
from .units import System

COLUMNS = ("name", "title", "source", "errata")


def sheet(tables: Sequence[Table], _system: System) -> Sheet:
    """A table a row, and what to ask next; where they were printed, by their names' first word."""
    lines = tuple((t.name, str(len(t.errata)), t.title) for t in tables)
    errata = sum(len(t.errata) for t in tables)
    note = f"{errata} errata; balcli tables NAME shows a table, --errata lists them"
    titles = Grid("", ("name", "errata", "title"), lines, note=note, words=(0, 2))
    sources = {t.name.partition("-")[0]: t.source.partition(", Table ")[0] for t in tables}
    printed = Grid("Sources", ("tables", "printed in"), tuple(sources.items()), words=(0, 1))
    return Sheet("Printed tables, recomputed", (titles, printed))


def document(tables: Sequence[Table]) -> list[dict[str, Any]]:
    """One list, an entry a table."""
    return [dict(zip(COLUMNS, line, strict=True)) for line in _lines(tables)]


def rows(tables: Sequence[Table], _system: System) -> Rows:
    """CSV: a table a line."""
    return Rows(COLUMNS, _lines(tables))


def _lines(tables: Sequence[Table]) -> list[tuple[str, str, str, int]]:
    return [(t.name, t.title, t.source, len(t.errata)) for t in tables]


RENDERER = Renderer(sheet=sheet, document=document, rows=rows)

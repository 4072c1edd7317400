"""Printed figures that are not the exact ones rounded, of several tables."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict
from typing import Any

from ..printed_tables.recomputed import Erratum, Table
from .csv import Rows
from .formats import Renderer
from .sheet import Grid, Sheet
from .units import System

COLUMNS = ("table", "row", "column", "printed", "exact", "kind")


def sheet(tables: Sequence[Table], _system: System) -> Sheet:
    """All errata, a row each, and their number."""
    lines = tuple(_lines(tables))
    note = f"{len(lines)} printed figures are not the exact ones rounded"
    return Sheet("Errata", (Grid("", COLUMNS, lines, note=note, words=(0, 1, 2, 5)),))


def document(tables: Sequence[Table]) -> list[dict[str, Any]]:
    """One list, each erratum with its table's name."""
    return [{"name": t.name, **asdict(e)} for t in tables for e in t.errata]


def rows(tables: Sequence[Table], _system: System) -> Rows:
    """CSV: an erratum a line."""
    return Rows(COLUMNS, _lines(tables))


def _lines(tables: Sequence[Table]) -> Iterator[tuple[str, ...]]:
    for t in tables:
        for e in t.errata:
            yield t.name, t.label(e.row), e.column, e.printed, _exact(e), e.kind


def _exact(erratum: Erratum) -> str:
    return f"{erratum.exact:.8g}" if isinstance(erratum.exact, float) else str(erratum.exact)


RENDERER = Renderer(sheet=sheet, document=document, rows=rows)

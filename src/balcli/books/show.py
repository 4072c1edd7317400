"""Show recomputed tables, their errata, the list of tables, and the table of common layouts.

A table is laid out like its print, with each exact figure rounded to the printed decimals. If the
printed figure deviates, it follows the exact one: `.4313 ≠ .4312`. JSON and CSV have full
precision.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import TypeAlias

from ..core.records import Node, to_document
from ..show.formats import Renderer, Rows
from ..show.sheet import UNKNOWN, Facts, Grid, Sheet, Text, number
from ..show.table import WIDTH, fold
from ..show.units import System
from .answer import find_gaps
from .recomputed import (
    ANSWER,
    CLASSES,
    STATEMENT,
    Cell,
    Erratum,
    Row,
    Table,
    deviates,
    parse_decimal,
    parse_number,
    round_like,
)


def sheet(table: Table, _system: System) -> Sheet:
    """Return the source, the table laid out as printed, and the number of deviating figures."""
    facts, title = Facts((("source", table.source),)), f"{table.name}: {table.title}"
    if STATEMENT in table.columns:
        return Sheet(title, (facts, *map(_lay_out_statement, table.errata), _explain(table.errata)))
    columns = range(len(table.columns))
    words = tuple(
        j
        for j in columns
        if j == 0 or all(isinstance(row[j], str) and not _is_figure(row[j]) for row in table.exact)
    )
    cells = tuple(tuple(_shown(table, i, j) for j in columns) for i, _ in enumerate(table.exact))
    marked = frozenset((e.row, table.columns.index(e.column)) for e in table.errata)
    grid = Grid("", table.columns, cells, count_deviations(table), marked, words)
    return Sheet(title, (facts, grid))


def rows(table: Table, _system: System) -> Rows:
    """Return the exact figures as CSV, in full precision."""

    return Rows(table.columns, table.exact)


def count_deviations(table: Table) -> str:
    """Return a sentence on how many printed figures differ from the rounded exact ones."""
    printed = sum(_is_figure(text) for row in table.printed for text in row[table.stub :])
    wrong = f"{len(table.errata)} of {printed} printed figures deviate (exact ≠ printed)"
    return wrong if printed else "no printed source"


# ------------------------------------------------------------------ cells
def _is_figure(cell: Cell) -> bool:
    return parse_decimal(str(cell)) is not None or parse_number(cell) is not None


def _shown(table: Table, i: int, j: int) -> str:
    """Return a cell in the form of the print, followed by the print if it deviates."""
    value, text = table.exact[i][j], table.printed[i][j]
    shown = _round_as_printed(value, text or "") if isinstance(value, (int, float)) else value or ""
    return f"{shown} ≠ {text}" if text is not None and deviates(value, text) else shown


def _round_as_printed(value: float, text: str) -> str:
    """Return a value in the form of the printed text: its decimals, its plus sign, and whether a 0
    precedes the point.
    """
    like = parse_decimal(text)
    if like is None:
        return f"{value:.6g}"
    shown = f"{round_like(value, like):f}"
    if text.lstrip("+-").startswith(".") and abs(value) < 1:
        shown = shown.replace("0.", ".", 1)
    return f"+{shown}" if text.startswith("+") else shown


RENDERER = Renderer(sheet=sheet, rows=rows)


_SHOWN_OF_ERRATUM = ("row", "column", "printed", "exact")
Errata: TypeAlias = Sequence[tuple[str, Erratum]]


def lay_out_errata(errata: Errata, _system: System) -> Sheet:
    """Return a grid for each table and cause, a paragraph for each statement, and the classes."""
    groups: dict[tuple[str, str, str], list[Erratum]] = {}
    for table, e in errata:
        kind = "" if e.column in (STATEMENT, ANSWER) else e.kind
        groups.setdefault((table, e.category, kind), []).append(e)
    parts: list[Grid | Text] = []
    for (table, category, kind), members in groups.items():
        if kind:
            rows = tuple((e.label, e.column, e.printed, _exact(e)) for e in members)
            note = kind if kind != category else ""
            parts.append(Grid(f"{table}, {category}", _SHOWN_OF_ERRATUM, rows, note))
        else:
            parts += map(_lay_out_statement, members)
    return Sheet("Errata", (*parts, _explain([e for _, e in errata])))


def _lay_out_statement(e: Erratum) -> Text:
    title = "\n".join(fold(f"{e.label} ({e.category})", WIDTH))
    return Text(title, (f"printed: {e.printed}", f"right: {_exact(e)}", e.kind))


def _explain(errata: Sequence[Erratum]) -> Grid:
    """Return the classes of these errata, with their counts and meanings."""
    counts = Counter(e.category for e in errata)
    rows = tuple((name, str(counts[name]), text) for name, text in CLASSES.items() if counts[name])
    figures = sum(e.column != STATEMENT for e in errata)
    note = f"{figures} printed figures, {len(errata) - figures} equations and sentences"
    return Grid("Classes", ("class", "errata", "meaning"), rows, note=note, words=(0, 2))


def describe_errata(errata: Errata) -> list[Node]:
    """Return the errata as a list for JSON, each with its table's name."""
    return [{"name": table, **to_document(e)} for table, e in errata]


def list_errata(errata: Errata, _system: System) -> Rows:
    """Return CSV with one erratum in each line."""
    columns = ("table", *_SHOWN_OF_ERRATUM, "kind", "class")
    lines = [(t, e.label, e.column, e.printed, _exact(e), e.kind, e.category) for t, e in errata]
    return Rows(columns, lines)


def _exact(erratum: Erratum) -> str:
    return f"{erratum.exact:.8g}" if isinstance(erratum.exact, float) else str(erratum.exact)


ERRATA = Renderer(sheet=lay_out_errata, document=describe_errata, rows=list_errata)


def lay_out_list(tables: Sequence[Table], _system: System) -> Sheet:
    """Return a list of the tables with their errata, and a list of sources."""
    lines = tuple((t.name, str(len(t.errata)), t.title) for t in tables)
    errata = sum(len(t.errata) for t in tables)
    note = f"{errata} errata; --errata lists them, tables NAME shows one table"
    titles = Grid("", ("name", "errata", "title"), lines, note=note, words=(0, 2))
    sources = {t.name.partition("-")[0]: t.source.partition(", Table ")[0] for t in tables}
    printed = Grid("Sources", ("tables", "printed in"), tuple(sources.items()), words=(0, 1))
    return Sheet("Printed tables, recomputed", (titles, printed))


def describe_list(tables: Sequence[Table]) -> list[Node]:
    """Return a list for JSON with an entry for each table."""
    return [
        {"name": t.name, "title": t.title, "source": t.source, "errata": len(t.errata)}
        for t in tables
    ]


def list_tables(tables: Sequence[Table], _system: System) -> Rows:
    """Return CSV with one table in each line."""
    entries = describe_list(tables)
    return Rows([*entries[0]], [[*entry.values()] for entry in entries])


TABLE_LIST = Renderer(sheet=lay_out_list, document=describe_list, rows=list_tables)


_SHOWN = ("F1", "F2", "M1", "M2")
_NOTE = (
    "Largest values: F1 as a multiple of m r ω² (m: reciprocating mass of a cylinder, r: crank "
    "radius, ω: crank speed), F2 of A2 m r ω² (A2 ≈ r / rod length), M1 and M2 of these two "
    "forces times the distance of neighbouring throws. --format csv adds orders 4 and 6 and "
    "smallest values; balcli engines lists the engines as files."
)


def lay_out_layouts(table: Table, _system: System) -> Sheet:
    """Return force and moment of orders 1 and 2, and the firing intervals of each engine."""
    places = [table.columns.index(f"{name}_major") for name in _SHOWN]

    def cells(row: Row) -> tuple[str, ...]:
        name, title, *_ = map(str, row)
        multiples = (number(float(row[k] or 0.0)) for k in places)
        gaps = "/".join(f"{gap:g}" for gap in find_gaps(name))  # such as 90/150 for uneven firing
        return title.partition(" (")[0], *multiples, gaps or UNKNOWN

    rows = tuple(map(cells, table.exact))
    grid = Grid("", ("engine", *_SHOWN, "fires every"), rows, note=_NOTE)
    return Sheet("Free forces and moments of common engines", (grid,))


LAYOUTS = Renderer(sheet=lay_out_layouts, rows=rows)


def lay_out_published(table: Table, _system: System) -> Sheet:
    """Return a table for each chapter (forces, balancing and so on), with a line for each problem
    and the verdicts on its figures.
    """
    places = [table.columns.index(name) for name in ("chapter", "source", "title", "verdict")]
    chapters: dict[str, dict[str, Counter[str]]] = {}
    for chapter, source, title, verdict in ([str(row[k]) for k in places] for row in table.exact):
        problems = chapters.setdefault(chapter, {})
        problems.setdefault(f"{source}: {title}", Counter()).update([verdict])
    grids = []
    for chapter, problems in chapters.items():
        rows = tuple((name, _tell_verdicts(verdicts)) for name, verdicts in problems.items())
        grids.append(Grid(chapter, ("problem", "figures"), rows, words=(0, 1)))
    told = _tell_verdicts(Counter(str(row[places[-1]]) for row in table.exact))
    note = (
        f"{sum(map(len, chapters.values()))} problems, {len(table.exact)} figures: {told} "
        "(listed by --errata). --format csv lists every figure."
    )
    return Sheet(table.title, (*grids, Text("", (note,))))


_VERDICTS = {
    "agrees": "in all digits",
    "rounded": "within rounding",
    "definition": "by another definition",
    "wrong": "wrong in the source",
}


def _tell_verdicts(verdicts: Counter[str]) -> str:
    told = (f"{verdicts[key]} {words}" for key, words in _VERDICTS.items() if verdicts[key])
    return ", ".join(told)


PUBLISHED = Renderer(sheet=lay_out_published, rows=rows)

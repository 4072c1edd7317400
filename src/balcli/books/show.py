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
from ..show.sheet import UNKNOWN, Column, Facts, Grid, Sheet, Text, number
from ..show.table import WIDTH, fold
from ..show.units import System
from .answer import PUBLISHED as PUBLISHED_PROBLEMS, SourceTables, find_gaps
from .recomputed import (
    ANSWER,
    CLASSES,
    STATEMENT,
    Cell,
    Erratum,
    Table,
    deviates,
    parse_decimal,
    parse_number,
    round_like,
)
from .sources import SOURCES


def sheet(table: Table, _system: System) -> Sheet:
    """Return the source, the table laid out as printed, and the number of deviating figures."""
    facts = Facts((("source", table.source),))
    title = f"{table.name}: {table.title}"
    if STATEMENT in table.columns:
        return Sheet(title, (facts, *map(_lay_out_statement, table.errata), _explain(table.errata)))
    columns = []
    for j, head in enumerate(table.columns):
        cells = [_shown(table, i, j) for i, _ in enumerate(table.exact)]
        words = j == 0 or all(_is_word(row[j]) for row in table.exact)
        marked = [erratum.row for erratum in table.errata if erratum.column == head]
        columns.append(Column(head, cells, words, marked))
    grid = Grid("", columns, count_deviations(table))
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


def _is_word(cell: Cell) -> bool:
    return isinstance(cell, str) and not _is_figure(cell)


def _shown(table: Table, i: int, j: int) -> str:
    """Return a cell in the form of the print, followed by the print if it deviates."""
    value = table.exact[i][j]
    text = table.printed[i][j]
    shown = _round_as_printed(value, text or "") if isinstance(value, (int, float)) else value or ""
    return f"{shown} ≠ {text}" if text is not None and deviates(value, text) else shown


def _round_as_printed(value: float, text: str) -> str:
    """Return a value in the form of the printed text: its decimals, its plus sign, and whether a 0
    precedes the point.
    """
    like = parse_decimal(text)
    if like is None:
        return number(value, 6)
    shown = f"{round_like(value, like):f}"
    if text.lstrip("+-").startswith(".") and abs(value) < 1:
        shown = shown.replace("0.", ".", 1)
    return f"+{shown}" if text.startswith("+") else shown


RENDERER = Renderer(sheet=sheet, rows=rows)


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
            columns = [
                Column("row", [e.label for e in members], words=True),
                Column("column", [e.column for e in members]),
                Column("printed", [e.printed for e in members]),
                Column("exact", [_exact(e) for e in members]),
            ]
            note = kind if kind != category else ""
            parts.append(Grid(f"{table}, {category}", columns, note))
        else:
            parts += map(_lay_out_statement, members)
    return Sheet("Errata", (*parts, _explain([e for _, e in errata])))


def _lay_out_statement(e: Erratum) -> Text:
    title = "\n".join(fold(f"{e.label} ({e.category})", WIDTH))
    return Text(title, (f"printed: {e.printed}", f"right: {_exact(e)}", e.kind))


def _explain(errata: Sequence[Erratum]) -> Grid:
    """Return the classes of these errata, with their counts and meanings."""
    counts = Counter(e.category for e in errata)
    found = [name for name in CLASSES if counts[name]]
    columns = [
        Column("class", found, words=True),
        Column("errata", [str(counts[name]) for name in found]),
        Column("meaning", [CLASSES[name] for name in found], words=True),
    ]
    figures = sum(e.column != STATEMENT for e in errata)
    note = f"{figures} printed figures, {len(errata) - figures} equations and sentences"
    return Grid("Classes", columns, note)


def describe_errata(errata: Errata) -> list[Node]:
    """Return the errata as a list for JSON, each with its table's name."""
    return [{"name": table, **to_document(e)} for table, e in errata]


def list_errata(errata: Errata, _system: System) -> Rows:
    """Return CSV with one erratum in each line."""
    columns = ("table", "row", "column", "printed", "exact", "kind", "class")
    lines = [(t, e.label, e.column, e.printed, _exact(e), e.kind, e.category) for t, e in errata]
    return Rows(columns, lines)


def _exact(erratum: Erratum) -> str:
    return f"{erratum.exact:.8g}" if isinstance(erratum.exact, float) else str(erratum.exact)


ERRATA = Renderer(sheet=lay_out_errata, document=describe_errata, rows=list_errata)


def lay_out_list(tables: Sequence[Table], _system: System) -> Sheet:
    """Return a list of the tables with their errata, and a list of sources."""
    columns = [
        Column("name", [t.name for t in tables], words=True),
        Column("errata", [str(len(t.errata)) for t in tables]),
        Column("title", [t.title for t in tables], words=True),
    ]
    of_problems = sum(len(t.errata) for t in tables if t.name == PUBLISHED_PROBLEMS)
    errata = sum(len(t.errata) for t in tables) - of_problems
    note = (
        f"{errata} errata of the five sources (--errata lists them, --errata liu those of liu), "
        f"{of_problems} of published problems (--errata {PUBLISHED_PROBLEMS}). tables NAME shows "
        "one table, tables liu what there is of that source."
    )
    printed = [
        Column("source", [source.key for source in SOURCES], words=True),
        Column("printed in", [source.citation for source in SOURCES], words=True),
    ]
    parts = (Grid("", columns, note), Grid("Sources", printed))
    return Sheet("Printed tables, recomputed", parts)


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


def lay_out_source(found: SourceTables, _system: System) -> Sheet:
    """Return the tables of a source and its wrong statements, a line for each."""
    tables = found.tables
    columns = [
        Column("name", [table.name for table in tables], words=True),
        Column("errata", [str(len(table.errata)) for table in tables]),
        Column("title", [table.title for table in tables], words=True),
    ]
    wrong = [
        Column("place", [e.place for e in found.statements], words=True),
        Column("printed", [e.printed for e in found.statements], words=True),
        Column("right", [_exact(e) for e in found.statements], words=True),
    ]
    key = found.source.key
    parts: list[Facts | Grid] = [
        Facts((("source", found.source.citation),)),
        Grid("Tables", columns, f"tables {key}-… shows a table, tables --errata {key} all errata"),
    ]
    if found.statements:
        parts.append(Grid("Wrong equations and sentences", wrong))
    return Sheet(f"{key}: {found.source.authors}", tuple(parts))


def describe_source(found: SourceTables) -> Node:
    """Return tables and wrong statements of a source for JSON."""
    return {
        "format": "balcli.source/1",
        "source": found.source.key,
        "citation": found.source.citation,
        "tables": describe_list(found.tables),
        "statements": describe_errata([("statements", e) for e in found.statements]),
    }


def list_source(found: SourceTables, _system: System) -> Rows:
    """Return CSV with a line for each table, and one for each wrong statement."""
    lines = [("table", t.name, t.title, len(t.errata), None) for t in found.tables]
    wrong = [("statement", e.label, e.printed, None, _exact(e)) for e in found.statements]
    return Rows(("kind", "name", "text", "errata", "right"), [*lines, *wrong])


SOURCE = Renderer(sheet=lay_out_source, document=describe_source, rows=list_source)
TABLE_LIST = Renderer(sheet=lay_out_list, document=describe_list, rows=list_tables)


_NOTE = (
    "Largest values: F1 as a multiple of m r ω² (m: reciprocating mass of a cylinder, r: crank "
    "radius, ω: crank speed), F2 of A2 m r ω² (A2 ≈ r / rod length), M1 and M2 of these two "
    "forces times the distance of neighbouring throws. --format csv adds orders 4 and 6 and "
    "smallest values; balcli engines lists the engines as files."
)


def lay_out_layouts(table: Table, _system: System) -> Sheet:
    """Return force and moment of orders 1 and 2, and the firing intervals of each engine."""
    names = map(str, _list_exact(table, "engine"))
    titles = [str(title).partition(" (")[0] for title in _list_exact(table, "layout")]
    # Such as 90/150 for uneven firing.
    gaps = ["/".join(f"{gap:g}" for gap in find_gaps(name)) for name in names]
    columns = [Column("engine", titles, words=True)]
    for name in ("F1", "F2", "M1", "M2"):
        sizes = _list_exact(table, f"{name}_major")
        columns.append(Column(name, [number(float(size or 0.0)) for size in sizes]))
    columns.append(Column("fires every", [each or UNKNOWN for each in gaps]))
    grid = Grid("", columns, _NOTE)
    return Sheet("Free forces and moments of common engines", (grid,))


def _list_exact(table: Table, heading: str) -> list[Cell]:
    """Return the exact cells of a column."""
    place = table.columns.index(heading)
    return [row[place] for row in table.exact]


LAYOUTS = Renderer(sheet=lay_out_layouts, rows=rows)


def lay_out_published(table: Table, _system: System) -> Sheet:
    """Return a table for each chapter (forces, balancing and so on), with a line for each problem
    and the verdicts on its figures.
    """
    verdicts = [str(verdict) for verdict in _list_exact(table, "verdict")]
    names = ("chapter", "source", "title")
    places = zip(*(_list_exact(table, name) for name in names), strict=True)
    chapters: dict[str, dict[str, Counter[str]]] = {}
    for (chapter, source, title), verdict in zip(places, verdicts, strict=True):
        problems = chapters.setdefault(str(chapter), {})
        problems.setdefault(f"{source}: {title}", Counter()).update([verdict])
    grids = []
    for chapter, problems in chapters.items():
        figures = [_tell_verdicts(counts) for counts in problems.values()]
        columns = [
            Column("problem", [*problems], words=True),
            Column("figures", figures, words=True),
        ]
        grids.append(Grid(chapter, columns))
    told = _tell_verdicts(Counter(verdicts))
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

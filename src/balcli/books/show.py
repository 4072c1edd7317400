"""Show recomputed tables, their errata, the list of tables, and the table of common layouts.

A table is laid out like its print, with each exact figure rounded to the printed decimals. If the
printed figure deviates, it follows the exact one: `.4313 ≠ .4312`. JSON and CSV have full
precision.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from typing import NamedTuple, TypeAlias

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
    columns = [_lay_out_column(table, j) for j, _ in enumerate(table.columns)]
    grid = Grid("", columns, count_deviations(table))
    return Sheet(title, (facts, grid))


def _lay_out_column(table: Table, j: int) -> Column:
    """Return a column with the printed figures that deviate beside the exact ones."""
    head = table.columns[j]
    cells = []
    only_words = True
    for i, row in enumerate(table.exact):
        cells.append(_show_cell(table, i, j))
        only_words = only_words and _is_word(row[j])
    marked = [erratum.row for erratum in table.errata if erratum.column == head]
    return Column(head, cells, j == 0 or only_words, marked)


def rows(table: Table, _system: System) -> Rows:
    """Return the exact figures as CSV, in full precision."""
    return Rows(table.columns, table.exact)


def count_deviations(table: Table) -> str:
    """Return a sentence on how many printed figures differ from the rounded exact ones."""
    printed = 0
    for row in table.printed:
        printed += sum(map(_is_figure, row[table.stub :]))
    if printed == 0:
        return "no printed source"
    return f"{len(table.errata)} of {printed} printed figures deviate (exact ≠ printed)"


# ------------------------------------------------------------------ cells
def _is_figure(cell: Cell) -> bool:
    return parse_decimal(str(cell)) is not None or parse_number(cell) is not None


def _is_word(cell: Cell) -> bool:
    return isinstance(cell, str) and not _is_figure(cell)


def _show_cell(table: Table, i: int, j: int) -> str:
    """Return a cell in the form of the print, followed by the print if it deviates."""
    value = table.exact[i][j]
    text = table.printed[i][j]
    if isinstance(value, (int, float)):
        exact = _round_as_printed(value, text or "")
    else:
        exact = value or ""
    if text is None or not deviates(value, text):
        return exact
    return f"{exact} ≠ {text}"


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


class _Cause(NamedTuple):
    """What the errata of one grid have in common; `kind` is empty for statements."""

    table: str
    category: str
    kind: str


def lay_out_errata(errata: Errata, _system: System) -> Sheet:
    """Return a grid for each table and cause, a paragraph for each statement, and the classes."""
    groups: dict[_Cause, list[Erratum]] = {}
    for table, erratum in errata:
        is_statement = erratum.column in (STATEMENT, ANSWER)
        cause = _Cause(table, erratum.category, "" if is_statement else erratum.kind)
        groups.setdefault(cause, []).append(erratum)
    parts: list[Grid | Text] = []
    for cause, members in groups.items():
        if cause.kind:
            parts.append(_lay_out_figures(cause, members))
        else:
            parts += map(_lay_out_statement, members)
    parts.append(_explain([erratum for _, erratum in errata]))
    return Sheet("Errata", tuple(parts))


def _lay_out_figures(cause: _Cause, errata: Sequence[Erratum]) -> Grid:
    """Return a table of wrong figures with the same cause."""
    heads = [Column("row", words=True), Column("column"), Column("printed"), Column("exact")]
    rows = []
    for erratum in errata:
        rows.append((erratum.label, erratum.column, erratum.printed, _write_exact(erratum)))
    note = cause.kind if cause.kind != cause.category else ""
    return Grid.of_rows(f"{cause.table}, {cause.category}", heads, rows, note)


def _lay_out_statement(erratum: Erratum) -> Text:
    title = "\n".join(fold(f"{erratum.label} ({erratum.category})", WIDTH))
    right = f"right: {_write_exact(erratum)}"
    return Text(title, (f"printed: {erratum.printed}", right, erratum.kind))


def _explain(errata: Sequence[Erratum]) -> Grid:
    """Return the classes of these errata, with their counts and meanings."""
    counts = Counter(erratum.category for erratum in errata)
    heads = [Column("class", words=True), Column("errata"), Column("meaning", words=True)]
    rows = []
    for name, meaning in CLASSES.items():
        if counts[name]:
            rows.append((name, str(counts[name]), meaning))
    figures = sum(erratum.column != STATEMENT for erratum in errata)
    note = f"{figures} printed figures, {len(errata) - figures} equations and sentences"
    return Grid.of_rows("Classes", heads, rows, note)


def describe_errata(errata: Errata) -> list[Node]:
    """Return the errata as a list for JSON, each with its table's name."""
    return [{"name": table, **to_document(erratum)} for table, erratum in errata]


def list_errata(errata: Errata, _system: System) -> Rows:
    """Return CSV with one erratum in each line."""
    columns = ("table", "row", "column", "printed", "exact", "kind", "class")
    lines = []
    for table, e in errata:
        line = (table, e.label, e.column, e.printed, _write_exact(e), e.kind, e.category)
        lines.append(line)
    return Rows(columns, lines)


def _write_exact(erratum: Erratum) -> str:
    if isinstance(erratum.exact, float):
        return f"{erratum.exact:.8g}"
    return str(erratum.exact)


ERRATA = Renderer(sheet=lay_out_errata, document=describe_errata, rows=list_errata)


OUTSIDE = (
    "docs/sources.md names the command for every equation, table and figure of the five. Outside "
    "balcli: finite-element stress, fatigue and reliability; lateral vibration, whirling and "
    "gyroscopic moments of shafts; analysis of recorded vibration traces; dry-friction dampers."
)


def lay_out_list(tables: Sequence[Table], _system: System) -> Sheet:
    """Return a list of the tables with their errata, and a list of sources."""
    of_problems = 0
    of_sources = 0
    for table in tables:
        if table.name == PUBLISHED_PROBLEMS:
            of_problems += len(table.errata)
        else:
            of_sources += len(table.errata)
    note = (
        f"{of_sources} errata of the five sources "
        "(--errata lists them, --errata liu those of liu), "
        f"{of_problems} of published problems (--errata {PUBLISHED_PROBLEMS}). tables NAME shows "
        "one table, tables liu what there is of that source."
    )
    printed = [
        Column("source", [source.key for source in SOURCES], words=True),
        Column("printed in", [source.citation for source in SOURCES], words=True),
    ]
    parts = (_tabulate("", tables, note), Grid("Sources", printed, OUTSIDE))
    return Sheet("Printed tables, recomputed", parts)


def _tabulate(title: str, tables: Iterable[Table], note: str) -> Grid:
    """Return name, number of errata and title of each table."""
    heads = [Column("name", words=True), Column("errata"), Column("title", words=True)]
    rows = [(table.name, str(len(table.errata)), table.title) for table in tables]
    return Grid.of_rows(title, heads, rows, note)


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


def lay_out_source(book: SourceTables, _system: System) -> Sheet:
    """Return the tables of a source and its wrong statements, a line for each."""
    key = book.source.key
    note = f"tables {key}-… shows a table, tables --errata {key} all errata"
    parts: list[Facts | Grid] = [
        Facts((("source", book.source.citation),)),
        _tabulate("Tables", book.tables, note),
    ]
    if book.statements:
        names = ("place", "printed", "right")
        heads = [Column(name, words=True) for name in names]
        wrong = [(e.place, e.printed, _write_exact(e)) for e in book.statements]
        parts.append(Grid.of_rows("Wrong equations and sentences", heads, wrong))
    return Sheet(f"{key}: {book.source.authors}", tuple(parts))


def describe_source(book: SourceTables) -> Node:
    """Return tables and wrong statements of a source for JSON."""
    return {
        "format": "balcli.source/1",
        "source": book.source.key,
        "citation": book.source.citation,
        "tables": describe_list(book.tables),
        "statements": describe_errata([("statements", e) for e in book.statements]),
    }


def list_source(book: SourceTables, _system: System) -> Rows:
    """Return CSV with a line for each table, and one for each wrong statement."""
    lines: list[tuple[object, ...]] = []
    for table in book.tables:
        lines.append(("table", table.name, table.title, len(table.errata), None))
    for erratum in book.statements:
        right = _write_exact(erratum)
        lines.append(("statement", erratum.label, erratum.printed, None, right))
    return Rows(("kind", "name", "text", "errata", "right"), lines)


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
    titles = [str(title).partition(" (")[0] for title in _list_exact(table, "layout")]
    columns = [Column("engine", titles, words=True)]
    for name in ("F1", "F2", "M1", "M2"):
        sizes = _list_exact(table, f"{name}_major")
        columns.append(Column(name, [number(float(size or 0.0)) for size in sizes]))
    intervals = [_tell_intervals(str(name)) for name in _list_exact(table, "engine")]
    columns.append(Column("fires every", intervals))
    grid = Grid("", columns, _NOTE)
    return Sheet("Free forces and moments of common engines", (grid,))


def _tell_intervals(engine: str) -> str:
    """Return the firing intervals of an engine, such as 90/150 for uneven firing."""
    gaps = [f"{gap:g}" for gap in find_gaps(engine)]
    return "/".join(gaps) or UNKNOWN


def _list_exact(table: Table, heading: str) -> list[Cell]:
    """Return the exact cells of a column."""
    place = table.columns.index(heading)
    return [row[place] for row in table.exact]


LAYOUTS = Renderer(sheet=lay_out_layouts, rows=rows)


def lay_out_published(table: Table, _system: System) -> Sheet:
    """Return a table for each chapter (forces, balancing and so on), with a line for each problem
    and the verdicts on its figures.
    """
    chapter_column = _list_exact(table, "chapter")
    source_column = _list_exact(table, "source")
    title_column = _list_exact(table, "title")
    verdicts = [str(verdict) for verdict in _list_exact(table, "verdict")]
    chapters: dict[str, dict[str, Counter[str]]] = {}
    for chapter, source, title, verdict in zip(
        chapter_column, source_column, title_column, verdicts, strict=True
    ):
        problems = chapters.setdefault(str(chapter), {})
        problems.setdefault(f"{source}: {title}", Counter()).update([verdict])
    heads = [Column("problem", words=True), Column("figures", words=True)]
    grids = []
    for name, problems in chapters.items():
        rows = [(problem, _tell_verdicts(counts)) for problem, counts in problems.items()]
        grids.append(Grid.of_rows(name, heads, rows))
    count = sum(map(len, chapters.values()))
    note = (
        f"{count} problems, {len(table.exact)} figures: {_tell_verdicts(Counter(verdicts))} "
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
    parts = []
    for key, words in _VERDICTS.items():
        if verdicts[key]:
            parts.append(f"{verdicts[key]} {words}")
    return ", ".join(parts)


PUBLISHED = Renderer(sheet=lay_out_published, rows=rows)

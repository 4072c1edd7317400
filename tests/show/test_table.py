"""Plain text without rich is what rich prints where there is no terminal: the same lay-out, letter for letter."""

from io import StringIO

from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text as Line
from support.cases import cases
from support.paths import ENGINES

from balcli import analyze, load
from balcli.analysis import comparison, show as analysis
from balcli.analysis.comparison import compare
from balcli.show.sheet import Column, Facts, Grid, Sheet, Text, View
from balcli.show.table import PROSE, WIDTH, count_places, fold, write_text
from balcli.show.units import SYSTEMS

WIDE = 100_000


def print_by_rich(sheets: list[Sheet]) -> str:
    """The sheets as rich prints them into a file of unlimited width."""
    buffer = StringIO()
    console = Console(file=buffer, width=WIDE, highlight=False, emoji=False, markup=False, soft_wrap=True)
    for sheet in sheets:
        console.print(Line(sheet.title))
        for part in sheet.parts:
            console.print()
            if part.title:
                console.print(Line(part.title))
            for piece in pieces_for_rich(part):
                whole = isinstance(piece, Table) and isinstance(part, Grid)
                console.print(piece, width=None if whole else WIDTH, soft_wrap=whole)
        console.print()
    return "\n".join(line.rstrip() for line in buffer.getvalue().splitlines())


def pieces_for_rich(part: Grid | Facts | Text) -> list:
    match part:
        case Grid():
            return [grid_for_rich(part), *([Line(part.note)] if part.note else [])]
        case Facts():
            table = Table.grid(padding=(0, 2))
            for name, value in part.pairs:
                table.add_row(name, value)
            return [table]
        case Text():
            return list(part.paragraphs)


def grid_for_rich(grid: Grid) -> Table:
    table = Table(box=box.SIMPLE_HEAD, padding=(0, 1, 0, 1), pad_edge=False, show_edge=False)
    for column in grid.columns:
        folded = {"overflow": "fold", "max_width": PROSE} if table.columns and column.words else {"no_wrap": True}
        table.add_column(column.head, justify="left" if column.words else "right", **folded)
    for row in grid.rows:
        table.add_row(*map(Line, row))
    return table


def test_an_analysis_and_a_comparison_are_as_rich_prints_them():
    si = SYSTEMS["si"]
    engines = [load(ENGINES / f"{name}.toml") for name in ("single", "i4", "vr6")]
    sheets = [
        analysis.sheet(analyze(engines[0]), si, View()),
        comparison.sheet(compare(*engines, names=["single", "i4", "vr6"]), si),
    ]
    assert write_text(sheets) == print_by_rich(sheets)


LETTERS = "a few words of different length, 七气缸 and e\u0301tude, μ − ω"
LONG = "x" * 60 + " end"


@cases("show/table", "any_grid_is_as_rich_prints_it", LETTERS=LETTERS, LONG=LONG)
def test_any_grid_is_as_rich_prints_it(cells):
    words = (Column("no.", words=True), Column("what it is", words=True), Column("figure"))
    figures = (Column("no."), Column("what it is"), Column("figure"))
    parts = (
        Grid.of_rows("Title of the grid", words, cells, "A note."),
        Grid.of_rows("", figures, cells),
        Facts((("μ", LETTERS), ("name of a fact", "1"), ("七", "2"))),
        Text("Title", (LETTERS, LONG, "")),
    )
    sheets = [Sheet("七 cylinders", parts), Sheet("second", parts[:1])]
    assert write_text(sheets) == print_by_rich(sheets)


def test_words_are_folded_between_blanks_and_long_ones_within():
    assert fold("one two three", 7) == ["one two", "three"]
    assert fold("one twothree four", 6) == ["one", "twothr", "ee", "four"]
    assert fold("short", 5) == ["short"]


def test_letters_take_the_places_they_have_in_a_terminal():
    counted = [count_places(text) for text in ("abc", "a − ω", "七气缸", "e\u0301", "")]
    assert counted == [3, 5, 6, 1, 0]


def test_control_characters_command_nobody():
    sheet = Sheet("a\x1b[31m", (Text("", ("b\u202e", "c\x9b")),))
    assert write_text([sheet]) == "a?[31m\n\nb?\nc?\n"


def sheet_of_figures(figure):
    """A table whose row of six equal figures is wide."""
    columns = [Column("step", ["2 counterweights at every throw"], words=True)]
    columns += [Column(f"a head of several words, unit {k}", [figure]) for k in range(6)]
    return Sheet("s", (Grid("", columns),))


def test_a_wide_table_is_narrowed_to_80_columns_but_no_figure_is_folded():
    lines = write_text([sheet_of_figures("12345.6 ≠ 7")]).splitlines()
    assert max(map(len, lines[2:])) > 80  # six figures of 11 places do not fit
    assert any(line.count("12345.6 ≠ 7") == 6 for line in lines)
    lines = write_text([sheet_of_figures("12345")]).splitlines()
    assert max(map(len, lines)) == 80
    assert " ".join(" ".join(lines).split()).count("12345") == 6

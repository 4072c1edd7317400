"""Sheets in a terminal, by rich: with colours, and folded to its width."""

from __future__ import annotations

from collections.abc import Iterator
from io import StringIO

from rich import box
from rich.console import Console, RenderableType
from rich.table import Table
from rich.text import Text as Line

from ..errors import legible
from .sheet import Facts, Grid, Sheet, Text
from .table import LABEL, column_texts, count_places, longest_word, share_out


def terminal(sheets: list[Sheet]) -> str:
    """Return all sheets as text with escapes for the terminal in which they are seen."""
    buffer = StringIO()
    console = Console(
        file=buffer,
        highlight=False,
        emoji=False,
        markup=False,
        force_terminal=True,  # whatever FORCE_COLOR says
    )
    for sheet in sheets:
        console.print(Line(legible(sheet.title), style="bold"))
        for part in sheet.parts:
            console.print()
            if part.title:
                console.print(Line(part.title, style="bold"))
            for piece in _pieces(part, console.width):
                console.print(piece)
        console.print()
    return "\n".join(line.rstrip() for line in buffer.getvalue().splitlines())


def _pieces(part: Grid | Facts | Text, width: int) -> Iterator[RenderableType]:
    """Yield the content of a part, which stands under its title."""
    match part:
        case Grid():
            yield from _fitting(part, width)
            if part.note:
                yield Line(part.note, style="dim")
        case Facts():
            yield _facts_table(part)
        case Text():
            yield from part.paragraphs


def _fitting(grid: Grid, width: int) -> Iterator[Table]:
    """Yield the table unfolded, or narrowed to fit. Figures are never broken: a table that is still
    too wide is divided into pieces, each with the first column.
    """
    natural = [max(map(count_places, column_texts(grid, k))) for k in range(len(grid.columns))]
    for gap in (3, 2):
        if sum(natural) + gap * (len(natural) - 1) <= width:
            yield _grid_table(grid, dict(enumerate(natural)), gap)
            return
    broken = grid._replace(columns=tuple(name.replace("_", "_ ") for name in grid.columns))
    least = [longest_word(column_texts(broken, k)) for k in range(len(grid.columns))]
    least[0] = max(least[0], min(natural[0], LABEL))
    piece = [0]
    for k in range(1, len(least)):
        if len(piece) > 1 and sum(least[j] for j in [*piece, k]) + 2 * len(piece) > width:
            yield _grid_table(grid, share_out(width, piece, least, natural), 2)
            piece = [0]
        piece.append(k)
    yield _grid_table(grid, share_out(width, piece, least, natural), 2)


def _grid_table(grid: Grid, widths: dict[int, int], gap: int) -> Table:
    table = Table(box=box.SIMPLE_HEAD, padding=(0, gap - 2, 0, 1), pad_edge=False, show_edge=False)
    for k, width in widths.items():
        table.add_column(
            _fold(grid.columns[k], width),
            justify="left" if k in grid.words else "right",
            overflow="fold",
            style="bold" if k == 0 else "",
            max_width=width,
        )
    for i, row in enumerate(grid.rows):
        table.add_row(
            *(Line(row[k], style="bold red" if (i, k) in grid.marked else "") for k in widths)
        )
    return table


def _fold(heading: str, width: int) -> str:
    """Return the lines of a heading, broken between words or after an underscore of a name."""
    lines = [""]
    for word in heading.split():
        gap = " " if lines[-1] else ""
        for part in word.replace("_", "_ ").split():
            if lines[-1] and count_places(lines[-1] + gap + part) > width:
                lines.append(part)
            else:
                lines[-1] += gap + part
            gap = ""
    return "\n".join(lines)


def _facts_table(facts: Facts) -> Table:
    table = Table.grid(padding=(0, 2))
    table.add_column(style="dim")
    table.add_column(overflow="fold")
    for name, value in facts.pairs:
        table.add_row(name, value)
    return table

"""A sheet for the terminal, or as plain text, with figures of unlimited width, where the output is
no terminal.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from io import StringIO
from typing import TYPE_CHECKING, Any

from ..errors import legible
from .sheet import Facts, Grid, Sheet, Text

if TYPE_CHECKING:
    from rich.table import Table

UNLIMITED = 100_000
LABEL = 12  # width up to which the headings of rows (`order 10`) are not folded either
PROSE = (
    50  # width at which columns of words are folded where no terminal has one; figures never are
)


def terminal(sheets: list[Sheet], *, seen: bool = False) -> str:
    """All sheets as text: with colours and folded to the width of the terminal in which they are
    seen, else plain and as wide as they are.
    """
    from rich.console import Console
    from rich.text import Text as Line

    buffer = StringIO()
    console = Console(
        file=buffer,
        highlight=False,
        emoji=False,
        markup=False,
        soft_wrap=not seen,
        force_terminal=seen,  # whatever FORCE_COLOR says
        width=None if seen else UNLIMITED,
        no_color=None if seen else True,
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
    text = "\n".join(line.rstrip() for line in buffer.getvalue().splitlines())
    return text if seen else legible(text)


def _pieces(part: Grid | Facts | Text, width: int) -> Iterator[Any]:
    """What is printed of a part under its title."""
    from rich.text import Text as Line

    match part:
        case Grid():
            yield from _fitting(part, width)
            if part.note:
                yield Line(part.note, style="dim")
        case Facts():
            yield _facts(part)
        case Text():
            yield from part.paragraphs


def _fitting(grid: Grid, width: int) -> Iterator[Table]:
    """The table as wide as it likes to be, else narrowed; figures are never broken, so one that is
    still too wide comes in pieces, each with the first column.
    """
    natural = [max(map(len, _texts(grid, k))) for k in range(len(grid.columns))]
    if width == UNLIMITED:
        natural = [
            min(size, PROSE) if k and k in grid.words else size for k, size in enumerate(natural)
        ]
    for gap in (3, 2):
        if sum(natural) + gap * (len(natural) - 1) <= width:
            yield _grid(grid, dict(enumerate(natural)), gap)
            return
    grid = replace(
        grid, columns=tuple(name.replace("_", " ") for name in grid.columns)
    )  # may be broken into lines
    least = [
        max((len(word) for text in _texts(grid, k) for word in text.split()), default=1)
        for k in range(len(grid.columns))
    ]
    least[0] = max(least[0], min(natural[0], LABEL))
    piece = [0]
    for k in range(1, len(least)):
        if len(piece) > 1 and sum(least[j] for j in [*piece, k]) + 2 * len(piece) > width:
            yield _grid(grid, _shared_out(width, piece, least, natural), 2)
            piece = [0]
        piece.append(k)
    yield _grid(grid, _shared_out(width, piece, least, natural), 2)


def _texts(grid: Grid, k: int) -> list[str]:
    """Everything that stands in a column."""
    return [grid.columns[k], *(row[k] for row in grid.rows)]


def _shared_out(
    width: int, columns: list[int], least: list[int], natural: list[int]
) -> dict[int, int]:
    """Width of each column: the least, and what is left over to the one that lacks most, until
    there is none.
    """
    widths = {k: least[k] for k in columns}
    for _ in range(width - sum(widths.values()) - 2 * (len(columns) - 1)):
        needy = max(columns, key=lambda k: natural[k] - widths[k])
        widths[needy] += natural[needy] > widths[needy]
    return widths


def _grid(grid: Grid, widths: dict[int, int], gap: int) -> Table:
    from rich import box
    from rich.table import Table
    from rich.text import Text as Cell

    table = Table(box=box.SIMPLE_HEAD, padding=(0, gap - 2, 0, 1), pad_edge=False, show_edge=False)
    for k, width in widths.items():
        table.add_column(
            grid.columns[k],
            justify="left" if k in grid.words else "right",
            overflow="fold",
            style="bold" if k == 0 else "",
            max_width=width,
        )
    for i, row in enumerate(grid.rows):
        table.add_row(
            *(Cell(row[k], style="bold red" if (i, k) in grid.marked else "") for k in widths)
        )
    return table


def _facts(facts: Facts) -> Table:
    from rich.table import Table

    table = Table.grid(padding=(0, 2))
    table.add_column(style="dim")
    table.add_column(overflow="fold")
    for name, value in facts.pairs:
        table.add_row(name, value)
    return table

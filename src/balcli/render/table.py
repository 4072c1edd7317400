"""A sheet for the terminal, or as plain text of unlimited width where the output is no terminal."""
from __future__ import annotations

import sys
from io import StringIO
from typing import TYPE_CHECKING

from .sheet import Facts, Grid, Sheet, Text

if TYPE_CHECKING:
    from rich.table import Table

UNLIMITED = 100_000


def seen(into_file: bool) -> bool:
    """Whether a person looks at a terminal."""
    return sys.stdout.isatty() and not into_file


def terminal(sheets: list[Sheet], *, into_file: bool = False) -> str:
    """All sheets as text: with colours and folded to the width where a person looks at a terminal, else plain and unfolded."""
    from rich.console import Console
    from rich.text import Text as Line

    person = seen(into_file)
    buffer = StringIO()
    console = Console(file=buffer, highlight=False, emoji=False, markup=False, soft_wrap=not person,
                      **({"force_terminal": True} if person else {"width": UNLIMITED, "no_color": True}))
    for sheet in sheets:
        console.print(Line(sheet.title, style="bold"))
        for part in sheet.parts:
            console.print()
            match part:
                case Grid():
                    if part.title:
                        console.print(Line(part.title, style="bold"))
                    console.print(_grid(part))
                    if part.note:
                        console.print(Line(part.note, style="dim"))
                case Facts():
                    if part.title:
                        console.print(Line(part.title, style="bold"))
                    console.print(_facts(part))
                case Text():
                    console.print(Line(part.title, style="bold"))
                    for paragraph in part.paragraphs:
                        console.print(paragraph)
        console.print()
    return "\n".join(line.rstrip() for line in buffer.getvalue().splitlines())


def _grid(grid: Grid) -> Table:
    from rich import box
    from rich.table import Table
    from rich.text import Text as Cell

    table = Table(box=box.SIMPLE_HEAD, padding=(0, 1), pad_edge=False, show_edge=False)
    for k, column in enumerate(grid.columns):
        table.add_column(column, justify="left" if k in grid.words else "right", overflow="fold", style="bold" if k == 0 else "")
    for i, row in enumerate(grid.rows):
        table.add_row(*(Cell(cell, style="bold red" if (i, k) in grid.marked else "") for k, cell in enumerate(row)))
    return table


def _facts(facts: Facts) -> Table:
    from rich.table import Table

    table = Table.grid(padding=(0, 2))
    table.add_column(style="dim")
    table.add_column(overflow="fold")
    for name, value in facts.pairs:
        table.add_row(name, value)
    return table

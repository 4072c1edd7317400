"""A sheet as Markdown."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from itertools import chain

from ..errors import legible
from .sheet import Facts, Grid, Sheet, Text

_SPECIAL = re.compile(r"([\\`*_{}\[\]<>#|~])")


def markdown(sheets: list[Sheet]) -> str:
    """All sheets as Markdown, one after the other."""
    return "\n\n".join(chain.from_iterable(map(_blocks, sheets))) + "\n"


def escape(text: str) -> str:
    """Text that Markdown leaves as it is."""
    return _SPECIAL.sub(r"\\\1", legible(text.replace("\n", " ")))


def _blocks(sheet: Sheet) -> Iterator[str]:
    """Title and parts, which blank lines separate."""
    yield f"# {escape(sheet.title)}"
    yield from map(_part, sheet.parts)


def _part(part: Grid | Facts | Text) -> str:
    head = f"## {escape(part.title)}\n\n" if part.title else ""
    match part:
        case Grid():
            return (
                head + "\n".join(_lines(part)) + (f"\n\n{escape(part.note)}" if part.note else "")
            )
        case Facts():
            return head + "\n".join(
                f"- {escape(name)}: {escape(value)}" for name, value in part.pairs
            )
        case Text():
            return head + "\n\n".join(escape(p) for p in part.paragraphs)


def _lines(grid: Grid) -> Iterator[str]:
    """Heading, rule and rows of a table."""
    yield _line(map(escape, grid.columns))
    yield _line("---" if k in grid.words else "---:" for k in range(len(grid.columns)))
    for i, row in enumerate(grid.rows):
        yield _line(
            f"**{escape(cell)}**" if (i, k) in grid.marked else escape(cell)
            for k, cell in enumerate(row)
        )


def _line(cells: Iterable[str]) -> str:
    return "| " + " | ".join(cells) + " |"

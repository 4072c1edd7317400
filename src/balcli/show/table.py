"""Sheets as plain text and as Markdown.

Plain text is what rich would print without colours; importing rich takes longer than all else that
a command does.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from itertools import chain, zip_longest

from ..errors import legible
from .sheet import Facts, Grid, Sheet, Text

WIDTH = 80  # of prose, and of tables as far as they can be folded
GAP = 3  # blanks between the columns of a grid
FACTS_GAP = 2  # between names and what they are
LABEL = 12  # width up to which the headings of rows (`order 10`) are not folded
PROSE = 50  # width at which columns of words are folded; figures never are
_SINGLE = frozenset("–−…≠≤≥→∠⋅θλμπψω")  # what we write ourselves takes one place each


def plain_text(sheets: Sequence[Sheet]) -> str:
    """Return all sheets one after the other, no line with blanks at its end."""
    text = "\n".join(line for sheet in sheets for line in _lines(sheet))
    return legible("\n".join(line.rstrip() for line in text.split("\n")))


def _lines(sheet: Sheet) -> Iterator[str]:
    yield sheet.title
    for part in sheet.parts:
        yield ""
        if part.title:
            yield part.title
        match part:
            case Grid():
                yield from _grid_lines(part)
                if part.note:
                    yield from fold(part.note, WIDTH)
            case Facts():
                yield from _fact_lines(part)
            case Text():
                yield from chain.from_iterable(fold(p, WIDTH) for p in part.paragraphs)
    yield ""


def _grid_lines(grid: Grid) -> Iterator[str]:
    """Yield headings, a rule, and the rows; words to the left, figures to the right."""
    every = range(len(grid.columns))
    natural = [_measure(grid, k) for k in every]
    narrow = [_narrow(grid, k) for k in every]
    whole = [natural[0], *narrow[1:]]  # the headings of rows on one line
    for gap, least in ((GAP, natural), (2, whole), (1, whole), (2, narrow)):
        if sum(least) + gap * (len(least) - 1) <= WIDTH:
            break
    widths = list(share_out(WIDTH, every, least, natural, gap).values())
    yield from _row_lines(grid.columns, widths, grid.words, gap)
    yield "─" * (sum(widths) + gap * (len(widths) - 1))
    for row in grid.rows:
        yield from _row_lines(row, widths, grid.words, gap)


def _measure(grid: Grid, k: int) -> int:
    """Return the width of a column."""
    widest = max(map(count_places, column_texts(grid, k)))
    return min(widest, PROSE) if k and k in grid.words else widest


def _narrow(grid: Grid, k: int) -> int:
    """Return the least width of a column; figures are never folded."""
    head, *cells = column_texts(grid, k)
    if k in grid.words:
        return max(longest_word([head, *cells]), min(_measure(grid, k), LABEL) if not k else 0)
    return max([longest_word([head]), *map(count_places, cells)])


def column_texts(grid: Grid, k: int) -> list[str]:
    """Return all texts in a column, its head first.

    Args:
        grid: Table.
        k: Number of the column, from 0.
    """
    return [grid.columns[k], *(row[k] for row in grid.rows)]


def longest_word(texts: Iterable[str]) -> int:
    """Return the width of the longest word in places."""
    return max((count_places(word) for text in texts for word in text.split()), default=1)


def share_out(
    width: int, columns: Sequence[int], least: Sequence[int], natural: Sequence[int], gap: int = 2
) -> dict[int, int]:
    """Return the width of each column: the least width, and the remaining width place by place to
    the column that lacks most.

    Args:
        width: Width of the table.
        columns: Columns in it.
        least: Least width of every column.
        natural: Width of every column without folding.
        gap: Blanks between columns.
    """
    widths = {k: least[k] for k in columns}
    for _ in range(width - sum(widths.values()) - gap * (len(columns) - 1)):
        needy = max(columns, key=lambda k: natural[k] - widths[k])
        widths[needy] += natural[needy] > widths[needy]
    return widths


def _row_lines(
    cells: Sequence[str], widths: Sequence[int], words: Sequence[int], gap: int
) -> Iterator[str]:
    """Yield one line, or as many as the longest of its cells takes when it is folded."""
    folded = [fold(cell, width) for cell, width in zip(cells, widths, strict=True)]
    for pieces in zip_longest(*folded, fillvalue=""):
        columns = enumerate(zip(pieces, widths, strict=True))
        yield (" " * gap).join(_justify(*cell, to_the_left=k in words) for k, cell in columns)


def _justify(text: str, width: int, *, to_the_left: bool) -> str:
    blanks = " " * (width - count_places(text))
    return text + blanks if to_the_left else blanks + text


def fold(text: str, width: int) -> list[str]:
    """Return a text in lines, broken between words, and within a word that is longer than a line.

    Args:
        text: Text on one line.
        width: Largest width of a line.
    """
    if count_places(text) <= width:
        return [text]
    lines = [""]
    for word in text.split(" "):
        longer = f"{lines[-1]} {word}" if lines[-1] else word
        if count_places(longer) <= width:
            lines[-1] = longer
            continue
        lines.append("")
        for letter in word:
            if count_places(lines[-1] + letter) > width:
                lines.append("")
            lines[-1] += letter
    return [line for line in lines if line]


def _fact_lines(facts: Facts) -> Iterator[str]:
    """Yield names to the left, their values to the right."""
    width = max((count_places(name) for name, _ in facts.pairs), default=0)
    room = max(WIDTH - width - FACTS_GAP, PROSE)
    for name, value in facts.pairs:
        for k, line in enumerate(fold(value, room)):
            yield _justify("" if k else name, width, to_the_left=True) + " " * FACTS_GAP + line


def count_places(text: str) -> int:
    """Return how many places a text takes where every letter is as wide as another, or twice as
    wide.
    """
    if text.isascii() or all(letter < "\u0300" or letter in _SINGLE for letter in text):
        return len(text)
    from rich.cells import cell_len  # knows Unicode's wide and combining letters

    return cell_len(text)


_SPECIAL = re.compile(r"([\\`*_{}\[\]<>#|~])")


def markdown(sheets: list[Sheet]) -> str:
    """Return all sheets as Markdown, one after the other."""
    return "\n\n".join(chain.from_iterable(map(_blocks, sheets))) + "\n"


def escape(text: str) -> str:
    """Return a text that Markdown leaves as it is."""
    return _SPECIAL.sub(r"\\\1", legible(text.replace("\n", " ")))


def _blocks(sheet: Sheet) -> Iterator[str]:
    """Yield title and parts, which blank lines separate."""
    yield f"# {escape(sheet.title)}"
    yield from map(_part, sheet.parts)


def _part(part: Grid | Facts | Text) -> str:
    head = f"## {escape(part.title)}\n\n" if part.title else ""
    match part:
        case Grid():
            return (
                head
                + "\n".join(_list_rows(part))
                + (f"\n\n{escape(part.note)}" if part.note else "")
            )
        case Facts():
            return head + "\n".join(
                f"- {escape(name)}: {escape(value)}" for name, value in part.pairs
            )
        case Text():
            return head + "\n\n".join(escape(p) for p in part.paragraphs)


def _list_rows(grid: Grid) -> Iterator[str]:
    """Yield heading, rule and rows of a table."""
    yield _line(map(escape, grid.columns))
    yield _line("---" if k in grid.words else "---:" for k in range(len(grid.columns)))
    for i, row in enumerate(grid.rows):
        yield _line(
            f"**{escape(cell)}**" if (i, k) in grid.marked else escape(cell)
            for k, cell in enumerate(row)
        )


def _line(cells: Iterable[str]) -> str:
    return "| " + " | ".join(cells) + " |"

"""Write sheets as text, plain or with the styles of a terminal, and as Markdown.

Tables are laid out here, not by rich: rich folds figures if a table is too wide, and its import
takes a tenth of the run time of `analyze`.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from itertools import chain, zip_longest

from ..errors import legible
from .sheet import Facts, Grid, Sheet, Text

WIDTH = 80  # width of prose, and of tables if folding allows
GAP = 3  # number of blanks between the columns of a grid
FACTS_GAP = 2  # number of blanks between names and their values
LABEL = 12  # headings of rows up to this width (`order 10`) are not folded
PROSE = 50  # largest width of columns of words; figures are never folded
_SINGLE = frozenset("–−…≠≤≥→∠⋅θλμπψω")  # letters in texts of balcli that take one place


Piece = tuple[str, str]  # part of a line: text, and style in a terminal
_BOLD, _DIM, _RED, _PLAIN = "1", "2", "1;31", ""  # ANSI codes


def write_text(sheets: Sequence[Sheet], width: int | None = None, *, styled: bool = False) -> str:
    """Return all sheets as text, one after the other, without blanks at the ends of lines. Figures
    are never folded: a table that is wider than the terminal is divided into several, each with the
    first column.

    Args:
        sheets: Sheets to write.
        width: Width of the terminal; None: no terminal shows the text, and no table is divided.
        styled: Whether escape sequences make titles bold and notes dim.
    """
    lines = (line for sheet in sheets for line in _lines(sheet, width))
    return "\n".join(
        "".join(_paint(text, style * styled) for text, style in line).rstrip() for line in lines
    )


def _paint(text: str, style: str) -> str:
    text = legible(text)
    return f"\x1b[{style}m{text}\x1b[0m" if style and text.strip() else text


def _lines(sheet: Sheet, terminal: int | None) -> Iterator[list[Piece]]:
    width = terminal or WIDTH
    yield [(sheet.title, _BOLD)]
    for part in sheet.parts:
        yield []
        if part.title:
            yield [(part.title, _BOLD)]
        match part:
            case Grid():
                for grid in _divide(part, width) if terminal else (part,):
                    yield from _grid_lines(grid, width)
                for note in part.note.split("\n"):
                    yield from ([(line, _DIM)] for line in fold(note, width) if line)
            case Facts():
                yield from _fact_lines(part, width)
            case Text():
                for paragraph in part.paragraphs:
                    yield from ([(line, _PLAIN)] for line in fold(paragraph, width))
    yield []


def _divide(grid: Grid, width: int) -> Iterator[Grid]:
    """Yield tables with as many columns as fit the width, each with the first column."""
    least = [_measure(grid, k)[1] for k in range(len(grid.columns))]
    pieces = [[0]]
    for k in range(1, len(least)):
        wider = [*pieces[-1], k]
        if len(wider) > 2 and sum(least[j] + 2 for j in wider) - 2 > width:
            pieces.append([0, k])
        else:
            pieces[-1] = wider
    for piece in pieces:
        yield grid._replace(
            columns=tuple(grid.columns[k] for k in piece),
            rows=tuple(tuple(row[k] for k in piece) for row in grid.rows),
            marked=frozenset((i, piece.index(k)) for i, k in grid.marked if k in piece),
            words=tuple(place for place, k in enumerate(piece) if k in grid.words),
        )


def _grid_lines(grid: Grid, width: int) -> Iterator[list[Piece]]:
    """Yield headings, a rule, and the rows; words are left-aligned, figures right-aligned."""
    every = range(len(grid.columns))
    natural, narrow = zip(*(_measure(grid, k) for k in every), strict=True)
    whole = [natural[0], *narrow[1:]]  # headings of rows are not folded
    for gap, least in ((GAP, natural), (2, whole), (1, whole), (2, narrow)):
        if sum(least) + gap * (len(least) - 1) <= width:
            break
    widths = _share_out(width, least, natural, gap)
    yield from _row_lines(grid, grid.columns, [_PLAIN] * len(widths), widths, gap)
    yield [("─" * (sum(widths) + gap * (len(widths) - 1)), _PLAIN)]
    for i, row in enumerate(grid.rows):
        styles = [_RED if (i, k) in grid.marked else _PLAIN if k else _BOLD for k in every]
        yield from _row_lines(grid, row, styles, widths, gap)


def _measure(grid: Grid, k: int) -> tuple[int, int]:
    """Return the preferred and the least width of a column; figures are never folded."""
    texts = [grid.columns[k], *(row[k] for row in grid.rows)]
    widths = [*map(count_places, texts)]
    if k not in grid.words:
        return max(widths), max([_longest_word(texts[:1]), *widths[1:]])
    natural = min(max(widths), PROSE) if k else max(widths)
    return natural, max(_longest_word(texts), 0 if k else min(natural, LABEL))


def _longest_word(texts: Iterable[str]) -> int:
    return max((count_places(word) for text in texts for word in text.split()), default=1)


def _share_out(width: int, least: Sequence[int], natural: Sequence[int], gap: int) -> list[int]:
    """Return the width of each column: its least width, plus a share of the remaining width. Each
    remaining place goes to the column that lacks the most places.

    Args:
        width: Width of the table.
        least: Least width of every column.
        natural: Width of every column without folding.
        gap: Blanks between columns.
    """
    widths = list(least)
    for _ in range(width - sum(widths) - gap * (len(widths) - 1)):
        lacking = [wanted - got for wanted, got in zip(natural, widths, strict=True)]
        widths[lacking.index(max(lacking))] += max(lacking) > 0
    return widths


def _row_lines(
    grid: Grid, cells: Sequence[str], styles: Sequence[str], widths: Sequence[int], gap: int
) -> Iterator[list[Piece]]:
    """Yield the lines of a row, as many as its longest folded cell needs."""
    folded = [fold(cell, width) for cell, width in zip(cells, widths, strict=True)]
    for texts in zip_longest(*folded, fillvalue=""):
        yield [
            (" " * gap * (k > 0) + _justify(text, widths[k], k in grid.words), style)
            for k, (text, style) in enumerate(zip(texts, styles, strict=True))
        ]


def _justify(text: str, width: int, to_the_left: bool) -> str:
    blanks = " " * (width - count_places(text))
    return text + blanks if to_the_left else blanks + text


def fold(text: str, width: int) -> list[str]:
    """Return a text as lines, broken between words or within words that are longer than a line.

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


def _fact_lines(facts: Facts, width: int) -> Iterator[list[Piece]]:
    """Yield lines with a name on the left and its value on the right."""
    names = max((count_places(name) for name, _ in facts.pairs), default=0)
    room = max(width - names - FACTS_GAP, PROSE)
    for name, value in facts.pairs:
        for k, line in enumerate(fold(value, room)):
            head = _justify("" if k else name, names, to_the_left=True)
            yield [(head, _DIM), (" " * FACTS_GAP + line, _PLAIN)]


def count_places(text: str) -> int:
    """Return the number of places that a text takes in a font of fixed width, where wide letters
    take two.
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
    """Return a text escaped so that Markdown shows it unchanged."""
    return _SPECIAL.sub(r"\\\1", legible(text.replace("\n", " ")))


def _blocks(sheet: Sheet) -> Iterator[str]:
    """Yield title and parts as blocks, between which there are blank lines."""
    yield f"# {escape(sheet.title)}"
    yield from map(_part, sheet.parts)


def _part(part: Grid | Facts | Text) -> str:
    match part:
        case Grid():
            blocks = ["\n".join(_list_rows(part)), escape(part.note)]
        case Facts():
            blocks = ["\n".join(f"- {escape(name)}: {escape(value)}" for name, value in part.pairs)]
        case Text():
            blocks = list(map(escape, part.paragraphs))
    head = f"## {escape(part.title)}" if part.title else ""
    return "\n\n".join(filter(None, (head, *blocks)))


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

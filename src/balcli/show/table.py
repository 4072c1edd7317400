"""Write sheets as text, plain or with the styles of a terminal, and as Markdown.

Tables are laid out here, not by rich: rich folds figures if a table is too wide, and its import
takes a tenth of the run time of `analyze`.
"""

import re
from collections.abc import Iterable, Iterator, Sequence
from itertools import chain, zip_longest
from typing import NamedTuple

from ..errors import legible
from .sheet import Column, Facts, Grid, Shade, Sheet, Text

WIDTH = 80  # width of prose, and of tables if folding allows
GAP = 3  # number of blanks between the columns of a grid
_SMALLER_GAP = 2  # gap in a grid that is too wide with the usual one
FACTS_GAP = 2  # number of blanks between names and their values
LABEL = 12  # headings of rows up to this width (`order 10`) are not folded
PROSE = 50  # largest width of columns of words; figures are never folded
_SINGLE = frozenset("–−…≠≤≥→∠⋅θλμπψω")  # letters in texts of balcli that take one place


Piece = tuple[str, str]  # part of a line: text, and style in a terminal
_BOLD = "1"
_DIM = "2"
_RED = "1;31"
_PLAIN = ""  # ANSI codes
_LOOKS = {Shade.LARGE: "31", Shade.BALANCED: "32", Shade.APPLIED: _BOLD}


def write_text(sheets: Sequence[Sheet], width: int | None = None, *, styled: bool = False) -> str:
    """Return all sheets as text, one after the other, without blanks at the ends of lines. Figures
    are never folded: a table that is wider than the terminal is divided into several, each with the
    first column.

    Args:
        sheets: Sheets to write.
        width: Width of the terminal; None: no terminal shows the text, and no table is divided.
        styled: Whether escape sequences make titles bold, notes dim, and large, balanced and
            applied cells red, green and bold.
    """
    written = []
    for sheet in sheets:
        for line in _lines(sheet, width):
            pieces = [_paint(text, style if styled else _PLAIN) for text, style in line]
            written.append("".join(pieces).rstrip())
    return "\n".join(written)


def _paint(text: str, style: str) -> str:
    text = legible(text)
    if style and text.strip():
        return f"\x1b[{style}m{text}\x1b[0m"
    return text


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
                yield from _prose_lines(filter(None, part.note.split("\n")), width, _DIM)
            case Facts():
                yield from _fact_lines(part, width)
            case Text():
                yield from _prose_lines(part.paragraphs, width, _PLAIN)
    yield []


def _prose_lines(paragraphs: Iterable[str], width: int, style: str) -> Iterator[list[Piece]]:
    """Yield the lines of paragraphs; that of an empty paragraph is empty."""
    for paragraph in paragraphs:
        for line in fold(paragraph, width):
            yield [(line, style)]


def _divide(grid: Grid, width: int) -> Iterator[Grid]:
    """Yield tables with as many columns as fit the width, each with the first column."""
    first, *others = grid.columns
    start = _measure_heads(first).least
    pieces = [[first]]
    used = start
    for column in others:
        least = _measure(column).least + _SMALLER_GAP
        if len(pieces[-1]) > 1 and used + least > width:
            pieces.append([first])
            used = start
        pieces[-1].append(column)
        used += least
    for piece in pieces:
        yield grid._replace(columns=piece)


def _grid_lines(grid: Grid, width: int) -> Iterator[list[Piece]]:
    """Yield headings, a rule, and the rows; words are left-aligned, figures right-aligned."""
    first, *others = grid.columns
    heads = _measure_heads(first)
    measured = [_measure(column) for column in others]
    natural = [heads.natural, *(each.natural for each in measured)]
    narrow = [heads.least, *(each.least for each in measured)]
    whole = [heads.natural, *narrow[1:]]
    lay_outs = ((GAP, natural), (_SMALLER_GAP, whole), (1, whole), (_SMALLER_GAP, narrow))
    for gap, least in lay_outs:
        if sum(least) + gap * (len(least) - 1) <= width:
            break
    widths = _share_out(width, least, natural, gap)
    rule = "─" * (sum(widths) + gap * (len(widths) - 1))
    plain = [_PLAIN] * len(widths)
    yield from _row_lines(grid, [column.head for column in grid.columns], plain, widths, gap)
    yield [(rule, _PLAIN)]
    for i, row in enumerate(grid.rows):
        styles = list(plain)
        for k, column in enumerate(grid.columns):
            if i in column.marked:
                styles[k] = _RED
            elif i in column.shades:
                styles[k] = _LOOKS[column.shades[i]]
        yield from _row_lines(grid, row, styles, widths, gap)


class _Width(NamedTuple):
    """Width of a column: without folding, and the least one."""

    natural: int
    least: int


def _measure(column: Column) -> _Width:
    """Return the widths of a column; figures are never folded, but their heading is."""
    cells = max(map(count_places, column.cells), default=0)
    natural = max(count_places(column.head), cells)
    if column.words:
        return _Width(min(natural, PROSE), _longest_word([column.head, *column.cells]))
    return _Width(natural, max(_longest_word([column.head]), cells))


def _measure_heads(column: Column) -> _Width:
    """Return the widths of the first column; headings of rows are folded last, short ones never."""
    if not column.words:
        return _measure(column)
    texts = [column.head, *column.cells]
    natural = max(map(count_places, texts))
    return _Width(natural, max(_longest_word(texts), min(natural, LABEL)))


def _longest_word(texts: Iterable[str]) -> int:
    words = chain.from_iterable(text.split() for text in texts)
    return max(map(count_places, words), default=1)


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
        if max(lacking) > 0:
            widths[lacking.index(max(lacking))] += 1
    return widths


def _row_lines(
    grid: Grid, cells: Sequence[str], styles: Sequence[str], widths: Sequence[int], gap: int
) -> Iterator[list[Piece]]:
    """Yield the lines of a row, as many as its longest folded cell needs."""
    folded = [fold(cell, width) for cell, width in zip(cells, widths, strict=True)]
    for texts in zip_longest(*folded, fillvalue=""):
        pieces: list[Piece] = []
        for column, text, style, width in zip(grid.columns, texts, styles, widths, strict=True):
            margin = " " * gap if pieces else ""
            pieces.append((margin + _justify(text, width, column.words), style))
        yield pieces


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
            lines = [f"- {escape(name)}: {escape(value)}" for name, value in part.pairs]
            blocks = ["\n".join(lines)]
        case Text():
            blocks = list(map(escape, part.paragraphs))
    if part.title:
        blocks.insert(0, f"## {escape(part.title)}")
    return "\n\n".join(filter(None, blocks))


def _list_rows(grid: Grid) -> Iterator[str]:
    """Yield heading, rule and rows of a table."""
    yield _line(escape(column.head) for column in grid.columns)
    yield _line("---" if column.words else "---:" for column in grid.columns)
    for i, row in enumerate(grid.rows):
        cells = [escape(cell) for cell in row]
        for k, column in enumerate(grid.columns):
            if i in column.marked:
                cells[k] = f"**{cells[k]}**"
        yield _line(cells)


def _line(cells: Iterable[str]) -> str:
    return "| " + " | ".join(cells) + " |"

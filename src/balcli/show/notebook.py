"""Write a sheet as HTML, for the output of a notebook's cell."""

from __future__ import annotations

from collections.abc import Iterable
from html import escape

from ..engine.engine import Engine
from ..file.doubt import Doubt
from .engine_facts import engine_facts
from .sheet import NAMELESS, Column, Facts, Grid, Sheet, Text
from .units import SI


def show_engine(engine: Engine) -> str:
    """Return the description of an engine in SI units, with its doubtful figures, as HTML."""
    facts = engine_facts(engine, SI, whole=False)
    return html_text(Sheet(engine.name or NAMELESS, (facts,)), engine.doubts)


def html_text(sheet: Sheet, doubts: Iterable[Doubt] = ()) -> str:
    """Return a sheet and doubts as HTML: tables and paragraphs without style, except left-aligned
    words.

    Args:
        sheet: Sheet to write.
        doubts: Doubts about the result.
    """
    blocks = [write_block(part) for part in sheet.parts]
    lines = tuple(str(doubt) for doubt in doubts)
    if lines:
        blocks.append(write_block(Text("Doubtful", lines)))
    return f"<div>\n<h4>{escape(sheet.title)}</h4>\n{''.join(blocks)}</div>"


def write_block(part: Grid | Facts | Text) -> str:
    """Return a table, facts or paragraphs as HTML, under their title."""
    text = f"<p><b>{escape(part.title)}</b></p>\n" if part.title else ""
    match part:
        case Text():
            return text + "".join(f"<p>{escape(line)}</p>\n" for line in part.paragraphs)
        case Facts():
            return text + _write_facts(part)
        case Grid():
            return text + _write_table(part)


def _write_facts(facts: Facts) -> str:
    rows = ""
    for name, value in facts.pairs:
        rows += _row(_cell("th", name, "left") + _cell("td", value, "left"))
    return f"<table>\n{rows}</table>\n"


def _write_table(grid: Grid) -> str:
    head = _row("".join(_cell("th", column.head, _side(column)) for column in grid.columns))
    body = ""
    for i, row in enumerate(grid.rows):
        cells = ""
        for column, text in zip(grid.columns, row, strict=True):
            cells += _cell("td", text, _side(column), i in column.marked)
        body += _row(cells)
    note = f"<p><small>{escape(grid.note)}</small></p>\n" if grid.note else ""
    return f"<table>\n<thead>{head}</thead>\n<tbody>\n{body}</tbody>\n</table>\n{note}"


def _side(column: Column) -> str:
    return "left" if column.words else ""


def _row(cells: str) -> str:
    return f"<tr>{cells}</tr>\n"


def _cell(tag: str, text: str, side: str, marked: bool = False) -> str:
    style = f' style="text-align: {side}"' if side else ""
    content = escape(text)
    if marked:
        content = f"<b>{content}</b>"
    return f"<{tag}{style}>{content}</{tag}>"

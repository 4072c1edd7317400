"""Write a sheet as HTML, for the output of a notebook's cell."""

from __future__ import annotations

from html import escape
from itertools import repeat

from ..engine.engine import Engine
from .engine_facts import engine_facts
from .formats import Columns
from .sheet import NAMELESS, Facts, Grid, Sheet, Text, number
from .units import SI

ENDS = 5  # number of rows that are shown at each end of a long table


def show_engine(engine: Engine) -> str:
    """Return the description of an engine in SI units, with its doubtful figures, as HTML."""
    facts = engine_facts(engine, SI, whole=False)
    return html_text(Sheet(engine.name or NAMELESS, (facts,)), engine.doubts)


def outline(columns: Columns) -> Grid:
    """Return a table of the first and last rows of columns."""
    heads = [
        f"{name}, {columns.units[name]}" if columns.units.get(name) else name
        for name in columns.values
    ]
    length = len(next(iter(columns.values.values())))
    shown = range(length) if length <= 2 * ENDS else [*range(ENDS), *range(length - ENDS, length)]
    rows = [tuple(number(column[k]) for column in columns.values.values()) for k in shown]
    if length > len(rows):
        rows.insert(ENDS, ("...",) * len(heads))
    return Grid("", tuple(heads), tuple(rows), note=f"{length} rows", words=())


def html_text(sheet: Sheet, doubts: tuple[str, ...] = ()) -> str:
    """Return a sheet and doubts as HTML: tables and paragraphs without style, except left-aligned
    words.

    Args:
        sheet: Sheet to write.
        doubts: Doubts about the result, in words.
    """
    doubtful = (Text("Doubtful", doubts),) if doubts else ()
    blocks = "".join(map(_block, (*sheet.parts, *doubtful)))
    return f"<div>\n<h4>{escape(sheet.title)}</h4>\n{blocks}</div>"


def _block(part: Grid | Facts | Text) -> str:
    text = f"<p><b>{escape(part.title)}</b></p>\n" if part.title else ""
    if isinstance(part, Text):
        return text + "".join(f"<p>{escape(paragraph)}</p>\n" for paragraph in part.paragraphs)
    if isinstance(part, Facts):
        pairs = (_cell("th", name, "left") + _cell("td", fact, "left") for name, fact in part.pairs)
        return f"{text}<table>\n{''.join(map(_row, pairs))}</table>\n"
    sides = ["left" if k in part.words else "" for k in range(len(part.columns))]
    head = _row("".join(map(_cell, repeat("th"), part.columns, sides)))
    body = ""
    for i, row in enumerate(part.rows):
        marked = [(i, k) in part.marked for k in range(len(row))]
        body += _row("".join(map(_cell, repeat("td"), row, sides, marked)))
    text += f"<table>\n<thead>{head}</thead>\n<tbody>\n{body}</tbody>\n</table>\n"
    return text + (f"<p><small>{escape(part.note)}</small></p>\n" if part.note else "")


def _row(cells: str) -> str:
    return f"<tr>{cells}</tr>\n"


def _cell(tag: str, text: str, side: str, marked: bool = False) -> str:
    style = f' style="text-align: {side}"' if side else ""
    return f"<{tag}{style}>{f'<b>{escape(text)}</b>' if marked else escape(text)}</{tag}>"

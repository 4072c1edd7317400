"""A sheet as HTML for the output of a notebook's cell."""

from __future__ import annotations

from html import escape
from itertools import repeat

from ..analysis import show as analysis
from ..analysis.answer import Analysis
from ..engine.build import Engine
from ..show.csv import Columns
from ..show.engine_facts import engine_facts
from ..show.formats import Renderer
from ..show.result import Result, find_renderer, list_columns
from ..show.sheet import NAMELESS, Facts, Grid, Sheet, Text, number
from ..show.units import SI

ENDS = 5  # rows of a long table that are shown, at its head and at its foot


def show_in_notebook(result: Engine | Result) -> str:
    """An engine or an answer as a person reads it, in SI units, and what is doubtful of it."""
    sheet = _make_sheet(result)
    doubts = (Text("Doubtful", result.doubts),) if result.doubts else ()
    return html_text(Sheet(sheet.title, (*sheet.parts, *doubts)))


def _make_sheet(result: Engine | Result) -> Sheet:
    if isinstance(result, Engine):
        facts = engine_facts(result, SI, higher=False, whole=False)
        return Sheet(result.name or NAMELESS, (facts,))
    if isinstance(result, Analysis):
        return analysis.sheet(result, SI)
    renderer = find_renderer(result)
    if isinstance(renderer, Renderer):
        sheet: Sheet = renderer.sheet(result, SI)
        return sheet
    return Sheet(repr(result)[1:-1], (outline(list_columns(result)),))


def outline(columns: Columns) -> Grid:
    """The first and the last rows of columns."""
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


def html_text(sheet: Sheet) -> str:
    """Return a sheet as HTML: tables and paragraphs without style, but words stand left."""
    blocks = "".join(map(_block, sheet.parts))
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

"""A sheet as HTML for the output of a notebook's cell."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from html import escape

from ..engine.build import Engine
from ..result import Result
from ..results.analysis import Analysis
from . import analysis
from .csv import Columns
from .engine_facts import engine_facts
from .exchange import find_renderer, list_columns
from .sheet import NAMELESS, Facts, Grid, Sheet, Text, number
from .units import SI

WORDS = "text-align: left"
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
    if not hasattr(renderer, "sheet"):
        return Sheet(repr(result)[1:-1], (outline(list_columns(result)),))
    sheet: Sheet = renderer.sheet(result, SI)
    return sheet


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
    """A sheet as HTML: tables and paragraphs, without style of their own but what stands left."""
    return f"<div>\n{''.join(_blocks(sheet))}</div>"


def _blocks(sheet: Sheet) -> Iterator[str]:
    yield f"<h4>{escape(sheet.title)}</h4>\n"
    for part in sheet.parts:
        if part.title:
            yield f"<p><b>{escape(part.title)}</b></p>\n"
        match part:
            case Grid():
                yield from _table(part)
            case Facts():
                yield "<table>\n"
                for name, value in part.pairs:
                    yield (
                        f'<tr><th style="{WORDS}">{escape(name)}</th>'
                        f'<td style="{WORDS}">{escape(value)}</td></tr>\n'
                    )
                yield "</table>\n"
            case Text():
                yield from (f"<p>{escape(paragraph)}</p>\n" for paragraph in part.paragraphs)


def _table(grid: Grid) -> Iterator[str]:
    yield "<table>\n<thead>"
    yield _line(grid.columns, grid.words, "th")
    yield "</thead>\n<tbody>\n"
    for i, row in enumerate(grid.rows):
        marked = [k for k in range(len(row)) if (i, k) in grid.marked]
        yield _line(row, grid.words, "td", marked)
    yield "</tbody>\n</table>\n"
    if grid.note:
        yield f"<p><small>{escape(grid.note)}</small></p>\n"


def _line(
    cells: Sequence[str], words: tuple[int, ...], tag: str, marked: Collection[int] = ()
) -> str:
    texts = [
        f"<b>{escape(cell)}</b>" if k in marked else escape(cell) for k, cell in enumerate(cells)
    ]
    styles = [f' style="{WORDS}"' if k in words else "" for k in range(len(cells))]
    joined = "".join(
        f"<{tag}{style}>{text}</{tag}>" for style, text in zip(styles, texts, strict=True)
    )
    return f"<tr>{joined}</tr>\n"

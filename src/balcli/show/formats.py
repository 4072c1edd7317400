"""Formats of results, renderers, and the text of results in each format."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import StrEnum
from shutil import get_terminal_size
from typing import TYPE_CHECKING, Generic, TypeVar, assert_never

from ..core.records import Node, to_document
from .csv import csv_text, json_text
from .table import markdown, plain_text, terminal_text

if TYPE_CHECKING:
    from .csv import Columns, Rows
    from .sheet import NamedResult, Sheet
    from .units import System


class Format(StrEnum):
    """Format of a written result."""

    TABLE = "table"
    JSON = "json"
    CSV = "csv"
    MARKDOWN = "markdown"


class Units(StrEnum):
    """System of units of tables, CSV and Markdown; JSON is always in SI units."""

    SI = "si"
    IMPERIAL = "imperial"


Shown = TypeVar("Shown")


def write_named(one: NamedResult[Shown]) -> Node:
    """Return the JSON document of a named result; the document has the engine's name already."""
    return to_document(one.result)


@dataclass(frozen=True, kw_only=True)
class Columnar(Generic[Shown]):
    """Conversion of one kind of result to documents and columns.

    Attributes:
        document: Function that returns the JSON document, in SI units; default: the document of
            the record.
        columns: Function that returns the columns of DataFrames; None: the columns of CSV.
    """

    document: Callable[[Shown], object] = to_document
    columns: Callable[[Shown], Columns] | None = None


@dataclass(frozen=True, kw_only=True)
class Renderer(Columnar[Shown]):
    """Conversion of one kind of result to sheets and CSV as well.

    Attributes:
        sheet: Function that returns the sheet in given units.
        rows: Function that returns the rows of CSV in given units.
    """

    sheet: Callable[[Shown, System], Sheet]
    rows: Callable[[Shown, System], Rows]


def render(
    results: Sequence[Shown],
    renderer: Renderer[Shown],
    form: Format,
    system: System,
    *,
    seen: bool = False,
) -> str:
    """Return the text of one or more results in one format: sheets one after the other, a JSON
    document on each line, or all rows of CSV under one header.

    Args:
        seen: Whether a terminal shows the text, so that its colours and width are used.
    """
    match form:
        case Format.TABLE | Format.MARKDOWN:
            sheets = [renderer.sheet(result, system) for result in results]
            return lay_out(sheets, form, seen=seen)
        case Format.CSV:
            return csv_text([renderer.rows(result, system) for result in results])
        case Format.JSON:
            return "\n".join(json_text(renderer.document(result)) for result in results)
        case _:
            assert_never(form)


def lay_out(sheets: list[Sheet], form: Format, *, seen: bool) -> str:
    """Return sheets as tables or Markdown, one after the other.

    Args:
        sheets: Sheets to write.
        form: Table or Markdown.
        seen: Whether a terminal shows the text, as in `render`.
    """
    if form is Format.MARKDOWN:
        return markdown(sheets)
    if not seen:
        return plain_text(sheets)
    styled = not os.environ.get("NO_COLOR") and os.environ.get("TERM") != "dumb"
    return terminal_text(sheets, get_terminal_size().columns, styled=styled)

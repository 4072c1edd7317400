"""Formats and documents of results, and the text of a result in each."""

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
    """How a result is written."""

    TABLE = "table"
    JSON = "json"
    CSV = "csv"
    MARKDOWN = "markdown"


class Units(StrEnum):
    """Units of tables, CSV and Markdown; JSON stays SI."""

    SI = "si"
    IMPERIAL = "imperial"


Shown = TypeVar("Shown")


def write_named(one: NamedResult[Shown]) -> Node:
    """Return the JSON document of a result, which has the engine's own name."""
    return to_document(one.result)


@dataclass(frozen=True, kw_only=True)
class Columnar(Generic[Shown]):
    """How results of one kind become documents and columns.

    Attributes:
        document: Makes the JSON document, in SI units; default: the record's.
        columns: Makes the columns of DataFrames; None: those of the rows of CSV.
    """

    document: Callable[[Shown], object] = to_document
    columns: Callable[[Shown], Columns] | None = None


@dataclass(frozen=True, kw_only=True)
class Renderer(Columnar[Shown]):
    """How results of one kind are shown.

    Attributes:
        sheet: Makes the sheet in these units.
        rows: Makes the rows of CSV in these units.
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
    """Return the text of one or more results in one format: sheets one after the other, one JSON
    document a line, all rows of CSV under one header.

    Args:
        seen: whether a person will see it in a terminal, with colours and at its width.
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
        seen: Whether a terminal shows them, as for `render`.
    """
    if form is Format.MARKDOWN:
        return markdown(sheets)
    if not seen:
        return plain_text(sheets)
    styled = not os.environ.get("NO_COLOR") and os.environ.get("TERM") != "dumb"
    return terminal_text(sheets, get_terminal_size().columns, styled=styled)

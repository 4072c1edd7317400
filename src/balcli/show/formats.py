"""Formats of results, renderers, and the text of results in each format: rows as CSV in full
precision, documents as JSON.
"""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from shutil import get_terminal_size
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Generic, NamedTuple, TypeAlias, TypeVar

from ..core.records import Node, to_document
from ..errors import is_coloured
from ..version import __version__
from .table import markdown, write_text

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .sheet import NamedResult, Sheet
    from .units import System


# Beginnings of cells that spreadsheets run as formulas, in ASCII and full width.
FORMULA = ("=", "+", "-", "@", "\t", "\r", "\uff1d", "\uff0b", "\uff0d", "\uff20")
_PARTED = re.compile(r'[",;\t\r\n]')


Values: TypeAlias = "Sequence[Any] | NDArray[Any]"


class Columns(NamedTuple):
    """A result as columns of one length, for DataFrames.

    Attributes:
        values: Lists or arrays, by column name.
        units: Units of some columns, by column name.
    """

    values: Mapping[str, Values]
    units: Mapping[str, str] = MappingProxyType({})


class Rows(NamedTuple):
    """CSV of a result: names of the columns, and lines with a cell for each column."""

    header: Sequence[str]
    lines: Iterable[Sequence[object]]


def csv_text(results: Sequence[Rows]) -> str:
    """Return the lines of all results under the header of the first; None becomes an empty cell."""
    lines: list[Sequence[object]] = [results[0].header]
    for rows in results:
        lines += rows.lines
    return "".join(",".join(map(_cell, line)) + "\n" for line in lines)


def name_cell(name: str) -> str:
    """Return a name from a user, with an apostrophe in front if a spreadsheet would run it as a
    formula.
    """
    return f"'{name}" if name.startswith(FORMULA) else name


def _cell(value: object) -> str:
    """Return a cell, in quotes if a program might split it."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return str(value).lower()
    text = str(value)
    if _PARTED.search(text):
        return '"' + text.replace('"', '""') + '"'
    return text


def json_text(document: object) -> str:
    """Return a document on one line; raise ValueError if it has a nan or infinity (a bug)."""
    return json.dumps(stamp(document), ensure_ascii=False, allow_nan=False)


def stamp(document: object) -> Any:
    """Return a document with the version of balcli inserted after its format; return anything else
    unchanged.
    """
    if not isinstance(document, dict) or "format" not in document:
        return document
    return {"format": document["format"], "version": __version__} | document


class Format(StrEnum):
    """Format of a written result; each of the last six belongs to one command."""

    TABLE = "table"
    JSON = "json"
    CSV = "csv"
    MARKDOWN = "markdown"
    PARQUET = "parquet"
    JUNIT = "junit"
    GITHUB = "github"
    CARD = "card"
    MARINE = "marine"
    HTML = "html"


class Units(StrEnum):
    """System of units of tables, CSV and Markdown; JSON is always in SI units."""

    SI = "si"
    IMPERIAL = "imperial"


Shown = TypeVar("Shown")


def write_named(named: NamedResult[Shown]) -> Node:
    """Return the JSON document of a named result; the document has the engine's name already."""
    return to_document(named.result)


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Columnar(Generic[Shown]):
    """Conversion of one kind of result to documents and columns.

    Attributes:
        document: Function that returns the JSON document, in SI units; default: a key for each
            attribute of the result.
        columns: Function that returns the columns of DataFrames; None: DataFrames have the columns
            of CSV.
    """

    document: Callable[[Shown], object] = to_document
    columns: Callable[[Shown], Columns] | None = None


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Renderer(Columnar[Shown]):
    """Conversion of one kind of result to documents, columns, sheets and CSV.

    Attributes:
        sheet: Function that returns the sheet (readable tables and facts) in given units.
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
    if form is Format.CSV:
        return csv_text([renderer.rows(result, system) for result in results])
    if form is Format.JSON:
        return "\n".join(json_text(renderer.document(result)) for result in results)
    return lay_out([renderer.sheet(result, system) for result in results], form, seen=seen)


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
        return write_text(sheets)
    return write_text(sheets, get_terminal_size().columns, styled=is_coloured(sys.stdout))

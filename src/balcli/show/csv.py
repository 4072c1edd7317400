"""Write rows as CSV in full precision, and documents as JSON."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from ..version import __version__

if TYPE_CHECKING:
    from numpy.typing import NDArray


# Beginnings of cells that spreadsheets run as formulas, in ASCII and full width.
FORMULA = ("=", "+", "-", "@", "\t", "\r", "\uff1d", "\uff0b", "\uff0d", "\uff20")
_PARTED = re.compile(r'[",;\t\r\n]')


Column: TypeAlias = "Sequence[Any] | NDArray[Any]"


class Columns(NamedTuple):
    """A result as columns of one length, for DataFrames.

    Attributes:
        values: Lists or arrays, by column name.
        units: Units of some columns, by column name.
    """

    values: Mapping[str, Column]
    units: Mapping[str, str] = MappingProxyType({})


class Rows(NamedTuple):
    """CSV of a result: names of the columns, and lines with a cell for each column."""

    header: Sequence[str]
    lines: Iterable[Sequence[object]]


def csv_text(results: Sequence[Rows]) -> str:
    """Return the lines of all results under the header of the first; None becomes an empty cell."""
    lines = [results[0].header, *(line for rows in results for line in rows.lines)]
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
    return '"' + text.replace('"', '""') + '"' if _PARTED.search(text) else text


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

"""Rows under a header as CSV in full precision, and documents as JSON."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from ..version import __version__

if TYPE_CHECKING:
    from numpy.typing import NDArray


# Beginnings of what is run, in full width as in small.
FORMULA = ("=", "+", "-", "@", "\t", "\r", "\uff1d", "\uff0b", "\uff0d", "\uff20")
_PARTED = re.compile(r'[",;\t\r\n]')


Column: TypeAlias = "Sequence[Any] | NDArray[Any]"


class Columns(NamedTuple):
    """A result as columns of one length, for DataFrames.

    Attributes:
        values: by name, each a list or an array.
        units: of some of them.
    """

    values: Mapping[str, Column]
    units: Mapping[str, str] = MappingProxyType({})


class Rows(NamedTuple):
    """CSV of a result: names of the columns, and lines of as many cells."""

    header: Sequence[str]
    lines: Iterable[Sequence[object]]


def csv_text(results: Sequence[Rows]) -> str:
    """Return the lines of all results under the header of the first; None is an empty cell."""
    lines = [results[0].header, *(line for rows in results for line in rows.lines)]
    return "".join(",".join(map(_cell, line)) + "\n" for line in lines)


def name_cell(name: str) -> str:
    """Return a name that a user has given, with an apostrophe before it where a spreadsheet would
    take it for a formula and run it.
    """
    return f"'{name}" if name.startswith(FORMULA) else name


def _cell(value: object) -> str:
    """Return a cell, between quotes where any program might part it."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return str(value).lower()
    text = str(value)
    return '"' + text.replace('"', '""') + '"' if _PARTED.search(text) else text


def json_text(document: object) -> str:
    """Return one document on one line; ValueError for a nan or infinity in it, a fault of ours."""
    return json.dumps(stamp(document), ensure_ascii=False, allow_nan=False)


def stamp(document: object) -> Any:
    """Return a result with the version that wrote it, after its format; anything else as it is."""
    if not isinstance(document, dict) or "format" not in document:
        return document
    return {"format": document["format"], "version": __version__} | document

"""Rows under a header as CSV, in full precision."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Mapping, Sequence
from io import StringIO
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

if TYPE_CHECKING:
    from numpy.typing import NDArray

# Beginnings of what is run, in full width as in small.
FORMULA = ("=", "+", "-", "@", "\t", "\r", "\uff1d", "\uff0b", "\uff0d", "\uff20")


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
    """What CSV says of a result: names of the columns, and lines of as many cells."""

    header: Sequence[str]
    lines: Iterable[Sequence[Any]]


def csv_text(results: Sequence[Rows]) -> str:
    """The lines of all results under the header of the first; None is an empty cell."""
    buffer = StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(results[0].header)
    for rows in results:
        writer.writerows([_cell(value) for value in line] for line in rows.lines)
    return buffer.getvalue()


def name_cell(name: str) -> str:
    """A name that a user has given, with an apostrophe before it where a spreadsheet would take it
    for a formula and run it.
    """
    return f"'{name}" if name.startswith(FORMULA) else name


def _cell(value: Any) -> Any:
    if value is None:
        return ""
    return str(value).lower() if isinstance(value, bool) else value

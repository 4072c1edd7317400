"""Tables of numbers beside an engine file: CSV with a heading, such as a measured diagram."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from ..errors import BalcliError
from ..limits import LARGEST_FILE_BYTES, LARGEST_IN_COLUMNS, MOST_ROWS
from .fields import shorten
from .toml import read_bytes


class NumberColumns(NamedTuple):
    """Numbers of a file.

    Attributes:
        heads: as the file has them, in the order in which they were asked for.
        rows: a number for each head.
        lines: of the file, from 1, one for each row.
    """

    heads: tuple[str, ...]
    rows: tuple[tuple[float, ...], ...]
    lines: tuple[int, ...]

    def column(self, number: int) -> list[float]:
        """Return all numbers under one of the heads, counted from 0."""
        return [row[number] for row in self.rows]


def locate_beside(folder: Path, name: str) -> Path:
    """Return the path of a file beside an engine file.

    Args:
        folder: of the engine file, which the path may not leave.
        name: as the engine file has it.

    Raises:
        BalcliError: it would, or no file can have that name.
    """
    try:
        home, place = folder.resolve(), (folder / name).resolve()
    except ValueError as error:  # letters that names of files have not here: LC_ALL=C
        raise BalcliError(f"{shorten(name)}: cannot be read ({error})") from None
    if not place.is_relative_to(home):
        raise BalcliError(
            f"{shorten(name)} lies outside the folder of the engine file; put it beside that file, "
            "or into a folder below it"
        )
    return folder / name


def read_columns(path: Path, wanted: Sequence[Sequence[str]]) -> NumberColumns:
    """Return some columns of a CSV file.

    Other columns, empty lines and lines that begin with # count for nothing. Where semicolons or
    tabs part the heading, they part the lines, and decimals may have commas; elsewhere a number to
    the right of the heading is refused: "0,5,1,3" might be two.

    Args:
        path: of the file.
        wanted: the names that each column may have.

    Raises:
        BalcliError: it cannot be read, a column is missing, or a line has no such numbers.
    """
    content = read_bytes(path)
    if len(content) > LARGEST_FILE_BYTES:
        raise BalcliError(f"{path}: has more than {LARGEST_FILE_BYTES // 1_000_000} MB")
    try:
        return _parse(content.decode("utf-8-sig"), wanted)
    except UnicodeDecodeError:
        raise BalcliError(f"{path}: is not UTF-8 text; save it as CSV in UTF-8") from None
    except (ValueError, csv.Error) as error:
        raise BalcliError(f"{path}: {error}") from None


def _parse(text: str, wanted: Sequence[Sequence[str]]) -> NumberColumns:
    numbered = enumerate(text.splitlines(), 1)
    lines = {n: line for n, line in numbered if line.strip() and not line.lstrip().startswith("#")}
    if len(lines) > MOST_ROWS:
        raise ValueError(f"has {len(lines)} lines; at most {MOST_ROWS} are read")
    first = next(iter(lines.values()), "")
    # The comma, where none of them is there; tabs after a comma are room.
    mark = max(",;\t", key=re.sub(r"([,;])\s+", r"\1", first).count)
    if mark != ",":
        lines = {n: line.replace(",", ".").replace(mark, ",") for n, line in lines.items()}
    numbers, cells = list(lines)[1:], csv.reader(lines.values())
    heading = [cell.strip() for cell in next(cells, [])]
    places = [_find_head(names, heading, wanted, mark) for names in wanted]
    width = len(heading) if mark == "," else None
    rows = tuple(_read_row(row, places, width, n) for row, n in zip(cells, numbers, strict=False))
    return NumberColumns(tuple(heading[place] for place in places), rows, tuple(numbers))


def _find_head(
    names: Sequence[str], heading: list[str], wanted: Sequence[Sequence[str]], mark: str
) -> int:
    """Return where a heading has one of these names; `mark` parts its columns."""
    for place, head in enumerate(heading):
        if head in names:
            return place
    usual = mark.join(some[0] for some in wanted)
    others = [name for some in wanted for name in some[1:]]
    also = f" (or {', '.join(others)})" if others else ""
    found = shorten(mark.join(heading))
    raise ValueError(f"the heading {found} has no {names[0]}; head the file {usual}{also}")


def _read_row(row: list[str], places: list[int], width: int | None, line: int) -> tuple[float, ...]:
    """`width`: of the heading, beyond which no number may stand; None: one may."""
    if len(row) <= max(places):
        raise ValueError(f"line {line}: has {len(row)} of {max(places) + 1} columns")
    if width is not None and any(re.match(r"\s*[+-]?\.?\d", cell) for cell in row[width:]):
        raise ValueError(
            f"line {line}: has {len(row)} columns, the heading {width}; name every column in the "
            "heading, or, where decimals have commas, part columns by semicolons there and below"
        )
    return tuple(_read_number(row[place], line) for place in places)


def _read_number(cell: str, line: int) -> float:
    try:
        number = float(cell)
    except ValueError:
        number = math.nan
    if not abs(number) <= LARGEST_IN_COLUMNS:
        what = "too large a" if math.isfinite(number) else "not a"
        raise ValueError(f"line {line}: {shorten(cell.strip())} is {what} number")
    return number

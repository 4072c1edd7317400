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
from .toml_text import name_other_kind, read_bytes


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
        """All numbers under one of the heads."""
        return [row[number] for row in self.rows]


def locate_beside(folder: Path, name: str) -> Path:
    """The file of this name, relative to a folder that it may not leave.

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
    """Some columns of a CSV file; other columns, empty lines and lines that begin with # count for
    nothing. Where semicolons or tabs part the heading, they part the lines, and decimals may have
    commas; elsewhere a number to the right of the heading is refused: "0,5,1,3" might be two.

    Args:
        wanted: the names that each column may have.

    Raises:
        BalcliError: it cannot be read, a column is missing, or a line has no such numbers.
    """
    content = read_bytes(path)
    if len(content) > LARGEST_FILE_BYTES:
        raise BalcliError(f"{path}: has more than {LARGEST_FILE_BYTES // 1_000_000} MB")
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError:
        kind = name_other_kind(content)
        told = (
            f"is {kind}; save the sheet as CSV" if kind else "is not UTF-8 text; save it as UTF-8"
        )
        raise BalcliError(f"{path}: {told}") from None
    try:
        return _parse(text, wanted)
    except (ValueError, csv.Error) as error:
        raise BalcliError(f"{path}: {error}") from None


def _parse(text: str, wanted: Sequence[Sequence[str]]) -> NumberColumns:
    lines = [
        (number, line)
        for number, line in enumerate(text.splitlines(), 1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    if len(lines) > MOST_ROWS:
        raise ValueError(f"has {len(lines)} lines; at most {MOST_ROWS} are read")
    first = lines[0][1] if lines else ""
    if re.fullmatch(r"[-+\d.,;eE\s]+", first) and re.search(r"\d", first):
        mark = next((mark for mark in ";\t" if mark in first), ",")
        usual = mark.join(some[0] for some in wanted)
        raise ValueError(f"begins with figures, without a heading; put the line {usual} above them")
    # The comma, where none of them is there; tabs after a comma are room.
    mark = max(",;\t", key=re.sub(r"([,;])\s+", r"\1", first).count)
    if mark != ",":
        lines = [(n, line.replace(",", ".").replace(mark, ",")) for n, line in lines]
    cells = csv.reader(line for _, line in lines)
    heading = [cell.strip() for cell in next(cells, [])]
    places = [_find_head(names, heading, wanted, mark) for names in wanted]
    numbers = [number for number, _ in lines[1:]]
    width = len(heading) if mark == "," else None
    rows = tuple(_read_row(row, places, width, n) for row, n in zip(cells, numbers, strict=False))
    return NumberColumns(tuple(heading[place] for place in places), rows, tuple(numbers))


def _find_head(
    names: Sequence[str], heading: list[str], wanted: Sequence[Sequence[str]], mark: str
) -> int:
    """Where a heading has one of these names; `mark` parts its columns."""
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
    if not math.isfinite(number):
        raise ValueError(f"line {line}: {shorten(cell.strip())} is not a number")
    if abs(number) > LARGEST_IN_COLUMNS:
        raise ValueError(f"line {line}: {shorten(cell.strip())} is too large a number")
    return number

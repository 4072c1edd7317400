"""Tables of numbers next to an engine file: columns with a heading, such as a measured diagram."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from ..errors import BalcliError
from ..limits import LARGEST_FILE_BYTES, LARGEST_IN_COLUMNS, MOST_ROWS
from .fields import shorten
from .toml import read_bytes
from .units import PLAIN, Dimension, convert

GAUGE_UNITS = ("barg", "psig")  # over the atmosphere


class Head(NamedTuple):
    """A wanted column.

    Attributes:
        usual: its head as documents write it, such as torque_Nm; other heads begin with its name.
        dimension: dimension of its numbers; PLAIN: the head is `usual` alone.
        others: further heads that messages name.
    """

    usual: str
    dimension: Dimension = PLAIN
    others: tuple[str, ...] = ()

    def read(self, head: str) -> tuple[str, float] | None:
        """Return the unit in a head, and its size; None: this is another column."""
        if self.dimension is PLAIN:
            return ("", 1.0) if head == self.usual else None
        name, _, _ = self.usual.partition("_")
        found = re.fullmatch(rf"(?i){name}[\s_]*[\[(/]?\s*([^\])]+?)\s*[\])]?", head)
        if found is None:
            return None
        unit = found[1].replace("_", " ")
        try:  # gauge pressures are units with a g behind them
            absolute = unit.removesuffix("g") if unit in GAUGE_UNITS else unit
            return unit, convert(f"1 {absolute}", self.dimension)
        except ValueError:
            return None


class NumberColumns(NamedTuple):
    """Columns of numbers in a file.

    Attributes:
        heads: Heads as the file has them, in the wanted order.
        rows: A number for each head.
        lines: Line of each row in the file, from 1.
        units: Unit of each head, as the file has it; empty where the head has none.
        scales: Size of that unit in the unit of the column's dimension.
    """

    heads: tuple[str, ...]
    rows: tuple[tuple[float, ...], ...]
    lines: tuple[int, ...]
    units: tuple[str, ...] = ()
    scales: tuple[float, ...] = ()

    def column(self, number: int) -> list[float]:
        """Return all numbers under one of the heads, counted from 0, in its quantity's unit."""
        return [row[number] * self.scales[number] for row in self.rows]

    def as_written(self, row: int, number: int) -> str:
        """Return a number as the file has it, with the file's unit."""
        return f"{self.rows[row][number]:.15g} {self.units[number]}".rstrip()


def locate_beside(folder: Path, name: str) -> Path:
    """Return the path of a file that an engine file names.

    Args:
        folder: Folder of the engine file, which the path may not leave.
        name: Name in the engine file.

    Raises:
        BalcliError: The path leaves the folder, or no file can have that name.
    """
    try:
        home, place = folder.resolve(), (folder / name).resolve()
    except ValueError as error:  # letters that names of files have not here: LC_ALL=C
        raise BalcliError(f"{shorten(name)}: cannot be read ({error})") from None
    if not place.is_relative_to(home):
        raise BalcliError(
            f"{shorten(name)} lies outside the folder of the engine file; put it next to that "
            "file, or in a folder below it"
        )
    return folder / name


def read_columns(path: Path, wanted: Sequence[Head]) -> NumberColumns:
    """Return some columns of a CSV file.

    Other columns, empty lines and lines that begin with # are ignored. Where semicolons,
    tabs or blanks part the heading, they part the lines, and decimals may have commas; elsewhere a
    number to the right of the heading is refused: "0,5,1,3" might be two.

    Args:
        path: Path of the file.
        wanted: Heads of the columns.

    Raises:
        BalcliError: The file cannot be read, a column is missing, or a line has no such numbers.
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


def _parse(text: str, wanted: Sequence[Head]) -> NumberColumns:
    numbered = enumerate(text.splitlines(), 1)
    lines = {n: line for n, line in numbered if line.strip() and not line.lstrip().startswith("#")}
    if len(lines) > MOST_ROWS:
        raise ValueError(f"has {len(lines)} lines; at most {MOST_ROWS} are read")
    mark, cells = _split(list(lines.values()))
    heading, numbers = [cell.strip() for cell in next(cells, [])], list(lines)[1:]
    found = [_find_head(head, heading, wanted, mark) for head in wanted]
    places, units, scales = zip(*found, strict=True)
    width = len(heading) if mark == "," else None
    rows = tuple(_read_row(row, places, width, n) for row, n in zip(cells, numbers, strict=False))
    heads = tuple(heading[place] for place in places)
    return NumberColumns(heads, rows, tuple(numbers), units, scales)


def _split(lines: list[str]) -> tuple[str, Iterator[list[str]]]:
    """Return the mark between the columns of the heading, and the cells of every line."""
    first = lines[0] if lines else ""
    # The comma, where none of them is there; tabs after a comma are room.
    mark = max(",;\t", key=re.sub(r"([,;])\s+", r"\1", first).count)
    if not re.search("[,;\t]", first) and re.search(r"\S\s+\S", first):
        mark = " "
        # A unit in brackets may have blanks: "torque [kN m]"
        first = re.sub(r"[\[(][^\])]*[\])]", lambda unit: unit[0].replace(" ", "_"), first)
        first = re.sub(r"\s+(?=[\[(])", "_", first.strip())
        lines = [" ".join(line.split()) for line in (first, *lines[1:])]
    if mark != ",":
        lines = [line.replace(",", ".").replace(mark, ",") for line in lines]
    return mark, csv.reader(lines)


def _find_head(
    wanted: Head, heading: list[str], every: Sequence[Head], mark: str
) -> tuple[int, str, float]:
    """Return place, unit and scale of a column; `mark` parts the columns of the heading."""
    for place, head in enumerate(heading):
        if head_read := wanted.read(head):
            return (place, *head_read)
    usual = mark.join(head.usual for head in every)
    others = [name for head in every for name in head.others]
    also = f" (or {', '.join(others)})" if others else ""
    found = shorten(mark.join(heading))
    raise ValueError(f"the heading {found} has no {wanted.usual}; head the file {usual}{also}")


def _read_row(
    row: list[str], places: Sequence[int], width: int | None, line: int
) -> tuple[float, ...]:
    """Return the numbers at these places of a line. No number may stand beyond `width`, the number
    of columns in the heading; None: it may.
    """
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

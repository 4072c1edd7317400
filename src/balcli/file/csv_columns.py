"""Read columns of numbers, such as a measured diagram, from CSV files next to an engine file."""

import csv
import math
import re
from collections.abc import Sequence
from io import StringIO
from pathlib import Path
from typing import NamedTuple

from ..errors import BalcliError
from ..limits import LARGEST_FILE_BYTES, LARGEST_IN_COLUMNS, LONGEST_ROW, MOST_ROWS
from .fields import join_words, shorten
from .toml import read_bytes
from .units import ANGLE, FORTRAN, PLAIN, PRESSURE, Dimension, convert

ANGLE_SYMBOLS = r"crank(?:shaft)?[\s_]*(?:angle)?|ca|theta|θ|phi|φ|alpha|α"
GAUGE_UNITS = ("barg", "psig")  # units of pressures above atmospheric pressure
_CRANK_ANGLE = r"(?i)^(?:deg|°|degrees?)?[\s_.]*(?:ca|cad|ka|kw|crank angle|atdc)$"  # degrees
_DEGREES_OF_CRANK = r"(?i)cad|(?:°|deg(?:rees?)?)[\s_.]*(?:ca|kw|crank angle|atdc)"
_THOUSANDS = r"[+-]?[1-9]\d{0,2}\.\d{3}"
_STARTS_NUMBER = r"(?i)\s*[+-]?(?:\.?\d|nan\b|inf)"
_SPACE = r"(?<=\d)[ \u00a0\u2009\u202f'](?=\d{3}\b)"  # a blank or ' that separates thousands


class Head(NamedTuple):
    """A wanted column, described by the heads that it may have (a head is the text above the
    numbers of a column).

    Attributes:
        usual: Usual head, such as torque_Nm. Heads with its name (torque) and another unit are
            accepted as well.
        dimension: Dimension of the numbers; with PLAIN (numbers without a unit), only
            `usual` itself is accepted.
        others: Accepted heads that messages list in addition to `usual`.
        symbols: Other names of the quantity, as a regular expression.
        any_unit: Whether `usual` may be followed by any unit, which is not converted.
    """

    usual: str
    dimension: Dimension = PLAIN
    others: tuple[str, ...] = ()
    symbols: str = ""
    any_unit: bool = False

    def read(self, head: str, *, by_symbol: bool = False) -> tuple[str, float] | None:
        """Return the unit in a head, and the factor that converts numbers in this unit into the
        unit of the dimension; None if the head belongs to another column.

        Args:
            head: Head of a column, with its unit.
            by_symbol: Whether to compare the head with `symbols` instead of the name in `usual`.
        """
        if self.any_unit:
            found = re.fullmatch(rf"(?i){self.usual}(?:[\s_,(\[]+(.+?)[)\]]?)?", head)
            return None if found is None else (found[1] or self.usual, 1.0)
        if self.dimension is PLAIN:
            return ("", 1.0) if head == self.usual else None
        name = rf"(?:{self.symbols})(?![^\W_])" if by_symbol else self.usual.partition("_")[0]
        if by_symbol and self.dimension is ANGLE and re.fullmatch(_DEGREES_OF_CRANK, head):
            return "deg", 1.0
        match = re.fullmatch(rf"(?i){name}[\s_,]*[\[(/]?\s*(.+?)\s*[\])]?", head)
        if match is None:
            return None
        unit = re.sub(_CRANK_ANGLE, "deg", match[1]).replace("_", " ")
        if self.dimension is PRESSURE:  # "bar (abs)", "bar g"
            unit = re.sub(r"(?i)[\s(]+a(?:bs(?:olute)?)?\)?$", "", unit)
            unit = re.sub(r"(?i)[\s(]+g(?:auge)?\)?$", "g", unit)
        try:  # units of gauge pressures end in g
            absolute = unit.removesuffix("g") if unit in GAUGE_UNITS else unit
            return unit, convert(f"1 {absolute}", self.dimension)
        except ValueError:
            return None


class NumberColumns(NamedTuple):
    """Columns of numbers in a file.

    Attributes:
        rows: Rows with a number for each wanted head.
        lines: Line of each row in the file, from 1.
        units: Unit in each head as the file writes it; empty for plain numbers.
        scales: Factor that converts the numbers of each column into the unit of its dimension.
    """

    rows: tuple[tuple[float, ...], ...]
    lines: tuple[int, ...]
    units: tuple[str, ...]
    scales: tuple[float, ...]

    def column(self, number: int) -> list[float]:
        """Return all numbers of the column with this index, in the unit of its dimension."""
        return [row[number] * self.scales[number] for row in self.rows]

    def as_written(self, row: int, number: int) -> str:
        """Return the number at these indices of row and column, with the unit in the file."""
        return f"{self.rows[row][number]:.15g} {self.units[number]}".rstrip()


class _Table(NamedTuple):
    """A CSV file as cells.

    Attributes:
        heading: Heads of the columns, joined with the units in the row below, if there is one.
        rows: Cells of the other lines.
        numbers: Line of each of these rows in the file, from 1.
        mark: Separator of the columns.
    """

    heading: list[str]
    rows: list[list[str]]
    numbers: list[int]
    mark: str


def list_heads(path: Path) -> list[str]:
    """Return the heads of the columns of a CSV file, each with its unit.

    Raises:
        BalcliError: The file cannot be read.
    """
    return _read_table(path).heading


def read_columns(path: Path, wanted: Sequence[Head]) -> NumberColumns:
    """Return the wanted columns of a CSV file.

    Other columns, empty lines and lines that begin with # are ignored. If semicolons, tabs or
    blanks separate the heads, they also separate the numbers, and decimals may have commas.
    Otherwise a number to the right of the last head is rejected: "0,5,1,3" might be two numbers.

    Args:
        path: Path of the file.
        wanted: Heads of the columns.

    Raises:
        BalcliError: The file cannot be read, a column is missing, or a line lacks a number.
    """
    table = _read_table(path)
    try:
        return _take_columns(table, wanted)
    except ValueError as error:
        raise BalcliError(f"{path}: {error}") from None


def _read_table(path: Path) -> _Table:
    content = read_bytes(path)
    if len(content) > LARGEST_FILE_BYTES:
        raise BalcliError(f"{path}: has more than {LARGEST_FILE_BYTES // 1_000_000} MB")
    try:
        return _split(content.decode("utf-8-sig"))
    except UnicodeDecodeError:
        raise BalcliError(f"{path}: is not UTF-8 text; save it as CSV in UTF-8") from None
    except (ValueError, csv.Error) as error:
        raise BalcliError(f"{path}: {error}") from None


def _list_lines(text: str) -> dict[int, str]:
    """Return the lines that are neither empty nor comments, by line number from 1."""
    lines: dict[int, str] = {}
    for number, line in enumerate(StringIO(text, newline=None), 1):
        if not line.strip() or line.lstrip().startswith("#") or re.match("sep=.$", line):
            continue  # Excel writes sep=;
        if len(line) > LONGEST_ROW:
            raise ValueError(f"line {number}: has more than {LONGEST_ROW} characters")
        if len(lines) > MOST_ROWS:  # not counting the heading
            raise ValueError(f"has more than {MOST_ROWS} rows; give only the mean of the cycles")
        lines[number] = line.rstrip("\n")
    return lines


def _split(text: str) -> _Table:
    lines = _list_lines(text)
    first = next(iter(lines.values()), "")
    # The separator is the mark that is most frequent in the heading; a comma if there is no mark.
    # Tabs after a comma or semicolon are only white space.
    mark = max(",;\t", key=re.sub(r"([,;])\s+", r"\1", first).count)
    if not re.search("[,;\t]", first) and re.search(r"\S\s+\S", first):
        mark = " "
        for number in list(lines)[:2]:  # a unit in brackets may contain blanks: "torque [kN m]"
            squeezed = re.sub(
                r"[\[(][^\])]*[\])]", lambda unit: unit[0].replace(" ", "_"), lines[number]
            )
            lines[number] = squeezed.strip()
        lines[next(iter(lines))] = re.sub(r"\s+(?=[\[(])", "_", next(iter(lines.values())))
        lines = {n: " ".join(line.split()) for n, line in lines.items()}
    numbers = list(lines)[1:]
    cells = csv.reader(lines.values(), delimiter=mark)
    heading = [cell.strip() for cell in next(cells, [])]
    rows = list(cells)
    if rows and (joined := _join_units(heading, rows[0])):
        heading = joined
        rows = rows[1:]
        numbers = numbers[1:]
    return _Table(heading, rows, numbers, mark)


def _take_columns(table: _Table, wanted: Sequence[Head]) -> NumberColumns:
    heading, rows, numbers, mark = table
    columns = [_find_head(head, heading, wanted, mark) for head in wanted]
    places = [place for place, _, _ in columns]
    width = len(heading) if mark in ", " else None
    texts = []
    for row, line in zip(rows, numbers, strict=False):
        texts.append(_find_cells(row, places, width, line))
    for column in zip(*texts, strict=True):
        _refuse_thousands(column, numbers)
    comma = "," if mark == "," else "."  # replacement for a comma in a number
    figures = []
    for cells, line in zip(texts, numbers, strict=False):
        figures.append(tuple(_read_number(cell, comma, line) for cell in cells))
    _, units, scales = zip(*columns, strict=True)
    return NumberColumns(tuple(figures), tuple(numbers), units, scales)


def _join_units(heading: list[str], below: list[str]) -> list[str]:
    """Return the heading joined with a row of units below it; empty if that row has no units."""
    units = [cell.strip(" []()") for cell in below]
    if len(units) < len(heading) or any(re.match(_STARTS_NUMBER, cell) for cell in below):
        return []
    joined = []
    for head, unit in zip(heading, units, strict=False):
        last_word = re.split(r"[\s_[(/]+", head)[-1].rstrip("]) ")
        joined.append(head if unit == last_word else f"{head} [{unit}]")
    return joined


def _find_head(
    wanted: Head, heading: list[str], every: Sequence[Head], mark: str
) -> tuple[int, str, float]:
    """Return index, unit and scale of the wanted column; `mark` separates the heads."""
    for by_symbol in (False, True):
        places = []
        for place, head in enumerate(heading):
            unit = wanted.read(head, by_symbol=by_symbol)
            if unit is not None:
                places.append((place, *unit))
        if len(places) > 1 and by_symbol:
            several = join_words([shorten(heading[place]) for place, *_ in places])
            raise ValueError(f"has the columns {several}; rename the right one {wanted.usual}")
        if places:
            return places[0]
    usual = mark.join(head.usual for head in every)
    others: list[str] = []
    for other in every:
        others += other.others
    also = f" (or {', '.join(others)})" if others else ""
    whole = shorten(mark.join(heading))
    raise ValueError(f"the heading {whole} has no {wanted.usual}; write {usual}{also}")


def _find_cells(row: list[str], places: list[int], width: int | None, line: int) -> list[str]:
    """Return the cells at these places of a line. If `width`, the number of heads, is given, there
    must be no number to the right of the last head.
    """
    if len(row) <= max(places):
        raise ValueError(f"line {line}: has {len(row)} of {max(places) + 1} columns")
    if width is not None and any(re.match(_STARTS_NUMBER, cell) for cell in row[width:]):
        raise ValueError(
            f"line {line}: has {len(row)} columns, the heading has {width}; name every column in "
            "the heading, or, if decimals have commas, separate columns by semicolons everywhere"
        )
    return [row[place].strip() for place in places]


def _refuse_thousands(column: Sequence[str], lines: Sequence[int]) -> None:
    """Raise ValueError if the points in a column probably separate thousands: three digits follow
    every point, and other numbers of the column have a decimal comma, or end with three digits and
    have no point.
    """
    pointed = [(cell, line) for cell, line in zip(column, lines, strict=False) if "." in cell]
    others = any(re.match(r"[+-]?\d*(,|\d{3}$)", cell) for cell in column)
    if pointed and others and all(re.fullmatch(_THOUSANDS, cell) for cell, _ in pointed):
        cell, line = pointed[0]
        raise ValueError(
            f"line {line}: {cell}: does the point separate thousands? Write "
            f"{cell.replace('.', '')}, or {cell}0 if it is a decimal point"
        )


def _read_number(cell: str, comma: str, line: int) -> float:
    try:
        spelt = re.sub(_SPACE, "", cell.replace(",", comma))
        number = float(re.sub(FORTRAN, r"e\1", spelt))
    except ValueError:
        number = math.nan
    if not abs(number) <= LARGEST_IN_COLUMNS:
        what = "too large a" if math.isfinite(number) else "not a"
        raise ValueError(f"line {line}: {shorten(cell.strip())} is {what} number")
    return number

"""A sheet: the readable form of a result, for terminal, Markdown and HTML; and how much of an
analysis it shows.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Generic, NamedTuple, TypeVar

if TYPE_CHECKING:
    from .units import ShownUnit


USUAL_DIGITS = 4

_digits: int | None = None  # significant ones, that were asked for


def set_digits(digits: int | None) -> None:
    """Set how many significant digits figures have, for the rest of this process; None: those that
    are usual where they stand.
    """
    global _digits
    _digits = digits


def get_digits(usual: int = USUAL_DIGITS) -> int:
    """Return how many significant digits a figure has: those that were asked for, else the usual
    ones.
    """
    return _digits or usual


NAMELESS = "engine without a name"
# share of what one cylinder does, or of the largest order, below which a higher order is passed
# over
NEGLIGIBLE = 1e-3
NOTHING, UNKNOWN = "balanced", "–"  # a force or moment of 0, and one that is not known


class Grid(NamedTuple):
    """A table. Cells are text; the first column is a heading of its row. Cells in `marked` (row,
    column) stand out, and the columns in `words` are read, not compared: they are left-aligned.
    """

    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    note: str = ""
    marked: frozenset[tuple[int, int]] = frozenset()
    words: tuple[int, ...] = (0,)

    @classmethod
    def of_columns(
        cls, title: str, columns: Iterable[tuple[str, Iterable[str]]], note: str = ""
    ) -> Grid:
        """Return a table that is given by columns.

        Args:
            title: Title of the table.
            columns: Heading and cells of every column.
            note: Note below the table.
        """
        heads, cells = zip(*columns, strict=True)
        return cls(title, heads, tuple(zip(*cells, strict=True)), note)


class Facts(NamedTuple):
    """Names and their values."""

    pairs: tuple[tuple[str, str], ...]
    title: str = ""


class Text(NamedTuple):
    """Paragraphs under a title."""

    title: str
    paragraphs: tuple[str, ...]


class Sheet(NamedTuple):
    """A title and its parts, in order."""

    title: str
    parts: tuple[Grid | Facts | Text, ...]


def capitalized(text: str) -> str:
    """Return a text with its first letter large, the others as they are."""
    return text[0].upper() + text[1:]


def sentence(text: str) -> str:
    """Return a text with its first letter large and a full stop at its end."""
    return f"{capitalized(text).removesuffix('.')}."


def count_name(count: float) -> str:
    """Return a whole number as people read it, 100 000, in groups from five digits on."""
    return f"{count:,.0f}".replace(",", " ") if abs(count) >= 10_000 else f"{count:.0f}"


def order_name(order: float) -> str:
    """Return an order as a table shows it: 2, ½, 1½."""
    whole, half = divmod(order, 1)
    return f"{int(whole) or ''}½" if half else str(int(whole))


def number(value: float, digits: int | None = None) -> str:
    """Return a figure for people: no exponent between 0.0001 and a million, a plain 0.

    Args:
        value: Figure.
        digits: Significant digits unless `--digits` asks for others; None: the usual ones.
    """
    return _write(value, get_digits(digits or USUAL_DIGITS))


def given(value: float, digits: int = 6) -> str:
    """Return a number that somebody gave, such as a speed: like a figure (`number`), but with its
    own digits, however few were asked for.

    Args:
        value: Number.
        digits: Largest number of significant digits.
    """
    return _write(value, digits)


def _write(value: float, digits: int) -> str:
    if math.isnan(value):
        return UNKNOWN
    if value == 0:
        return "0"
    # rounded first, so that machine noise does not decide to which side a half goes
    value = float(f"{value:.{max(digits, 12)}g}")
    text = f"{value:.{digits}g}"
    if "e" not in text:
        return text
    if 1 <= abs(value) < 10 ** max(digits + 2, 6):
        return f"{value:.0f}"
    mantissa, exponent = text.split("e")
    return f"{mantissa}e{int(exponent)}"


def size_text(value: float, unit: ShownUnit, digits: int | None = 4) -> str:
    """Return a value in the unit that fits it, with the unit's name.

    Args:
        value: Value, SI.
        unit: Unit, of which a multiple may fit better.
        digits: As for `number`.
    """
    unit = unit.fit(value)
    return f"{number(unit.of(value), digits)} {unit.name}"


def small_text(value: float, unit: ShownUnit) -> str:
    """Return the word for a negligible value, with its size if it is not 0.

    Args:
        value: Value, SI.
        unit: Its unit.
    """
    return f"negligible ({size_text(value, unit, 2)})" if value else NOTHING


def size_cell(
    value: float, unit: ShownUnit, *, negligible: bool = False, digits: int | None = 4
) -> str:
    """Return a force or moment in a column, or a word where it is 0 or negligible.

    Args:
        value: Value, SI.
        unit: Unit of the column.
        negligible: Whether the value is too small to count.
        digits: As for `number`.
    """
    if not value:
        return NOTHING
    return "negligible" if negligible else number(unit.of(value), digits)


def degrees(value: float, turn: float = 360) -> str:
    """Return an angle to a tenth of a degree, or a dash for nan.

    Half a turn backwards is half a turn, and a whole turn none: otherwise its last digits would
    decide which of both an angle is, and to which side a half is rounded.

    Args:
        value: Angle, deg.
        turn: 360, or 180 for lines.
    """
    if math.isnan(value):
        return UNKNOWN
    tenths = round(round(value, 6), 1) + 0.0
    if tenths == -turn / 2:
        tenths = turn / 2
    return "0.0" if tenths == 360 else f"{tenths:.1f}"


VISIBLE = 1e-3  # share of the largest, below which an order is too small for a picture


R = TypeVar("R")


class View(NamedTuple):
    """Parts of an analysis that a sheet shows.

    Attributes:
        whole: Whether every table and order is shown; else the usual tables and relevant orders.
        parts: Words of `--only`, such as `force`, `xy`, `verdict`; empty: the usual ones.
        every_order: Whether negligible orders are shown as well.
        hints: Whether commands and options that show more are named.
    """

    whole: bool = False
    parts: frozenset[str] = frozenset()
    every_order: bool = False
    hints: bool = True


IN_BRIEF = View()
ON_A_PAGE = View(hints=False)


class NamedResult(NamedTuple, Generic[R]):
    """Result for one of several engines.

    Attributes:
        result: Result.
        name: Name of the engine, which distinguishes its rows from those of the others.
        view: Parts that a sheet shows.
    """

    name: str
    result: R
    view: View


def assumed_facts(assumed: Sequence[str] | None) -> tuple[Facts, ...]:
    """Return the values taken because the file leaves them out, for the head of a sheet."""
    return (Facts((("assumed", tell_assumed(assumed)),)),) if assumed else ()


def tell_assumed(assumed: Iterable[str]) -> str:
    """Return these values in words, the name of [gas] once before all its keys; then those of
    single engines, after their names.
    """
    lines = list(assumed)
    single = [line for line in lines if ": " in line]
    common = [line for line in lines if line not in single]
    later = [line for line in common if line.startswith("gas.")][1:]
    words = ", ".join(line.removeprefix("gas.") if line in later else line for line in common)
    return "; ".join(filter(None, [words, *single]))

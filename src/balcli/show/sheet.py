"""A sheet: what a person reads, of which terminal, Markdown and HTML are made; and how much of an
analysis it shows.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Generic, NamedTuple, TypeVar

if TYPE_CHECKING:
    from .units import ShownUnit


USUAL_DIGITS = 5

_digits: int | None = None  # significant ones, that were asked for


def set_digits(digits: int | None) -> None:
    """How many significant digits figures have, for the rest of this process; None: those that are
    usual where they stand.
    """
    global _digits
    _digits = digits


def get_digits(usual: int = USUAL_DIGITS) -> int:
    """How many significant digits a figure has: those that were asked for, else the usual ones."""
    return _digits or usual


NAMELESS = "engine without a name"
# share of what one cylinder does, or of the largest order, below which a higher order is passed
# over
NEGLIGIBLE = 1e-3
NOTHING, UNKNOWN = "balanced", "–"  # a force or moment of 0, and one that is not known


class Grid(NamedTuple):
    """A table. Cells are text; the first column is a heading of its row. Cells in `marked` (row,
    column) stand out, and the columns in `words` are read, not compared: they stand to the left.
    """

    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    note: str = ""
    marked: frozenset[tuple[int, int]] = frozenset()
    words: tuple[int, ...] = (0,)


class Facts(NamedTuple):
    """Names and what they are."""

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
    """Text with its first letter large, the others as they are."""
    return text[0].upper() + text[1:]


def sentence(text: str) -> str:
    """Text with its first letter large and a full stop at its end."""
    return f"{capitalized(text).removesuffix('.')}."


def order_number(order: float) -> int | float:
    """An order as it is written: whole ones without a point."""
    return int(order) if order == int(order) else float(order)


def order_name(order: float) -> str:
    """An order as a table shows it: 2, ½, 1½."""
    whole, half = divmod(order, 1)
    return f"{int(whole) or ''}½" if half else str(int(whole))


def number(value: float, digits: int | None = None) -> str:
    """A figure for people, with as many significant digits as were asked for; `digits` are usual
    there. No exponent between 0.0001 and a million, a plain 0.
    """
    return _write(value, get_digits(digits or USUAL_DIGITS))


def given(value: float, digits: int = 6) -> str:
    """A number that somebody gave, such as a speed: like a figure (`number`), but with its own
    digits, however few were asked for.
    """
    return _write(value, digits)


def _write(value: float, digits: int) -> str:
    if math.isnan(value):
        return UNKNOWN
    if value == 0:
        return "0"
    # the last digits, which are the machine's, do not decide to which side a half is rounded
    value = float(f"{value:.{max(digits, 12)}g}")
    text = f"{value:.{digits}g}"
    if "e" not in text:
        return text
    if 1 <= abs(value) < 10 ** max(digits + 2, 6):
        return f"{value:.0f}"
    mantissa, exponent = text.split("e")
    return f"{mantissa}e{int(exponent)}"


def size_text(value: float, unit: ShownUnit, digits: int | None = 4) -> str:
    """A value (SI) in the unit that fits it, with its name; digits as of `number`."""
    unit = unit.fit(value)
    return f"{number(unit.of(value), digits)} {unit.name}"


def small_text(value: float, unit: ShownUnit) -> str:
    """What is too small to count (SI), in words, and how small it is if it is anything."""
    return f"negligible ({size_text(value, unit, 2)})" if value else NOTHING


def size_cell(
    value: float, unit: ShownUnit, *, negligible: bool = False, digits: int | None = 4
) -> str:
    """A force or moment (SI) in a column with this unit, or a word where there is none that counts;
    digits as of `number`.
    """
    if not value:
        return NOTHING
    return "negligible" if negligible else number(unit.of(value), digits)


def degrees(value: float, turn: float = 360) -> str:
    """An angle to a tenth of a degree, or a dash where there is none; of lines `turn` is 180.

    Half a turn backwards is half a turn, and a whole turn none: which of both an angle is, and to
    which side a half is rounded, would else be for its last digits to say.
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
    """What of an analysis a sheet shows.

    Attributes:
        whole: every table and every order; else what most people want, orders that matter.
        parts: words of `--only`, such as `force`, `xy`, `verdict`; empty: the usual ones.
        every_order: whether orders that are negligible are shown, too.
        hints: whether commands and options that show more are named.
    """

    whole: bool = False
    parts: frozenset[str] = frozenset()
    every_order: bool = False
    hints: bool = True


IN_BRIEF = View()
ON_A_PAGE = View(hints=False)


class NamedResult(NamedTuple, Generic[R]):
    """What was found of one of several engines.

    Attributes:
        name: of the engine, by which its rows are told from those of the others.
        view: what of it a sheet shows.
    """

    name: str
    result: R
    view: View


def assumed_facts(assumed: Sequence[str] | None) -> tuple[Facts, ...]:
    """What is taken because the file leaves it out, for the head of a sheet."""
    return (Facts((("assumed", tell_assumed(assumed)),)),) if assumed else ()


def tell_assumed(assumed: Iterable[str]) -> str:
    """The same in words, the name of [gas] once before all its keys; then that of single engines,
    after their names.
    """
    lines = list(assumed)
    single = [line for line in lines if ": " in line]
    common = [line for line in lines if line not in single]
    later = [line for line in common if line.startswith("gas.")][1:]
    words = ", ".join(line.removeprefix("gas.") if line in later else line for line in common)
    return "; ".join(filter(None, [words, *single]))

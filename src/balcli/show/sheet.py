"""Define sheets, the readable form of results for terminal, Markdown and HTML: tables, facts and
texts; and format their numbers.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from enum import Enum, auto
from types import MappingProxyType
from typing import TYPE_CHECKING, Generic, NamedTuple, TypeVar

if TYPE_CHECKING:
    from ..file.assumed import Assumed, Value
    from .units import ShownUnit


USUAL_DIGITS = 4

_digits: int | None = None  # significant digits of `--digits`


def set_digits(digits: int | None) -> None:
    """Set the number of significant digits of figures for the rest of this process; None: each
    figure has its default number.
    """
    global _digits
    _digits = digits


def get_digits(usual: int = USUAL_DIGITS) -> int:
    """Return the number of significant digits of a figure: as requested by `set_digits`, otherwise
    `usual`.
    """
    return _digits or usual


NAMELESS = "engine without a name"
# An order is negligible if its amplitude is below this share of one cylinder's amplitude, or of the
# largest amplitude of all orders.
NEGLIGIBLE = 1e-3
NOTHING = "balanced"
UNKNOWN = "–"  # words for a force of 0, and for an unknown force


class Shade(Enum):
    """What a terminal shows by the look of a cell, beside its words."""

    LARGE = auto()  # a force or moment of an order that is not small
    BALANCED = auto()
    APPLIED = auto()  # a step whose devices are fitted


class Column(NamedTuple):
    """A column of a table.

    Attributes:
        head: Heading.
        cells: Text of each row; empty in the heads of `Grid.of_rows`.
        words: Whether the cells are words, which are left-aligned and may be folded; figures are
            right-aligned and never folded.
        marked: Numbers of the rows whose cells are highlighted; the first row is 0.
        shades: Shades of cells by the number of their row; other cells have none.
    """

    head: str
    cells: Sequence[str] = ()
    words: bool = False
    marked: Collection[int] = ()
    shades: Mapping[int, Shade] = MappingProxyType({})


class Grid(NamedTuple):
    """A table of texts; the first column has the headings of rows. Lines of `note` are shown as
    lines.
    """

    title: str
    columns: Sequence[Column]
    note: str = ""

    @classmethod
    def of_rows(
        cls, title: str, heads: Sequence[Column], rows: Iterable[Sequence[str]], note: str = ""
    ) -> Grid:
        """Return a table with the given rows.

        Args:
            title: Title of the table.
            heads: Columns without cells.
            rows: Cells of each row, one for each column.
            note: Note below the table.
        """
        cells: list[list[str]] = [[] for _ in heads]
        for row in rows:
            for column, cell in zip(cells, row, strict=True):
                column.append(cell)
        filled = zip(heads, cells, strict=True)
        return cls(title, [head._replace(cells=column) for head, column in filled], note)

    @property
    def rows(self) -> list[tuple[str, ...]]:
        """Cells of each row."""
        return list(zip(*(column.cells for column in self.columns), strict=True))


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
    """Return a text with a capital first letter; the others do not change."""
    return text[0].upper() + text[1:]


def sentence(text: str) -> str:
    """Return a text with a capital first letter and a full stop."""
    return f"{capitalized(text).removesuffix('.')}."


def count_name(count: float) -> str:
    """Return a whole number with its digits in groups if it has five or more: 100 000."""
    return f"{count:,.0f}".replace(",", " ") if abs(count) >= 10_000 else f"{count:.0f}"


def order_name(order: float) -> str:
    """Return an order as text: 2, ½, 1½; 1.316 for an order of a part at another speed."""
    whole, half = divmod(order, 1)
    if half not in (0, 0.5):
        return f"{order:.4g}"
    return f"{int(whole) or ''}½" if half else str(int(whole))


def number(value: float | None, digits: int | None = None) -> str:
    """Return a figure as text, without exponent between 0.0001 and a million; a dash if it is not
    known.

    Args:
        value: Figure; None or nan: not known.
        digits: Significant digits unless `--digits` overrides them; None: USUAL_DIGITS.
    """
    if value is None:
        return UNKNOWN
    return _write(value, get_digits(digits or USUAL_DIGITS))


def given(value: float, digits: int = 6) -> str:
    """Return a number from the user, such as a speed. It is formatted as by `number`, but
    `--digits` has no effect.

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
    # Rounded first, so that rounding errors do not decide to which side a half is rounded.
    value = float(f"{value:.{max(digits, 12)}g}")
    text = f"{value:.{digits}g}"
    if "e" not in text:
        return text
    if 1 <= abs(value) < 10 ** max(digits + 2, 6):
        return f"{value:.0f}"
    mantissa, exponent = text.split("e")
    return f"{mantissa}e{int(exponent)}"


def unit_cell(value: float | None, unit: ShownUnit, digits: int | None = None) -> str:
    """Return the cell of a figure in the unit of its column; a dash if it is not known.

    Args:
        value: Figure, SI; None or nan: not known.
        unit: Unit of the column.
        digits: Significant digits, as in `number`.
    """
    if value is None:
        return UNKNOWN
    return number(unit.of(value), digits)


def size_text(value: float, unit: ShownUnit, digits: int | None = 4) -> str:
    """Return a value in a fitting unit, followed by the unit's name.

    Args:
        value: Value, SI.
        unit: Unit; a larger multiple of it is used if that fits better.
        digits: Significant digits, as in `number`.
    """
    unit = unit.fit(value)
    return f"{number(unit.of(value), digits)} {unit.name}"


def small_text(value: float, unit: ShownUnit) -> str:
    """Return "negligible" with the size of a value, or "balanced" for 0.

    Args:
        value: Value, SI.
        unit: Unit of the value.
    """
    return f"negligible ({size_text(value, unit, 2)})" if value else NOTHING


def size_cell(
    value: float | None, unit: ShownUnit, *, negligible: bool = False, digits: int | None = 4
) -> str:
    """Return the cell of a force or moment: its value, "balanced" or "negligible"; a dash if it is
    not known.

    Args:
        value: Value, SI; None: not known.
        unit: Unit of the column.
        negligible: Whether the value is negligible.
        digits: Significant digits, as in `number`.
    """
    if value is None:
        return UNKNOWN
    if not value:
        return NOTHING
    return "negligible" if negligible else number(unit.of(value), digits)


def degrees(value: float, turn: float = 360) -> str:
    """Return an angle as text, rounded by `round_degrees`, or a dash for nan.

    Args:
        value: Angle, deg.
        turn: Period of the angle, deg: 360, or 180 for undirected lines.
    """
    if math.isnan(value):
        return UNKNOWN
    return f"{round_degrees(value, turn):.1f}"


def round_degrees(value: float, turn: float = 360) -> float:
    """Return an angle rounded to a tenth of a degree.

    Minus half a period becomes plus half a period, and 360 becomes 0. Otherwise rounding errors
    would decide which of two equal angles is shown.

    Args:
        value: Angle, deg.
        turn: Period of the angle, deg: 360, or 180 for undirected lines.
    """
    tenths = round(round(value, 6), 1) + 0.0
    if tenths == -turn / 2:
        return turn / 2
    return 0.0 if tenths == 360 else tenths


VISIBLE = 1e-3  # amplitudes below this share of the largest one are invisible in pictures


R = TypeVar("R")


class View(NamedTuple):
    """Parts of an analysis that a sheet shows.

    Attributes:
        whole: Whether every table and order is shown; otherwise only the default tables and
            relevant orders.
        parts: Words of `--only`, such as `force`, `xy`, `verdict`; empty: the default parts.
        every_order: Whether negligible orders are shown as well.
        hints: Whether the sheet names commands and options that show more.
    """

    whole: bool = False
    parts: frozenset[str] = frozenset()
    every_order: bool = False
    hints: bool = True


WITHOUT_HINTS = View(hints=False)


class NamedResult(NamedTuple, Generic[R]):
    """Result for one of several engines.

    Attributes:
        result: Result.
        name: Name of the engine, which distinguishes its rows from those of other engines.
        view: Parts that a sheet shows.
    """

    name: str
    result: R
    view: View


def assumed_facts(assumed: Sequence[Assumed] | None) -> tuple[Facts, ...]:
    """Return the values assumed because the file leaves them out, for the head of a sheet."""
    return (Facts((("assumed", tell_assumed(assumed)),)),) if assumed else ()


def tell_assumed(assumed: Iterable[Assumed], shown: Collection[str] = ()) -> str:
    """Return assumed values in words. Values of single engines follow at the end, after the
    engine's name. The prefix `gas.` appears only once for each engine.

    Args:
        assumed: Assumed values.
        shown: Paths of values that are shown elsewhere; only these paths are named.
    """
    of_engines: dict[str | None, list[Assumed]] = {None: []}
    for value in assumed:
        of_engines.setdefault(value.engine, []).append(value)
    parts: list[str] = []
    for engine, values in of_engines.items():
        if values:
            text = ", ".join(_list_assignments(values, shown))
            parts.append(text if engine is None else f"{engine}: {text}")
    return "; ".join(parts)


def _list_assignments(values: Iterable[Assumed], shown: Collection[str]) -> Iterator[str]:
    """Yield the assignment of each value (`rod.cg = 0 mm`), or only its path if it is shown
    elsewhere.
    """
    tables: set[str] = set()
    for path, value, unit, _ in values:
        table, _, key = path.partition(".")
        name = key if table == "gas" and table in tables else path
        tables.add(table)
        if path in shown:
            yield name
        else:
            yield " ".join(filter(None, (name, "=", write_value(value), unit)))


def write_value(value: Value) -> str:
    """Return an assumed value in the notation of a file, numbers with six significant digits."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, tuple):
        return f"[{', '.join(map(write_value, value))}]"
    if isinstance(value, str):
        return value
    return f"{value:g}"

"""A recomputed table next to its print, and the rule that says which printed figures are wrong."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from decimal import ROUND_DOWN, ROUND_HALF_UP, Decimal, InvalidOperation
from fractions import Fraction
from typing import TypeAlias

from ..result import Result

Cell: TypeAlias = float | str | None
Row: TypeAlias = tuple[Cell, ...]
Words: TypeAlias = tuple[str | None, ...]


@dataclass(frozen=True)
class Explanation:
    """Figures as the author may have computed them, in the places of the exact ones; None where the
    explanation has no figure.
    """

    kind: str
    rows: tuple[Row, ...]


@dataclass(frozen=True)
class Erratum:
    """A printed figure that is not the exact one rounded to as many digits."""

    row: int
    column: str
    printed: str
    exact: Cell
    kind: str


@dataclass(frozen=True, repr=False)
class Table(Result):
    """Rows as recomputed and as printed, of one shape; `errata` follow from the two.

    Attributes:
        name: Name of the table.
        title: Title of the table.
        source: Book or paper that prints it.
        columns: Names of the columns.
        exact: Cells of every row.
        printed: Printed texts of every row.
        explanations: Explanations of errata.
        stub: How many leading columns name a row.
        digits: Decimals of the figures that are shown; None: as printed.
    """

    name: str
    title: str
    source: str
    columns: tuple[str, ...]
    exact: tuple[Row, ...]
    printed: tuple[Words, ...]
    explanations: tuple[Explanation, ...] = ()
    stub: int = 1
    digits: int | None = None

    @property
    def summary(self) -> str:
        """Name and title of the table."""
        return f"{self.name}: {self.title}"

    @property
    def errata(self) -> tuple[Erratum, ...]:
        """Printed cells that are not the exact ones rounded."""
        return tuple(self._errata())

    def label(self, row: int) -> str:
        """Return the name of a row: the cells of its stub."""
        cells = self.exact[row][: self.stub]
        shown = [c if isinstance(c, str) else f"{c:.15g}" for c in cells if c is not None]
        return ", ".join(filter(None, shown))

    def _errata(self) -> Iterator[Erratum]:
        for i, (row, words) in enumerate(zip(self.exact, self.printed, strict=True)):
            for j, (value, text) in enumerate(zip(row, words, strict=True)):
                if text is not None and deviates(value, text):
                    supposed = [(each.kind, each.rows[i][j]) for each in self.explanations]
                    kind = _find_kind(value, text, supposed)
                    yield Erratum(i, self.columns[j], text, value, kind)


def parse_decimal(text: str) -> Decimal | None:
    """Return the printed decimal with its digits (`.4312`, `+1.0`, `-0.5`); None for others."""
    try:
        value = Decimal(text.strip().replace("−", "-"))
    except InvalidOperation:
        return None
    return value if value.is_finite() else None


def parse_number(cell: Cell) -> Fraction | None:
    """Return `0.24`, `1/4.5`, `.0048` or `15/128` exactly; None for any other text."""
    above, _, below = str(cell).replace(" ", "").partition("/")
    try:
        return Fraction(above) / Fraction(below or 1)
    except (ValueError, ZeroDivisionError):
        return None


def round_like(value: float, like: Decimal, rounding: str = ROUND_HALF_UP) -> Decimal:
    """Return the value with the decimals of a printed figure, halves rounded away from zero."""
    return Decimal(repr(float(value))).quantize(Decimal(1).scaleb(_exponent(like)), rounding)


def deviates(value: Cell, text: str) -> bool:
    """Return whether a printed figure is not the exact value rounded; words never deviate."""
    printed, fraction = parse_decimal(text), parse_number(text)
    if isinstance(value, (int, float)):
        if printed is not None:
            return round_like(value, printed) != printed
        return fraction is not None and abs(value - fraction) > 1e-12 * abs(fraction)
    exact = parse_number(value)
    return exact is not None and fraction is not None and exact != fraction


def explain_figure(value: Cell, text: str) -> str | None:
    """Return how a value leads to the printed figure: "", ", truncated", ", digits transposed";
    None: it does not.
    """
    printed = parse_decimal(text)
    if printed is None or not isinstance(value, (int, float)):
        return None
    rounded = round_like(value, printed)
    if rounded == printed:
        return ""
    if round_like(value, printed, ROUND_DOWN) == printed:
        return ", truncated"
    x, y = str(rounded), str(printed)
    swaps = (f"{x[:i]}{x[i + 1]}{x[i]}{x[i + 2 :]}" for i in range(len(x) - 1))
    return ", digits transposed" if y in swaps else None


def _find_kind(value: Cell, text: str, supposed: Sequence[tuple[str, Cell]]) -> str:
    """Return the kind of an erratum: the first explanation that leads to it, or what its digits
    show.
    """
    printed = parse_decimal(text)
    if printed is None or not isinstance(value, (int, float)):
        return "misprint"
    for kind, other in supposed:
        differs = isinstance(other, (int, float)) and abs(other - value) > 1e-9 * abs(value)
        if differs and (found := explain_figure(other, text)) is not None:
            return kind + found
    error = abs(round_like(value, printed) - printed).scaleb(-_exponent(printed))
    kind = "misprint" if error > 1 else "last digit"
    return kind + (explain_figure(value, text) or "")


def _exponent(printed: Decimal) -> int:
    exponent = printed.as_tuple().exponent
    return exponent if isinstance(exponent, int) else 0

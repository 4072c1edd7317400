"""A recomputed table beside its print, and the rule that says which printed figures are wrong."""

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

NEAR_A_TIE = Decimal("0.1")  # units of the last printed digit


@dataclass(frozen=True)
class Explanation:
    """Figures as the author may have computed them, in the places of the exact ones; None where it
    says nothing.
    """

    kind: str
    rows: tuple[Row, ...]

    @classmethod
    def of_answer(cls, kind: str, number: int, value: Cell, table: Sequence[Row]) -> Explanation:
        """Another value of one answer (from 0), each of which stands at the end of its row."""
        blank = tuple((None,) * len(row) for row in table)
        told = (*blank[number][:-1], value)
        return cls(kind, (*blank[:number], told, *blank[number + 1 :]))


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
        name: by which it is asked for.
        title: what it shows.
        source: where it is printed.
        columns: their names.
        exact: a row of cells for each of the table.
        printed: the same as texts, as they are printed.
        explanations: of errata.
        stub: how many leading columns name a row.
    """

    name: str
    title: str
    source: str
    columns: tuple[str, ...]
    exact: tuple[Row, ...]
    printed: tuple[Words, ...]
    explanations: tuple[Explanation, ...] = ()
    stub: int = 1

    @property
    def summary(self) -> str:
        """Its name and title."""
        return f"{self.name}: {self.title}"

    @property
    def errata(self) -> tuple[Erratum, ...]:
        """Printed cells that are not the exact ones rounded."""
        return tuple(self._errata())

    def label(self, row: int) -> str:
        """What names a row: the cells of its stub."""
        shown = [
            f"{c:.15g}" if isinstance(c, (int, float)) else c for c in self.exact[row][: self.stub]
        ]
        return ", ".join(text for text in shown if text)

    def _errata(self) -> Iterator[Erratum]:
        for i, (row, words) in enumerate(zip(self.exact, self.printed, strict=True)):
            for j, (value, text) in enumerate(zip(row, words, strict=True)):
                if text is not None and deviates(value, text):
                    yield Erratum(i, self.columns[j], text, value, self._kind(i, j))

    def _kind(self, i: int, j: int) -> str:
        value, text = self.exact[i][j], self.printed[i][j] or ""
        for explanation in self.explanations:
            supposed = explanation.rows[i][j]
            found = explain_figure(supposed, text)
            if found is not None and not _same(supposed, value):
                return explanation.kind + found
        return _plain_kind(value, text)


def parse_decimal(text: str) -> Decimal | None:
    """The printed decimal with its digits (`.4312`, `+1.0`, `-0.5`), None if the text is none."""
    try:
        value = Decimal(text.strip().replace("−", "-"))
    except InvalidOperation:
        return None
    return value if value.is_finite() else None


def parse_decimals(words: Words) -> tuple[Decimal | None, ...]:
    """The printed decimals of a row, None where it has none."""
    return tuple(parse_decimal(text or "") for text in words)


def parse_fraction(cell: Cell) -> Fraction | None:
    """`15/128` as a fraction, None for any other text."""
    try:
        return Fraction(str(cell).replace(" ", ""))
    except (ValueError, ZeroDivisionError):
        return None


def round_like(value: float, like: Decimal, rounding: str = ROUND_HALF_UP) -> Decimal:
    """The value with as many decimals as a printed figure, halves rounded away from zero."""
    return Decimal(repr(float(value))).quantize(_unit(like), rounding)


def deviates(value: Cell, text: str) -> bool:
    """Whether a printed figure is not the exact value rounded; words and ranges never deviate."""
    printed = parse_decimal(text)
    if isinstance(value, (int, float)):
        if printed is not None:
            return round_like(value, printed) != printed
        exact = parse_fraction(text)
        return exact is not None and abs(value - exact) > 1e-12 * abs(exact)
    exact, fraction = parse_fraction(value), parse_fraction(text)
    return exact is not None and fraction is not None and exact != fraction


def explain_figure(value: Cell, text: str) -> str | None:
    """How this value leads to the printed figure: "", ", truncated", ...; None: it does not."""
    printed = parse_decimal(text)
    if printed is None or not isinstance(value, (int, float)):
        return None
    if round_like(value, printed) == printed:
        return ""
    if round_like(value, printed, ROUND_DOWN) == printed:
        return ", truncated"
    return ", digits transposed" if _transposed(round_like(value, printed), printed) else None


def _plain_kind(value: Cell, text: str) -> str:
    """The kind of an erratum by its digits alone."""
    printed = parse_decimal(text)
    if printed is None or not isinstance(value, (int, float)):
        return "misprint"
    exact = round_like(value, printed)
    if abs(exact - printed) > _unit(printed):
        return "misprint, digits transposed" if _transposed(exact, printed) else "misprint"
    tie = abs(Decimal(repr(float(value))) - (exact + printed) / 2)
    if tie <= NEAR_A_TIE * _unit(printed):
        return "last digit, near a tie"
    return (
        "last digit, truncated"
        if round_like(value, printed, ROUND_DOWN) == printed
        else "last digit"
    )


def _same(a: Cell, b: Cell) -> bool:
    return (
        isinstance(a, (int, float)) and isinstance(b, (int, float)) and abs(a - b) <= 1e-9 * abs(b)
    )


def _unit(printed: Decimal) -> Decimal:
    exponent = printed.as_tuple().exponent
    return Decimal(1).scaleb(exponent if isinstance(exponent, int) else 0)


def _transposed(a: Decimal, b: Decimal) -> bool:
    """Whether two figures differ by an exchange of two neighbouring digits."""
    x, y = str(a), str(b)
    differing = [i for i, (p, q) in enumerate(zip(x, y, strict=False)) if p != q]
    if len(x) != len(y) or len(differing) != 2:
        return False
    i, j = differing
    return j == i + 1 and x[i] == y[j] and x[j] == y[i]

"""Compare recomputed tables with the printed ones, and classify the printed figures that are wrong
(errata).

Each printed table is a CSV file of the package. Its first lines are its title, and either its
number in its source (`printed as`) or, if it is from none of the five books and papers, its source.
The user may replace the rows and columns of a table by ranges such as `0.20:0.40:0.01` or
`0.24,0.28,1/3`.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from decimal import ROUND_DOWN, ROUND_HALF_UP, Decimal, InvalidOperation
from fractions import Fraction
from importlib.resources import files
from typing import Annotated, Literal, NamedTuple, TypeAlias, cast

import numpy as np

from ..core.phasors import Array
from ..core.records import HIDDEN, WrittenAs
from ..errors import Argument, ArgumentError
from ..limits import LARGEST_TABLE_VALUE, MOST_TABLE_VALUES
from ..show.result import Result
from .sources import find_origin

Cell: TypeAlias = float | str | None
Row: TypeAlias = tuple[Cell, ...]
Words: TypeAlias = tuple[str | None, ...]
ErratumClass = Literal["misprint", "rounding", "approximation", "method", "error", "copy"]
STATEMENT = "statement"  # column of errata that are equations or sentences
ANSWER = "balcli"  # column of the answers to published problems
CLASSES: dict[ErratumClass, str] = {
    "misprint": "the printed figure or text contradicts the source's own formula",
    "rounding": "last digits are wrong: cut off, or computed from rounded figures",
    "approximation": "the figure follows from the author's rounded constant or shortened series",
    "method": "the author's method does not find the value that it searches for",
    "error": "the statement itself is wrong, not only its printing",
    "copy": "wrong in the scanned copy that was read; the print may be right",
}


class Explanation(NamedTuple):
    """Figures as the author may have computed them, in the same cells as the exact ones; None in
    cells that this explanation does not cover.
    """

    kind: str
    rows: tuple[Row, ...]
    category: ErratumClass = "method"


class Erratum(NamedTuple):
    """A printed figure that differs from the rounded exact one, or a wrong statement.

    Attributes:
        row: Number of the row in its table, from 0.
        column: Heading of the column.
        printed: Text in the source.
        exact: Right value or statement.
        kind: Cause of the erratum; for a statement, the evidence for its right form.
        label: Name of the row.
        category: Class of the erratum, a key of `CLASSES`.
        place: Where in its source a wrong statement stands; empty for a figure.
    """

    row: int
    column: str
    printed: str
    exact: Cell
    kind: str
    label: str
    category: Annotated[ErratumClass, WrittenAs(key="class")]
    place: Annotated[str, HIDDEN] = ""


@dataclass(frozen=True, repr=False)
class Table(Result):
    """A recomputed table: exact and printed rows of the same shape.

    Attributes:
        name: Name of the table.
        title: Title of the table.
        source: Book or paper that prints it.
        columns: Names of the columns.
        exact: Exact cells of every row.
        printed: Printed texts of every row; null: not printed.
        errata: Printed cells that differ from the rounded exact ones, or wrong statements.
        stub: Number of leading columns that name a row.
    """

    format: Literal["balcli.table/1"] = field(default="balcli.table/1", kw_only=True)
    name: str
    title: str
    source: str
    columns: tuple[str, ...]
    exact: Annotated[tuple[Row, ...], WrittenAs(key="rows")]
    printed: tuple[Words, ...]
    errata: tuple[Erratum, ...]
    stub: Annotated[int, HIDDEN] = 1

    @property
    def summary(self) -> str:
        """Name and title of the table."""
        return f"{self.name}: {self.title}"


def parse_decimal(text: str) -> Decimal | None:
    """Return a printed decimal (`.4312`, `+1.0`, `-0.5`) with its digits; None for other texts."""
    try:
        value = Decimal(text.strip().replace("−", "-"))
    except InvalidOperation:
        return None
    return value if value.is_finite() else None


def parse_number(cell: Cell) -> Fraction | None:
    """Return the exact number in `0.24`, `1/4.5`, `.0048` or `15/128`; None for other texts."""
    above, _, below = str(cell).replace(" ", "").partition("/")
    try:
        return Fraction(above) / Fraction(below or 1)
    except (ValueError, ZeroDivisionError):
        return None


def round_like(value: float, like: Decimal, rounding: str = ROUND_HALF_UP) -> Decimal:
    """Return the value rounded to the decimals of a printed figure, with halves away from zero."""
    return Decimal(repr(float(value))).quantize(like, rounding)


def deviates(value: Cell, text: str) -> bool:
    """Return whether a printed figure differs from the rounded exact value; words never do."""
    printed = parse_decimal(text)
    if printed is not None and isinstance(value, (int, float)):
        return round_like(value, printed) != printed
    exact = parse_number(value)
    fraction = parse_number(text)
    if exact is None or fraction is None:
        return False
    return abs(exact - fraction) > abs(fraction) / 10**12


def _derive(value: float, printed: Decimal) -> str | None:
    """Return how a value becomes the printed figure: "" (rounded), ", truncated" or ", digits
    transposed"; None if it does not.
    """
    rounded = round_like(value, printed)
    if rounded == printed:
        return ""
    if round_like(value, printed, ROUND_DOWN) == printed:
        return ", truncated"
    x = str(rounded)
    y = str(printed)
    swaps = (f"{x[:i]}{x[i + 1]}{x[i]}{x[i + 2 :]}" for i in range(len(x) - 1))
    return ", digits transposed" if y in swaps else None


def _explain(
    value: Cell, text: str, supposed: Iterable[tuple[Explanation, Cell]]
) -> tuple[ErratumClass, str]:
    """Return the class and kind of an erratum: those of the first explanation whose figure leads to
    the printed one; without such an explanation, the class follows from the digits.
    """
    printed = parse_decimal(text)
    if printed is None or not isinstance(value, (int, float)):
        return "misprint", "misprint"
    for (kind, _, category), other in supposed:
        if not isinstance(other, (int, float)) or abs(other - value) <= 1e-9 * abs(value):
            continue
        if (cause := _derive(other, printed)) is not None:
            whose = "author's approximation: " if category == "approximation" else ""
            return category, whose + kind + cause
    unit = Decimal(f"1e{printed.as_tuple().exponent}")  # one unit of the last digit
    near = abs(round_like(value, printed) - printed) <= unit
    category, kind = ("rounding", "last digit") if near else ("misprint", "misprint")
    return category, kind + (_derive(value, printed) or "")


class Print(NamedTuple):
    """A table as the source prints it; None marks cells that it leaves empty."""

    name: str
    title: str
    source: str
    columns: tuple[str, ...]
    rows: tuple[Words, ...]

    def column(self, heading: str) -> tuple[str, ...]:
        """Return the texts of a column; cells without print are empty."""
        return tuple(row[self.columns.index(heading)] or "" for row in self.rows)

    def headings(self) -> tuple[str, ...]:
        """Return the headings that are numbers: 0.24, 1/4.5."""
        return tuple(c for c in self.columns if parse_number(c) is not None)

    def align_cells(self, stub: Sequence[str], columns: Sequence[str]) -> list[Words]:
        """Return the printed cells for these rows (by their first cell) and columns. Different
        texts of the same number match (0.3 and 0.30). None marks cells without print.
        """
        rows = {identify(row[0] or ""): row for row in self.rows}
        numbers = {identify(c): j for j, c in enumerate(self.columns)}
        places = [numbers.get(identify(c)) for c in columns]
        nothing = (None,) * len(self.columns)
        aligned = []
        for name in stub:
            row = rows.get(identify(name), nothing)
            aligned.append(tuple(None if place is None else row[place] for place in places))
        return aligned

    def compare_columns(
        self,
        headings: Sequence[str],
        body: Iterable[Iterable[float]],
        explanations: Sequence[Explanation] = (),
    ) -> Table:
        """Return the table with a row of figures for each name in the first column of the print,
        and a column for each heading.
        """
        stub = self.column(self.columns[0])
        columns = (self.columns[0], *headings)
        cells = self.align_cells(stub, columns)
        return self.compare(columns, head_rows(stub, body), cells, explanations)

    def compare(
        self,
        columns: Sequence[str],
        rows: Sequence[Row],
        printed: Sequence[Words] | None = None,
        explanations: Sequence[Explanation] = (),
        stub: int = 1,
    ) -> Table:
        """Return the table of recomputed rows, with the printed ones and the errata.

        Args:
            columns: Names of the columns.
            rows: Recomputed rows.
            printed: Printed texts of the rows; None: the rows of this print, with further columns
                left empty.
            explanations: Possible explanations of errata.
            stub: Number of leading columns that name a row.
        """
        if printed is None:
            printed = [words + (None,) * (len(columns) - len(words)) for words in self.rows]
        errata = []
        for i, (row, words) in enumerate(zip(rows, printed, strict=True)):
            names = (c if isinstance(c, str) else f"{c:.15g}" for c in row[:stub] if c is not None)
            label = ", ".join(filter(None, names))
            for j, (value, text) in enumerate(zip(row, words, strict=True)):
                if text is not None and deviates(value, text):
                    supposed = ((each, each.rows[i][j]) for each in explanations)
                    category, kind = _explain(value, text, supposed)
                    errata.append(Erratum(i, columns[j], text, value, kind, label, category))
        return Table(
            name=self.name,
            title=self.title,
            source=self.source,
            columns=tuple(columns),
            exact=tuple(rows),
            printed=tuple(printed),
            errata=tuple(errata),
            stub=stub,
        )

    def compare_answers(
        self, answers: Sequence[float], others: Sequence[tuple[ErratumClass, str, int, float]]
    ) -> Table:
        """Return the table of worked examples; the answers are the last cells of the rows.

        Args:
            answers: Exact answers.
            others: Values that authors computed instead, each with the class and kind of erratum
                and the index of the answer: (class, kind, index, value).
        """
        rows = [(*words[:-1], one) for words, one in zip(self.rows, answers, strict=True)]
        blank: Row = (None,) * len(self.columns)
        explanations = []
        for category, kind, n, value in others:
            figures = [blank] * len(rows)
            figures[n] = (*blank[1:], value)
            explanations.append(Explanation(kind, tuple(figures), category))
        return self.compare(self.columns, rows, explanations=explanations, stub=4)


def tabulate_statements(printed: Print, ranges: Ranges) -> Table:
    """Return the table of wrong equations and sentences. Every row is an erratum whose `exact` is
    the right form. The tests compute the printed and the right form of each statement.
    """
    rows = [tuple(map(str, row)) for row in printed.rows]
    cells = [(source, place, *others) for source, place, _, *others in rows]
    words = [(source, place, wrong, None, None) for source, place, wrong, *_ in rows]
    errata = []
    for i, (source, place, wrong, right, name, kind) in enumerate(rows):
        erratum = Erratum(
            row=i,
            column=STATEMENT,
            printed=wrong,
            exact=right,
            kind=kind,
            label=f"{source}, {place}",
            category=cast("ErratumClass", name),
            place=place,
        )
        errata.append(erratum)
    return Table(
        name=printed.name,
        title=printed.title,
        source=printed.source,
        columns=("source", "place", STATEMENT, "class", "known"),
        exact=tuple(cells),
        printed=tuple(words),
        errata=tuple(errata),
        stub=2,
    )


def read_data(file: str) -> str:
    """Return the text of a data file of the package."""
    return files(__package__).joinpath("data", file).read_text("utf-8")


def load_print(name: str) -> Print:
    """Read the print of a table: lines `# printed as:` or `# source:` and `# title:`, then headings
    and rows.
    """
    lines = read_data(f"{name}.csv").splitlines()
    notes = dict(line[2:].split(": ", 1) for line in lines if line.startswith("# "))
    head, *body = csv.reader(line for line in lines if not line.startswith("# "))
    rows = tuple(tuple(cell or None for cell in row) for row in body)
    origin = find_origin(name)
    if origin is None:
        source = notes["source"]
    elif "printed as" in notes:
        source = f"{origin.citation}, {notes['printed as']}"
    else:
        source = origin.citation
    return Print(name, notes["title"], source, tuple(head), rows)


def identify(text: str) -> object:
    """Return the key of a row or column: its number, so that 0.3 equals 0.30, or its text."""
    number = parse_number(text)
    return text if number is None else number


def as_numbers(texts: Iterable[str]) -> Array:
    """Return the texts as numbers; nan for a text that is not a number."""
    return np.array([np.nan if (n := parse_number(text)) is None else float(n) for text in texts])


def as_cells(values: Iterable[float]) -> list[Cell]:
    """Return numbers as plain floats, with -0.0 replaced by 0.0."""
    return [float(v) + 0.0 for v in values]


def head_rows(stub: Iterable[Cell], body: Iterable[Iterable[float]]) -> tuple[Row, ...]:
    """Return rows of numbers, each preceded by its cell of the stub."""
    return tuple((head, *as_cells(line)) for head, line in zip(stub, body, strict=True))


_PLAIN = re.compile(r"\s*[-+.\d/]{1,30}(e-?\d{1,2})?\s*", re.IGNORECASE)


class Ranges(NamedTuple):
    """Columns and rows that replace those of the print; None: as printed.

    Attributes:
        lam: Values of lambda (crank radius over rod length), as texts of the headings.
        angle: Crank angles or bank angles, deg, as texts of the rows or headings.
        power: Highest power of lambda.
    """

    lam: tuple[str, ...] | None = None
    angle: tuple[str, ...] | None = None
    power: int | None = None


def parse_range(argument: str, text: str) -> tuple[str, ...]:
    """Return the numbers of a range as texts; START:STOP:STEP includes STOP if a step meets it.

    Args:
        argument: Name of the argument, for messages.
        text: Range, or list of numbers.

    Raises:
        ArgumentError: The text is neither a range nor a list of numbers, or has too many of them.
    """
    try:
        headings = [heading for item in text.split(",") for heading in _expand(*item.split(":"))]
    except (ValueError, TypeError, ArithmeticError):
        raise ArgumentError(
            "{argument} {text!r} is no range: give START:STOP:STEP (0.20:0.40:0.01) or a list "
            "(0.24,0.28,1/3)",
            argument=Argument(argument),
            text=text,
        ) from None
    return tuple(dict.fromkeys(headings))


def parse_crank_ratios(text: str) -> tuple[str, ...]:
    """Return the numbers of a range of lambda (crank radius over rod length) as texts.

    Raises:
        ArgumentError: The range is wrong (see `parse_range`), or a mechanism in it cannot turn.
    """
    headings = parse_range("lambda_", text)
    bad = next((heading for heading in headings if not 0 < _read(heading) < 1), None)
    if bad is not None:
        raise ArgumentError(
            "{lambda_} {text!r}: lambda = {bad}, but a crank turns only with 0 < lambda < 1; give "
            "crank radius over rod length, such as 0.25 or 1/3.5",
            text=text,
            bad=bad,
        )
    return headings


def _read(text: str) -> Fraction:
    """Return the number in a text; raise ValueError if it is unsuitable for an angle or ratio."""
    value = parse_number(text) if _PLAIN.fullmatch(text) else None
    if value is None or abs(value) > LARGEST_TABLE_VALUE:
        raise ValueError(text)
    return value


def _expand(start: str, stop: str | None = None, step: str = "1") -> list[str]:
    first = _read(start)
    stride = _read(step)
    if stop is None:
        return [start.strip()]
    count = (_read(stop) - first) / stride
    if not 0 <= count < MOST_TABLE_VALUES:
        raise ValueError(count)
    return [_heading(first + k * stride) for k in range(int(count) + 1)]


def _heading(value: Fraction) -> str:
    """Return a number as text: 6/25 as 0.24, but 1/3, which has no finite decimal, as 1/3."""
    decimal = Decimal(value.numerator) / value.denominator
    return f"{decimal.normalize():f}" if Fraction(decimal) == value else str(value)

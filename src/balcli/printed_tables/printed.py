"""The printed figures: package data, one CSV file a table, headed by its source."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from importlib.resources import files
from typing import TypeAlias

from .recomputed import Cell, Explanation, Row, Table, Words

Key: TypeAlias = Fraction | str


@dataclass(frozen=True)
class Print:
    """A table as printed; cells that are not printed are None."""

    name: str
    source: str
    title: str
    columns: tuple[str, ...]
    rows: tuple[Words, ...]

    def column(self, heading: str) -> Words:
        return tuple(row[self.columns.index(heading)] for row in self.rows)

    def numbers(self, heading: str) -> list[float]:
        """A column all of whose cells are numbers."""
        return [float(parse_number(text or "")) for text in self.column(heading)]

    def headings(self) -> tuple[str, ...]:
        """The headings that are numbers: 0.24, 1/4.5."""
        return tuple(c for c in self.columns if isinstance(identify(c), Fraction))

    def align_cells(self, stub: Sequence[str], columns: Sequence[str]) -> tuple[Words, ...]:
        """The printed cells of these rows (found by the first column) and columns; None where
        nothing is printed.
        """
        rows = {identify(row[0] or ""): row for row in self.rows}
        places = {identify(c): j for j, c in enumerate(self.columns)}

        def cell(row: Words | None, column: str) -> str | None:
            place = places.get(identify(column))
            return None if row is None or place is None else row[place]

        return tuple(tuple(cell(rows.get(identify(s)), c) for c in columns) for s in stub)

    def compare(
        self,
        columns: Sequence[str],
        rows: Sequence[Row],
        printed: Sequence[Words] | None = None,
        explanations: Sequence[Explanation] = (),
        stub: int = 1,
    ) -> Table:
        """The recomputed rows beside the print; without `printed`, row by row, further columns
        having no print.
        """
        if printed is None:
            printed = [words + (None,) * (len(columns) - len(words)) for words in self.rows]
        return Table(
            self.name,
            self.title,
            self.source,
            tuple(columns),
            tuple(rows),
            tuple(printed),
            tuple(explanations),
            stub,
        )


def load_print(name: str) -> Print:
    """The print of a table: `# source:` and `# title:` lines, headings, rows."""
    text = files(__package__).joinpath("data", f"{name}.csv").read_text(encoding="utf-8")
    lines = text.splitlines()
    notes = dict(line[2:].split(": ", 1) for line in lines if line.startswith("# "))
    head, *body = csv.reader(line for line in lines if not line.startswith("# "))
    rows = tuple(tuple(cell or None for cell in row) for row in body)
    return Print(name, notes["source"], notes["title"], tuple(head), rows)


def parse_number(text: str) -> Fraction:
    """`0.24`, `1/4.5`, `.0048` or `-1.6`, exactly.

    Raises:
        ValueError: the text is no number.
    """
    above, _, below = text.strip().partition("/")
    try:
        return Fraction(above) / Fraction(below or 1)
    except ZeroDivisionError:
        raise ValueError(text) from None


def identify(text: str) -> Key:
    """What identifies a row or column: its number (0.3 is 0.30), or else its text."""
    try:
        return parse_number(text)
    except ValueError:
        return text


def as_cells(values: Iterable[float]) -> list[Cell]:
    """Numbers of any kind as plain floats; minus zero as zero."""
    return [float(v) + 0.0 for v in values]


def head_rows(stub: Iterable[Cell], body: Iterable[Iterable[float]]) -> tuple[Row, ...]:
    """Rows of numbers, each headed by its cell of the stub."""
    return tuple((head, *as_cells(line)) for head, line in zip(stub, body, strict=True))

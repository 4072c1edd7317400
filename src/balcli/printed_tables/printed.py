"""The printed figures: package data, one CSV file a table, headed by its source."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from importlib.resources import files

import numpy as np

from ..core.phasors import Array
from .recomputed import Cell, Explanation, Row, Table, Words, parse_number


@dataclass(frozen=True)
class Print:
    """A table as printed; cells that are not printed are None."""

    name: str
    source: str
    title: str
    columns: tuple[str, ...]
    rows: tuple[Words, ...]

    def column(self, heading: str) -> tuple[str, ...]:
        """Return the texts of a column; empty where nothing is printed."""
        return tuple(row[self.columns.index(heading)] or "" for row in self.rows)

    def headings(self) -> tuple[str, ...]:
        """Return the headings that are numbers: 0.24, 1/4.5."""
        return tuple(c for c in self.columns if parse_number(c) is not None)

    def align_cells(self, stub: Sequence[str], columns: Sequence[str]) -> list[Words]:
        """Return the printed cells of these rows (found by the first column) and columns; numbers
        are the same however they are written. Cells that are not printed are None.
        """
        rows = {identify(row[0] or ""): row for row in self.rows}
        numbers = {identify(c): j for j, c in enumerate(self.columns)}
        places = [numbers.get(identify(c)) for c in columns]
        nothing = (None,) * len(self.columns)
        found = [rows.get(identify(name), nothing) for name in stub]
        return [tuple(None if j is None else row[j] for j in places) for row in found]

    def compare(
        self,
        columns: Sequence[str],
        rows: Sequence[Row],
        printed: Sequence[Words] | None = None,
        explanations: Sequence[Explanation] = (),
        stub: int = 1,
    ) -> Table:
        """Return the recomputed rows next to the print.

        Args:
            columns: Names of the columns.
            rows: Recomputed rows.
            printed: Printed texts of the rows; None: row by row, further columns have no print.
            explanations: Explanations of errata.
            stub: How many leading columns name a row.
        """
        if printed is None:
            printed = [words + (None,) * (len(columns) - len(words)) for words in self.rows]
        shape = tuple(columns), tuple(rows), tuple(printed)
        return Table(self.name, self.title, self.source, *shape, tuple(explanations), stub)

    def compare_answers(
        self, answers: Sequence[float], others: Sequence[tuple[str, int, float]]
    ) -> Table:
        """Return the exact answers of worked examples, which stand at the ends of the rows.

        Args:
            answers: Exact answers.
            others: What authors took instead: the kind of erratum, the number of the answer (from
                0), their value.
        """
        rows = [(*words[:-1], one) for words, one in zip(self.rows, answers, strict=True)]
        blank: Row = (None,) * len(self.columns)
        explanations = [
            Explanation(
                kind, tuple((*blank[1:], value if k == n else None) for k in range(len(rows)))
            )
            for kind, n, value in others
        ]
        return self.compare(self.columns, rows, explanations=explanations, stub=4)


def load_print(name: str) -> Print:
    """Return the print of a table: `# source:` and `# title:` lines, headings, rows."""
    text = files(__package__).joinpath("data", f"{name}.csv").read_text(encoding="utf-8")
    lines = text.splitlines()
    notes = dict(line[2:].split(": ", 1) for line in lines if line.startswith("# "))
    head, *body = csv.reader(line for line in lines if not line.startswith("# "))
    rows = tuple(tuple(cell or None for cell in row) for row in body)
    return Print(name, notes["source"], notes["title"], tuple(head), rows)


def identify(text: str) -> object:
    """Return what identifies a row or column: its number (0.3 is 0.30), or its text."""
    number = parse_number(text)
    return text if number is None else number


def as_numbers(texts: Iterable[str]) -> Array:
    """Return the numbers that texts are; nan for a text that is none."""
    return np.array([np.nan if (n := parse_number(text)) is None else float(n) for text in texts])


def as_cells(values: Iterable[float]) -> list[Cell]:
    """Return numbers of any kind as plain floats; minus zero as zero."""
    return [float(v) + 0.0 for v in values]


def head_rows(stub: Iterable[Cell], body: Iterable[Iterable[float]]) -> tuple[Row, ...]:
    """Return rows of numbers, each headed by its cell of the stub."""
    return tuple((head, *as_cells(line)) for head, line in zip(stub, body, strict=True))

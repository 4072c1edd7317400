"""Equations and sentences of the five sources that are wrong, with the right form, how it is known,
and its class.

The tests compute both forms of each and compare them with a reference.
"""

from __future__ import annotations

from typing import cast

from .recomputed import Erratum, ErratumClass, Print, Ranges, Table, Words

STATEMENT = "statement"  # the column of errata that are no figures
COLUMNS = ("source", "place", STATEMENT, "class", "known")


def tabulate_statements(printed: Print, ranges: Ranges) -> Table:
    """Return the table of statements; exact is the right form, and every row is an erratum."""
    cells, words, stated = [], list[Words](), []
    for i, row in enumerate(printed.rows):
        source, place, wrong, right, category, known = map(str, row)
        cells.append((source, place, right, category, known))
        words.append((source, place, wrong, None, None))
        label = f"{source}, {place}"
        category = cast("ErratumClass", category)
        stated.append(Erratum(i, STATEMENT, wrong, right, known, category, label))
    shape = COLUMNS, tuple(cells), tuple(words)
    return Table(printed.name, printed.title, printed.source, *shape, stub=2, stated=tuple(stated))

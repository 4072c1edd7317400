"""Liu Xianzhi: Two-shaft balance of the second-order inertia force of flat-plane V8 engines (in Chinese), 1979."""

from math import sqrt

import pytest

from balcli.books.answer import tables as recompute


def test_paths_of_the_two_shafts():
    """Section 4: they meet at 90 and 180 degrees."""
    table = recompute("liu-1")
    for column in map(table.columns.index, ("90", "180")):
        assert table.exact[0][column] == pytest.approx(table.exact[1][column], abs=1e-14)
    assert table.exact[5][table.columns.index("0")] == -9


def test_table_3_at_the_largest_force():
    table = recompute("liu-3")
    row = next(row for row in table.exact if row[:2] == ("Zx", 109.5))
    assert row[table.columns.index("45")] == pytest.approx(-8 / (3 * sqrt(3)), abs=1e-6)


def test_most_errata_of_table_3_come_from_0_706_for_cos_45():
    kinds = [e.kind for e in recompute("liu-3").errata]
    assert sum("cos 45° taken as 0.706" in kind for kind in kinds) == 48
    assert kinds.count("misprint") == 8
    assert kinds.count("last digit, truncated") == 2

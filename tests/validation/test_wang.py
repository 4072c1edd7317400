"""Wang Yongding: Methods of balancing single-cylinder engines (in Chinese), Shanghai Fisheries University, undated.

J = m_j r omega^2; a counterweight k m_j r leads the point opposite the crank by alpha.
"""

from math import radians

import numpy as np
import pytest

from balcli.books.answer import tables as recompute

TH = np.radians(np.arange(0.0, 360.0, 0.05))


def peak(lam, k, alpha=0.0):
    return np.abs(np.cos(TH) + lam * np.cos(2 * TH) - k * np.exp(1j * (TH + radians(alpha)))).max()


def rows():
    table = recompute("wang-1")
    return [dict(zip(table.columns, row, strict=True)) for row in table.exact]


def test_true_optimum_has_three_equal_maxima():
    """Table 1: at theta = 0 and at two angles symmetric to the cylinder; no other k or alpha does better."""
    for row in rows():
        lam = row["lambda"]
        k = row["k0"]
        assert row["Pmax_min"] == pytest.approx(1 + lam - k, rel=1e-14)
        assert peak(lam, k) == pytest.approx(row["Pmax_min"], rel=1e-6)
        for dk, alpha in ((0.003, 0), (-0.003, 0), (0, 0.3), (0, -0.3)):
            assert peak(lam, k + dk, alpha) > row["Pmax_min"]


def test_true_optimum_in_figures():
    """Found independently by a min-max search over k and alpha on a fine grid of theta."""
    expected = {0.20: 0.624638, 0.25: 0.658266, 0.30: 0.692876, 0.35: 0.728433, 0.40: 0.764890}
    assert {row["lambda"]: round(row["Pmax_min"], 6) for row in rows()} == expected


def test_the_print_searched_half_a_revolution():
    """Its own figures come out of that search; over the whole revolution its choice leaves up to 19 % more."""
    table = recompute("wang-1")
    assert {e.kind.partition(" = ")[0] for e in table.errata} == {"the search ends at theta"}
    assert {e.row for e in table.errata} == set(range(5))
    worse = [row["printed_choice_Pmax"] / row["half_cycle_Pmax_min"] - 1 for row in rows()]
    assert [round(100 * w, 1) for w in worse] == [9.4, 5.7, 0.0, 18.7, 19.7]
    assert min(row["printed_choice_Pmax"] - row["Pmax_min"] for row in rows()) > 0

"""Liang Shoupan: Engine Dynamics (in Chinese), Commercial Press, 1948: section 1-2, and the worked examples, which
`tests/published` computes from engine files.

p = r/l; weights in lb, lengths in in, g = 32.174 ft/s^2.
"""

from math import pi, sqrt

import pytest

from balcli.books.answer import tables as recompute

P = 2 / 7
OMEGA = 4000 * 2 * pi / 60
G = 9.80665 / 0.3048


def answers():
    table = recompute("liang-examples")
    return [row[table.columns.index("answer")] for row in table.exact]


def test_example_2():
    """Triangular rod: hk = 2/9, q^2 = 1/18; the residual couple has the factor 1/sqrt(1 - p^2) (print: 1.036)."""
    factor = 1 / sqrt(1 - P**2)
    couple = 2.75 / G * (1 / 6) * (7 / 12) * (2 / 12) * OMEGA**2 * factor
    assert answers()[3:8] == pytest.approx([2 / 9, 1 / 18, 1 / 6, factor, couple], rel=1e-12)


def test_answers_that_follow_from_rounded_figures():
    kinds = {e.printed: e.kind for e in recompute("liang-examples").errata}
    assert kinds == {
        "37400": "author's approximation: omega taken as 418 rad/s",
        "2080": "follows from the rounded figures 1.79 and 37400, g = 32.2",
        "1.036": "misprint",
        "253": "author's approximation: g taken as 32.2 ft/s^2",
    }

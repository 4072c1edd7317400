"""Liang Shoupan: Engine Dynamics (in Chinese), Commercial Press, 1948: section 1-2, and the worked examples, which
`tests/published` computes from engine files.

p = r/l; weights in lb, lengths in in, g = 32.174 ft/s^2.
"""

from math import pi, sqrt

import pytest

from balcli.books.answer import tables as recompute
from balcli.core.mechanisms import closed_form, power_series
from balcli.engine.build import build
from balcli.engine.parse import parse

P = 2 / 7
OMEGA = 4000 * 2 * pi / 60
G = 9.80665 / 0.3048


def answers():
    table = recompute("liang-examples")
    return [row[table.columns.index("answer")] for row in table.exact]


def test_small_coefficients_at_p_0_3():
    """a_6 = 0.00019 (0.000190081 in two terms, 0.000191937 in all), a_8 = -4.27e-6 in one term, -5.027e-6 in all."""
    assert closed_form.piston([6, 8], 0.3) == pytest.approx([1.91937e-4, -5.0272e-6], rel=1e-5)
    for n, printed in ((6, 1.90081e-4), (8, -4.27148e-6)):
        assert sum(float(c) * 0.3**p for p, c in power_series.piston(n, 7).items()) == pytest.approx(printed, rel=1e-5)


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


def build_cylinders(crank: str, rod: str, piston: str):
    text = f"crank = {{ {crank} }}\nrod = {{ {rod} }}\npiston = {{ mass = '{piston}' }}"
    return build(parse(text, "example")).cylinders


def test_engines_give_the_answers_of_the_table():
    """From engine files: masses, acceleration and force; the rod's couple; weights of the third."""
    crank = "stroke = '4 in'"
    rod = "length = '7 in', mass = '2.75 lb'"
    pound = 0.45359237
    foot = 0.3048
    first = build_cylinders(crank, rod + ", cg = '2 in'", "1 lb")
    second = build_cylinders(crank, rod + ", cg = '7/3 in', inertia = '539/72 lb in^2'", "1 lb")
    ends = "length = '12 in', small_end = '2 lb', big_end = '3 lb'"
    third = build_cylinders("stroke = '6 in', throw_mass = '1 lb'", ends, "6 lb")
    weight = first.reciprocating[0] / pound
    top = 2 / 12 * OMEGA**2 * (1 + first.lam[0])
    share = second.couple[0] / (2.75 * pound * (7 * foot / 12) ** 2)
    rotating = third.rotating[0] / pound
    moving = third.reciprocating[0] / pound
    found = [weight, top, weight * top / G, share, rotating, moving, (rotating + moving / 2) * 3 / 3.5]
    assert found == pytest.approx([answers()[k] for k in (0, 1, 2, 5, 8, 9, 10)], rel=1e-12)

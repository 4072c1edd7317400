"""A. V. Kvasnikov: Determination of the unbalance of piston engines (in Russian), Tomsk, 1920.

Ratios of the orders, and which orders remain in radial, V and in-line engines.
"""

from math import sqrt

import numpy as np
import pytest

from balcli.books.answer import tables as recompute
from balcli.core.mechanisms import closed_form, power_series as series
from balcli.core.phasors import unit

LAM = np.array([1 / 6, 1 / 4])


def percent(coefficients, n, first):
    return [round(100 * float(abs(x)), 4) for x in coefficients([n], LAM)[0] / coefficients([first], LAM)[0]]


def test_force_orders_relative_to_the_first():
    """After Table I: 17 to 25 %, 0.1 to 0.4 %, 0.00 to 0.01 %."""
    assert percent(closed_form.piston, 2, 1) == pytest.approx([16.78, 25.40], abs=0.005)
    assert percent(closed_form.piston, 4, 1) == [0.1182, 0.4098]
    assert percent(closed_form.piston, 6, 1) == pytest.approx([0.00094, 0.00744], abs=6e-5)


def test_rod_moments_relative_to_the_first():
    """After (32): 2.4 to 1 % and 0.05 to 0.01 % (print: 0.04 to 0.00)."""
    assert percent(closed_form.rod, 3, 1) == pytest.approx([1.055, 2.410], abs=6e-4)
    assert percent(closed_form.rod, 5, 1) == pytest.approx([0.0093, 0.0485], abs=6e-5)


def test_wrong_coefficients_of_the_series():
    """(16) prints 5/128 and -3/10, (23) prints 25/1025."""
    wrong = {(e.printed, e.exact) for e in recompute("series").errata}
    assert wrong == {("5/128", "15/128"), ("-3/10", "-3/16"), ("25/1025", "25/1024")}


@pytest.mark.parametrize(
    ("coefficients", "terms", "orders"),
    [(closed_form.piston, series.piston, (2, 4, 6, 8)), (closed_form.rod, series.rod, (1, 3, 5, 7))],
)
def test_tables_i_and_ii_agree_with_the_series(coefficients, terms, orders):
    """Up to lambda^40, beyond which nothing is left at lambda = 1/4."""
    for n, exact in zip(orders, coefficients(list(orders), LAM), strict=True):
        summed = sum(float(c) * LAM**p for p, c in terms(n, 40).items())
        assert exact == pytest.approx(summed, rel=1e-14)


def radial_orders(cylinders, highest=20):
    """Orders n that a radial of equal cylinders on one crank leaves: sum of e^{i(1 -+ n) g} over the axes g."""
    axes = np.arange(cylinders) * 360 / cylinders
    return [
        n
        for n in [1, *range(2, highest, 2)]
        if max(abs(unit((1 - n) * axes).sum()), abs(unit((1 + n) * axes).sum())) > 1e-9
    ]


def test_orders_left_in_radial_engines():
    """Odd i: n = m i -+ 1 for odd m (print: i, 3i, 5i); even i: none above the first."""
    assert radial_orders(5) == [1, 4, 6, 14, 16]
    assert radial_orders(3) == [1, 2, 4, 8, 10, 14, 16]
    assert radial_orders(6) == [1]


def layout(name):
    table = recompute("layouts")
    return next(dict(zip(table.columns, row, strict=True)) for row in table.exact if row[0] == name)


def test_radial_engines():
    """(81): half the reciprocating masses turn with the crank; i = 5 keeps orders 4 and 6, each i/2, i = 7 only 6."""
    five, seven = layout("radial5"), layout("radial7")
    assert five["F1_major"] == five["F1_minor"] == pytest.approx(5 / 2, rel=1e-14)
    assert (five["F2_major"], five["F4_major"], five["F6_major"]) == pytest.approx((0, 5 / 2, 5 / 2), abs=1e-12)
    assert (seven["F4_major"], seven["F6_major"]) == pytest.approx((0, 7 / 2), abs=1e-12)


def test_v_pair_of_90_degrees():
    """First order a circle, second order sqrt2 A_2 along one line."""
    pair = layout("vtwin90")
    assert (pair["F1_major"], pair["F1_minor"]) == pytest.approx((1, 1), rel=1e-14)
    assert (pair["F2_major"], pair["F2_minor"]) == pytest.approx((sqrt(2), 0), abs=1e-14)


def test_in_line_engines():
    """(84), (85): with even crank spacing the lowest order is i (i even) or 2 i (i odd); fours, sixes repeat cranks."""
    assert (layout("i3")["F2_major"], layout("i3")["F6_major"]) == pytest.approx((0, 3), abs=1e-12)
    assert layout("i4")["F2_major"] == pytest.approx(4, rel=1e-14)
    assert (layout("i6")["F4_major"], layout("i6")["F6_major"]) == pytest.approx((0, 6), abs=1e-12)


def test_textbook_moments():
    """sqrt3 F1 a: in-line three; sqrt10 F1 a: cross-plane V8; 4 sqrt2 F2: flat-plane V8 of 90 degrees."""
    assert layout("i3")["M1_major"] == pytest.approx(sqrt(3), rel=1e-14)
    cross = layout("v8_crossplane")
    assert cross["M1_major"] == cross["M1_minor"] == pytest.approx(sqrt(10), rel=1e-14)
    assert layout("v8_flatplane")["F2_major"] == pytest.approx(4 * sqrt(2), rel=1e-14)

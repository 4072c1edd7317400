"""A. V. Kvasnikov: Determination of the unbalance of piston engines (in Russian), Tomsk, 1920.

Ratios of the orders, and which orders remain in radial, V and in-line engines.
"""

from math import sqrt

import numpy as np
import pytest

from balcli.books.answer import tables as recompute
from balcli.core.mechanisms import closed_form
from balcli.core.phasors import unit


@pytest.mark.parametrize(
    ("coefficients", "n", "percent"),
    [  # after Table I: 17 to 25 %, 0.1 to 0.4 %, 0.00 to 0.01 %; after (32): 1 to 2.4 %, 0.00 to 0.04 % (in truth 0.05)
        (closed_form.piston, 2, [16.78, 25.40]),
        (closed_form.piston, 4, [0.1182, 0.4098]),
        (closed_form.piston, 6, [0.0009, 0.0074]),
        (closed_form.rod, 3, [1.055, 2.410]),
        (closed_form.rod, 5, [0.0093, 0.0485]),
    ],
)
def test_orders_relative_to_the_first(coefficients, n, percent):
    first, found = coefficients([1, n], np.array([1 / 6, 1 / 4]))
    assert 100 * abs(found / first) == pytest.approx(percent, abs=5e-3 if n == 2 else 6e-4 if n == 3 else 6e-5)


def test_wrong_coefficients_of_the_series():
    """(16) prints 5/128 and -3/10, (23) prints 25/1025."""
    wrong = {(e.printed, e.exact) for e in recompute("series").errata}
    assert wrong == {("5/128", "15/128"), ("-3/10", "-3/16"), ("25/1025", "25/1024")}


def radial_orders(cylinders, highest=20):
    """Orders n that a radial of equal cylinders on one crank leaves: sum of e^{i(1 -+ n) g} over the axes g. With an
    odd number i, n = m i -+ 1 for odd m (print: i, 3i, 5i); with an even one, none above the first.
    """
    axes = np.arange(cylinders) * 360 / cylinders
    return [
        n
        for n in [1, *range(2, highest, 2)]
        if max(abs(unit((1 - n) * axes).sum()), abs(unit((1 + n) * axes).sum())) > 1e-9
    ]


def test_statements_by_sums_of_unit_vectors():
    """Stars, rows and the vee of four: a force of order n is the sum of e^{i n psi} over the throws, a moment
    M_z that of the odd orders.
    """
    table = recompute("kvasnikov-statements")
    found = {row[1:3]: row[-1] for row in table.exact}
    assert found["star of 5", "lowest order of force above 1"] == radial_orders(5)[1]
    assert found["star of 5", "next order of force"] == radial_orders(5)[2]
    assert found["star of 6", "lowest order of force above 1"] == 0 == len(radial_orders(6)) - 1
    rows = {"row of 3": [0, 120, 240], "row of 4": [0, 90, 180, 270], "row of 5": np.arange(0, 360, 72)}
    rows |= {f"row of {i}, four-stroke": [*np.arange(0, 360, 720 / i)] * 2 for i in (4, 6, 8)}
    for name, throws in rows.items():
        left = [n for n in range(1, 20) if abs(unit(n * np.array(throws)).sum()) > 1e-9]
        assert found[name, "lowest order of force"] == min(n for n in left if n % 2 == 0)
        if (name, "lowest order of moment M_z") in found:
            assert found[name, "lowest order of moment M_z"] == min((n for n in left if n % 2), default=0)
    theta = np.arange(360.0)
    pins = np.array([0, 0, 180, 180])
    axes = np.array([-45, 45, -45, 45])
    along_y = (np.sin(np.radians(axes)) * np.cos(np.radians(2 * (theta[:, None] + pins - axes)))).sum(axis=1)
    assert found["vee of 4, gamma = 45 deg", "force of order 2 along y"] == pytest.approx(along_y.max(), rel=1e-12)
    assert {e.category for e in table.errata} == {"rounding", "error"}


@pytest.mark.parametrize(
    ("name", "sizes"),
    [  # (81): half the reciprocating masses turn with the crank; i = 5 keeps orders 4 and 6, each i/2, i = 7 only 6
        ("radial5", {"F1_major": 5 / 2, "F1_minor": 5 / 2, "F2_major": 0, "F4_major": 5 / 2, "F6_major": 5 / 2}),
        ("radial7", {"F4_major": 0, "F6_major": 7 / 2}),
        # (84), (85): with even crank spacing the lowest order is i (i even) or 2 i (i odd); fours, sixes repeat cranks
        ("i3", {"F2_major": 0, "F6_major": 3, "M1_major": sqrt(3)}),
        ("i6", {"F4_major": 0, "F6_major": 6}),
        ("v8_crossplane", {"M1_major": sqrt(10), "M1_minor": sqrt(10)}),
    ],
)
def test_layouts(name, sizes):
    table = recompute("layouts")
    found = next(dict(zip(table.columns, row, strict=True)) for row in table.exact if row[0] == name)
    assert {key: found[key] for key in sizes} == pytest.approx(sizes, rel=1e-14, abs=1e-14)

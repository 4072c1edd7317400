"""Liu Xianzhi: Two-shaft balance of the second-order inertia force of flat-plane V8 engines (in Chinese), 1979.

K = 4 lambda m r omega^2, gamma the bank angle, alpha the crank angle; forces of the sliders
Z_x = (cos 3g/2 - cos g/2) sin 2a, Z_y = (cos 3g/2 + cos g/2) cos 2a for K = 1.
"""

from math import atan, cos, degrees, pi, radians, sqrt

import numpy as np
import pytest
from support.engines import build_text

from balcli.books.answer import tables as recompute
from balcli.forces.spectrum import compute_spectra

GAMMA = np.radians(np.arange(0.0, 180.0, 0.01))


def z_x(gamma):
    return np.cos(1.5 * gamma) - np.cos(gamma / 2)


def z_y(gamma):
    return np.cos(1.5 * gamma) + np.cos(gamma / 2)


def flat_plane(gamma):
    return build_text(
        "crank = { stroke = 80, throws = [0, 180, 180, 0], spacing = 100 }\nrod.ratio = 0.28\npiston.mass = 0.5\n"
        f"layout.bank_angle = {gamma}\noperation.speed = 6000\n"
    )


def vectors(gamma):
    """|V+| and |V-| of the second order over 4 m r omega^2 A_2 = K, from the engine itself."""
    from balcli.core.mechanisms.closed_form import piston

    engine = flat_plane(gamma)
    force = compute_spectra(engine, [2], ["force"]).force
    k = 4 * 0.5 * 0.04 * engine.omega**2 * float(piston([2], 0.28)[0])
    return abs(force.forward[0]) / k, abs(force.backward[0]) / k


@pytest.mark.parametrize("gamma", [0, 30, 60, 90, 120, 150, 180])
def test_the_second_order_is_two_vectors(gamma):
    """(1.5): cos(gamma/2) turning with the crank, cos(3 gamma/2) against it: at 60 degrees sqrt3/2 and none (3.1)."""
    expected = abs(cos(radians(gamma / 2))), abs(cos(radians(1.5 * gamma)))
    assert vectors(gamma) == pytest.approx(expected, abs=1e-14)


def test_largest_slider_force_across():
    """6.1: 8/(3 sqrt3) at gamma = 2 arctan sqrt2 = 109.4712 degrees."""
    where = GAMMA[np.abs(z_x(GAMMA)).argmax()]
    assert degrees(where) == pytest.approx(degrees(2 * atan(sqrt(2))), abs=0.01)
    assert round(degrees(2 * atan(sqrt(2))), 4) == 109.4712
    assert z_x(2 * atan(sqrt(2))) == pytest.approx(-8 / (3 * sqrt(3)), rel=1e-14)


def test_relative_extreme_of_the_slider_force_along():
    """6.2: -4/(3 sqrt6) = -0.544 at gamma = 2 arctan sqrt5 = 131.8103 degrees; the largest is 2, at gamma = 0."""
    assert round(degrees(2 * atan(sqrt(5))), 4) == 131.8103
    assert z_y(2 * atan(sqrt(5))) == pytest.approx(-4 / (3 * sqrt(6)), rel=1e-14)
    assert z_y(GAMMA).min() == pytest.approx(-4 / (3 * sqrt(6)), rel=1e-7)
    assert np.abs(z_y(GAMMA)).max() == z_y(0.0) == 2


def test_paths_of_the_two_shafts():
    """Section 4: from gamma = 0 to 180 degrees one travels 3b, the other b; they meet at 90 and 180 degrees."""
    travelled = np.abs(np.diff(np.cos(1.5 * np.linspace(0, pi, 30001)))).sum()
    assert travelled == pytest.approx(3, rel=1e-7)
    table = recompute("liu-1")
    one, other = table.exact[0], table.exact[1]
    assert [
        one[table.columns.index(g)] == pytest.approx(other[table.columns.index(g)], abs=1e-14) for g in ("90", "180")
    ] == [True, True]
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

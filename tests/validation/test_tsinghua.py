"""Lu Jiqing, Meng Sizong: Automobile Engine Design, vol. 1 (in Chinese), Tsinghua University Press, 1990, sec. 1.1.1.

Statements of the text in figures, each test named after what is stated; the tables themselves are
in the package.
"""

from math import degrees, pi, radians

import numpy as np
import pytest
from support import two_term
from support.two_term import PSI, largest_error

from balcli.books.answer import tables as recompute
from balcli.core.mechanisms import slidercrank as sc

LAM = 0.32  # the largest ratio of the tables


def relative(form):
    """Error of a two-term form relative to the exact value, and where it is largest (degrees)."""
    error = np.abs(two_term.errors(form, LAM) / getattr(sc, form.__name__)(PSI, LAM))
    return error.max(), degrees(PSI[error.argmax()])


def test_displacement_error_is_at_most_0_0043_r():
    assert round(largest_error(two_term.displacement, LAM), 4) == 0.0043


def test_displacement_error_at_90_degrees_is_0_37_percent_but_the_largest_is_0_42_at_73_6():
    """The book takes the error at 90 degrees for the largest."""
    at_90 = 1 - float(two_term.displacement(pi / 2, LAM) / sc.displacement(pi / 2, LAM))
    assert round(100 * at_90, 2) == 0.37
    largest, where = relative(two_term.displacement)
    assert round(100 * largest, 4) == 0.4194
    assert where == pytest.approx(73.56, abs=0.02)


def test_velocity_error_is_at_most_0_0057_r_omega_and_0_83_percent():
    assert round(largest_error(two_term.velocity, LAM), 4) == 0.0057
    largest, where = relative(two_term.velocity)
    assert 0.0082 < largest < 0.0083
    assert where == pytest.approx(127.55, abs=0.02)


def test_acceleration_error_is_0_0178_r_omega2_at_90_degrees_which_is_5_3_percent():
    error = largest_error(two_term.acceleration, LAM)
    assert round(error, 4) == 0.0178
    at_90 = two_term.acceleration(pi / 2, LAM) - sc.acceleration(pi / 2, LAM)
    assert error == pytest.approx(float(at_90), rel=1e-12)
    assert round(100 * error / abs(float(sc.acceleration(pi / 2, LAM))), 1) == 5.3


def test_errors_are_smaller_for_smaller_lambda():
    for form in (two_term.displacement, two_term.velocity, two_term.acceleration):
        assert (np.diff([largest_error(form, lam) for lam in np.linspace(0.01, LAM, 50)]) > 0).all()


def test_linear_interpolation_between_the_columns_of_table_1_2():
    """Half-way between two columns the error is largest: less than 4e-6."""
    lam = np.arange(0.24, 0.32, 0.01)
    between = (sc.displacement(PSI[:, None], lam) + sc.displacement(PSI[:, None], lam + 0.01)) / 2
    assert np.abs(between - sc.displacement(PSI[:, None], lam + 0.005)).max() < 4e-6


def test_the_true_fastest_point_comes_0_29_to_0_52_degrees_earlier():
    lam = np.array([1 / 4, 1 / 3])
    earlier = np.degrees(sc.fastest_two_term(lam)[0] - sc.fastest(lam)[0])
    assert earlier.round(2).tolist() == [0.29, 0.52]


def test_at_the_fastest_point_crank_and_rod_stand_nearly_at_right_angles():
    """90.80 degrees at 1/4 to 91.78 at 1/3."""
    lam = np.array([1 / 4, 1 / 3])
    psi, _ = sc.fastest(lam)
    both = np.degrees(psi + np.arctan2(*sc.rod_angle(psi, lam)))
    assert both.round(2).tolist() == [90.80, 91.78]


@pytest.mark.parametrize(("lam", "dips"), [(0.2637, False), (0.2639, True)])
def test_the_exact_acceleration_dips_below_its_value_at_180_degrees_above_lambda_0_263763(lam, dips):
    """Its curvature at 180 degrees changes sign where 4 lambda - 3 lambda^3 = 1."""
    assert (4 * lam - 3 * lam**3 > 1) is dips
    near = sc.acceleration(np.radians(np.arange(170, 180, 0.1)), lam)
    assert bool((near < -(1 - lam)).any()) is dips


def test_the_acceleration_dip_at_lambda_0_32():
    """-0.70089 at 141.329 degrees; the two-term form has -0.71063 at 141.375."""
    psi = np.radians(np.arange(140, 143, 0.001))
    a = sc.acceleration(psi, LAM)
    assert round(float(a.min()), 5) == -0.70089
    assert degrees(psi[a.argmin()]) == pytest.approx(141.329, abs=1e-3)


def test_table_1_4_follows_the_two_term_formula():
    """36 of its 42 figures; the exact extremes stand beside."""
    table = recompute("tsinghua-1-4")
    assert len(table.errata) == 6
    exact = [row[table.columns.index("exact 1/3")] for row in table.exact]
    assert exact[0] == pytest.approx(73.1752966362, abs=1e-9)
    assert exact[5] == pytest.approx(1.05463954654, abs=1e-10)
    assert radians(exact[0]) == pytest.approx(float(sc.fastest(1 / 3)[0]), rel=1e-14)

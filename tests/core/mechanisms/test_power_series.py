"""The generated series: against the closed forms they expand, and in coefficients that are easily found by hand."""

from fractions import Fraction
from itertools import product
from math import asin, comb, cos, radians, sin

import pytest

from balcli.core.mechanisms import power_series as series, slidercrank as sc

LAM = Fraction(1, 4)
POWER = 24  # lambda^26 = 2e-16: the remainder is below the rounding error
PSI = [0.0, 20.0, 73.0, 90.0, 131.0, 180.0, 250.0]


@pytest.mark.parametrize(
    ("generate", "wave", "closed"),
    [
        (series.displacement, cos, sc.displacement),
        (series.velocity, sin, sc.velocity),
        (series.piston, cos, sc.acceleration),
        (series.cos_beta, cos, lambda psi, lam: sc.rod_angle(psi, lam)[1]),
        (series.rod, sin, lambda psi, lam: sc.SliderCrank(psi, lam).spin_rate),
        (series.beta, sin, lambda psi, lam: asin(lam * sin(psi))),
    ],
)
def test_orders_add_up_to_the_closed_form(generate, wave, closed):
    sums = {n: float(sum(c * LAM**p for p, c in generate(n, POWER).items())) for n in range(POWER + 2)}
    for psi in map(radians, PSI):
        found = sum(value * wave(n * psi) for n, value in sums.items())
        assert found == pytest.approx(float(closed(psi, 0.25)), abs=1e-12), psi


def test_leading_terms():
    """The leading term of A_2m is (2m)^2 (-1)^(m+1) binom(2m, m) / ((2m - 1) 2^(4m - 1)) lambda^(2m - 1)."""
    for m in range(1, 9):
        power = 2 * m - 1
        expected = Fraction((-1) ** (m + 1) * (2 * m) ** 2 * comb(2 * m, m), (2 * m - 1) * 2 ** (4 * m - 1))
        assert series.piston(2 * m, power) == {power: expected}


def test_to_any_power_and_without_zeros():
    assert max(series.piston(2, 60)) == 59
    assert series.piston(3, 20) == {}
    assert series.piston(1, 20) == {0: 1}
    assert series.piston(0, 20) == {}
    assert series.displacement(0, 3) == {0: 1, 1: Fraction(1, 4), 3: Fraction(3, 64)}
    assert series.from_shaft(0, 1) == {-1: 1, 1: Fraction(-1, 4)}


@pytest.mark.parametrize(
    "generate", [series.piston, series.rod, series.velocity, series.displacement, series.cos_beta, series.beta]
)
def test_no_power_beyond_the_one_asked_for(generate):
    """And all up to it: one more power adds that power alone."""
    for power, order in product(range(1, 9), range(8)):
        terms = generate(order, power)
        more = generate(order, power + 1)
        assert all(p <= power for p in terms), (power, order)
        assert terms == {p: c for p, c in more.items() if p <= power}, (power, order)

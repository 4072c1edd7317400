"""Vanishing sums of roots of unity: the exact decision against polynomial division and against
floating point.
"""

from __future__ import annotations

import math
import random
from fractions import Fraction

import numpy as np
import pytest

from balcli.core.roots_of_unity import even, rational, turns, vanishes


def cyclotomic(n: int) -> list[int]:
    """Coefficients of the n-th cyclotomic polynomial, lowest first: x^n - 1 divided by those of all
    proper divisors.
    """
    poly = [-1] + [0] * (n - 1) + [1]
    for d in range(1, n):
        if n % d == 0:
            poly = divided(poly, cyclotomic(d))[0]
    return poly


def divided(poly: list, by: list[int]) -> tuple[list, list]:
    """Quotient and remainder by a monic polynomial."""
    rest, quotient = list(poly), []
    while len(rest) >= len(by):
        factor = rest[-1]
        quotient.append(factor)
        for k, c in enumerate(by):
            rest[len(rest) - len(by) + k] -= factor * c
        rest.pop()
    return quotient[::-1], rest


def divisible(weights, angles) -> bool:
    n = math.lcm(*(x.denominator for x in angles))
    poly = [0] * n
    for w, x in zip(weights, angles, strict=True):
        poly[int(x * n) % n] += w
    return not any(divided(poly, cyclotomic(n))[1])


def polygons(rng: random.Random, divisors: list[int]) -> tuple[list[int], list[Fraction]]:
    """Regular polygons, turned and weighted at random, all of them vanishing sums; sometimes spoilt
    in one place.
    """
    weights, angles = [], []
    for _ in range(rng.randint(1, 3)):
        corners, weight, start = (rng.choice(divisors), rng.choice([-2, -1, 1, 2]), Fraction(rng.randrange(120), 120))
        weights += [weight] * corners
        angles += [start + Fraction(k, corners) for k in range(corners)]
    if rng.random() < 0.5:
        k = rng.randrange(len(angles))
        angles[k] += Fraction(rng.randrange(1, 60), 60)
    return weights, angles


@pytest.mark.stress
def test_against_division_by_the_cyclotomic_polynomial():
    rng = random.Random(1)
    outcomes = set()
    for _ in range(300):
        weights, angles = polygons(rng, [2, 3, 5, 6])
        found = vanishes(weights, angles)
        assert found == divisible(weights, angles), (weights, angles)
        outcomes.add(found)
    assert outcomes == {True, False}


@pytest.mark.stress
def test_ten_thousand_layouts_against_floating_point():
    """Sums of so few and small terms, if they do not vanish, are far from 0."""
    rng = random.Random(2)
    balanced = 0
    for trial in range(10_000):
        if trial % 2:
            weights, angles = polygons(rng, [2, 3, 4, 5, 6, 7, 8, 9, 12])
        else:
            q, count = rng.choice([4, 6, 8, 12, 14, 15, 18, 20, 24, 36]), rng.randint(2, 8)
            weights = [rng.choice([-3, -1, 1, 1, 1, 3]) for _ in range(count)]
            angles = [Fraction(rng.randrange(q), q) for _ in range(count)]
        size = abs(np.dot(weights, np.exp(2j * np.pi * np.array(angles, float))))
        assert vanishes(weights, angles) == (size < 1e-9), (weights, angles, size)
        balanced += size < 1e-9
    assert 2_000 < balanced < 8_000


@pytest.mark.parametrize("k", [40, 60, 200])
def test_what_floating_point_cannot_settle(k):
    """`F_k psi + F_(k-1) = psi^k`, psi = (1 - sqrt 5)/2 = -2 cos 72 deg: far below the rounding
    error of its terms, but not 0.
    """
    fibonacci = [0, 1]
    while len(fibonacci) <= k:
        fibonacci.append(fibonacci[-1] + fibonacci[-2])
    weights, angles = ([-fibonacci[k], -fibonacci[k], fibonacci[k - 1]], [Fraction(1, 5), Fraction(4, 5), Fraction(0)])
    numeric = abs(np.dot(np.array(weights, float), np.exp(2j * np.pi * np.array(angles, float))))
    assert numeric < 1e-15 * fibonacci[k] * 4
    assert not vanishes(weights, angles)
    # exactly 0 with as large terms: the same, but F_k more at all five corners
    corners = [Fraction(j, 5) for j in range(5)]
    assert vanishes([fibonacci[k]] * 5, corners)
    assert not vanishes([fibonacci[k] + 1, *[fibonacci[k]] * 4], corners)


def test_denominators_whose_common_multiple_is_in_the_millions():
    primes = [Fraction(1, 5039), Fraction(1, 5021)]
    weights, angles = (
        [1, -1] * 2,
        [primes[0], primes[0] + Fraction(1, 5021), primes[1], primes[1] + Fraction(1, 5039)],
    )
    assert not vanishes(weights, angles)
    assert vanishes(
        [1] * 7 + [-1] * 7,
        [primes[0] + primes[1] + Fraction(k, 7) for k in range(7)] + [Fraction(k, 7) for k in range(7)],
    )


@pytest.mark.parametrize(
    ("degrees", "fraction"),
    [
        (0.0, Fraction(0)),
        (90, Fraction(1, 4)),
        (-120, Fraction(2, 3)),
        (360 / 7 * 3, Fraction(3, 7)),
        (22.5, Fraction(1, 16)),
        (360 * 0.1, Fraction(1, 10)),
        (360 / 5040, Fraction(1, 5040)),
        (51.4285714, None),
        (120 + 1e-11, None),
        (21.9, Fraction(73, 1200)),
        (360 / 7 - 360, Fraction(1, 7)),
        (math.degrees(1.0), None),
    ],
)
def test_angles_that_are_fractions_of_a_turn(degrees, fraction):
    assert turns(degrees) == fraction


def test_even_instants():
    third = Fraction(1, 3)
    assert even([Fraction(1, 2), Fraction(1, 2) + third, Fraction(1, 2) - third], Fraction(1))
    assert not even([Fraction(0), third, Fraction(1, 2)], Fraction(1))
    assert even([Fraction(0), Fraction(1)], Fraction(2))


def test_no_denominator_above_5040_and_no_more_than_two_ulp_of_a_turn():
    ulp = math.ulp(360.0)
    assert turns(360 / 5041) is None
    assert turns(120 + 1.75 * ulp) == Fraction(1, 3)
    assert turns(120 + 2.5 * ulp) is None
    assert rational(0.5, 2, 0.0) == Fraction(1, 2)  # exact is near enough


def test_a_weight_without_an_angle_is_no_sum():
    with pytest.raises(ValueError, match="argument 2 is shorter"):
        vanishes([1, -1], [Fraction(0)])


def test_even_intervals_may_begin_anywhere():
    """Instants in any order, before the cycle or beyond it."""
    cycle = Fraction(720)
    assert even([Fraction(100), Fraction(-140), Fraction(340 + 720)], cycle)
    assert not even([Fraction(100), Fraction(-140), Fraction(341)], cycle)
    assert even([Fraction(7)], cycle)

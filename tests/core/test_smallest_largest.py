"""Smallest largest residual: proved by equioscillation and linear duality; least squares within
limits by the conditions of the optimum.
"""

from functools import cache

import numpy as np
import pytest

from balcli.core.least_squares import Region, minimise, solve
from balcli.field_balancing.places import find_region


def problem(seed: int, readings: int, unknowns: int):
    rng = np.random.default_rng(seed)
    parts = rng.normal(size=(2, readings, unknowns + 1))
    whole = parts[0] + 1j * parts[1]
    return whole[:, :-1], whole[:, -1], rng.uniform(0.5, 2.0, readings)


@cache
def find_free(*case):
    """The smallest largest residual of a problem without limits."""
    return minimise(*problem(*case), largest=True)


def largest_of(found, weights) -> float:
    return float((weights * np.abs(found.residual)).max())


CASES = [(1, 4, 1), (2, 3, 2), (3, 8, 2), (4, 12, 3), (5, 24, 4), (6, 24, 6), (7, 7, 6)]
LONGEST = (6, 24, 6)


def dual_multipliers(matrix, residual):
    """Non-negative, of sum 1, for which the directions of the largest residuals cancel in every
    column: by active sets (Lawson and Hanson), in real numbers.
    """
    direction = np.conj(residual / np.abs(residual))
    rows = (direction[:, None] * matrix).T
    system = np.concatenate([rows.real, rows.imag, np.ones((1, len(residual)))])
    wanted = np.append(np.zeros(len(system) - 1), 1.0)
    active = np.abs(residual) > (1 - 1e-7) * np.abs(residual).max()
    multipliers = np.zeros(len(residual))
    multipliers[active] = np.linalg.lstsq(system[:, active], wanted, rcond=None)[0]
    return multipliers, system @ multipliers - wanted


@pytest.mark.parametrize("case", CASES)
def test_it_is_proved_by_linear_programming(case):
    """For any x, max |r| >= sum l Re(conj(d) r), which does not depend on x where the weighted
    directions d cancel in every column: the dual of the linear program of all directions.
    """
    matrix, target, weights = problem(*case)
    found = find_free(*case)
    residual = weights * (target - matrix @ found.x)
    multipliers, miss = dual_multipliers(weights[:, None] * matrix, residual)
    assert np.abs(miss).max() < 1e-6
    assert multipliers.min() > -1e-6
    bound = multipliers @ (np.conj(residual / np.abs(residual)) * weights * target).real
    assert largest_of(found, weights) == pytest.approx(bound, rel=1e-7)
    assert found.bound == pytest.approx(largest_of(found, weights), rel=2e-8)


def test_what_can_be_cancelled_is_cancelled():
    matrix, _, weights = problem(8, 6, 3)
    planted = np.array([1 + 2j, -3j, 0.5])
    found = minimise(matrix, matrix @ planted, weights, largest=True)
    assert found.x == pytest.approx(planted, rel=1e-12)
    assert found.bound == 0


@pytest.mark.parametrize(
    "case", [pytest.param(c, marks=[pytest.mark.slow] * (c == LONGEST)) for c in CASES if c[2] > 1]
)
def test_limits_of_the_largest(case):
    """The bound holds within the limits: no random point inside is better, and it is reached."""
    matrix, target, weights = problem(*case)
    free = find_free(*case)
    most = 0.5 * abs(free.x[0])
    disc = Region(0j, most)
    found = minimise(matrix, target, weights, [disc, *[Region()] * (matrix.shape[1] - 1)], largest=True)
    assert abs(found.x[0]) <= most * (1 + 1e-12)
    assert abs(disc.find_depth(found.x[0])) < 1e-7 * most
    assert largest_of(found, weights) > largest_of(free, weights)
    assert found.bound == pytest.approx(largest_of(found, weights), rel=1e-5)


@pytest.mark.parametrize("case", [c for c in CASES if c[1] > c[2]])
def test_least_squares_within_limits_meets_the_conditions_of_the_optimum(case):
    """With a price p >= 0 on a limited unknown: column^H residual = p x, 0 for the others."""
    matrix, target, weights = problem(*case)
    most = 0.6 * abs(solve(matrix, target, weights).x[0])
    regions = [Region(0j, most), *[Region()] * (matrix.shape[1] - 1)]
    found = minimise(matrix, target, weights, regions)
    pull = matrix.conj().T @ (weights**2 * found.residual)
    price = pull[0] / found.x[0]
    size = np.abs(matrix.T) @ (weights**2 * np.abs(target))
    assert abs(found.x[0]) == pytest.approx(most, rel=1e-10)
    assert price.real > 0
    assert abs(price.imag) < 1e-9 * price.real
    assert np.all(np.abs(pull[1:]) < 1e-9 * size[1:])


# ------------------------------------------------------------------ regions with corners
def reach(generators, most, direction):
    """How far rays from 0 to `most`, added up, go in a direction."""
    return most * np.maximum((np.conj(direction) * generators).real, 0).sum()


def regions_of(rng, sizes):
    """Of two to five places each: polygons; one is a line, one a disc."""
    angles = [rng.uniform(0, 360, count) for count in rng.integers(2, 6, len(sizes))]
    angles[0] = np.array([20.0, 200.0])
    most = rng.uniform(0.1, 0.6) * sizes
    places = [find_region(a, m) for a, m in zip(angles, most, strict=True)]
    return [np.exp(1j * np.radians(a)) for a in angles], most, places


@pytest.mark.parametrize("case", [c for c in CASES if c[2] > 1])
def test_least_squares_in_polygons(case):
    """The optimum of a convex function: no point of any region is farther along its pull."""
    matrix, target, weights = problem(*case)
    free = np.abs(solve(matrix, target, weights).x)
    generators, most, regions = regions_of(np.random.default_rng(case[0]), free)
    found = minimise(matrix, target, weights, regions)
    pull = matrix.conj().T @ (weights**2 * found.residual)
    assert found.residual == pytest.approx(target - matrix @ found.x)
    for k, (region, x) in enumerate(zip(regions, found.x, strict=True)):
        assert abs(region.project(x)[0] - x) < 1e-10 * most[k]
        best = reach(generators[k], most[k], pull[k])
        size = np.abs(matrix[:, k]) @ (weights**2 * np.abs(target)) * most[k]
        assert (np.conj(pull[k]) * x).real == pytest.approx(best, abs=1e-7 * size)
    assert any(abs(r.find_depth(x)) < 1e-6 * m for r, x, m in zip(regions, found.x, most, strict=True))


@pytest.mark.parametrize("case", [c for c in CASES if c[2] > 1])
def test_largest_in_polygons(case):
    """The bound is reached within the regions, and no random point of them is better."""
    matrix, target, weights = problem(*case)
    rng = np.random.default_rng(case[0])
    generators, most, regions = regions_of(rng, np.abs(solve(matrix, target, weights).x))
    found = minimise(matrix, target, weights, regions, largest=True)
    assert all(abs(r.project(x)[0] - x) < 1e-9 * m for r, x, m in zip(regions, found.x, most, strict=True))
    assert found.bound == pytest.approx(largest_of(found, weights), rel=1e-6)
    assert found.bound <= largest_of(found, weights) * (1 + 1e-12)
    for _ in range(200):
        amounts = [m * rng.uniform(0, 1, len(g)) for g, m in zip(generators, most, strict=True)]
        x = np.array([a @ g for a, g in zip(amounts, generators, strict=True)])
        near = found.x + rng.uniform(0, 1) ** 4 * (x - found.x)
        assert (weights * np.abs(target - matrix @ near)).max() >= found.bound * (1 - 1e-12)


def test_one_unknown_in_a_wedge():
    """By hand: -1 is nearest to 0 among all weights at 0 and 60 deg, 1j to its edge at 60 deg."""
    wedge = [find_region(np.array([0.0, 60]), np.inf)]
    one = np.ones(1)
    matrix = np.ones((1, 1), dtype=complex)
    edge = np.cos(np.pi / 6) * np.exp(1j * np.pi / 3)
    for largest in (False, True):
        for target, nearest in ((-1, 0), (1j, edge)):
            found = minimise(matrix, np.array([target + 0j]), one, wedge, largest=largest)
            assert found.x == pytest.approx(nearest, abs=1e-9)

"""Smallest largest residual: proved by equioscillation and linear duality; least squares within
limits by the conditions of the optimum.
"""

from __future__ import annotations

import numpy as np
import pytest

from balcli.core.least_squares import solve
from balcli.core.smallest_largest import find_limited, minimise_largest, minimise_squares_within

RELATIVE = 1e-9


def problem(seed: int, readings: int, unknowns: int):
    rng = np.random.default_rng(seed)
    parts = rng.normal(size=(2, readings, unknowns + 1))
    whole = parts[0] + 1j * parts[1]
    return whole[:, :-1], whole[:, -1], rng.uniform(0.5, 2.0, readings)


CASES = [(1, 4, 1), (2, 3, 2), (3, 8, 2), (4, 12, 3), (5, 24, 4), (6, 24, 6), (7, 7, 6)]


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
    found = minimise_largest(matrix, target, weights)
    residual = weights * (target - matrix @ found.x)
    multipliers, miss = dual_multipliers(weights[:, None] * matrix, residual)
    assert np.abs(miss).max() < 1e-9
    assert multipliers.min() > -1e-9
    bound = multipliers @ (np.conj(residual / np.abs(residual)) * weights * target).real
    assert found.largest == pytest.approx(bound, rel=RELATIVE)
    assert found.bound == pytest.approx(found.largest, rel=1e-12)


@pytest.mark.parametrize("case", CASES)
def test_largest_residuals_are_equal_and_no_step_makes_them_smaller(case):
    """Equioscillation."""
    matrix, target, weights = problem(*case)
    found = minimise_largest(matrix, target, weights)
    sizes = weights * np.abs(found.residual)
    assert np.sum(sizes > (1 - RELATIVE) * sizes.max()) >= 2
    rng = np.random.default_rng(0)
    for _ in range(200):
        step = rng.normal(size=(2, matrix.shape[1])) * 10.0 ** rng.uniform(-6, 0)
        moved = target - matrix @ (found.x + step[0] + 1j * step[1])
        assert (weights * np.abs(moved)).max() > found.largest * (1 - 1e-12)


def test_a_textbook_case():
    """3x - 2y = -1, 5x - 2y = 1, 5x - 3y = 0 in real numbers: all three residuals 0.4 at (1, 1.8)."""
    matrix = np.array([[3, -2], [5, -2], [5, -3]], dtype=complex)
    found = minimise_largest(matrix, np.array([-1, 1, 0], dtype=complex), np.ones(3))
    assert found.x == pytest.approx([1.0, 1.8], abs=1e-9)
    assert np.abs(found.residual) == pytest.approx([0.4] * 3, rel=1e-12)


def test_what_can_be_cancelled_is_cancelled():
    matrix, _, weights = problem(8, 6, 3)
    planted = np.array([1 + 2j, -3j, 0.5])
    found = minimise_largest(matrix, matrix @ planted, weights)
    assert found.x == pytest.approx(planted, rel=1e-12)
    assert found.bound == 0


@pytest.mark.parametrize("case", [c for c in CASES if c[2] > 1])
def test_limits_of_the_largest(case):
    """The bound holds within the limits: no random point inside is better, and it is reached."""
    matrix, target, weights = problem(*case)
    free = minimise_largest(matrix, target, weights)
    most = np.full(matrix.shape[1], np.inf)
    most[0] = 0.5 * abs(free.x[0])
    found = minimise_largest(matrix, target, weights, most)
    assert abs(found.x[0]) <= most[0] * (1 + 1e-12)
    assert find_limited(found.x, most) == [0]
    assert found.largest > free.largest
    assert found.bound == pytest.approx(found.largest, rel=1e-11)


@pytest.mark.parametrize("case", [c for c in CASES if c[1] > c[2]])
def test_least_squares_within_limits_meets_the_conditions_of_the_optimum(case):
    """With a price p >= 0 on a limited unknown: column^H residual = p x, 0 for the others."""
    matrix, target, weights = problem(*case)
    most = 0.6 * np.abs(solve(matrix, target, weights).x)
    most[1:] = np.inf
    found = minimise_squares_within(matrix, target, weights, most)
    pull = matrix.conj().T @ (weights**2 * found.residual)
    price = pull[0] / found.x[0]
    size = np.abs(matrix.T) @ (weights**2 * np.abs(target))
    assert abs(found.x[0]) == pytest.approx(most[0], rel=1e-10)
    assert price.real > 0
    assert abs(price.imag) < 1e-9 * price.real
    assert np.all(np.abs(pull[1:]) < 1e-9 * size[1:])


def test_limits_that_do_not_bind_change_nothing():
    matrix, target, weights = problem(9, 8, 2)
    free = solve(matrix, target, weights).x
    found = minimise_squares_within(matrix, target, weights, 1.01 * np.abs(free))
    assert found.x == pytest.approx(free, rel=1e-13)

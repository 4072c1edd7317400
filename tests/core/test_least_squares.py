"""Least squares against the same sums in fifty digits."""

import mpmath
import numpy as np
import pytest

from balcli.core.least_squares import find_dependent_columns, solve

EPS = 2.0**-52


def random(seed: int, *shape: int) -> np.ndarray:
    numbers = np.random.default_rng(seed)
    return numbers.normal(size=shape) + 1j * numbers.normal(size=shape)


def exact(matrix, target, weights=None) -> np.ndarray:
    """The least squares in fifty digits: by the normal equations of a matrix of full rank."""
    with mpmath.workdps(50):
        scale = mpmath.diag([mpmath.mpf(w) for w in (np.ones(len(target)) if weights is None else weights)])
        a = scale * mpmath.matrix(matrix.tolist())
        b = scale * mpmath.matrix(target.tolist())
        x = mpmath.lu_solve(a.H * a, a.H * b)
        return np.array([complex(v) for v in x])


def residual_in_fifty_digits(matrix, x, target) -> np.ndarray:
    with mpmath.workdps(50):
        left = mpmath.matrix(target.tolist()) - mpmath.matrix(matrix.tolist()) * mpmath.matrix(x.tolist())
        return np.array([complex(v) for v in left])


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize(("readings", "unknowns"), [(1, 1), (3, 3), (4, 2), (12, 5)])
def test_complex_unknowns_as_in_fifty_digits(readings, unknowns, seed):
    matrix = random(seed, readings, unknowns)
    target = random(seed + 100, readings)
    found = solve(matrix, target)
    assert found.x == pytest.approx(exact(matrix, target), rel=1e-13 * found.condition, abs=0)
    left = residual_in_fifty_digits(matrix, found.x, target)
    assert found.residual == pytest.approx(left, abs=8 * EPS * np.linalg.norm(target))
    assert found.left == pytest.approx(np.linalg.norm(left) / np.linalg.norm(target), abs=1e-14)
    assert found.rank == unknowns


def test_weights_multiply_the_residuals():
    matrix = random(3, 5, 2)
    target = random(4, 5)
    weights = np.array([1e6, 1.0, 1e-6, 0.0, 2.0])
    found = solve(matrix, target, weights)
    assert found.x == pytest.approx(exact(matrix, target, weights), rel=1e-9)
    weighed = np.linalg.norm(weights * found.residual) / np.linalg.norm(weights * target)
    assert found.left == pytest.approx(weighed, rel=1e-12)
    read = weights > 0  # a weight of 0 is no reading
    assert solve(matrix[read], target[read], weights[read]).x == pytest.approx(found.x, rel=1e-9)


@pytest.mark.parametrize("condition", [1.0, 1e4, 1e8, 1e11])
@pytest.mark.parametrize("seed", range(2))
def test_what_can_be_cancelled_is_cancelled_to_rounding(condition, seed):
    """Without refinement, 1e-16 times the condition number would be left."""
    u, _, vh = np.linalg.svd(random(seed, 6, 6))
    matrix = (u * np.geomspace(1, 1 / condition, 6)) @ vh
    target = matrix @ random(seed + 50, 6)
    found = solve(matrix, target)
    left = residual_in_fifty_digits(matrix, found.x, target)
    assert np.linalg.norm(left) <= 20 * EPS * np.linalg.norm(found.x)
    assert found.condition == pytest.approx(condition, rel=1e-4)


def test_columns_of_very_different_size():
    """Kilograms beside micrograms."""
    sizes = np.array([1.0, 1e-6, 1e-9])
    matrix = random(5, 8, 3) * sizes
    x = np.array([1 + 2j, 3e6j, -1e9])
    found = solve(matrix, matrix @ x)
    assert found.x * sizes == pytest.approx(x * sizes, rel=1e-12)
    assert found.rank == 3


def test_of_many_solutions_the_smallest():
    """Two equal columns share what one would do alone, as in fifty digits."""
    columns = random(8, 6, 2)
    target = random(9, 6)
    matrix = columns[:, [0, 1, 0]]
    found = solve(matrix, target)
    two = exact(columns, target)
    assert found.x == pytest.approx([two[0] / 2, two[1], two[0] / 2], rel=1e-13)
    assert (found.rank, found.condition) == (2, np.inf)


def test_more_unknowns_than_readings():
    """The smallest x is `A* (A A*)^-1 b`."""
    matrix = random(10, 2, 5)
    target = random(11, 2)
    with mpmath.workdps(50):
        a = mpmath.matrix(matrix.tolist())
        b = mpmath.matrix(target.tolist())
        smallest = [complex(v) for v in a.H * mpmath.lu_solve(a * a.H, b)]
    found = solve(matrix, target)
    assert found.x == pytest.approx(smallest, rel=1e-12)
    assert found.left < 1e-15
    assert (found.rank, np.isfinite(found.condition)) == (2, True)


# ------------------------------------------------------------------ columns that depend on others
def test_columns_that_act_alike_are_named():
    columns = random(14, 8, 4)
    assert find_dependent_columns(columns) == []
    third = columns.copy()
    third[:, 2] = 1e-9 * (2j * columns[:, 0] - columns[:, 3])  # however small it is
    assert find_dependent_columns(third) == [0, 2, 3]


def test_a_column_of_zeros_is_determined_by_nothing():
    columns = random(15, 8, 3)
    columns[:, 1] = 0
    assert find_dependent_columns(columns) == [1]


@pytest.mark.parametrize(("apart", "dependent"), [(1e-6, []), (1e-14, [0, 1])])
def test_columns_that_differ_by_more_than_rounding_are_told_apart(apart, dependent):
    columns = random(17, 8, 2)
    columns[:, 1] = columns[:, 0] + apart * columns[:, 1]
    assert find_dependent_columns(columns) == dependent

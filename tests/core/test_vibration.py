"""Modes and response of small systems, against 50 digits, closed forms and direct solution."""

import numpy as np
import pytest
from support import high_precision

from balcli.core.vibration import (
    UndampedResonanceError,
    find_modes,
    find_resonances,
    modal_loss,
    solve_equations,
    solve_response,
)

RELATIVE = 1e-13


def random_system(seed, springs, dof, spread):
    """Springs, stiffness and diagonal mass over `spread` powers of ten either way."""
    rng = np.random.default_rng(seed)
    rows = np.eye(springs, dof) - np.eye(springs, dof, 1) * rng.uniform(0.5, 2, (springs, 1))
    return (rows, 10 ** rng.uniform(-spread, spread, springs), 10 ** rng.uniform(-spread, spread, dof))


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("spread", [0.5, 3, 6])
def test_frequencies_whatever_their_spread(seed, spread):
    springs, stiffness, mass = random_system(seed, 7, 7, spread)
    modes = find_modes(springs, stiffness, mass)
    exact = high_precision.angular_frequencies(springs, stiffness, mass)
    assert modes.omega == pytest.approx(exact, rel=RELATIVE, abs=0)
    assert modes.shapes @ (mass[:, None] * modes.shapes.T) == pytest.approx(np.eye(7), abs=1e-12)
    assert modes.rigid == 0


def test_a_full_mass_matrix():
    """Two ways to see one system: in coordinates x = T y the mass T^T m T is full."""
    springs, stiffness, mass = random_system(9, 5, 5, 1)
    turned = np.random.default_rng(1).normal(size=(5, 5))
    modes = find_modes(springs, stiffness, mass)
    same = find_modes(springs @ turned, stiffness, turned.T @ np.diag(mass) @ turned)
    assert same.omega == pytest.approx(modes.omega, rel=1e-12)
    assert np.abs(same.shapes @ turned.T) == pytest.approx(np.abs(modes.shapes), rel=1e-9)


def test_rigid_motions_have_exactly_0():
    springs = np.array([[1.0, -1, 0, 0], [0, 0, 1, -2]])
    rigid = np.array([[1.0, 1, 0, 0], [0, 0, 2, 1]])
    mass = np.array([1.0, 2, 3, 4])
    modes = find_modes(springs, np.array([5.0, 6]), mass, rigid)
    assert modes.omega[:2].tolist() == [0, 0]
    assert modes.rigid == 2
    expected = [np.sqrt(6 * (1 / 3 + 4 / 4)), np.sqrt(5 * (1 / 1 + 1 / 2))]
    assert modes.omega[2:] == pytest.approx(sorted(expected), rel=1e-15)
    assert modes.shapes @ np.diag(mass) @ modes.shapes.T == pytest.approx(np.eye(4), abs=1e-15)
    assert springs @ modes.shapes[:2].T == pytest.approx(np.zeros((2, 2)), abs=1e-15)


def damped_system(seed=4, dof=5):
    rng = np.random.default_rng(seed)
    springs, stiffness, mass = random_system(seed, dof, dof, 0.5)
    k = springs.T @ ((stiffness * (1 + 1j * rng.uniform(0.01, 0.1, dof)))[:, None] * springs)
    return k, 0.02 * springs.T @ springs, np.diag(mass)


def test_response_against_50_digits():
    k, c, m = damped_system()
    w = np.multiply.outer([0.5, 1, 2], [0.3, 1.1])
    rng = np.random.default_rng(2)
    load = rng.normal(size=(3, 2, 5)) + 1j * rng.normal(size=(3, 2, 5))
    motion = solve_response(k, c, m, w, load)
    for at in np.ndindex(3, 2):
        dynamic = k + 1j * w[at] * c - w[at] ** 2 * m
        exact = high_precision.solve(high_precision.to_matrix(dynamic), high_precision.to_matrix(load[at][:, None]))
        assert motion[at] == pytest.approx(exact, rel=1e-12)


def twins():
    """Two equal masses, each on a spring 3, with a spring 1 between: w^2 = 3 together and 5 against each other."""
    return np.array([[4.0, -1], [-1, 4]]), np.zeros((2, 2)), np.eye(2)


def test_an_undamped_resonance_is_an_error_with_its_frequency():
    with pytest.raises(UndampedResonanceError, match=r"^undamped resonance at 2\.23607 rad/s$") as at:
        solve_response(*twins(), np.array([1, np.sqrt(5)]), np.array([1, 0]))
    assert at.value.frequency == pytest.approx(np.sqrt(5))


def test_a_mode_that_is_not_driven_stays_at_rest():
    """Loads together at the frequency of the mode against each other: x = f/(3 - 5)."""
    motion = solve_response(*twins(), np.sqrt(5), np.array([1, 1]))
    assert motion == pytest.approx([-0.5, -0.5])


def test_one_undamped_mode_among_damped_ones():
    """A dashpot on the sum of both motions leaves the mode against each other undamped."""
    k, _, m = twins()
    c = np.ones((2, 2))
    exact = np.array([[4.0, -4], [-4, 4]])
    with pytest.raises(UndampedResonanceError):
        solve_response(exact, c, m, np.sqrt(8) * np.ones(1), np.array([1, 0]))
    assert solve_response(k, c, m, 2.0, np.array([1, 1])) == pytest.approx(np.full(2, 1 / (3 - 4 + 4j)), rel=1e-12)


def test_singular_equations_with_a_solution_have_their_least():
    matrix = np.array([[[1, 1], [1, 1]]], complex)
    here = np.array([7.0])
    for known in (True, False):
        assert solve_equations(matrix, np.array([[2, 2]]), here, np.array([known])) == pytest.approx(np.ones((1, 2)))
    with pytest.raises(UndampedResonanceError, match="at 7 rad/s"):
        solve_equations(matrix, np.array([[2, -2]]), here, np.array([False]))


def test_loss_of_a_mode():
    """Equal loss everywhere is the loss factor of every mode; dashpots give c w/k."""
    springs, stiffness, mass = random_system(2, 4, 4, 1)
    modes = find_modes(springs, stiffness, mass)
    k = springs.T @ (stiffness[:, None] * springs)
    none = np.zeros((4, 4))
    assert modal_loss(modes, k * (1 + 0.03j), none) == pytest.approx(np.full(4, 0.03))
    assert modal_loss(modes, k + 0j, 0.002 * k) == pytest.approx(0.002 * modes.omega)
    assert modal_loss(modes, k + 0j, none).tolist() == [0, 0, 0, 0]


TWIN_MODES = find_modes(np.array([[1.0, 0], [0, 1], [1, -1]]), np.array([3.0, 3, 1]), np.ones(2))


def test_undamped_resonances_in_a_range_of_speeds():
    """Both modes between the speeds 0.8 and 2, computed there or not."""
    found = find_resonances(TWIN_MODES, np.zeros(2), np.array([1.0, 2]), np.array([0.8, 0.9, 2]), np.array([1, 0]))
    assert [(r.mode, r.order) for r in found] == [(0, 1), (0, 2), (1, 2)]
    assert [r.speed for r in found] == pytest.approx([3**0.5, 3**0.5 / 2, 5**0.5 / 2])


def test_of_modes_that_are_damped_not_driven_or_elsewhere_there_are_none():

    def count(loss=(0, 0), order=1.0, speeds=(1.0, 2), load=(1, 0)):
        given = (np.array(loss), np.array([order]), np.array(speeds), np.array(load))
        return len(find_resonances(TWIN_MODES, *given))

    assert count() == 1
    assert count(loss=(1e-3, 0)) == count(load=(1, -1)) == count(speeds=(1.8, 2.2)) == count(order=0.0) == 0

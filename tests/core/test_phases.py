"""Sums of turning vectors against the same sums written out, cylinder by cylinder."""

import cmath
import math

import numpy as np
import pytest

from balcli.core.cylinders import Cylinders
from balcli.core.mechanisms.closed_form import Series
from balcli.core.phases import Phases, SeparatePhases

ORDERS = np.array([0.0, 1.0, 2.0, 5.0])
AXES = [-20.0, 70.0]
PINS = [0.0, 130.0, 250.0, 10.0, 140.0]
BANKS = [0, 0, 0, 1, 1]
ARMS = np.array([-0.2, 0.0, 0.1, 0.3, 0.5])
ROUNDING = 1e-14


def cylinders(first: int = 1) -> Cylinders:
    """Five in two banks, cylinder 1 in the second of them; masses and lengths count nowhere."""
    rest = dict.fromkeys(("radius", "offset", "lam", "eps", "reciprocating", "rotating", "couple"), np.ones(1))
    angles = {"axis_deg": np.array(AXES), "pin_deg": np.array(PINS)}
    return Cylinders(**angles, **rest, starts=np.array([0, 3]), first=first, z=ARMS)


def random(seed: int, columns: int) -> np.ndarray:
    numbers = np.random.default_rng(seed)
    shape = len(ORDERS), columns
    return numbers.normal(size=shape) + 1j * numbers.normal(size=shape)


def turned(n: float, cylinder: int, first: int) -> tuple[complex, complex, complex]:
    """Factors of a local harmonic e^{i n psi}: of a forward vector, of a backward one, of a scalar,
    with `psi = theta + axis_1 + pin - axis`.
    """
    axis = math.radians(AXES[BANKS[cylinder]])
    phase = n * (math.radians(AXES[first]) + math.radians(PINS[cylinder]) - axis)
    return cmath.exp(1j * (axis + phase)), cmath.exp(1j * (axis - phase)), cmath.exp(1j * phase)


@pytest.mark.parametrize("first", [0, 1])
@pytest.mark.parametrize("columns", [1, 5])
@pytest.mark.parametrize("arms", [None, ARMS])
def test_vectors_and_scalars_are_turned_and_added_up(columns, arms, first):
    """Equal vectors are taken out of the sum, others not; the result is the same."""
    forward = random(1, columns)
    mirrored = random(2, columns)
    vectors = Series(np.array((forward, mirrored)), np.zeros((len(ORDERS), 1)))
    phases = Phases(cylinders(first), ORDERS)
    found = phases.add_vectors(vectors, arms, arms)
    scalar = phases.add_scalars(Series(forward))
    for row, n in enumerate(ORDERS):
        ahead = astern = about = 0j
        for k in range(5):
            own = (row, k if columns > 1 else 0)
            with_crank, against, still = turned(n, k, first)
            arm = 1 if arms is None else arms[k]
            ahead += arm * forward[own] * with_crank
            astern += arm * mirrored[own].conjugate() * against
            about += forward[own] * still
        assert found.forward[row] == pytest.approx(ahead, abs=ROUNDING)
        assert found.backward[row] == pytest.approx(astern, abs=ROUNDING)
        whole = scalar.forward[row] if n == 0 else 2 * scalar.forward[row]
        assert whole == pytest.approx(about.real if n == 0 else about, abs=ROUNDING)


@pytest.mark.parametrize("columns", [1, 5])
@pytest.mark.parametrize("arms", [None, ARMS])
def test_what_is_not_summed_are_the_terms_of_the_sum(columns, arms):
    sides = np.array((random(3, columns), random(4, columns)))
    vectors = Series(sides, np.ones((len(ORDERS), columns)))
    whole = Phases(cylinders(), ORDERS).add_vectors(vectors, arms, arms)
    each = SeparatePhases(cylinders(), ORDERS).add_vectors(vectors, arms, arms)
    assert each.forward.shape == each.backward.shape == (len(ORDERS), 5)
    assert each.forward.sum(axis=1) == pytest.approx(whole.forward, abs=ROUNDING)
    assert each.backward.sum(axis=1) == pytest.approx(whole.backward, abs=ROUNDING)
    noise = np.broadcast_to(each.noise, (len(ORDERS), 5)).sum(axis=1)
    assert noise == pytest.approx(whole.noise)

"""Products that are not multiplied out against the same phasors written out."""

from __future__ import annotations

import numpy as np
import pytest

from balcli.core.phasors import EPS, FactoredPhasors, Phasors

ORDERS = np.array([1.0, 2.0, 4.0])
RNG = np.random.default_rng(5)


def random_vectors(*shape: int) -> np.ndarray:
    return RNG.normal(size=shape) + 1j * RNG.normal(size=shape)


SIDES = (
    (RNG.normal(size=(3, 1, 5)), random_vectors(3, 4, 1)),
    (random_vectors(3, 1, 5), random_vectors(3, 4, 1)),
)
NOISE = np.abs(RNG.normal(size=(3, 1, 5)))  # as large as what it is compared with
FACTORED = FactoredPhasors(ORDERS, SIDES, NOISE)
PLAIN = Phasors.of(ORDERS, *(factor * vector for factor, vector in SIDES), NOISE)


def compare(one: Phasors, other: Phasors) -> None:
    assert np.array_equal(one.orders, other.orders)
    for name in ("forward", "backward", "major", "minor", "x", "y"):
        found, expected = getattr(one, name), getattr(other, name)
        assert found.shape == expected.shape, name
        assert np.abs(found - expected).max() <= 16 * EPS, name
        assert np.array_equal(found == 0, expected == 0), name


@pytest.mark.parametrize("factor", [1j, -2.5, RNG.normal(size=(3, 4, 1))])
def test_products_are_what_they_are_multiplied_out(factor: complex | np.ndarray) -> None:
    compare(FACTORED, PLAIN)
    compare(factor * FACTORED, factor * PLAIN)
    compare((1j * FACTORED).drop_noise(), (1j * PLAIN).drop_noise())
    compare(FACTORED + PLAIN, PLAIN + PLAIN)


def test_what_lies_within_the_noise_is_zero_in_one_row_as_in_all() -> None:
    settled, plain = FACTORED.drop_noise(), PLAIN.drop_noise()
    there = np.count_nonzero(plain.forward)
    assert 0 < there < plain.forward.size  # some and not all
    compare(settled, plain)
    for row in range(len(ORDERS)):
        compare(settled.select_row(row), plain.select_row(row))
    compare(settled.select_orders([2, 4]), plain.select_orders([2, 4]))

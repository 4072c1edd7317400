"""The largest values of many curves at once against a dense grid of each."""

import numpy as np
import pytest

from balcli.core import peaks
from balcli.core.peaks import find_largest, find_peak
from balcli.core.phasors import Phasors

pytestmark = pytest.mark.slow

DENSE = np.linspace(0, 4 * np.pi, 200_001)


def curves(orders, forward, backward) -> Phasors:
    return Phasors.of(np.asarray(orders, float), forward, backward, np.zeros(1))


def random_curves(orders, count: int, seed: int = 3) -> Phasors:
    """Amplitudes that fall with the order, as an engine's do."""
    rng = np.random.default_rng(seed)
    shape = len(orders), count
    size = np.asarray(orders, float).reshape(-1, 1) + 1
    sides = (rng.normal(size=shape) + 1j * rng.normal(size=shape) for _ in range(2))
    return curves(orders, *(side / size for side in sides))


@pytest.mark.parametrize(
    "orders", [[1, 2, 4, 6], [0, 1, 2], [3, 6, 12, 18], [0.5, 1, 1.5, 3], [7], range(1, 40), [0]], ids=str
)
def test_against_a_dense_grid(orders):
    many = random_curves([*orders], 25)
    found = find_largest(many)
    turning = np.exp(1j * np.multiply.outer(DENSE, many.orders))
    dense = np.abs(turning @ many.forward + turning.conj() @ many.backward).max(axis=0)
    assert np.all(found >= dense * (1 - 1e-15))
    assert np.all(found <= dense * (1 + 1e-6))


def test_what_is_balanced_level_or_turns_evenly():
    """Nothing, a mean, a vector that turns, an ellipse, in one call."""
    forward = np.array([[0, 2, 0, 0], [0, 0, 3j, 4]], complex)
    backward = np.array([[0, 0, 0, 0], [0, 0, 0, -1]], complex)
    assert find_largest(curves([0, 1], forward, backward)) == pytest.approx([0, 2, 3, 5], rel=1e-15)
    assert find_largest(curves([1, 2], 0 * forward, 0 * backward)).tolist() == [0] * 4


def test_trailing_axes_and_blocks(monkeypatch):
    """A side that is the same for all, two axes of variants, a few curves at a time."""
    many = random_curves([1, 2, 3], 12)
    grid = curves(many.orders, many.forward.reshape(3, 3, 4), many.backward[:, :1].reshape(3, 1, 1))
    whole = find_largest(grid)
    assert whole.shape == (3, 4)
    monkeypatch.setattr(peaks, "_AT_ONCE", 5 * 96)
    assert np.array_equal(find_largest(grid), whole)
    one = curves(many.orders, grid.forward[:, 1, 2], grid.backward[:, 0, 0])
    assert whole[1, 2] == pytest.approx(find_peak(one).value, rel=4e-15, abs=0)

"""Curves over a cycle against the curve itself on a fine grid and in closed form."""

import numpy as np
import pytest

from balcli.core.peaks import find_longest, find_swing, largest_of_ellipse, sum_amplitudes

RELATIVE = 1e-13
FINE = np.linspace(0, 4 * np.pi, 1 << 16, endpoint=False)


def values(orders, phasors, angle=FINE):
    """Curves (angles, *curves), term by term."""
    return np.tensordot(np.exp(1j * np.outer(angle, orders)), phasors, 1).real


def random_phasors(seed, *shape):
    rng = np.random.default_rng(seed)
    return rng.normal(size=shape) + 1j * rng.normal(size=shape)


@pytest.mark.parametrize(
    "orders", [[0.5], [1, 2], [0, 0.5, 1.5], [3, 6, 9, 12], np.arange(1, 25) / 2, [7.5, 40], [12, 0.5, 3]]
)
def test_highest_and_lowest_of_many_curves(orders):
    phasors = random_phasors(3, len(orders), 5, 4)
    swing = find_swing(orders, phasors)
    curve = values(orders, phasors)
    step = max(orders) * FINE[1]
    slack = sum_amplitudes(phasors) * step**2
    assert np.all(swing.highest.value >= curve.max(axis=0) - RELATIVE * slack / step**2)
    assert np.all(swing.highest.value <= curve.max(axis=0) + slack)
    assert np.all(swing.lowest.value <= curve.min(axis=0) + RELATIVE * slack / step**2)
    assert np.all(swing.lowest.value >= curve.min(axis=0) - slack)
    for peak in swing:
        there = [values(orders, phasors[:, i, j], peak.angle[i, j : j + 1])[0] for i, j in np.ndindex(5, 4)]
        assert peak.value.ravel() == pytest.approx(there, rel=1e-12)
        assert np.all((peak.angle >= 0) & (peak.angle < 4 * np.pi))


@pytest.mark.parametrize("order", [0.5, 1, 12, 60.5])
def test_of_one_order_it_is_the_amplitude(order):
    swing = find_swing([order], np.array([[3 - 4j, 0.0, 2.0]]))
    assert swing.half == pytest.approx([5, 0, 2], rel=RELATIVE, abs=0)
    assert swing.highest.angle[0] == pytest.approx(np.arctan2(4, 3) / order)
    assert swing.highest.angle[1:] == pytest.approx([0, 0])


def test_two_orders_in_closed_form():
    """cos t + a cos 2t: highest 1 + a at 0; lowest where cos t = -1/(4a), -a - 1/(8a), if a > 1/4."""
    a = np.array([0.26, 0.5, 3.0])
    swing = find_swing([1, 2], np.stack([np.ones(3), a]).astype(complex))
    assert swing.highest.value == pytest.approx(1 + a, rel=RELATIVE)
    assert swing.lowest.value == pytest.approx(-a - 1 / (8 * a), rel=RELATIVE)
    assert swing.lowest.angle == pytest.approx(np.arccos(-1 / (4 * a)))


def test_a_peak_that_no_sample_shows_as_highest():
    """Two tops of nearly equal height, the higher one farther from a sample."""
    orders = [1, 7, 8]
    for shift in np.linspace(0, 0.2, 41):
        phasors = np.array([0.003, 1, 1]) * np.exp(-1j * shift * np.array(orders))
        top = find_swing(orders, phasors[:, None]).highest
        assert top.value == pytest.approx([2.003], rel=RELATIVE)
        assert top.angle == pytest.approx([shift], abs=1e-6)


def test_a_mean_counts_with_its_real_part():
    swing = find_swing([0, 1], np.array([2 + 9j, 1]))
    assert (swing.highest.value, swing.lowest.value) == pytest.approx((3, 1))
    assert find_longest([0, 1], np.array([[2 + 9j], [1]])).value == pytest.approx(3)


@pytest.mark.parametrize("components", [1, 2, 3])
def test_longest_vector(components):
    orders = np.arange(1, 17) / 2
    phasors = random_phasors(5, len(orders), 6, components)
    found = find_longest(orders, phasors)
    length = np.linalg.norm(values(orders, phasors), axis=-1).max(axis=0)
    assert np.all(found.value >= length * (1 - RELATIVE))
    assert np.all(found.value <= length * (1 + (8 * FINE[1]) ** 2))
    if components == 1:
        swing = find_swing(orders, phasors[..., 0])
        both = np.maximum(swing.highest.value, -swing.lowest.value)
        assert found.value == pytest.approx(both, rel=RELATIVE)


def test_ellipse_of_a_circle_and_of_a_line():
    circle = np.array([3, 3j, 0])
    line = np.array([3, 0, 4]) * np.exp(1.2j)
    assert largest_of_ellipse(np.array([circle, line])) == pytest.approx([3, 5])


@pytest.mark.parametrize("orders", [[0.25, 1], [-1, 1], [1, 1]])
def test_other_orders_are_refused(orders):
    message = "orders have to be different multiples of 1/2, none below 0"
    with pytest.raises(ValueError, match=message):
        find_swing(orders, np.ones((2, 1), complex))

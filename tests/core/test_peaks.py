"""The largest value over a revolution, on the curve and not on a grid."""

import numpy as np
import pytest

from balcli.core.peaks import find_peak
from balcli.core.phasors import Phasors

RELATIVE = 1e-14


def curve(*terms: tuple[float, complex, complex]) -> Phasors:
    """Phasors of (order, forward, backward)."""
    orders, forward, backward = zip(*terms, strict=True)
    return Phasors.of(np.array(orders, float), np.array(forward, complex), np.array(backward, complex), np.zeros(1))


@pytest.mark.parametrize("order", [1, 2, 7, 40, 300])
@pytest.mark.parametrize(("forward", "backward"), [(3 + 4j, 1 - 2j), (1, 1), (0.2j, 1)])
def test_of_one_order_it_is_the_longer_semi_axis(order, forward, backward):
    found = find_peak(curve((order, forward, backward)))
    assert found.value == pytest.approx(abs(forward) + abs(backward), rel=RELATIVE)
    assert 0 <= found.theta < 2 * np.pi


def test_half_orders_repeat_themselves_after_two_revolutions():
    """cos(theta/2) - 1 is largest, 2 away from 0, when the crank has turned once."""
    found = find_peak(curve((0, -1, 0), (0.5, 0.5, 0.5)))
    assert found.value == pytest.approx(2, rel=RELATIVE)
    assert found.theta == pytest.approx(2 * np.pi, rel=1e-9)


@pytest.mark.parametrize("turn", [-1e-14, 0, 1e-14])
def test_a_peak_at_0_is_not_at_a_whole_turn(turn):
    vector = 0.5 * np.exp(1j * turn)
    assert find_peak(curve((1, vector, vector.conjugate()), (2, 0.125, 0.125))).theta == 0


def test_piston_acceleration_of_two_terms():
    """cos t + lambda cos 2t: 1 + lambda at top dead centre; without the first, the second alone."""
    found = find_peak(curve((1, 0.5, 0.5), (2, 0.125, 0.125)))
    assert found.value == pytest.approx(1.25, rel=RELATIVE)
    assert np.cos(found.theta) == pytest.approx(1)


@pytest.mark.parametrize(
    ("parts", "every"),
    [
        ([(1, 0.5, 0.5)], np.pi),
        ([(1, 0.5, 0.5), (2, 0.125, 0.125)], 2 * np.pi),
        ([(2, 0.5, 0.5), (4, 0.1j, -0.1j)], np.pi),
        ([(3, 1, 0.2), (9, 0.3, 0)], np.pi / 3),
        ([(1, 1, 0), (4, 0.1, 0.2)], 2 * np.pi),
        ([(1, 1, 0), (6, 0, 0.2)], 2 * np.pi / 7),
        ([(5, 1j, 0)], 0),
        ([(0, 1, 0)], 0),
        ([(0.5, 0.5, 0.5), (1.5, 0.1, 0.1)], 2 * np.pi),
        ([(0, 1, 0), (0.5, 0.5, 0.5)], 4 * np.pi),
    ],
)
def test_after_which_angle_a_curve_repeats_its_size(parts, every):
    """By its samples: after this angle, and not after a half or a third of it."""
    found = curve(*parts)
    assert find_peak(found).every == pytest.approx(every)
    theta = np.linspace(0, 4 * np.pi, 97)
    size = np.abs(found.values(theta))
    assert np.abs(found.values(theta + every)) == pytest.approx(size)
    for part in (2, 3):
        again = np.abs(found.values(theta + every / part))
        assert (every == 0) == (again == pytest.approx(size))


def test_a_narrow_peak_between_samples():
    """All orders in step at an angle that no regular sampling meets: their sum there, and the angle itself."""
    orders, at = np.arange(1, 41), 1.2345678
    found = find_peak(curve(*[(n, 0.5 * np.exp(-1j * n * at), 0.5 * np.exp(1j * n * at)) for n in orders]))
    assert found.value == pytest.approx(40, rel=RELATIVE)
    assert found.theta == pytest.approx(at, abs=1e-9)


@pytest.mark.parametrize("seed", range(4))
def test_random_curves_against_many_samples(seed):
    random = np.random.default_rng(seed)
    orders = np.arange(0 if seed % 2 else 1, 3 + 4 * seed)
    vectors = (random.normal(size=(4, len(orders))) * 0.7**orders).astype(complex)
    backward = np.where(orders > 0, vectors[2] + 1j * vectors[3], 0)
    phasors = Phasors.of(orders.astype(float), vectors[0] + 1j * vectors[1], backward, np.zeros(1))
    found = find_peak(phasors)
    sampled = np.abs(phasors.values(np.linspace(0, 2 * np.pi, 40_001))).max()
    assert sampled * (1 - RELATIVE) <= found.value <= sampled * (1 + 1e-5)
    assert abs(phasors.values(found.theta)) == pytest.approx(found.value, rel=RELATIVE)
    there = np.exp(1j * orders * found.theta)
    rate = np.sum(1j * orders * (phasors.forward * there - phasors.backward / there))
    assert (
        abs((np.conj(phasors.values(found.theta)) * rate).real) <= 1e-13 * orders[-1] * found.value**2
    )  # level to rounding


def test_of_equal_peaks_the_first_counts():
    """|cos 3 theta| is 1 at 0, 60, 120 .. deg, |sin 3 theta| at 30, 90 ..; rounding must not choose."""
    for turned, first in ((1, 0.0), (1j, 30.0), (1 - 1e-13j, 0.0), (1 + 1e-13j, 0.0)):  # the last a whole turn, nearly
        half = np.array([turned / 2])
        found = find_peak(Phasors.of(np.array([3.0]), half, np.conj(half), np.zeros(1)))
        assert found.value == pytest.approx(1, rel=1e-14)
        assert (np.degrees(found.theta) + 1e-9) % 360 == pytest.approx(first, abs=1e-7)


@pytest.mark.parametrize("order", [200])
def test_more_near_maxima_than_are_climbed(order):
    """Two neighbouring orders against each other, and a little of a first that says which of their
    maxima, hundreds within 8 % of the top, is the highest: its sample is none of the highest 64.
    """
    many = curve((1, 0.0242 * np.exp(0.7j), 0), (order - 1, 0, np.exp(1.7453j)), (order, np.exp(0.2967j), 0))
    found = find_peak(many)
    theta = np.linspace(0, 2 * np.pi, 400 * order, endpoint=False)
    dense = max(np.abs(many.values(part)).max() for part in np.array_split(theta, 100))
    assert found.value >= dense * (1 - 1e-9)
    there = np.abs(many.values(np.array([found.theta])))[0]
    assert found.value == pytest.approx(float(there), rel=1e-11)


def test_of_what_is_tiny_squares_may_underflow():
    assert 0 < find_peak(curve((1, 1e-170, 0), (40, 0, 1e-170))).value <= 2e-170

"""The largest value over a revolution or a cycle, on the curve and not on a grid; of many curves at once."""

import numpy as np
import pytest

from balcli.core import peaks
from balcli.core.peaks import find_largest, find_peak, find_peaks, find_swing
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
    orders = np.arange(1, 41)
    at = 1.2345678
    found = find_peak(curve(*[(n, 0.5 * np.exp(-1j * n * at), 0.5 * np.exp(1j * n * at)) for n in orders]))
    assert found.value == pytest.approx(40, rel=RELATIVE)
    assert found.theta == pytest.approx(at, abs=1e-9)


def test_of_equal_peaks_the_first_counts():
    """|cos 3 theta| is 1 at 0, 60, 120 .. deg, |sin 3 theta| at 30, 90 ..; rounding must not choose."""
    for turned, first in ((1, 0.0), (1j, 30.0), (1 - 1e-13j, 0.0), (1 + 1e-13j, 0.0)):  # the last a whole turn, nearly
        half = np.array([turned / 2])
        found = find_peak(Phasors.of(np.array([3.0]), half, np.conj(half), np.zeros(1)))
        assert found.value == pytest.approx(1, rel=1e-14)
        assert (np.degrees(found.theta) + 1e-9) % 360 == pytest.approx(first, abs=1e-7)


def test_more_near_maxima_than_are_climbed():
    """Two neighbouring orders against each other, and a little of a first that says which of their
    maxima, hundreds within 8 % of the top, is the highest: its sample is none of the highest 64.
    """
    order = 200
    many = curve((1, 0.0242 * np.exp(0.7j), 0), (order - 1, 0, np.exp(1.7453j)), (order, np.exp(0.2967j), 0))
    found = find_peak(many)
    theta = np.linspace(0, 2 * np.pi, 400 * order, endpoint=False)
    dense = max(np.abs(many.values(part)).max() for part in np.array_split(theta, 100))
    assert found.value >= dense * (1 - 1e-9)
    assert found.value == pytest.approx(abs(many.values(found.theta)), rel=1e-11)


def test_of_what_is_tiny_squares_may_underflow():
    assert 0 < find_peak(curve((1, 1e-170, 0), (40, 0, 1e-170))).value <= 2.001e-170


# ------------------------------------------------------------------ many curves
def curves(orders, forward, backward) -> Phasors:
    return Phasors.of(np.asarray(orders, float), forward, backward, np.zeros(1))


def random_curves(orders, count: int) -> Phasors:
    """Amplitudes that fall with the order, as an engine's do."""
    vectors = np.random.default_rng(3).normal(size=(2, len(orders), count, 2)) @ [1, 1j]
    return curves(orders, *(vectors / (np.asarray(orders, float).reshape(-1, 1) + 1)))


@pytest.mark.slow
@pytest.mark.parametrize(
    "orders", [[1, 2, 4, 6], [0, 1, 2], [3, 6, 12, 18], [0.5, 1, 1.5, 3], [7], range(1, 40), [0]], ids=str
)
def test_against_a_dense_grid(orders):
    many = random_curves([*orders], 25)
    found = find_largest(many)
    turning = np.exp(1j * np.multiply.outer(np.linspace(0, 4 * np.pi, 200_001), many.orders))
    dense = np.abs(turning @ many.forward + turning.conj() @ many.backward).max(axis=0)
    assert np.all(found >= dense * (1 - 1e-15))
    assert np.all(found <= dense * (1 + 1e-6))
    for k, peak in enumerate(find_peaks(many)):
        one = many.select_place(k)
        assert found[k] == peak.value == pytest.approx(abs(one.values(peak.theta)), rel=RELATIVE)
        turn = np.exp(1j * many.orders * peak.theta)
        rate = np.sum(1j * many.orders * (one.forward * turn - one.backward / turn))
        level = 1e-13 * many.orders[-1] * peak.value**2  # flat to rounding
        assert abs((np.conj(one.values(peak.theta)) * rate).real) <= level


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


def test_curves_below_the_least_swing_have_bounds():
    """Half of 60 curves stay below it; the values of the others are the same as without it."""
    orders = np.arange(1, 13) / 2
    rng = np.random.default_rng(3)
    phasors = rng.normal(size=(12, 60, 2)) @ [1, 1j]
    exact = find_swing(orders, phasors).half
    least = np.full(60, np.median(exact))
    found = find_swing(orders, phasors, least).half
    above = exact >= least
    assert np.array_equal(found[above], exact[above])
    low = ~above & (found != exact)
    assert np.count_nonzero(low) > 20
    assert np.all(found[~above] < least[~above])
    assert np.all(found[low] >= exact[low])
    assert found[low] == pytest.approx(exact[low], rel=1 / np.cos(np.pi / 16) - 1 + 1e-9)

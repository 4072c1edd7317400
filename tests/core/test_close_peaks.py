"""Peaks of functions side by side, each within its own bounds; where a function is least."""

import math

import numpy as np
import pytest

from balcli.core.peaks import find_highest, find_least, find_least_smooth, find_peaks_between


def find_each(function, low, high):
    """One function for each interval."""
    between = np.stack([low, high])
    which = np.arange(len(low))
    return find_peaks_between(function, between, function(between, which), which)


def test_a_parabola_is_found_exactly_and_an_end_is_an_end():
    """The third falls all the way."""
    places = np.array([0.1, 7.0, -3.0])
    low = np.array([0.0, 5, -3])
    high = np.array([1.0, 8, -2])
    at, heights = find_each(lambda x, k: 4 - (x - places[k]) ** 2, low, high)
    assert at[:2] == pytest.approx(places[:2], rel=1e-12)
    assert heights[:2] == pytest.approx(4, rel=1e-15)
    assert (at[2], heights[2]) == (-3, 4)


def test_nothing_is_asked_beyond_an_interval():
    """The vertex is at its upper end; the function has no value beyond."""

    def judge(x, _):
        assert np.all((x >= 2) & (x <= 6))
        return 9 - (x - 6) ** 2

    at, heights = find_each(judge, np.array([2.0]), np.array([6.0]))
    assert (at[0], heights[0]) == (6, 9)


def test_resonances_as_wide_as_the_interval():
    """|1 / (w0^2 - w^2 + 2 i d w0 w)| is largest at w0 sqrt(1 - 2 d^2)."""
    own = np.array([1.0, 40.0])
    damping = np.array([0.05, 0.3])

    def amplify(w, k):
        return 1 / np.abs(own[k] ** 2 - w**2 + 2j * damping[k] * own[k] * w)

    at, heights = find_each(amplify, 0.8 * own, 1.1 * own)
    assert at == pytest.approx(own * np.sqrt(1 - 2 * damping**2), rel=1e-4)
    assert heights == pytest.approx(1 / (2 * damping * own**2 * np.sqrt(1 - damping**2)), rel=1e-8)


def test_intervals_that_do_not_have_the_highest_are_given_up():
    """Of one function with peaks of 3 and 4 the lower is not approached."""
    seen = []

    def judge(x, which):
        seen.append(x.shape[1])
        return np.maximum(3 - (x - 1) ** 2, 4 - (x - 6) ** 2)

    which = np.zeros(2, np.intp)
    between = np.array([[0.0, 5], [1.5, 7.5]])
    ends = judge(between, which)
    seen.clear()
    _, heights = find_peaks_between(judge, between, ends, which)
    assert heights.max() == pytest.approx(4, rel=1e-12)
    assert seen[0] == 2
    assert seen[-1] == 1


def test_the_highest_may_lie_beside_the_highest_place():
    """The curve falls from its highest place, 2, to 3, and rises to its top between 3 and 4."""
    places = np.arange(7.0)

    def judge(x, _=None):
        return np.maximum(10 - np.abs(x - 2), 10.4 - 6 * (x - 3.3) ** 2)

    heights = judge(places)[:, None]
    assert heights.argmax() == 2
    best, highest = find_highest(judge, places, heights, heights.max(axis=0), 0.9)
    assert best == pytest.approx([3.3])
    assert highest == pytest.approx([10.4])


def test_of_two_peaks_in_an_interval_the_one_that_looks_lower_may_be_higher():
    """Eighths of the interval meet the lower one, 1 at 2, and miss the higher one, 1.01 at 5.5."""

    def judge(x, _):
        return np.maximum(1 - 0.1 * (x - 2) ** 2, 1.01 - 0.1 * (x - 5.5) ** 2)

    between = np.array([[0.0], [8.0]])
    at, height = find_peaks_between(judge, between, judge(between, None), np.zeros(1, np.intp))
    assert (at[0], height[0]) == (pytest.approx(5.5), pytest.approx(1.01, rel=1e-12))


def test_a_peak_in_a_wide_interval_is_seen_by_the_chords_beside_it():
    """The highest place is elsewhere, at 20; the peak, 10.5 at 6, rises no place as high, and its values change little."""
    places = np.array([0.0, 3.8, 4.0, 8.0, 8.2, 12, 16, 20, 24])

    def judge(x, _=None):
        return np.maximum(10.5 - 0.15 * (x - 6) ** 2, 10.2 - 0.6 * (x - 20) ** 2)

    heights = judge(places)[:, None]
    assert heights.argmax() == 7
    best, highest = find_highest(judge, places, heights, heights.max(axis=0), 0.9)
    assert best == pytest.approx([6])
    assert highest == pytest.approx([10.5])


def test_a_peak_beside_an_end_may_be_higher_than_one_inside():
    """Of the eighths, 3 is the highest, 1.041; 1, 1.035, is beside the higher peak, 1.05 at 0.8."""

    def judge(x, _):
        return np.maximum(1.05 - 0.375 * (x - 0.8) ** 2, 1.041 - 0.008 * (x - 3) ** 2)

    between = np.array([[0.0], [8.0]])
    at, height = find_peaks_between(judge, between, judge(between, None), np.zeros(1, np.intp))
    assert (at[0], height[0]) == (pytest.approx(0.8), pytest.approx(1.05, rel=1e-12))


@pytest.mark.parametrize("place", [0.0, 0.1, np.pi / 10, 0.5, 0.9, 1.0])
@pytest.mark.parametrize("power", [1, 2])
@pytest.mark.parametrize("find", [find_least, find_least_smooth])
def test_the_bottom_of_a_valley(place, power, find):
    assert find(lambda x: abs(x - place) ** power, 0, 1) == pytest.approx(place, abs=1e-4)


@pytest.mark.parametrize(("judge", "most"), [(lambda x: (x - 0.3) ** 2, 6), (lambda x: math.cosh(5 * x - 1), 10)])
def test_the_bottom_of_a_smooth_valley_takes_few_steps(judge, most):
    """A third of the 22 of golden section."""
    places = []
    found = find_least_smooth(lambda x: places.append(x) or judge(x), -1, 1)
    assert judge(found) == pytest.approx(min(judge(0.3), judge(0.2)), abs=1e-8)
    assert len(places) <= most


def test_what_has_no_bound_on_one_side_is_least_beside_it():
    assert find_least_smooth(lambda x: x if x >= 0.2 else math.inf, 0, 1) == pytest.approx(0.2, abs=1e-4)


def test_on_a_flat_bottom_the_next_part_counts():
    """Flat from 0.3 to 0.6, where the second part falls; beyond, it goes on falling."""
    found = find_least(lambda x: (max(0.3 - x, 0.0, x - 0.6), -x), 0, 1)
    assert found == pytest.approx(0.6, abs=1e-4)

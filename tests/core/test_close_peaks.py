"""Peaks of functions side by side, each within its own bounds."""

from __future__ import annotations

import numpy as np
import pytest

from balcli.core.close_peaks import find_peaks_between, mark_high_peaks


def test_a_parabola_is_found_exactly_and_an_end_is_an_end():
    """The third falls all the way."""
    places, low, high = np.array([0.1, 7.0, -3.0]), np.array([0.0, 5, -3]), np.array([1.0, 8, -2])
    at, heights = find_peaks_between(lambda x: 4 - (x - places) ** 2, low, high)
    assert at[:2] == pytest.approx(places[:2], rel=1e-12)
    assert heights[:2] == pytest.approx(4, rel=1e-15)
    assert at[2] == pytest.approx(-3, abs=2e-3)


def test_resonances_as_wide_as_the_interval():
    """|1 / (w0^2 - w^2 + 2 i d w0 w)| is largest at w0 sqrt(1 - 2 d^2)."""
    own, damping = np.array([1.0, 40.0]), np.array([0.05, 0.3])

    def amplify(w):
        return 1 / np.abs(own**2 - w**2 + 2j * damping * own * w)

    at, heights = find_peaks_between(amplify, 0.8 * own, 1.1 * own)
    assert at == pytest.approx(own * np.sqrt(1 - 2 * damping**2), rel=1e-4)
    assert heights == pytest.approx(1 / (2 * damping * own**2 * np.sqrt(1 - damping**2)), rel=1e-8)


def test_what_is_told_of_a_place_is_the_height_there():
    at, heights = find_peaks_between(np.cos, np.array([-1.0, 5.0]), np.array([0.5, 8.0]))
    assert heights.tolist() == np.cos(at).tolist()


def test_peaks_at_the_ends_and_of_equal_height_count_low_ones_do_not():
    heights = np.array([[5.0, 0], [1, 0], [4.6, 0], [2, 0], [4.4, 0], [3, 0], [5, 0]])
    marked = mark_high_peaks(heights, 0.9)
    assert np.flatnonzero(marked[:, 0]).tolist() == [0, 2, 6]
    assert not marked[:, 1].any()  # 0 is above nothing

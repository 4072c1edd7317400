"""Where functions of one number have their peaks, where one call for many places costs little more
than one for a few.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from .singular_values import Real

_PARTS = 8  # of an interval, before the two beside the highest place are the next interval
_ROUNDS = 3


def find_peaks_between(judge: Callable[[Real], Real], low: Real, high: Real) -> tuple[Real, Real]:
    """Places and heights (functions,) of a peak of several functions between two places each. The
    height is good to 1e-8 where the interval is no wider than the peak.

    The peak is enclosed ever closer; the last place is the vertex of a parabola.

    Args:
        judge: places (places, functions), a column for each function -> the values there.
        low, high: (functions,) between which the peaks lie.
    """
    shares = np.arange(1, _PARTS)[:, None] / _PARTS
    each = np.arange(len(low))
    best, highest = low, np.full(len(low), -np.inf)
    for _ in range(_ROUNDS):
        step = (high - low) / _PARTS
        heights = judge(low + (high - low) * shares)
        top = low + step * (1 + heights.argmax(axis=0))
        best = np.where(heights.max(axis=0) > highest, top, best)
        highest = np.maximum(highest, heights.max(axis=0))
        low, high = top - step, top + step
    middle = np.clip(heights.argmax(axis=0), 1, _PARTS - 3)
    before, here, after = (heights[middle + k, each] for k in (-1, 0, 1))
    bend = before - 2 * here + after
    beside = (before - after) / (2 * np.where(bend < 0, bend, -np.inf))
    vertex = top + step * (middle - heights.argmax(axis=0) + beside)
    vertex = np.clip(vertex, low, high)
    there = judge(vertex[None])[0]
    return np.where(there > highest, vertex, best), np.maximum(highest, there)


def mark_high_peaks(heights: Real, share: float) -> NDArray[np.bool_]:
    """Which of the heights (places, functions) are peaks, those at the ends too, and above this
    share of the highest of their function.
    """
    ends = np.zeros((1, heights.shape[1]))
    around = np.concatenate([ends, heights, ends])
    peaks = (heights >= around[:-2]) & (heights >= around[2:])
    return np.asarray(peaks & (heights > share * heights.max(axis=0)))

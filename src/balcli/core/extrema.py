"""Find maxima and minima of functions of one variable. The search for maxima suits functions for
which one call with many places costs little more than a call with few.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TypeVar

import numpy as np

from .vibration import Indices, Real

_PARTS = 8  # parts into which an interval is cut; the two next to a peak are the next interval
_ROUNDS = 4


def find_highest(
    judge: Callable[[Real, Indices], Real], places: Real, heights: Real, level: Real, near: float
) -> tuple[Real, Real]:
    """Return place and height of the maximum of each function, shape (functions,). A maximum may
    lie between the given places.

    An interval between neighbouring places is searched if it may contain the maximum: its higher
    end is at least `near * level`, and no farther below the level than the function changes from
    place to place there.

    Args:
        judge: The functions, as in `find_peaks_between`.
        places: Rising places, shape (places,).
        heights: Values of the functions there, shape (places, functions).
        level: Lowest height that matters, shape (functions,).
        near: Share of the level that the higher end of a searched interval must reach.
    """
    best, highest = places[heights.argmax(axis=0)], heights.max(axis=0)
    ends = np.maximum(heights[1:], heights[:-1])
    rise = np.abs(np.diff(np.pad(heights, ((1, 1), (0, 0)), mode="edge"), axis=0))
    beside = np.maximum(np.maximum(rise[:-2], rise[1:-1]), rise[2:])
    may = (ends >= near * level) & (ends + beside >= level) & (level > 0)
    at, which = np.nonzero(may)
    if len(at):
        place, height = find_peaks_between(judge, places[at], places[at + 1], which)
        _raise(best, highest, which, place, height)
    return best, highest


def find_peaks_between(
    judge: Callable[[Real, Indices], Real], low: Real, high: Real, which: Indices
) -> tuple[Real, Real]:
    """Return place and height of a peak of a function in each of several intervals, shape
    (intervals,). The highest peak of each function is accurate to 1e-8 if it is smooth and its
    interval no wider than the peak. The search ends early in intervals that do not contain it.

    Each interval is cut into eighths. Every peak among these places that may be the highest is
    enclosed in a smaller interval, which is cut again; the last place is the vertex of a parabola.
    A peak that is narrower than an eighth may be missed.

    Args:
        judge: Function that returns the values of some functions. Its arguments are places, shape
            (places, some), and the index of the function of each column, shape (some,).
        low: Lower ends of the intervals, shape (intervals,).
        high: Upper ends of the intervals, shape (intervals,).
        which: Index of the function of each interval, shape (intervals,).
    """
    shares = np.arange(1, _PARTS)[:, None] / _PARTS
    best, highest = low.copy(), np.full(len(low), -np.inf)
    going = np.arange(len(low))
    for _ in range(_ROUNDS):
        step = (high - low) / _PARTS
        heights = judge(low + (high - low) * shares, which[going])
        ends = np.full((1, len(low)), -np.inf)
        rises = np.diff(np.concatenate([ends, heights, ends]), axis=0) >= 0
        top, at = np.nonzero(rises[:-1] & ~rises[1:])
        going, step, place = going[at], step[at], low[at] + step[at] * (1 + top)
        here, middle = heights[top, at], np.clip(top, 1, _PARTS - 3)
        around = np.stack([heights[middle + k, at] for k in (-1, 0, 1)])
        _raise(best, highest, going, place, here)
        of_function = np.full(which.max(initial=0) + 1, -np.inf)
        np.maximum.at(of_function, which, highest)
        may = 2 * here - around.min(axis=0) >= of_function[which[going]]  # it may rise as it fell
        going, place, step, top = (each[may] for each in (going, place, step, top))
        low, high, around = place - step, place + step, around[:, may]
    before, middle, after = around
    bend = before - 2 * middle + after
    beside = (before - after) / (2 * np.where(bend < 0, bend, -np.inf))
    vertex = place + step * (np.clip(top, 1, _PARTS - 3) - top + beside)
    vertex = np.clip(vertex, low, high)
    _raise(best, highest, going, vertex, judge(vertex[None], which[going])[0])
    return best, highest


def _raise(best: Real, highest: Real, going: Indices, place: Real, height: Real) -> None:
    """Raise `best` and `highest`, shape (intervals,), to the places and heights in the intervals
    `going` that are higher. An interval may occur several times.
    """
    rising = np.argsort(height, kind="stable")  # the highest is written last
    higher = rising[height[rising] > highest[going[rising]]]
    best[going[higher]], highest[going[higher]] = place[higher], height[higher]


Judged = TypeVar("Judged", float, tuple[float, float])
ROUNDS = 20  # steps of golden section, which narrow an interval to 1e-4 of its width
_GOLDEN = (math.sqrt(5) - 1) / 2


def find_least(
    judge: Callable[[float], Judged], low: float, high: float, rounds: int = ROUNDS
) -> float:
    """Return the place of the minimum of a function with one valley between two places, by golden
    section.

    Args:
        judge: The function; tuples are compared by their first value, then by the next.
        low: Lower end of the interval.
        high: Upper end of the interval.
        rounds: Number of steps, each of which narrows the interval to 0.618 of its width.
    """
    left, right = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
    at_left, at_right = judge(left), judge(right)
    for _ in range(rounds):
        if at_left <= at_right:
            high, right, at_right = right, left, at_left
            left = high - _GOLDEN * (high - low)
            at_left = judge(left)
        else:
            low, left, at_left = left, right, at_right
            right = low + _GOLDEN * (high - low)
            at_right = judge(right)
    return left if at_left <= at_right else right

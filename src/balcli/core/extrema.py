"""Peaks of functions of one number, where one call for many places costs little more than one for a
few; and where such a function is least.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TypeVar

import numpy as np

from .vibration import Indices, Real

_PARTS = 8  # of an interval, before the two beside each peak are the next interval
_ROUNDS = 4


def find_highest(
    judge: Callable[[Real, Indices], Real], places: Real, heights: Real, level: Real, near: float
) -> tuple[Real, Real]:
    """Return place and height of each function's maximum, also between places, (functions,).

    Every interval between neighbouring places that may contain the maximum is searched: its higher
    end is near the level, and no farther below it than the function changes nearby.

    Args:
        judge: as of `find_peaks_between`.
        places: (places,), rising.
        heights: (places, functions) there.
        level: (functions,), above which alone a height matters.
        near: share of the level that a peak may exceed its neighbouring places by.
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
    """Return places and heights (intervals,) of a peak in each of several intervals, in which
    several functions are searched. The highest of each function is good to 1e-8 where it is
    round and its interval no wider than the peak; intervals that do not have it are given up.

    Every peak that shows at an eighth of its interval and may be the highest is enclosed ever
    closer; the last place is the vertex of a parabola. A narrower peak between two of these places
    is missed.

    Args:
        judge: Function of places (places, some), each column in an interval, and of the numbers of
            their functions (some,), to the values there.
        low, high: Ends of the intervals, shape (intervals,).
        which: Number of the function of each interval, shape (intervals,).
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
        may = 2 * here - around.min(axis=0) >= of_function[which[going]]  # rise as it fell
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
    """Put the places and heights of some intervals, a few of each, into best and highest
    (intervals,) where they are higher.
    """
    rising = np.argsort(height, kind="stable")  # the highest last, on every processor
    higher = rising[height[rising] > highest[going[rising]]]
    best[going[higher]], highest[going[higher]] = place[higher], height[higher]


Judged = TypeVar("Judged", float, tuple[float, float])
ROUNDS = 20  # to 1e-4 of the distance between two neighbours
_GOLDEN = (math.sqrt(5) - 1) / 2


def find_least(
    judge: Callable[[float], Judged], low: float, high: float, rounds: int = ROUNDS
) -> float:
    """Return where a function with one valley between two places is least, by golden section.

    Args:
        judge: its value at a place; a tuple is judged by its first part, then by the next.
        rounds: each leaves 0.618 of the distance.
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

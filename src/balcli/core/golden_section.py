"""Where a function of one number is least, or several functions side by side are largest."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TypeVar

import numpy as np

from .singular_values import Real

Judged = TypeVar("Judged", float, tuple[float, float])
ROUNDS = 20  # to 1e-4 of the distance between two neighbours
_GOLDEN = (math.sqrt(5) - 1) / 2


def find_least(judge: Callable[[float], Judged], low: float, high: float) -> float:
    """Where a function with one valley between two places is least, to 1e-4 of their distance, by
    golden section.

    Args:
        judge: what it is at a place; a tuple is judged by its first part, then by the next.
    """
    left, right = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
    at_left, at_right = judge(left), judge(right)
    for _ in range(ROUNDS):
        if at_left <= at_right:
            high, right, at_right = right, left, at_left
            left = high - _GOLDEN * (high - low)
            at_left = judge(left)
        else:
            low, left, at_left = left, right, at_right
            right = low + _GOLDEN * (high - low)
            at_right = judge(right)
    return left if at_left <= at_right else right


def find_highest(judge: Callable[[Real], Real], low: Real, high: Real) -> tuple[Real, Real]:
    """Where each of several functions with one peak between two places is largest, to 1e-4 of
    their distance, by golden section, and how large it is there: (functions,) each.

    Args:
        judge: places (functions,), one of each -> the values there.
        low, high: (functions,) between which the peaks lie.
    """
    left, right = high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)
    at_left, at_right = judge(left), judge(right)
    for _ in range(ROUNDS):
        down = at_left >= at_right
        low, high = np.where(down, low, left), np.where(down, right, high)
        new = np.where(down, high - _GOLDEN * (high - low), low + _GOLDEN * (high - low))
        at_new = judge(new)
        left, right = np.where(down, new, right), np.where(down, left, new)
        at_left, at_right = np.where(down, at_new, at_right), np.where(down, at_left, at_new)
    return np.where(at_left >= at_right, left, right), np.maximum(at_left, at_right)

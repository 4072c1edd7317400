"""Where a function of one number is least."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TypeVar

Judged = TypeVar("Judged", float, tuple[float, float])
ROUNDS = 20  # to 1e-4 of the distance between two neighbours
_GOLDEN = (math.sqrt(5) - 1) / 2


def find_least(
    judge: Callable[[float], Judged], low: float, high: float, rounds: int = ROUNDS
) -> float:
    """Where a function with one valley between two places is least, by golden section.

    Args:
        judge: what it is at a place; a tuple is judged by its first part, then by the next.
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

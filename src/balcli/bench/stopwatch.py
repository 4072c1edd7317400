"""Run times of functions, on a machine that may be busy."""

from __future__ import annotations

import timeit
from collections.abc import Callable

import numpy as np

_PAIRS = 9
_SHORTEST = 1e-7  # s; no run is taken as quicker


def time_run(run: Callable[[], object]) -> float:
    """Seconds of the quickest of several runs, each of at least a few milliseconds."""
    timer = timeit.Timer(run)
    once = max(timer.timeit(1), _SHORTEST)
    number = max(int(0.02 / once), 1)
    return min(timer.repeat(5 if once < 0.2 else 2, number)) / number


def compare_times(one: Callable[[], object], other: Callable[[], object]) -> float:
    """Run time of the one as a multiple of the other's, measured in turn, so that a busy machine
    disturbs both alike.
    """
    number = max(int(0.01 / max(timeit.timeit(other, number=1), _SHORTEST)), 1)
    pairs = [
        (timeit.timeit(one, number=number), timeit.timeit(other, number=number))
        for _ in range(_PAIRS)
    ]
    first, second = (float(np.median(times)) for times in zip(*pairs, strict=True))
    return first / second

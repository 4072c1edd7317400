"""Run times of functions and programs, on a machine that may be busy."""

from __future__ import annotations

import math
import time
import timeit
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ..process import WINDOWS

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


class Spent(NamedTuple):
    """What programs take: seconds of processor time (nan: the system does not tell) and by the
    clock; or either as a multiple of others'.
    """

    processor: float
    clock: float


def compare_programs(one: Callable[[], object], other: Callable[[], object]) -> Spent:
    """What the programs that the one starts and waits for take, as a multiple of the other's,
    started in turn.
    """
    pairs = [(_spend(one), _spend(other)) for _ in range(_PAIRS)]
    first, second = np.median(pairs, axis=0)
    return Spent(*(first / second).tolist())


def _spend(run: Callable[[], object]) -> Spent:
    """What it takes once."""
    processor, clock = _read_children_time(), time.perf_counter()
    run()
    return Spent(_read_children_time() - processor, time.perf_counter() - clock)


def _read_children_time() -> float:
    """Processor time in s, user and system, of all programs that were started and have ended."""
    if WINDOWS:
        return math.nan
    from resource import RUSAGE_CHILDREN, getrusage  # not on Windows

    used = getrusage(RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime

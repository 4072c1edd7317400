"""Measure run times: quartiles of several rounds, in which the methods take turns, so that what
else the machine does slows all of them.
"""

from __future__ import annotations

import os
import time
import timeit
from collections.abc import Callable, Sequence
from functools import partial
from typing import TypeAlias

import numpy as np

from ..core.phasors import Array
from .methods import Method
from .records import Times

_CLOCK = time.perf_counter if os.name == "nt" else time.process_time  # Windows' is too coarse
_ROUNDS = 9
_SHORTEST = 2e-3  # s: what is shorter is repeated within one measurement
_SHARES = 10  # of many variants, each of which is timed

Run: TypeAlias = Callable[[], object]


def time_runs(runs: Sequence[Run]) -> list[Times]:
    """Return the time of each run, s: quartiles of several measurements of at least 2 ms."""
    timers = [timeit.Timer(run, timer=_CLOCK) for run in runs]
    numbers = [_count_repetitions(timer) for timer in timers]
    rounds = []
    for _ in range(_ROUNDS):
        seconds = []
        for timer, number in zip(timers, numbers, strict=True):
            seconds.append(timer.timeit(number) / number)
        rounds.append(seconds)
    return _find_quartiles(rounds)


def _count_repetitions(timer: timeit.Timer) -> int:
    """Return how often a run is repeated in a measurement."""
    once = timer.timeit(1)
    if once < _SHORTEST:  # the first run may have prepared something
        once = timer.timeit(1)
    return max(int(_SHORTEST / max(once, 1e-7)), 1)


def time_shares(methods: list[Method], lam: Array) -> list[Times]:
    """Return the time of one of many variants for each method, s. The variants are computed in
    equal shares, for which the methods take turns.
    """
    for method in methods:
        method.find(lam[:1])  # what is prepared once is not counted
    rounds = []
    for share in np.array_split(lam, _SHARES):
        seconds = []
        for method in methods:
            timer = timeit.Timer(partial(method.find, share), timer=_CLOCK)
            seconds.append(timer.timeit(1) / len(share))
        rounds.append(seconds)
    return _find_quartiles(rounds)


def _find_quartiles(rounds: list[list[float]]) -> list[Times]:
    """Return the quartiles of each column."""
    quartiles = np.quantile(rounds, [0.25, 0.5, 0.75], axis=0)
    return [Times(*column) for column in quartiles.T.tolist()]

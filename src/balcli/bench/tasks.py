"""Compute error and run time of every method of every task."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

import numpy as np

from .engine_tasks import V8, Case, Errors, list_engine_tasks
from .methods import Method, find_exactly, list_methods
from .records import Bench, Block, Measured, OrderError, Times
from .starts import compare_starts
from .timing import time_runs, time_shares

RATIOS = (0.25, 0.6, 0.95)
ORDERS = [2, 8, 16]
MANY = 100_000  # variants
_NEAR = 1e-3  # relative range of the λ of many variants
_NEIGHBOURS = 9  # λ at which an error is measured: a rounding error at one λ may be small by chance
_STEP = 1e-6  # relative distance of neighbours


def measure() -> Bench:
    """Time every method and cold starts of the program; this takes about ten seconds."""
    blocks = [*_measure_orders()]
    for task, cases in list_engine_tasks().items():
        times = time_runs([case.run for case in cases])
        blocks.append(Block(task, _join(cases, times)))
    return Bench.of(blocks, compare_starts(V8))


def _join(cases: list[Case], times: list[Times]) -> tuple[Measured, ...]:
    """Return the methods with their run times."""
    measured = []
    for case, seconds in zip(cases, times, strict=True):
        measured.append(Measured(case.method, case.approach, seconds, case.errors))
    return tuple(measured)


def _measure_orders() -> Iterator[Block]:
    task = "orders of one cylinder"
    methods = list(list_methods(ORDERS))
    cases = {lam: list(_list_cases(methods, lam)) for lam in RATIOS}
    for lam in RATIOS:
        times = time_runs([case.run for case in cases[lam]])
        yield Block(task, _join(cases[lam], times), 1, lam)
    for lam in RATIOS:
        side_by_side = lam * (1 - _NEAR * np.arange(MANY) / MANY)
        times = time_shares(methods, side_by_side)
        yield Block(task, _join(cases[lam], times), MANY, lam)


def _list_cases(methods: list[Method], lam: float) -> Iterator[Case]:
    only = np.array([lam])
    for method, errors in zip(methods, measure_errors(methods, lam), strict=True):
        yield Case(method.name, method.approach, partial(method.find, only), errors)


def measure_errors(methods: list[Method], lam: float) -> Iterator[Errors]:
    """Yield the errors of each method at every order, relative to this order: the largest at
    several λ that are almost the same.
    """
    near = [lam * (1 + _STEP * k) for k in range(_NEIGHBOURS)]
    exact = np.empty((len(ORDERS), len(near)))
    for row, order in enumerate(ORDERS):
        exact[row] = [find_exactly(order, ratio) for ratio in near]
    for method in methods:
        relative = np.abs(method.find(np.array(near)) - exact) / np.abs(exact)
        largest = relative.max(axis=1).tolist()
        yield tuple(map(OrderError, ORDERS, largest))

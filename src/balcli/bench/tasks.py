"""Compute error and run time of every method of every task."""

from __future__ import annotations

import os
import time
import timeit
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import NamedTuple, TypeAlias

import numpy as np

from ..analysis.answer import analyze
from ..core.phasors import Array, Complex
from ..crank_torque.answer import torque
from ..engine.build import build
from ..engine.engine import Engine
from ..engine.parse import parse
from ..torsional_vibration.answer import torsion
from .methods import Method, find_exactly, list_methods, tell_degrees
from .records import Approach, Bench, Block, Measured, OrderError, Times
from .starts import compare_starts

RATIOS = (0.25, 0.6, 0.95)
ORDERS = [2, 8, 16]
MANY = 100_000  # variants
_CLOCK = time.perf_counter if os.name == "nt" else time.process_time  # Windows' is too coarse
_ROUNDS = 9
_SHORTEST = 2e-3  # s: what is shorter is repeated within one measurement
_SHARES = 10  # of many variants, each of which is timed
_NEAR = 1e-3  # relative range of the λ of many variants
_NEIGHBOURS = 9  # λ at which an error is measured: a rounding error at one λ may be small by chance
_STEP = 1e-6  # relative distance of neighbours

V8 = """
name = "72-degree V8, uneven throws"
[crank]
stroke = 90
throws = [0, 100, 250, 190]      # no order is balanced, so that relative errors mean something
spacing = 110
throw_mass = 1.2
[rod]
ratio = 0.28
mass = 0.6
cg = 45
inertia = 4000
[piston]
mass = 0.5
[layout]
bank_angle = 72
stagger = 22
"""
SINGLE_WITH_GAS = """
name = "single with gas"
[crank]
stroke = 90
[rod]
ratio = 0.28
[piston]
mass = 0.5
bore = 86
[layout]
firing_order = [1]
[operation]
speed = 3000
[gas]
cycle = "wiebe"
compression_ratio = 10
imep = 10
burn_start = -15
burn_duration = 50
"""
GAS_ORDERS = [0.5, 6.0, 24.0]
CHAIN = """
name = "three inertias, six orders"
node = [
    { name = "crank", inertia = "0.05 kg m^2" },
    { name = "flywheel", inertia = "0.8 kg m^2" },
    { name = "load", inertia = "1.5 kg m^2" },
]
shaft = [
    { from = "crank", to = "flywheel", stiffness = 2e5, damping = 12 },
    { from = "flywheel", to = "load", stiffness = 5e4, damping = 8 },
]
excitation = [
    { node = "crank", order = 0.5, cos = 60, sin = 20 },
    { node = "crank", order = 1, cos = -30, sin = 45 },
    { node = "crank", order = 1.5, cos = 80, sin = -10 },
    { node = "crank", order = 2, cos = 120, sin = -35 },
    { node = "crank", order = 3, cos = 40, sin = 25 },
    { node = "crank", order = 4, cos = 15, sin = -20 },
]
"""
CHAIN_RPM = 2400.0


Run: TypeAlias = Callable[[], object]
Errors: TypeAlias = tuple[OrderError, ...]


class Case(NamedTuple):
    """A method of a task, before its time is measured.

    Attributes:
        method: Its name.
        approach: How it computes.
        run: What is timed.
        errors: Errors of its result.
    """

    method: str
    approach: Approach
    run: Run
    errors: Errors


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


# ------------------------------------------------------------------ orders of one cylinder
def _measure_orders() -> Iterator[Block]:
    task = "orders of one cylinder"
    methods = list(list_methods(ORDERS))
    cases = {lam: list(_list_cases(methods, lam)) for lam in RATIOS}
    for lam in RATIOS:
        times = time_runs([case.run for case in cases[lam]])
        yield Block(task, _join(cases[lam], times), 1, lam)
    for lam in RATIOS:
        side_by_side = lam * (1 - _NEAR * np.arange(MANY) / MANY)
        times = _time_shares(methods, side_by_side)
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


def _time_shares(methods: list[Method], lam: Array) -> list[Times]:
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


# ------------------------------------------------------------------ whole engines
def list_engine_tasks() -> dict[str, list[Case]]:
    """Return the methods of the tasks of whole engines, by task."""
    return {
        "largest force of a V8": list(_list_peaks()),
        "orders of gas torque": list(_list_gas_orders()),
        "vibratory torque of a shaft": list(_list_torsion()),
    }


def _list_peaks() -> Iterator[Case]:
    engine = build(parse(V8))
    exact = _climb(engine)
    for step in (5.0, 1.0, 0.1):
        angles = np.radians(np.arange(0.0, 360.0, step))

        def search_grid(angles: Array = angles) -> float:
            return float(np.abs(find_force(engine, angles)).max())

        yield _case(f"grid of {tell_degrees(step)}", "samples", search_grid, exact)

    def ask() -> float:
        return analyze(engine, only="peak").peak.force.value

    yield _case("analyze: maximum of the curve", "exact", ask, exact)


def _case(method: str, approach: Approach, run: Callable[[], float], exact: float) -> Case:
    error = abs(run() - exact) / abs(exact)
    return Case(method, approach, run, (OrderError(None, error),))


def find_force(engine: Engine, angles: Array) -> Complex:
    """Return the force of an engine of centred slider-cranks at crank angles (rad), N, by plain
    numpy.
    """
    c = engine.cylinders
    psi = angles + np.radians(c.angle_deg)[:, None]
    lam = float(c.lam[0])
    secant = 1 / np.sqrt(1 - (lam * np.sin(psi)) ** 2)
    acceleration = np.cos(psi) + lam * secant * ((np.cos(psi) * secant) ** 2 - np.sin(psi) ** 2)
    scale = float(c.radius[0]) * float(engine.omega) ** 2
    reciprocating = float(c.reciprocating[0])
    rotating = float(c.rotating[0])
    along = np.exp(1j * np.radians(c.axis_of_each_deg))[:, None]
    force = reciprocating * acceleration + rotating * np.exp(1j * psi)
    return np.asarray(scale * (along * force).sum(axis=0))


def _climb(engine: Engine) -> float:
    """Return the largest force, by grids that close in on it."""
    middle = 0.0
    width = np.pi
    for _ in range(12):
        angles = middle + np.linspace(-width, width, 401)
        sizes = np.abs(find_force(engine, angles))
        middle = float(angles[np.argmax(sizes)])
        width /= 50
    return float(sizes.max())


def _list_gas_orders() -> Iterator[Case]:
    engine = build(parse(SINGLE_WITH_GAS))
    curve = torque(engine, GAS_ORDERS).curve
    exact = _integrate(curve.breaks, curve.at)
    for step in (1.0, 0.25):
        angles = np.radians(np.arange(0.0, 720.0, step))

        def add_steps(angles: Array = angles) -> Complex:
            waves = np.exp(-1j * np.outer(GAS_ORDERS, angles))
            return np.asarray(2 / len(angles) * waves @ curve.at(angles))

        name = f"{len(angles)} steps over the cycle"
        yield Case(name, "samples", add_steps, _compare(add_steps(), exact))

    def add_pieces() -> Complex:
        return curve.harmonics(np.array(GAS_ORDERS) * 2)

    yield Case("exact pieces", "exact", add_pieces, _compare(add_pieces(), exact))


def _integrate(breaks: Array, at: Callable[[Array], Array]) -> Complex:
    """Return the orders of a curve by 40 Gauss points between its breaks."""
    nodes, weights = np.polynomial.legendre.leggauss(40)
    half = np.diff(breaks) / 2
    angles = (breaks[:-1] + half)[:, None] + half[:, None] * nodes
    values = at(angles.ravel()) * (half[:, None] * weights).ravel()
    waves = np.exp(-1j * np.outer(GAS_ORDERS, angles.ravel()))
    return np.asarray(2 / (breaks[-1] - breaks[0]) * waves @ values)


def _compare(found: Complex, exact: Complex) -> Errors:
    shares = np.abs(found - exact) / np.abs(exact)
    return tuple(OrderError(n, float(e)) for n, e in zip(GAS_ORDERS, shares, strict=True))


def _list_torsion() -> Iterator[Case]:
    orders, torques = _solve_chain()
    exact = float((_climb_wave(orders, torques) + _climb_wave(orders, -torques)) / 2)

    def add_amplitudes() -> float:
        return float(np.abs(_solve_chain()[1]).sum())

    yield _case("sum of amplitudes, dense matrices", "formula", add_amplitudes, exact)

    def ask() -> float:
        response = torsion(CHAIN, [CHAIN_RPM]).response
        return float(response.shafts[0].half_peak_to_peak_Nm[0])

    yield _case("torsion: synthesis of all orders", "exact", ask, exact)


def _climb_wave(orders: Array, torques: Complex) -> float:
    """Return the largest value of a sum of orders over two revolutions."""
    middle = 2 * np.pi
    width = 2 * np.pi
    for _ in range(8):
        angles = middle + np.linspace(-width, width, 2001)
        values = (torques @ np.exp(1j * np.outer(orders, angles))).real
        middle = float(angles[np.argmax(values)])
        width /= 100
    return float(values.max())


def _solve_chain() -> tuple[Array, Complex]:
    """Return the orders, and the torque of each order in the first shaft of CHAIN, N m."""
    inertia = np.diag([0.05, 0.8, 1.5])
    stiffness = np.array([[2e5, -2e5, 0], [-2e5, 2.5e5, -5e4], [0, -5e4, 5e4]])
    damping = np.array([[12.0, -12, 0], [-12, 20, -8], [0, -8, 8]])
    orders = np.array([0.5, 1, 1.5, 2, 3, 4])
    loads = np.array([60 - 20j, -30 - 45j, 80 + 10j, 120 + 35j, 40 - 25j, 15 + 20j])
    torques = []
    for order, load in zip(orders, loads, strict=True):
        w = order * CHAIN_RPM * np.pi / 30
        dynamic = stiffness + 1j * w * damping - w**2 * inertia
        angles = np.linalg.solve(dynamic, np.array([load, 0, 0]))
        torques.append((2e5 + 12j * w) * (angles[1] - angles[0]))
    return orders, np.array(torques)


# ------------------------------------------------------------------ run times
def time_runs(runs: Sequence[Run]) -> list[Times]:
    """Return the time of each run, s: quartiles of several measurements of at least 2 ms. The runs
    take turns, so that what else the machine does slows all of them.
    """
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


def _find_quartiles(rounds: list[list[float]]) -> list[Times]:
    """Return the quartiles of each column."""
    quartiles = np.quantile(rounds, [0.25, 0.5, 0.75], axis=0)
    return [Times(*column) for column in quartiles.T.tolist()]

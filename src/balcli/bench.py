"""Measure run time and error of several methods that compute the same forces, on this machine.

The methods are the two-term formula, the power series that books print, the closed form (balcli
itself), the FFT of samples, and differences of the piston's position (time stepping). All methods
but the closed form are written in plain numpy. Errors are relative to results from exact fractions.

The result is shown as a table, JSON or CSV.
"""

from __future__ import annotations

import os
import subprocess
import sys
import time
import timeit
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from .core.mechanisms import power_series
from .core.phasors import Array, Complex
from .engine.build import build
from .engine.engine import Engine
from .engine.parse import parse
from .forces.spectrum import compute_spectra
from .show.formats import Renderer, Rows
from .show.sheet import Column, Grid, Sheet, capitalized, number

if TYPE_CHECKING:
    from .show.units import System


ORDERS = [1, 2, 4, 6, 8]
POWERS = (3, 5, 7)  # highest powers of lambda in series that books print
POINTS = (8, 16, 32, 64)
STEPS = (64, 360, 720, 3600)
EXACT_POWER = 81  # lambda^81 is below 1e-40 at lambda = 0.3
CYLINDER = """
[crank]
stroke = 90
[rod]
ratio = 0.28
[piston]
mass = 0.5
"""
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
LIBRARIES = "import numpy, typer; from pydantic import BaseModel"
SMALLEST = """
import numpy, typer
from pydantic import BaseModel

def main(number: float = 1.0) -> None:
    pass

typer.run(main)
"""
_PAIRS = 9
_SHORTEST = 1e-7  # s; shorter run times are replaced by this one


@dataclass(frozen=True, kw_only=True)
class Row:
    """Run time and error of one method for one task.

    Attributes:
        task: Name of the task.
        method: Name of the method.
        seconds: Run time of one computation, s.
        error: Largest relative error.
    """

    task: str
    method: str
    seconds: float
    error: float


@dataclass(frozen=True, kw_only=True)
class Ratio:
    """A run time as a multiple of another.

    Attributes:
        what: Names of both runs, with a slash between them.
        value: The ratio.
    """

    what: str
    value: float


@dataclass(frozen=True, kw_only=True)
class Bench:
    """Results of one run of the benchmark.

    Attributes:
        rows: Run time and error of every method.
        ratios: Ratios of run times; the two programs of a ratio are started alternately.
    """

    format: Literal["balcli.bench/1"] = "balcli.bench/1"
    rows: tuple[Row, ...]
    ratios: tuple[Ratio, ...]


class Case(NamedTuple):
    """A run to be timed, and the error of its result."""

    task: str
    method: str
    run: Callable[[], object]
    error: float


def measure() -> Bench:
    """Time every method and cold starts of the program; this takes about ten seconds."""
    rows = tuple(
        Row(task=case.task, method=case.method, seconds=time_run(case.run), error=case.error)
        for case in list_cases()
    )
    return Bench(rows=rows, ratios=tuple(compare_starts()))


def list_cases() -> Iterator[Case]:
    """Yield a case for every method of every task."""
    cylinder = build(parse(CYLINDER))
    v8 = build(parse(V8))
    for task, engine, orders in (
        ("one cylinder, order 2", cylinder, [2]),
        ("one cylinder, order 8", cylinder, [8]),
        ("one V8, force and moment", v8, ORDERS),
    ):
        for name, way in WAYS.items():
            error = find_error(engine, way, orders)
            yield Case(task, name, partial(way, engine, orders), error)


# ------------------------------------------------------------------ coefficients A_n of cos(n psi)
# Acceleration of the piston / (crank radius * crank speed squared) = sum A_n cos(n psi), with the
# angle psi of the crank pin from the cylinder's axis. lambda (`lam`): crank radius / rod length.
Coefficients = Callable[[list[int], float], Array]


def find_exactly(orders: list[int], lam: float) -> Array:
    """Return A_n, computed in exact fractions and rounded once to a float."""
    x = Fraction(lam)
    series = (power_series.piston(n, EXACT_POWER).items() for n in orders)
    return np.array([float(sum(c * x**p for p, c in terms)) for terms in series])


def _use_two_terms(orders: list[int], lam: float) -> Array:
    """Return A_n of the two-term acceleration cos psi + lambda cos 2 psi."""
    return np.array([{1: 1.0, 2: lam}.get(n, 0.0) for n in orders])


def _cut_series(power: int) -> Coefficients:
    terms = {
        n: [(p, float(c)) for p, c in power_series.piston(n, power).items() if p <= power]
        for n in range(1, 65)
    }

    def add_up(orders: list[int], lam: float) -> Array:
        return np.array([sum(c * lam**p for p, c in terms[n]) for n in orders])

    return add_up


def _accelerate(psi: Array, lam: float) -> Array:
    """Return the acceleration of the piston, divided by crank radius times crank speed squared."""
    cosine = np.cos(psi)
    sine = np.sin(psi)
    cos_beta = np.sqrt(1 - (lam * sine) ** 2)
    return cosine - lam * sine**2 / cos_beta + lam * cosine**2 / cos_beta**3


# ------------------------------------------------------------------ force and moment of an engine
Way = Callable[[Engine, list[int]], Complex]  # shape (force and moment, orders, directions)


def _add_up(find: Coefficients) -> Way:
    """Return a method that sums the vectors of all cylinders, with A_n from `find`."""

    def evaluate(engine: Engine, orders: list[int]) -> Complex:
        reciprocating, rotating, axis, phase, z = _list_columns(engine)
        n = np.array(orders)[:, None]
        c = reciprocating * find(orders, float(engine.cylinders.lam[0]))[:, None] / 2
        forward = (c + rotating * (n == 1)) * np.exp(1j * (axis + n * phase))
        backward = c * np.exp(1j * (axis - n * phase))
        both = np.stack([forward, backward], axis=-1)
        return np.stack([both.sum(axis=1), 1j * (z[:, None] * both).sum(axis=1)])

    return evaluate


def use_balcli(engine: Engine, orders: list[int]) -> Complex:
    """Return force and moment as balcli computes them."""
    found = compute_spectra(engine, orders, ("force", "moment"))
    return np.array([(p.forward, p.backward) for _, p in found.items()]).transpose(0, 2, 1)


def _sample(points: int, force_of: Callable[[Array, float, float, float], Complex]) -> Way:
    """Return a method that samples the cylinders' forces over a revolution and takes the FFT of
    their sums.
    """

    def evaluate(engine: Engine, orders: list[int]) -> Complex:
        reciprocating, rotating, axis, phase, z = _list_columns(engine)
        psi = 2 * np.pi * np.arange(points) / points + phase[:, None]
        force = force_of(psi, float(engine.cylinders.lam[0]), reciprocating, rotating)
        force = force * np.exp(1j * axis)[:, None]
        curves = np.stack([force.sum(axis=0), 1j * (z[:, None] * force).sum(axis=0)])
        lines = np.fft.fft(curves) / points
        n = np.array(orders)
        both = np.stack([lines[:, n % points], lines[:, -n % points]], axis=-1)
        return np.where(2 * n[:, None] < points, both, 0)  # too few points for higher orders

    return evaluate


def _force_at_angles(psi: Array, lam: float, reciprocating: float, rotating: float) -> Complex:
    return reciprocating * _accelerate(psi, lam) + rotating * np.exp(1j * psi)


def _force_of_steps(psi: Array, lam: float, reciprocating: float, rotating: float) -> Complex:
    """Return the force by central differences of the position, over one revolution."""
    piston = np.cos(psi) + np.sqrt(1 - (lam * np.sin(psi)) ** 2) / lam  # position / radius
    place = reciprocating * piston + rotating * np.exp(1j * psi)
    step = 2 * np.pi / psi.shape[-1]
    return (2 * place - np.roll(place, -1, axis=-1) - np.roll(place, 1, axis=-1)) / step**2


def _list_columns(engine: Engine) -> tuple[float, float, Array, Array, Array]:
    """Return mass times crank radius times crank speed squared for the reciprocating and for the
    rotating mass of cylinder 1 (N); and of each cylinder the axis (rad), the angle of its crank pin
    from this axis at crank angle 0 (rad), and z from the point of reference (m).
    """
    c = engine.cylinders
    scale = c.radius[0] * engine.omega**2
    return (
        float(c.reciprocating[0] * scale),
        float(c.rotating[0] * scale),
        np.radians(c.axis_of_each_deg),
        np.radians(c.angle_deg),
        c.z - engine.reference_m[2],
    )


def find_error(engine: Engine, way: Way, orders: list[int]) -> float:
    """Return the largest error of a method, relative to the largest exact vector of each order."""
    exact = _add_up(find_exactly)(engine, orders)
    scale = np.abs(exact).max(axis=(0, 2), keepdims=True)
    return float((np.abs(way(engine, orders) - exact) / scale).max())


WAYS: dict[str, Way] = {
    "two-term formula": _add_up(_use_two_terms),
    **{f"series to λ^{p}": _add_up(_cut_series(p)) for p in POWERS},
    "closed form": use_balcli,
    **{f"FFT, {n} points": _sample(n, _force_at_angles) for n in POINTS},
    **{f"time stepping, {n} steps": _sample(n, _force_of_steps) for n in STEPS},
}


# ------------------------------------------------------------------ run times
def time_run(run: Callable[[], object]) -> float:
    """Return the mean time of a run, s, in the quickest of several batches (20 ms, or one run)."""
    timer = timeit.Timer(run)
    once = max(timer.timeit(1), _SHORTEST)
    number = max(int(0.02 / once), 1)
    return min(timer.repeat(5 if once < 0.2 else 2, number)) / number


def compare_starts() -> Iterator[Ratio]:
    """Yield the time of a cold start of `balcli analyze` / that of each of two other programs."""
    others = {
        "import of numpy, typer and pydantic": LIBRARIES,
        "minimal typer program that imports numpy and pydantic": SMALLEST,
    }
    for what, program in others.items():
        pairs = [
            (_start("-m", "balcli", "analyze", "-", text=V8), _start("-c", program))
            for _ in range(_PAIRS)
        ]
        first, second = np.median(pairs, axis=0)
        yield Ratio(what=f"cold balcli analyze / {what}", value=float(first / second))


def _start(*argv: str, text: str = "") -> float:
    """Return the run time of a Python program, s, with one thread of linear algebra."""
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    command = [sys.executable, *argv]
    start = time.perf_counter()
    subprocess.run(command, input=text.encode(), capture_output=True, check=True, env=environment)
    return time.perf_counter() - start


ROUNDING = 1e-13  # smaller relative errors are shown as rounding


def rows(result: Bench, _system: System) -> Rows:
    """Return the rows of the CSV: run times (s) and relative errors, then ratios."""
    cases = ((r.task, r.method, r.seconds, r.error, None) for r in result.rows)
    ratios = (("ratio", r.what, None, None, r.value) for r in result.ratios)
    return Rows(("task", "method", "seconds", "error", "ratio"), [*cases, *ratios])


def sheet(result: Bench, _system: System) -> Sheet:
    """Return a table for each task, and a table of the ratios."""
    grids = []
    for task in dict.fromkeys(r.task for r in result.rows):
        shown = [r for r in result.rows if r.task == task]
        errors = ["rounding" if r.error < ROUNDING else f"{r.error:.1e}" for r in shown]
        columns = [
            Column("method", [r.method for r in shown], words=True),
            Column("µs", [number(r.seconds * 1e6, 3) for r in shown]),
            Column("relative error", errors),
        ]
        grids.append(Grid(capitalized(task), columns))
    ratios = [
        Column("", [ratio.what for ratio in result.ratios], words=True),
        Column("ratio", [number(ratio.value, 3) for ratio in result.ratios]),
    ]
    grids.append(Grid("Ratios of run times", ratios))
    return Sheet("Run time against error", tuple(grids))


RENDERER = Renderer(sheet=sheet, rows=rows)

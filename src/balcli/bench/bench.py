"""Run time against error of every way to the same figures, on this machine."""

from __future__ import annotations

import os
import subprocess
import sys
import timeit
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial
from itertools import count
from typing import Any

import numpy as np

from ..core.phasors import EPS
from ..engine.build import Engine, build
from ..engine.load import parse
from ..enginefile.model import EngineFile
from ..forces.kinds import KINDS
from ..forces.quantity import parse as quantities
from ..forces.spectrum import spectra
from ..results.analysis import analyze
from ..studies.parameters import Parameter, ladder
from ..studies.sweep import CHUNK, Sweep, chunks
from . import methods

LAM = 0.28
ORDERS = [1, 2, 4, 6, 8]
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


@dataclass(frozen=True)
class Row:
    """One way to one figure: seconds (a variant, of a sweep), and the largest relative error; None:
    not meaningful.
    """

    task: str
    method: str
    seconds: float
    error: float | None


@dataclass(frozen=True)
class Ratio:
    """Two run times, the one as a multiple of the other."""

    what: str
    value: float


@dataclass(frozen=True)
class Bench:
    """Everything measured in one run."""

    rows: tuple[Row, ...]
    ratios: tuple[Ratio, ...]


@dataclass(frozen=True)
class Case:
    """A way to be timed: `run` does the work `times` times over, `error` is that of its result."""

    task: str
    method: str
    run: Callable[[], Any]
    error: float | None
    times: int = 1


def bench() -> Bench:
    """All tasks and ratios; about ten seconds."""
    return Bench(
        tuple(Row(c.task, c.method, _seconds(c.run) / c.times, c.error) for c in cases()),
        tuple(ratios()),
    )


def cases() -> Iterator[Case]:
    """All that is timed, with its error."""
    yield from _coefficient()
    yield from _engine()
    yield from _sweep()


def _coefficient() -> Iterator[Case]:
    ways: list[tuple[str, methods.Coefficients]] = [
        ("two-term formula", methods.two_term),
        *((f"series to λ^{p}", methods.printed(p)) for p in methods.POWERS),
        ("closed form", methods.find_closed_form),
        *((f"FFT, {n} points", methods.transformed(n)) for n in methods.POINTS),
        *((f"time stepping, {n} steps", methods.stepped(n)) for n in methods.SAMPLES),
    ]
    for orders, task in (([2], "A_2"), ([8], "A_8")):
        exact = methods.exact(orders, LAM)
        for name, find in ways:
            yield Case(task, name, partial(find, orders, LAM), _worst(find(orders, LAM), exact))


def _engine() -> Iterator[Case]:
    engine, find = build(parse(V8)), methods.from_coefficients
    exact = find(methods.exact)(engine, ORDERS)
    ways: list[tuple[str, methods.Vectors]] = [
        ("two-term formula", find(methods.two_term)),
        *((f"series to λ^{p}", find(methods.printed(p))) for p in methods.POWERS),
        ("closed form", methods.of_engine),
        *((f"FFT, {n} points", methods.sampled(n)) for n in methods.POINTS),
        *((f"time stepping, {n} steps", methods.time_stepped(n)) for n in methods.SAMPLES),
    ]
    for name, way in ways:
        yield Case(
            "one V8, force and moment",
            name,
            partial(way, engine, ORDERS),
            _worst(way(engine, ORDERS), exact, axis=(0, 2)),
        )


def _sweep() -> Iterator[Case]:
    """A V8 over bank angles and rod ratios, orders 1 and 2 of force and moment."""
    file, task = parse(V8), "sweep of a V8, a variant"
    grid, few = _grid(file, *_parameters(512, 128)), _grid(file, *_parameters(2, 2))
    yield Case(
        task,
        "closed form, as arrays",
        lambda: list(chunks(grid)),
        _swept(few, methods.of_engine),
        grid.variants,
    )
    ways = [
        ("closed form, engine by engine", methods.of_engine),
        ("FFT, 16 points, engine by engine", methods.sampled(16)),
        ("time stepping, 360 steps, engine by engine", methods.time_stepped(360)),
    ]
    for name, way in ways:
        yield Case(task, name, partial(_one_by_one, few, way), _swept(few, way), few.variants)
    angles = np.random.default_rng(1).uniform(0, 7, 8 * CHUNK)
    yield Case(
        task, "np.exp(1j*x) of its 8 crank angles alone", lambda: np.exp(1j * angles), None, CHUNK
    )


def _grid(file: EngineFile, *parameters: Parameter) -> Sweep:
    return Sweep(
        file, parameters, quantities("force.1.major,force.2.major,moment.1.major,moment.2.major")
    )


def _parameters(banks: int, ratios: int) -> tuple[Parameter, Parameter]:
    return (
        Parameter("layout.bank_angle", ladder(Fraction(40), Fraction(1, 5), banks)),
        Parameter("rod.ratio", ladder(Fraction(1, 5), Fraction(1, 1000), ratios)),
    )


def _engines(sweep: Sweep) -> Iterator[Engine]:
    first, second = sweep.parameters
    for k in range(len(first)):
        for j in range(len(second)):
            yield build(_set(sweep.file, float(first.values[k]), float(second.values[j])))


def _set(file: EngineFile, angle: float, ratio: float) -> EngineFile:
    return file.model_copy(
        update={
            "layout": file.layout.model_copy(update={"bank_angle": angle}),
            "rod": file.rod.model_copy(update={"ratio": ratio}),
        }
    )


def _one_by_one(sweep: Sweep, way: methods.Vectors) -> list[Any]:
    return [way(engine, [1, 2]) for engine in _engines(sweep)]


def _swept(sweep: Sweep, way: methods.Vectors) -> float:
    exact = methods.from_coefficients(methods.exact)
    return max(
        _worst(way(engine, [1, 2]), exact(engine, [1, 2]), axis=(0, 2))
        for engine in _engines(sweep)
    )


def _worst(found: Any, exact: Any, axis: tuple[int, ...] = ()) -> float:
    """The largest error relative to the largest exact value of its order (`axis`: what belongs to
    one order).
    """
    scale = np.abs(exact).max(axis=axis, keepdims=True) if axis else np.abs(exact)
    return float((np.abs(found - exact) / scale).max())


# ------------------------------------------------------------------ what is saved by not doing it
def ratios() -> Iterator[Ratio]:
    """Pairs of run times, measured in turn."""
    file = parse(V8)
    engine = build(file)
    unequal = build(
        file.model_copy(
            update={
                "cylinder": parse(
                    V8 + "[cylinder.3]\npiston_mass = 0.51\nrod_ratio = 0.281\n"
                ).cylinder
            }
        )
    )
    forces = ("force", "moment")
    long, short = np.arange(1.0, 33.0), [1.0, 2.0]
    plain = partial(methods.sampled(64), engine, list(range(1, 9)))
    eight = np.arange(1.0, 9.0)
    yield _ratio(
        "force and moment of a V8, orders 1-8, to plain numpy (64 angles, FFT)",
        lambda: spectra(engine, eight, forces),
        plain,
    )
    another = _unseen(engine)
    yield _ratio(
        "the same of a V8 not seen before", lambda: spectra(another(), eight, forces), plain
    )
    yield _ratio("all quantities of it to the same", lambda: spectra(engine, eight, KINDS), plain)
    yield _ratio(
        "orders: 1-32 to 1 and 2",
        lambda: spectra(engine, long, forces),
        lambda: spectra(engine, short, forces),
    )
    yield _ratio(
        "moments: force and moment to force",
        lambda: spectra(engine, eight, forces),
        lambda: spectra(engine, eight, ("force",)),
    )
    yield _ratio(
        "equal cylinders: unequal to equal",
        lambda: spectra(unequal, eight, forces),
        lambda: spectra(engine, eight, forces),
    )
    yield _ratio(
        "peaks: force with peak to force",
        lambda: analyze(engine, [1, 2], {"force", "peak"}),
        lambda: analyze(engine, [1, 2], {"force"}),
    )
    yield from _imports()
    array, exponential = (c for c in _sweep() if "array" in c.method or "exp(" in c.method)
    unit = _seconds(exponential.run) / exponential.times
    throw = _grid(
        file, Parameter("crank.throws.2", ladder(Fraction(40), Fraction(1, 1000), 2 * CHUNK))
    )
    yield Ratio(
        "a variant of a sweep to np.exp(1j*x) of its 8 crank angles",
        _seconds(array.run) / array.times / unit,
    )
    yield Ratio(
        "a variant of a sweep of one throw to the same",
        _seconds(lambda: list(chunks(throw))) / throw.variants / unit,
    )


def _unseen(engine: Engine) -> Callable[[], Engine]:
    """Engines of which nothing is kept from an earlier call: each has a lambda of its own."""
    ulps, c = count(1), engine.cylinders
    return lambda: replace(engine, cylinders=replace(c, lam=c.lam * (1 + next(ulps) * EPS)))


def _imports() -> Iterator[
    Ratio
]:  # pragma: no cover: measures cold starts for minutes; the tests leave it out
    """Cold starts of the whole program."""

    def start(*argv: str) -> Callable[[], Any]:
        return lambda: subprocess.run(
            [sys.executable, *argv],
            input=V8.encode(),
            capture_output=True,
            check=True,
            env=os.environ,
        )

    floor = start("-c", "import numpy, typer; from pydantic import BaseModel")
    for argv in ("analyze - --format json", "analyze -", "--help"):
        yield _ratio(
            f"imports: cold balcli {argv} to importing numpy, typer and pydantic",
            start("-m", "balcli", *argv.split()),
            floor,
        )


def _ratio(what: str, one: Callable[[], Any], other: Callable[[], Any]) -> Ratio:
    """Measured in turn, so that a busy machine disturbs both alike."""
    number = max(int(0.01 / max(timeit.timeit(other, number=1), 1e-7)), 1)
    pairs = [
        (timeit.timeit(one, number=number), timeit.timeit(other, number=number)) for _ in range(9)
    ]
    first, second = (float(np.median(times)) for times in zip(*pairs, strict=True))
    return Ratio(what, first / second)


def _seconds(run: Callable[[], Any]) -> float:
    """The quickest of several runs, each of at least a few milliseconds."""
    timer = timeit.Timer(run)
    once = max(timer.timeit(1), 1e-7)
    number = max(int(0.02 / once), 1)
    return min(timer.repeat(5 if once < 0.2 else 2, number)) / number

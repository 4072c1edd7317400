"""Run time against error of every way to the same figures, on this machine."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ..core.phasors import Array, Complex
from ..engine.build import Engine, build
from ..engine.load import parse
from ..enginefile import examples
from ..forces.kinds import DEFAULT_QUANTITIES, KINDS
from ..forces.spectrum import compute_spectra
from ..results.analysis import analyze
from ..studies.parameters import Parameter, ladder
from ..studies.quantities import parse_quantities
from ..studies.sweep import CHUNK, Sweep
from . import methods
from .cold_start import start_balcli, start_libraries, start_smallest
from .stopwatch import compare_programs, compare_times, time_run
from .sweeps import OuterProduct, run_sweep, sample_sweeps, sweep_peaks

LAM = 0.28
ORDERS = [1, 2, 4, 6, 8]
SWEPT_ORDERS = [1, 2]
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
    """One way to one figure.

    Attributes:
        seconds: of one run; of a sweep, for each variant.
        error: the largest relative error; None: not meaningful.
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
    run: Callable[[], object]
    error: float | None
    times: int = 1

    def time(self) -> float:
        """Seconds for the work done once."""
        return time_run(self.run) / self.times


def bench() -> Bench:
    """All tasks and ratios; about ten seconds."""
    rows = tuple(Row(case.task, case.method, case.time(), case.error) for case in cases())
    return Bench(rows, tuple(ratios()))


def cases() -> Iterator[Case]:
    """All that is timed, with its error."""
    yield from _coefficient_cases()
    yield from _engine_cases()
    yield from _sweep_cases()


def _coefficient_cases() -> Iterator[Case]:
    ways: list[tuple[str, methods.Coefficients]] = [
        ("two-term formula", methods.two_term),
        *((f"series to λ^{p}", methods.printed(p)) for p in methods.POWERS),
        ("closed form", methods.find_closed_form),
        *((f"FFT, {n} points", methods.transformed(n)) for n in methods.POINTS),
        *((f"time stepping, {n} steps", methods.stepped(n)) for n in methods.SAMPLES),
    ]
    for order in (2, 8):
        exact = methods.exact([order], LAM)
        for name, find in ways:
            error = _largest_error(find([order], LAM), exact)
            yield Case(f"A_{order}", name, partial(find, [order], LAM), error)


def _engine_cases() -> Iterator[Case]:
    engine, task = build(parse(V8)), "one V8, force and moment"
    add_up = methods.from_coefficients
    exact = add_up(methods.exact)(engine, ORDERS)
    ways: list[tuple[str, methods.Vectors]] = [
        ("two-term formula", add_up(methods.two_term)),
        *((f"series to λ^{p}", add_up(methods.printed(p))) for p in methods.POWERS),
        ("closed form", methods.of_engine),
        *((f"FFT, {n} points", methods.sampled(n)) for n in methods.POINTS),
        *((f"time stepping, {n} steps", methods.time_stepped(n)) for n in methods.SAMPLES),
    ]
    for name, way in ways:
        error = _largest_error_of_orders(way(engine, ORDERS), exact)
        yield Case(task, name, partial(way, engine, ORDERS), error)


def _sweep_cases() -> Iterator[Case]:
    """A V8 over bank angles and rod ratios, orders 1 and 2 of force and moment."""
    task, few = "sweep of a V8, a variant", _grid(2, 2)
    yield _array_case()
    ways = [
        ("closed form, engine by engine", methods.of_engine),
        ("FFT, 16 points, engine by engine", methods.sampled(16)),
        ("time stepping, 360 steps, engine by engine", methods.time_stepped(360)),
    ]
    for name, way in ways:
        run = partial(_run_one_by_one, few, way)
        yield Case(task, name, run, _largest_error_of_sweep(few, way), few.variants)
    yield _exponential_case()
    for name, sweep, each in sample_sweeps(V8):
        task = "sweeps of sampled mechanisms, a variant and cylinder"
        yield Case(task, name, partial(run_sweep, sweep), None, sweep.variants * each)
    peaks = sweep_peaks(V8)
    task, name = "peaks of a sweep, each", "force and moment of a V8"
    yield Case(task, name, partial(run_sweep, peaks), None, 2 * peaks.variants)


def _array_case() -> Case:
    """The sweep as balcli computes it."""
    grid = _grid(1024, 512)
    error = _largest_error_of_sweep(_grid(2, 2), methods.of_engine)
    run = partial(run_sweep, grid)
    return Case("sweep of a V8, a variant", "closed form, as arrays", run, error, grid.variants)


def _exponential_case() -> Case:
    """What a variant costs at least, if each has crank angles of its own."""
    angles = np.random.default_rng(1).uniform(0, 7, 8 * CHUNK)
    name = "np.exp(1j*x) of its 8 crank angles alone"
    return Case("sweep of a V8, a variant", name, lambda: np.exp(1j * angles), None, CHUNK)


def _grid(banks: int, ratios: int) -> Sweep:
    """The V8 over so many bank angles and rod ratios."""
    return _sweep(
        Parameter("layout.bank_angle", ladder(Fraction(40), Fraction(1, 5), banks)),
        Parameter("rod.ratio", ladder(Fraction(1, 5), Fraction(1, 1000), ratios)),
    )


def _sweep(*parameters: Parameter) -> Sweep:
    return Sweep(parse(V8), parameters, parse_quantities(DEFAULT_QUANTITIES))


def _run_one_by_one(sweep: Sweep, way: methods.Vectors) -> None:
    for engine in _engines(sweep):
        way(engine, SWEPT_ORDERS)


def _engines(sweep: Sweep) -> Iterator[Engine]:
    angles, ratios = sweep.parameters
    for angle in angles.values:
        for ratio in ratios.values:
            file = sweep.file.with_table("layout", bank_angle=float(angle))
            yield build(file.with_table("rod", ratio=float(ratio)))


def _largest_error(found: Array, exact: Array) -> float:
    """Relative to each exact value."""
    return float(np.abs((found - exact) / exact).max())


def _largest_error_of_orders(found: Complex, exact: Complex) -> float:
    """Relative to the largest exact value of each order, for shapes (kind, order, direction)."""
    scale = np.abs(exact).max(axis=(0, 2), keepdims=True)
    return float((np.abs(found - exact) / scale).max())


def _largest_error_of_sweep(sweep: Sweep, way: methods.Vectors) -> float:
    find_exact = methods.from_coefficients(methods.exact)
    return max(
        _largest_error_of_orders(way(engine, SWEPT_ORDERS), find_exact(engine, SWEPT_ORDERS))
        for engine in _engines(sweep)
    )


# ------------------------------------------------------------------ what is saved by not doing it
def ratios() -> Iterator[Ratio]:
    """Pairs of run times, measured in turn."""
    yield from _engine_ratios()
    yield from _start_ratios()
    yield from _sweep_ratios()


def _engine_ratios() -> Iterator[Ratio]:
    engine = build(parse(V8))
    unequal = build(parse(V8 + "[cylinder.3]\npiston_mass = 0.51\nrod_ratio = 0.281\n"))
    eight: NDArray[np.float64] = np.arange(1.0, 9.0)

    def analyse(
        subject: Engine = engine,
        orders: NDArray[np.float64] = eight,
        kinds: tuple[str, ...] = ("force", "moment"),
    ) -> Callable[[], object]:
        return lambda: compute_spectra(subject, orders, kinds)

    plain = partial(methods.sampled(64), engine, list(range(1, 9)))
    what = "force and moment of a V8, orders 1-8, to plain numpy (64 angles, FFT)"
    yield Ratio(what, compare_times(analyse(), plain))
    what = "all quantities of it to the same"
    yield Ratio(what, compare_times(analyse(kinds=tuple(KINDS)), plain))
    low, many = analyse(orders=np.arange(1.0, 3.0)), analyse(orders=np.arange(1.0, 33.0))
    yield Ratio("orders: 1-32 to 1 and 2", compare_times(many, low))
    force = analyse(kinds=("force",))
    yield Ratio("moments: force and moment to force", compare_times(analyse(), force))
    what = "equal cylinders: unequal to equal"
    yield Ratio(what, compare_times(analyse(unequal), analyse()))
    without = partial(analyze, engine, [1, 2], {"force"})
    with_peak = partial(analyze, engine, [1, 2], {"force", "peak"})
    yield Ratio("peaks: force with peak to force", compare_times(with_peak, without))


def _start_ratios() -> Iterator[Ratio]:  # pragma: no cover: cold starts for minutes
    """Cold starts of the whole program, which the tests leave out."""
    json = "analyze - --format json"
    for argv, engine_file in (
        (json, V8),
        ("analyze -", V8),
        ("torque -", examples.text("v8_wiebe")),
        ("--help", ""),
    ):
        start = partial(start_balcli, argv.split(), engine_file)
        yield from _compare_starts(
            argv, start, "importing numpy, typer and pydantic", start_libraries
        )
    check = partial(start_balcli, ["check", str(examples.folder())])
    yield from _compare_starts(
        f"check of {len(examples.names())} engines", check, "the same", start_libraries
    )
    start = partial(start_balcli, json.split(), V8)
    yield from _compare_starts(
        json, start, "a program of these that reads one option", start_smallest
    )


def _compare_starts(
    argv: str, start: Callable[[], object], others: str, start_others: Callable[[], object]
) -> Iterator[Ratio]:  # pragma: no cover
    """Processor time, where the system tells it: numpy alone starts a thread on every core, which
    nobody waits for. And by the clock.
    """
    spent = compare_programs(start, start_others)
    what = f"imports: cold balcli {argv} to {others}"
    if not math.isnan(spent.processor):
        yield Ratio(f"{what}, processor time", spent.processor)
    yield Ratio(f"{what}, by the clock", spent.clock)


def _sweep_ratios() -> Iterator[Ratio]:
    exponential = _exponential_case().time()
    grid = _grid(1024, 512)
    some = OuterProduct(64, 512)  # of the grid, so that it stays in the cache
    share = math.prod(some.shape) / grid.variants
    what = "a variant of a sweep to the outer product of its phases and coefficients in numpy"
    yield Ratio(what, share * compare_times(partial(run_sweep, grid), some.run))
    what = "a variant of a sweep to np.exp(1j*x) of its 8 crank angles"
    yield Ratio(what, _array_case().time() / exponential)
    angles = ladder(Fraction(40), Fraction(1, 1000), 2 * CHUNK)
    throw = _sweep(Parameter("crank.throws.2", angles))
    seconds = time_run(partial(run_sweep, throw)) / throw.variants
    yield Ratio("a variant of a sweep of one throw to the same", seconds / exponential)

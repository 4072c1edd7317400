"""Run times that only developers ask for, as ratios measured in turn: python benchmarks/sweeps.py

What leaving things out saves in one engine, what a variant of a sweep costs, and how much of it
numpy alone would take.
"""

from __future__ import annotations

import timeit
from collections.abc import Callable
from functools import partial

import numpy as np

from balcli.analysis.answer import analyze
from balcli.bench.engine_tasks import V8, find_force
from balcli.bench.timing import time_runs
from balcli.engine.build import build
from balcli.engine.engine import Engine
from balcli.engine.parse import parse
from balcli.forces.kinds import DEFAULT_QUANTITIES, KINDS
from balcli.forces.spectrum import compute_spectra
from balcli.studies.parameters import Parameter
from balcli.studies.quantities import parse_quantities
from balcli.studies.sweep import Sweep, evaluate_chunks

RADIAL = """
[crank]
stroke = 120
[rod]
length = 240
mass = 1.9
cg = 55
[piston]
mass = 1.3
[layout]
radial = 7
"""
HUNG = """
[articulation]
knuckle_radius = 52
rod = { length = 188, mass = 0.62, cg = 90 }
"""
FORCES = "force.1.major,force.2.major"
OFFSETS = "".join(f"[cylinder.{n}]\npiston_offset = {3 * n}\n" for n in range(1, 9))
PAIRS = 9


def run_sweep(sweep: Sweep) -> None:
    """Compute a sweep in one thread and discard its results."""
    for _ in evaluate_chunks(sweep):
        pass


def compare(one: Callable[[], object], other: Callable[[], object]) -> float:
    """Return the run time of the one as a multiple of the other's: medians of pairs."""
    number = max(int(0.01 / max(timeit.timeit(other, number=1), 1e-7)), 1)
    pairs = [
        (timeit.timeit(one, number=number), timeit.timeit(other, number=number))
        for _ in range(PAIRS)
    ]
    first, second = np.median(pairs, axis=0)
    return float(first / second)


def compare_questions() -> None:
    """Print what is saved in one engine by not asking for something."""
    engine = build(parse(V8))
    unequal = build(parse(V8 + "[cylinder.3]\npiston_mass = 0.51\nrod_ratio = 0.281\n"))

    def spectra(
        subject: object = engine, most: int = 8, kinds: tuple[str, ...] = ("force", "moment")
    ) -> Callable[[], object]:
        return partial(compute_spectra, subject, np.arange(1.0, most + 1), kinds)

    plain = partial(transform_forces, engine, 64)
    without = partial(analyze, engine, [1, 2], {"force"})
    with_peak = partial(analyze, engine, [1, 2], {"force", "peak"})
    ratios = {
        "force and moment of a V8, orders 1-8, to an FFT of its force": (
            spectra(),
            plain,
        ),
        "all quantities of it to the same": (spectra(kinds=tuple(KINDS)), plain),
        "orders 1-32 to 1 and 2": (spectra(most=32), spectra(most=2)),
        "force and moment to force": (spectra(), spectra(kinds=("force",))),
        "unequal cylinders to equal ones": (spectra(unequal), spectra()),
        "force with peak to force": (with_peak, without),
    }
    for what, (one, other) in ratios.items():
        print(f"{compare(one, other):10.3g}  {what}")


def transform_forces(engine: Engine, points: int) -> np.ndarray:
    """Return the force of an engine by order, from samples of all forces and an FFT."""
    angles = 2 * np.pi * np.arange(points) / points
    return np.fft.fft(find_force(engine, angles)) / points


def sweep_over(
    text: str, values: dict[str, np.ndarray], quantities: str = DEFAULT_QUANTITIES
) -> Sweep:
    """Return a sweep of an engine file over values of some numbers."""
    parameters = tuple(Parameter(path, array) for path, array in values.items())
    return Sweep(parse(text), parameters, parse_quantities(quantities))


def compare_sweeps() -> None:
    """Print what a variant costs: in µs, and of a grid as a multiple of what numpy takes."""
    rotary, hung = RADIAL + "rotary = true\n", RADIAL + HUNG
    one = np.linspace
    cases = {
        "offset of one cylinder of a V8": (V8, "cylinder.1.piston_offset", one(1, 12, 2000)),
        "stroke of a V8, eight offsets": (V8 + OFFSETS, "crank.stroke", one(80, 90, 2000)),
        "rods of a rotary engine": (rotary, "rod.length", one(220, 260, 2000), FORCES),
        "knuckle pins of a radial": (
            hung,
            "articulation.knuckle_radius",
            one(50, 54, 2000),
            FORCES,
        ),
        "peaks of a V8": (V8, "rod.ratio", one(0.2, 0.3, 2000), "peak.force,peak.moment"),
        "one throw of a V8": (V8, "crank.throws.2", one(40, 140, 100_000)),
    }
    for what, (text, path, values, *quantities) in cases.items():
        sweep = sweep_over(text, {path: values}, *quantities)
        (times,) = time_runs([partial(run_sweep, sweep)])
        print(f"{times.median / len(values) * 1e6:10.3g}  µs a variant: {what}")
    grid = {"layout.bank_angle": one(40, 240, 1024), "rod.ratio": one(0.2, 0.7, 512)}
    outer, share = outer_product(64, 512), 64 / 1024
    ratio = share * compare(partial(run_sweep, sweep_over(V8, grid)), outer)
    print(f"{ratio:10.3g}  a variant of a grid to the outer product of its phases in numpy")


def outer_product(phases: int, coefficients: int) -> Callable[[], object]:
    """Return what numpy makes of a grid: amplitudes of force and moment in two orders."""
    rng = np.random.default_rng(1)
    shape = 2, 2, 2, phases, 1  # kind, order, direction of rotation
    sums = rng.normal(size=shape) + 1j * rng.normal(size=shape)
    c = rng.normal(size=(2, 1, 1, coefficients))
    rotating = np.array([1.0, 0.0]).reshape(2, 1, 1, 1)
    return lambda: [np.abs((c + rotating) * s[:, :1]) + np.abs(c * s[:, 1:]) for s in sums]


if __name__ == "__main__":
    compare_questions()
    compare_sweeps()

"""Sweeps to be timed: of mechanisms that are sampled, of peaks, and a plain grid beside what numpy
makes of it in a few lines.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..core.phasors import Array
from ..engine.load import parse
from ..enginefile.model import EngineFile
from ..forces.kinds import DEFAULT_QUANTITIES
from ..studies.parameters import Parameter
from ..studies.quantities import parse_quantities
from ..studies.sweep import Sweep, evaluate_chunks

RADIAL = """
name = "radial"
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


class TimedSweep(NamedTuple):
    """A sweep that is timed, by name, and the number of what each variant has of what counts."""

    name: str
    sweep: Sweep
    each: int


def sample_sweeps(vee: str) -> list[TimedSweep]:
    """Sweeps of mechanisms that are sampled; `vee` is the text of a V8 in line with its axes."""
    one, all_of_them, rods = "cylinder.1.piston_offset", "crank.stroke", "rod.length"
    pins, rotary = "articulation.knuckle_radius", RADIAL + "rotary = true\n"
    return [
        TimedSweep("offset of one cylinder of a V8", _vary(vee, one, 1, 12), 8),
        TimedSweep("stroke of a V8, eight offsets", _vary(vee + OFFSETS, all_of_them, 80, 90), 8),
        TimedSweep("rods of a rotary engine", _vary(rotary, rods, 220, 260, FORCES), 7),
        TimedSweep(
            "knuckle pins of a radial engine", _vary(RADIAL + HUNG, pins, 50, 54, FORCES), 7
        ),
    ]


def sweep_peaks(vee: str) -> Sweep:
    """A V8 whose peaks of force and moment are asked for."""
    return _vary(vee, "rod.ratio", 0.2, 0.3, "peak.force,peak.moment")


def _vary(
    text: str, path: str, first: float, last: float, quantities: str = DEFAULT_QUANTITIES
) -> Sweep:
    return build_timed_sweep(parse(text), {path: np.linspace(first, last, 2_000)}, quantities)


def build_timed_sweep(file: EngineFile, values: dict[str, Array], quantities: str) -> Sweep:
    """A sweep over these values of some numbers."""
    parameters = tuple(Parameter(path, array) for path, array in values.items())
    return Sweep(file, parameters, parse_quantities(quantities))


def run_sweep(sweep: Sweep) -> None:
    """All of it, by one thread, kept nowhere."""
    for _ in evaluate_chunks(sweep):
        pass


class OuterProduct:
    """What numpy makes of a grid of phases and of coefficients: amplitudes of force and moment in
    two orders, without bounds of rounding.
    """

    def __init__(self, phases: int, coefficients: int) -> None:
        self.shape = phases, coefficients
        rng = np.random.default_rng(1)
        shape = 2, 2, 2, phases, 1  # kind, order, side
        self._sums = rng.normal(size=shape) + 1j * rng.normal(size=shape)
        self._coefficients = rng.normal(size=(2, 1, 1, coefficients))
        self._turning = np.array([1.0, 0.0]).reshape(2, 1, 1, 1)

    def run(self) -> list[Array]:
        """The amplitudes, each of shape (order, 1, phases, coefficients)."""
        found = []
        for sums in self._sums:
            ahead = (self._coefficients + self._turning) * sums[:, :1]
            astern = self._coefficients * sums[:, 1:]
            found.append(np.abs(ahead) + np.abs(astern))
        return found

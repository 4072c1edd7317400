"""What a unit of weight in each plane does to each reading, from runs with trial weights.

All complex numbers here turn in the sense in which phases of readings are counted. Every speed is a
series of runs of its own: a weight that stays on counts in the later runs at that speed.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ..core.least_squares import solve
from ..core.phasors import Complex
from ..enginefile.exclusive import join_words
from ..errors import InputError, Problem
from .model import RunsFile

_ROUNDING = 1e-13  # share of the largest reading below which a change is none
_UNLIKE = (
    0.5  # of the largest reading as found, or change of one by weights: a run so far from what
)
# was foretold has a reason


class Influence(NamedTuple):
    """Readings of all speeds, one speed after the other, and what weights do to them.

    Attributes:
        speeds_rpm: of every reading; None where the file gives none. Length: readings.
        sensors: of every reading, its place in the file's list.
        coefficients: change of each reading by one unit of weight, shape (readings, planes); 0 for
            planes that are left out.
        found: readings of the rotor without weights.
        now: readings of the last run with a correction in; as found where there is none.
        start: readings from which balancing goes on: those with `on`, computed from `now` where
            something else was on; also of weights in planes that are left out.
        trimmed: name of the last run with a correction in, at whatever speed; empty if there is
            none.
        on: weights that were on in that run, shape (planes,); else 0.
    """

    speeds_rpm: tuple[float | None, ...]
    sensors: tuple[int, ...]
    coefficients: Complex
    found: Complex
    now: Complex
    start: Complex
    trimmed: str
    on: Complex

    @property
    def state(self) -> str:
        """What `now` are the readings of: as found, a run, or at several speeds the last of each
        with a correction in.
        """
        several = len(set(self.speeds_rpm)) > 1
        return ("last read" if several else self.trimmed) if self.trimmed else "as found"


class _Series(NamedTuple):
    """The runs at one speed: their numbers in the file (from 1), readings (runs, sensors) and all
    weights that are on (runs, planes).
    """

    numbers: list[int]
    readings: Complex
    on: Complex


def find_influence(file: RunsFile, left_out: frozenset[str], name: str = "") -> Influence:
    """Influence coefficients: those of the file, or by least squares over all runs at each speed
    (`change of a reading over weight` where there are just enough).

    A run that comes after the coefficients are determined has a correction in: they are made better
    by it, and balancing goes on from there.

    Raises:
        InputError: planes whose trial weight is missing, or cannot be told from another.
    """
    used = [k for k, plane in enumerate(file.planes) if plane not in left_out]
    speeds = list(dict.fromkeys(run.speed for run in file.run))
    series = [_collect_runs(file, speed) for speed in speeds]
    sensors = series[0].readings.shape[1]
    blocks = []
    trims: dict[int, Complex] = {}  # weights on in the last run with a correction in, by its number
    for k, (speed, runs) in enumerate(zip(speeds, series, strict=True)):
        trial_count = 1
        if file.influence is None:
            trial_count = _count_trials(file, runs, used, speed, name)
        coefficients, found = _find_coefficients(file, runs, used, k)
        last = len(runs.numbers) - 1
        now, on = found, np.zeros(len(file.planes), dtype=complex)
        if last >= trial_count:
            now, on = runs.readings[last], runs.on[last]
            trims[runs.numbers[last]] = on
        blocks.append((coefficients, found, now, np.zeros_like(coefficients) + on))
    coefficients, found, now, now_on = (
        np.concatenate(parts) for parts in zip(*blocks, strict=True)
    )
    keep = np.isin(np.arange(len(file.planes)), used)
    trim = max(trims, default=0)
    goes_on = trims.get(trim, np.zeros(len(file.planes), dtype=complex))
    return Influence(
        tuple(speed for speed in speeds for _ in range(sensors)),
        tuple(range(sensors)) * len(speeds),
        coefficients * keep,
        found,
        now,
        now + np.sum(coefficients * (goes_on - now_on), axis=1),
        _name_run(file, trim) if trims else "",
        goes_on,
    )


class Surprise(NamedTuple):
    """A reading far from what the runs before it foretell.

    Attributes:
        run: name of its run. sensor: its place in the file's list.
        read, foretold: the reading, and what was to be expected there.
        other_sense: whether it is as foretold if angles of weights count the other way round.
    """

    run: str
    sensor: int
    read: complex
    foretold: complex
    other_sense: bool


def find_surprise(file: RunsFile, left_out: frozenset[str]) -> Surprise | None:
    """The reading that is farthest from what the runs needed for the coefficients (or those of the
    file) foretell of it, by more than half of what there was as found or weights changed; None if
    there is none.

    Args: of runs from which influence was found.
    """
    return max(_find_surprises(file, left_out), key=_find_error, default=None)


def _find_surprises(file: RunsFile, left_out: frozenset[str]) -> Iterator[Surprise]:
    """The worst at every speed at which one is."""
    used = [k for k, plane in enumerate(file.planes) if plane not in left_out]
    for k, speed in enumerate(dict.fromkeys(run.speed for run in file.run)):
        runs = _collect_runs(file, speed)
        foretold, largest = _foretell(file, runs, used, k)
        errors = np.abs(runs.readings - foretold)
        row, sensor = np.unravel_index(int(errors.argmax()), errors.shape)
        if errors[row, sensor] > _UNLIKE * largest:
            turned, _ = _foretell(file, runs._replace(on=np.conj(runs.on)), used, k)
            near = np.abs(runs.readings - turned).max() <= _UNLIKE * largest
            yield Surprise(
                _name_run(file, runs.numbers[row]),
                int(sensor),
                complex(runs.readings[row, sensor]),
                complex(foretold[row, sensor]),
                bool(near),
            )


def _find_error(surprise: Surprise) -> float:
    return abs(surprise.read - surprise.foretold)


def _foretell(file: RunsFile, runs: _Series, used: list[int], k: int) -> tuple[Complex, float]:
    """Every reading at one speed, the k-th, by the coefficients that were known first, shape
    (runs, sensors); and the largest as found, or change of one by the weights.
    """
    first = runs
    if file.influence is None:
        count = _count_needed(_design(runs, used)) or len(runs.on)
        first = _Series(runs.numbers[:count], runs.readings[:count], runs.on[:count])
    coefficients, found = _find_coefficients(file, first, used, k)
    changes = runs.on @ coefficients.T
    foretold, largest = found + changes, float(max(np.abs(found).max(), np.abs(changes).max()))
    return np.where(np.abs(foretold) <= _ROUNDING * largest, 0, foretold), largest


def has_opposite_senses(file: RunsFile) -> bool:
    """Whether angles of weights count the other way round than phases of readings."""
    phases, weights = find_senses(file)
    return phases != weights


def find_senses(file: RunsFile) -> tuple[str, str]:
    """Whether phases of readings and angles of weights count "with" or "against" rotation."""
    phases = "against" if file.rotation == "lag" else "with"
    return phases, file.weights or phases


def name_sensor(file: RunsFile, sensor: int) -> str:
    """A sensor as the file calls it, or by its number."""
    return file.sensors[sensor] if file.sensors else f"sensor {sensor + 1}"


def _name_run(file: RunsFile, number: int) -> str:
    return file.run[number - 1].name or f"run {number}"


def _find_coefficients(
    file: RunsFile, runs: _Series, used: list[int], k: int
) -> tuple[Complex, Complex]:
    """Coefficients (sensors, planes) at one speed, the k-th, and its readings as found."""
    if file.influence is None:
        return _fit(runs, used)
    sensors = runs.readings.shape[1]
    coefficients = np.array(file.influence[k * sensors : (k + 1) * sensors], dtype=complex)
    return coefficients, _find_measured(runs, runs.readings[0] - coefficients @ runs.on[0])


def _collect_runs(file: RunsFile, speed: float | None) -> _Series:
    numbers = [k for k, run in enumerate(file.run, 1) if run.speed == speed]
    runs = [file.run[k - 1] for k in numbers]
    kept = np.zeros(len(file.planes), dtype=complex)
    states = []
    for run in runs:
        on = kept + np.array([run.weights.get(plane, 0j) for plane in file.planes])
        states.append(on)
        kept = on if run.keep_trial else kept
    on = np.array(states)
    readings = np.array([run.readings for run in runs], dtype=complex)
    return _Series(numbers, readings, np.conj(on) if has_opposite_senses(file) else on)


def _count_trials(
    file: RunsFile, runs: _Series, used: list[int], speed: float | None, name: str
) -> int:
    """How many runs, from the first, determine the rotor as found and all coefficients.

    Raises:
        InputError: if not even all of them do.
    """
    design = _design(runs, used)
    if (count := _count_needed(design)) is not None:
        return count
    at = "" if speed is None else f" at {speed:g} rpm"
    if bool(runs.on.any(axis=1).all()):
        problem = Problem(
            f"run.{runs.numbers[0]}",
            f"has weights, and so has every other run{at}; give the readings of the rotor as "
            "found, in a run without weights",
        )
        raise InputError([problem], name)
    bare = [file.planes[k] for k in used if not runs.on[:, k].any()]
    if bare:
        problem = Problem(
            "run",
            f"there is no trial weight in {join_words(bare)}{at}; add a run with one, such as "
            f'weights = {{ {bare[0]} = "10 @ 0" }}, give influence, or leave the plane out with '
            f"--without {bare[0]}",
        )
    else:
        names = [file.planes[k] for k in range(len(file.planes)) if runs.on[:, k].any()]
        problem = Problem(
            "run",
            f"the trial weights in {join_words(names)} are never apart{at}, so what each does "
            f"cannot be told; of {len(runs.numbers)} runs here, {design.shape[1]} that differ are "
            "needed: one as found, and one for each plane",
        )
    raise InputError([problem], name)


def _count_needed(design: Complex) -> int | None:
    """How many rows, from the first, have the rank of all columns; None: not even all rows do."""
    for count in range(1, len(design) + 1):
        if np.linalg.matrix_rank(design[:count]) == design.shape[1]:
            return count
    return None


def _design(runs: _Series, used: list[int]) -> Complex:
    """What each run's reading is made of: one of the rotor itself, and the weights on it in units
    of the largest; planes that are not used count only where a weight was on.
    """
    there = [k for k in range(runs.on.shape[1]) if k in used or runs.on[:, k].any()]
    largest = np.abs(runs.on).max() or 1.0
    return np.concatenate([np.ones((len(runs.on), 1)), runs.on[:, there] / largest], axis=1)


def _fit(runs: _Series, used: list[int]) -> tuple[Complex, Complex]:
    """Coefficients (sensors, planes), and readings as found."""
    planes = runs.on.shape[1]
    there = [k for k in range(planes) if k in used or runs.on[:, k].any()]
    design, largest = _design(runs, used), np.abs(runs.on).max() or 1.0
    fitted = np.array([solve(design, column).x for column in runs.readings.T])
    changes = fitted[:, 1:]
    unmoved = np.abs(changes) <= _ROUNDING * np.abs(runs.readings).max(axis=0)[:, None]
    coefficients = np.zeros((len(fitted), planes), dtype=complex)
    coefficients[:, there] = np.where(unmoved, 0, changes) / largest
    return coefficients, _find_measured(runs, fitted[:, 0])


def _find_measured(runs: _Series, fitted: Complex) -> Complex:
    """Readings as found: the mean of the runs without weights, or fitted if there are none."""
    bare = ~runs.on.any(axis=1)
    return np.asarray(runs.readings[bare].mean(axis=0)) if bare.any() else fitted

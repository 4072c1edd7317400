"""Compute influence coefficients from runs with trial weights.

At each speed, the readings V depend on the weights U by `V = V0 + alpha U` (Goodman, J. Eng. Ind.
86, 1964, 273). The influence coefficients alpha and the readings as found V0 are fitted to all runs
by least squares. With a single trial weight this is `alpha = (V - V0) / U`.

The first runs, up to the run with which all coefficients can be computed, are the trial runs. A
*correction run* comes later and has weights that differ from those of all trial runs. New weights
are added to the weights of the last correction run.

Angles of all complex numbers in this module count in the direction of the phases of readings.

For the scatter of the weights (`find_scatter`), all readings are assumed to have errors e of equal
size, which is estimated from the residuals of the fit and of the correction. To first order, the
errors change the weights by `B h e`, where h is the share of each run in the readings to cancel,
and B is the (pseudo)inverse of the coefficients. With nu complex degrees of freedom, the square of
this change divided by its estimated mean has the distribution F(2, 2 nu): it exceeds t with the
probability `(1 + t / nu)^-nu`.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import NamedTuple

import numpy as np

from ..core.least_squares import solve
from ..core.phasors import Array, Complex
from ..errors import InputError, Message, Problem
from ..file.fields import join_words
from .runs_file import RunsFile

_SAME = 1e-9  # weights that differ by less than this share of the largest are equal
_ROUNDING = 1e-13  # changes below this share of the largest reading are rounding errors
_OUTSIDE = 0.05  # probability that an unbalance is farther from its estimate than the scatter


class Series(NamedTuple):
    """The runs at one speed.

    Attributes:
        speed_rpm: Speed; None if the file gives none.
        numbers: Index of each run in the file.
        readings: Readings, shape (runs, sensors).
        weights: Weights on the rotor in each run, at the radius of their plane, shape (runs,
            planes).
        given: Influence coefficients in the file, shape (sensors, planes); None: they are fitted.
    """

    speed_rpm: float | None
    numbers: list[int]
    readings: Complex
    weights: Complex
    given: Complex | None


class Influence(NamedTuple):
    """Readings and influence coefficients of all speeds, one speed after the other.

    Attributes:
        speeds_rpm: Speed of every reading, rpm; None if the file gives none.
        coefficients: Change of each reading by one unit of weight, shape (readings, planes); 0 for
            planes that are left out.
        found: Readings of the rotor without weights, shape (readings,).
        latest: Readings of the last correction run, shape (readings,); equal to `found` at speeds
            without such a run.
        start: Readings to be corrected, shape (readings,): those of the rotor with the weights
            `weights_on`. At speeds where `latest` was read with other weights, they are computed
            from `latest`.
        factors: Weight of each reading in the sum or maximum that is minimised, shape (readings,).
        trimmed: Name of the last correction run at any speed; empty if there is none.
        weights_on: Weights on the rotor in the last correction run, shape (planes,); 0 if there is
            no such run.
    """

    speeds_rpm: tuple[float | None, ...]
    coefficients: Complex
    found: Complex
    latest: Complex
    start: Complex
    factors: Array
    trimmed: str
    weights_on: Complex

    @property
    def state(self) -> str:
        """Name of the state of the rotor in which `latest` was read."""
        if not self.trimmed:
            return "as found"
        return "last read" if len(set(self.speeds_rpm)) > 1 else self.trimmed


def collect_series(file: RunsFile) -> list[Series]:
    """Return the runs as one series for each speed, in the order of the file."""
    all_series = list[Series]()
    speeds = dict.fromkeys(run.speed for run in file.run)
    rows = file.influence and np.array(file.influence, complex)
    known = [None] * len(speeds) if rows is None else np.split(rows, len(speeds))
    for speed, given in zip(speeds, known, strict=True):
        numbers = [k for k, run in enumerate(file.run) if run.speed == speed]
        kept = np.zeros(len(file.planes), dtype=complex)
        states = []
        for run in (file.run[k] for k in numbers):
            states.append(kept + file.list_weights(run))
            kept = states[-1] if run.keep_trial else kept
        readings = np.array([file.run[k].readings for k in numbers], dtype=complex)
        all_series.append(Series(speed, numbers, readings, file.turn(np.array(states)), given))
    return all_series


def find_influence(file: RunsFile, used: Collection[int], name: str = "") -> Influence:
    """Return readings and influence coefficients. The coefficients are those of the file, or are
    fitted to all runs.

    Args:
        file: File of runs.
        used: Indices of the planes that get a weight.
        name: Name of the file for messages.

    Raises:
        InputError: The runs do not determine the coefficients of all planes.
    """
    planes = len(file.planes)
    blocks = []
    trim = -1
    goes_on = np.zeros(planes, dtype=complex)  # index and weights of the last correction
    for series in collect_series(file):
        count = count_needed(series, used)
        if count is None:
            raise InputError([_explain_undetermined(file, series, used)], name)
        alpha, as_found = fit_coefficients(series)
        latest = as_found
        on = np.zeros(planes, dtype=complex)
        if (last := find_last_correction(series, count)) is not None:
            latest = series.readings[last]
            on = series.weights[last]
            if series.numbers[last] > trim:
                trim = series.numbers[last]
                goes_on = on
        speeds = np.full(len(as_found), series.speed_rpm, dtype=object)
        blocks.append((speeds, alpha, as_found, latest, latest - alpha @ on))
    speeds, alpha, as_found, latest, bare = map(np.concatenate, zip(*blocks, strict=True))
    return Influence(
        speeds_rpm=tuple(speeds),
        coefficients=alpha * np.isin(np.arange(planes), [*used]),
        found=as_found,
        latest=latest,
        start=bare + alpha @ goes_on,
        factors=np.resize(file.reading_weights or 1.0, len(as_found)),
        trimmed="" if trim < 0 else file.name_run(trim),
        weights_on=goes_on,
    )


def fit_coefficients(series: Series) -> tuple[Complex, Complex]:
    """Return influence coefficients and readings as found at one speed.

    Returns:
        Coefficients, shape (sensors, planes), 0 for planes without weights. Readings as found,
        shape (sensors,): the mean of the runs without weights; if there are none, the fitted V0.
    """
    if series.given is not None:
        alpha = series.given
        as_found = series.readings[0] - alpha @ series.weights[0]
    else:
        design = _design(series)
        fitted = np.array([solve(design, column).x for column in series.readings.T])
        as_found = fitted[:, 0]
        changes = fitted[:, 1:]
        unmoved = np.abs(changes) <= _ROUNDING * np.abs(series.readings).max(axis=0)[:, None]
        alpha = changes * ~unmoved / (np.abs(series.weights).max() or 1.0)
    bare = ~series.weights.any(axis=1)
    return alpha, np.asarray(series.readings[bare].mean(axis=0)) if bare.any() else as_found


def find_scatter(file: RunsFile, runs: Influence, used: list[int], step: Complex) -> Array | None:
    """Return a distance for each plane: with 95 % probability, the unbalance of the plane is no
    farther than this from its estimate.

    Args:
        file: File of runs.
        runs: Influence coefficients of the runs.
        used: Indices of the planes that get a weight.
        step: Least-squares weights that cancel the readings best, shape (planes used,).

    Returns:
        Distances as amounts of weight, shape (planes used,); None if there are only as many
        readings as unknowns.
    """
    after = runs.weights_on.copy()
    blocks = collect_series(file)
    squares = 0.0
    freedom = 0
    after[used] += step
    factors = runs.factors
    gains = []  # variance of each reading to cancel, relative to that of a single reading
    for series, scale in zip(blocks, np.split(factors, len(blocks)), strict=True):
        design = _design(series)
        readings = series.readings
        if series.given is not None:
            design = design[:, :1]
            readings = readings - series.weights @ series.given.T
        inverse = np.linalg.pinv(design)
        bare = ~series.weights.any(axis=1)
        taken = bare / max(bare.sum(), 1) if bare.any() else inverse[0]
        moved = after
        if (last := find_last_correction(series, count_needed(series, used) or 0)) is not None:
            taken = np.arange(len(readings)) == last
            moved = after - series.weights[last]
        if series.given is None:
            taken = taken + moved / (np.abs(series.weights).max() or 1.0) @ inverse[1:]
        gains.append(np.full(len(scale), np.linalg.norm(taken) ** 2))
        errors = (readings - design @ (inverse @ readings)) * scale
        errors[np.abs(errors) <= _ROUNDING * np.abs(series.readings * scale).max()] = 0
        squares += float(np.sum(np.abs(errors) ** 2))
        freedom += (len(readings) - int(np.linalg.matrix_rank(design))) * len(scale)
    matrix = factors[:, None] * runs.coefficients[:, used]
    gain = np.concatenate(gains)
    left = factors * runs.start + matrix @ step
    left[np.abs(left) <= _ROUNDING * np.abs(factors * runs.found).max()] = 0
    inverse = np.linalg.pinv(matrix)
    if spare := len(left) - len(used):
        kept = np.abs(np.eye(len(left)) - matrix @ inverse) ** 2 @ gain  # variance of residuals
        squares += spare * float(np.sum(np.abs(left) ** 2) / kept.sum())
    freedom += spare
    if not freedom:
        return None
    widest = squares * (_OUTSIDE ** (-1 / freedom) - 1)
    return np.asarray(np.sqrt(widest * (np.abs(inverse) ** 2 @ gain)))


def count_needed(series: Series, used: Collection[int]) -> int | None:
    """Return how many runs, from the first on, determine V0 and all coefficients; None if all
    runs together do not determine them.

    Args:
        series: Runs at one speed.
        used: Indices of the planes that get a weight.
    """
    if series.given is not None:
        return 1
    design = _design(series)
    unknowns = _count_unknowns(series, used)
    counts = range(1, len(design) + 1)
    return next((n for n in counts if np.linalg.matrix_rank(design[:n]) == unknowns), None)


def find_last_correction(series: Series, count: int) -> int | None:
    """Return the index of the last correction run, whose weights differ from those of each of the
    first `count` runs; None if there is none.
    """
    states = series.weights
    apart = np.abs(states[:, np.newaxis] - states[:count]).max(axis=2)
    same = apart <= _SAME * np.abs(states).max()
    fresh = np.flatnonzero(~same.any(axis=1))
    return int(fresh[-1]) if len(fresh) else None


def _design(series: Series) -> Complex:
    """Return the matrix of the fit, shape (runs, 1 + planes): a column of 1, and the weights
    relative to the largest.
    """
    size = np.abs(series.weights).max() or 1.0
    return np.concatenate([np.ones((len(series.weights), 1)), series.weights / size], axis=1)


def _count_unknowns(series: Series, used: Collection[int]) -> int:
    """Return the number of unknowns of the fit: V0, and a coefficient for each plane that is used
    or had a weight.
    """
    return 1 + len({*used, *np.flatnonzero(series.weights.any(axis=0)).tolist()})


def _explain_undetermined(file: RunsFile, series: Series, used: Collection[int]) -> Problem:
    """Return a problem that names the runs that are missing at a speed."""
    at = "" if series.speed_rpm is None else f" at {series.speed_rpm:g} rpm"
    tried = np.asarray(series.weights.any(axis=0))
    bare = [file.planes[k] for k in used if not tried[k]]
    lacking = [f"with a trial weight in {join_words(bare)}"] if bare else []
    if series.weights.any(axis=1).all():
        lacking.insert(0, "of the rotor as found, without weights")
    if not lacking:
        named = [plane for plane, weights in zip(file.planes, tried, strict=True) if weights]
        lacking = [f"with another ratio of the weights in {join_words(named)}, or with only one"]
    message = Message(
        "add a run{at} {lacking}; {count} runs with different weights are needed (one as found, "
        "and one for each plane; given: {given}); or write `influence`, or leave a plane out "
        "({without})",
        at=at,
        lacking=" and one ".join(lacking),
        count=_count_unknowns(series, used),
        given=len(series.numbers),
    )
    return Problem("run", message)

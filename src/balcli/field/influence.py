"""Influence coefficients from runs with trial weights.

At each speed the readings V depend on the weights U by `V = V0 + alpha U` (Goodman, J. Eng. Ind.
86, 1964, 273). The coefficients alpha and the readings as found V0 are fitted to all runs by least
squares; where there are just enough runs, this is `alpha = (V - V0) / U`.

A run after the coefficients are determined, with weights that no earlier run had, is a *correction
run*: balancing goes on from the last of them. A repeated run is not one.

All complex numbers here turn in the sense in which phases of readings count.

All readings are taken to have errors of one size. It is estimated from the residuals of the fit
and of the correction. To first order the errors e
move the weights by `B h e`: h is the share of each run in the readings to cancel, B the inverse of
the coefficients. With nu complex degrees of freedom the square of such a distance over its
estimated mean has the distribution F(2, 2 nu), whose tail is `(1 + t / nu)^-nu`.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import NamedTuple

import numpy as np

from ..core.least_squares import solve
from ..core.phasors import Array, Complex
from ..errors import InputError, Problem
from ..file.fields import join_words
from .tables import RunsFile

_SAME = 1e-9  # share of the largest weight by which equal weights may differ
_ROUNDING = 1e-13  # share of the largest reading below which a change is rounding
_OUTSIDE = 0.05  # probability that an unbalance lies farther from its estimate than its scatter


class Series(NamedTuple):
    """The runs at one speed.

    Attributes:
        speed_rpm: Speed; None if the file gives none.
        numbers: Number of each run in the file, from 0.
        readings: Readings, shape (runs, sensors).
        weights: All weights that are on, shape (runs, planes).
        given: Influence coefficients of the file, shape (sensors, planes); None: to be found.
    """

    speed_rpm: float | None
    numbers: list[int]
    readings: Complex
    weights: Complex
    given: Complex | None


class Influence(NamedTuple):
    """Readings of all speeds, one speed after the other, and the effects of weights on them.

    Attributes:
        speeds_rpm: Speed of every reading, rpm; None if the file gives none.
        coefficients: Change of each reading by one unit of weight, shape (readings, planes); 0 for
            planes that are left out.
        found: Readings of the rotor without weights, shape (readings,).
        latest: Readings of the last run with a correction in, shape (readings,); `found` at speeds
            without such a run.
        start: Readings from which balancing goes on, shape (readings,): those with the weights
            `weights_on`, computed from `latest` where other weights were on.
        factors: How much each reading counts, shape (readings,).
        trimmed: Name of the last run with a correction in, at any speed; empty without one.
        weights_on: Weights that were on in that run, shape (planes,); otherwise 0.
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
        """Name of the state in which `latest` was read."""
        if not self.trimmed:
            return "as found"
        return "last read" if len(set(self.speeds_rpm)) > 1 else self.trimmed


def collect_series(file: RunsFile) -> list[Series]:
    """Return the runs as one series for each speed, in the order of the file."""
    found: list[Series] = []
    for speed in dict.fromkeys(run.speed for run in file.run):
        numbers = [k for k, run in enumerate(file.run) if run.speed == speed]
        kept, states = np.zeros(len(file.planes), dtype=complex), []
        for run in (file.run[k] for k in numbers):
            states.append(kept + [run.weights.get(plane, 0j) for plane in file.planes])
            kept = states[-1] if run.keep_trial else kept
        readings = np.array([file.run[k].readings for k in numbers], dtype=complex)
        given = None
        if file.influence is not None:
            sensors = readings.shape[1]
            rows = file.influence[len(found) * sensors : (len(found) + 1) * sensors]
            given = np.array(rows, dtype=complex)
        found.append(Series(speed, numbers, readings, file.turn(np.array(states)), given))
    return found


def find_influence(file: RunsFile, used: Collection[int], name: str = "") -> Influence:
    """Return influence coefficients: those of the file, or fitted to all runs.

    Args:
        file: Runs.
        used: Numbers of the planes that get a weight, from 0.
        name: Name of the file for messages.

    Raises:
        InputError: The runs do not determine the coefficients of all planes.
    """
    planes, blocks = len(file.planes), []
    trim, goes_on = -1, np.zeros(planes, dtype=complex)  # last run with a correction in
    for series in collect_series(file):
        count = count_needed(series, used)
        if count is None:
            raise InputError([_explain_undetermined(file, series, used)], name)
        alpha, found = fit_coefficients(series)
        latest, on = found, np.zeros(planes, dtype=complex)
        if (last := find_last_correction(series, count)) is not None:
            latest, on = series.readings[last], series.weights[last]
            if series.numbers[last] > trim:
                trim, goes_on = series.numbers[last], on
        speeds = np.full(len(found), series.speed_rpm, dtype=object)
        blocks.append((speeds, alpha, found, latest, latest - alpha @ on))
    speeds, alpha, found, latest, bare = map(np.concatenate, zip(*blocks, strict=True))
    return Influence(
        speeds_rpm=tuple(speeds),
        coefficients=alpha * np.isin(np.arange(planes), [*used]),
        found=found,
        latest=latest,
        start=bare + alpha @ goes_on,
        factors=np.resize(file.reading_weights or 1.0, len(found)),
        trimmed="" if trim < 0 else file.name_run(trim),
        weights_on=goes_on,
    )


def fit_coefficients(series: Series) -> tuple[Complex, Complex]:
    """Return influence coefficients and readings as found at one speed.

    Returns:
        Coefficients, shape (sensors, planes), 0 for planes without weights; and readings as found,
        shape (sensors,): the mean of the runs without weights, or the fitted ones if there is no
        such run.
    """
    if series.given is not None:
        alpha = series.given
        found = series.readings[0] - alpha @ series.weights[0]
    else:
        design = _design(series)
        fitted = np.array([solve(design, column).x for column in series.readings.T])
        found, changes = fitted[:, 0], fitted[:, 1:]
        unmoved = np.abs(changes) <= _ROUNDING * np.abs(series.readings).max(axis=0)[:, None]
        alpha = changes * ~unmoved / (np.abs(series.weights).max() or 1.0)
    bare = ~series.weights.any(axis=1)
    return alpha, np.asarray(series.readings[bare].mean(axis=0)) if bare.any() else found


def find_scatter(file: RunsFile, runs: Influence, used: list[int], step: Complex) -> Array | None:
    """Return how far the unbalance of each plane may lie from its estimate, with 95 % probability.

    Args:
        file: Runs.
        runs: Their influence coefficients.
        used: Numbers of the planes that get a weight, from 0.
        step: Weights that cancel the readings best, by least squares, shape (planes used,).

    Returns:
        Weights, shape (planes used,); None if there are no more readings than unknowns.
    """
    after, blocks, squares, freedom = runs.weights_on.copy(), collect_series(file), 0.0, 0
    after[used] += step
    factors = runs.factors
    gains = []  # variance of a reading to cancel over that of one run
    for series, scale in zip(blocks, np.split(factors, len(blocks)), strict=True):
        design, readings = _design(series), series.readings
        if series.given is not None:
            design, readings = design[:, :1], readings - series.weights @ series.given.T
        inverse, bare = np.linalg.pinv(design), ~series.weights.any(axis=1)
        taken, moved = bare / max(bare.sum(), 1) if bare.any() else inverse[0], after
        if (last := find_last_correction(series, count_needed(series, used) or 0)) is not None:
            taken, moved = np.arange(len(readings)) == last, after - series.weights[last]
        if series.given is None:
            taken = taken + moved / (np.abs(series.weights).max() or 1.0) @ inverse[1:]
        gains.append(np.full(len(scale), np.linalg.norm(taken) ** 2))
        errors = (readings - design @ (inverse @ readings)) * scale
        errors[np.abs(errors) <= _ROUNDING * np.abs(series.readings * scale).max()] = 0
        squares += float(np.sum(np.abs(errors) ** 2))
        freedom += (len(readings) - int(np.linalg.matrix_rank(design))) * len(scale)
    matrix, gain = factors[:, None] * runs.coefficients[:, used], np.concatenate(gains)
    left = factors * runs.start + matrix @ step
    left[np.abs(left) <= _ROUNDING * np.abs(factors * runs.found).max()] = 0
    inverse = np.linalg.pinv(matrix)
    if spare := len(left) - len(used):
        kept = np.abs(np.eye(len(left)) - matrix @ inverse) ** 2 @ gain  # of errors, by reading
        squares += spare * float(np.sum(np.abs(left) ** 2) / kept.sum())
    freedom += spare
    if not freedom:
        return None
    widest = squares * (_OUTSIDE ** (-1 / freedom) - 1)
    return np.asarray(np.sqrt(widest * (np.abs(inverse) ** 2 @ gain)))


def count_needed(series: Series, used: Collection[int]) -> int | None:
    """Return how many runs, from the first, determine V0 and all coefficients; None: not even all.

    Args:
        series: Runs.
        used: Numbers of the planes that get a weight, from 0.
    """
    if series.given is not None:
        return 1
    design, unknowns = _design(series), _count_unknowns(series, used)
    counts = range(1, len(design) + 1)
    return next((n for n in counts if np.linalg.matrix_rank(design[:n]) == unknowns), None)


def find_last_correction(series: Series, count: int) -> int | None:
    """Return the index of the last run whose weights differ from those of each of the first `count`
    runs; None: no such run.
    """
    states = series.weights
    apart = np.abs(states[:, np.newaxis] - states[:count]).max(axis=2)
    same = apart <= _SAME * np.abs(states).max()
    fresh = np.flatnonzero(~same.any(axis=1))
    return int(fresh[-1]) if len(fresh) else None


def _design(series: Series) -> Complex:
    """Return the matrix of the fit, shape (runs, 1 + planes): 1, and weights over the largest."""
    size = np.abs(series.weights).max() or 1.0
    return np.concatenate([np.ones((len(series.weights), 1)), series.weights / size], axis=1)


def _count_unknowns(series: Series, used: Collection[int]) -> int:
    """Return 1 for V0, and one for each plane that is used or had a weight on."""
    return 1 + len({*used, *np.flatnonzero(series.weights.any(axis=0)).tolist()})


def _explain_undetermined(file: RunsFile, series: Series, used: Collection[int]) -> Problem:
    """Return why not even all runs at a speed determine the coefficients."""
    at = "" if series.speed_rpm is None else f" at {series.speed_rpm:g} rpm"
    tried = np.asarray(series.weights.any(axis=0))
    bare = [file.planes[k] for k in used if not tried[k]]
    lacking = [f"with a trial weight in {join_words(bare)}"] if bare else []
    if series.weights.any(axis=1).all():
        lacking.insert(0, "of the rotor as found, without weights")
    if not lacking:
        named = [plane for plane, weights in zip(file.planes, tried, strict=True) if weights]
        lacking = [f"in which the trial weights in {join_words(named)} are apart"]
    return Problem(
        "run",
        f"add a run{at} {' and one '.join(lacking)}; {_count_unknowns(series, used)} that differ "
        f"are needed, and {len(series.numbers)} are here: one as found, and one for each plane; "
        "or give influence, or leave a plane out (--without)",
    )

"""Fit influence coefficients to amplitudes without phase.

In a run with the weights w, sensor j reads `A = |v + sum of alpha w|`. Phases are known only
relative to the reading as found, so v is real and above 0. Each sensor has 1 + 2 unknowns for each
plane: v, and real and imaginary part of every alpha. They minimise the sum of squares of
`A - |v + ...|` over all runs.

Start, plane by plane: with `A0 = v`, `A^2 - A0^2 = 2 A0 Re(alpha w) + |alpha|^2 |w|^2` is linear in
`A0 alpha` and `|alpha|^2`. For three equal weights at 120 deg this is the four-run method (Wowk,
Machinery Vibration: Balancing, McGraw-Hill 1995). Gauss-Newton steps refine the start.

**Two answers.** A sensor reads `|alpha| |u + w|` if u is the unbalance. From all points of a
circle, u and its image in this circle have the same ratio of distances. If the points -w of all
runs, with 0 for the rotor as found, lie on one circle (or on one line), amplitudes cannot tell u
from its image.

The first runs that determine everything are the trial runs. A *correction run* comes later and has
weights that differ from those of all trial runs, as for readings with phase (`influence`).
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ..core.phasors import Array, Complex
from ..errors import InputError, Problem
from ..file.fields import counted
from .influence import Influence, Series, collect_series, find_last_correction
from .runs_file import RunsFile

_ON_CIRCLE = 1e-6  # least singular value, as a share of the largest, of points not on one circle
_ON_LINE = 1e-9  # a curvature below this share of the coefficients of a circle: it is a line
_STEPS = 30  # most Gauss-Newton steps; about 12 suffice
_SETTLED = 1e-12  # a step below this share of the unknowns ends the iteration
_ROUNDING = 1e-9  # a misfit, or a difference of weights, below this share is a rounding error
_THREE = "such as the same weight at 0, 120 and 240 deg"


class Answers(NamedTuple):
    """The two unbalances that fit the amplitudes of one plane.

    Attributes:
        corrections: Both correction weights of the first sensor, the lighter one first.
        firsts: Influence coefficients if the first answer is right, shape (sensors,).
        others: Influence coefficients if the second answer is right, shape (sensors,).
    """

    corrections: tuple[complex, complex]
    firsts: Complex
    others: Complex


class AmplitudeFit(NamedTuple):
    """Influence coefficients fitted to amplitudes.

    Attributes:
        influence: Readings and influence coefficients. `found` are the fitted readings as found,
            with phase 0; `latest` has measured amplitudes, with the phases of the fit.
        measured: Mean reading of each sensor in the runs without weights, shape (sensors,).
        misfit: Reading minus fitted amplitude, shape (runs, sensors).
        rms: Root mean square of the misfit over all sensors and runs; 0 for rounding errors.
        share: `rms` as a share of the largest reading.
        answers: The two answers; None if only one unbalance fits.
    """

    influence: Influence
    measured: Array
    misfit: Array
    rms: float
    share: float
    answers: Answers | None


class _Circle(NamedTuple):
    """A circle through 0, or a line through 0.

    Attributes:
        centre: Centre of the circle; for a line, a unit vector along it.
        is_line: Whether it is a line.
    """

    centre: complex
    is_line: bool

    def reflect(self, point: complex) -> complex | None:
        """Return the image of a point; None for the centre, whose image is infinitely far."""
        if self.is_line:
            return complex(self.centre**2 * np.conj(point))
        offset = point - self.centre
        if abs(offset) <= _ROUNDING * abs(self.centre):
            return None
        return complex(self.centre + abs(self.centre) ** 2 / np.conj(offset))


def fit_amplitudes(file: RunsFile, used: list[int], name: str = "") -> AmplitudeFit:
    """Return influence coefficients fitted to readings without phase.

    Args:
        file: File of runs whose readings are amplitudes.
        used: Indices of the planes that get a weight.
        name: Name of the file for messages.

    Raises:
        InputError: A run is missing, or no unbalance fits the readings.
    """
    (series,) = collect_series(file)
    tried = np.flatnonzero(series.weights.any(axis=0)).tolist()
    planes = sorted({*used, *tried})
    if problems := [*_find_missing_runs(file, series, planes)]:
        raise InputError(problems, name)
    weights = series.weights[:, planes]
    size = float(np.abs(weights).max())
    circle = _find_circle(weights[:, 0] / size) if len(planes) == 1 else None
    fits = []
    for j, amplitudes in enumerate(series.readings.real.T):
        try:
            start = _start(amplitudes, weights / size, circle)
        except _NoFitError as error:
            of_plane = file.planes[planes[error.column]] if len(planes) > 1 else ""
            raise InputError([_explain_no_fit(file, j, of_plane)], name) from None
        fits.append(_refine(amplitudes, weights / size, start))
    unknowns: Complex = np.array(fits, dtype=complex)
    as_found = np.asarray(unknowns[:, 0].real)
    alpha: Complex = np.divide(unknowns[:, 1:], size)
    answers = None
    if circle is not None:
        images = _pair(as_found / unknowns[:, 1], circle)
        if images is not None:
            answers = _order(as_found, images * size)
            alpha = answers.firsts.reshape(-1, 1)
    coefficients = np.zeros((len(as_found), len(file.planes)), dtype=complex)
    coefficients[:, planes] = alpha
    trials = _count_trials(file, series, planes)
    last = find_last_correction(series, trials)
    influence = _describe_state(file, series, as_found, coefficients, last)
    used_planes = np.isin(np.arange(len(file.planes)), used)
    influence = influence._replace(coefficients=coefficients * used_planes)
    misfit = series.readings.real - np.abs(as_found + weights @ alpha.T)
    rms = float(np.sqrt(np.mean(misfit**2)))
    largest = float(series.readings.real.max())
    if rms <= _ROUNDING * largest:
        rms = 0.0
    return AmplitudeFit(influence, _average_as_found(series), misfit, rms, rms / largest, answers)


def _average_as_found(series: Series) -> Array:
    """Return the mean reading of each sensor in the runs without weights, shape (sensors,)."""
    bare = ~series.weights.any(axis=1)
    return np.asarray(series.readings[bare].real.mean(axis=0))


def _describe_state(
    file: RunsFile, series: Series, as_found: Array, coefficients: Complex, last: int | None
) -> Influence:
    """Return the fitted readings as found and those to be corrected, with all coefficients.

    Args:
        file: File of runs.
        series: Its runs.
        as_found: Fitted readings as found, shape (sensors,).
        coefficients: Influence coefficients, shape (sensors, planes).
        last: Index of the last correction run; None without such a run.
    """
    weights_on = np.zeros(len(file.planes), dtype=complex)
    trimmed = ""
    measured = _average_as_found(series)
    if last is not None:
        weights_on = series.weights[last]
        trimmed = file.name_run(series.numbers[last])
        measured = series.readings[last].real
    start = as_found + coefficients @ weights_on
    return Influence(
        speeds_rpm=(series.speed_rpm,) * len(as_found),
        coefficients=coefficients,
        found=as_found.astype(complex),
        latest=measured * np.exp(1j * np.angle(start)),
        start=start,
        factors=np.resize(file.reading_weights or 1.0, len(as_found)),
        trimmed=trimmed,
        weights_on=weights_on,
    )


def _count_trials(file: RunsFile, series: Series, planes: list[int]) -> int:
    """Return how many runs, from the first on, determine everything; all runs if two answers fit.

    Args:
        file: File of runs.
        series: Its runs, none of them missing.
        planes: Indices of the planes with unknown coefficients.
    """
    for count in range(1, len(series.numbers)):
        first = series._replace(
            numbers=series.numbers[:count],
            readings=series.readings[:count],
            weights=series.weights[:count],
        )
        if next(_find_missing_runs(file, first, planes), None) is not None:
            continue
        if len(planes) > 1 or _find_circle(first.weights[:, planes[0]]) is None:
            return count
    return len(series.numbers)


def _find_missing_runs(file: RunsFile, series: Series, planes: list[int]) -> Iterator[Problem]:
    """Yield a problem for each run that the fit lacks.

    Args:
        file: File of runs.
        series: Its runs.
        planes: Indices of the planes with unknown coefficients.
    """
    bare = ~series.weights.any(axis=1)
    if not bare.any():
        text = "add a run of the rotor as found, without weights; amplitudes are compared with it"
        yield Problem("run", text)
        return
    for row in np.flatnonzero(bare):
        for j in np.flatnonzero(series.readings[row] == 0):
            place = f"run.{series.numbers[row] + 1}.readings.{j + 1}"
            text = "is 0 in a run as found: without phase, a reading that is 0 shows no unbalance"
            yield Problem(place, text)
    needed = 2 if len(planes) == 1 else 3
    for k in planes:
        alone = _select_alone(series.weights, k)
        plane = file.planes[k]
        count = _count_different(series.weights[alone, k])
        if count < needed:
            text = (
                f"has {counted(count, 'trial run')} with different weights in {plane} alone; "
                f"without phase, give three on no common circle with 0, {_THREE}"
            )
            yield Problem("run", text)
        elif needed == 3 and _find_circle(np.append(series.weights[alone, k], 0)) is not None:
            text = (
                f"has trial weights in {plane} that lie on one circle with 0, so two answers fit; "
                f"give three trial runs on no common circle with 0, {_THREE}"
            )
            yield Problem("run", text)


def _select_alone(weights: Complex, k: int) -> Array:
    """Return a mask of the runs with weights in plane k alone, shape (runs,)."""
    others = np.delete(weights, k, axis=1)
    return np.asarray((weights[:, k] != 0) & ~others.any(axis=1))


def _count_different(weights: Complex) -> int:
    """Return how many weights differ."""
    different: list[complex] = []
    for weight in weights:
        apart = [abs(weight - other) > _ROUNDING * abs(weight) for other in different]
        if all(apart):
            different.append(complex(weight))
    return len(different)


def _find_circle(weights: Complex) -> _Circle | None:
    """Return the circle, or line, through the points -w; None if no circle has all points. 0 is one
    of the weights.
    """
    w = weights / np.abs(weights).max()
    rows = np.stack([np.ones(len(w)), w.real, w.imag, np.abs(w) ** 2], axis=1)
    _, s, vh = np.linalg.svd(rows)
    if len(rows) >= 4 and s[-1] >= _ON_CIRCLE * s[0]:
        return None
    _, along_x, along_y, curvature = vh[-1]  # curvature |w|^2 + along_x Re w + along_y Im w = 0
    normal = complex(along_x, along_y)
    if abs(curvature) <= _ON_LINE * abs(normal):
        return _Circle(1j * normal / abs(normal), is_line=True)
    return _Circle(normal / (2 * curvature) * np.abs(weights).max(), is_line=False)


def _explain_no_fit(file: RunsFile, j: int, of_plane: str) -> Problem:
    """Return the problem of readings that no unbalance fits.

    Args:
        file: File of runs.
        j: Index of the sensor.
        of_plane: Plane in which the trial weights do not fit; empty if there is only one.
    """
    sensor = file.sensors[j] if file.sensors else f"sensor {j + 1}"
    text = (
        f"no unbalance fits the readings of {sensor}: a reading or a weight must be wrong, or the "
        "trial weights are too light"
    )
    if of_plane:
        text += f"; check the runs with weights in {of_plane}"
    return Problem("run", text)


class _NoFitError(Exception):
    """No unbalance fits the readings of a sensor.

    Attributes:
        column: Column of the weights whose runs do not fit.
    """

    def __init__(self, column: int) -> None:
        super().__init__(column)
        self.column = column


def _start(amplitudes: Array, weights: Complex, circle: _Circle | None) -> Complex:
    """Return reading as found and influence coefficients from the linear equations of each plane,
    shape (1 + planes,).

    Args:
        amplitudes: Readings of one sensor, shape (runs,).
        weights: Weights on the rotor, at most 1, shape (runs, planes).
        circle: Circle of all weights, if two answers fit: the lighter one is returned.

    Raises:
        _NoFitError: No unbalance fits.
    """
    as_found = float(amplitudes[~weights.any(axis=1)].mean())
    start = [complex(as_found)]
    for k in range(weights.shape[1]):
        alone = _select_alone(weights, k)
        w = weights[alone, k]
        rows = np.stack([2 * w.real, -2 * w.imag, np.abs(w) ** 2], axis=1)
        target = amplitudes[alone] ** 2 - as_found**2
        x: Array | None = np.linalg.lstsq(rows, target, rcond=_ON_CIRCLE)[0]
        if circle is not None and x is not None:
            x = _choose_lighter(x, np.linalg.svd(rows)[2][-1], as_found)
        if x is None or x[2] <= 0:
            raise _NoFitError(k)
        start.append(complex(x[0], x[1]) / as_found)
    return np.array(start)


def _choose_lighter(x: Array, free: Array, as_found: float) -> Array | None:
    """Return the point `x + t free` with `|A0 alpha|^2 = A0^2 |alpha|^2` that has the largest
    alpha, so the lightest unbalance; None if there is none.

    Args:
        x: Solution of the linear equations: real and imaginary part of A0 alpha, |alpha|^2.
        free: Direction in which the equations leave x open.
        as_found: A0, reading as found.
    """
    square = free[0] ** 2 + free[1] ** 2
    linear = 2 * (x[0] * free[0] + x[1] * free[1]) - as_found**2 * free[2]
    constant = x[0] ** 2 + x[1] ** 2 - as_found**2 * x[2]
    under_root = linear**2 - 4 * square * constant
    if under_root < -_ROUNDING * linear**2:
        return None
    root = np.sqrt(max(under_root, 0.0))
    points = [x + (sign * root - linear) / (2 * square) * free for sign in (1, -1)]
    return max(points, key=lambda point: float(point[2]))


def _refine(amplitudes: Array, weights: Complex, start: Complex) -> Complex:
    """Return the unknowns with the least sum of squares that Gauss-Newton steps reach, shape (1 +
    planes,): the reading as found, above 0, and the coefficients.

    Args:
        amplitudes: Readings of one sensor, shape (runs,).
        weights: Weights on the rotor, at most 1, shape (runs, planes).
        start: First unknowns.
    """
    ones = np.ones((len(weights), 1))
    design = np.concatenate([ones, weights, 1j * weights], axis=1)
    x = np.concatenate([start.real, start[1:].imag])
    best = x
    least = np.inf
    for _ in range(_STEPS):
        vectors = design @ x
        sizes = np.abs(vectors)
        miss = amplitudes - sizes
        if np.linalg.norm(miss) < least:
            best = x
            least = float(np.linalg.norm(miss))
        directions = np.where(sizes > 0, vectors, 1.0) / np.where(sizes > 0, sizes, 1.0)
        step = np.linalg.lstsq((np.conj(directions)[:, None] * design).real, miss, rcond=None)[0]
        x = x + step
        if np.linalg.norm(step) <= _SETTLED * np.linalg.norm(x):
            best = x
            break
    if best[0] < 0:
        best = -best
    planes = weights.shape[1]
    return np.concatenate([best[:1], best[1 : 1 + planes] + 1j * best[1 + planes :]])


def _pair(unbalances: Complex, circle: _Circle) -> Complex | None:
    """Return both unbalances of each sensor, shape (sensors, 2); None if the image of one is
    infinitely far, so that only one answer is left. The columns are the two answers.

    Args:
        unbalances: An unbalance that fits each sensor, shape (sensors,).
        circle: Circle of all weights.
    """
    pairs: list[list[complex]] = []
    for unbalance in unbalances:
        image = circle.reflect(complex(unbalance))
        if image is None:
            return None
        pair = [complex(unbalance), image]
        if pairs and abs(pair[0] - pairs[0][0]) > abs(pair[1] - pairs[0][0]):
            pair.reverse()
        pairs.append(pair)
    return np.array(pairs)


def _order(as_found: Array, unbalances: Complex) -> Answers:
    """Return both answers.

    Args:
        as_found: Readings as found, shape (sensors,).
        unbalances: Both unbalances of each sensor, shape (sensors, 2).
    """
    if abs(unbalances[0, 0]) > abs(unbalances[0, 1]):
        unbalances = unbalances[:, ::-1]
    alpha = as_found[:, None] / unbalances
    lighter, heavier = -unbalances[0]
    return Answers((complex(lighter), complex(heavier)), alpha[:, 0], alpha[:, 1])

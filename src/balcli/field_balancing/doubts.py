"""Valid but suspicious runs and weights: each doubt with its value and a remedy."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from ..core.phasors import Complex
from ..documents.records import angle_deg
from ..enginefile.exclusive import join_words
from ..enginefile.units import ask_unit
from .influence import Series, collect_series, count_needed, fit_coefficients
from .model import RunsFile

if TYPE_CHECKING:
    from .balance import Correction, FieldBalance

_NEARLY_DEPENDENT = 0.2  # own effect of a plane below which errors of reading grow much
_SMALL_CHANGE = 0.1  # of the largest reading: a smaller change determines a plane badly
_SMALLEST_RADIUS = 1.0  # mm; the smallest rotors that are balanced have more
_UNEQUAL_TRIALS = 100.0  # ratio of trial weights: those of one rotor are more alike
_FAR_BEYOND = 5.0  # times the largest trial weight: far from where coefficients were measured
_FEWEST_PHASES = 4  # two runs of two sensors; fewer may be as near to 0 by chance
_EQUAL_PHASES_DEG = 0.5  # phases differ by less where all that shakes is in phase
_ROUNDING = 1e-13  # share of the largest reading below which a prediction is rounding
# A reading that is farther from its prediction than this share of the largest reading as found, or
# of the largest change that weights made, has a reason.
_SURPRISING = 0.5


def find_doubts(result: FieldBalance) -> Iterator[str]:
    """Yield everything suspicious about a result and its runs."""
    alike = [each for each in result.corrections if each.own_effect < _NEARLY_DEPENDENT]
    if len(alike) > 1:
        yield (
            f"what planes {join_words([each.plane for each in alike])} do, other planes do nearly "
            f"as well: only {min(each.own_effect for each in alike):.1%} of what one does is its "
            f"own (condition {result.condition:.3g}), so errors of reading grow as much; if their "
            f"weights are large, try --without {alike[0].plane}"
        )
    if result.left_out and result.permitted is not None:
        yield (
            f"the permitted unbalance is judged without {' and '.join(result.left_out)}: what is "
            f"there is not known, and readings of up to {result.largest:.4g} {result.unit or ''}"
        ).rstrip() + " stay"
    trials = _find_largest_trials(result.file)
    if result.file.influence is None:
        for correction in result.corrections:
            yield from _doubt_trials(result, correction, trials[correction.plane])
    yield from _doubt_runs(result)
    yield from _doubt_units(result.file, trials)
    yield from _doubt_phases(result.file)


def _find_largest_trials(file: RunsFile) -> dict[str, float]:
    """Return the largest weight that was on in each plane, of those that had any."""
    found: dict[str, float] = {}
    for run in file.run:
        for plane, weight in run.weights.items():
            found[plane] = max(abs(weight), found.get(plane, 0.0))
    return found


def _doubt_trials(result: FieldBalance, correction: Correction, trial: float) -> Iterator[str]:
    """Yield doubts about trial weights that changed little, and a correction far beyond them."""
    plane, influence = correction.plane, result.runs
    speeds = list(dict.fromkeys(influence.speeds_rpm))
    for speed in speeds:
        runs = [run for run in result.file.run if run.speed == speed]
        heaviest = max(abs(run.weights.get(plane, 0)) for run in runs)
        rows = [k for k, each in enumerate(influence.speeds_rpm) if each == speed]
        effects = influence.coefficients[rows, result.file.planes.index(plane)]
        change = heaviest * float(np.abs(effects).max())
        largest = float(np.abs(influence.found[rows]).max())
        if change < _SMALL_CHANGE * largest:
            at = f" at {speed:g} rpm" if len(speeds) > 1 else ""
            yield (
                f"the trial weight in {plane}{at} changes no reading by more than {change:.3g}, "
                f"{100 * change / largest:.2g}% of the largest; use a heavier one"
            )
    weight = abs(correction.weight)
    if weight > _FAR_BEYOND * trial:
        yield (
            f"the correction of {weight:.3g} {result.weight_unit} in {plane} is "
            f"{weight / trial:.3g} times the largest weight tried there; put it on, read again, "
            "and add that run to the file"
        )


def _doubt_runs(result: FieldBalance) -> Iterator[str]:
    """Yield a doubt for each speed about the reading that follows least from the other runs."""
    file = result.file
    used = [k for k, plane in enumerate(file.planes) if plane not in result.left_out]
    for series in collect_series(file):
        predicted, largest = _predict(series, used)
        errors = np.abs(series.readings - predicted)
        row, sensor = np.unravel_index(int(errors.argmax()), errors.shape)
        if errors[row, sensor] <= _SURPRISING * largest:
            continue
        read, expected = (
            f"{abs(value):.4g} @ {angle_deg(value):.1f}"
            for value in (series.readings[row, sensor], predicted[row, sensor])
        )
        turned, _ = _predict(series._replace(weights=np.conj(series.weights)), used)
        remedy = (
            "are its weights where the file says, and is the machine as it was? Else leave the run "
            "out"
        )
        if np.abs(series.readings - turned).max() <= _SURPRISING * largest:
            other = "with" if file.senses[1] == "against" else "against"
            remedy = (
                "had angles of weights been counted the other way round, weights = "
                f'"{other}", it would be near'
            )
        yield (
            f"'{file.name_run(series.numbers[row])}' reads {read} at "
            f"{result.readings[sensor].sensor}, far from {expected}, which the other runs predict; "
            f"{remedy}"
        )


def _predict(series: Series, used: list[int]) -> tuple[Complex, float]:
    """Return every reading as the first runs that determine the coefficients predict it, shape
    (runs, sensors), and the largest reading as found, or change of one by weights.
    """
    count = count_needed(series, used)
    first = series._replace(readings=series.readings[:count], weights=series.weights[:count])
    alpha, found = fit_coefficients(first)
    changes = series.weights @ alpha.T
    predicted, largest = found + changes, float(max(np.abs(found).max(), np.abs(changes).max()))
    return np.where(np.abs(predicted) <= _ROUNDING * largest, 0, predicted), largest


def _doubt_units(file: RunsFile, trials: dict[str, float]) -> Iterator[str]:
    """Yield doubts about meters for millimeters, and kilograms for grams in one of the planes."""
    if file.radius is not None and (radius := max(file.radius)) < _SMALLEST_RADIUS:
        yield f"radius is {radius:g} mm; {ask_unit('mm', f'{radius:g} m')}"
    by_weight = sorted((weight, plane) for plane, weight in trials.items())
    if by_weight and by_weight[-1][0] > _UNEQUAL_TRIALS * by_weight[0][0]:
        unit = file.weight_unit
        ends = (by_weight[0], by_weight[-1])
        light, heavy = (f"{weight:.3g} {unit} in {plane}" for weight, plane in ends)
        yield f"the weights tried are {light} and {heavy}; are both in {unit}?"


def _doubt_phases(file: RunsFile) -> Iterator[str]:
    """Yield a doubt if phases seem to be in radians: all within 2 pi degrees, and yet different."""
    phases = [math.degrees(cmath.phase(each)) for run in file.run for each in run.readings if each]
    most = max(map(abs, phases), default=0.0)
    several = len(phases) >= _FEWEST_PHASES and max(phases) - min(phases) > _EQUAL_PHASES_DEG
    if several and most <= 2 * math.pi:
        yield (
            f"all phases of readings are within {most:.3g} deg of 0; are they in radians? One of "
            f"{most:.3g} rad is {math.degrees(most):.1f} deg"
        )

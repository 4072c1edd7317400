"""Balance a rotor in the field (`field`): compute correction weights, the remaining
readings, whether the balance grade is reached, and warnings of doubtful runs.

The corrections x minimise the sum of squares of the readings `|V + alpha x|`, or the largest of
them (`minimise`). V are the readings to be corrected, alpha the influence coefficients. Places and
largest weights, if the file has them, constrain x.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from itertools import cycle
from pathlib import Path
from typing import Annotated, Literal, NamedTuple, TypeAlias

import numpy as np

from ..core.least_squares import find_dependent_columns, minimise as make_small, solve
from ..core.phasors import Complex
from ..core.records import HIDDEN, INLINE, Axes, Polar, angle_deg
from ..core.unbalance import find_permitted_unbalance
from ..errors import ArgumentError, InputError, Message, Problem, check_type, list_words
from ..file.doubt import Doubt
from ..file.fields import counted, join_words, shorten, suggest_nearest
from ..file.plain_tables import take_tables
from ..file.units import ask_unit
from ..show.result import Result
from .amplitudes import AmplitudeFit, fit_amplitudes
from .influence import (
    Influence,
    Series,
    collect_series,
    count_needed,
    find_influence,
    find_scatter,
    fit_coefficients,
)
from .places import Piece, PlaneLimits
from .runs_file import RunsFile, Sense, check_runs

_NEARLY_DEPENDENT = 0.2  # with a smaller own effect of a plane, reading errors change weights much
_SMALL_CHANGE = 0.1  # share of the largest reading; smaller changes give bad coefficients
_SMALLEST_RADIUS = 1.0  # smallest likely radius of weights, mm
_FAR_BEYOND = 5.0  # coefficients hold for corrections up to this multiple of a trial weight
_ROUNDING = 1e-13  # a prediction below this share of the largest reading is a rounding error
# A warning is given if a reading differs from its prediction by more than this share of a scale:
# the largest reading as found, or the largest change by weights, whichever is larger.
_SURPRISING = 0.5
_MISFIT = 0.05  # a larger misfit of amplitudes, as a share of the largest reading, is doubtful


def find_doubts(result: FieldBalance) -> Iterator[Doubt]:
    """Yield warnings of everything suspicious in a result and its runs."""
    file = result.file
    if result.fit is not None and result.fit.share > _MISFIT:
        yield _doubt_fit(result, result.fit)
    alike = [each for each in result.corrections if each.own_effect < _NEARLY_DEPENDENT]
    if len(alike) > 1:
        message: str = Message(
            "planes {planes} have nearly the same effect: {share:.1%} of the effect of one can "
            "come from the others (condition number {condition:.3g}), so small reading errors "
            "change the weights much; if the weights are large, try {without} {plane}",
            planes=join_words([each.plane for each in alike]),
            share=1 - min(each.own_effect for each in alike),
            condition=result.condition,
            plane=alike[0].plane,
        )
        yield Doubt("", message)
    if file.grade is not None or file.shares is not None:
        for key, hint in list_missing(file).items():
            yield Doubt(key, f"is missing, so the grade is not checked; give it, such as {hint}")
    if result.left_out and result.permitted is not None:
        remaining = f"{result.largest:.4g} {result.unit or ''}".rstrip()
        message = (
            f"the permitted unbalance is checked without {' and '.join(result.left_out)}, whose "
            f"unbalance is unknown; readings of up to {remaining} remain"
        )
        yield Doubt("", message)
    series = collect_series(file)
    if result.fit is not None:
        runs = result.runs
        yield from _doubt_trials(result, [_Trials(series[0], runs.coefficients, runs.found)])
    else:
        if file.influence is None:
            trials = [_Trials(each, *fit_coefficients(each)) for each in series]
            yield from _doubt_trials(result, trials)
        for each in series:
            yield from _doubt_runs(result, each)
    if file.radius is not None and (radius := max(file.radius)) < _SMALLEST_RADIUS:
        yield Doubt("radius", f"{radius:g} mm; {ask_unit('mm', f'{radius:g} m')}")


def _doubt_fit(result: FieldBalance, fit: AmplitudeFit) -> Doubt:
    """Return the warning that amplitudes do not fit one unbalance."""
    row, _ = np.unravel_index(int(np.abs(fit.misfit).argmax()), fit.misfit.shape)
    amount = f"{fit.rms:.3g} {result.unit or ''}".rstrip()
    worst = result.file.name_run(int(row))
    message = (
        f"the readings do not fit one unbalance: their misfit is {amount} (rms), "
        f"{100 * fit.share:.2g}% of the largest reading; repeat '{worst}', which "
        "fits worst, with the same weights"
    )
    return Doubt("", message)


class _Trials(NamedTuple):
    """Runs at one speed, with the influence coefficients and readings as found of the fit."""

    series: Series
    coefficients: Complex
    found: Complex


def _doubt_trials(result: FieldBalance, trials: list[_Trials]) -> Iterator[Doubt]:
    """Yield warnings of weak trial weights, and of corrections far above all trial weights."""
    for correction in result.corrections:
        plane = correction.plane
        weight = abs(correction.weight)
        k = result.file.planes.index(plane)
        for series, alpha, as_found in trials:
            change = np.abs(np.outer(alpha[:, k], series.weights[:, k])).max()
            if change < _SMALL_CHANGE * (largest := np.abs(as_found).max()):
                at = f" at {series.speed_rpm:g} rpm" if len(trials) > 1 else ""
                message = (
                    f"the trial weight in {plane}{at} changes no reading by more than "
                    f"{change:.3g}, {100 * change / largest:.2g}% of the largest; make it heavier"
                )
                yield Doubt("", message)
        trial = max(float(np.abs(each.series.weights[:, k]).max()) for each in trials)
        if weight > _FAR_BEYOND * trial:
            message = (
                f"the correction of {weight:.3g} {result.weight_unit} in {plane} is "
                f"{weight / trial:.3g} times the largest weight tried there; put it on, read "
                "again, and add that run to the file"
            )
            yield Doubt("", message)


def _doubt_runs(result: FieldBalance, series: Series) -> Iterator[Doubt]:
    """Yield a warning of the reading (at one speed) that differs most from its prediction by the
    other runs, if it differs much.
    """
    file = result.file
    used = [k for k, plane in enumerate(file.planes) if plane not in result.left_out]
    predicted, largest = _predict(series, used)
    errors = np.abs(series.readings - predicted)
    row, sensor = np.unravel_index(int(errors.argmax()), errors.shape)
    if errors[row, sensor] <= _SURPRISING * largest:
        return
    read, expected = (
        f"{abs(value):.4g} @ {angle_deg(value):.1f}"
        for value in (series.readings[row, sensor], predicted[row, sensor])
    )
    turned, _ = _predict(series._replace(weights=np.conj(series.weights)), used)
    remedy = "check its weights and the state of the machine, or leave the run out"
    if np.abs(series.readings - turned).max() <= _SURPRISING * largest:
        other = "with" if file.senses[1] == "against" else "against"
        remedy = f'the run fits if angles of weights count the other way: weights = "{other}"'
    message = (
        f"'{file.name_run(series.numbers[row])}' reads {read} at "
        f"{result.readings[sensor].sensor}; the other runs predict {expected}; {remedy}"
    )
    yield Doubt("", message)


def _predict(series: Series, used: list[int]) -> tuple[Complex, float]:
    """Return the readings predicted by the first runs that determine the coefficients, shape (runs,
    sensors), and the scale for judging errors: the largest reading as found, or the largest change
    by weights, whichever is larger.
    """
    count = count_needed(series, used)
    first = series._replace(readings=series.readings[:count], weights=series.weights[:count])
    alpha, as_found = fit_coefficients(first)
    changes = series.weights @ alpha.T
    predicted = as_found + changes
    largest = float(max(np.abs(as_found).max(), np.abs(changes).max()))
    return np.where(np.abs(predicted) <= _ROUNDING * largest, 0, predicted), largest


Minimise = Literal["squares", "max"]
Weight: TypeAlias = Annotated[complex, Polar("weight", "angle_deg")]
_READING = Polar("amplitude", "phase_deg")

_NOISE = 1e-14  # a residual below this share of the terms that cancel in it is a rounding error
_NEGLIGIBLE = 1e-9  # negligible weight, as a share of a weight that cancels the largest reading
_AT_EDGE = 1e3  # a weight closer to its limit than this many negligible weights is at its limit
_G_MM = 1e-6  # 1 g mm in kg m


class Sensor(NamedTuple):
    """Sensor and speed of a reading.

    Attributes:
        sensor: Name of the sensor, or its number.
        speed_rpm: Speed; null if the file gives none.
    """

    sensor: str
    speed_rpm: float | None


@dataclass(frozen=True, kw_only=True)
class Correction:
    """Correction weight of one plane. Its angle counts in the same direction as the file's weights.

    Attributes:
        plane: Name of the plane.
        weight: Correction weight relative to the rotor as found, with all trial weights off.
        add: Weight to add to the weight of the last correction run; left out without such a run.
        unbalance_g_mm: Unbalance of the correction weight; left out if the radius is unknown.
        own_effect: Share of the plane's effect that no combination of other planes can produce; 1
            if they can produce none of it.
        at_limit: Whether the places or the largest weight of the plane limit its correction.
        wanted: Best correction weight without these limits; left out unless `at_limit` is true.
        pieces: Single weights, or holes, that together have the effect of the weight to add.
    """

    plane: str
    weight: Annotated[Weight, INLINE]
    add: Weight | None = None
    unbalance_g_mm: float | None = None
    own_effect: float
    at_limit: bool
    wanted: Weight | None = None
    pieces: tuple[Piece, ...]

    @property
    def step(self) -> complex:
        """Weight to add now: `add` after a correction run, otherwise `weight`."""
        return self.weight if self.add is None else self.add


@dataclass(frozen=True, kw_only=True)
class PlanePermitted:
    """Permitted residual unbalance of one plane (ISO 21940-11).

    Attributes:
        plane: Name of the plane.
        permitted_g_mm: Permitted residual unbalance.
        present_g_mm: Present unbalance, estimated from the last readings by least squares; without
            phase, unbalance of the rotor as found.
        trimmed_g_mm: Without phase, unbalance in the last correction run; left out without such a
            run, and if readings have phases.
        scatter_g_mm: Distance from the estimate within which the true unbalance lies with 95 %
            probability, judged by the residuals of the fit; left out if there are only as many
            readings as unknowns.
        reached: Whether the unbalance there now plus scatter is at most the permitted unbalance.
        after_g_mm: Residual unbalance after the corrections.
    """

    plane: str
    permitted_g_mm: float
    present_g_mm: float
    trimmed_g_mm: float | None = None
    scatter_g_mm: float | None = None
    reached: bool
    after_g_mm: float

    @property
    def now_g_mm(self) -> float:
        """Unbalance in the last correction run; without one, of the rotor as found."""
        return self.present_g_mm if self.trimmed_g_mm is None else self.trimmed_g_mm

    @property
    def verdict(self) -> str:
        """Verdict on the plane's grade: reached, uncertain or not reached."""
        if self.reached:
            return "reached"
        near = self.now_g_mm - (self.scatter_g_mm or 0.0) <= self.permitted_g_mm
        return "uncertain" if near else "not reached"


class Permitted(NamedTuple):
    """Permitted residual unbalance of the rotor (ISO 21940-11).

    Attributes:
        specific_mm: Permitted eccentricity.
        unbalance_g_mm: Permitted residual unbalance of the whole rotor.
        planes: Permitted and present unbalance by plane.
        reached: Whether all planes reach their grade before the corrections.
    """

    specific_mm: float
    unbalance_g_mm: float
    planes: tuple[PlanePermitted, ...]
    reached: bool


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class FieldBalance(Result):
    """Weights that balance a rotor on its machine, and the remaining readings.

    Weights and readings are complex numbers in the units of the file.

    Attributes:
        format: Name and version of the document.
        name: Name of the rotor; null if the file gives none.
        unit: Unit of the readings; null if the file gives none.
        weight_unit: Unit of the weights.
        phases: Direction in which phases of readings count: with or against rotation.
        weights: Direction in which angles of weights count: with or against rotation.
        minimise: Minimised quantity: the sum of squared readings, or the largest reading.
        method: How the readings were evaluated: from amplitudes without phase; left out if they
            have phases.
        ambiguous: Whether two unbalances fit the amplitudes, so that `corrections` is empty; left
            out if readings have phases.
        fit_rms: Root mean square of the misfit of the amplitudes over all sensors and runs; left
            out if readings have phases.
        solutions: Both correction weights that fit the amplitudes, the lighter one first; left out
            unless `ambiguous` is true.
        readings: Sensor and speed of every reading.
        influence: Influence coefficients: change of a reading by one unit of weight in a plane.
        corrections: Correction weights of the planes that are not left out.
        before: Readings of the last correction run; without one, the readings as found. Without
            phase, the fitted readings as found.
        residual: Predicted readings after the corrections.
        largest: Largest reading after the corrections, weighted by the file's `reading_weights`.
        rms: Root mean square of the readings after the corrections, weighted in the same way.
        condition: Condition number of the influence coefficients; null if it is infinite.
        bound: Proven lower bound of `largest` for all allowed weights; left out if `minimise` is
            squares.
        trimmed: Name of the last correction run; left out if there is none.
        permitted: Permitted residual unbalance; left out if the grade or a key that it needs is
            missing.
        file: File of runs.
        runs: Readings and influence coefficients of all speeds.
        used: Names of the planes that get a weight.
        fit: Fit of amplitudes without phase; None if readings have phases.
    """

    format: Literal["balcli.field/1"] = "balcli.field/1"
    name: str | None
    unit: str | None
    weight_unit: str
    phases: Sense
    weights: Sense
    minimise: Minimise
    method: Literal["amplitudes"] | None = None
    ambiguous: bool | None = None
    fit_rms: float | None = None
    solutions: tuple[Weight, ...] | None = None
    readings: tuple[Sensor, ...]
    influence: Annotated[Complex, _READING, Axes(2)]
    corrections: tuple[Correction, ...]
    before: Annotated[Complex, _READING]
    residual: Annotated[Complex, _READING]
    largest: float
    rms: float
    condition: float
    bound: float | None = None
    trimmed: str | None = None
    permitted: Permitted | None = None
    file: Annotated[RunsFile, HIDDEN]
    runs: Annotated[Influence, HIDDEN]
    used: Annotated[tuple[str, ...], HIDDEN]
    fit: Annotated[AmplitudeFit | None, HIDDEN] = None

    @property
    def summary(self) -> str:
        """Planes that get a weight."""
        return f"in {', '.join(self.used)}"

    @property
    def limited(self) -> bool:
        """Whether places or largest weights limit the correction of any plane."""
        return any(each.at_limit for each in self.corrections)

    @property
    def left_out(self) -> list[str]:
        """Planes that are left out."""
        return [plane for plane in self.file.planes if plane not in self.used]

    @property
    def doubts(self) -> tuple[Doubt, ...]:
        """Warnings of valid but suspicious runs and weights, each with its value and a remedy."""
        return tuple(find_doubts(self))


def find_corrections(
    file: RunsFile, minimise: Minimise = "squares", without: Collection[str] = (), name: str = ""
) -> FieldBalance:
    """Return the correction weights of a rotor.

    Args:
        file: File of runs.
        minimise: "squares" (minimise the sum of squared readings) or "max" (minimise the largest
            reading).
        without: Names of planes that get no weight.
        name: Name of the file, for messages.

    Raises:
        InputError: The runs do not separate the effects of the planes.
        BalcliError: `without` names all planes, or a plane that does not exist.
    """
    used = _choose_planes(file, without)
    fit = fit_amplitudes(file, used, name) if file.has_only_amplitudes else None
    if fit is not None and fit.answers is not None:
        return _leave_open(file, minimise, used, fit)
    runs = find_influence(file, used, name) if fit is None else fit.influence
    matrix = runs.coefficients[:, used]
    now = runs.start
    _refuse_dependent(matrix, [file.planes[k] for k in used], name)
    phases, senses = file.senses
    limits = [PlaneLimits.of_plane(file, k) for k in used]
    regions = [
        each.make_region(complex(runs.weights_on[k]), 1 if phases == senses else -1)
        for k, each in zip(used, limits, strict=True)
    ]
    factors = runs.factors
    negligible = _NEGLIGIBLE * np.abs(now).max() / np.abs(matrix).max(axis=0)
    best = small = make_small(matrix, -now, factors, largest=minimise == "max")
    outside = [abs(r.project(x)[0] - x) for r, x in zip(regions, best.x, strict=True)] > negligible
    if outside.any():
        small = make_small(matrix, -now, factors, regions, largest=minimise == "max")
    step = np.where(outside.any() & (np.abs(small.x) <= negligible), 0, small.x)
    depths = np.abs([r.find_depth(x) for r, x in zip(regions, step, strict=True)])
    at_limit = (outside.any() & (depths <= _AT_EDGE * negligible)).tolist()
    noise = _NOISE * (np.abs(now) + np.abs(matrix) @ np.abs(step))
    residual = np.where(np.abs(small.residual) <= noise, 0, -small.residual)
    left = factors * np.abs(residual)
    # sine of the angle between each column and the span of the others
    inverse = np.linalg.pinv(matrix / np.linalg.norm(matrix, axis=0), rcond=0.0)
    own_effects = 1 / np.linalg.norm(inverse, axis=1)
    corrections = []
    for j, k in enumerate(used):
        on = runs.weights_on[k]
        add = complex(file.turn(step[j]))
        weight = complex(file.turn(on + step[j]))
        corrections.append(
            Correction(
                plane=file.planes[k],
                weight=weight,
                add=add if runs.trimmed else None,
                unbalance_g_mm=_find_unbalance(file, k, weight),
                own_effect=float(own_effects[j]),
                at_limit=at_limit[j],
                wanted=complex(file.turn(on + best.x[j])) if at_limit[j] else None,
                pieces=limits[j].plan(add, float(negligible[j])),
            )
        )
    return FieldBalance(
        name=file.name,
        unit=file.unit,
        weight_unit=file.weight_unit,
        phases=phases,
        weights=senses,
        minimise=minimise,
        method=None if fit is None else "amplitudes",
        ambiguous=None if fit is None else False,
        fit_rms=None if fit is None else fit.rms,
        readings=_list_sensors(file, runs),
        influence=runs.coefficients,
        corrections=tuple(corrections),
        before=runs.latest if fit is None else runs.found,
        residual=residual,
        largest=float(left.max()),
        rms=float(np.sqrt(np.mean(left**2))),
        condition=solve(matrix, now).condition,
        bound=small.bound,
        trimmed=runs.trimmed or None,
        permitted=_find_permitted(file, runs, used, step),
        file=file,
        runs=runs,
        used=tuple(file.planes[k] for k in used),
        fit=fit,
    )


def _leave_open(
    file: RunsFile, minimise: Minimise, used: list[int], fit: AmplitudeFit
) -> FieldBalance:
    """Return the result of amplitudes that two unbalances fit: both answers, and no corrections.

    Args:
        file: File of runs.
        minimise: Minimised quantity.
        used: Index of the only plane.
        fit: Fit with two answers.
    """
    runs = fit.influence
    answers = fit.answers.corrections if fit.answers is not None else ()
    left = runs.factors * np.abs(runs.found)
    phases, senses = file.senses
    return FieldBalance(
        name=file.name,
        unit=file.unit,
        weight_unit=file.weight_unit,
        phases=phases,
        weights=senses,
        minimise=minimise,
        method="amplitudes",
        ambiguous=True,
        fit_rms=fit.rms,
        solutions=answers,
        readings=_list_sensors(file, runs),
        influence=runs.coefficients,
        corrections=(),
        before=runs.found,
        residual=runs.found,
        largest=float(left.max()),
        rms=float(np.sqrt(np.mean(left**2))),
        condition=1.0,
        file=file,
        runs=runs,
        used=tuple(file.planes[k] for k in used),
        fit=fit,
    )


def _list_sensors(file: RunsFile, runs: Influence) -> tuple[Sensor, ...]:
    """Return sensor and speed of every reading."""
    names = file.sensors or [f"sensor {k}" for k, _ in enumerate(file.run[0].readings, 1)]
    return tuple(map(Sensor, cycle(names), runs.speeds_rpm))


def _choose_planes(file: RunsFile, without: Collection[str]) -> list[int]:
    """Return the indices of the planes that get a weight.

    Raises:
        ArgumentError: `without` names all planes, or a plane that does not exist.
    """
    for name in without:
        if name not in file.planes:
            hint = suggest_nearest(name, file.planes, f"there are {', '.join(file.planes)}")
            raise ArgumentError(
                "{without} {name} is not a plane; {hint}", name=shorten(name), hint=hint
            )
    used = [k for k, plane in enumerate(file.planes) if plane not in without]
    if not used:
        raise ArgumentError("{without} leaves no plane for a weight")
    return used


def _refuse_dependent(matrix: Complex, planes: list[str], name: str) -> None:
    """Raise InputError if the readings do not separate the effects of the planes.

    Args:
        matrix: Influence coefficients, shape (readings, planes).
        planes: Names of the planes.
        name: Name of the file for messages.
    """
    dead = [plane for plane, column in zip(planes, matrix.T, strict=True) if not column.any()]
    dependent = dead[:1] or [planes[k] for k in find_dependent_columns(matrix)]
    if not dependent:
        return
    message = Message(
        "{readings} cannot separate the effects of {planes}; add sensors or speeds, or leave one "
        "plane out, such as {without} {last}",
        readings=counted(len(matrix), "reading"),
        planes=join_words(dependent),
        last=dependent[-1],
    )
    if dead:
        message = Message(
            "a weight in {plane} changes no reading, so no correction can be found there; use a "
            "heavier trial weight, or {without} {plane}",
            plane=dead[0],
        )
    raise InputError([Problem("planes", message)], name)


def _find_unbalance(file: RunsFile, k: int, weight: complex) -> float | None:
    """Return the unbalance of a weight in the k-th plane, g mm; None if no radius is known."""
    per_weight = file.find_unbalance_per_weight(k)
    return None if per_weight is None else float(abs(weight)) * per_weight / _G_MM


def list_missing(file: RunsFile) -> dict[str, str]:
    """Return the keys that the file lacks for a check of its grade, each with an example."""
    needed = {"grade": "grade = 6.3", "mass": "mass = 120", "speed": "speed = 3000"}
    if file.weighs_masses:
        radius = f"radius = {[200] * len(file.planes)}"
        needed["radius"] = f'{radius} (or give weights as unbalances, weight_unit = "g mm")'
    return {key: hint for key, hint in needed.items() if getattr(file, key) is None}


def _find_permitted(
    file: RunsFile, runs: Influence, used: list[int], step: Complex
) -> Permitted | None:
    """Return permitted and present unbalance; None if the grade or a key that it needs is missing.

    Args:
        file: File of runs.
        runs: Influence coefficients of the runs.
        used: Indices of the planes that get a weight.
        step: Weights to add, shape (planes used,).
    """
    if file.grade is None or file.mass is None or file.speed is None or list_missing(file):
        return None
    matrix = runs.coefficients[:, used]
    best = make_small(matrix, -runs.start, runs.factors).x
    at_first = make_small(matrix, -runs.found, runs.factors).x  # of the rotor as found
    splits = file.has_only_amplitudes and bool(runs.trimmed)
    scatter = None if file.has_only_amplitudes else find_scatter(file, runs, used, best)
    whole = find_permitted_unbalance(file.grade, file.mass, file.speed)
    shares = np.array(file.shares or np.ones(len(file.planes)))
    planes = []
    for j, (k, installed, added) in enumerate(zip(used, best, step, strict=True)):
        permitted = whole * float(shares[k] / shares.sum())
        now = _find_unbalance(file, k, installed) or 0.0
        as_found = _find_unbalance(file, k, at_first[j]) or 0.0
        within = None if scatter is None else _find_unbalance(file, k, scatter[j])
        planes.append(
            PlanePermitted(
                plane=file.planes[k],
                permitted_g_mm=permitted,
                present_g_mm=as_found if splits else now,
                trimmed_g_mm=now if splits else None,
                scatter_g_mm=within,
                reached=now + (within or 0.0) <= permitted,
                after_g_mm=_find_unbalance(file, k, installed - added) or 0.0,
            )
        )
    return Permitted(
        specific_mm=whole / (1e3 * file.mass),
        unbalance_g_mm=whole,
        planes=tuple(planes),
        reached=all(each.reached for each in planes),
    )


def field(
    runs: str | Path | Mapping[str, object],
    minimise: Literal["squares", "max"] = "squares",
    *,
    without: str | Collection[str] = (),
) -> FieldBalance:
    """Balance a rotor on its machine, from readings of runs with trial weights.

    Args:
        runs: Path of a file of runs, its text (TOML), or a dict of its tables: `planes`, and a list
            `run` of dicts with the `readings` and `weights` of each run, such as "5 @ 30"
            (amplitude and angle in degrees).
        minimise: "squares" (minimise the sum of squared readings) or "max" (minimise the largest
            reading).
        without: Names of planes that get no weight.

    Returns:
        The result, with `corrections` (each has a complex `weight` in the file's unit, and
        `pieces`) and `residual` (predicted readings, shape (readings,)).

    Raises:
        BalcliError: The file cannot be read, or `without` names all planes or a plane that does
            not exist.
        InputError: The runs have mistakes, or do not separate the effects of the planes.
        TypeError: An argument has a wrong type.

    Example:
        >>> field("fan.toml", "max").to_pandas()
    """
    check_type("minimise", minimise, str, 'give "squares" or "max"')
    if minimise not in ("squares", "max"):
        raise ArgumentError('{minimise} {other!r}: choose "squares" or "max"', other=minimise)
    planes = [without] if isinstance(without, str) else list_words("without", without, '["front"]')
    wanted = "give the path, text or dict of a file of runs"
    tables, name = take_tables("field", runs, wanted)
    file = check_runs(tables, name)
    return find_corrections(file, minimise, planes, name or "file of runs")  # text or dict: no name

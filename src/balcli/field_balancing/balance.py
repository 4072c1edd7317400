"""Runs of a rotor -> correction weights, what they leave, what the shop does, and whether the
permitted unbalance is reached.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from ..core.least_squares import find_dependent_columns, solve
from ..core.phasors import Array, Complex
from ..core.smallest_largest import Region, Smallest, minimise_largest, minimise_squares
from ..enginefile.exclusive import join_words
from ..enginefile.fields import counted, nearest, shorten
from ..enginefile.units import ask_unit
from ..errors import BalcliError, InputError, Problem
from ..result import Result
from .influence import (
    Influence,
    find_influence,
    find_senses,
    find_surprise,
    has_opposite_senses,
    name_sensor,
)
from .model import RunsFile
from .permitted import find_permitted_eccentricity, find_permitted_unbalance
from .shop import Piece, find_angle_deg, find_shop, find_unbalance_per_weight

Minimise = Literal["squares", "max"]

_NEARLY_ALIKE = 0.2  # of a plane's effect, that no other plane has: below, planes are nearly one
_SMALL_CHANGE = 0.1  # of the largest reading: less tells little about a plane
_SMALL_RADIUS = 1.0  # mm; the smallest rotors that are balanced have more
_UNLIKE = 100.0  # times the lightest trial weight of a plane: planes of one rotor are more alike
_FAR_BEYOND = 5.0  # times the largest trial weight: far from where the coefficients were measured
_SEVERAL_PHASES = 4  # two runs of two sensors; fewer may be as near to 0 by chance
_PHASES_ALIKE = 0.5  # deg; they differ by less where all that shakes is in phase
_ROUNDING = 1e-14
_NOTHING = 1e-9  # share of the weight that would do as much as all unbalance
_AT_EDGE = 1e3  # times that: so near its limit a weight counts as at it
_G_MM = 1e-6  # kg m


class Permitted(NamedTuple):
    """Unbalance of one plane, g mm: what the grade permits, what is there now by the readings, and
    what is left of it after the corrections.
    """

    permitted: float
    present: float
    after: float

    @property
    def reached(self) -> bool:
        return self.present <= self.permitted


class PlaneCorrection(NamedTuple):
    """One plane. Angles count as the file counts those of weights.

    Attributes:
        total: weight in the file's unit, from the rotor as found, all trial weights off.
        step: the same, on top of what was on in the last run with a correction in; `total` where
            there is none.
        wanted: the step that would be best if weights of any size could be anywhere.
        unbalance: of the total, g mm; None where no radius is known.
        own: share of the plane's effect that no combination of the others has (1: independent).
        limited: whether its places or its largest weight stopped it.
        pieces: weights or holes of the shop, which together are the step.
        permitted: None without a grade.
    """

    plane: str
    total: complex
    step: complex
    wanted: complex
    unbalance: float | None
    own: float
    limited: bool
    pieces: tuple[Piece, ...]
    permitted: Permitted | None


@dataclass(frozen=True, eq=False, repr=False)
class FieldBalance(Result):
    """Weights that balance a rotor, and the readings that are left with them.

    Attributes:
        file: the runs.
        minimise: what was made smallest: the sum of squares, or the largest, of the readings.
        planes: those that were not left out.
        after: predicted readings, shape (readings,).
        influence: what a unit of weight in each plane changes.
        condition: of the influence coefficients.
        bound: no weights leave less as the largest (weighted) reading; nan for squares.
        largest: the largest weighted reading after.
        rms: of the weighted readings after.
    """

    file: RunsFile
    minimise: Minimise
    influence: Influence
    planes: tuple[PlaneCorrection, ...]
    after: Complex
    condition: float
    largest: float
    bound: float
    rms: float

    @property
    def summary(self) -> str:
        """Which planes get a weight, and what is left."""
        return f"in {', '.join(plane.plane for plane in self.planes)}"

    @property
    def reached(self) -> bool:
        """Whether every plane is within its permitted unbalance (true without a grade)."""
        return all(p.permitted is None or p.permitted.reached for p in self.planes)

    @property
    def limited(self) -> bool:
        """Whether places or largest weights keep any plane from what would be best."""
        return any(p.limited for p in self.planes)

    @property
    def doubts(self) -> tuple[str, ...]:
        """What is valid but suspicious of runs and weights, each with its figure and a remedy."""
        return tuple(_find_doubts(self))


def find_corrections(
    file: RunsFile, minimise: Minimise = "squares", without: Collection[str] = (), name: str = ""
) -> FieldBalance:
    """Correction weights from readings.

    Args:
        without: planes that get no weight.
        name: of the file, for messages.

    Raises:
        InputError: runs that do not tell what each plane does, planes that depend on one another.
        BalcliError: a plane to leave out that is none, or all of them.
    """
    used = _find_used(file, without)
    influence = find_influence(file, frozenset(without), name)
    matrix = influence.coefficients[:, used]
    _refuse_dependent(file, matrix, used, name)
    on, now = influence.on, influence.start
    weights = np.ones(len(now))
    if file.reading_weights:
        weights = np.tile(np.array(file.reading_weights), len(set(influence.speeds_rpm)))
    sense = -1 if has_opposite_senses(file) else 1
    shops = [find_shop(file, k) for k in used]
    regions = [shop.find_region(complex(on[k]), sense) for k, shop in zip(used, shops, strict=True)]
    wanted = _fit(matrix, -now, weights, (), minimise)
    nothing = _NOTHING * np.abs(now).max() / np.abs(matrix).max(axis=0)
    fitted, limited = wanted, [False] * len(used)
    if not all(map(Region.has, regions, wanted.x, nothing)):
        fitted = _fit(matrix, -now, weights, regions, minimise)
        fitted = fitted._replace(x=np.where(np.abs(fitted.x) <= nothing, 0, fitted.x))
        limited = list(map(Region.has_at_edge, regions, fitted.x, _AT_EDGE * nothing))
    after = _drop_rounding(-fitted.residual, now, matrix, fitted.x)
    left = weights * np.abs(after)
    own = _find_own_shares(matrix)
    turn = np.conj if sense < 0 else np.asarray
    planes = tuple(
        PlaneCorrection(
            file.planes[k],
            total=complex(turn(on[k] + step)),
            step=complex(turn(step)),
            wanted=complex(turn(wanted.x[j])),
            unbalance=_find_unbalance(file, k, on[k] + step),
            own=float(own[j]),
            limited=limited[j],
            pieces=shops[j].plan(complex(turn(step)), float(nothing[j])),
            permitted=_find_permitted(file, k, wanted.x[j], wanted.x[j] - step),
        )
        for j, (k, step) in enumerate(zip(used, fitted.x, strict=True))
    )
    return FieldBalance(
        file,
        minimise,
        influence,
        planes,
        after=after,
        condition=solve(matrix, now).condition,
        largest=float(left.max()),
        bound=fitted.bound,
        rms=float(np.sqrt(np.mean(left**2))),
    )


def _find_doubts(result: FieldBalance) -> list[str]:
    doubts = []
    alike = [p for p in result.planes if p.own < _NEARLY_ALIKE]
    if len(alike) > 1:
        names = join_words([p.plane for p in alike])
        doubts.append(
            f"what planes {names} do, other planes do nearly as well: only "
            f"{min(p.own for p in alike):.1%} of what one does is its own (condition "
            f"{result.condition:.3g}), so errors of reading grow as much; if their weights are "
            f"large, try --without {alike[0].plane}"
        )
    left_out = [name for name in result.file.planes if name not in {p.plane for p in result.planes}]
    unit = result.file.unit or ""
    if left_out and any(p.permitted for p in result.planes):
        doubts.append(
            f"the permitted unbalance is judged without {' and '.join(left_out)}: what is there is "
            f"not known, and readings of up to {result.largest:.4g} {unit}".rstrip()
            + " stay"
        )
    if result.file.influence is None:
        doubts += _doubt_trials(result)
    return [
        *doubts,
        *_doubt_runs(result.file, left_out),
        *_doubt_units(result.file),
        *_doubt_phases(result.file),
    ]


# ------------------------------------------------------------------ steps
def _find_used(file: RunsFile, without: Collection[str]) -> list[int]:
    for name in without:
        if name not in file.planes:
            near = nearest(name, file.planes)
            hint = f" Did you mean {near}?" if near else ""
            planes = ", ".join(file.planes)
            raise BalcliError(f"--without {shorten(name)}: is no plane; there are {planes}.{hint}")
    used = [k for k, plane in enumerate(file.planes) if plane not in without]
    if not used:
        raise BalcliError("--without: leaves no plane to put a weight in")
    return used


def _refuse_dependent(file: RunsFile, matrix: Complex, used: list[int], name: str) -> None:
    """Raises InputError where readings cannot tell planes apart."""
    readings, planes = matrix.shape
    if planes > readings:
        message = (
            f"{counted(planes, 'plane')} cannot be told apart by {counted(readings, 'reading')}; "
            f"add sensors or speeds, or leave {counted(planes - readings, 'plane')} out with "
            "--without"
        )
        raise InputError([Problem("planes", message)], name)
    dependent = [file.planes[used[k]] for k in find_dependent_columns(matrix)]
    dead = [file.planes[used[k]] for k in range(planes) if not matrix[:, k].any()]
    if dead:
        message = (
            f"a weight in {dead[0]} changes no reading, so none can be found for it; use a heavier "
            f"trial weight, or --without {dead[0]}"
        )
        raise InputError([Problem("planes", message)], name)
    if dependent:
        *front, last = dependent
        message = (
            f"{', '.join(front)} and {last} depend on one another: what one does, the others do as "
            f"well, at every sensor and speed; leave one out, such as --without {last}"
        )
        raise InputError([Problem("planes", message)], name)


def _fit(
    matrix: Complex, target: Complex, weights: Array, regions: Sequence[Region], minimise: Minimise
) -> Smallest:
    """The steps; residuals are those of the target."""
    if not target.any() and not regions:
        nothing = np.zeros(matrix.shape[1], dtype=complex)
        return Smallest(nothing, target, 0.0, 0.0)
    fit = minimise_largest if minimise == "max" else minimise_squares
    return fit(matrix, target, weights, regions)


def _drop_rounding(after: Complex, before: Complex, matrix: Complex, x: Complex) -> Complex:
    """Readings that are no more than rounding errors of what they are the sum of are 0."""
    noise = _ROUNDING * (np.abs(before) + np.abs(matrix) @ np.abs(x))
    return np.where(np.abs(after) <= noise, 0, after)


def _find_own_shares(matrix: Complex) -> Array:
    """Of every column: its distance from what the others span, over its length (sine)."""
    directions = matrix / np.linalg.norm(matrix, axis=0)
    return np.asarray(1 / np.linalg.norm(np.linalg.pinv(directions, rcond=0.0), axis=1))


def _find_unbalance(file: RunsFile, k: int, weight: complex) -> float | None:
    """g mm of a weight in a plane; None where no radius is known."""
    per_weight = find_unbalance_per_weight(file, k)
    return None if per_weight is None else float(abs(weight)) * per_weight / _G_MM


def _find_permitted(file: RunsFile, k: int, wanted: complex, left: complex) -> Permitted | None:
    """Args: what would balance the plane now, and after the corrections."""
    present, after = _find_unbalance(file, k, wanted), _find_unbalance(file, k, left)
    if not (file.grade and file.mass and file.speed) or present is None or after is None:
        return None
    shares = np.array(file.shares or np.ones(len(file.planes)))
    whole = find_permitted_unbalance(file.grade, file.mass, file.speed)
    return Permitted(whole * float(shares[k] / shares.sum()), present, after)


def _doubt_trials(result: FieldBalance) -> list[str]:
    """Trial weights that told little, and corrections far beyond them."""
    doubts = []
    file, speeds = result.file, list(dict.fromkeys(result.influence.speeds_rpm))
    for p in result.planes:
        for speed in speeds:
            change, largest = _find_change(result, p.plane, speed)
            if change < _SMALL_CHANGE * largest:
                at = f" at {speed:g} rpm" if len(speeds) > 1 else ""
                doubts.append(
                    f"the trial weight in {p.plane}{at} changes no reading by more than "
                    f"{change:.3g}, {100 * change / largest:.2g}% of the largest; a heavier one "
                    "tells more"
                )
        trial = max(abs(run.weights[p.plane]) for run in file.run if p.plane in run.weights)
        if abs(p.total) > _FAR_BEYOND * trial:
            doubts.append(
                f"the correction of {abs(p.total):.3g} {file.weight_unit} in {p.plane} is "
                f"{abs(p.total) / trial:.3g} times the largest weight tried there; put it on, read "
                "again, and add that run to the file"
            )
    return doubts


def _doubt_runs(file: RunsFile, left_out: Collection[str]) -> Iterator[str]:
    """A run that reads what no weights on this rotor, counted as the file says, could make."""
    surprise = find_surprise(file, frozenset(left_out))
    if surprise is None:
        return
    read, foretold = map(_tell_polar, (surprise.read, surprise.foretold))
    unlike = (
        f"'{surprise.run}' reads {read} at {name_sensor(file, surprise.sensor)}, far from "
        f"{foretold}, which the other runs foretell"
    )
    if surprise.other_sense:
        other = "with" if find_senses(file)[1] == "against" else "against"
        yield (
            f'{unlike}; had angles of weights been counted the other way round, weights = "{other}"'
            ", it would be near"
        )
    else:
        yield (
            f"{unlike}; are its weights where the file says, and is the machine as it was? Else "
            "leave the run out"
        )


def _tell_polar(value: complex) -> str:
    return f"{abs(value):.4g} @ {find_angle_deg(value):.1f}"


def _doubt_units(file: RunsFile) -> Iterator[str]:
    """Metres for millimetres, and kilograms for grams in one of the planes."""
    if file.radius is not None and max(file.radius) < _SMALL_RADIUS:
        at = max(file.radius)
        yield f"radius is {at:g} mm; {ask_unit('mm', f'{at:g} m')}"
    trials = {
        plane: max(abs(run.weights[plane]) for run in file.run if plane in run.weights)
        for plane in file.planes
        if any(plane in run.weights for run in file.run)
    }
    if len(trials) > 1:
        light, heavy = min(trials, key=trials.__getitem__), max(trials, key=trials.__getitem__)
        unit = file.weight_unit
        if trials[heavy] > _UNLIKE * trials[light]:
            yield (
                f"the weights tried are {trials[light]:.3g} {unit} in {light} and "
                f"{trials[heavy]:.3g} {unit} in {heavy}; are both in {unit}?"
            )


def _doubt_phases(file: RunsFile) -> Iterator[str]:
    """Phases in radians: all of them within a turn of those, and yet not alike."""
    phases = [
        math.degrees(cmath.phase(value)) for run in file.run for value in run.readings if value
    ]
    most = max(map(abs, phases), default=0.0)
    several = len(phases) >= _SEVERAL_PHASES and max(phases) - min(phases) > _PHASES_ALIKE
    if several and most <= 2 * math.pi:
        yield (
            f"all phases of readings are within {most:.3g} deg of 0; are they in radians? One of "
            f"{most:.3g} rad is {math.degrees(most):.1f} deg"
        )


def _find_change(result: FieldBalance, plane: str, speed: float | None) -> tuple[float, float]:
    """By how much the heaviest weight that was in a plane at a speed changes a reading, and the
    largest reading there as found.
    """
    influence, file = result.influence, result.file
    runs = [run for run in file.run if run.speed == speed and plane in run.weights]
    trial = max(abs(run.weights[plane]) for run in runs)
    here = [k for k, own in enumerate(influence.speeds_rpm) if own == speed]
    moved = influence.coefficients[here, file.planes.index(plane)]
    return trial * float(np.abs(moved).max()), float(np.abs(influence.found[here]).max())


def find_eccentricity(file: RunsFile) -> float | None:
    """Permitted specific unbalance, mm; None without a grade."""
    if file.grade is None or file.speed is None:
        return None
    return find_permitted_eccentricity(file.grade, file.speed)

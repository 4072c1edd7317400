"""Runs of a rotor -> correction weights, what they leave, what the shop does, and whether the
permitted unbalance is reached.
"""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.drilled_hole import find_drill_depth, find_drilled_unbalance
from ..core.least_squares import find_dependent_columns, solve
from ..core.smallest_largest import (
    Smallest,
    find_limited,
    minimise_largest,
    minimise_squares_within,
)
from ..enginefile.fields import counted, nearest, shorten
from ..errors import BalcliError, InputError, Problem
from .influence import Influence, find_influence, has_opposite_senses
from .model import RunsFile, read_amount_unit
from .permitted import find_permitted_eccentricity, find_permitted_unbalance
from .places import Placed, find_reach, split_weight
from .read import is_mass

Complex = NDArray[np.complex128]
Array = NDArray[np.float64]
Minimise = Literal["squares", "max"]

_NEARLY_ALIKE = 0.2  # of a plane's effect, that no other plane has: below, planes are nearly one
_SMALL_CHANGE = 0.1  # of the largest reading: less tells little about a plane
_FAR_BEYOND = 5.0  # times the largest trial weight: far from where the coefficients were measured
_ROUNDING = 1e-14
_G_MM = 1e-6  # kg m


class Piece(NamedTuple):
    """A weight to put on, or a hole that removes it: in the file's unit, at an angle of the rotor;
    depth of the hole in mm (nan: too much for this drill; None: nothing is drilled).
    """

    weight: float
    angle_deg: float
    depth_mm: float | None


class Work(NamedTuple):
    """What the shop does in one plane.

    Attributes:
        pieces: weights or holes; None if the places cannot take it.
        reach: largest weight that the places can stand for in that direction; infinite without a
            limit.
    """

    pieces: tuple[Piece, ...] | None
    reach: float


class Permitted(NamedTuple):
    """Unbalance of one plane, g mm: what the grade permits, and what is there now."""

    permitted: float
    present: float

    @property
    def reached(self) -> bool:
        return self.present <= self.permitted


class PlaneCorrection(NamedTuple):
    """One plane. Angles count as the file counts those of weights.

    Attributes:
        total: weight in the file's unit, from the rotor as found, all trial weights off.
        step: the same, on top of what was on in the last run with a correction in; `total` where
            there is none.
        unbalance: of the total, g mm; None where no radius is known.
        own: share of the plane's effect that no combination of the others has (1: independent).
        limited: whether its largest weight stopped it.
        work: for the step. permitted: None without a grade.
    """

    plane: str
    total: complex
    step: complex
    unbalance: float | None
    own: float
    limited: bool
    work: Work
    permitted: Permitted | None


@dataclass(frozen=True)
class FieldBalance:
    """The answer.

    Attributes:
        minimise: what was made smallest: the sum of squares, or the largest, of the readings.
        planes: those that were not left out.
        after: predicted readings, shape (readings,).
        condition: of the influence coefficients.
        bound: no weights leave less as the largest (weighted) reading; nan for squares.
        largest: the largest weighted reading after; rms: of the weighted readings.
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
    def reached(self) -> bool:
        """Whether every plane is within its permitted unbalance (true without a grade)."""
        return all(p.permitted is None or p.permitted.reached for p in self.planes)


def balance_rotor(
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
    as_found = influence.now - np.sum(influence.coefficients * influence.now_on, axis=1)
    weights = np.ones(len(as_found))
    if file.reading_weights:
        weights = np.tile(np.array(file.reading_weights), len(set(influence.speeds_rpm)))
    most = np.array([file.most[k] if file.most and not file.places else np.inf for k in used])
    fitted = _fit(matrix, -as_found, weights, most, minimise)
    after = _drop_rounding(-fitted.residual, as_found, matrix, fitted.x)
    left = weights * np.abs(after)
    limited = find_limited(fitted.x, most)
    steps = fitted.x - influence.now_on[-1, used]
    own = _find_own_shares(matrix)
    sense = np.conj if has_opposite_senses(file) else np.asarray
    planes = tuple(
        _describe_plane(file, k, complex(total), complex(step), float(own[j]), j in limited)
        for j, (k, total, step) in enumerate(zip(used, sense(fitted.x), sense(steps), strict=True))
    )
    return FieldBalance(
        file,
        minimise,
        influence,
        planes,
        after=after,
        condition=solve(matrix, as_found).condition,
        largest=float(left.max()),
        bound=fitted.bound,
        rms=float(np.sqrt(np.mean(left**2))),
    )


def find_doubts(result: FieldBalance) -> list[str]:
    """What is valid but suspicious, each with its figure and a remedy."""
    doubts = []
    alike = [p for p in result.planes if p.own < _NEARLY_ALIKE]
    if len(alike) > 1:
        names = " and ".join(p.plane for p in alike)
        doubts.append(
            f"planes {names} act nearly alike: only {min(p.own for p in alike):.1%} of what one "
            f"does is its own (condition {result.condition:.3g}), so errors of reading grow as "
            f"much; if their weights are large, try --without {alike[0].plane}"
        )
    if result.file.influence is None:
        doubts += _doubt_trials(result)
    return doubts


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
    matrix: Complex, target: Complex, weights: Array, most: Array, minimise: Minimise
) -> Smallest:
    """The weights; residuals are those of the target."""
    if not target.any():
        nothing = np.zeros(matrix.shape[1], dtype=complex)
        return Smallest(nothing, target, 0.0, 0.0)
    if minimise == "max":
        return minimise_largest(matrix, target, weights, most)
    return minimise_squares_within(matrix, target, weights, most)


def _drop_rounding(after: Complex, before: Complex, matrix: Complex, x: Complex) -> Complex:
    """Readings that are no more than rounding errors of what they are the sum of are 0."""
    noise = _ROUNDING * (np.abs(before) + np.abs(matrix) @ np.abs(x))
    return np.where(np.abs(after) <= noise, 0, after)


def _find_own_shares(matrix: Complex) -> Array:
    """Of every column: its distance from what the others span, over its length (sine)."""
    directions = matrix / np.linalg.norm(matrix, axis=0)
    return np.asarray(1 / np.linalg.norm(np.linalg.pinv(directions, rcond=0.0), axis=1))


def _describe_plane(
    file: RunsFile, k: int, total: complex, step: complex, own: float, limited: bool
) -> PlaneCorrection:
    per_weight = _find_unbalance_per_weight(file, k)
    permitted = None
    if file.grade and file.mass and file.speed and per_weight is not None:
        shares = np.array(file.shares or np.ones(len(file.planes)))
        whole = find_permitted_unbalance(file.grade, file.mass, file.speed)
        share = float(shares[k] / shares.sum())
        permitted = Permitted(whole * share, abs(step) * per_weight / _G_MM)
    return PlaneCorrection(
        file.planes[k],
        total,
        step,
        None if per_weight is None else abs(total) * per_weight / _G_MM,
        own,
        limited,
        _plan_work(file, k, step, per_weight),
        permitted,
    )


def _find_unbalance_per_weight(file: RunsFile, k: int) -> float | None:
    """kg m of one unit of weight in a plane; None where its radius is not known."""
    scale = float(read_amount_unit(file.weight_unit).scale)
    if not is_mass(file):
        return scale
    return scale * file.radius[k] / 1e3 if file.radius else None


class _Hole(NamedTuple):
    """A radial hole into a rim, m; and the unbalance of one unit of weight there, kg m."""

    rim: float
    diameter: float
    per_weight: float

    def find_depth_mm(self, weight: float) -> float:
        return 1e3 * find_drill_depth(weight * self.per_weight, self.rim, self.diameter)

    def find_weight(self, depth_mm: float) -> float:
        removed = find_drilled_unbalance(depth_mm / 1e3, self.rim, self.diameter)
        return removed / self.per_weight


def _find_hole(file: RunsFile, k: int, per_weight: float | None) -> _Hole | None:
    if file.drill is None or file.radius is None or per_weight is None:
        return None
    return _Hole(file.radius[k] / 1e3, file.drill[k] / 1e3, per_weight)


def _plan_work(file: RunsFile, k: int, step: complex, per_weight: float | None) -> Work:
    hole = _find_hole(file, k, per_weight)
    wanted = -step if hole else step
    limit = file.most[k] if file.most and file.places else math.inf
    if hole and file.deepest:
        limit = min(limit, hole.find_weight(file.deepest[k]))
    placed, reach = _place(wanted, file.places[k] if file.places else None, limit)
    if placed is None:
        return Work(None, reach)
    pieces = (
        Piece(p.weight, p.angle_deg, hole.find_depth_mm(p.weight) if hole else None) for p in placed
    )
    return Work(tuple(pieces), reach)


def _place(
    wanted: complex, angles_deg: tuple[float, ...] | None, limit: float
) -> tuple[tuple[Placed, ...] | None, float]:
    """Where the weight goes (None: it does not fit), and how much would fit there."""
    if wanted == 0:
        return (), math.inf
    if angles_deg is None:
        single = Placed(abs(wanted), find_angle_deg(wanted))
        return ((single,) if single.weight <= limit else None), limit
    placed = split_weight(wanted, np.array(angles_deg), limit)
    reach = math.inf if placed is not None else find_reach(wanted, np.array(angles_deg), limit)
    return placed, reach


def find_angle_deg(number: complex) -> float:
    """Angle in [0, 360); 0 of 0."""
    angle = math.degrees(math.atan2(number.imag, number.real)) % 360
    return 0.0 if angle == 360 else angle


def _doubt_trials(result: FieldBalance) -> list[str]:
    """Trial weights that told little, and corrections far beyond them."""
    doubts = []
    influence, file = result.influence, result.file
    largest = float(np.abs(influence.found).max())
    for p in result.planes:
        k = file.planes.index(p.plane)
        trial = max(abs(run.weights[p.plane]) for run in file.run if p.plane in run.weights)
        change = float(np.abs(influence.coefficients[:, k]).max()) * trial
        if change < _SMALL_CHANGE * largest:
            doubts.append(
                f"the trial weight in {p.plane} changes no reading by more than {change:.3g}, "
                f"{change / largest:.0%} of the largest; a heavier one tells more"
            )
        if abs(p.total) > _FAR_BEYOND * trial:
            doubts.append(
                f"the correction of {abs(p.total):.3g} {file.weight_unit} in {p.plane} is "
                f"{abs(p.total) / trial:.3g} times the largest weight tried there; put it on, read "
                "again, and add that run to the file"
            )
    return doubts


def find_eccentricity(file: RunsFile) -> float | None:
    """Permitted specific unbalance, mm; None without a grade."""
    if file.grade is None or file.speed is None:
        return None
    return find_permitted_eccentricity(file.grade, file.speed)

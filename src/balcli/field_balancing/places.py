"""Compute the weights that a plane allows: at given places or at any angle, up to a largest weight,
or as holes in the rim.

The sums of weights at given angles, each from 0 to a largest weight, fill a convex polygon
(`find_region`). `split_weight` finds the lightest weights with a given sum.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.least_squares import Region
from ..core.phasors import Array, Complex
from ..core.records import angle_deg
from ..core.unbalance import find_drill_depth, find_drilled_unbalance
from .runs_file import RunsFile

_ROUNDING = 1e-9  # a smaller share of a weight is a rounding error


class Piece(NamedTuple):
    """Weight at a place, or a drilled hole: a part of a correction.

    Attributes:
        weight: Weight to put on, or weight at the rim with the same effect as the hole.
        angle_deg: Angle, which counts in the same direction as the file's weights.
        place: Number of the place in the file's list, from 1; left out without places.
        depth_mm: Depth of the hole; left out for weights.
    """

    weight: float
    angle_deg: float
    place: int | None = None
    depth_mm: float | None = None


class PlaneLimits(NamedTuple):
    """Places and largest weight of one plane. Angles count like those of the file's weights.

    Attributes:
        places_deg: Angles of the places, deg; empty if any angle is allowed.
        most: Largest weight at one place, of one hole, or in a plane without places; infinite if
            unlimited.
        find_depth: Function that returns the depth, m, of the hole that replaces a weight at the
            rim; the hole is opposite to the weight. None if weights are put on.
    """

    places_deg: tuple[float, ...]
    most: float
    find_depth: Callable[[float], float] | None

    @classmethod
    def of_plane(cls, file: RunsFile, k: int) -> PlaneLimits:
        """Return the limits of the plane with the index k."""
        places = file.places[k] if file.places else ()
        most = file.most[k] if file.most else math.inf
        unit = file.find_unbalance_per_weight(k)
        if file.drill is None or file.radius is None or unit is None:
            return cls(places, most, None)
        rim = file.radius[k] / 1e3
        drill = file.drill[k] / 1e3
        deepest = file.deepest[k] / 1e3 if file.deepest else rim
        heaviest = min(most, find_drilled_unbalance(deepest, rim, drill) / unit)

        def find_depth(weight: float) -> float:
            return find_drill_depth(min(weight, heaviest) * unit, rim, drill)

        return cls(places, heaviest, find_depth)

    def make_region(self, weight_on: complex, sense: int) -> Region:
        """Return the region of weights that can be added. Angles of complex weights count in the
        direction of the phases of readings.

        Args:
            weight_on: Weight already on the plane.
            sense: -1 if angles of the file's weights count in the other direction, otherwise 1.
        """
        if self.places_deg:
            angles_deg = sense * np.array(self.places_deg) + (180 if self.find_depth else 0)
            return find_region(angles_deg, self.most)
        return Region(0j if self.find_depth or math.isinf(self.most) else -weight_on, self.most)

    def plan(self, weight: complex, negligible: float) -> tuple[Piece, ...]:
        """Return the weights, or holes, whose sum is a given weight; it lies in the plane's region.

        Args:
            weight: Weight to add.
            negligible: Largest weight that is neglected.
        """
        if abs(weight) <= negligible:
            return ()
        amount = -weight if self.find_depth else weight
        pieces: tuple[Piece, ...] | None = (Piece(weight=abs(amount), angle_deg=angle_deg(amount)),)
        if self.places_deg:
            pieces = split_weight(amount, np.array(self.places_deg), self.most, negligible)
        if pieces is None:
            raise AssertionError(f"{amount} is not in the region of {self.places_deg}")
        if (find := self.find_depth) is None:
            return pieces
        return tuple(piece._replace(depth_mm=1e3 * find(piece.weight)) for piece in pieces)


def split_weight(
    wanted: complex, angles_deg: Array, most: float, noise: float = 0.0
) -> tuple[Piece, ...] | None:
    """Return the lightest weights at given angles whose sum is a given weight.

    They are the optimum of a linear program: all places within an arc of less than half a turn are
    full, the two neighbours of the arc take the remainder, and the others are empty. The proof is
    by duality: choose a price for each component of the sum so that a unit of weight at each of the
    two neighbours is worth exactly 1. Then a unit is worth more at the places between them and less
    at all others.

    Args:
        wanted: Required sum.
        angles_deg: Angles of the places, deg, shape (places,).
        most: Largest weight at one place; infinite if unlimited.
        noise: Negligible weight; rounding errors of `wanted` are negligible in any case.

    Returns:
        The weights at their places; None if no weights at these places have the required sum.
    """
    size = abs(wanted)
    if size <= noise:
        return ()
    angles, numbers, unit = _sort_places(angles_deg)
    target = wanted / size
    limit = most / size
    nothing = max(_ROUNDING, noise / size)
    count = len(angles)
    sums = np.concatenate([[0], np.cumsum(np.tile(unit, 2))])
    first = np.arange(count)
    for between in range(max(count - 1, 1) if np.isfinite(limit) else 1):
        last = first + between + 1
        full = (limit if between else 0.0) * (sums[last] - sums[first + 1])
        shares = _resolve(target - full, unit, unit[last % count], nothing)
        right = np.flatnonzero(((shares >= -nothing) & (shares <= limit + nothing)).all(axis=0))
        if len(right):
            i = int(right[0])
            amounts = enumerate([shares[0, i], *[limit] * between, shares[1, i]], i)
            parts = [(k % count, float(share)) for k, share in amounts if share > nothing]
            return tuple(
                Piece(weight=share * size, angle_deg=float(angles[k]), place=int(numbers[k]))
                for k, share in parts
            )
    return None


def find_region(angles_deg: Array, most: float) -> Region:
    """Return the region of the sums of weights at given angles: a polygon with edges parallel to
    the places' directions, or a wedge if the weights are unlimited.

    Args:
        angles_deg: Angles of the places, deg, shape (places,).
        most: Largest weight at one place; infinite if unlimited.
    """
    angles, _, unit = _sort_places(angles_deg)
    if np.isfinite(most):
        order = np.argsort(np.append(angles, angles + 180) % 360, kind="stable")
        ways = np.append(unit, -unit)[order]
        lowest = (unit.imag < -_ROUNDING) | ((np.abs(unit.imag) <= _ROUNDING) & (unit.real < 0))
        starts = most * (unit[lowest].sum() + np.append(0, np.cumsum(ways)[:-1]))
        return Region(starts=starts, ways=ways, lengths=np.full(len(ways), most))
    gaps = np.append(angles[1:], angles[0] + 360) - angles
    before = np.flatnonzero(gaps >= 180 - _ROUNDING)
    after = (before + 1) % len(angles)
    ways = np.append(unit[after], -unit[before])
    far = np.full(len(before), np.inf)
    return Region(starts=np.zeros_like(ways), ways=ways, lengths=np.append(far, -far))


def _sort_places(angles_deg: Array) -> tuple[Array, NDArray[np.intp], Complex]:
    """Return the distinct angles in [0, 360), their numbers in the list (from 1), and their unit
    vectors.
    """
    rounded = np.round(np.asarray(angles_deg) % 360, 9) % 360
    angles, first = np.unique(rounded, return_index=True)
    return angles, first + 1, np.exp(1j * np.radians(angles))


def _resolve(wanted: Complex, first: Complex, other: Complex, nothing: float) -> Array:
    """Return the weights along `first` and `other` that add up to `wanted`, shape (2, places).

    If `other` is half a turn or more ahead of `first`, only `first` is used. -1 marks an impossible
    weight.
    """
    across = (np.conj(first) * other).imag
    miss = (np.conj(first) * wanted).imag
    parts = np.array([-(np.conj(other) * wanted).imag, miss])
    alone = np.where(np.abs(miss) < nothing, (np.conj(first) * wanted).real, -1.0)
    two = across > _ROUNDING
    return np.where(two, parts / np.where(two, across, 1.0), [alone, np.zeros_like(alone)])

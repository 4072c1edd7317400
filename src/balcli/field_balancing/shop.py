"""What the shop can do in one plane: weights at places, or holes in the rim, none too heavy."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ..core.drilled_hole import find_drill_depth, find_drilled_unbalance
from ..core.smallest_largest import ANYWHERE, Region
from .model import RunsFile, read_amount_unit
from .places import Placed, find_region, split_weight
from .read import is_mass


class Piece(NamedTuple):
    """A weight to put on, or a hole that removes it: in the file's unit, at an angle of the rotor.

    Attributes:
        place: which of the plane's places it is, from 1; None where it can be anywhere.
        depth_mm: of the hole; None: nothing is drilled.
    """

    weight: float
    angle_deg: float
    place: int | None
    depth_mm: float | None


class _Hole(NamedTuple):
    """A radial hole into a rim, m; and the unbalance of one unit of weight there, kg m."""

    rim: float
    diameter: float
    per_weight: float

    def find_depth_mm(self, weight: float) -> float:
        return 1e3 * find_drill_depth(weight * self.per_weight, self.rim, self.diameter)

    def find_weight(self, depth: float) -> float:
        return find_drilled_unbalance(depth, self.rim, self.diameter) / self.per_weight


class Shop(NamedTuple):
    """One plane. Angles count as the file counts those of weights.

    Attributes:
        places_deg: where it takes weights or holes; empty: anywhere.
        most: heaviest weight in the plane, or at one place, or of one hole.
    """

    places_deg: tuple[float, ...]
    most: float
    hole: _Hole | None

    def find_region(self, on: complex, sense: int) -> Region:
        """The steps that are possible.

        Args:
            on: weight that is on in the plane already.
            sense: -1 where these steps are counted against the angles of weights, `on` too.
        """
        if self.places_deg:
            turned = sense * np.array(self.places_deg) + (180.0 if self.hole else 0.0)
            return find_region(turned, self.most)
        if math.isinf(self.most):
            return ANYWHERE
        return Region(0j if self.hole else -on, self.most)

    def plan(self, step: complex, nothing: float) -> tuple[Piece, ...]:
        """Weights or holes that together are a step in the region.

        Args:
            nothing: a weight that need not be put on.
        """
        if abs(step) <= nothing:
            return ()
        amount = -step if self.hole else step
        if not self.places_deg:
            return (self._make_piece(Placed(abs(amount), find_angle_deg(amount), None)),)
        placed = split_weight(amount, np.array(self.places_deg), self.most, nothing)
        if placed is None:
            raise AssertionError(f"{amount} is not in the region of {self.places_deg}")
        return tuple(map(self._make_piece, placed))

    def _make_piece(self, placed: Placed) -> Piece:
        depth = self.hole.find_depth_mm(min(placed.weight, self.most)) if self.hole else None
        return Piece(placed.weight, placed.angle_deg, placed.number, depth)


def find_shop(file: RunsFile, k: int) -> Shop:
    """What can be done in a plane; k is its number in the file, from 0."""
    places = file.places[k] if file.places else ()
    most = file.most[k] if file.most else math.inf
    per_weight = find_unbalance_per_weight(file, k)
    if file.drill is None or file.radius is None or per_weight is None:
        return Shop(places, most, None)
    rim = file.radius[k] / 1e3
    hole = _Hole(rim, file.drill[k] / 1e3, per_weight)
    deepest = file.deepest[k] / 1e3 if file.deepest else rim
    return Shop(places, min(most, hole.find_weight(deepest)), hole)


def find_unbalance_per_weight(file: RunsFile, k: int) -> float | None:
    """kg m of one unit of weight in a plane; None where its radius is not known."""
    scale = float(read_amount_unit(file.weight_unit).scale)
    if not is_mass(file):
        return scale
    return scale * file.radius[k] / 1e3 if file.radius else None


def find_angle_deg(number: complex) -> float:
    """Angle in [0, 360); 0 of 0."""
    angle = math.degrees(math.atan2(number.imag, number.real)) % 360
    return 0.0 if angle == 360 else angle

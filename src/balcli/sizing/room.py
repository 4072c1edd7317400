"""Compute the room around a crank for new counterweights, and half discs of steel: the first guess
of a new device's shape.

A half disc of radius R and thickness t has its centroid at 4R/(3 pi) from its diameter, so its
unbalance is `U = density t 2/3 R^3` and its mass `3 pi U/(4 R)`. A counterweight has the radius of
the room, and its thickness follows. The eccentric of a shaft is as long as its diameter: `U =
density 4/3 R^4`.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import NamedTuple

import numpy as np

from ..core.cylinders import find_innermost
from ..core.unbalance import STEEL
from ..engine.engine import Engine
from ..file.assumed import Assumed, assume, join_assumed
from .planes import find_unbalance
from .remedy import Remedy

SHARE_OF_DISTANCE = 0.7  # radius of the room over piston pin distance, without `piston.skirt`
_ROUNDING = 1e-12  # share by which a half disc may exceed its room
_ONE_PLACE = 1e-9  # throws closer than this, m, are in one plane


class HalfDisc(NamedTuple):
    """A half disc of steel whose diameter passes through the axis of rotation.

    Attributes:
        radius: Radius, m.
        thickness: Thickness, m.
    """

    radius: float
    thickness: float

    @property
    def mass(self) -> float:
        """Mass, kg."""
        return STEEL * math.pi / 2 * self.radius**2 * self.thickness

    @classmethod
    def of_radius(cls, unbalance: float, radius: float) -> HalfDisc:
        """Return the half disc of this unbalance (kg m) and radius (m)."""
        return cls(radius, 1.5 * unbalance / (STEEL * radius**3))

    @classmethod
    def of_thickness(cls, unbalance: float, thickness: float) -> HalfDisc:
        """Return the half disc of this unbalance (kg m) and thickness (m)."""
        return cls((1.5 * unbalance / (STEEL * thickness)) ** (1 / 3), thickness)

    @classmethod
    def as_long_as_wide(cls, unbalance: float) -> HalfDisc:
        """Return the half disc of this unbalance (kg m) that is as thick as its diameter."""
        radius = (0.75 * abs(unbalance) / STEEL) ** 0.25
        return cls(radius, 2 * radius)


class Room(NamedTuple):
    """Room around the axis of a crank.

    Attributes:
        radius_m: Largest radius of a counterweight; None if it is not known.
        thickness_m: Largest thickness of a counterweight, half the smallest distance of throws;
            infinite if the throws are in one plane.
    """

    radius_m: float | None
    thickness_m: float = math.inf

    def takes(self, disc: HalfDisc | None) -> bool:
        """Return whether a half disc fits; False without a half disc or a known radius."""
        if disc is None or not self.radius_m:
            return False
        has_radius = disc.radius <= self.radius_m * (1 + _ROUNDING)
        return has_radius and disc.thickness <= self.thickness_m * (1 + _ROUNDING)

    def find_disc(self, unbalance: float) -> HalfDisc | None:
        """Return the half disc of this unbalance (kg m) that has the radius of the room, however
        thick it is; None if this radius is not known.
        """
        return HalfDisc.of_radius(unbalance, self.radius_m) if self.radius_m else None

    def shape(self, unbalance: float) -> HalfDisc | None:
        """Return the half disc of this unbalance (kg m) that fits in the room; None if none
        does.
        """
        disc = self.find_disc(unbalance)
        return disc if self.takes(disc) else None


# ------------------------------------------------------------------ room of a crank
def find_rooms(engine: Engine) -> dict[str | None, Room]:
    """Return the room around each crank by the name of its engine, which is the key `engine` of a
    counterweight; None stands for the first engine.

    Args:
        engine: One engine, not an array of variants.
    """
    rooms: dict[str | None, Room] = {}
    for crank in engine.cranks:
        rooms[crank.name] = _find_room(engine, crank.engine)
        rooms.setdefault(None, rooms[crank.name])
    return rooms


def _find_room(whole: Engine, engine: Engine) -> Room:
    """Return the room around the crank of a single engine."""
    if engine.rotary or engine.of_locomotive:  # weights turn with the cylinders, or in the wheels
        return Room(None)
    limits = (_find_piston_limit(engine), _find_crankcase(whole, engine))
    known = [limit for limit in limits if limit is not None]
    radius = max(min(known), 0.0) if known else None
    return Room(radius, find_half_distance(engine))


def find_lowest_edge(engine: Engine) -> float | None:
    """Return the smallest distance of any piston's lowest edge from the crank axis, m; None if the
    file gives no skirt, or if counterweights turn with the cylinders.
    """
    skirt = None if engine.model is None else engine.model.piston.skirt
    distance = _find_pin_distance(engine)
    if skirt is None or distance is None:
        return None
    return distance - skirt / 1e3


def find_known_radius(engine: Engine) -> float | None:
    """Return the radius of the room around the crank of an engine, m, by its pistons and its
    crankcase as far as the file gives them; None if it gives neither.
    """
    limits = (find_lowest_edge(engine), _find_crankcase(engine, engine))
    return min((limit for limit in limits if limit is not None), default=None)


def assume_skirt(engine: Engine, remedies: Iterable[Remedy]) -> tuple[Assumed, ...]:
    """Return the skirt that is assumed for the room of new counterweights where a file gives none;
    empty if no remedy has a counterweight without a shape of its own.

    Args:
        engine: One engine, not an array of variants.
        remedies: New devices.
    """
    weights = [weight for remedy in remedies for weight in remedy.counterweights]
    if all(weight.sector is not None for weight in weights):
        return ()
    lists = [_assume_skirt(engine, crank.engine) for crank in engine.cranks]
    return (
        join_assumed([crank.name for crank in engine.cranks], lists) if engine.placed else lists[0]
    )


def _assume_skirt(whole: Engine, engine: Engine) -> tuple[Assumed, ...]:
    distance = _find_pin_distance(engine)
    if distance is None or engine.of_locomotive or find_lowest_edge(engine) is not None:
        return ()
    crankcase = _find_crankcase(whole, engine)
    if engine.model is None or (crankcase or math.inf) <= SHARE_OF_DISTANCE * distance:
        return ()
    skirt = round(1e3 * (1 - SHARE_OF_DISTANCE) * distance, 9)
    return (assume("piston.skirt", engine.model.piston, skirt),)


def _find_pin_distance(engine: Engine) -> float | None:
    """Return the smallest distance of a piston pin from the crank axis, m; None if it is not
    known.
    """
    if engine.rotary:
        return None
    distance = float(find_innermost(engine.cylinders).min())
    return distance if math.isfinite(distance) else None


def _find_piston_limit(engine: Engine) -> float | None:
    """Return the radius of the room under the pistons, m; None if it is not known."""
    lowest = find_lowest_edge(engine)
    distance = _find_pin_distance(engine)
    if lowest is not None or distance is None:
        return lowest
    return SHARE_OF_DISTANCE * distance


def _find_crankcase(whole: Engine, engine: Engine) -> float | None:
    """Return the radius of the crankcase, m: that of the engine's own file, else that of the file
    of all engines that are geared together; None if neither gives it.
    """
    for owner in (engine, whole):
        if owner.model is not None and owner.model.frame.crankcase is not None:
            return owner.model.frame.crankcase / 1e3
    return None


def find_half_distance(engine: Engine) -> float:
    """Return half the smallest distance of throws, m; infinite if they are in one plane."""
    gaps = np.diff(np.sort(engine.joined_throws_m))
    apart = gaps[gaps > _ONE_PLACE]
    return float(apart.min()) / 2 if apart.size else math.inf


def weigh_steel(remedy: Remedy, rooms: Mapping[str | None, Room]) -> float | None:
    """Return the mass of half discs of steel for all counterweights and shafts of a remedy, kg. A
    counterweight has the radius of the room, however thick it is; None if this radius is not known.

    Args:
        remedy: New devices.
        rooms: Rooms from `find_rooms`.
    """
    discs = [HalfDisc.as_long_as_wide(find_unbalance(shaft)) for shaft in remedy.shafts]
    for weight in remedy.counterweights:
        disc = rooms[weight.engine].find_disc(find_unbalance(weight))
        if disc is None:
            return None
        discs.append(disc)
    return sum(disc.mass for disc in discs) + 0.0

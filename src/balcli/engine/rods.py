"""Pistons and rods of an engine file: masses, lengths and moments of inertia of one cylinder, SI
(docs/theory.md).
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from ..enginefile.model import ArticulatedRod, EngineFile, Rod
from ..enginefile.units import STANDARD_GRAVITY
from ..errors import Problem
from ..limits import NEAREST_TO_LOCK

ENDS = ("small_end", "big_end")
_GROUPS = (
    ({"length"}, {"ratio"}),
    ({"mass", "cg"}, {"small_end", "big_end"}),
    ({"inertia"}, {"pendulum"}),
)


class Parts(NamedTuple):
    """Piston and rod of one cylinder, SI: `spin` is the rod's moment of inertia about its centre of
    mass, `couple` is H.
    """

    length: Any
    offset: Any
    piston: Any
    small_end: Any
    big_end: Any
    spin: Any
    couple: Any

    def top_deg(self, radius: Any) -> Any:
        """Crank angle of top dead centre."""
        return np.degrees(np.arcsin(self.offset / (radius + self.length)))


def rod_of(file: EngineFile, number: int, articulated: bool) -> Parts:
    """Piston and rod of a cylinder: the engine's, with what its own table says otherwise
    (docs/theory.md); an end of which nothing is said, a mistake, counts as weightless here.
    """
    figures = _figures(file, number, articulated)
    length = (
        figures["length"] / 1e3
        if "length" in figures
        else file.crank.stroke / 2e3 / figures["ratio"]
    )
    if figures.keys() & ENDS:
        small, big = (figures.get(end, 0.0) for end in ENDS)
    else:
        mass, from_big_end = figures.get("mass", 0.0), figures.get("cg", 0.0) / 1e3
        small, big = mass * (from_big_end / length), mass * ((length - from_big_end) / length)
    whole = small + big
    share = small / np.where(whole == 0, 1.0, whole)  # s_b / l
    if "inertia" in figures:
        spin = figures["inertia"] / 1e6
    elif "pendulum" in figures:
        swing = figures["pendulum"]
        arm = length * (share if swing.pivot == "big_end" else 1 - share)
        spin = whole * arm * (STANDARD_GRAVITY * (swing.period / (2 * math.pi)) ** 2 - arm)
    else:
        spin = whole * share * (1 - share) * length**2
    return Parts(
        length,
        own_or(file, number, "piston_offset", file.piston.offset) / 1e3,
        own_or(file, number, "piston_mass", file.piston.mass),
        small,
        big,
        spin,
        whole * share * (1 - share) * length**2 - spin,
    )


def own_or(file: EngineFile, number: int, key: str, default: Any) -> Any:
    """What `[cylinder.N]` says under this key, or else the engine's figure."""
    own = file.cylinder.get(number)
    value = None if own is None else getattr(own, key)
    return default if value is None else value


def _figures(file: EngineFile, number: int, articulated: bool) -> dict[str, Any]:
    """Figures of a rod; a figure of the cylinder's own displaces those of the engine that say the
    same otherwise.
    """
    rod, own = _given(file, articulated), file.cylinder.get(number)
    figures = {
        key: value for key in type(rod).model_fields if (value := getattr(rod, key)) is not None
    }
    if own is None:
        return figures
    mine = {
        key: value for key in Rod.model_fields if (value := getattr(own, f"rod_{key}")) is not None
    }
    for ways in _GROUPS:
        for way in ways:
            if way & mine.keys():
                for key in set().union(*ways) - way:
                    figures.pop(key, None)
    return figures | mine


def mistakes(
    file: EngineFile, number: int, rod: Parts, radius: Any, articulated: bool
) -> list[Problem]:
    """What keeps a mechanism from turning, or a rod from being one."""
    found = _half_weighed(file, number, articulated)
    if not found and not np.all(rod.spin >= 0):
        found = [_no_rod(file, number, rod, articulated)]
    lam, eps = np.max(radius / rod.length), np.max(np.abs(rod.offset / rod.length))
    if (
        articulated or lam + eps <= 1 - NEAREST_TO_LOCK
    ):  # what an articulated rod can do depends on its master
        return found
    aside = np.max(np.abs(rod.offset)) * 1e3
    offset = (
        f", with the piston offset of {aside:g} mm lambda + |offset|/length = {lam + eps:.9g}"
        if eps
        else ""
    )
    return [
        *found,
        Problem(
            _path(file, number, "length", "ratio"),
            f"the crank cannot turn: crank radius {np.max(radius) * 1e3:g} mm over rod length "
            f"{np.min(rod.length) * 1e3:g} mm is lambda = {lam:.9g}{offset}; at most 1 - "
            f"{NEAREST_TO_LOCK:g} is allowed: "
            f"make the rod longer{' or the offset smaller' if eps else ''}",
        ),
    ]


def _half_weighed(file: EngineFile, number: int, articulated: bool) -> list[Problem]:
    """A rod weighed at one end only: a cylinder's own where the engine's does not give the other,
    or the engine's (in a sweep).
    """
    given = [end for end in ENDS if end in _figures(file, number, articulated)]
    if len(given) != 1:
        return []
    (here,), (missing,) = given, set(ENDS).difference(given)
    path = _path(file, number, here, articulated=articulated)
    return [
        Problem(
            path,
            f"needs {'rod_' * path.startswith('cylinder')}{missing} beside it: weigh the rod at "
            "both ends",
        )
    ]


def _no_rod(file: EngineFile, number: int, rod: Parts, articulated: bool) -> Problem:
    """A rod whose moment of inertia would be negative: by its pendulum test, or as two masses at
    its ends.
    """
    figures = _figures(file, number, articulated)
    if "pendulum" in figures:
        return Problem(
            _path(file, number, "pendulum"),
            "the period is too quick for the distance of its pivot from the centre of mass: the "
            "moment of inertia about "
            f"it would be {np.min(rod.spin) * 1e6:g} kg mm2 (period: a full swing, s)",
        )
    length = np.min(rod.length) * 1e3
    return Problem(
        _path(file, number, "cg", articulated=articulated),
        f"{float(np.max(figures['cg'])):g} mm is outside the rod of {length:g} mm, and two masses "
        "at its ends cannot stand for "
        f"such a rod, one would be negative: give a cg from 0 to {length:g} mm, or the rod's "
        "inertia",
    )


def _path(file: EngineFile, number: int, *keys: str, articulated: bool = False) -> str:
    """Where one of these figures of a cylinder's rod is given, or the first might be."""
    own, general = file.cylinder.get(number), _given(file, articulated)
    for key in keys:
        if own is not None and getattr(own, f"rod_{key}") is not None:
            return f"cylinder.{number}.rod_{key}"
    key = next((key for key in keys if getattr(general, key, None) is not None), keys[0])
    return f"{'articulation.' if articulated else ''}rod.{key}"


def _given(file: EngineFile, articulated: bool) -> Rod | ArticulatedRod:
    """What the file says of the rods of a kind."""
    return file.articulation.rod if articulated and file.articulation else file.rod

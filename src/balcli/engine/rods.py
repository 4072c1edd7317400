"""Compute masses, lengths and moment of inertia of piston and rod of one cylinder from the figures
of a file (docs/theory.md).
"""

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ..core.phasors import EPS, Figure
from ..errors import Problem
from ..file.units import STANDARD_GRAVITY
from ..limits import NEAREST_TO_LOCK
from .figures import RodFigures, or_zero

ENDS = ("small_end", "big_end")
LENGTHS = ("length", "ratio")
# Crank radius over rod length from which on a wrong unit is likelier than a short rod: engines have
# 0.2 to 0.35, and a slip is a factor of 10 or more.
OTHER_UNIT = 2.0
_ROUNDING = 8 * EPS  # relative rounding error of the two terms of `RunningGear.couple`


class RunningGear(NamedTuple):
    """Piston and rod of one cylinder, in SI units.

    Attributes:
        length: Rod length, m.
        offset: Offset of the piston pin's path from the crank axis, m.
        piston: Piston mass, kg.
        small_end: Mass at the piston pin that, with `big_end`, replaces the rod, kg.
        big_end: Mass at the crank pin or knuckle pin, kg.
        spin: Moment of inertia of the rod about its centre of mass, kg m2.
        couple: Moment of inertia of the two masses less that of the rod, kg m2: `m a b - spin`,
            with the rod mass m and the distances a and b of its centre of mass from its ends.
    """

    length: Figure
    offset: Figure
    piston: Figure
    small_end: Figure
    big_end: Figure
    spin: Figure
    couple: Figure

    def top_deg(self, radius: Figure) -> Figure:
        """Return the angle of the crank pin from the cylinder's axis at top dead centre, deg;
        radius in m.
        """
        return np.degrees(np.arcsin(self.offset / (radius + self.length)))


class CylinderMasses(NamedTuple):
    """Masses of one cylinder as a workshop weighs them, kg.

    Attributes:
        throw: Index of the throw that carries the rod.
        piston: Mass of the piston with pin, rings and locks.
        piston_parts: Masses of the piston's parts by keys of [piston]: only `mass`, or those of
            piston, pin, rings and locks that are given.
        crosshead: Mass of the crosshead with piston rod and pin.
        small_end: Mass of the small end, without bearing shells.
        big_end: Mass of the big end, without bearing shells.
        share: This cylinder's share of the throw's unbalanced mass.
        rod_bearing: Mass of this rod's bearing shells, which turn with the pin.
        oil: Mass of the oil in this rod's bearing, which turns with the pin.
    """

    throw: int
    piston: Figure
    piston_parts: tuple[tuple[str, Figure], ...]
    small_end: Figure
    big_end: Figure
    share: Figure
    rod_bearing: Figure
    oil: Figure
    crosshead: Figure = 0.0

    @property
    def reciprocating(self) -> Figure:
        """Reciprocating mass of the cylinder, kg."""
        return self.piston + self.crosshead + self.small_end

    @property
    def rotating(self) -> Figure:
        """Rotating mass at the crank pin without that of the throw, kg."""
        return self.big_end + self.rod_bearing + self.oil


def weigh_rod(
    rod: RodFigures, length: Figure, offset: Figure = 0.0, piston: Figure = 0.0
) -> RunningGear:
    """Return the masses and moments of inertia of a rod with its piston.

    Two masses at the ends of the rod replace it; they have its total mass and its centre of mass.
    `couple` corrects their moment of inertia (docs/theory.md). A pendulum test gives the moment of
    inertia I of a rod of mass m by `I + m a^2 = m g a (T / 2 pi)^2`: T is the period, g standard
    gravity, and a the distance of the centre of mass from the pivot.

    Args:
        rod: Figures of the rod. If the mass of only one end is given, which is a mistake in the
            file, the other end counts as massless.
        length: Rod length, m.
        offset: Offset of the piston pin's path, m.
        piston: Piston mass, kg.
    """
    if rod.small_end is not None or rod.big_end is not None:
        small = or_zero(rod.small_end)
        big = or_zero(rod.big_end)
    else:
        mass = or_zero(rod.mass)
        from_big_end = or_zero(rod.cg)
        small = mass * (from_big_end / length)
        big = mass * ((length - from_big_end) / length)
    whole = small + big
    share = small / np.where(whole == 0, 1.0, whole)  # (centre of mass to big end) / length
    two_masses = whole * share * (1 - share) * length**2
    if rod.inertia is not None:
        spin = rod.inertia
    elif rod.pendulum is not None:
        arm = length * (share if rod.pendulum.pivot == "big_end" else 1 - share)
        swing = STANDARD_GRAVITY * (rod.pendulum.period / (2 * math.pi)) ** 2
        spin = whole * arm * (swing - arm)
    else:
        spin = two_masses
    couple = two_masses - spin
    couple = couple * (np.abs(couple) > _ROUNDING * (np.abs(two_masses) + np.abs(spin)))
    return RunningGear(length, offset, piston, small, big, spin, couple)


# ------------------------------------------------------------------ rules
class RodPlace(NamedTuple):
    """Figures of a cylinder's rod, with the tables from which they come.

    Attributes:
        number: Cylinder number; 0 for the general figures.
        articulated: Whether the rod is carried by a master rod.
        rod: Figures of the rod: its own ones, and general ones where it has none.
        own: Figures in the cylinder's own table.
        general: Figures in [rod] or, for an articulated rod, in [articulation.rod].
    """

    number: int
    articulated: bool
    rod: RodFigures
    own: RodFigures
    general: RodFigures

    def path(self, *keys: str) -> str:
        """Return the path of the first of these keys that the file gives, else a path for the first
        key.
        """
        for key in keys:
            if key in self.own.given:
                return f"cylinder.{self.number}.rod_{key}"
        key = next((key for key in keys if key in self.general.given), keys[0])
        return f"{'articulation.' if self.articulated else ''}rod.{key}"


def check_ends(place: RodPlace) -> Iterator[Problem]:
    """Check that a rod weighed at one end is weighed at the other as well."""
    ends = [end for end in ENDS if end in place.rod.given]
    if len(ends) == 1:
        path = place.path(*ends)
        missing = next(end for end in ENDS if end not in ends)
        other = f"rod_{missing}" if path.startswith("cylinder") else missing
        yield Problem(path, f"needs {other} as well: weigh the rod at both ends")


def check_harmonic(place: RodPlace, *, fixed: bool) -> Iterator[Problem]:
    """Check that engine and rod allow harmonic motion.

    Args:
        place: Rod and its place in the file.
        fixed: Whether all rods are on crank pins, and all cylinders at rest.
    """
    if not fixed:
        message = "harmonic motion needs a fixed cylinder whose rod or yoke is on the crank pin"
        yield Problem("rod.motion", message)
        return
    for key in {"inertia", "pendulum"} & place.rod.given.keys():
        message = "a rod in harmonic motion does not swing; leave it out"
        yield Problem(place.path(key), message)
    given = place.rod.given
    if {"mass", "cg"} <= given.keys() and not given.keys() & {*LENGTHS}:
        message = "rod.mass and rod.cg need it (or give small_end and big_end instead)"
        yield Problem.of_missing("rod.length", message)


def check_rod_inertia(place: RodPlace, gear: RunningGear) -> Iterator[Problem]:
    """Check that the moment of inertia of a rod (from a pendulum test, or of two masses at its
    ends) is not negative in any variant.

    Args:
        place: Rod and its place in the file.
        gear: Running gear of its cylinder.
    """
    if np.all(gear.spin >= 0):
        return
    if (pendulum := place.rod.pendulum) is not None:
        from_big_end = gear.length * gear.small_end / (gear.small_end + gear.big_end)
        arm = from_big_end if pendulum.pivot == "big_end" else gear.length - from_big_end
        spin, period, arm = np.broadcast_arrays(gear.spin, pendulum.period, arm)
        worst = spin.argmin()
        shortest = 2 * math.pi * math.sqrt(max(arm.flat[worst], 0.0) / STANDARD_GRAVITY)
        message = f"period {period.flat[worst]:g} s is too short: a full swing takes more than "
        message += (
            f"{shortest:.4g} s with the centre of mass {1e3 * arm.flat[worst]:g} mm from the pivot"
        )
        yield Problem(place.path("pendulum"), message)
        return
    length_mm = np.min(gear.length) * 1e3
    cg_mm = np.max(or_zero(place.rod.cg)) * 1e3
    # The general centre of mass may not fit the length of this cylinder's rod.
    path = place.path("cg")
    subject = ""
    if place.own.given.keys() & {*LENGTHS} and "cg" not in place.own.given:
        subject = f"{path} = "
        path = place.path(*LENGTHS)
    message = f"{subject}{cg_mm:g} mm is outside the rod of {length_mm:g} mm: give a cg from 0 to "
    yield Problem(path, f"{message}{length_mm:g} mm, or the rod's inertia")


def check_turning(place: RodPlace, gear: RunningGear, radius: Figure) -> Iterator[Problem]:
    """Check that a slider-crank can turn in every variant: (crank radius + |piston offset|) / rod
    length must be below 1.

    Args:
        place: Rod and its place in the file.
        gear: Running gear of its cylinder.
        radius: Crank radius, m.
    """
    radii, lengths = np.broadcast_arrays(radius, gear.length)
    ratios = radii / lengths
    lam = np.max(ratios)
    eps = np.max(np.abs(gear.offset / gear.length))
    if lam + eps <= 1 - NEAREST_TO_LOCK:
        return
    sum_ = f"; with the piston offset over rod length, the sum is {lam + eps:.9g}" if eps else ""
    worst = np.argmax(ratios)
    sizes = f"{1e3 * radii.flat[worst]:g} mm and {1e3 * lengths.flat[worst]:g} mm"
    hint = "make the rod longer"
    if lam >= OTHER_UNIT:
        hint = "are stroke and rod length in the same unit? Bare numbers are mm"
    message = (
        f"the crank cannot turn: crank radius over rod length ({sizes}) is {lam:.9g}{sum_}; at "
        f"most 1 - {NEAREST_TO_LOCK:g} is allowed: {hint}"
    )
    yield Problem(place.path(*LENGTHS), message)

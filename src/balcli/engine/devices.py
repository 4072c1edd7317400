"""Counterweights, shafts and sliders of an engine file as rotating vectors of mass x radius."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..core.cylinders import Device, DeviceKind
from ..core.phasors import Figure, unit
from ..errors import InputError, Problem
from ..file.fields import shorten
from ..file.model import Counterweight, EngineFile, Sector, Shaft, Slider, group_eccentrics
from .figures import AS_GIVEN, FileFigures, or_zero, place_in_plane

if TYPE_CHECKING:
    from .parts import Parts


def build_devices(
    model: EngineFile, figures: FileFigures, first_axis_deg: Figure
) -> Iterator[Device]:
    """Yield the counterweights, shafts and sliders of a file, in this order, as `build_device`
    does.

    Args:
        model: Engine file.
        figures: Its figures, which may vary.
        first_axis_deg: Angle of the first cylinder's axis, deg.
    """
    for path, table in model.tables():
        if isinstance(table, (Counterweight, Shaft, Slider)):
            yield build_device(table, first_axis_deg, figures, path)


def build_device(
    table: Counterweight | Shaft | Slider,
    first_axis_deg: Figure,
    figures: FileFigures = AS_GIVEN,
    path: str = "",
) -> Device:
    """Return one device, SI.

    Args:
        table: Table of an engine file.
        first_axis_deg: Direction of cylinder 1's crank pin at crank angle 0, from which the angle
            of a counterweight counts. The angles of other devices count from x.
        figures: Figures of the file.
        path: Dotted name of the table.
    """
    take = figures.take
    start = first_axis_deg if isinstance(table, Counterweight) else 0.0
    turning = _unbalance(figures, path, table) * unit(take(f"{path}.angle", table.angle) + start)
    z = take(f"{path}.position", table.position) / 1e3
    if isinstance(table, Counterweight):
        spin = take(f"{path}.inertia", table.inertia) / 1e6
        if table.sector is not None:
            spin = find_sector(table, table.sector, figures, path).inertia
        return Device(1, turning, 0j, 0j, z, DeviceKind.COUNTERWEIGHT, spin)
    x, y = figures.take_each(f"{path}.at", table.at)
    place = place_in_plane(x / 1e3, y / 1e3)
    if isinstance(table, Shaft):
        forward, backward = (turning, 0j) if table.ratio > 0 else (0j, turning)
        spin = table.ratio * take(f"{path}.inertia", table.inertia) / 1e6
        return Device(abs(table.ratio), forward, backward, place, z, DeviceKind.SHAFT, spin)
    # The displacement `U cos(n theta + angle)` is two vectors of half the size, one each way.
    half = unit(take(f"{path}.direction", table.direction)) / 2
    forward, backward = half * turning, half * np.conj(turning)
    return Device(table.order, forward, backward, place, z, DeviceKind.SLIDER)


def _unbalance(figures: FileFigures, path: str, device: Counterweight | Shaft | Slider) -> Figure:
    """Return mass x radius, kg m.

    Raises:
        InputError: It is still to be fitted.
    """
    if device.to_fit:
        command = "run balcli balance FILE --write OUT, which puts a figure in its place"
        raise InputError([Problem("", f'{path}.unbalance is "fit": {command}')])
    if isinstance(device, Counterweight) and device.sector is not None:
        return find_sector(device, device.sector, figures, path).unbalance
    return or_zero(find_given_unbalance(device, figures, path))


def find_given_unbalance(
    device: Counterweight | Shaft | Slider, figures: FileFigures = AS_GIVEN, path: str = ""
) -> Figure | None:
    """Return mass x radius, kg m; None where the file gives neither it nor mass and radius.

    Raises:
        InputError: Only one of mass and radius varies, and the file gives neither.
    """
    unbalance = figures.take_optional(f"{path}.unbalance", device.unbalance)
    if unbalance is not None:
        return unbalance / 1e6
    mass = figures.take_optional(f"{path}.mass", device.mass)
    radius = figures.take_optional(f"{path}.radius", device.radius)
    if mass is not None and radius is not None:
        return mass * radius / 1e3
    if mass is not None or radius is not None:
        raise InputError([Problem(path, "the file gives neither mass nor radius; vary unbalance")])
    return None


class SectorMoments(NamedTuple):
    """Moments of the area of a sector of a disc about the axis of the disc.

    Attributes:
        area: Area, m2.
        first: First moment, along the middle of the sector, m3.
        polar: Polar second moment, m4.
    """

    area: Figure
    first: Figure
    polar: Figure


def find_sector_moments(inner: Figure, outer: Figure, opening_deg: Figure) -> SectorMoments:
    """Return the moments of a sector: `q/2 (R^2 - r^2)`, `2/3 (R^3 - r^3) sin(q/2)`, `q/4 (R^4 -
    r^4)`, integrals of r, r^2 cos and r^3 over the sector.

    Args:
        inner: Inner radius r, m.
        outer: Outer radius R, m.
        opening_deg: Full angle q, deg.
    """
    angle = opening_deg * (math.pi / 180)
    sine = unit(opening_deg / 2).imag + 0.0  # exactly 0 for a whole ring
    return SectorMoments(
        angle / 2 * (outer**2 - inner**2),
        2 / 3 * (outer**3 - inner**3) * sine,
        angle / 4 * (outer**4 - inner**4),
    )


class SectorFigures(NamedTuple):
    """Figures of a counterweight in the shape of a sector, SI.

    Attributes:
        thickness: Thickness, m.
        mass: Mass, kg.
        center_of_mass: Distance of its center of mass from the crank axis, m.
        unbalance: Mass x distance, kg m.
        inertia: Polar moment of inertia about the crank axis, kg m2.
    """

    thickness: Figure
    mass: Figure
    center_of_mass: Figure
    unbalance: Figure
    inertia: Figure


def find_sector(
    table: Counterweight, sector: Sector, figures: FileFigures = AS_GIVEN, path: str = ""
) -> SectorFigures:
    """Return the figures of a counterweight from the thickness of its sector, or from its
    unbalance.

    Args:
        table: The counterweight.
        sector: Its sector.
        figures: Figures of the file.
        path: Dotted name of the counterweight.

    Raises:
        InputError: Thickness and unbalance are both given, or inertia, which only variants do.
    """
    inner, outer, opening, density = (
        figures.take(f"{path}.sector.{key}", getattr(sector, key))
        for key in ("inner_radius", "outer_radius", "opening", "density")
    )
    moments, per_volume = find_sector_moments(inner / 1e3, outer / 1e3, opening), density * 1e3
    thickness = figures.take_optional(f"{path}.sector.thickness", sector.thickness)
    unbalance = find_given_unbalance(table, figures, path)
    is_double = thickness is not None and unbalance is not None
    if is_double or figures.is_displaced(f"{path}.sector"):
        told = "the file gives a sector, by its thickness or by an unbalance; vary that one"
        raise InputError([Problem(path, told)])
    if thickness is None:
        thickness = or_zero(unbalance) / (per_volume * moments.first)
    else:
        thickness = thickness / 1e3
        unbalance = per_volume * thickness * moments.first
    return SectorFigures(
        thickness,
        per_volume * thickness * moments.area,
        moments.first / moments.area,
        or_zero(unbalance),
        per_volume * thickness * moments.polar,
    )


# ------------------------------------------------------------------ rules between entries
_OF_SHAFT = ("inertia", "bearings", "gear", "drag")  # keys of a whole shaft


def check_shafts(parts: Parts) -> Iterator[Problem]:
    """Check that eccentrics of one name have one ratio and place, that each key of the whole shaft
    stands in one of them, and that a shaft with drag has a gear.
    """
    for name, entries in group_eccentrics(parts.model.shaft):
        (first, table), *others = entries.items()
        for number, other in others:
            for key in ("ratio", "at"):
                if (value := getattr(other, key)) != (wanted := getattr(table, key)):
                    told = f'is {shorten(value)}, but shaft.{first} of the name "{name}" has '
                    told += f"{shorten(wanted)}: give eccentrics of one shaft the same {key}"
                    yield Problem(f"shaft.{number}.{key}", told)
        given = {key: [k for k, one in entries.items() if one.has(key)] for key in _OF_SHAFT}
        for key, numbers in given.items():
            for number in numbers[1:]:
                told = f'stands in shaft.{numbers[0]} of the name "{name}" already; give it once'
                yield Problem(f"shaft.{number}.{key}", told)
        if given["drag"] and not given["gear"]:
            told = "needs gear, such as { position = -150, radius = 35, direction = 90 }"
            yield Problem(f"shaft.{given['drag'][0]}.drag", told)

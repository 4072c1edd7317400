"""Compute the rotating vectors (mass x radius) of counterweights, shafts and sliders of a file."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from itertools import product
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..core.cylinders import Device, DeviceKind
from ..core.phasors import Complex, Figure, unit
from ..errors import InputError, Message, Problem
from ..file.fields import shorten
from ..file.model import Counterweight, EngineFile, Sector, Shaft, Slider
from ..file.table import label_table
from .figures import AS_GIVEN, FileFigures, divide, or_zero, place_in_plane, value_or

if TYPE_CHECKING:
    from .parts import Parts


def build_devices(parts: Parts) -> Iterator[Device]:
    """Yield all devices of a file in SI units: first the coupling masses of a locomotive and the
    webs of the crankshaft, then counterweights, shafts and sliders.

    Args:
        parts: Parts of the engine, whose figures may vary.
    """
    first_axis_deg = parts.pins.axes_deg[1]
    yield from _build_coupling_pins(parts, first_axis_deg)
    if parts.webs is not None:
        yield from (web.device for web in parts.webs.webs)
    for path, table in parts.model.tables():
        if isinstance(table, Shaft) and table.drifts:
            continue
        if isinstance(table, (Counterweight, Shaft, Slider)):
            yield build_device(table, first_axis_deg, parts.figures, path)


def _build_coupling_pins(parts: Parts, first_axis_deg: Figure) -> Iterator[Device]:
    """Yield the coupling masses of a locomotive, which turn with its axles as counterweights do."""
    table = parts.model.locomotive
    figures = parts.figures
    if table is None or table.coupling_planes is None or table.coupling_angles is None:
        return
    given = figures.take_optional("locomotive.coupling_radius", table.coupling_radius)
    radius = value_or(divide(given, 1e3), parts.find_radius(1))
    planes = figures.take_each("locomotive.coupling_planes", table.coupling_planes)
    angles = figures.take_each("locomotive.coupling_angles", table.coupling_angles)
    for k, axle in enumerate(parts.model.axle, 1):
        path = f"axle.{label_table(axle, k)}.coupling_mass"
        masses = figures.take_for_each(path, axle.coupling_mass, 2)
        for mass, z, angle in zip(masses, planes, angles, strict=True):
            turning = _turn(mass * radius, angle + first_axis_deg)
            if np.any(mass):
                kind = DeviceKind.COUNTERWEIGHT
                rods = Device(1, turning, 0j, 0j, z / 1e3, kind, axle=axle.name)
                yield rods._replace(is_coupling=True)


def build_device(
    table: Counterweight | Shaft | Slider,
    first_axis_deg: Figure,
    figures: FileFigures = AS_GIVEN,
    path: str = "",
) -> Device:
    """Return a device in SI units.

    Args:
        table: Table of the device in an engine file.
        first_axis_deg: Direction of cylinder 1's crank pin at crank angle 0, deg. Angles of
            counterweights count from it, angles of other devices from x.
        figures: Figures of the file.
        path: Dotted name of the table.

    Raises:
        InputError: The unbalance is "fit".
    """
    if table.to_fit:
        message = Message(
            '{path}.unbalance is "fit": run balcli balance, which puts a figure in its place '
            "({write} names the new file)",
            path=path,
        )
        raise InputError([Problem("", message)])
    take = figures.take
    sector = None
    unbalance = find_given_unbalance(table, figures, path)
    if isinstance(table, (Counterweight, Shaft)) and table.sector is not None:
        sector = find_sector(table, table.sector, figures, path)
        unbalance = sector.unbalance
    start = first_axis_deg if isinstance(table, Counterweight) else 0.0
    turning = _turn(or_zero(unbalance), take(f"{path}.angle", table.angle) + start)
    z = take(f"{path}.position", table.position) / 1e3
    if isinstance(table, Counterweight):
        spin = take(f"{path}.inertia", table.inertia) / 1e6 if sector is None else sector.inertia
        return Device(
            1, turning, 0j, 0j, z, DeviceKind.COUNTERWEIGHT, spin=spin, axle=table.axle or ""
        )
    x, y = figures.take_each(f"{path}.at", table.at)
    place = place_in_plane(x / 1e3, y / 1e3)
    if isinstance(table, Shaft):
        forward, backward = (turning, 0j) if table.ratio > 0 else (0j, turning)
        order = abs(table.ratio)
        compensates = table.role == "compensator"
        inertia = take(f"{path}.inertia", table.inertia) / 1e6 if sector is None else sector.inertia
        spin = table.ratio * inertia
        kind = DeviceKind.SHAFT
        return Device(order, forward, backward, place, z, kind, compensates, spin)
    # With unbalance U, order n and crank angle theta, the vector `U cos(n theta + angle)` along the
    # slider's path is the sum of two vectors of size U/2, which turn in opposite directions.
    half = _turn(0.5, take(f"{path}.direction", table.direction))
    forward = half * turning
    backward = half * np.conj(turning)
    return Device(table.order, forward, backward, place, z, DeviceKind.SLIDER)


def _turn(size: Figure, angle_deg: Figure) -> Complex:
    """Return the vector that has this size and, at crank angle 0, this direction (deg)."""
    return size * unit(angle_deg)


def find_given_unbalance(
    device: Counterweight | Shaft | Slider, figures: FileFigures = AS_GIVEN, path: str = ""
) -> Figure | None:
    """Return the unbalance, kg m; None if the file gives neither unbalance nor mass and radius.

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


class SectorFigures(NamedTuple):
    """Figures of a counterweight or eccentric in the shape of a sector, in SI units; mass, centre
    of mass and inertia of an eccentric include the core of the shaft.

    Attributes:
        unbalance: Mass x distance of the centre of mass from the axis of rotation, kg m.
        mass: Mass, kg.
        center_of_mass: Distance of the centre of mass from the axis of rotation, m.
        thickness: Thickness, m.
        inertia: Polar moment of inertia about the axis of rotation, kg m2.
    """

    unbalance: Figure
    mass: Figure
    center_of_mass: Figure
    thickness: Figure
    inertia: Figure


def find_sector(
    table: Counterweight | Shaft, sector: Sector, figures: FileFigures = AS_GIVEN, path: str = ""
) -> SectorFigures:
    """Return the figures of a counterweight, or of an eccentric on its shaft, from the thickness of
    its sector, or from its unbalance.

    With the inner radius r, the outer radius R and the opening angle q, the sector has the area
    `q/2 (R^2 - r^2)` and, about the axis of rotation, the first moment `2/3 (R^3 - r^3) sin(q/2)`
    and the polar second moment `q/4 (R^4 - r^4)`. The core of a shaft adds the area `pi r^2` and
    the polar second moment `pi r^4/2`.

    Args:
        table: The counterweight or eccentric.
        sector: Its sector.
        figures: Figures of the file.
        path: Dotted name of its table.

    Raises:
        InputError: A figure varies that the file does not give: the unbalance of a sector with
            thickness, the thickness of a sector with unbalance, or the inertia.
    """
    inner, outer, opening, density = (
        figures.take(f"{path}.sector.{key}", getattr(sector, key))
        for key in ("inner_radius", "outer_radius", "opening", "density")
    )
    thickness = figures.take_optional(f"{path}.sector.thickness", sector.thickness)
    unbalance = find_given_unbalance(table, figures, path)
    is_double = thickness is not None and unbalance is not None
    if is_double or f"{path}.sector" in figures.displaced:
        message = "the file gives thickness or unbalance of the sector; vary the one that it gives"
        raise InputError([Problem(path, message)])
    inner = inner / 1e3
    outer = outer / 1e3
    angle = opening * (math.pi / 180)
    area = angle / 2 * (outer**2 - inner**2)
    first = 2 / 3 * (_turn(outer**3 - inner**3, opening / 2).imag + 0.0)  # 0 for a whole ring
    # mass per area of the sector, kg/m2
    weight = density * or_zero(thickness) if unbalance is None else unbalance / first
    polar = angle / 4 * (outer**4 - inner**4)
    if isinstance(table, Shaft):
        area = area + math.pi * inner**2
        polar = polar + math.pi / 2 * inner**4
    return SectorFigures(
        weight * first, weight * area, first / area, weight / (1e3 * density), weight * polar
    )


# ------------------------------------------------------------------ rules between entries
def group_eccentrics(shafts: Iterable[Shaft]) -> list[tuple[str, dict[int, Shaft]]]:
    """Return the entries of each balancer shaft, with their numbers in the file, from 1.

    Args:
        shafts: All [[shaft]] tables.

    Returns: For each shaft, its name (without a name, `shaft 2` by its number) and its entries.
    """
    groups: dict[tuple[str, int], dict[int, Shaft]] = {}
    for number, table in enumerate(shafts, 1):
        key = table.name, 0 if table.name else number
        groups.setdefault(key, {})[number] = table
    return [(name or f"shaft {number}", entries) for (name, number), entries in groups.items()]


def check_drifting(parts: Parts) -> Iterator[Problem]:
    """Check that shafts without a fixed phase to the crank have no key that needs one."""
    yield from list_drifting_problems(parts.model)


def list_drifting_problems(model: EngineFile) -> Iterator[Problem]:
    """Yield the shafts without a fixed phase to the crank that have a key that needs one."""
    uneven = bool(model.operation.speed_ripple)
    for number, shaft in enumerate(model.shaft, 1):
        if not shaft.drifts:
            continue
        for is_wrong, cause in (
            (uneven, "operation.speed_ripple"),
            (shaft.to_fit, 'unbalance = "fit"'),
            (shaft.role == "compensator", 'role = "compensator"'),
        ):
            if is_wrong:
                yield refuse_drifting(f"shaft.{number}", shaft, cause)


def refuse_drifting(path: str, shaft: Shaft, cause: str) -> Problem:
    """Return the problem of a shaft whose ratio does not go together with another key.

    Args:
        path: Dotted name of its table.
        shaft: The shaft.
        cause: The other key, such as `role = "compensator"`.
    """
    told = f"{shaft.ratio:g} does not go together with {cause}; give a multiple of 1/2"
    return Problem(f"{path}.ratio", told)


def check_shafts(parts: Parts) -> Iterator[Problem]:
    """Check the [[shaft]] tables with the same name, which are the eccentrics of one shaft: their
    `ratio` and `at` are equal, a key that describes the whole shaft is in only one of them, and a
    shaft with `drag` has a `gear`.
    """
    for name, entries in group_eccentrics(parts.model.shaft):
        first, *others = entries
        for number, key in product(others, ("ratio", "at")):
            value, wanted = (shorten(getattr(entries[k], key)) for k in (number, first))
            if value != wanted:
                message = f'is {value}, but shaft.{first} with the name "{name}" has {wanted}: '
                yield Problem(f"shaft.{number}.{key}", f"{message}give both the same {key}")
        for key in ("inertia", "bearings", "gear", "drag"):
            for number in [k for k, one in entries.items() if one.has(key)][1:]:
                message = f'is given twice for the shaft "{name}"; give it once'
                yield Problem(f"shaft.{number}.{key}", message)
        shaped = [number for number, one in entries.items() if one.sector is not None]
        given = [number for number, one in entries.items() if one.has("inertia")]
        if shaped and given and shaped != given:
            message = (
                f'is given for the shaft "{name}", whose inertia follows from '
                f"shaft.{shaped[0]}.sector; give one of them"
            )
            yield Problem(f"shaft.{given[0]}.inertia", message)
        driven = [number for number, one in entries.items() if one.drag]
        if driven and not any(one.gear for one in entries.values()):
            message = "needs gear, such as { position = -150, radius = 35, direction = 90 }"
            yield Problem(f"shaft.{driven[0]}.drag", message)

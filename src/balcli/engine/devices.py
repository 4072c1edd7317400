"""Counterweights, shafts and sliders of an engine file as rotating vectors of mass x radius."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from ..core.cylinders import Device, DeviceKind
from ..core.phasors import Figure, unit
from ..errors import InputError, Problem
from ..file.model import Counterweight, Shaft, Slider, label_table
from .figures import AS_GIVEN, FileFigures, divide, or_zero, place_in_plane, value_or

if TYPE_CHECKING:
    from .parts import Parts


def build_devices(parts: Parts) -> Iterator[Device]:
    """Yield the coupling masses of a locomotive, and the counterweights, shafts and sliders of a
    file, in this order, as `build_device` does.

    Args:
        parts: Parts of the engine, whose figures may vary.
    """
    first_axis_deg = parts.pins.axes_deg[1]
    yield from _build_coupling_pins(parts, first_axis_deg)
    for path, table in parts.model.tables():
        if isinstance(table, (Counterweight, Shaft, Slider)):
            yield build_device(table, first_axis_deg, parts.figures, path)


def _build_coupling_pins(parts: Parts, first_axis_deg: Figure) -> Iterator[Device]:
    """Yield the coupling masses of a locomotive, which turn with its axles, as counterweights."""
    table, figures = parts.model.locomotive, parts.figures
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
            turning, kind = mass * radius * unit(angle + first_axis_deg), DeviceKind.COUNTERWEIGHT
            if np.any(mass):
                yield Device(1, turning, 0j, 0j, z / 1e3, kind, axle.name)


def build_device(
    table: Counterweight | Shaft | Slider,
    first_axis_deg: Figure,
    figures: FileFigures = AS_GIVEN,
    path: str = "",
) -> Device:
    """Return a device in SI units.

    Args:
        table: Table of an engine file.
        first_axis_deg: Direction of cylinder 1's crank pin at crank angle 0, deg. Angles of
            counterweights count from it, angles of other devices from x.
        figures: Figures of the file.
        path: Dotted name of the table.
    """
    take = figures.take
    start = first_axis_deg if isinstance(table, Counterweight) else 0.0
    turning = _unbalance(figures, path, table) * unit(take(f"{path}.angle", table.angle) + start)
    z = take(f"{path}.position", table.position) / 1e3
    if isinstance(table, Counterweight):
        return Device(1, turning, 0j, 0j, z, DeviceKind.COUNTERWEIGHT, table.axle or "")
    x, y = figures.take_each(f"{path}.at", table.at)
    place = place_in_plane(x / 1e3, y / 1e3)
    if isinstance(table, Shaft):
        forward, backward = (turning, 0j) if table.ratio > 0 else (0j, turning)
        return Device(abs(table.ratio), forward, backward, place, z, DeviceKind.SHAFT)
    # The displacement `U cos(n theta + angle)` is the sum of two vectors of half the size, which
    # turn in opposite directions.
    half = unit(take(f"{path}.direction", table.direction)) / 2
    forward, backward = half * turning, half * np.conj(turning)
    return Device(table.order, forward, backward, place, z, DeviceKind.SLIDER)


def _unbalance(figures: FileFigures, path: str, device: Counterweight | Shaft | Slider) -> Figure:
    """Return mass x radius, kg m.

    Raises:
        InputError: The unbalance is "fit".
    """
    if device.to_fit:
        command = "run balcli balance FILE --write OUT, which puts a figure in its place"
        raise InputError([Problem("", f'{path}.unbalance is "fit": {command}')])
    unbalance = figures.take_optional(f"{path}.unbalance", device.unbalance)
    if unbalance is not None:
        return unbalance / 1e6
    mass = or_zero(figures.take_optional(f"{path}.mass", device.mass))
    return mass * or_zero(figures.take_optional(f"{path}.radius", device.radius)) / 1e3

"""Counterweights, shafts and sliders of an engine file as rotating vectors of mass x radius."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..core.cylinders import Device, DeviceKind
from ..core.phasors import Figure, unit
from ..errors import InputError, Problem
from ..file.model import Counterweight, EngineFile, Shaft, Slider
from .figures import AS_GIVEN, FileFigures, or_zero, place_in_plane


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
        return Device(1, turning, 0j, 0j, z, DeviceKind.COUNTERWEIGHT)
    x, y = figures.take_each(f"{path}.at", table.at)
    place = place_in_plane(x / 1e3, y / 1e3)
    if isinstance(table, Shaft):
        forward, backward = (turning, 0j) if table.ratio > 0 else (0j, turning)
        order, compensates = abs(table.ratio), table.role == "compensator"
        return Device(order, forward, backward, place, z, DeviceKind.SHAFT, compensates)
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
    unbalance = figures.take_optional(f"{path}.unbalance", device.unbalance)
    if unbalance is not None:
        return unbalance / 1e6
    mass = or_zero(figures.take_optional(f"{path}.mass", device.mass))
    return mass * or_zero(figures.take_optional(f"{path}.radius", device.radius)) / 1e3

"""Counterweights, shafts and sliders of an engine file as rotating vectors of mass x radius."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from ..core.cylinders import Device, DeviceKind
from ..core.phasors import Complex, Figure, unit
from ..enginefile.model import Counterweight, EngineFile, Shaft, Slider
from .arrays import place_in_plane
from .figures import AS_GIVEN, FileFigures, or_nothing


def build_devices(
    model: EngineFile, figures: FileFigures, first_axis_deg: Figure
) -> Iterator[Device]:
    """The devices of a file: its counterweights, shafts and sliders, in this order."""
    for path, table in model.tables():
        if isinstance(table, (Counterweight, Shaft, Slider)):
            yield build_device(table, first_axis_deg, figures, path)


def build_device(
    table: Counterweight | Shaft | Slider,
    first_axis_deg: Figure,
    figures: FileFigures = AS_GIVEN,
    path: str = "",
) -> Device:
    """One device, SI.

    Args:
        table: what an engine file says, or would say, of it.
        first_axis_deg: from which the angle of a counterweight counts: where cylinder 1's pin
            points at crank angle 0. Those of others count from x.
        figures, path: what varies, and the name of the table.
    """
    match table:
        case Counterweight():
            return _counterweight(figures, path, table, first_axis_deg)
        case Shaft():
            return _shaft(figures, path, table)
        case Slider():
            return _slider(figures, path, table)


def _counterweight(
    figures: FileFigures, path: str, weight: Counterweight, first_axis_deg: Figure
) -> Device:
    angle = figures.take(f"{path}.angle", weight.angle)
    forward = _unbalance(figures, path, weight) * unit(angle + first_axis_deg)
    z = _position(figures, path, weight)
    return Device(1, forward, 0j, 0j, z, DeviceKind.COUNTERWEIGHT)


def _shaft(figures: FileFigures, path: str, shaft: Shaft) -> Device:
    angle = figures.take(f"{path}.angle", shaft.angle)
    turning = _unbalance(figures, path, shaft) * unit(angle)
    forward, backward = (turning, 0j) if shaft.ratio > 0 else (0j, turning)
    place, z = _place(figures, path, shaft.at), _position(figures, path, shaft)
    return Device(abs(shaft.ratio), forward, backward, place, z, DeviceKind.SHAFT)


def _slider(figures: FileFigures, path: str, slider: Slider) -> Device:
    """Its displacement `U cos(n theta + angle)` is two vectors of half the size, one each way."""
    half = _unbalance(figures, path, slider) / 2
    direction = unit(figures.take(f"{path}.direction", slider.direction))
    phase = unit(figures.take(f"{path}.angle", slider.angle))
    forward, backward = half * direction * phase, half * direction * np.conj(phase)
    place, z = _place(figures, path, slider.at), _position(figures, path, slider)
    return Device(slider.order, forward, backward, place, z, DeviceKind.SLIDER)


def _unbalance(figures: FileFigures, path: str, device: Counterweight | Shaft | Slider) -> Figure:
    """Mass x radius, kg m."""
    unbalance = figures.take_optional(f"{path}.unbalance", device.unbalance)
    if unbalance is not None:
        return unbalance / 1e6
    mass = or_nothing(figures.take_optional(f"{path}.mass", device.mass))
    return mass * or_nothing(figures.take_optional(f"{path}.radius", device.radius)) / 1e3


def _place(figures: FileFigures, path: str, at: Sequence[float]) -> complex | Complex:
    """x + iy of the device's axis, m."""
    x, y = figures.take_each(f"{path}.at", at)
    return place_in_plane(x / 1e3, y / 1e3)


def _position(figures: FileFigures, path: str, device: Counterweight | Shaft | Slider) -> Figure:
    """z, m."""
    return figures.take(f"{path}.position", device.position) / 1e3

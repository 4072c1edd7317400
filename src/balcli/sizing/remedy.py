"""Remedy: the devices that a scheme fits, as tables of the engine file, so that what is written is
exactly what is analysed.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Any, NamedTuple

from ..core.cylinders import Device
from ..core.phasors import EPS, reduced
from ..engine.build import Engine
from ..engine.devices import build_device
from ..enginefile.model import Counterweight, Shaft, Slider


class Remedy(NamedTuple):
    """New devices, in the units of the engine file (g mm, deg, mm), each with its reason in plain
    words.

    Attributes:
        order: the order that it is for, where the scheme has one.
        details: figures of the scheme that are no device, SI with the unit in their names.
        beyond: devices that no engine file can describe, SI.
    """

    scheme: str
    order: int | None = None
    counterweights: tuple[Counterweight, ...] = ()
    shafts: tuple[Shaft, ...] = ()
    sliders: tuple[Slider, ...] = ()
    reasons: tuple[str, ...] = ()
    details: Mapping[str, Any] = MappingProxyType({})
    beyond: tuple[Device, ...] = ()

    @property
    def devices(self) -> tuple[Counterweight | Shaft | Slider, ...]:
        return (*self.counterweights, *self.shafts, *self.sliders)


def fitted(engine: Engine, remedy: Remedy) -> Engine:
    """The engine with the devices of a remedy added to its own, in the order in which its file
    would have them.
    """
    new = (build_device(table, engine.first_axis_deg) for table in remedy.devices)
    everything = (*engine.devices, *new, *remedy.beyond)
    return replace(engine, devices=tuple(sorted(everything, key=lambda device: device.rank)))


# ------------------------------------------------------------------ unbalance (kg m, complex) ->
# table
def counterweight(unbalance: complex, z: float, first_axis_deg: float) -> Counterweight:
    """A weight on the crankshaft; its angle counts from cylinder 1's pin."""
    size, angle = _polar(unbalance, first_axis_deg)
    return Counterweight.model_construct(unbalance=size, angle=angle, position=_millimetres(z))


def shaft(unbalance: complex, ratio: int, z: float, place: complex) -> Shaft:
    """An eccentric of a balancer shaft; its angle counts from x."""
    size, angle = _polar(unbalance)
    return Shaft.model_construct(
        ratio=ratio, unbalance=size, angle=angle, at=_at(place), position=_millimetres(z)
    )


def slider(
    amplitude: complex, order: int, direction_deg: float, z: float, place: complex
) -> Slider:
    """A reciprocating mass whose displacement is the real part of `amplitude e^{i n theta}` along
    its direction.
    """
    size, angle = _polar(amplitude)
    return Slider.model_construct(
        order=order,
        unbalance=size,
        direction=direction_deg,
        angle=angle,
        at=_at(place),
        position=_millimetres(z),
    )


def degrees(vector: complex, origin_deg: float = 0.0) -> float:
    """Direction of a vector from `origin_deg`, in (-180, 180]."""
    return _plain(float(reduced(math.degrees(cmath.phase(vector)) - origin_deg, 360)), 360)


def _polar(vector: complex, origin_deg: float = 0.0) -> tuple[float, float]:
    """g mm and degrees."""
    return abs(vector) * 1e6, degrees(vector, origin_deg)


def _at(place: complex) -> tuple[float, float]:
    return _millimetres(place.real), _millimetres(place.imag)


def _millimetres(metres: float) -> float:
    return _plain(metres * 1e3, abs(metres * 1e3))


def _plain(figure: float, size: float) -> float:
    """The figure with nine decimals, as people would write it, where that is the same to an ulp of
    `size`.
    """
    short = round(figure, 9) + 0.0
    return short if abs(figure - short) <= size * EPS else figure

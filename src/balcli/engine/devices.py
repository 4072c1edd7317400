"""Counterweights, balancer shafts and sliders of an engine file as rotating vectors of mass x
radius.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Any

import numpy as np

from ..core.cylinders import Device
from ..core.phasors import unit
from ..enginefile.model import Counterweight, Shaft, Slider


def devices(
    tables: Iterable[Counterweight | Shaft | Slider], first_axis_deg: Any
) -> Iterator[Device]:
    """What the tables of a file describe; a counterweight's angle counts from cylinder 1's pin,
    others from x.
    """
    for table in tables:
        match table:
            case Counterweight():
                yield _counterweight(table, first_axis_deg)
            case Shaft():
                yield _shaft(table)
            case Slider():
                yield _slider(table)


def _counterweight(d: Counterweight, first_axis_deg: Any) -> Device:
    return Device(1, _unbalance(d) * unit(d.angle + first_axis_deg), 0j, 0j, d.position / 1e3, 0)


def _shaft(d: Shaft) -> Device:
    turning = _unbalance(d) * unit(d.angle)
    forward, backward = (turning, 0j) if d.ratio > 0 else (0j, turning)
    return Device(abs(d.ratio), forward, backward, _place(d.at), d.position / 1e3, 1)


def _slider(d: Slider) -> Device:
    """Its displacement `U cos(n theta + angle)` is two vectors of half the size, turning against
    each other.
    """
    half, direction, phase = _unbalance(d) / 2, unit(d.direction), unit(d.angle)
    return Device(
        d.order,
        half * direction * phase,
        half * direction * np.conj(phase),
        _place(d.at),
        d.position / 1e3,
        2,
    )


def _unbalance(d: Counterweight | Shaft | Slider) -> Any:
    """kg m"""
    if d.unbalance is not None:
        return d.unbalance / 1e6
    mass, radius = (0.0 if figure is None else figure for figure in (d.mass, d.radius))
    return mass * radius / 1e3


def _place(at: Sequence[Any]) -> Any:
    return at[0] / 1e3 + 1j * (at[1] / 1e3)

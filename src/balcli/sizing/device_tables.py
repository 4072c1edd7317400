"""Devices as tables of the engine file (g mm, degrees, mm), made from SI: what is written is
exactly what is analysed.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from typing import TypeAlias, TypeGuard

from ..core.phasors import EPS, wrap_degrees
from ..enginefile.model import Counterweight, Shaft, Slider

DeviceTable: TypeAlias = Counterweight | Shaft | Slider

# what describes a new device of each kind: the kinds and their fields in the order of the file
FIELDS: dict[type[DeviceTable], tuple[str, ...]] = {
    Counterweight: ("unbalance", "angle", "position"),
    Shaft: ("ratio", "unbalance", "angle", "at", "position"),
    Slider: ("order", "unbalance", "direction", "angle", "at", "position"),
}
KINDS = tuple(FIELDS)
_ROUNDING = 1e-12  # of the largest eccentric: less together is no force


def name_kind(device: DeviceTable) -> str:
    """The name of its table in an engine file: "counterweight", "shaft" or "slider"."""
    return type(device).__name__.lower()


def find_unbalance(device: DeviceTable) -> float:
    """Unbalance of a device that a scheme made, kg m."""
    return (device.unbalance or 0.0) / 1e6


def find_free(devices: Sequence[DeviceTable]) -> tuple[bool, ...]:
    """Which devices belong to a shaft that may stand anywhere, because its eccentrics together make
    a moment and no force, and nobody has said where it stands.
    """
    turned: dict[int, list[complex]] = {}
    for device in devices:
        if _stands_nowhere(device):
            turned.setdefault(device.ratio, []).append(_as_vector(device))
    free = {
        ratio
        for ratio, vectors in turned.items()
        if len(vectors) > 1 and abs(sum(vectors)) <= _ROUNDING * max(map(abs, vectors))
    }
    return tuple(_stands_nowhere(device) and device.ratio in free for device in devices)


def _stands_nowhere(device: DeviceTable) -> TypeGuard[Shaft]:
    """A shaft on the crank axis, where it is put if nothing is said of its place."""
    return isinstance(device, Shaft) and not any(device.at)


def _as_vector(shaft: Shaft) -> complex:
    return cmath.rect(find_unbalance(shaft), math.radians(shaft.angle))


def make_counterweight(unbalance: complex, z: float, first_axis_deg: float) -> Counterweight:
    """A weight on the crankshaft.

    Args:
        unbalance: kg m, its direction at crank angle 0 counting from x.
        z: m.
        first_axis_deg: direction of cylinder 1's crank pin, from which the file's angle counts.
    """
    size, angle = _polar(unbalance, first_axis_deg)
    return Counterweight.model_construct(unbalance=size, angle=angle, position=_millimetres(z))


def make_shaft(unbalance: complex, ratio: int, z: float, place: complex) -> Shaft:
    """An eccentric of a balancer shaft.

    Args:
        unbalance: kg m, its direction at crank angle 0.
        ratio: times crank speed, negative if it turns against the crank.
        z, place: m, x + iy.
    """
    size, angle = _polar(unbalance)
    return Shaft.model_construct(
        ratio=ratio, unbalance=size, angle=angle, at=_at(place), position=_millimetres(z)
    )


def make_slider(
    unbalance: complex, order: int, direction_deg: float, z: float, place: complex
) -> Slider:
    """A reciprocating mass.

    Args:
        unbalance: kg m; mass times displacement is the real part of `unbalance e^{i order theta}`.
        direction_deg: of its path, from x.
        z, place: m, x + iy.
    """
    size, angle = _polar(unbalance)
    return Slider.model_construct(
        order=order,
        unbalance=size,
        direction=direction_deg,
        angle=angle,
        at=_at(place),
        position=_millimetres(z),
    )


def measure_direction(vector: complex, origin_deg: float = 0.0) -> float:
    """Direction of a vector, degrees from `origin_deg`, in (-180, 180]."""
    return _plain(float(wrap_degrees(math.degrees(cmath.phase(vector)) - origin_deg, 360)), 360)


def _polar(unbalance: complex, origin_deg: float = 0.0) -> tuple[float, float]:
    """kg m -> g mm and degrees."""
    return abs(unbalance) * 1e6, measure_direction(unbalance, origin_deg)


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

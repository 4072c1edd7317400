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
            vector = cmath.rect(find_unbalance(device), math.radians(device.angle))
            turned.setdefault(device.ratio, []).append(vector)
    free = {
        ratio
        for ratio, vectors in turned.items()
        if len(vectors) > 1 and abs(sum(vectors)) <= _ROUNDING * max(map(abs, vectors))
    }
    return tuple(_stands_nowhere(device) and device.ratio in free for device in devices)


def _stands_nowhere(device: DeviceTable) -> TypeGuard[Shaft]:
    """A shaft on the crank axis, where it is put if nothing is said of its place."""
    return isinstance(device, Shaft) and not any(device.at)


def measure_direction(vector: complex, origin_deg: float = 0.0) -> float:
    """Direction of a vector, degrees from `origin_deg`, in (-180, 180]."""
    return _plain(float(wrap_degrees(math.degrees(cmath.phase(vector)) - origin_deg, 360)), 360)


def as_millimetres(metres: float) -> float:
    """Return a length in mm, as people would write it."""
    return _plain(metres * 1e3, abs(metres * 1e3))


def _plain(figure: float, size: float) -> float:
    """The figure with nine decimals, as people would write it, where that is the same to an ulp of
    `size`.
    """
    short = round(figure, 9) + 0.0
    return short if abs(figure - short) <= size * EPS else figure

"""A weight at some angle, put on where the shop can: at given angles, none of them too heavy."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_ROUNDING = 1e-9  # share of a weight that is rounding


class Placed(NamedTuple):
    """One weight at one of the angles."""

    weight: float
    angle_deg: float


def split_weight(wanted: complex, angles_deg: Array, most: float) -> tuple[Placed, ...] | None:
    """The least weight in all, spread over the angles, that does what one weight would do.

    The optimum of a linear program: all places of an arc of less than half a turn are full, its two
    neighbours take what is left, all others are empty. Give the two components of the wanted weight
    such prices that the two neighbours are worth just what they weigh: places between them are
    worth more, all others less, which proves it.

    Args:
        wanted: weight as a complex number. angles_deg: of the places.
        most: largest weight at one place, infinite if there is no limit.

    Returns:
        The places with a weight, or None if no weights there add up to it.
    """
    if wanted == 0:
        return ()
    angles, unit = _sort_places(angles_deg)
    target, limit = wanted / abs(wanted), most / abs(wanted)
    count = len(angles)
    alone = np.flatnonzero(np.abs(unit - target) < _ROUNDING)
    if len(alone) and limit >= 1:
        return (Placed(abs(wanted), float(angles[alone[0]])),)
    sums = np.concatenate([[0], np.cumsum(np.tile(unit, 2))])
    first = np.arange(count)
    for between in range(count - 1 if np.isfinite(limit) else min(1, count - 1)):
        last = first + between + 1
        full = (limit if between else 0.0) * (sums[last] - sums[first + 1])
        at_first, at_last = _resolve(target - full, unit, unit[last % count])
        low, high = np.minimum(at_first, at_last), np.maximum(at_first, at_last)
        right = np.flatnonzero((low >= -_ROUNDING) & (high <= limit * (1 + _ROUNDING)))
        if len(right):
            i = int(right[0])
            parts = [at_first[i], *[limit] * between, at_last[i]]
            places = [(i + k) % count for k in range(between + 2)]
            return tuple(
                Placed(float(part) * abs(wanted), float(angles[k]))
                for part, k in zip(parts, places, strict=True)
                if part > _ROUNDING
            )
    return None


def find_reach(direction: complex, angles_deg: Array, most: float) -> float:
    """The largest weight in this direction that the places can stand for together; 0 if they cannot
    point there at all, infinite without a limit.

    What the places reach is a polygon; its edges are parallel to the directions of places, and the
    nearest edge in the direction counts.
    """
    _, unit = _sort_places(angles_deg)
    toward = direction / abs(direction)
    normals = np.concatenate([1j * unit, -1j * unit, unit])
    ahead = (np.conj(normals) * toward).real
    normals, ahead = normals[ahead > _ROUNDING], ahead[ahead > _ROUNDING]
    parts = (np.conj(normals)[:, None] * unit).real
    support = np.where(parts > _ROUNDING, parts, 0).sum(axis=1)
    reach = np.where(support > 0, most * np.where(support > 0, support, 1.0), 0.0) / ahead
    return float(reach.min(initial=np.inf))


def _sort_places(angles_deg: Array) -> tuple[Array, NDArray[np.complex128]]:
    """Angles in [0, 360), each once, and as complex numbers."""
    angles = np.unique(np.round(np.asarray(angles_deg) % 360, 9) % 360)
    return angles, np.exp(1j * np.radians(angles))


def _resolve(
    wanted: NDArray[np.complex128], one: NDArray[np.complex128], other: NDArray[np.complex128]
) -> tuple[Array, Array]:
    """Weights at two places, the other less than half a turn on from the one, that add up to what
    is wanted; negative where the other is farther on.
    """
    across = (np.conj(one) * other).imag
    usable = across > _ROUNDING
    divisor = np.where(usable, across, 1.0)
    at_one = np.where(usable, -(np.conj(other) * wanted).imag / divisor, -1.0)
    at_other = np.where(usable, (np.conj(one) * wanted).imag / divisor, -1.0)
    return at_one, at_other

"""A weight at some angle, put on where the shop can: at given angles, none of them too heavy."""

from __future__ import annotations

from itertools import combinations
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_ROUNDING = 1e-9  # share of a weight that is rounding
_PARALLEL = 1e-9  # sine of an angle between two places below which they are on one line


class Placed(NamedTuple):
    """One weight at one of the angles."""

    weight: float
    angle_deg: float


def split_weight(wanted: complex, angles_deg: Array, most: float) -> tuple[Placed, ...] | None:
    """The least weight in all, spread over the angles, that does what one weight would do.

    The optimum of a linear program: two places take what is left, every other is empty or full.
    Give the two components of the wanted weight such prices that these two places are worth just
    what they weigh: places worth more are full, places worth less are empty, which proves it.

    Args:
        wanted: weight as a complex number. angles_deg: of the places.
        most: largest weight at one place, infinite if there is no limit.

    Returns:
        The places with a weight, or None if no weights there add up to it.
    """
    if wanted == 0:
        return ()
    angles = np.unique(np.round(np.asarray(angles_deg) % 360, 9) % 360)
    unit = np.exp(1j * np.radians(angles))
    target = wanted / abs(wanted)
    limit = most / abs(wanted)
    best = None
    for k in range(len(unit)):  # one place alone, where it is just right
        if abs(unit[k] - target) < _ROUNDING and limit >= 1:
            return (Placed(abs(wanted), float(angles[k])),)
    near = np.argsort(-(unit * np.conj(target)).real)
    for i, j in combinations(near, 2):
        across = (np.conj(unit[i]) * unit[j]).imag
        if abs(across) < _PARALLEL:
            continue
        price = 1j * (unit[i] - unit[j]) / across  # worth of a place: real part of conj(price) unit
        worth = (np.conj(price) * unit).real
        full = worth > 1 + _ROUNDING
        full[[i, j]] = False
        if np.any(full) and not np.isfinite(limit):
            continue
        rest = target - (limit if np.any(full) else 0.0) * unit[full].sum()
        at_i = -(np.conj(unit[j]) * rest).imag / across
        at_j = (np.conj(unit[i]) * rest).imag / across
        if min(at_i, at_j) >= -_ROUNDING and max(at_i, at_j) <= limit * (1 + _ROUNDING):
            best = np.where(full, limit if np.any(full) else 0.0, 0.0)
            best[i], best[j] = at_i, at_j
            break
    if best is None:
        return None
    return tuple(
        Placed(float(weight) * abs(wanted), float(angle))
        for weight, angle in zip(best, angles, strict=True)
        if weight > _ROUNDING
    )


def find_reach(direction: complex, angles_deg: Array, most: float) -> float:
    """The largest weight in this direction that the places can stand for together; 0 if they cannot
    point there at all, infinite without a limit.
    """
    low, high = 0.0, most * len(angles_deg)
    toward = direction / abs(direction)
    if split_weight(toward, angles_deg, np.inf) is None:
        return 0.0
    if not np.isfinite(high):
        return float("inf")
    for _ in range(50):
        middle = (low + high) / 2
        if split_weight(middle * toward, angles_deg, most) is None:
            high = middle
        else:
            low = middle
    return low

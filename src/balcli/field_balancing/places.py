"""A weight at some angle, put on where the shop can: at given angles, none of them too heavy."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.phasors import Array, Complex
from ..core.smallest_largest import Region

_ROUNDING = 1e-9  # share of a weight that is rounding


class Placed(NamedTuple):
    """One weight, at the angle of a place; which one that is, from 1 (None: anywhere)."""

    weight: float
    angle_deg: float
    number: int | None


def split_weight(
    wanted: complex, angles_deg: Array, most: float, noise: float = 0.0
) -> tuple[Placed, ...] | None:
    """The least weight in all, spread over the angles, that does what one weight would do.

    The optimum of a linear program: all places of an arc of less than half a turn are full, its two
    neighbours take what is left, all others are empty. Give the two components of the wanted weight
    such prices that the two neighbours are worth just what they weigh: places between them are
    worth more, all others less, which proves it.

    Args:
        wanted: weight as a complex number. angles_deg: of the places.
        most: largest weight at one place, infinite if there is no limit.
        noise: a weight that is nothing, where it is more than rounding errors of the wanted one.

    Returns:
        The places with a weight, or None if no weights there add up to it.
    """
    if abs(wanted) <= noise:
        return ()
    angles, numbers, unit = _sort_places(angles_deg)
    target, limit = wanted / abs(wanted), most / abs(wanted)
    nothing = max(_ROUNDING, noise / abs(wanted))
    count = len(angles)
    alone = np.flatnonzero(np.abs(unit - target) < nothing)
    if len(alone) and limit >= 1 - nothing:
        i = int(alone[0])
        return (Placed(abs(wanted), float(angles[i]), int(numbers[i])),)
    sums = np.concatenate([[0], np.cumsum(np.tile(unit, 2))])
    first = np.arange(count)
    for between in range(count - 1 if np.isfinite(limit) else min(1, count - 1)):
        last = first + between + 1
        full = (limit if between else 0.0) * (sums[last] - sums[first + 1])
        at_first, at_last = _resolve(target - full, unit, unit[last % count])
        low, high = np.minimum(at_first, at_last), np.maximum(at_first, at_last)
        right = np.flatnonzero((low >= -nothing) & (high <= limit + nothing))
        if len(right):
            i = int(right[0])
            parts = [at_first[i], *[limit] * between, at_last[i]]
            places = [(i + k) % count for k in range(between + 2)]
            return tuple(
                Placed(float(part) * abs(wanted), float(angles[k]), int(numbers[k]))
                for part, k in zip(parts, places, strict=True)
                if part > nothing
            )
    return None


def find_region(angles_deg: Array, most: float) -> Region:
    """Return the region of all weights that weights at these places can stand for together: a
    polygon whose edges are parallel to the places, or without a limit a wedge.

    Args: as for `split_weight`.
    """
    angles, _, unit = _sort_places(angles_deg)
    if np.isfinite(most):
        order = np.argsort(np.append(angles, angles + 180) % 360, kind="stable")
        ways = np.append(unit, -unit)[order]
        lowest = (unit.imag < -_ROUNDING) | ((np.abs(unit.imag) <= _ROUNDING) & (unit.real < 0))
        starts = most * (unit[lowest].sum() + np.append(0, np.cumsum(ways)[:-1]))
        return Region(starts=starts, ways=ways, lengths=np.full(len(ways), most), inward=1j * ways)
    gaps = np.append(angles[1:], angles[0] + 360) - angles
    before = np.flatnonzero(gaps >= 180 - _ROUNDING)
    after = (before + 1) % len(angles)
    ways = np.append(unit[after], unit[before])
    inward = np.append(1j * unit[after], -1j * unit[before])
    zeros, endless = np.zeros(len(ways), complex), np.full(len(ways), np.inf)
    return Region(starts=zeros, ways=ways, lengths=endless, inward=inward)


def _sort_places(angles_deg: Array) -> tuple[Array, NDArray[np.intp], Complex]:
    """Angles in [0, 360), each once; which of the given ones, from 1; and as complex numbers."""
    rounded = np.round(np.asarray(angles_deg) % 360, 9) % 360
    angles, first = np.unique(rounded, return_index=True)
    return angles, first + 1, np.exp(1j * np.radians(angles))


def _resolve(wanted: Complex, one: Complex, other: Complex) -> tuple[Array, Array]:
    """Weights at two places, the other less than half a turn on from the one, that add up to what
    is wanted; negative where the other is farther on.
    """
    across = (np.conj(one) * other).imag
    usable = across > _ROUNDING
    divisor = np.where(usable, across, 1.0)
    at_one = np.where(usable, -(np.conj(other) * wanted).imag / divisor, -1.0)
    at_other = np.where(usable, (np.conj(one) * wanted).imag / divisor, -1.0)
    return at_one, at_other

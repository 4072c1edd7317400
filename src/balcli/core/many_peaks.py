"""The largest absolute values of many curves at once, found on the curves as `peaks.find_peak`
finds that of one, and as exact.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .peaks import MOST_CANDIDATES, NEAR_TOP, differentiate, find_move, find_peak
from .phasors import Array, Complex, Phasors

_AT_ONCE = 1 << 16  # samples of curves
_SETTLED = 1e-10  # move of a candidate that is at its top: its square does not count
_ROUNDS = 12


class _Curves(NamedTuple):
    """Sums of `forward e^{i n t} + backward e^{-i n t}`.

    Attributes:
        orders: whole, ascending, shape (orders,).
        forward, backward: shape (curves, orders).
    """

    orders: NDArray[np.intp]
    forward: Complex
    backward: Complex

    def select(self, which: slice | NDArray[np.intp]) -> _Curves:
        """Some of the curves, or curves several times."""
        return _Curves(self.orders, self.forward[which], self.backward[which])


def find_largest(curves: Phasors) -> Array:
    """The largest |F| over a revolution (over two, where there are half orders) of every curve, to
    rounding; phasors of shape (orders, *trailing), result of shape (*trailing).
    """
    shape = np.broadcast_shapes(curves.forward.shape[1:], curves.backward.shape[1:])
    every = (len(curves.orders), *shape)
    ahead, astern = (np.broadcast_to(c, every) for c in (curves.forward, curves.backward))
    sides = [side.reshape(len(side), -1) for side in (ahead, astern)]
    there = np.any([side.any(axis=1) for side in sides], axis=0)
    if not there.any():
        return np.zeros(shape)
    orders = np.rint(2 * curves.orders[there]).astype(np.intp)
    orders //= max(int(np.gcd.reduce(orders)), 1)  # orders that are multiples repeat themselves
    whole = _Curves(orders, *(np.ascontiguousarray(side[there].T) for side in sides))
    step = max(_AT_ONCE // _count_samples(orders), 1)
    parts = range(0, len(whole.forward), step)
    return np.concatenate([_climb_all(whole.select(slice(k, k + step))) for k in parts]).reshape(
        shape
    )


def _count_samples(orders: NDArray[np.intp]) -> int:
    """16 for each period of the highest order: see `peaks.find_peak`."""
    return 16 * max(int(orders[-1]), 1)


def _climb_all(curves: _Curves) -> Array:
    """The largest value of each curve, shape (curves,)."""
    count = _count_samples(curves.orders)
    curve, at = _find_candidates(curves, count)
    step = 2 * np.pi / count
    values = _climb(curves.select(curve), at.astype(float) * step, step)
    starts = np.searchsorted(curve, np.arange(len(curves.forward)))
    largest: Array = np.maximum.reduceat(values, starts)
    for k in np.flatnonzero(np.bincount(curve) > MOST_CANDIDATES):  # level but for little
        orders, noise = curves.orders.astype(float), np.zeros(1)
        largest[k] = find_peak(
            Phasors.of(orders, curves.forward[k], curves.backward[k], noise)
        ).value
    return largest


def _find_candidates(curves: _Curves, count: int) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Samples that may lie beside the highest peak of their curve, at most one more than
    MOST_CANDIDATES of each: numbers of the curves, ascending, and of the samples.
    """
    spectrum = np.zeros((len(curves.forward), count), complex)
    spectrum[:, curves.orders] = curves.forward
    spectrum[:, -curves.orders] += curves.backward
    samples = np.fft.ifft(spectrum, norm="forward")
    power = samples.real**2 + samples.imag**2
    rises = power >= np.roll(power, 1, axis=-1)
    top = rises & (power >= np.roll(power, -1, axis=-1))
    top &= power >= NEAR_TOP * power.max(axis=-1, keepdims=True)
    top &= np.cumsum(top, axis=-1) <= MOST_CANDIDATES + 1
    curve, at = np.nonzero(top)
    return curve, at


def _climb(curves: _Curves, theta: Array, step: float) -> Array:
    """The value of each curve at the top beside an angle, by Newton's method in steps of at most
    half of `step`.
    """
    values = np.empty(len(theta))
    moving = np.arange(len(theta))
    for _ in range(_ROUNDS):
        f, f1, f2 = differentiate(curves.orders, curves.forward, curves.backward, theta)
        values[moving] = np.hypot(f.real, f.imag)
        move = find_move(f, f1, f2, step)
        on = np.abs(move) >= _SETTLED
        if not on.any():
            break
        curves, theta, moving = curves.select(np.flatnonzero(on)), (theta + move)[on], moving[on]
    return values

"""Fourier coefficients of slider-cranks: centred ones by their closed form, offset ones sampled.

The closed form is good to about 1e-14 relative in every order, samples to about 1e-16 absolute.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..phasors import EPS, Array
from . import closed_form, slidercrank
from .fourier import NONE, Harmonics, Rows, join_mechanisms, transform, unit_circle

HARDEST = 1 << 16  # samples of a revolution that a mechanism takes at 1 - 1e-6 of its lock
CLOSED_FORM = 4096  # highest order of closed forms; only mechanisms near their lock have more


def find_harmonics(
    orders: ArrayLike, lam: Array, eps: Array, *, rod: bool = True, energy: bool = True
) -> Harmonics:
    """Harmonics of one mechanism a cylinder, equal ones computed once.

    Args:
        orders: shape (orders,), not negative.
        lam, eps: crank radius and offset over rod length, shape (cylinders or 1, *trailing).
        rod, energy: whether the series of the rod, and of the kinetic energies, are wanted.

    Raises nothing: that every mechanism turns (`lambda + |eps| < 1`) is the caller's to see to.
    """
    few, which = find_distinct_harmonics(orders, lam, eps, rod=rod, energy=energy)
    return few.select_cylinders(which)


def find_distinct_harmonics(
    orders: ArrayLike, lam: Array, eps: Array, *, rod: bool, energy: bool
) -> tuple[Harmonics, Rows]:
    """Those of the mechanisms that differ, and which of them each cylinder has."""
    if lam.ndim > 1 or lam.size * eps.size == 1:
        return _find_all(orders, lam, eps, rod=rod, energy=energy), slice(None)
    pairs, which = find_distinct(lam, eps)
    each = [_find_all(orders, *np.array([pair]).T, rod=rod, energy=energy) for pair in pairs]
    return join_mechanisms(each), which


def find_distinct(lam: Array, eps: Array) -> tuple[list[tuple[float, float]], NDArray[np.intp]]:
    """(lambda, eps) of the mechanisms that differ, and which of them each cylinder has.

    Args:
        lam, eps: shape (cylinders or 1,).
    """
    pairs = list(zip(*(v.tolist() for v in np.broadcast_arrays(lam, eps)), strict=True))
    place = {pair: k for k, pair in enumerate(dict.fromkeys(pairs))}
    return list(place), np.array([place[pair] for pair in pairs])


def count_all_samples(lam: Array, eps: Array) -> tuple[int, int]:
    """How many mechanisms differ, and how many samples of a revolution they take together.

    Args:
        lam, eps: shape (cylinders or 1,).
    """
    pairs, _ = find_distinct(lam, eps)
    return len(pairs), sum(count_samples(*pair) for pair in pairs)


def count_samples(lam: ArrayLike, eps: ArrayLike, highest: float = math.inf) -> int:
    """Number of samples (a power of two) that leaves no alias above rounding in orders up to the
    highest, nor a tail beyond it, in any of these mechanisms.

    Coefficients decay like `x^n`, x = tan(arcsin(lambda')/2), `lambda' = lambda / (1 - |eps|)`;
    order n of N samples is mixed with N - n.
    """
    steep = np.minimum(np.max(np.asarray(lam) / (1 - np.abs(eps))), 1 - EPS)
    decay = -np.log(steep / (1 + np.sqrt((1 - steep) * (1 + steep))))
    last = -1.2 * np.log(EPS) / decay  # the order beyond which all is rounding
    return 1 << int(np.ceil(np.log2(max(last + min(highest, last), 16))))


def find_highest_order(lam: Array, eps: Array) -> int:
    """The order beyond which nothing of these mechanisms exceeds rounding errors."""
    return count_samples(lam, eps) // 2


def _find_all(orders: ArrayLike, lam: Array, eps: Array, *, rod: bool, energy: bool) -> Harmonics:
    """Those of every mechanism, equal or not."""
    if np.count_nonzero(eps) or np.asarray(orders).max(initial=0) > CLOSED_FORM:
        return sample_harmonics(orders, lam, eps, rod=rod, energy=energy)
    return closed_form.find_harmonics(orders, lam, rod=rod, energy=energy)


def sample_harmonics(
    orders: ArrayLike, lam: Array, eps: Array, *, rod: bool = True, energy: bool = True
) -> Harmonics:
    """Those of whole orders from one revolution of samples; lam and eps are broadcast.

    Accelerations are sampled as such, not differentiated, so that no order's error grows.
    """
    many = np.ndim(lam) > 1  # variants; of one engine an order is the same among any others
    count = count_samples(lam, eps, np.max(orders, initial=0) if many else math.inf)
    at = unit_circle(count), np.asarray(lam)[..., None], np.asarray(eps)[..., None]
    piston = transform(slidercrank.acceleration(*at), orders)
    spin = transform(-slidercrank.rod_acceleration(*at), orders) if rod else NONE
    kinetic = transform(slidercrank.velocity(*at) ** 2, orders) if energy else NONE
    rod_kinetic = transform(slidercrank.rod_rate(*at) ** 2, orders) if energy and rod else NONE
    return Harmonics(piston, spin, kinetic, rod_kinetic)

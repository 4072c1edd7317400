"""Fourier coefficients of slider-cranks: centred ones by their closed form, offset ones sampled.

The closed form is good to about 1e-14 relative in every order, samples to about 1e-16 absolute.
"""

from __future__ import annotations

from collections.abc import Collection

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..phasors import EPS, Array
from . import closed_form
from .distinct import find_distinct
from .fourier import SERIES, Harmonics, Rows, join_mechanisms

HARDEST = 1 << 16  # samples of a revolution that a mechanism takes at 1 - 1e-6 of its lock
CLOSED_FORM = 4096  # highest order of closed forms; only mechanisms near their lock have more


def find_harmonics(
    orders: ArrayLike, lam: Array, eps: Array, wanted: Collection[str] = SERIES
) -> Harmonics:
    """Harmonics of one mechanism a cylinder, equal ones computed once.

    Args:
        orders: shape (orders,), not negative.
        lam, eps: crank radius and offset over rod length, shape (cylinders or 1, *trailing).
        wanted: names of series (`fourier.SERIES`).

    Raises nothing: that every mechanism turns (`lambda + |eps| < 1`) is the caller's to see to.
    """
    few, which = find_distinct_harmonics(orders, lam, eps, wanted)
    return few.select_cylinders(which)


def find_distinct_harmonics(
    orders: ArrayLike, lam: Array, eps: Array, wanted: Collection[str]
) -> tuple[Harmonics, Rows]:
    """Those of the mechanisms that differ, and which of them each cylinder has."""
    last = float(np.asarray(orders, float).max(initial=0))
    if lam.size == eps.size == 1 and eps.item() == 0 and last <= CLOSED_FORM:  # most engines
        axes = max(lam.ndim, eps.ndim)
        return closed_form.find_harmonics(orders, lam.ravel(), wanted), np.zeros((1,) * axes, int)
    few = find_distinct(lam, eps)
    ratios, offsets = few.figures
    centred = offsets == 0
    if last > CLOSED_FORM:
        centred[:] = False
    one_engine = few.which.ndim == 1  # of one an order is the same among any others
    found = []
    if np.count_nonzero(centred):
        own = ratios[centred]
        each = own[:, None] if one_engine else own[None]
        found += [closed_form.find_harmonics(orders, few_ratios, wanted) for few_ratios in each]
    if not np.all(centred):
        highest = np.inf if one_engine else last
        off = ratios[~centred], offsets[~centred]
        found.append(sample_harmonics(orders, *off, wanted, highest))
    if len(found) == 1:
        return found[0], few.which
    place = np.empty(len(centred), np.intp)
    place[np.r_[np.flatnonzero(centred), np.flatnonzero(~centred)]] = np.arange(len(centred))
    return join_mechanisms(found), place[few.which]


def count_all_samples(lam: Array, eps: Array) -> tuple[int, int]:
    """How many mechanisms differ, and how many samples of a revolution they take together.

    Args:
        lam, eps: shape (cylinders or 1,).
    """
    ratios, offsets = find_distinct(lam, eps).figures
    return len(ratios), int(count_samples(ratios, offsets).sum())


def count_samples(lam: ArrayLike, eps: ArrayLike, highest: float = np.inf) -> NDArray[np.intp]:
    """Number of samples (a power of two) of each mechanism that leaves no alias above rounding in
    orders up to the highest, nor a tail beyond it.

    Coefficients decay like `x^n`, x = tan(arcsin(lambda')/2), `lambda' = lambda / (1 - |eps|)`;
    order n of N samples is mixed with N - n.
    """
    steep = np.minimum(np.asarray(lam) / (1 - np.abs(eps)), 1 - EPS)
    decay = -np.log(steep / (1 + np.sqrt((1 - steep) * (1 + steep))))
    last = -1.2 * np.log(EPS) / decay  # the order beyond which all is rounding
    doublings = np.ceil(np.log2(np.maximum(last + np.minimum(highest, last), 16)))
    return np.asarray(1 << doublings.astype(np.intp))


def find_highest_order(lam: Array, eps: Array) -> int:
    """The order beyond which nothing of these mechanisms exceeds rounding errors."""
    return int(count_samples(lam, eps).max()) // 2


def sample_harmonics(
    orders: ArrayLike,
    lam: Array,
    eps: Array,
    wanted: Collection[str] = SERIES,
    highest: float = np.inf,
) -> Harmonics:
    """Those of whole orders from one revolution of samples.

    Args:
        orders: shape (orders,).
        lam, eps: shape (mechanisms,).
        wanted: names of series (`fourier.SERIES`).
        highest: of all orders for which the samples must be enough.
    """
    from .sampled import sample_mechanisms
    from .slidercrank import SliderCrank

    counts = count_samples(lam, eps, highest)
    return sample_mechanisms(orders, wanted, SliderCrank, (lam, eps), counts).as_harmonics()

"""Fourier coefficients of slider-cranks: centred ones by their closed form, offset ones sampled.

The closed form is good to about 1e-14 relative in every order, samples to about 1e-16 absolute.
Mechanisms that are equal are computed once.
"""

from __future__ import annotations

import math
from collections.abc import Collection
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..phasors import EPS, Array
from . import closed_form
from .fourier import SERIES, Harmonics, Rows, select_cylinders

HARDEST = 1 << 16  # samples of a revolution that a mechanism takes at 1 - 1e-6 of its lock
CLOSED_FORM = 4096  # highest order of closed forms; only mechanisms near their lock have more


class Distinct(NamedTuple):
    """Mechanisms that differ, one after the other.

    Attributes:
        figures: each figure that tells them apart, shape (mechanisms,).
        which: number of the mechanism that each cylinder has, shape (cylinders or 1, *trailing).
    """

    figures: tuple[NDArray[Any], ...]
    which: Rows


def find_distinct(*figures: NDArray[Any]) -> Distinct:
    """Return the mechanisms that differ in some figure, in the order in which cylinders have them.

    A cylinder that does not vary along an axis has one mechanism there; cylinders with the same
    figures at every variant have the same mechanisms.

    Args:
        figures: each of shape (cylinders or 1, *trailing); trailing axes broadcast.
    """
    shape = np.broadcast_shapes(*(values.shape for values in figures))
    starts: dict[tuple[tuple[tuple[int, ...], bytes], ...], int] = {}
    different: list[list[NDArray[Any]]] = []
    which = np.empty(shape, np.intp)
    count = 0
    for row in range(shape[0]):
        own = [narrow(values[row if len(values) > 1 else 0]) for values in figures]
        key = tuple((values.shape, values.tobytes()) for values in own)
        own_shape = np.broadcast_shapes(*(values.shape for values in own))
        own_count = math.prod(own_shape)
        if key not in starts:
            starts[key] = count
            different.append([np.broadcast_to(values, own_shape).ravel() for values in own])
            count += own_count
        which[row] = starts[key] + np.arange(own_count).reshape(own_shape)
    joined = tuple(np.concatenate(parts) for parts in zip(*different, strict=True))
    return Distinct(joined, which)


def narrow(values: NDArray[Any]) -> NDArray[Any]:
    """Return the values without repetition: axes along which they are equal get length 1."""
    for axis, length in enumerate(values.shape):
        if length > 1 and (values == (first := values.take([0], axis))).all():
            values = first
    return values


def find_harmonics(
    orders: ArrayLike, lam: Array, eps: Array, wanted: Collection[str] = SERIES
) -> Harmonics:
    """Return the harmonics of one mechanism a cylinder.

    Args:
        orders: shape (orders,), not negative.
        lam, eps: crank radius and offset over rod length, shape (cylinders or 1, *trailing), with
            lam + |eps| < 1.
        wanted: names of series (`fourier.SERIES`).
    """
    few, which = find_distinct_harmonics(orders, lam, eps, wanted)
    return select_cylinders(few, which)


def find_distinct_harmonics(
    orders: ArrayLike, lam: Array, eps: Array, wanted: Collection[str]
) -> tuple[Harmonics, Rows]:
    """Return the harmonics of the mechanisms that differ, and the number of each cylinder's.

    Where some mechanism has an offset, all are sampled.

    Args:
        orders, lam, eps, wanted: as in `find_harmonics`.
    """
    highest = float(np.max(orders, initial=0))
    if np.any(eps) or highest > CLOSED_FORM:
        (ratios, offsets), which = find_distinct(lam, eps)
        return sample_harmonics(orders, ratios, offsets, wanted, highest), which
    (ratios,), which = find_distinct(lam)
    return closed_form.find_harmonics(orders, ratios, wanted), which


def count_all_samples(lam: Array, eps: Array) -> tuple[int, int]:
    """Return how many mechanisms differ, and how many samples of a revolution they take together.

    Args:
        lam, eps: shape (cylinders or 1, *trailing).
    """
    ratios, offsets = find_distinct(lam, eps).figures
    return len(ratios), int(count_samples(ratios, offsets).sum())


def count_samples(lam: ArrayLike, eps: ArrayLike, highest: float = np.inf) -> NDArray[np.intp]:
    """Return the number of samples (a power of two) of each mechanism that leaves no alias above
    rounding in orders up to the highest, nor an order beyond the samples.

    Coefficients decay like `x^n`, x = tan(arcsin(lam')/2), `lam' = lam / (1 - |eps|)`, because
    cos beta is analytic in a strip of the complex plane; order n of N samples is mixed with N - n.
    """
    steep = np.minimum(np.asarray(lam) / (1 - np.abs(eps)), 1 - EPS)
    decay = -np.log(steep / (1 + np.sqrt((1 - steep) * (1 + steep))))
    last = -1.2 * np.log(EPS) / decay  # the order beyond which all is rounding
    doublings = np.ceil(np.log2(np.maximum(last + np.minimum(highest, last), 16)))
    return np.asarray(1 << doublings.astype(np.intp))


def find_highest_order(lam: Array, eps: Array) -> int:
    """Return the order beyond which nothing of these mechanisms exceeds rounding errors."""
    return int(count_samples(lam, eps).max()) // 2


def sample_harmonics(
    orders: ArrayLike,
    lam: Array,
    eps: Array,
    wanted: Collection[str] = SERIES,
    highest: float = np.inf,
) -> Harmonics:
    """Return the harmonics of mechanisms from one revolution of samples.

    Args:
        orders: shape (orders,).
        lam, eps: shape (mechanisms,).
        wanted: names of series (`fourier.SERIES`).
        highest: order for which the samples must be enough.
    """
    from .sampled import sample_mechanisms
    from .slidercrank import SliderCrank

    counts = count_samples(lam, eps, highest)
    return sample_mechanisms(orders, wanted, SliderCrank, (lam, eps), counts, highest).series

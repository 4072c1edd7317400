"""Harmonics added up in time: the largest values over a cycle, of many curves at once.

A curve is `x(t) = Re sum over orders of c_n e^{i n t}`, t the crank angle in rad, n a multiple of
1/2, so that a cycle is 4 pi. Phasors have the orders first, then any axes of curves.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .vibration import Complex, Real

_SAMPLES = 12  # for each period of the highest order
_ROUNDS = 40  # Newton's method needs 3 or 4 where a peak is round, more where it is flat
_SETTLED = 1e-16  # gain, as a share of the curve, that ends the climb
_SHORT = 1e-6  # of the distance of two samples: a step within which a curve is a parabola
_EQUAL = 1e-12  # peaks that differ by a smaller share are equal


class CyclePeak(NamedTuple):
    """Largest value (*curves) over a cycle and the first crank angle (rad, in [0, 4 pi)) where it
    is reached.
    """

    value: Real
    angle: Real


class Swing(NamedTuple):
    """Highest and lowest value of curves over a cycle."""

    highest: CyclePeak
    lowest: CyclePeak

    @property
    def half(self) -> Real:
        """Half of peak to peak (*curves)."""
        return (self.highest.value - self.lowest.value) / 2


Slopes = tuple[Real, Real, Real]  # a value and its first two derivatives
Evaluate = Callable[[NDArray[np.intp], Real], Slopes]  # of some curves, each at one angle


def find_swing(orders: ArrayLike, phasors: Complex) -> Swing:
    """Highest and lowest value over the cycle, to rounding, of phasors (orders, *curves).

    A trigonometric polynomial of degree h that swings by R about its middle is above
    `R cos(h d)` at a distance d from its top (M. Riesz), so that the samples beside the highest
    peak are among the highest; from those Newton's method climbs the curve.
    """
    harmonics, unit, phasors = _common_harmonics(orders, phasors)
    curves = np.ascontiguousarray(phasors.reshape(len(harmonics), -1).T)
    samples = _sample(harmonics, curves)
    half = (samples.max(axis=-1) - samples.min(axis=-1)) / 2
    slack = half * (1 / np.cos(np.pi / _SAMPLES) - 1)
    size = np.sum(np.abs(curves), axis=-1)

    def find_tops(sign: int) -> tuple[Real, Real]:
        def evaluate(which: NDArray[np.intp], angle: Real) -> Slopes:
            return _evaluate(harmonics, sign * curves[which], angle)

        return _find_tops(sign * samples, slack, size, evaluate)

    (top, at_top), (bottom, at_bottom) = find_tops(1), find_tops(-1)
    shape = phasors.shape[1:]
    return Swing(
        CyclePeak(top.reshape(shape), at_top.reshape(shape) / unit),
        CyclePeak(-bottom.reshape(shape), at_bottom.reshape(shape) / unit),
    )


def find_longest(orders: ArrayLike, phasors: Complex) -> CyclePeak:
    """Largest length over the cycle, to rounding, of vectors with phasors (orders, *curves,
    components): one, two or three along fixed axes.

    Along the direction of the longest, the vector is a curve as of `find_swing`, about 0.
    """
    harmonics, unit, phasors = _common_harmonics(orders, phasors)
    vectors = np.moveaxis(phasors.reshape(len(harmonics), -1, phasors.shape[-1]), 0, -1)
    curves = np.ascontiguousarray(vectors)
    samples = np.sum(_sample(harmonics, curves) ** 2, axis=1)
    slack = samples.max(axis=-1) * np.sin(np.pi / _SAMPLES) ** 2
    size = np.sum(np.abs(curves), axis=(1, 2)) ** 2

    def evaluate(which: NDArray[np.intp], angle: Real) -> Slopes:
        x, x1, x2 = _evaluate(harmonics, curves[which], angle[:, None])
        slope, bend = 2 * np.sum(x * x1, axis=-1), 2 * np.sum(x1 * x1 + x * x2, axis=-1)
        return np.sum(x * x, axis=-1), slope, bend

    top, at = _find_tops(samples, slack, size, evaluate)
    shape = phasors.shape[1:-1]
    return CyclePeak(np.sqrt(top).reshape(shape), at.reshape(shape) / unit)


def sum_amplitudes(phasors: Complex) -> Real:
    """Sum of the amplitudes of all orders (*curves): what the largest value would be if all orders
    peaked at once. It is commonly 1.2 to 2.5 times the largest value that occurs.
    """
    return np.sum(np.abs(phasors), axis=0)


def largest_of_ellipse(phasors: Complex) -> Real:
    """Longest vector on the ellipse that `Re(c e^{i t})` runs through: of phasors (*curves,
    components) the longer semi-axis (*curves), `sqrt((|c|^2 + |c . c|)/2)`.
    """
    power = np.sum(np.abs(phasors) ** 2, axis=-1)
    return np.sqrt((power + np.abs(np.sum(phasors**2, axis=-1))) / 2)


def _common_harmonics(
    orders: ArrayLike, phasors: Complex
) -> tuple[NDArray[np.int64], float, Complex]:
    """Whole harmonics of the shortest common cycle, how many of those make a turn of 2 pi, and the
    phasors that belong to them; orders that nothing has are left out.

    Raises:
        ValueError: an order that is no multiple of 1/2, is negative or comes twice.
    """
    halves = 2 * np.asarray(orders, float)
    harmonics = np.rint(halves).astype(np.int64)
    once = len(np.unique(harmonics)) == len(harmonics)
    if not once or np.any(harmonics != halves) or np.any(harmonics < 0):
        raise ValueError("orders have to be different multiples of 1/2, none below 0")
    there = np.any(phasors != 0, axis=tuple(range(1, phasors.ndim)))
    there |= not np.any(there)
    common = max(int(np.gcd.reduce(harmonics[there])), 1)
    return harmonics[there] // common, common / 2, phasors[there]


def _sample(harmonics: NDArray[np.int64], curves: Complex) -> Real:
    """Values (..., samples) of curves (..., harmonics) at equal distances over a cycle."""
    count = _SAMPLES * max(int(harmonics.max(initial=1)), 1)
    spectrum = np.zeros((*curves.shape[:-1], int(harmonics.max(initial=0)) + 1), complex)
    spectrum[..., harmonics] = np.where(harmonics, curves / 2, curves.real)
    return np.fft.irfft(spectrum, count, axis=-1, norm="forward")


def _evaluate(harmonics: NDArray[np.int64], curves: Complex, angle: Real) -> Slopes:
    """Values and two derivatives of curves (..., harmonics) at angles that broadcast to (...)."""
    factors = np.ones((*angle.shape, int(harmonics.max(initial=0)) + 1), complex)
    factors[..., 1:] = np.exp(1j * angle)[..., None]
    turned = curves * np.cumprod(factors, axis=-1)[..., harmonics]
    weights = np.vander(harmonics.astype(float), 3, increasing=True).astype(complex)
    sums = turned @ weights
    return sums[..., 0].real, -sums[..., 1].imag, -sums[..., 2].real


def _find_tops(samples: Real, slack: Real, size: Real, evaluate: Evaluate) -> tuple[Real, Real]:
    """Highest value (curves,) and its angle in [0, 2 pi), of samples (curves, samples) that may
    fall short of it by `slack` (curves,); `size` bounds the curves' values.
    """
    highest = np.argmax(samples, axis=-1)
    each = np.arange(len(samples))
    near = samples >= (samples[each, highest] - slack)[:, None]
    curve, at = np.nonzero(near)
    here, before = samples[curve, at], samples[curve, at - 1]
    after = samples[curve, (at + 1) % samples.shape[-1]]
    top = (here > before) & (here >= after)
    top |= at == highest[curve]
    curve, at, before, here, after = (column[top] for column in (curve, at, before, here, after))
    step = 2 * np.pi / samples.shape[-1]
    bend = before - 2 * here + after  # of the parabola through the three
    start = at + (before - after) / (2 * np.where(bend < 0, bend, -np.inf))
    value, angle = _climb(curve, start * step, size[curve], step, evaluate)
    starts = np.searchsorted(curve, each)
    best = np.maximum.reduceat(value, starts)
    angle = np.round(angle % (2 * np.pi), 12) % np.round(2 * np.pi, 12)
    among = value >= (best - _EQUAL * size)[curve]
    return best, np.minimum.reduceat(np.where(among, angle, 2 * np.pi), starts)


def _climb(
    curve: NDArray[np.intp], angle: Real, size: Real, step: float, evaluate: Evaluate
) -> tuple[Real, Real]:
    """Newton's method from each angle to the top beside it, in steps of at most `step`."""
    value = np.empty(len(angle))
    moving = np.arange(len(angle))
    for _ in range(_ROUNDS):
        x, slope, bend = evaluate(curve[moving], angle[moving])
        uphill = np.where(bend < 0, -slope / np.where(bend < 0, bend, -1), np.sign(slope) * step)
        move = np.clip(uphill, -step, step)
        gain = slope * move / 2  # of a parabola
        value[moving] = x + gain
        angle[moving] += move
        far = np.abs(move) > _SHORT * step
        moving = moving[far & (2 * np.abs(gain) > _SETTLED * size[moving])]
        if not len(moving):
            break
    return value, angle

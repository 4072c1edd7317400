"""The largest absolute value of a curve given by its phasors, found on the curve itself and not on
a grid of samples.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .phasors import Array, Complex, Phasors

_TURN = 2 * math.pi  # rad


class Peak(NamedTuple):
    """Largest absolute value over a revolution, and the first crank angle (rad, in [0, 2 pi)) at
    which it is reached; over two revolutions where there are half orders.

    Attributes:
        every: after which angle (rad) the curve repeats its size, by the orders that it has; 0: it
            always has this size.
    """

    value: float
    theta: float
    every: float = _TURN


MOST_CANDIDATES = 64  # for the highest peak of a curve
NEAR_TOP = 0.92  # share of the largest |F|^2 of samples that those beside the peak have
_EQUAL = 1e-12  # peaks that differ by a smaller share are equal
_TERMS = 7  # of the series by which many peaks are told apart
_ROUNDS = 4  # of Newton's method on it
_CLIMBS = 12  # rounds of Newton's method on the curve, at most
_DIGITS = 8  # to which they are


def find_peak(curve: Phasors) -> Peak:
    """The global maximum of |F|, to rounding, or to 1e-8 where more than 64 maxima are that near to
    it.

    |F|^2 is a trigonometric polynomial of degree 2n, n the highest order that is there. Between
    samples at 16n points it exceeds the largest of them by less than a factor 1/cos(pi/8) (Ehlich
    and Zeller 1964), so that the highest peak is among the samples within 8 % of the top; from each
    of those Newton's method climbs the curve.
    """
    there = np.flatnonzero(curve.major)
    if not len(there):
        return Peak(0.0, 0.0)
    curve = Phasors(curve.orders[there], curve.vectors[:, there], np.zeros(1))
    if np.count_nonzero(curve.orders % 1):  # of half the crank angle all are whole
        half = find_peak(replace(curve, orders=2 * curve.orders))
        return Peak(half.value, 2 * half.theta, 2 * half.every)
    theta = find_candidates(curve)
    step = np.pi / (8 * max(curve.orders[-1], 1))
    # 0 is the first place of a peak beside it, and of a level curve.
    theta = np.concatenate([[0.0], climb_peaks(curve, theta, step)])
    values, turned = np.abs(curve.values(theta)), theta % _TURN
    equal = np.flatnonzero(values >= values.max() * (1 - _EQUAL))
    # Of equal peaks the first, whatever the rounding.
    best = equal[np.argmin(np.round(turned[equal], 9) % np.round(_TURN, 9))]
    return Peak(float(values.max()), float(turned[best]), _find_repetition(curve))


def _find_repetition(curve: Phasors) -> float:
    """After which angle (rad) |F| is the same again, whatever the phasors of whole orders are: F is
    a sum of vectors that turn m times a revolution (m < 0: backward), and |F| of what their turns
    differ by.
    """
    ahead, against = curve.orders[curve.forward != 0], curve.orders[curve.backward != 0]
    turns = np.concatenate([ahead, -against]).astype(int)
    times = int(np.gcd.reduce(turns - turns[0]))
    return _TURN / times if times else 0.0


def find_candidates(curve: Phasors) -> Array:
    """Angles of the samples that may lie beside the highest peak of a curve of whole orders, at
    most MOST_CANDIDATES: where there are more, those of the highest peaks but for 1e-8, of equal
    ones the first.
    """
    count = 16 * max(int(curve.orders[-1]), 1)
    spectrum = np.zeros(count, complex)
    spectrum[curve.orders.astype(int)] += curve.forward
    spectrum[-curve.orders.astype(int)] += curve.backward
    power = np.abs(np.fft.ifft(spectrum, norm="forward")) ** 2
    around = np.concatenate([power[-1:], power, power[:1]])
    top = (power >= around[:-2]) & (power >= around[2:])
    top &= power >= NEAR_TOP * power.max()
    found = np.flatnonzero(top)
    height = power[found]
    if len(found) > MOST_CANDIDATES:
        height = _estimate_peaks(spectrum, found)
        height = np.round(height / (height.max() or 1.0), _DIGITS)  # squares may underflow
    highest_first = found[np.argsort(-height, kind="stable")]
    return highest_first[:MOST_CANDIDATES].astype(float) * (2 * np.pi / count)


def _estimate_peaks(spectrum: Complex, at: NDArray[np.intp]) -> Array:
    """|F|^2 at the maxima beside samples, by the Taylor series of F about each: within half a step
    of pi/8n its remainder is below 1e-9 of the amplitudes.
    """
    count = len(spectrum)
    rate = 1j * np.fft.fftfreq(count, 1 / count)
    derivatives = [spectrum / math.factorial(k) * rate**k for k in range(_TERMS)]
    series = np.stack([np.fft.ifft(d, norm="forward")[at] for d in derivatives])
    first = _differentiate(series)
    second = _differentiate(first)
    x = np.zeros(len(at))
    for _ in range(_ROUNDS):
        f, f1, f2 = (_evaluate_each(c, x) for c in (series, first, second))
        x = np.clip(x + find_move(f, f1, f2, np.pi / count), -np.pi / count, np.pi / count)
    values: Array = np.abs(_evaluate_each(series, x)) ** 2
    return values


def _evaluate_each(series: Complex, x: Array) -> Complex:
    """Polynomials of coefficients (terms, polynomials), each at its own x, by Horner's rule."""
    value = series[-1]
    for coefficient in series[-2::-1]:
        value = coefficient + value * x
    return value


def _differentiate(series: Complex) -> Complex:
    """The derivatives of such polynomials."""
    powers: Array = np.arange(1.0, len(series))
    return series[1:] * powers[:, None]


def climb_peaks(curve: Phasors, theta: Array, step: float) -> Array:
    """Newton's method for the maxima of |F|^2 beside these angles, in steps of at most `step`."""
    for _ in range(_CLIMBS):
        f, f1, f2 = differentiate(curve.orders, curve.forward, curve.backward, theta)
        move = find_move(f, f1, f2, step)
        theta = theta + move
        if np.max(np.abs(move)) < 1e-10:
            break
    return theta


def differentiate(
    orders: Array | NDArray[np.intp], forward: Complex, backward: Complex, theta: Array
) -> tuple[Complex, Complex, Complex]:
    """A curve at crank angles (rad), or each of many curves at its own, and two derivatives.

    Args:
        orders: shape (orders,).
        forward, backward: phasors, shape (orders,); of many curves (angles, orders).
        theta: shape (angles,), as of all that is returned.
    """
    turned = np.exp(1j * np.multiply.outer(theta, orders))
    ahead, astern = forward * turned, backward * turned.conj()
    both, rate = ahead + astern, orders * (ahead - astern)
    return both.sum(axis=-1), 1j * rate.sum(axis=-1), -(orders**2 * both).sum(axis=-1)


def find_move(f: Complex, f1: Complex, f2: Complex, step: float) -> Array:
    """One step of Newton's method, at most `step`, by F and its two derivatives; uphill where |F|^2
    bends upwards.
    """
    slope = (np.conj(f) * f1).real
    bend = np.abs(f1) ** 2 + (np.conj(f) * f2).real
    steep = np.where(bend < 0, -slope / np.where(bend < 0, bend, -1), np.sign(slope) * step / 2)
    move: Array = np.clip(steep, -step, step)
    return move

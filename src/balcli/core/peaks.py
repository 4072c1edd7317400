"""Largest values of periodic curves, found on the curves themselves and not on a grid of samples.

A curve is `x(t) = Re sum over orders of c_n e^{i n t}`, t the crank angle in rad; a vector has one
such curve for each of its components. Orders are multiples of 1/2, so that a cycle is 4 pi. Arrays
have the orders first, then any axes of curves, then the components of vectors.

A trigonometric polynomial of degree h that swings by R about its middle is above `R cos(h d)` at a
distance d from its top (M. Riesz). So of 16 samples for each period of the highest order, those
beside the highest peak are among the highest, and Newton's method climbs the curve from there.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .phasors import Array, Phasors
from .vibration import Complex, Real

_TURN = 2 * np.pi  # rad
_SAMPLES = 16  # for each period of the highest order
_AT_ONCE = 1 << 19  # samples, or terms of curves, which bounds the memory
_ROUNDS = 40  # Newton's method needs 3 or 4 where a peak is round, more where it is flat
_SETTLED = 1e-16  # gain, as a share of the sum of all amplitudes, that ends the climb
_SHORT = 1e-6  # share of the distance of two samples: within it a curve is a parabola
_ZERO = 1e-12  # rad; an angle so near to a whole turn is 0
_EQUAL = 1e-12  # peaks that differ by a smaller share of the sum of all amplitudes are equal


class Peak(NamedTuple):
    """Largest absolute value of a curve over a revolution (over two if it has half orders).

    Attributes:
        value: in the unit of the curve.
        theta: first crank angle at which it is reached, rad.
        every: angle after which the curve repeats its size, rad; 0: the size is constant.
    """

    value: float
    theta: float
    every: float = _TURN


class CyclePeak(NamedTuple):
    """Largest values of curves over a cycle, and the first crank angles at which they are reached,
    rad in [0, 4 pi); each of shape (*curves).
    """

    value: Real
    angle: Real


class Swing(NamedTuple):
    """Highest and lowest values of curves over a cycle."""

    highest: CyclePeak
    lowest: CyclePeak

    @property
    def half(self) -> Real:
        """Half of peak to peak, shape (*curves)."""
        return (self.highest.value - self.lowest.value) / 2


class _Curves(NamedTuple):
    """Real curves, vectors of one or more components.

    Attributes:
        harmonics: whole numbers, shape (orders,).
        parts: phasors, shape (curves, components, orders).
        squared: whether the square of the length is measured, not the value of the one component.
    """

    harmonics: NDArray[np.int64]
    parts: Complex
    squared: bool

    def sample(self) -> Real:
        """Return values at equal distances over a cycle, shape (curves, samples)."""
        top = int(self.harmonics.max(initial=1))
        spectrum = np.zeros((*self.parts.shape[:-1], top + 1), complex)
        spectrum[..., self.harmonics] = np.where(self.harmonics, self.parts / 2, self.parts.real)
        values = np.fft.irfft(spectrum, _SAMPLES * max(top, 1), axis=-1, norm="forward")
        return np.sum(values**2, axis=1) if self.squared else values[:, 0]

    def differentiate(self, which: NDArray[np.intp], angle: Real) -> tuple[Real, Real, Real]:
        """Return values and two derivatives of some curves, each at one angle, shape (some,)."""
        turned = self.parts[which] * np.exp(1j * angle[:, None] * self.harmonics)[:, None]
        rates = np.vander(self.harmonics.astype(float), 3, increasing=True)
        sums = turned @ rates.astype(complex)
        x, x1, x2 = sums[..., 0].real, -sums[..., 1].imag, -sums[..., 2].real
        if not self.squared:
            return x[:, 0], x1[:, 0], x2[:, 0]
        slope, bend = 2 * np.sum(x * x1, axis=1), 2 * np.sum(x1 * x1 + x * x2, axis=1)
        return np.sum(x * x, axis=1), slope, bend


# ------------------------------------------------------------------ curves by their phasors
def find_peak(curve: Phasors) -> Peak:
    """Return the largest |F| over a revolution of phasors without trailing axes."""
    if not np.any(curve.vectors):
        return Peak(0.0, 0.0)
    value, theta = find_longest(curve.orders, _list_components(curve))
    return Peak(float(value), float(theta), _find_repetition(curve))


def find_largest(curves: Phasors) -> Array:
    """Return the largest |F| over a cycle of phasors (orders, *trailing), shape (*trailing)."""
    return np.asarray(find_longest(curves.orders, _list_components(curves)).value, float)


def find_near_peaks(curve: Phasors) -> Real:
    """Return the angles (rad, ascending) of all tops of |F| within some 2 % of the highest over a
    revolution, for phasors of whole orders without trailing axes; several may be the same top.
    """
    parts = _list_components(curve).T[None]
    curves = _Curves(curve.orders.astype(np.int64), parts / np.abs(parts).sum(), squared=True)
    return np.sort(_find_tops(curves, curves.sample())[2])


def _list_components(curves: Phasors) -> Complex:
    """Return `Re(c e^{i n theta})` along x and y, shape (orders, *trailing, 2)."""
    ahead, astern = curves.forward, np.conj(curves.backward)
    return np.stack([ahead + astern, -1j * (ahead - astern)], axis=-1)


def _find_repetition(curve: Phasors) -> float:
    """Return the angle (rad) after which |F| is the same again, whatever the phasors are: F is a
    sum of vectors that turn m times a revolution (m < 0: backward), and |F| depends on the
    differences of their turns.
    """
    ahead, against = curve.orders[curve.forward != 0], curve.orders[curve.backward != 0]
    halves = np.rint(2 * np.concatenate([ahead, -against])).astype(int)
    times = int(np.gcd.reduce(halves - halves[0]))
    return 2 * _TURN / times if times else 0.0


# ------------------------------------------------------------------ curves by their harmonics
def find_swing(orders: ArrayLike, phasors: Complex) -> Swing:
    """Return the highest and lowest values over the cycle of phasors (orders, *curves).

    Raises:
        ValueError: an order that is no multiple of 1/2, is negative or comes twice.
    """
    top, at_top = _search(orders, phasors[..., None], squared=False)
    bottom, at_bottom = _search(orders, -phasors[..., None], squared=False)
    return Swing(CyclePeak(top, at_top), CyclePeak(-bottom, at_bottom))


def find_longest(orders: ArrayLike, phasors: Complex) -> CyclePeak:
    """Return the largest lengths over the cycle of vectors (orders, *curves, components).

    Raises:
        ValueError: an order that is no multiple of 1/2, is negative or comes twice.
    """
    return CyclePeak(*_search(orders, phasors, squared=True))


def sum_amplitudes(phasors: Complex) -> Real:
    """Return the sum of the amplitudes of all orders, shape (*curves): the largest value if all
    orders peaked at once. It is commonly 1.2 to 2.5 times the largest value that occurs.
    """
    return np.sum(np.abs(phasors), axis=0)


def largest_of_ellipse(phasors: Complex) -> Real:
    """Return the longer semi-axis (*curves) of the ellipse `Re(c e^{i t})` of phasors (*curves,
    components): `sqrt((|c|^2 + |c . c|)/2)`.
    """
    power = np.sum(np.abs(phasors) ** 2, axis=-1)
    return np.sqrt((power + np.abs(np.sum(phasors**2, axis=-1))) / 2)


def _search(orders: ArrayLike, phasors: Complex, *, squared: bool) -> tuple[Real, Real]:
    """Return the highest values, or lengths, and their angles, shape (*curves)."""
    harmonics, unit, phasors = _common_harmonics(orders, phasors)
    shape, parts = phasors.shape[1:-1], phasors.reshape(len(harmonics), -1, phasors.shape[-1])
    count = _SAMPLES * int(harmonics.max(initial=1)) * parts.shape[-1]
    step = max(_AT_ONCE // max(count, 1), 1)
    found = [np.zeros((2, 0))]
    for start in range(0, parts.shape[1], step):
        some = np.ascontiguousarray(np.moveaxis(parts[:, start : start + step], 0, -1))
        size = np.sum(np.abs(some), axis=(1, 2))
        some = some / np.where(size > 0, size, 1)[:, None, None]
        top, angle = _find_first_peaks(_Curves(harmonics, some, squared))
        found.append(np.stack([(np.sqrt(top) if squared else top) * size, angle / unit]))
    value, angle = np.concatenate(found, axis=1)
    return value.reshape(shape), angle.reshape(shape)


def _common_harmonics(
    orders: ArrayLike, phasors: Complex
) -> tuple[NDArray[np.int64], float, Complex]:
    """Return the whole harmonics of the shortest common cycle, how many of these cycles make a turn
    of 2 pi, and the phasors of the harmonics; orders without any phasor are left out.
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


def _find_first_peaks(curves: _Curves) -> tuple[Real, Real]:
    """Return the highest value of each curve, shape (curves,), and its first angle in [0, 2 pi)."""
    samples = curves.sample()
    curve, value, angle = _find_tops(curves, samples)
    starts = np.searchsorted(curve, np.arange(len(samples)))
    best = np.maximum.reduceat(value, starts)
    among = value >= (best - _EQUAL)[curve]
    first = np.minimum.reduceat(np.where(among, angle, _TURN), starts)
    return best, np.where(samples[:, 0] >= best - _EQUAL, 0.0, first)


def _find_tops(curves: _Curves, samples: Real) -> tuple[NDArray[np.intp], Real, Real]:
    """Return the tops beside samples that may be the highest of their curves: numbers of the
    curves, ascending, values, and angles in [0, 2 pi); each of shape (tops,).
    """
    highest = np.argmax(samples, axis=-1)
    low, high, near = samples.min(axis=-1), samples.max(axis=-1), np.cos(np.pi / _SAMPLES)
    slack = high * (1 - near**2) if curves.squared else (high - low) / 2 * (1 / near - 1)
    curve, at = np.nonzero(samples >= (high - slack)[:, None])
    here, before = samples[curve, at], samples[curve, at - 1]
    after = samples[curve, (at + 1) % samples.shape[-1]]
    top = (here > before) & (here >= after)
    top |= at == highest[curve]
    curve, at, before, here, after = (column[top] for column in (curve, at, before, here, after))
    step = _TURN / samples.shape[-1]
    bend = before - 2 * here + after  # of the parabola through the three
    start = at + (before - after) / (2 * np.where(bend < 0, bend, -np.inf))
    terms = curves.parts.shape[1] * curves.parts.shape[2]
    block = max(_AT_ONCE // max(terms, 1), 1)
    climbed = [
        _climb(curves, curve[k : k + block], step * start[k : k + block], step)
        for k in range(0, len(curve), block)
    ]
    value, angle = np.concatenate(climbed, axis=1)
    angle = angle % _TURN
    return curve, value, np.where(angle > _TURN - _ZERO, 0.0, angle)


def _climb(curves: _Curves, curve: NDArray[np.intp], angle: Real, step: float) -> Real:
    """Return the tops beside these angles of some curves, by Newton's method in steps of at most
    `step`: values and angles, shape (2, angles).
    """
    value, angle = np.empty(len(angle)), angle.copy()
    moving = np.arange(len(angle))
    for _ in range(_ROUNDS):
        x, slope, bend = curves.differentiate(curve[moving], angle[moving])
        uphill = np.where(bend < 0, -slope / np.where(bend < 0, bend, -1), np.sign(slope) * step)
        move = np.clip(uphill, -step, step)
        gain = slope * move / 2  # of a parabola
        value[moving] = x + gain
        angle[moving] += move
        moving = moving[(np.abs(move) > _SHORT * step) & (2 * np.abs(gain) > _SETTLED)]
        if not len(moving):
            break
    return np.stack([value, angle])

"""Represent functions of an angle that are smooth between breakpoints: pressures, torques,
energies, speeds.

Between two breakpoints the function is cut into panels. On each panel it is a short Legendre
series, computed from its values at the Gauss-Legendre nodes. Panels are halved until the last terms
are small, so that sharp peaks are resolved as well. Mean, harmonics, integral and extremes follow
from the series; no panel extends across a corner or a jump.

A curve may have a figure, further axes at the end of its series, such as one for the variants of an
engine. It is then several functions on the same panels, whose values have the axes of the figure.

Forces in a plane that are smooth between common breakpoints are sampled at the nodes of the same
panels. A sum of forces is then a sum of samples, so that each force is computed only once.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import NamedTuple, TypeAlias, TypeVar

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import ArrayLike, NDArray

from .peaks import Peak
from .phasors import Array, Complex, Figure, open_axes

Function: TypeAlias = Callable[[Array], Array]  # values at angles (rad), shape (*angles, *figure)
Number = TypeVar("Number", np.float64, np.complex128)
Vectors: TypeAlias = Callable[[Array], Complex]  # values at angles, shape (vectors, angles)

gauss = lru_cache(legendre.leggauss)  # rising nodes and weights of the quadrature on [-1, 1]

_WIDEST = 0.5  # rad, largest width of a panel before halving
_TERMS = 16
_RESOLVED = 1e-12  # limit of the last terms of a series, relative to the function's largest value
_HALVINGS = 48
# Halving ends at this multiple of the initial number of panels: finer details are rounding errors.
_EVERYWHERE = 16
_REACH = 16.0  # rad; _NODES nodes suffice if the phase of a harmonic turns no farther on a panel
_NODES = 32
_MOST_WAVES = 2**21  # values of a wave at once, so that high harmonics take little memory
_SAME = 1e-11  # rad; an angle this close to a breakpoint is the breakpoint
_NEWTON_STEPS = 6
_SHORT = 1e-9  # share of half a panel; the step after a shorter one would be below rounding
_NO_SIGN = 1e-9  # values below this share of the largest one have no sign
_ROUNDING = 1e-14  # values below this share of the largest value, or of the terms of a sum, are 0
_TIE = 1e-11  # extremes that differ by less than this share of the range are equal


class Extreme(NamedTuple):
    """Angle (rad) at which a curve is lowest or highest, and its value there."""

    angle: float
    value: float


@lru_cache
def values_to_series(count: int) -> Array:
    """Return the matrix from values at the nodes of `gauss` to Legendre coefficients."""
    nodes, weights = gauss(count)
    basis = legendre.legvander(nodes, count - 1)
    return np.asarray((np.arange(count)[:, None] + 0.5) * basis.T * weights)


# ---------------------------------------------------------------- curves
@dataclass(frozen=True, eq=False)
class PiecewiseCurve:
    """A periodic function that is a polynomial on each panel.

    Attributes:
        breaks: Rising angles that bound the panels, rad, shape (panels + 1,); the last is one
            period after the first.
        series: Legendre coefficients on each panel, shape (terms, panels, *figure).
    """

    breaks: Array
    series: Array

    @property
    def figure(self) -> tuple[int, ...]:
        """Shape of the figure; empty for a single function."""
        return self.series.shape[2:]

    @property
    def period(self) -> float:
        """Length of one period, rad."""
        return float(self.breaks[-1] - self.breaks[0])

    @property
    def integral(self) -> float:
        """Integral over one period; 0 if panels cancel to rounding. The curve has no figure."""
        return float(self.integrals)

    @property
    def mean(self) -> float:
        """Mean value over one period. The curve has no figure."""
        return float(self.means)

    @cached_property
    def integrals(self) -> Array:
        """Integral over one period, shape (*figure); 0 if panels cancel to rounding."""
        panels = self.series[0] * open_axes(np.diff(self.breaks), self.figure)
        total = panels.sum(axis=0)
        noise = _ROUNDING * np.abs(panels).sum(axis=0)
        return np.where(np.abs(total) <= noise, 0.0, total)

    @property
    def means(self) -> Array:
        """Mean value over one period, shape (*figure)."""
        return self.integrals / self.period

    def at(self, angle: ArrayLike) -> Array:
        """Return values at any angles (rad), shape (*angle, *figure); at a jump, the value after
        it.
        """
        start = self.breaks[0]
        turned = np.remainder(np.asarray(angle, float) + _SAME - start, self.period)
        return self.within(start + turned - _SAME)

    def within(self, angle: Array) -> Array:
        """Return values at angles between the first and the last breakpoint, shape (*angle,
        *figure); for angles outside, the value at the nearer end.
        """
        panel = np.searchsorted(self.breaks, angle + _SAME, side="right") - 1
        panel = np.clip(panel, 0, len(self.breaks) - 2)
        middle, half = _find_middles(self.breaks)
        x = np.clip((angle - middle[panel]) / half[panel], -1, 1)
        if not self.figure:
            return np.asarray(legendre.legval(x, self.series[:, panel], tensor=False))
        basis = legendre.legvander(x, len(self.series) - 1)
        values = np.empty(x.shape + self.figure, self.series.dtype)
        for k in set(panel.ravel().tolist()):
            here = panel == k
            values[here] = np.tensordot(basis[here], self.series[:, k], 1)
        return values

    def split(self) -> Iterator[PiecewiseCurve]:
        """Yield the curve of each member of the figure, in the order of its flat index."""
        flat = self.series.reshape(*self.series.shape[:2], -1)
        for member in range(flat.shape[2]):
            yield PiecewiseCurve(self.breaks, flat[:, :, member])

    def repeated(self, times: int) -> PiecewiseCurve:
        """Return the curve repeated several times, as one period."""
        parts = [PiecewiseCurve(self.breaks + k * self.period, self.series) for k in range(times)]
        return join(parts)

    def harmonics(self, wanted: ArrayLike) -> Complex:
        """Return the coefficients c_k of `Re sum c_k e^{2 pi i k angle/period}` for the wanted
        whole numbers k >= 0, shape (harmonics, *figure); c_0 is the mean.
        """
        numbers = np.asarray(wanted, int)
        unit = 2 * np.pi / self.period
        top = int(numbers.max(initial=0))
        nodes, weights = quadrature(cut(self.breaks, _REACH / (unit * max(top, 1))), _NODES)
        # e^(-i k angle) with k = high * stride + low is a product of two waves of few different k
        stride = math.isqrt(top) + 1
        if numbers.size <= stride or self.figure:
            is_mean = open_axes(numbers == 0, self.figure)
            return np.where(is_mean, self.means, self._add_waves(unit * numbers, nodes, weights))
        angles = nodes.reshape(-1)
        shares = (2 * self.within(nodes) * weights).reshape(-1)
        low = unit * np.arange(stride)
        high = unit * np.arange(0, top + 1, stride)
        every = np.zeros((len(low), len(high)), np.complex128)
        for part in _blocks(len(angles), len(low)):
            slow = np.exp(-1j * np.multiply.outer(low, angles[part]))
            fast = np.exp(-1j * np.multiply.outer(high, angles[part]))
            every += slow @ (fast * shares[part]).T
        return np.where(numbers == 0, self.mean, every[numbers % stride, numbers // stride])

    def _add_waves(self, numbers: Array, nodes: Array, weights: Array) -> Complex:
        """Return the sum over the nodes of `2 weight value e^(-i number angle)` for each number,
        shape (numbers, *figure).

        Args:
            numbers: Numbers, shape (numbers,).
            nodes: Angles, shape (nodes, panels).
            weights: Weights, in the shape of the nodes.
        """
        total = np.zeros(numbers.shape + self.figure, np.complex128)
        functions = math.prod(self.figure)
        for part in _blocks(nodes.shape[1], len(nodes) * max(numbers.size, functions)):
            angles = nodes[:, part]
            shares = self.within(angles) * open_axes(2 * weights[:, part], self.figure)
            waves = np.exp(-1j * np.multiply.outer(numbers, angles))
            total += np.tensordot(waves, shares, 2)
        return total

    def antiderivative(self, constant: float = 0.0) -> PiecewiseCurve:
        """Return the integral of `curve - constant` over the angle, from the first breakpoint on.
        It is periodic if the constant is the mean.
        """
        half = open_axes(np.diff(self.breaks) / 2, self.figure)
        series = self.series.copy()
        series[0] -= constant
        area = 2 * half * series[0]
        series = legendre.legint(series, lbnd=-1) * half
        series[0] += np.cumsum(area, axis=0) - area
        return PiecewiseCurve(self.breaks, series)

    def extremes(self) -> tuple[Extreme, Extreme]:
        """Return the lowest and the highest value, each at the first angle that has it; at a jump,
        the values on both sides count. An extreme below the rounding error of the curve's largest
        absolute value becomes 0. The curve has no figure.
        """
        lowest = self._find_tops(-1)
        highest = self._find_tops(1)
        return Extreme(*map(float, lowest)), Extreme(*map(float, highest))

    def find_range(self) -> tuple[Array, Array]:
        """Return the values of `extremes`, shape (*figure) each."""
        return self._find_tops(-1)[1], self._find_tops(1)[1]

    def reversals(self) -> int:
        """Return the number of sign changes in a period; values below 1e-9 of the largest one have
        no sign. The curve must have no figure.
        """
        value = self._samples[1].T.reshape(-1)
        signs = np.sign(value[np.abs(value) > _NO_SIGN * np.abs(value).max()])
        return int(np.count_nonzero(signs != np.roll(signs, 1)))

    @cached_property
    def _samples(self) -> tuple[Array, Array]:
        """Points of a panel (both ends and the nodes), shape (points,), and the values there on
        every panel, shape (points, panels, *figure).
        """
        points = np.concatenate([[-1.0], gauss(max(len(self.series), 2))[0], [1.0]])
        basis = legendre.legvander(points, len(self.series) - 1)
        return points, np.tensordot(basis, self.series, 1)

    @cached_property
    def _rates(self) -> tuple[Array, Array]:
        """Series of the first and second derivative by the place in the panel, from -1 to 1."""
        slope = np.asarray(legendre.legder(self.series), float)
        return slope, np.asarray(legendre.legder(slope), float)

    def _find_tops(self, sign: int) -> tuple[Array, Array]:
        """Return angle and value of the lowest (sign -1) or highest (sign 1) point, by Newton's
        method from the best point of every panel, shape (*figure) each.
        """
        points, values = self._samples
        tie = _TIE * np.ptp(values, axis=(0, 1))
        noise = _ROUNDING * np.abs(values).max(axis=(0, 1))
        heights = sign * values
        start = x = points[np.argmax(heights >= heights.max(axis=0) - tie, axis=0)]
        for _ in range(_NEWTON_STEPS):
            before = x
            slope, curved = (legendre.legval(x, each, tensor=False) for each in self._rates)
            x = np.clip(x - slope / np.where(sign * curved < 0, curved, np.inf), -1, 1)
            if np.abs(x - before).max() < _SHORT:
                break
        low, high = (sign * legendre.legval(p, self.series, tensor=False) for p in (start, x))
        x = np.where(high > low + noise, x, start)
        height = np.maximum(low, high)
        top = height.max(axis=0)
        first = np.argmax(height >= top - tie, axis=0)
        middle, half = _find_middles(self.breaks)
        within = np.take_along_axis(x, first[None], axis=0)[0]
        angle = middle[first] + half[first] * within
        return angle, np.where(np.abs(top) > noise, sign * top, 0.0)


def _blocks(places: int, values: int) -> Iterator[slice]:
    """Yield the parts of a row of places at each of which this many values take little memory."""
    size = max(_MOST_WAVES // max(values, 1), 1)
    for start in range(0, places, size):
        yield slice(start, start + size)


def join(curves: Sequence[PiecewiseCurve]) -> PiecewiseCurve:
    """Return one curve made of several that follow each other."""
    breaks = [curve.breaks[:-1] for curve in curves]
    series = np.concatenate([curve.series for curve in curves], axis=1)
    return PiecewiseCurve(np.concatenate([*breaks, curves[-1].breaks[-1:]]), series)


def resolved(
    function: Function, breaks: ArrayLike, widest: float = _WIDEST, *, each: bool = False
) -> PiecewiseCurve:
    """Return the curve of a function that is smooth between the given breakpoints.

    A panel is halved until its last two coefficients are below 1e-12 of the function's largest
    value, or until there are so many panels that more of them would only resolve rounding errors.

    Args:
        function: Function that returns values at angles strictly between breakpoints, of the shape
            of the angles, or (*angles, *figure).
        breaks: Rising breakpoints, rad; the last one is a period after the first.
        widest: Largest width of a panel before any is halved, rad.
        each: Whether the coefficients of each member of the figure are compared with its own
            largest value, not with the largest value of all.
    """
    edges = cut(np.asarray(breaks, float), widest)
    low = edges[:-1]
    high = edges[1:]
    size: Figure = 0.0
    starts = []
    pieces = []
    for halvings in range(_HALVINGS + 1):
        middle = (low + high) / 2
        values = function(middle + (high - low) / 2 * gauss(_TERMS)[0][:, None])
        series = np.tensordot(values_to_series(_TERMS), values, 1)
        largest = np.abs(values).max(axis=(0, 1))
        size = np.maximum(size, largest if each else largest.max())
        last = np.abs(series[-2:]).max(axis=0)
        halve = (last > _RESOLVED * size).reshape(len(low), -1).any(axis=1)
        halve &= halvings < _HALVINGS and len(low) < _EVERYWHERE * len(edges)
        starts.append(low[~halve])
        pieces.append(series[:, ~halve])
        if not halve.any():
            break
        low = low[halve]
        middle = middle[halve]
        high = high[halve]
        low = np.concatenate([low, middle])
        high = np.concatenate([middle, high])
    start = np.concatenate(starts)
    rising = np.argsort(start)
    series = np.concatenate(pieces, axis=1)[:, rising]
    return PiecewiseCurve(np.append(start[rising], edges[-1]), series)


def polyline(angle: ArrayLike, value: ArrayLike) -> PiecewiseCurve:
    """Return straight lines between points; two points at the same angle are a jump. The last point
    ends the period; if its value differs from that of the first, there is a jump as well.

    Args:
        angle: Rising angles, rad, shape (points,).
        value: Values at the angles, shape (points, *figure).
    """
    angles = np.asarray(angle, float)
    values = np.asarray(value)
    wide = np.diff(angles) > 0
    first = values[:-1][wide]
    last = values[1:][wide]
    breaks = np.append(angles[:-1][wide], angles[-1])
    return PiecewiseCurve(breaks, np.stack([first + last, last - first]) / 2)


# ---------------------------------------------------------------- breakpoints
def quadrature(breaks: Array, nodes: int = _TERMS) -> tuple[Array, Array]:
    """Return angles within panels (rad) and their weights in a mean over the period, each of shape
    (nodes, panels).

    Args:
        breaks: Breakpoints of the panels, rad, shape (panels + 1,).
        nodes: Number of Gauss nodes in each panel.
    """
    x, weights = gauss(nodes)
    middle, half = _find_middles(breaks)
    return middle + half * x[:, None], half * weights[:, None] / (breaks[-1] - breaks[0])


def merged_breaks(parts: list[tuple[Array, float]], period: float) -> Array:
    """Return the breakpoints in [0, period] of a sum of functions, rad.

    Args:
        parts: Breakpoints of each function, and the angle by which they are shifted, rad.
        period: Length of one period, rad.
    """
    inside = [np.remainder(breaks + shift, period) for breaks, shift in parts]
    rising = np.sort(np.concatenate([np.zeros(1), *inside, np.full(1, period)]))
    kept = rising[np.append(np.diff(rising) > _SAME, True)]
    kept[0] = 0.0
    return kept


def cut(breaks: Array, widest: float) -> Array:
    """Return breakpoints, with pieces that are too wide cut into equal panels.

    Args:
        breaks: Breakpoints, rad, shape (breaks,).
        widest: Largest width of a panel, rad.
    """
    counts = np.maximum(np.ceil(np.diff(breaks) / widest), 1)
    places = np.append(0, np.cumsum(counts))
    return np.interp(np.arange(places[-1] + 1), places, breaks)


def _find_middles(breaks: Array) -> tuple[Array, Array]:
    """Return the middle and half the width of every panel."""
    return (breaks[1:] + breaks[:-1]) / 2, np.diff(breaks) / 2


# ---------------------------------------------------------------- zeros
_ROUNDS = 100  # largest number of steps of the search
_ENOUGH = 1e-13  # a relative step of the secant below this ends the search


def find_zero(rising: Callable[[float], float], guess: float, at_zero: float) -> float:
    """Return the zero of a rising function of a positive number; see `find_zeros`."""

    def rise(number: Array) -> Array:
        return np.asarray(rising(float(number)))

    return float(find_zeros(rise, np.asarray(guess), np.asarray(at_zero)))


def find_zeros(rising: Callable[[Array], Array], guess: Array, at_zero: Array) -> Array:
    """Return the zeros of several rising functions of positive numbers, by false position.

    Args:
        rising: Function that computes all functions, each of a number of its own. If a function
            jumps from below 0 to infinity, its zero is just below the jump.
        guess: Positive number to start with, for each function.
        at_zero: Value of each function at 0; the zero of a function that is not negative there is
            0.
    """
    low = np.zeros_like(at_zero)
    below = at_zero
    high = np.where(at_zero < 0, guess, 0.0)
    above = rising(high)
    while (short := (above < 0) & (at_zero < 0)).any():
        low = np.where(short, high, low)
        below = np.where(short, above, below)
        high = np.where(short, 2 * high, high)
        above = rising(high)
    tried = high
    was_below = np.zeros(at_zero.shape, bool)
    going = at_zero < 0
    for _ in range(_ROUNDS):
        if not going.any():
            break
        apart = np.where(going, below - above, -1.0)
        share = np.where(np.isinf(above), 0.5, below / apart)
        last = tried
        tried = np.where(going, low + (high - low) * share, tried)
        value = rising(tried)
        going &= (value != 0) & (np.abs(tried - last) > _ENOUGH * tried)
        is_below = value < 0
        low = np.where(going & is_below, tried, low)
        high = np.where(going & ~is_below, tried, high)
        # A side that is kept twice in a row counts half.
        kept_above = np.where(was_below, above / 2, above)
        kept_below = np.where(was_below, below, below / 2)
        above = np.where(going, np.where(is_below, kept_above, value), above)
        below = np.where(going, np.where(is_below, value, kept_below), below)
        was_below = is_below
    return np.where(np.isinf(above), low, tried)


# ------------------------------------------------------------------ forces in a plane
_TURN_ON_PANEL = 4.0  # rad; if e^{in angle} turns no farther on a panel, _TERMS terms suffice
_AT_ONCE = 1 << 20  # largest number of orders x angles computed together, which bounds the memory


@dataclass(frozen=True, eq=False)
class Panels:
    """Panels of a cycle on which all forces are short series.

    Attributes:
        breaks: Rising breakpoints, rad; the last is one period after the first.
    """

    breaks: Array

    @cached_property
    def angles(self) -> Array:
        """Angles of the samples, rad, shape (samples,): the first node of every panel, then the
        second node of every panel, and so on.
        """
        return quadrature(self.breaks)[0].reshape(-1)

    def find_orders(self, samples: Complex, orders: Array) -> tuple[Complex, Complex]:
        """Return the vectors that turn with the crank and those that turn against it, each of shape
        (orders, forces).

        Args:
            samples: Samples of the forces, shape (forces, samples).
            orders: Orders, shape (orders,), up to the highest for which the panels were made. If
                the oscillations of an order in the period are not a whole number, its vectors are
                0.
        """
        weighed = (samples * quadrature(self.breaks)[1].reshape(-1)).T
        both = np.hstack([weighed, weighed.conj()])
        parts = np.array_split(orders, len(orders) * len(self.angles) // _AT_ONCE + 1)
        found = [np.exp(-1j * some[:, None] * self.angles) @ both for some in parts]
        ahead, against = np.hsplit(np.concatenate(found), 2)
        against = against.conj()
        against[orders == 0] = 0.0  # the mean is kept in `ahead`
        waves = orders * (self.breaks[-1] - self.breaks[0]) / (2 * np.pi)
        there = np.abs(waves - np.rint(waves)) < 0.1  # whole numbers of oscillations
        ahead[~there] = against[~there] = 0.0
        return ahead, against

    def find_largest(self, samples: Complex) -> Peak:
        """Return the largest size of a force and the first angle (rad) at which it is reached. At a
        jump, the values on both sides count.
        """
        series = self.find_series(samples)
        finer = 2 * _TERMS - 1  # terms of the square
        values = legendre.legvander(gauss(finer)[0], _TERMS - 1) @ series
        squares = values_to_series(finer) @ (values.real**2 + values.imag**2)
        highest = PiecewiseCurve(self.breaks, squares).extremes()[1]
        return Peak(float(np.sqrt(max(highest.value, 0.0))), highest.angle)

    def find_mean_size(self, samples: Complex) -> float:
        """Return the mean size of a force over the period. The size has a corner where the force is
        0.
        """
        series = self.find_series(samples)
        x, y = (PiecewiseCurve(self.breaks, part) for part in (series.real, series.imag))
        return resolved(lambda at: np.hypot(x.within(at), y.within(at)), self.breaks).mean

    def find_series(self, samples: NDArray[Number]) -> NDArray[Number]:
        """Return the Legendre coefficients of a force on each panel, shape (terms, panels)."""
        return np.asarray(values_to_series(_TERMS) @ samples.reshape(_TERMS, -1))


def find_panels(forces: Vectors, breaks: Array, highest_order: float) -> Panels:
    """Return panels for forces that are smooth between breakpoints.

    Args:
        forces: Function that returns the values of all forces at angles (rad).
        breaks: Rising breakpoints, rad; the last is one period after the first.
        highest_order: Highest order for which the panels must be fine enough.
    """

    def add_squares(angle: Array) -> Array:
        found = forces(angle.reshape(-1))
        return np.asarray((np.abs(found) ** 2).sum(axis=0)).reshape(angle.shape)

    found = resolved(add_squares, breaks).breaks
    return Panels(cut(found, _TURN_ON_PANEL / max(highest_order, 1.0)))

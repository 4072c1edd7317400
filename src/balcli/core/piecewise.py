"""Functions of an angle that are smooth between breakpoints: pressures, torques, energies, speeds.

Between two breakpoints such a function is cut into panels, and on every panel it is a short
Legendre series, found from its values at the Gauss-Legendre nodes. Panels are halved until the
last terms are at rounding level, so that nobody has to know beforehand how sharp a function is.
Mean, harmonics, integral and extremes then follow from the series, and no sample is ever taken
across a corner or a jump.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .cached_property import cached_property
from .phasors import Array, Complex

Function: TypeAlias = Callable[[Array], Array]  # value at angles (rad), of their shape

_WIDEST = 0.5  # rad, of a panel before any is halved
_MANY = 200  # panels from which on each has few terms
_TERMS, _FEW_TERMS = 16, 8
_RESOLVED = 2e-14  # last terms of a series, relative to the largest value of the function
_NOISE = 1e-5  # last terms below this share that halving hardly lowers are rounding errors
_HARDLY = 0.75
_HALVINGS = 48
_EVERYWHERE = 256  # times as many panels: what these do not show is nothing but noise
_LONGEST_REACH = 16.0  # rad, of waves over half a panel: of more it is cut, and others stay short
_SAME = 1e-11  # rad; an angle so near to a breakpoint is the breakpoint
_SAME_X = 1e-15  # of a panel's half width, where Newton's method has arrived
_NOTHING = 1e-9  # values below this share of the largest have no sign
_ROUNDING = 1e-14  # a smaller share of the largest value, or of what is added up, is 0
_TIE = 1e-12  # extremes that differ by a smaller share of the range are equal


class Extreme(NamedTuple):
    """Where (rad) a curve is lowest or highest, and its value there."""

    angle: float
    value: float


# ---------------------------------------------------------------- Legendre polynomials
def legendre(x: Array, count: int) -> Array:
    """P_0 .. P_(count-1) at x, shape (count, *x.shape)."""
    rows = np.empty((max(count, 2), *x.shape))
    rows[0], rows[1] = 1.0, x
    for n in range(1, count - 1):
        rows[n + 1] = ((2 * n + 1) * x * rows[n] - n * rows[n - 1]) / (n + 1)
    return rows[:count]


@lru_cache
def gauss(count: int) -> tuple[Array, Array]:
    """Nodes (rising) and weights of the Gauss-Legendre quadrature on [-1, 1], each of shape
    (count,), by Newton's method on P_count.

    numpy has them too, in a subpackage that takes longer to import than all of this to run.
    """
    x = -np.cos(np.pi * (np.arange(count) + 0.75) / (count + 0.5))
    for _ in range(6):
        before, last = legendre(x, count + 1)[-2:]
        flow = count * (before - x * last)  # (1 - x^2) P', which is stationary at the nodes
        x = x - last * (1 - x * x) / flow
    return x, 2 * (1 - x) * (1 + x) / flow**2


@lru_cache
def values_to_series(count: int) -> Array:
    """Matrix from values at the nodes of `gauss` to the coefficients of P_0 .. P_(count-1)."""
    nodes, weights = gauss(count)
    return (np.arange(count)[:, None] + 0.5) * legendre(nodes, count) * weights


@lru_cache
def _derivative(count: int) -> Array:
    """Matrix from a series to that of its derivative: P_j' is the sum of (2 l + 1) P_l over
    l = j - 1, j - 3, ...
    """
    row, column = np.indices((count, count))
    return np.where((column > row) & ((column - row) % 2 == 1), 2.0 * row + 1, 0.0)


@lru_cache
def _antiderivative(count: int) -> Array:
    """Matrix from a series to that of its integral from -1, shape (count + 1, count): that of P_l
    is (P_(l+1) - P_(l-1))/(2 l + 1), of P_0 it is P_1 + P_0.
    """
    matrix = np.zeros((count + 1, count))
    for term in range(count):
        matrix[term + 1, term] += 1 / (2 * term + 1)
        matrix[max(term - 1, 0), term] += -1 / (2 * term + 1) if term else 1
    return matrix


# ---------------------------------------------------------------- curves
@dataclass(frozen=True, eq=False)
class PiecewiseCurve:
    """A periodic function, a polynomial on each panel.

    Attributes:
        breaks: rising angles between which the panels lie, rad, shape (panels + 1,); the last is a
            period after the first.
        series: Legendre coefficients on each panel, shape (terms, panels).
    """

    breaks: Array
    series: Array

    @property
    def period(self) -> float:
        """Rad."""
        return float(self.breaks[-1] - self.breaks[0])

    @cached_property
    def integral(self) -> float:
        """Over one period; 0 where it is what rounding leaves of panels that cancel."""
        panels = self.series[0] * np.diff(self.breaks)
        total = float(np.sum(panels))
        return 0.0 if abs(total) <= _ROUNDING * float(np.sum(np.abs(panels))) else total

    @property
    def mean(self) -> float:
        """Over one period."""
        return self.integral / self.period

    def at(self, angle: ArrayLike, *, before: bool = False) -> Array:
        """Values at any angles (rad), of their shape; at a jump the value after it, or `before`."""
        return self.within(wrapped(angle, self.breaks, before=before), before=before)

    def within(self, angle: Array, *, before: bool = False) -> Array:
        """The same for angles between the first and the last breakpoint."""
        flat = angle.reshape(-1)
        panel = piece_of(flat, self.breaks, before=before)
        middle, half = _panels(self.breaks)
        x = np.clip((flat - middle[panel]) / half[panel], -1, 1)
        basis = legendre(x, len(self.series))
        return np.einsum("tn,tn->n", self.series[:, panel], basis).reshape(angle.shape)

    def plus(self, constant: float) -> PiecewiseCurve:
        """The curve raised by a constant."""
        series = self.series.copy()
        series[0] += constant
        return PiecewiseCurve(self.breaks, series)

    def repeated(self, times: int) -> PiecewiseCurve:
        """The same over a period so many times as long."""
        start = self.period * np.arange(times)[:, None]
        inner = (self.breaks[:-1] + start).reshape(-1)
        end = self.breaks[0] + self.period * times
        return PiecewiseCurve(np.append(inner, end), np.tile(self.series, (1, times)))

    def harmonics(self, wanted: ArrayLike) -> Complex:
        """Coefficients c_k of `Re sum c_k e^{2 pi i k angle/period}` for the wanted whole numbers
        k >= 0, of their shape (harmonics,); c_0 is the mean.

        Gauss-Legendre quadrature of every panel, or where it holds many waves of equal parts of it,
        with as many nodes as the series times the highest harmonic need.
        """
        numbers = np.asarray(wanted, int)
        top = int(numbers.max(initial=0))
        unit = 2 * np.pi / self.period
        highest = unit * top
        edges = cut(self.breaks, 2 * _LONGEST_REACH / max(highest, unit))
        middle, half = _panels(edges)
        x, weights = gauss(_nodes_for(len(self.series), highest * float(half.max())))
        angle = middle + half * x[:, None]
        if len(edges) == len(self.breaks):
            values = legendre(x, len(self.series)).T @ self.series
        else:
            values = self.within(angle)
        shares = (values * half * weights[:, None]).reshape(-1) * (2 / self.period)

        def turn(harmonics: NDArray[np.intp]) -> Complex:
            return np.exp(-1j * np.multiply.outer(unit * harmonics, angle.reshape(-1)))

        # e^(-i k angle) of k = high * stride + low is a product: few waves of each make all
        stride = math.isqrt(top) + 1
        low, place_of_low = np.unique(numbers % stride, return_inverse=True)
        high, place_of_high = np.unique(numbers // stride, return_inverse=True)
        every = turn(low) @ (turn(high * stride) * shares).T
        return np.where(numbers == 0, self.mean, every[place_of_low, place_of_high])

    def antiderivative(self) -> PiecewiseCurve:
        """The integral from the first breakpoint on; periodic if the mean is 0."""
        half = np.diff(self.breaks) / 2
        series = _antiderivative(len(self.series)) @ self.series * half
        area = 2 * half * self.series[0]
        series[0] += np.cumsum(area) - area
        return PiecewiseCurve(self.breaks, series)

    def extremes(self) -> tuple[Extreme, Extreme]:
        """Lowest and highest value, each at the first of its angles; at a jump both sides count.
        What is rounding error beside the larger is 0.
        """
        angle, value = self._candidates(np.arange(self.series.shape[1]))
        value = np.where(np.abs(value) <= _ROUNDING * np.abs(value).max(), 0.0, value)
        tie = _TIE * float(np.ptp(value))
        lowest = int(np.argmax(value <= value.min() + tie))
        highest = int(np.argmax(value >= value.max() - tie))
        return (
            Extreme(float(angle[lowest]), float(value.min())),
            Extreme(float(angle[highest]), float(value.max())),
        )

    def highest(self) -> Extreme:
        """Highest value, at the first of its angles, as of `extremes`, but sought only on panels
        that can reach it: no series exceeds the sum of the sizes of its coefficients.
        """
        terms = len(self.series)
        samples = legendre(_points(terms), terms).T @ self.series
        size, tie = float(np.abs(samples).max()), _TIE * float(np.ptp(samples))
        able = np.abs(self.series).sum(axis=0) >= samples.max() - 2 * _TIE * size
        angle, value = self._candidates(np.flatnonzero(able))
        value = np.where(np.abs(value) <= _ROUNDING * size, 0.0, value)
        first = int(np.argmax(value >= value.max() - tie))
        return Extreme(float(angle[first]), float(value.max()))

    def reversals(self) -> int:
        """How often the sign changes in a period; what is within 1e-9 of the largest value has
        none.
        """
        value = legendre(_points(len(self.series)), len(self.series)).T @ self.series
        value = value.T.reshape(-1)
        signs = np.sign(value[np.abs(value) > _NOTHING * np.abs(value).max()])
        return int(np.count_nonzero(signs != np.roll(signs, 1)))

    def _candidates(self, panels: NDArray[np.intp]) -> tuple[Array, Array]:
        """Angles of both ends of each of these panels and of its stationary points, rising, with
        the values there.
        """
        terms, count = len(self.series), len(panels)
        owner, x = _roots(_derivative(terms) @ self.series[:, panels])
        panel = np.concatenate([panels, panels, panels[owner]])
        x = np.concatenate([np.full(count, -1.0), np.full(count, 1.0), x])
        middle, half = _panels(self.breaks)
        angle = middle[panel] + half[panel] * x
        value = np.sum(self.series[:, panel] * legendre(x, terms), axis=0)
        rising = np.argsort(angle, kind="stable")
        return angle[rising], value[rising]


def resolved(function: Function, breaks: ArrayLike) -> PiecewiseCurve:
    """The curve of a function that is smooth between the given breakpoints.

    Args:
        function: values at angles strictly between breakpoints, of the shape of the angles; good
            to rounding errors.
        breaks: rising, rad; the last a period after the first.

    A panel is halved until its last two coefficients are below 2e-14 of the function's largest
    value, or until halving no longer helps because they are the function's own rounding errors, of
    which it may have nothing else.
    """
    edges = cut(np.asarray(breaks, float), _WIDEST)
    terms = _TERMS if len(edges) <= _MANY else _FEW_TERMS
    low, high, above = edges[:-1], edges[1:], np.full(len(edges) - 1, np.inf)
    nodes, _ = gauss(terms)
    size, starts, found = 0.0, [], []
    for halvings in range(_HALVINGS + 1):
        middle = (low + high) / 2
        values = function(middle + (high - low) / 2 * nodes[:, None])
        series = values_to_series(terms) @ values
        size = max(size, float(np.abs(values).max()))
        tail = np.abs(series[-2:]).max(axis=0)
        noise = (tail < _NOISE * size) & (tail > _HARDLY * above)
        halve = (tail > _RESOLVED * size) & ~noise & (halvings < _HALVINGS)
        halve &= len(low) < _EVERYWHERE * len(edges)
        starts.append(low[~halve])
        found.append(series[:, ~halve])
        if not halve.any():
            break
        low, middle, high = low[halve], middle[halve], high[halve]
        low, high = np.concatenate([low, middle]), np.concatenate([middle, high])
        above = np.tile(tail[halve], 2)
    start = np.concatenate(starts)
    rising = np.argsort(start)
    return PiecewiseCurve(
        np.append(start[rising], edges[-1]), np.concatenate(found, axis=1)[:, rising]
    )


def quadrature(breaks: Array) -> tuple[Array, Array]:
    """Angles within panels, and their weights in a mean over the period, (nodes, panels) each."""
    nodes, weights = gauss(_TERMS)
    middle, half = _panels(breaks)
    return middle + half * nodes[:, None], half * weights[:, None] / (breaks[-1] - breaks[0])


def polyline(angle: ArrayLike, value: ArrayLike) -> PiecewiseCurve:
    """Straight lines between points whose angles (rad) rise; two points at one angle are a jump.
    The last point closes the period, and if it differs from the first, there is a jump.
    """
    angles, values = np.asarray(angle, float), np.asarray(value, float)
    wide = np.diff(angles) > 0
    first, last = values[:-1][wide], values[1:][wide]
    return PiecewiseCurve(
        np.append(angles[:-1][wide], angles[-1]), np.stack([first + last, last - first]) / 2
    )


# ---------------------------------------------------------------- angles and breakpoints
def wrapped(angle: ArrayLike, breaks: Array, *, before: bool = False) -> Array:
    """The same angles within the period that the breakpoints span: in [first, last), or `before` a
    jump in (first, last].
    """
    start, period = breaks[0], breaks[-1] - breaks[0]
    angles = np.asarray(angle, float)
    if before:
        return breaks[-1] - np.remainder(breaks[-1] + _SAME - angles, period) + _SAME
    return start + np.remainder(angles + _SAME - start, period) - _SAME


def piece_of(angle: Array, breaks: Array, *, before: bool = False) -> NDArray[np.intp]:
    """Between which breakpoints wrapped angles lie: 0 for the first two; on a breakpoint after it,
    or `before` it.
    """
    shift = -_SAME if before else _SAME
    return np.clip(np.searchsorted(breaks, angle + shift, side="right") - 1, 0, len(breaks) - 2)


def with_break(breaks: Array, angle: float) -> Array:
    """Breakpoints with one more, unless it is among them; without numpy's `unique`, which imports
    masked arrays: that takes longer than all of this.
    """
    at = int(np.searchsorted(breaks, angle))
    there = at < len(breaks) and breaks[at] == angle
    return breaks if there else np.concatenate([breaks[:at], [angle], breaks[at:]])


def merged_breaks(parts: list[tuple[Array, float]], period: float) -> Array:
    """Breakpoints in [0, period] of a sum of functions, each given by its breakpoints and the angle
    (rad) by which it is shifted to the right.
    """
    inside = [np.remainder(breaks + shift, period) for breaks, shift in parts]
    rising = np.sort(np.concatenate([np.zeros(1), *inside, np.full(1, period)]))
    kept = rising[np.append(np.diff(rising) > _SAME, True)]
    kept[0] = 0.0
    return kept


def _panels(breaks: Array) -> tuple[Array, Array]:
    """Middle and half width of every panel."""
    return (breaks[1:] + breaks[:-1]) / 2, np.diff(breaks) / 2


def cut(breaks: Array, widest: float) -> Array:
    """Breakpoints with pieces wider than so much (rad) cut into equal panels."""
    wide = np.ceil(np.diff(breaks) / widest).astype(int)
    if wide.max() <= 1:
        return breaks
    parts = [
        np.linspace(low, high, count, endpoint=False)
        for low, high, count in zip(breaks[:-1], breaks[1:], wide, strict=True)
    ]
    return np.append(np.concatenate(parts), breaks[-1])


def _nodes_for(terms: int, reach: float) -> int:
    """Nodes that integrate a series times e^{i reach x} over [-1, 1] to rounding errors.

    The exponential is a polynomial of the degree at which (reach/2)^n/n! falls below 1e-17.
    """
    degree, term = 0, 1.0
    while term > 1e-17 or degree < reach / 2:
        degree += 1
        term *= reach / 2 / degree
    return (terms + degree) // 2 + 1


def _points(terms: int) -> Array:
    """Both ends and the nodes of a panel, shape (terms + 2,)."""
    return np.concatenate([[-1.0], gauss(max(terms, 2))[0], [1.0]])


def _roots(series: Array) -> tuple[NDArray[np.intp], Array]:
    """Panels and x in (-1, 1) at which a series changes its sign, each of shape (roots,): Newton's
    method between two neighbouring points, halving where it would leave them.
    """
    terms = len(series)
    points = _points(terms)
    values = legendre(points, terms).T @ series
    positive = values > 0
    row, panel = np.nonzero(positive[:-1] != positive[1:])
    low, high, rising = points[row], points[row + 1], positive[row + 1, panel]
    first, last = values[row, panel], values[row + 1, panel]
    own, slope = series[:, panel], (_derivative(terms) @ series)[:, panel]
    x = (low * last - high * first) / (last - first)
    for _ in range(50):
        basis = legendre(x, terms)
        value, rate = np.sum(own * basis, axis=0), np.sum(slope * basis, axis=0)
        beyond = (value > 0) == rising
        low, high = np.where(beyond, low, x), np.where(beyond, x, high)
        newton = x - value / np.where(rate == 0, 1, rate)
        inside = (rate != 0) & (newton >= low) & (newton <= high)
        x, last_x = np.where(inside, newton, (low + high) / 2), x
        if np.all(np.abs(x - last_x) <= _SAME_X):
            break
    return panel, x

"""Functions of an angle that are smooth between breakpoints: pressures, torques, energies, speeds.

Between two breakpoints such a function is cut into panels, and on every panel it is a short
Legendre series, found from its values at the Gauss-Legendre nodes. Panels are halved until the last
terms are small, so that nobody has to know beforehand how sharp a function is. Mean, harmonics,
integral and extremes then follow from the series, and no sample is ever taken across a corner or a
jump.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import ArrayLike, NDArray

from .phasors import Array, Complex

Function: TypeAlias = Callable[[Array], Array]  # value at angles (rad), of their shape

_WIDEST = 0.5  # rad, of a panel before any is halved
_TERMS = 16
_RESOLVED = 1e-12  # last terms of a series, relative to the largest value of the function
_NOISE = 1e-5  # last terms below this share that halving hardly lowers are rounding errors
_HARDLY = 0.75
_HALVINGS = 48
_EVERYWHERE = 256  # times as many panels: what these do not show is nothing but noise
_REACH = 16.0  # rad, of the waves on a panel that this many nodes integrate
_NODES = 32
_SAME = 1e-11  # rad; an angle so near to a breakpoint is the breakpoint
_NEWTON_STEPS = 12
_NO_SIGN = 1e-9  # values below this share of the largest have no sign
_ROUNDING = 1e-14  # a smaller share of the largest value, or of what is added up, is 0
_TIE = 1e-11  # extremes that differ by a smaller share of the range are equal


class Extreme(NamedTuple):
    """Angle (rad) at which a curve is lowest or highest, and its value there."""

    angle: float
    value: float


@lru_cache
def gauss(count: int) -> tuple[Array, Array]:
    """Return nodes (rising) and weights of the Gauss-Legendre quadrature on [-1, 1], each of shape
    (count,).
    """
    nodes, weights = legendre.leggauss(count)
    return nodes, weights


@lru_cache
def values_to_series(count: int) -> Array:
    """Return the matrix from values at the nodes of `gauss` to Legendre coefficients."""
    nodes, weights = gauss(count)
    basis = legendre.legvander(nodes, count - 1)
    return np.asarray((np.arange(count)[:, None] + 0.5) * basis.T * weights)


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
        """Length of one period, rad."""
        return float(self.breaks[-1] - self.breaks[0])

    @cached_property
    def integral(self) -> float:
        """Integral over one period; 0 if it is what rounding leaves of panels that cancel."""
        panels = self.series[0] * np.diff(self.breaks)
        total = float(np.sum(panels))
        return 0.0 if abs(total) <= _ROUNDING * float(np.sum(np.abs(panels))) else total

    @property
    def mean(self) -> float:
        """Mean value over one period."""
        return self.integral / self.period

    def at(self, angle: ArrayLike, *, before: bool = False) -> Array:
        """Return values at any angles (rad), of their shape; at a jump the value after it, or
        `before` it.
        """
        return self.within(wrapped(angle, self.breaks, before=before), before=before)

    def within(self, angle: Array, *, before: bool = False) -> Array:
        """Return values at angles between the first and the last breakpoint."""
        panel = piece_of(angle, self.breaks, before=before)
        middle, half = _panels(self.breaks)
        x = np.clip((angle - middle[panel]) / half[panel], -1, 1)
        return np.asarray(legendre.legval(x, self.series[:, panel], tensor=False))

    def plus(self, constant: float) -> PiecewiseCurve:
        """Return the curve raised by a constant."""
        series = self.series.copy()
        series[0] += constant
        return PiecewiseCurve(self.breaks, series)

    def repeated(self, times: int) -> PiecewiseCurve:
        """Return the same curve over a period so many times as long."""
        start = self.period * np.arange(times)[:, None]
        inner = (self.breaks[:-1] + start).reshape(-1)
        end = self.breaks[0] + self.period * times
        return PiecewiseCurve(np.append(inner, end), np.tile(self.series, (1, times)))

    def harmonics(self, wanted: ArrayLike) -> Complex:
        """Return coefficients c_k of `Re sum c_k e^{2 pi i k angle/period}` for the wanted whole
        numbers k >= 0, of their shape (harmonics,); c_0 is the mean.
        """
        numbers = np.asarray(wanted, int)
        unit, top = 2 * np.pi / self.period, int(numbers.max(initial=0))
        angle, weights = quadrature(cut(self.breaks, _REACH / (unit * max(top, 1))), _NODES)
        shares = (2 * self.within(angle) * weights).reshape(-1)

        def turn(harmonics: NDArray[np.intp]) -> Complex:
            return np.exp(-1j * np.multiply.outer(unit * harmonics, angle.reshape(-1)))

        # e^(-i k angle) of k = high * stride + low is a product: few waves of each make all
        stride = math.isqrt(top) + 1
        low, high = np.arange(stride), np.arange(top // stride + 1)
        every = turn(low) @ (turn(high * stride) * shares).T
        return np.where(numbers == 0, self.mean, every[numbers % stride, numbers // stride])

    def antiderivative(self) -> PiecewiseCurve:
        """Return the integral from the first breakpoint on; periodic if the mean is 0."""
        half = np.diff(self.breaks) / 2
        series = legendre.legint(self.series, lbnd=-1) * half
        area = 2 * half * self.series[0]
        series[0] += np.cumsum(area) - area
        return PiecewiseCurve(self.breaks, series)

    def extremes(self) -> tuple[Extreme, Extreme]:
        """Return the lowest and the highest value, each at the first of its angles; at a jump both
        sides count. A value that is rounding error next to the larger one is 0.
        """
        points, values = self._sample()
        size, tie = float(np.abs(values).max()), _TIE * float(np.ptp(values))
        low, high = (self._find_top(sign, points, values, tie) for sign in (-1, 1))
        least, most = (
            one._replace(value=0.0 if abs(one.value) <= _ROUNDING * size else one.value)
            for one in (low, high)
        )
        return least, most

    def reversals(self) -> int:
        """Return how often the sign changes in a period; a value within 1e-9 of the largest has no
        sign.
        """
        value = self._sample()[1].T.reshape(-1)
        signs = np.sign(value[np.abs(value) > _NO_SIGN * np.abs(value).max()])
        return int(np.count_nonzero(signs != np.roll(signs, 1)))

    def _sample(self) -> tuple[Array, Array]:
        """Return both ends and the nodes of a panel, shape (points,), and the values there on every
        panel, shape (points, panels).
        """
        points = np.concatenate([[-1.0], gauss(max(len(self.series), 2))[0], [1.0]])
        return points, legendre.legvander(points, len(self.series) - 1) @ self.series

    def _find_top(self, sign: int, points: Array, values: Array, tie: float) -> Extreme:
        """Return the lowest (sign -1) or highest (1) value: from the best point of every panel that
        can reach it, Newton's method follows the series. No series exceeds the sum of the sizes of
        its coefficients.
        """
        able = sign * self.series[0] + np.abs(self.series[1:]).sum(axis=0)
        panels = np.flatnonzero(able >= (sign * values).max() - 2 * tie)
        heights = sign * values[:, panels]
        start = points[np.argmax(heights >= heights.max(axis=0) - tie, axis=0)]
        rate = legendre.legder(self.series[:, panels])
        bend, x = legendre.legder(rate), start
        for _ in range(_NEWTON_STEPS):
            slope, curved = (legendre.legval(x, each, tensor=False) for each in (rate, bend))
            x = np.clip(x - slope / np.where(sign * curved < 0, curved, np.inf), -1, 1)
        before, value = (
            legendre.legval(each, self.series[:, panels], tensor=False) for each in (start, x)
        )
        higher = sign * (value - before) > _ROUNDING * np.abs(values).max()
        x, value = np.where(higher, x, start), np.where(higher, value, before)
        first = int(np.argmax(sign * value >= (sign * value).max() - tie))
        middle, half = _panels(self.breaks)
        angle = middle[panels] + half[panels] * x
        return Extreme(float(angle[first]), float(sign * (sign * value).max()))


def resolved(function: Function, breaks: ArrayLike) -> PiecewiseCurve:
    """Return the curve of a function that is smooth between the given breakpoints.

    A panel is halved until its last two coefficients are below 1e-12 of the function's largest
    value, or until halving hardly lowers them because they are rounding errors of the function.

    Args:
        function: values at angles strictly between breakpoints, of the shape of the angles.
        breaks: rising, rad; the last a period after the first.
    """
    edges = cut(np.asarray(breaks, float), _WIDEST)
    low, high, above = edges[:-1], edges[1:], np.full(len(edges) - 1, np.inf)
    nodes, _ = gauss(_TERMS)
    size, starts, found = 0.0, [], []
    for halvings in range(_HALVINGS + 1):
        middle = (low + high) / 2
        values = function(middle + (high - low) / 2 * nodes[:, None])
        series = values_to_series(_TERMS) @ values
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


def quadrature(breaks: Array, nodes: int = _TERMS) -> tuple[Array, Array]:
    """Return angles within panels, rad, and their weights in a mean over the period, each of shape
    (nodes, panels).
    """
    x, weights = gauss(nodes)
    middle, half = _panels(breaks)
    return middle + half * x[:, None], half * weights[:, None] / (breaks[-1] - breaks[0])


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
    """Return the breakpoints with one more, unless it is among them."""
    return np.unique(np.append(breaks, angle))


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

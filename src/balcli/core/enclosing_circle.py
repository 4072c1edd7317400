"""Smallest circle that encloses a closed curve, found on the analytic curve itself.

The curve is a force seen from the turning crank, `f = F e^{-i theta}`. An exchange: the smallest
circle of a few of its points, which can only be too small, then the points of the curve farthest
from its centre, until both agree; Newton's method on the points that fix the circle makes it quick
and gives the centre to rounding even where the radius is flat. Any weights w of points bound the
radius from below, `R^2 >= sum w |f|^2 - |sum w f|^2`: the error is known.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from .peaks import climb_peaks, find_candidates
from .phasors import EPS, Array, Complex, Phasors

_SAME = 8 * EPS  # points no farther outside than this, relative, are on the circle
_TOUCHING = 1e-11  # likewise for the angles that are reported
_APART = 1e-3  # rad; angles nearer than this are one peak
_ROUNDS = 60
_NEWTON_STEPS = 4  # from points that nearly fix the circle, to rounding
_STEP = 1e-6  # rad, of differences that stand for derivatives
_FLAT = 1e-9  # singular values of the slopes below this share of the largest: a flat radius


class Circle(NamedTuple):
    """Smallest circle around a curve.

    Attributes:
        theta: angles (rad, ascending) at which the curve touches it.
        excess: bound by which the radius may be too large; 0 where that is no more than `noise`.
        noise: rounding error of the radius.
    """

    centre: complex
    radius: float
    theta: Array
    excess: float
    noise: float = 0.0


def enclose_curve(curve: Phasors) -> Circle:
    """Smallest circle around `F e^{-i theta}` for phasors of whole orders, 1 among them, without
    trailing axes.
    """
    there = np.flatnonzero((curve.major != 0) | (curve.orders == 1))
    if not np.any(curve.major):
        return Circle(0j, 0.0, np.zeros(0), 0.0)
    curve = Phasors(curve.orders[there], curve.vectors[:, there], np.zeros(1))
    best = _enclose_from(curve, complex(curve.forward[curve.orders == 1].sum()), np.zeros(0))
    theta, lower = best.theta, 0.0
    for _ in range(_ROUNDS):
        points = _seen(curve, theta)
        centre, _, fixing = enclose_points(points)
        theta = theta[fixing]
        lower = max(lower, _lower_bound(points[fixing], centre))
        trials = [_enclose_from(curve, c, theta) for c in (centre, _newton(curve, theta, centre))]
        best = min(best, *trials, key=lambda circle: circle.radius)
        if best.radius - lower <= _SAME * best.radius:
            break
        theta = _drop_near(np.concatenate([theta, *(circle.theta for circle in trials)]), _SAME)
    fine = _enclose_from(curve, _newton(curve, theta, best.centre), theta)
    best = fine if fine.radius <= best.radius * (1 + _SAME) else best
    noise = _SAME * float(curve.major.sum())
    on = np.abs(_seen(curve, best.theta) - best.centre) >= best.radius * (1 - _TOUCHING) - noise
    excess = best.radius - lower
    return best._replace(
        theta=best.theta[on], excess=excess if excess > noise else 0.0, noise=noise
    )


def enclose_points(points: Complex) -> tuple[complex, float, list[int]]:
    """Smallest circle around some points: centre, radius, and the (at most three) points that fix
    it.

    Point after point, the circle growing where one lies outside, which must then lie on it (Welzl
    1991, as loops).
    """

    def grown(count: int, fixed: list[int]) -> tuple[complex, float, list[int]]:
        centre, radius, on = _through(points, fixed)
        for k in range(count):
            if abs(points[k] - centre) > radius * (1 + _SAME) and len(fixed) < 3:
                centre, radius, on = grown(k, [*fixed, k])
        return centre, radius, on

    return grown(len(points), [])


def _through(points: Complex, fixed: Sequence[int]) -> tuple[complex, float, list[int]]:
    """Circle of none, one, two (as diameter) or three points."""
    if not fixed:
        return 0j, -1.0, []
    a = complex(points[fixed[0]])
    if len(fixed) == 1:
        return a, 0.0, list(fixed)
    b = complex(points[fixed[1]]) - a
    if len(fixed) == 2:
        return a + b / 2, abs(b) / 2, list(fixed)
    c = complex(points[fixed[2]]) - a
    across = 2 * (b.conjugate() * c).imag
    if across == 0:
        return a, np.inf, list(fixed)
    middle = 1j * (b * abs(c) ** 2 - c * abs(b) ** 2) / across
    return a + middle, abs(middle), list(fixed)


def _lower_bound(points: Complex, centre: complex) -> float:
    """A lower bound of the radius, by the weights with which the points balance about a centre."""
    arms = points - centre
    rows = np.stack([arms.real, arms.imag, np.full(len(arms), np.abs(arms).max() or 1.0)])
    weights = np.clip(
        np.linalg.lstsq(rows, rows[2, 0] * np.array([0, 0, 1.0]), rcond=None)[0], 0, None
    )
    weights /= weights.sum()
    return float(np.sqrt(max(weights @ np.abs(arms) ** 2 - abs(weights @ arms) ** 2, 0.0)))


def _enclose_from(curve: Phasors, centre: complex, theta: Array) -> Circle:
    """The smallest circle with this centre; its angles are those of the highest peaks, and of those
    beside the angles given.
    """
    forward = np.where(curve.orders == 1, curve.forward - centre, curve.forward)
    shifted = Phasors.of(curve.orders, forward, curve.backward, curve.noise)
    start = np.concatenate([find_candidates(shifted), theta])
    found = _drop_near(climb_peaks(shifted, start, np.pi / (8 * curve.orders[-1])))
    return Circle(centre, float(np.abs(shifted.values(found)).max()), found, np.inf)


def _newton(curve: Phasors, theta: Array, centre: complex) -> complex:
    """The centre of the circle through the points that fix it once each is where the curve is
    farthest from that centre.
    """
    theta = _drop_near(theta)
    if len(theta) < 2:
        return centre

    def slopes(theta: Array) -> tuple[Array, complex]:
        seen = _seen(curve, theta)
        middle = _through(seen, range(len(theta)))[0]
        return (np.conj(seen - middle) * _rate(curve, theta)).real, middle

    for _ in range(_NEWTON_STEPS):
        columns = [
            (slopes(theta + h)[0] - slopes(theta - h)[0]) / (2 * _STEP)
            for h in _STEP * np.eye(len(theta))
        ]
        inverse = np.linalg.pinv(np.stack(columns, axis=1), rcond=_FLAT)
        theta = theta - inverse @ slopes(theta)[0]
    return slopes(theta)[1]


def _drop_near(theta: Array, apart: float = _APART) -> Array:
    """Angles in [0, 2 pi), ascending, of several that lie together the first."""
    theta = np.sort(theta % (2 * np.pi))
    first = np.diff(theta, prepend=theta[-1:] - 2 * np.pi) > apart
    return theta[first] if first.any() else theta[:1]


def _seen(curve: Phasors, theta: Array) -> Complex:
    seen: Complex = curve.values(theta) * np.exp(-1j * theta)
    return seen


def _rate(curve: Phasors, theta: Array) -> Complex:
    """Derivative of the curve seen from the crank."""
    n = curve.orders
    return _seen(
        Phasors.of(n, 1j * (n - 1) * curve.forward, -1j * (n + 1) * curve.backward, curve.noise),
        theta,
    )

"""Smallest circle that encloses a closed curve, found on the analytic curve itself.

The curve is a force seen from the turning crank, `f = F e^{-i theta}`. An exchange: the smallest
circle of a few of its points, which can only be too small, then the peaks of the difference
between curve and centre, until both agree. Newton's method on the two or three angles that fix the
circle gives the centre to rounding even where the radius is flat. Weights w >= 0 of points with sum
1 bound the radius from below, `R^2 >= sum w |f|^2 - |sum w f|^2`: the error is known.
"""

from __future__ import annotations

from itertools import combinations
from typing import NamedTuple

import numpy as np

from .peaks import find_near_peaks
from .phasors import EPS, Complex, Phasors
from .vibration import Real

_SAME = 8 * EPS  # points no farther outside than this, relative, are on the circle
_TOUCHING = 1e-11  # the same for the angles that are reported
_APART = 1e-3  # rad; angles nearer than this are one peak
_ROUNDS = 60
_NEWTON_STEPS = 4  # from points that nearly fix the circle, to rounding
_STEP = 1e-6  # rad, of differences that stand for derivatives
_FLAT = 1e-9  # singular values of the slopes below this share of the largest: a flat radius


class Circle(NamedTuple):
    """Smallest circle around a curve.

    Attributes:
        theta: angles (rad, ascending) at which the curve touches it.
        excess: bound by which the radius may be too large; 0 if that is no more than `noise`.
        noise: rounding error of the radius.
    """

    centre: complex
    radius: float
    theta: Real
    excess: float
    noise: float = 0.0


def enclose_curve(curve: Phasors) -> Circle:
    """Return the smallest circle around `F e^{-i theta}` for phasors of whole orders, 1 among them,
    without trailing axes.
    """
    there = np.flatnonzero((curve.major != 0) | (curve.orders == 1))
    if not np.any(curve.major):
        return Circle(0j, 0.0, np.zeros(0), 0.0)
    curve = Phasors(curve.orders[there], curve.vectors[:, there], np.zeros(1))
    noise = _SAME * float(curve.major.sum())
    best = _reach(curve, complex(curve.forward[curve.orders == 1].sum()))
    theta, lower = best.theta, 0.0
    for _ in range(_ROUNDS):
        points = _seen(curve, theta)
        centre, fixing = enclose_points(points)
        theta = theta[fixing]
        lower = max(lower, _lower_bound(points[fixing], centre))
        trials = [_reach(curve, c) for c in (centre, _newton(curve, theta, centre))]
        best = min(best, *trials, key=lambda circle: circle.radius)
        if best.radius - lower <= noise:
            break
        theta = np.concatenate([theta, *(circle.theta for circle in trials)])
    fine = _reach(curve, _newton(curve, best.theta if len(theta) < 2 else theta, best.centre))
    best = fine if fine.radius <= best.radius + noise else best
    on = np.abs(_seen(curve, best.theta) - best.centre) >= best.radius * (1 - _TOUCHING) - noise
    excess = best.radius - lower
    return Circle(best.centre, best.radius, best.theta[on], excess * (excess > noise), noise)


def enclose_points(points: Complex) -> tuple[complex, list[int]]:
    """Return the centre of the smallest circle around some points, and the (at most three) points
    that fix it: of those and the farthest point, again and again.
    """
    centre, radius, fixing = complex(points[0]), 0.0, [0]
    for _ in range(len(points) + _ROUNDS):
        distance = np.abs(points - centre)
        farthest = int(np.argmax(distance))
        if distance[farthest] <= radius * (1 + _SAME) or farthest in fixing:
            break
        few = [*fixing, farthest]
        circles = [
            (float(np.abs(points[list(some)] - middle).max()), middle, list(some))
            for count in (2, 3)
            for some in combinations(few, count)
            if (middle := _find_middle(points[list(some)])) is not None
        ]
        holding = [
            one for one in circles if np.abs(points[few] - one[1]).max() <= one[0] * (1 + _TOUCHING)
        ]
        radius, centre, fixing = min(holding or circles, key=lambda one: one[0])
    return centre, fixing


def _find_middle(points: Complex) -> complex | None:
    """Return the centre of the circle through two points (as diameter) or three; None: in line."""
    a, b = complex(points[0]), complex(points[1] - points[0])
    if len(points) == 2:
        return a + b / 2
    c = complex(points[2]) - a
    across = 2 * (b.conjugate() * c).imag
    return a + 1j * (b * abs(c) ** 2 - c * abs(b) ** 2) / across if across else None


def _lower_bound(points: Complex, centre: complex) -> float:
    """Return a lower bound of the radius, by weights with which the points balance about the
    centre.
    """
    arms = points - centre
    size = np.abs(arms).max() or 1.0
    rows = np.stack([arms.real / size, arms.imag / size, np.ones(len(arms))])
    weights = np.clip(np.linalg.lstsq(rows, np.array([0, 0, 1.0]), rcond=None)[0], 0, None)
    weights /= weights.sum()
    return float(np.sqrt(max(weights @ np.abs(arms) ** 2 - abs(weights @ arms) ** 2, 0.0)))


def _reach(curve: Phasors, centre: complex) -> Circle:
    """Return the smallest circle with this centre, and the peaks of the difference."""
    forward = np.where(curve.orders == 1, curve.forward - centre, curve.forward)
    difference = Phasors.of(curve.orders, forward, curve.backward, curve.noise)
    if not np.any(difference.vectors):
        return Circle(centre, 0.0, np.zeros(1), np.inf)
    theta = find_near_peaks(difference)
    first = np.diff(theta, prepend=theta[-1] - 2 * np.pi) > _APART
    theta = theta[first] if np.any(first) else theta[:1]
    return Circle(centre, float(np.abs(difference.values(theta)).max()), theta, np.inf)


def _newton(curve: Phasors, theta: Real, centre: complex) -> complex:
    """Return the centre of the circle through two or three points of the curve once each is where
    the curve is farthest from that centre.
    """
    if not 2 <= len(theta) <= 3:
        return centre

    def slopes(theta: Real) -> tuple[Real, complex]:
        seen = _seen(curve, theta)
        middle = _find_middle(seen)
        middle = centre if middle is None else middle
        return (np.conj(seen - middle) * _seen(curve, theta, 1)).real, middle

    for _ in range(_NEWTON_STEPS):
        columns = [
            (slopes(theta + h)[0] - slopes(theta - h)[0]) / (2 * _STEP)
            for h in _STEP * np.eye(len(theta))
        ]
        inverse = np.linalg.pinv(np.stack(columns, axis=1), rcond=_FLAT)
        theta = theta - inverse @ slopes(theta)[0]
    return slopes(theta)[1]


def _seen(curve: Phasors, theta: Real, times: int = 0) -> Complex:
    """Return the curve seen from the crank, differentiated so many times, at angles (rad)."""
    ahead, against = 1j * (curve.orders - 1), -1j * (curve.orders + 1)
    return np.asarray(
        np.exp(np.multiply.outer(theta, ahead)) @ (ahead**times * curve.forward)
        + np.exp(np.multiply.outer(theta, against)) @ (against**times * curve.backward)
    )

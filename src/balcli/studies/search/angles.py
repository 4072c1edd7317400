"""Where a function of one angle is least while other functions stay below their limits: every local
minimum, however narrow the stretches that the limits leave.

A minimum lies where the function itself has one or where a limit begins to hold. These places are
computed and join a grid of angles as nodes; among the nodes the minima are then looked up, a broken
limit counting as infinite. A stretch that a limit leaves between two angles of the grid is found by
the minimum of the limited function in it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from ...core.phases import TURN
from ...core.phasors import Array
from ...engine.arrays import ranked

Curve = Callable[[Array], Array]  # a figure at some angles (deg), same shape
STEP = 0.5  # deg: of the grid, and at most
STEPS_A_WAVE = 16  # of the highest order
POINTS = 21  # into which each bracket is divided, again and again
ROUNDS_TO_MINIMUM = 9  # each makes the bracket (POINTS - 1)/2 times shorter
ROUNDS_TO_EDGE = 11  # each makes it POINTS - 1 times shorter, down to neighbouring numbers
ROUND = (1.0, 0.1, 0.01, 0.001, 1e-4)  # deg: the roundest angle that is as good is taken
AS_GOOD = 1e-9  # of the function's largest value
BELOW = 1e-10  # a limit, of itself: nearer to it, rounding says whether it is kept
_DECIMALS = 9  # of a short angle in degrees
_LARGEST_DENOMINATOR = 5040  # of a fraction of a turn: 7!, which has all common divisions
_NEAR = 1e-11  # deg, from a short one


@dataclass(frozen=True)
class Span:
    """The angles that are looked at, deg: [low, high], or all of a turn, (low, high]."""

    low: float
    high: float

    @property
    def ring(self) -> bool:
        """Whether it is a whole turn, in which the last angle stands beside the first."""
        return self.high - self.low == TURN

    def divide(self, step: float) -> Array:
        """Equally spaced angles, at most `step` apart."""
        grid = np.linspace(self.low, self.high, round(np.ceil((self.high - self.low) / step)) + 1)
        return grid[1:] if self.ring else grid

    def bring_inside(self, x: Array) -> Array:
        """The same angles within the span: those of a turn modulo 360, others at its end."""
        if self.ring:
            turned = self.high - np.remainder(self.high - x, TURN)
            return np.where((self.low < x) & (x <= self.high), x, turned)
        return np.clip(x, self.low, self.high)


def find_minima(
    curve: Curve, limits: Sequence[tuple[Curve, float]], span: Span, highest_order: float
) -> Array:
    """All local minima of `curve` where each limited curve is below its limit, deg, lowest first.

    Args:
        limits: curves and what they must stay below.
        highest_order: how often the curves may turn in 360 degrees.
    """
    step = min(STEP, TURN / (STEPS_A_WAVE * (highest_order + 1)))
    grid = span.divide(step)
    limited = [c for c, _ in limits]
    nodes = _join(span, grid, *(_find_valleys(c, grid, span) for c in (curve, *limited)))
    edges = [_find_edges(c, limit * (1 - BELOW), nodes, span) for c, limit in limits]
    nodes = _join(span, nodes, *edges)

    def keep_limits(x: Array) -> Array:
        values = curve(x)
        for c, limit in limits:
            values = np.where(c(x) < limit, values, np.inf)
        return values

    y = keep_limits(nodes)
    lowest = [run[y[run].argmin()] for run in _find_bottoms(y, span.ring)]
    if not lowest:
        return nodes[:0]
    slack = AS_GOOD * y[np.isfinite(y)].max()
    found = np.unique(span.bring_inside(_round_off(keep_limits, nodes[lowest], step, slack)))
    return found[np.argsort(ranked(keep_limits(found)), kind="stable")]


def _join(span: Span, *parts: Array) -> Array:
    return np.unique(span.bring_inside(np.concatenate(parts)))


def _find_bottoms(y: Array, ring: bool) -> list[NDArray[np.intp]]:
    """Runs of equal values (but for rounding) that are lower than both neighbours, as indices."""
    level = ranked(y)
    runs = np.split(np.arange(len(y)), np.flatnonzero(level[1:] != level[:-1]) + 1)
    if ring and len(runs) > 1 and level[0] == level[-1]:
        runs[0] = np.concatenate([runs.pop(), runs[0]])
    heights = level[[run[0] for run in runs]]
    before, after = np.roll(heights, 1), np.roll(heights, -1)
    if not ring or len(runs) == 1:
        before[0] = after[-1] = np.inf
    deep = (heights < before) & (heights < after)
    return [runs[k] for k in np.flatnonzero(deep)]


def _find_valleys(curve: Curve, grid: Array, span: Span) -> Array:
    """The minima of a curve without limits, and round angles beside them."""
    step = grid[1] - grid[0]
    runs = _find_bottoms(curve(grid), span.ring)
    if not runs:
        return grid[:0]
    low, high = grid[[run[0] for run in runs]] - step, grid[[run[-1] for run in runs]] + step
    if not span.ring:
        low, high = span.bring_inside(low), span.bring_inside(high)
    high = np.where(high < low, high + TURN, high)  # across the seam of a turn
    row = np.arange(len(low))
    for _ in range(ROUNDS_TO_MINIMUM):
        x = np.linspace(low, high, POINTS, axis=1)
        best = curve(x.ravel()).reshape(x.shape).argmin(axis=1)
        lowest = x[row, best]
        low, high = x[row, np.maximum(best - 1, 0)], x[row, np.minimum(best + 1, POINTS - 1)]
    return np.concatenate([lowest, *(np.round(lowest / grain) * grain for grain in ROUND)])


def _find_edges(curve: Curve, limit: float, nodes: Array, span: Span) -> Array:
    """Both sides, as near as numbers can be, of each place where a curve crosses a limit."""
    low, high = nodes, np.append(nodes[1:], nodes[0] + TURN)
    if not span.ring:
        low, high = low[:-1], high[:-1]
    kept = curve(nodes) < limit
    crossed = (kept != np.roll(kept, -1))[: len(low)]
    low, high = low[crossed], high[crossed]
    if not len(low):
        return low
    row = np.arange(len(low))
    for _ in range(ROUNDS_TO_EDGE):
        x = np.linspace(low, high, POINTS, axis=1)
        kept = (curve(x.ravel()) < limit).reshape(x.shape)
        last = (kept == kept[:, :1]).argmin(axis=1) - 1  # before the first that is otherwise
        low, high = x[row, last], x[row, last + 1]
    return np.concatenate([low, high])


def _round_off(curve: Curve, x: Array, farthest: float, slack: float) -> Array:
    """The same angles, or rounder ones, no farther than that, as good but for the slack."""
    found, enough = x, curve(x) + slack
    for grain in reversed(ROUND):
        rounder = np.round(found / grain) * grain + 0.0  # without the sign of -0.0
        good = (np.abs(rounder - x) <= farthest) & (curve(rounder) <= enough)
        found = np.where(good, rounder, found)
    return found


def neaten(angles: Array) -> Array:
    """Angles without the rounding errors of a sum, any shape: short decimals and fractions of a
    turn as a file would have them, others as they are.
    """
    different, which = np.unique(angles, return_inverse=True)
    neat = np.array([_neaten(float(angle)) for angle in different])
    return neat[which].reshape(angles.shape)


def _neaten(angle: float) -> float:
    short = round(angle, _DECIMALS)
    if abs(short - angle) <= _NEAR:
        return short
    fraction = Fraction(angle / TURN).limit_denominator(_LARGEST_DENOMINATOR)
    neat = float(fraction * TURN)
    return neat if abs(neat - angle) <= _NEAR else angle

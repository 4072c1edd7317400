"""Local optima of a function of one or several numbers in a box.

Candidates are spread over the box: a grid of one number, a quasi-random sequence of several. From
each candidate that is better than its neighbours a local search starts. It compares candidates and
uses no derivatives, because sizes of vectors have kinks where they vanish, limits have edges, and
some numbers make no engine: halved steps for one number, the evolution strategy with covariance
adaptation (Hansen, The CMA Evolution Strategy: A Tutorial, arXiv:1604.00772) for several.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from typing import NamedTuple

import numpy as np

from ...core.phasors import Array
from ...engine.figures import ranked
from .designs import Merit

Judge = Callable[[Array], Merit]  # of points, shape (points, numbers)
_DIGITS = 12  # of numbers
_LEVEL, _ROUNDING = 1e-9, 1e-12  # relative difference of costs that are equal; of the largest


@dataclass(frozen=True)
class Box:
    """The ranges of some numbers, shape (numbers,) each; a number of a ring comes back to `low`
    beyond `high`.
    """

    low: Array
    high: Array
    ring: Array

    @property
    def size(self) -> int:
        """Number of numbers."""
        return len(self.low)

    @property
    def span(self) -> Array:
        """Widths of the ranges."""
        return np.where(self.high > self.low, self.high - self.low, 1.0)

    def bring_inside(self, points: Array) -> Array:
        """Return points (..., numbers) in the box: the nearest, or modulo the span of a ring."""
        turned = self.high - np.remainder(self.high - points, self.span)
        return np.where(self.ring, turned, np.clip(points, self.low, self.high))

    def subtract(self, points: Array, others: Array) -> Array:
        """Return points - others as shares of the spans, the short way around a ring."""
        share = (points - others) / self.span
        return np.where(self.ring, share - np.round(share), share)

    def spread(self, count: int) -> Array:
        """Return points spread over the box: a grid, or the R sequence of several numbers."""
        if self.size == 1:
            grid = np.linspace(self.low, self.high, count + 1 if self.high > self.low else 1)
            return grid[1:] if self.ring[0] else grid
        base = 2.0
        for _ in range(50):  # the root of x**(numbers + 1) = x + 1
            base = (1 + base) ** (1 / (self.size + 1))
        steps = base ** -np.arange(1.0, self.size + 1)
        return self.low + self.span * ((0.5 + np.arange(count)[:, None] * steps) % 1)


@dataclass(frozen=True)
class Effort:
    """Effort of a search.

    Attributes:
        points: Number of points spread over the box.
        starts: Largest number of local searches.
        exact: Accuracy of an optimum, as a share of the box.
        as_good: Relative difference of costs that a rounder number may make.
        same: Distance, as a share of the box, below which two optima are one.
        steps: Number of points examined between two optima.
    """

    points: int
    starts: int
    exact: float
    as_good: float = 1e-13  # a smooth minimum is flat to rounding
    same: float = 1e-5
    steps: int = 31

    def count_evaluations(self, numbers: int) -> int:
        """Return about how many candidates are evaluated."""
        halvings = -math.log2(self.exact)
        return round(self.points + self.starts * halvings * (2 if numbers == 1 else 30 * numbers))


class LocalOptima(NamedTuple):
    """Result of a search.

    Attributes:
        places: local optima that keep all limits, best first, shape (optima, numbers); each is the
            roundest point that is as good.
        lines: for each, another end of a line of equally good points, or itself, shape (optima,
            numbers).
        merits: merits of the points that were spread over the box.
    """

    places: Array
    lines: Array
    merits: Merit


def find_local_optima(judge: Judge, box: Box, effort: Effort) -> LocalOptima:
    """Return every local optimum in a box that is found from `effort.starts` starts, once."""
    points = box.spread(effort.points)
    merits = judge(points)
    starts = _find_starts(points, merits, box)[: effort.starts]
    step = effort.points ** (-1 / box.size)  # between neighbours, as a share of the box
    if box.size == 1:
        found = _descend(judge, box, points[starts], step * box.span, effort.exact * box.span)
    else:
        found = _adapt(judge, box, points[starts], 0.5 * step, effort)
    ends = judge(found)
    kept = np.flatnonzero((ends.excess == 0) & np.isfinite(ends.cost))
    slack = effort.as_good * np.abs(ends.cost)
    rounded = [_round_off(judge, box, found[k], slack[k]) for k in kept]
    found = np.array(rounded).reshape(-1, box.size)
    costs = merits.cost[np.isfinite(merits.cost)]
    noise = _ROUNDING * np.abs(costs).max(initial=0)
    places, lines = _separate(judge, box, found, effort, noise)
    return LocalOptima(places, lines, merits)


def _separate(
    judge: Judge, box: Box, found: Array, effort: Effort, noise: float
) -> tuple[Array, Array]:
    """Return the optima from which none of the others can be reached without going uphill, best
    first; and the ends of lines of equally good points, as of `LocalOptima`.

    A search that stops on a line, such as one on which limits are kept, reaches a better point of
    the line without going uphill.
    """
    best: list[Array] = []
    lines: list[Array] = []
    ends = judge(found)
    for k in Merit(ends.excess, ranked(ends.cost)).rank():
        for n, other in enumerate(best):
            way = box.subtract(found[k], other)
            if np.abs(way).max() <= effort.same:
                break
            line = other + np.linspace(0, 1, effort.steps + 2)[:, None] * way * box.span
            along = judge(box.bring_inside(line))
            level = along.cost[-1] + _LEVEL * abs(along.cost[-1]) + noise
            if not along.excess.any() and along.cost.max() <= level:
                if along.cost[0] >= 2 * along.cost[-1] - level:
                    lines[n] = found[k]
                else:
                    best[n] = lines[n] = _slide(judge, box, other, way, effort)
                break
        else:
            best.append(found[k])
            lines.append(found[k])
    places = np.array(best).reshape(-1, box.size)
    ends = judge(places)
    order = Merit(ends.excess, ranked(ends.cost)).rank()
    return places[order], np.array(lines).reshape(-1, box.size)[order]


def _slide(judge: Judge, box: Box, point: Array, way: Array, effort: Effort) -> Array:
    """Return the best point on the line through a point in a direction (shares of the box)."""
    farthest = 1 / np.abs(way).max(keepdims=True)
    line = Box(-farthest, farthest, np.array([False]))

    def find(along: Array) -> Array:
        return box.bring_inside(point + along * way * box.span)

    finer = Effort(effort.steps, 2, effort.exact)
    places = find_local_optima(lambda along: judge(find(along)), line, finer).places
    return find(places[0]) if len(places) else point


def _find_starts(points: Array, merits: Merit, box: Box) -> Array:
    """Return the indices of the points that are better than their neighbours, best first; of equal
    ones the first.
    """
    merits = Merit(merits.excess, ranked(merits.cost))
    place = np.empty(len(points), int)
    place[merits.rank()] = np.arange(len(points))
    starts = []
    for k in np.flatnonzero(np.isfinite(merits.excess)):
        distance = (box.subtract(points, points[k]) ** 2).sum(axis=1)
        distance[k] = np.inf
        near = np.argsort(distance, kind="stable")[: 2 * box.size]
        if not any(place[near] < place[k]):
            starts.append(k)
    return np.array(sorted(starts, key=lambda k: int(place[k])), int)


def _descend(judge: Judge, box: Box, best: Array, step: Array, exact: Array) -> Array:
    """Return the minima near some starts, shape (starts, 1), all at once: each moves to a neighbour
    that is better, at a distance `step`, or halves the distance where neither is.
    """
    steps, reached = np.broadcast_to(step, best.shape).copy(), judge(best)
    while np.any(steps > exact):
        stays = np.full(len(best), True)
        for side in (-1, 1):
            points = box.bring_inside(best + side * steps)
            merits = judge(points)
            better = ~reached.is_at_most(merits)
            best = np.where(better[:, None], points, best)
            reached = Merit(*np.where(better, merits, reached))
            stays &= ~better
        steps[stays] /= 2
    return best


def _adapt(judge: Judge, box: Box, mean: Array, step: float, effort: Effort) -> Array:
    """Return an optimum for each start (starts, numbers) by evolution strategies that run side by
    side: each draws candidates, moves to the mean of the better half, and adapts its step and its
    covariance. Lengths are shares of the box. Starts that do not converge return their best.
    """
    count, k = mean.shape
    drawn, most = 8 + 4 * k, 300 + 100 * k
    half = drawn // 4
    random = np.random.default_rng(0)
    size = np.full(count, step)
    covariance = np.tile(np.eye(k), (count, 1, 1))
    learned = 1 + k * (k + 1) / (2 * half)
    mean, best, reached = mean.copy(), mean.copy(), judge(mean)
    for _ in range(most):
        squares, axes = np.linalg.eigh(covariance)
        widths = np.sqrt(np.maximum(squares, 1e-28))
        live = np.flatnonzero(size * widths[:, -1] > effort.exact)
        if not len(live):
            break
        sizes = size[live, None] * np.exp(
            random.standard_normal((len(live), drawn)) / math.sqrt(2 * k)
        )
        z = random.standard_normal((len(live), drawn, k))
        moves = np.einsum("sij,slj->sli", axes[live], z * widths[live, None])
        points = box.bring_inside(mean[live, None] + sizes[..., None] * moves * box.span)
        merits = Merit(*(each.reshape(sizes.shape) for each in judge(points.reshape(-1, k))))
        rows, order = np.arange(len(live))[:, None], merits.rank()[:, :half]
        first = merits.take((rows[:, 0], order[:, 0]))
        better = ~reached.take(live).is_at_most(first)
        best[live[better]] = points[rows[:, 0], order[:, 0]][better]
        for whole, part in zip(reached, first, strict=True):
            whole[live[better]] = part[better]
        steps = box.subtract(points, mean[live, None])[rows, order]
        mean[live] = box.bring_inside(mean[live] + steps.mean(axis=1) * box.span)
        chosen = steps / sizes[rows, order][..., None]
        size[live] = sizes[rows, order].mean(axis=1)
        spread = np.einsum("sli,slj->sij", chosen, chosen) / half
        covariance[live] += (spread - covariance[live]) / learned
    return best


def _round_off(judge: Judge, box: Box, point: Array, slack: float) -> Array:
    """Return a point with each number as round as it can be and still as good but for the slack."""
    for n, span in enumerate(box.span):
        coarsest = -math.floor(math.log10(span))
        x = float(point[n])
        rounded = [round(x, coarsest + more) + 0.0 for more in range(_DIGITS)]
        turns = 360.0 * float(Fraction(x / 360.0).limit_denominator(1000))  # 360/7 is round, too
        near = [y for y in [*rounded[:7], turns, *rounded[7:]] if box.low[n] <= y <= box.high[n]]
        tried = np.tile(point, (len(near) + 1, 1))
        tried[1:, n] = near
        merits = judge(tried)
        enough = Merit(merits.excess[:1], merits.cost[:1] + slack)
        good = np.flatnonzero(merits.is_at_most(enough)[1:])
        if len(good):
            point = tried[1 + good[0]]
    return point

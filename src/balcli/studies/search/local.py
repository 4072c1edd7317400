"""Find local optima of a function of one or several numbers in a box: a range for each number.

Candidates are spread over the box: on a grid for one number, in a quasi-random sequence for
several. A local search starts from each candidate that is better than its neighbours. For one
number it halves its steps; for several it is the evolution strategy with covariance adaptation
(Hansen, The CMA Evolution Strategy: A Tutorial, arXiv:1604.00772). Both only compare candidates and
use no derivatives, because magnitudes of vectors have kinks where they vanish, limits have edges,
and some values are impossible.
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
from .designs import BROKEN

Judge = Callable[[Array], Array]  # function that returns the costs of points (points, numbers)
_DIGITS = 12  # largest number of decimals of rounded numbers
# Costs are equal if they differ by less than _LEVEL times a cost, or _ROUNDING times the largest.
_LEVEL = 1e-9
_ROUNDING = 1e-12


@dataclass(frozen=True)
class Box:
    """Ranges of some numbers, shape (numbers,) each. `ring` marks periodic numbers, for which
    `high` means the same as `low`.
    """

    low: Array
    high: Array
    ring: Array

    @property
    def size(self) -> int:
        """Number of dimensions of the box."""
        return len(self.low)

    @property
    def span(self) -> Array:
        """Widths of the ranges."""
        return np.where(self.high > self.low, self.high - self.low, 1.0)

    def bring_inside(self, points: Array) -> Array:
        """Return points (..., numbers) moved into the box: by whole periods for periodic numbers,
        otherwise to the nearest point of the box.
        """
        turned = self.high - np.remainder(self.high - points, self.span)
        return np.where(self.ring, turned, np.clip(points, self.low, self.high))

    def subtract(self, points: Array, others: Array) -> Array:
        """Return points - others as shares of the spans; periodic numbers take the shorter way."""
        share = (points - others) / self.span
        return np.where(self.ring, share - np.round(share), share)

    def spread(self, count: int) -> Array:
        """Return points spread over the box: a grid for one number, the R sequence for several."""
        if self.size == 1:
            grid = np.linspace(self.low, self.high, count + 1 if self.high > self.low else 1)
            return grid[1:] if self.ring[0] else grid
        base = 2.0
        for _ in range(50):  # converges to the root of x**(numbers + 1) = x + 1
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
        as_good: Relative increase of the cost that is allowed for a rounder number.
        same: Distance, as a share of the box, below which two optima are the same.
        steps: Number of points examined between two optima.
    """

    points: int
    starts: int
    exact: float
    as_good: float = 1e-13  # changes next to a smooth minimum are smaller
    same: float = 1e-5
    steps: int = 31

    def count_evaluations(self, numbers: int) -> int:
        """Return the approximate number of evaluated candidates."""
        halvings = -math.log2(self.exact)
        return round(self.points + self.starts * halvings * (2 if numbers == 1 else 30 * numbers))


class LocalOptima(NamedTuple):
    """Result of a search.

    Attributes:
        places: Local optima that satisfy all limits, best first, shape (optima, numbers), rounded
            as far as the costs allow.
        costs: Costs of the points that were spread over the box.
    """

    places: Array
    costs: Array


def find_local_optima(judge: Judge, box: Box, effort: Effort) -> LocalOptima:
    """Return the distinct local optima that at most `effort.starts` searches find in a box."""
    points = box.spread(effort.points)
    costs = judge(points)
    starts = points[_find_starts(points, costs, box)[: effort.starts]]
    step = effort.points ** (-1 / box.size)  # distance of neighbours, as a share of the box
    if box.size == 1:
        ends = _descend(judge, box, starts, step * box.span, effort.exact * box.span)
    else:
        ends = _adapt(judge, box, starts, 0.5 * step, effort)
    rounded = [
        _round_off(judge, box, point, cost + effort.as_good * abs(cost))
        for point, cost in zip(ends, judge(ends), strict=True)
        if cost < BROKEN
    ]
    noise = _ROUNDING * np.abs(costs[costs < BROKEN]).max(initial=0)
    best = _separate(judge, box, rounded, effort, noise)
    order = np.argsort(ranked(judge(best)), kind="stable")
    return LocalOptima(best[order], costs)


def _separate(judge: Judge, box: Box, optima: list[Array], effort: Effort, noise: float) -> Array:
    """Return the optima that are separated from all better ones by higher costs.

    A search may stop on a line, such as the edge of a limit, of which another point is better. If
    costs do not rise on the way from one optimum to a better one, the worse optimum is dropped and
    the better one is replaced by the best point of the line through both.
    """
    best: list[Array] = []
    points = np.reshape(optima, (-1, box.size))
    for point in points[np.argsort(ranked(judge(points)), kind="stable")]:
        for n, other in enumerate(best):
            way = box.subtract(point, other)
            if np.abs(way).max() <= effort.same:
                break
            line = other + np.linspace(0, 1, effort.steps + 2)[:, None] * way * box.span
            along = judge(box.bring_inside(line))
            level = along[-1] + _LEVEL * abs(along[-1]) + noise
            if along.max() <= level:
                if along[0] < 2 * along[-1] - level:
                    best[n] = _slide(judge, box, other, way, effort)
                break
        else:
            best.append(point)
    return np.reshape(best, (-1, box.size))


def _slide(judge: Judge, box: Box, point: Array, way: Array, effort: Effort) -> Array:
    """Return the best point on the line through a point; the direction is in shares of the box."""
    farthest = 1 / np.abs(way).max(keepdims=True)
    line = Box(-farthest, farthest, np.array([False]))

    def find(along: Array) -> Array:
        return box.bring_inside(point + along * way * box.span)

    finer = Effort(effort.steps, 2, effort.exact)
    places = find_local_optima(lambda along: judge(find(along)), line, finer).places
    both = np.vstack([*map(find, places[:1]), point])
    return np.asarray(both[judge(both).argmin()])


def _find_starts(points: Array, costs: Array, box: Box) -> list[int]:
    """Return the indices of the points that are better than their neighbours, best first. Of
    equally good points, the first counts as better.
    """
    order = np.argsort(ranked(costs), kind="stable")
    place = np.argsort(order)
    starts = []
    for k in order[np.isfinite(costs[order])]:
        distance = (box.subtract(points, points[k]) ** 2).sum(axis=1)
        distance[k] = np.inf
        near = np.argsort(distance, kind="stable")[: 2 * box.size]
        if not any(place[near] < place[k]):
            starts.append(int(k))
    return starts


def _descend(judge: Judge, box: Box, best: Array, step: Array, exact: Array) -> Array:
    """Return the minimum near each start, shape (starts, 1). At each step every point moves to the
    better one of its two neighbours at the distance `step`, or halves this distance if neither is
    better than the point.
    """
    steps = np.broadcast_to(step, best.shape).copy()
    reached = judge(best)
    while np.any(steps > exact):
        both = box.bring_inside(np.concatenate([best - steps, best + steps]))
        costs_of_both = judge(both).reshape(2, -1)
        upper = costs_of_both[1] < costs_of_both[0]
        costs = costs_of_both.min(axis=0)
        below, above = np.split(both, 2)
        points = np.where(upper[:, None], above, below)
        better = costs < reached
        best = np.where(better[:, None], points, best)
        reached = np.where(better, costs, reached)
        steps[~better] /= 2
    return best


def _adapt(judge: Judge, box: Box, mean: Array, step: float, effort: Effort) -> Array:
    """Return an optimum for each start (starts, numbers) by evolution strategies that run in
    parallel. Each draws candidates, moves to the mean of the best ones, and adapts its step and
    covariance. Lengths are shares of the box. If a strategy does not converge, its best point is
    returned.
    """
    count, k = mean.shape
    drawn = 8 + 4 * k
    most = 300 + 100 * k
    half = drawn // 4
    random = np.random.default_rng(0)
    size = np.full(count, step)
    covariance = np.tile(np.eye(k), (count, 1, 1))
    learned = 1 + k * (k + 1) / (2 * half)
    reached = judge(mean)
    best = mean.copy()
    mean = mean.copy()
    for _ in range(most):
        squares, axes = np.linalg.eigh(covariance)
        widths = np.sqrt(np.maximum(squares, 1e-28))
        live = np.flatnonzero(size * widths[:, -1] > effort.exact)
        if not len(live):
            break
        changes = random.standard_normal((len(live), drawn)) / math.sqrt(2 * k)
        sizes = size[live, None] * np.exp(changes)
        z = random.standard_normal((len(live), drawn, k))
        moves = np.einsum("sij,slj->sli", axes[live], z * widths[live, None])
        points = box.bring_inside(mean[live, None] + sizes[..., None] * moves * box.span)
        costs = judge(points.reshape(-1, k)).reshape(sizes.shape)
        rows = np.arange(len(live))[:, None]
        order = np.argsort(costs, axis=1)[:, :half]
        first = costs.min(axis=1)
        better = first < reached[live]
        best[live[better]] = points[rows[:, 0], order[:, 0]][better]
        reached[live[better]] = first[better]
        steps = box.subtract(points, mean[live, None])[rows, order]
        mean[live] = box.bring_inside(mean[live] + steps.mean(axis=1) * box.span)
        chosen = steps / sizes[rows, order][..., None]
        size[live] = sizes[rows, order].mean(axis=1)
        spread = np.einsum("sli,slj->sij", chosen, chosen) / half
        covariance[live] += (spread - covariance[live]) / learned
    return best


def _round_off(judge: Judge, box: Box, point: Array, enough: float) -> Array:
    """Return a point with each number rounded as far as its cost stays at or below `enough`."""
    for n, span in enumerate(box.span):
        coarsest = -math.floor(math.log10(span))
        x = float(point[n])
        rounded = [round(x, coarsest + more) + 0.0 for more in range(_DIGITS)]
        turns = 360.0 * float(Fraction(x / 360.0).limit_denominator(1000))  # 360/7 counts as round
        near = [y for y in [*rounded[:7], turns, *rounded[7:]] if box.low[n] <= y <= box.high[n]]
        tried = np.tile(point, (len(near), 1))
        tried[:, n] = near
        good = np.flatnonzero(judge(tried) <= enough)
        if len(good):
            point = tried[good[0]]
    return point

"""Judge the stress and torque of shafts by limits that may depend on the speed: the largest share
of each limit, and the ranges of speed in which the limit is exceeded.

A limit is smooth between its corners, such as the speeds of a table. Corners are examined like
resonances, so that no peak of the share is missed.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.peaks import find_highest, find_peaks_between
from ..core.vibration import Indices, Real
from .columns import Columns
from .permitted import ShaftLimit
from .response import add_resonances
from .system import TorsionalSystem

_FINE = 0.003  # relative step with which a range of speeds is searched
_CLOSE = 0.9  # a peak above this share of a limit may exceed the limit between the steps
_HALVINGS = 24  # number of bisections of an interval of speeds in which a limit is passed


class ExceededRange(NamedTuple):
    """A range of speeds in which a limit is exceeded.

    Attributes:
        from_rpm: First speed.
        to_rpm: Last speed.
        open: Side on which the range ends only because the speeds end; None: it ends by itself.
        peak_rpm: Speed of the largest share.
        share: Largest share of the limit.
    """

    from_rpm: float
    to_rpm: float
    open: Literal["below", "above", "both"] | None
    peak_rpm: float
    share: float


class JudgedLimit(NamedTuple):
    """Largest share of a limit over the range of speeds, its speed, and the exceeded ranges."""

    share: float
    speed_rpm: float
    exceeded: tuple[ExceededRange, ...]


class LargestShare(NamedTuple):
    """A limit, and its largest share over the range of speeds with its speed."""

    limit: ShaftLimit
    share: float
    speed_rpm: float


class _Shares:
    """Shares of limits as functions of the speed.

    Args:
        system: System with an excitation.
        limits: Limits.
    """

    def __init__(self, system: TorsionalSystem, limits: Sequence[ShaftLimit]) -> None:
        self.system = system
        self.limits = limits
        self.columns = np.array([limit.column for limit in limits])
        self.swings = Columns([system])

    def find_factors(self, rpm: Real) -> Real:
        """Return the share of each limit for a curve of 1 N m or 1 rad, shape (speeds, limits)."""
        factors = [limit.by_torque / limit.limit.at(rpm) for limit in self.limits]
        return np.stack(factors, axis=-1)

    def bound(self, rpm: Real) -> Real:
        """Return upper bounds of the shares at speeds (speeds,), shape (speeds, limits)."""
        return self.swings.bound(rpm, self.columns) * self.find_factors(rpm)

    def judge(self, at: Real, which: Indices) -> Real:
        """Return the shares at speeds `at`, each of the limit with the index in `which`."""
        rpm, limit = (each.ravel() for each in np.broadcast_arrays(at, which))
        factors = self.find_factors(rpm)[np.arange(len(rpm)), limit]
        swings = self.swings.find(rpm, self.columns[limit])
        return np.asarray((swings * factors).reshape(np.shape(at)))

    def refine(self, heights: Real, rpm: Real, where: NDArray[np.bool_]) -> None:
        """Replace bounds by the shares themselves where a mask says so."""
        near = np.nonzero(where)
        heights[near] = self.judge(rpm[near[0]], near[1])


def judge_limits(
    system: TorsionalSystem, rpm: Real, limits: Sequence[ShaftLimit]
) -> tuple[JudgedLimit, ...]:
    """Return how much of each limit is used between the first and last speed.

    The examined speeds depend only on the ends of the range: fine steps, corners of limits,
    resonances, the tops of peaks just below a limit and the bottoms of valleys just above it. The
    ends of an exceeded range are found by bisection.

    Args:
        system: System with an excitation.
        rpm: Rising speeds, shape (speeds,).
        limits: Limits.
    """
    shares = _Shares(system, limits)
    speeds = _add_turns(shares, _choose_speeds(system, rpm, limits))
    heights = shares.bound(speeds)
    columns = np.arange(len(limits))
    level = shares.judge(speeds[heights.argmax(axis=0)], columns)
    least = _CLOSE * np.minimum(level, 1)
    shares.refine(heights, speeds, heights >= least)
    level = heights.max(axis=0)
    best, highest = find_highest(shares.judge, speeds, heights, level, _CLOSE)
    judged = []
    for k in columns.tolist():
        exceeded = tuple(_find_exceeded(shares, speeds, heights[:, k], k))
        judged.append(JudgedLimit(float(highest[k]), float(best[k]), exceeded))
    return tuple(judged)


def find_largest_share(
    system: TorsionalSystem, rpm: Real, limits: Sequence[ShaftLimit]
) -> LargestShare:
    """Return the largest share of any limit between the first and last speed; it is the largest one
    of `judge_limits`, which also looks for the largest share of every other limit.

    Args:
        system: System with an excitation.
        rpm: Rising speeds, shape (speeds,).
        limits: Limits, at least one.
    """
    shares = _Shares(system, limits)
    speeds = _choose_speeds(system, rpm, limits)
    heights = shares.bound(speeds)
    columns = np.arange(len(limits))
    level = shares.judge(speeds[heights.argmax(axis=0)], columns).max()
    shares.refine(heights, speeds, heights >= _CLOSE * level)
    levels = np.full(len(limits), heights.max())
    best, highest = find_highest(shares.judge, speeds, heights, levels, _CLOSE)
    k = int(highest.argmax())
    return LargestShare(limits[k], float(highest[k]), float(best[k]))


def _choose_speeds(system: TorsionalSystem, rpm: Real, limits: Sequence[ShaftLimit]) -> Real:
    """Return the speeds at which a range is examined first: fine steps, resonances and corners."""
    if len(rpm) == 1:
        return rpm
    steps = max(math.ceil(math.log(rpm[-1] / rpm[0]) / _FINE), 1)
    speeds = add_resonances(system, np.geomspace(rpm[0], rpm[-1], steps + 1))
    speeds[0] = rpm[0]
    speeds[-1] = rpm[-1]
    corners = np.concatenate([np.asarray(limit.limit.corners, float) for limit in limits])
    inside = corners[(corners > rpm[0]) & (corners < rpm[-1])]
    return np.unique(np.append(speeds, inside))


def _add_turns(shares: _Shares, speeds: Real) -> Real:
    """Return the speeds with the tops of peaks just below a limit and the bottoms of valleys just
    above it, which may pass the limit between two of the speeds.
    """
    heights = shares.bound(speeds)
    shares.refine(heights, speeds, heights > _CLOSE)
    inner = heights[1:-1]
    sign = np.where(inner <= 1, 1, -1)  # peaks below the limit, valleys above it
    beside = np.stack([heights[:-2], heights[2:]])
    turns = np.all(sign * (inner - beside) >= 0, axis=0)
    place, limit = np.nonzero(turns & (inner > _CLOSE) & (inner < 1 / _CLOSE))
    if not len(place):
        return speeds
    signs = sign[place, limit]

    def judge(at: Real, which: Indices) -> Real:
        """Return the shares, with the valleys turned into peaks."""
        return shares.judge(at, limit[which]) * signs[which]

    between = np.stack([speeds[place], speeds[place + 2]])
    ends = np.stack([heights[place, limit], heights[place + 2, limit]]) * signs
    tops, _ = find_peaks_between(judge, between, ends, np.arange(len(place)))
    return np.unique(np.append(speeds, tops))


def _find_exceeded(
    shares: _Shares, speeds: Real, heights: Real, limit: int
) -> tuple[ExceededRange, ...]:
    """Return the ranges in which one limit is exceeded.

    Args:
        shares: Shares of all limits.
        speeds: Rising speeds, shape (speeds,).
        heights: Shares of the limit at these speeds (upper bounds where they are below 0.9).
        limit: Index of the limit.
    """
    above = heights > 1
    changes = np.flatnonzero(above[1:] != above[:-1])
    upward = above[changes + 1]
    ends = _bisect(shares, limit, speeds[changes], speeds[changes + 1], upward)
    starts = [*speeds[:1][above[:1]].tolist(), *ends[upward].tolist()]
    stops = [*ends[~upward].tolist(), *speeds[-1:][above[-1:]].tolist()]
    ranges = []
    for start, stop in zip(starts, stops, strict=True):
        within = (speeds >= start) & (speeds <= stop)
        places = np.unique(np.concatenate([[start], speeds[within], [stop]]))
        only = np.array([limit])

        def judge(at: Real, which: Indices) -> Real:
            """Return the shares of this limit."""
            return shares.judge(at, np.full(np.shape(which), limit))

        inside = shares.judge(places[:, None], only)
        peak, share = find_highest(judge, places, inside, inside.max(axis=0), _CLOSE)
        below = above[0] and start == speeds[0]
        beyond = above[-1] and stop == speeds[-1]
        side = _name_open(bool(below), bool(beyond))
        ranges.append(ExceededRange(start, stop, side, float(peak[0]), float(share[0])))
    return tuple(ranges)


def _bisect(shares: _Shares, limit: int, low: Real, high: Real, upward: NDArray[np.bool_]) -> Real:
    """Return the speeds at which a limit is passed, one in each interval."""
    for _ in range(_HALVINGS if len(low) else 0):
        middle = (low + high) / 2
        same = (shares.judge(middle, np.full(len(middle), limit)) > 1) == upward
        low = np.where(same, low, middle)
        high = np.where(same, middle, high)
    return (low + high) / 2


def _name_open(below: bool, above: bool) -> Literal["below", "above", "both"] | None:
    """Return the sides on which a range ends only because the speeds end."""
    if below and above:
        return "both"
    if below:
        return "below"
    return "above" if above else None

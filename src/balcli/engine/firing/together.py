"""Cylinders that fire together.

A two-stroke fires every cylinder in every revolution. So cylinders that reach their dead centres
together fire together: the interval is 0. In a flat two-stroke with one rod on each throw, a firing
order alone may mean even firing or pairs that fire together, and the throws depend on it. A
four-stroke is never assumed to fire together; if its firing order does not fit its crank, intervals
of 0 are proposed.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import combinations, islice, pairwise

from ...core.phases import TURN
from ...file.fields import join_words
from ..layout import TOLERANCE_DEG, cycle_deg
from ..parts import Parts
from .common_pins import Intervals

MOST_WAYS_TRIED = 1000  # ways to let some of the coincident dead centres fire a turn apart


def is_flat_two_stroke(parts: Parts) -> bool:
    """Return whether the engine is a flat two-stroke with one rod on each throw and an even number
    of cylinders, whose file gives neither throws nor firing intervals.
    """
    layout = parts.model.layout
    order = parts.order
    if layout.strokes != 2 or order is None or layout.firing_intervals is not None:
        return False
    one_rod_each = parts.plan.rods_on_throw == 1 and not parts.throws_given
    return one_rod_each and len(order) % 2 == 0 and _is_flat(parts)


def _is_flat(parts: Parts) -> bool:
    """Return whether the cylinders point in two opposite directions."""
    axes = [float(axis) for axis in parts.pins.axes_deg.values()]
    from_first = [abs((axis - axes[0] + 180) % TURN - 180) for axis in axes]
    here = [angle <= TOLERANCE_DEG for angle in from_first]
    opposite = [angle >= 180 - TOLERANCE_DEG for angle in from_first]
    return any(opposite) and sum(here) + sum(opposite) == len(axes)


def list_flat_intervals(cylinders: int) -> list[Intervals]:
    """Return the usual firing intervals of a flat two-stroke, deg: even ones, and pairs that fire
    together, begun with the first cylinder of a pair or with the second.

    Args:
        cylinders: Even number of cylinders.
    """
    even = TURN / cylinders
    pairs = cylinders // 2
    return [(even,) * cylinders, (0.0, 2 * even) * pairs, (2 * even, 0.0) * pairs]


def list_intervals_of_crank(parts: Parts) -> list[Intervals]:
    """Return the firing intervals with which a four-stroke fits its crank if some cylinders fire
    together, deg. Dead centres at one crank angle are 0 or 360 deg apart. Intervals that begin with
    0 come first; then those with the fewest cylinders one after the other that fire together.

    Args:
        parts: Stages of an engine; its file gives throws and a firing order.
    """
    order = parts.order or ()
    ready = []
    for number in (*order, *order[:1]):
        behind = parts.true_tops_deg[number] - parts.pins.leads_deg[number]
        ready.append(parts.sense * float(behind))
    intervals = [(after - before) % TURN for before, after in pairwise(ready)]
    coincident = [k for k, angle in enumerate(intervals) if _is_whole_turn(angle)]
    for k in coincident:
        intervals[k] = 0.0
    turns = round((cycle_deg(parts.model.layout) - sum(intervals)) / TURN)
    if not 0 <= turns < len(coincident):
        return []
    ways = islice(combinations(reversed(coincident), turns), MOST_WAYS_TRIED)
    fitting = [_set_turns(intervals, apart) for apart in ways]
    return sorted(fitting, key=_rank_intervals)


def _rank_intervals(intervals: Intervals) -> tuple[bool, int]:
    """Return a key: intervals that begin with 0 come first; then those with the shortest run of
    cylinders that fire together.
    """
    return (intervals[0] > 0, _count_most_together(intervals))


def _is_whole_turn(angle: float) -> bool:
    return abs((angle + 180) % TURN - 180) <= TOLERANCE_DEG


def _set_turns(intervals: Sequence[float], apart: Sequence[int]) -> Intervals:
    """Return the intervals with a whole turn at some places."""
    return tuple(float(TURN) if k in apart else angle for k, angle in enumerate(intervals))


def _count_most_together(intervals: Intervals) -> int:
    """Return the largest number of intervals of 0 one after the other."""
    most = count = 0
    for interval in (*intervals, *intervals):
        count = count + 1 if interval == 0 else 0
        most = max(most, count)
    return most


def list_together(parts: Parts) -> list[list[int]]:
    """Return the numbers of the cylinders that fire together, a list for each group of them."""
    groups: list[tuple[float, list[int]]] = []
    cycle = cycle_deg(parts.model.layout)
    for number, fires in parts.fires_deg.items():
        for angle, group in groups:
            if abs((float(fires) - angle + cycle / 2) % cycle - cycle / 2) <= TOLERANCE_DEG:
                group.append(number)
                break
        else:
            groups.append((float(fires), [number]))
    return [group for _, group in groups if len(group) > 1]


def describe_together(groups: Iterable[Sequence[int]]) -> str:
    """Return which cylinders fire together in words: "cylinders 1 and 2 fire together"."""
    return ", ".join(f"cylinders {join_words(group)} fire together" for group in groups)

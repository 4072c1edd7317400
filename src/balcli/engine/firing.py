"""Firing order <-> crank throws (docs/theory.md).

Cylinder i is at top dead centre when its crank angle is `tau_i`, `sin tau_i = e_i / (r + l_i)`;
firing at `f_i` after cylinder 1 it needs its crank pin at `g_i - g_1 + tau_i - tau_1 - f_i`. Angles
in degrees; they may be arrays of variants. By number of the cylinder: `fires` when each fires,
`pins` where its crank pin stands, `tops` where the pin stands when it is at top dead centre, `g_i +
tau_i`. `sense` is -1 where the cylinders turn and the pins stand still, and `tops` then `g_i -
tau_i`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import accumulate

import numpy as np

from ..core.phasors import Array, Figure
from ..errors import InputError, Problem

# deg; real files round offsets, angles and intervals, real mistakes are tens of degrees
TOLERANCE_DEG = 1.0


def find_instants(
    order: Sequence[int], intervals: Sequence[Figure] | None, cycle: float
) -> dict[int, Figure]:
    """Angle at which each cylinder of a firing order fires, after the first; evenly over the cycle
    if no intervals (from each firing to the next) are given.
    """
    if intervals is None:
        return {number: cycle * k / len(order) for k, number in enumerate(order)}
    return dict(zip(order, accumulate(intervals, initial=0.0), strict=False))


def find_pins(
    fires: Mapping[int, Figure], tops: Mapping[int, Figure], sense: int
) -> dict[int, Array]:
    """Crank pin that each cylinder needs, after cylinder 1's, in [0, 360)."""
    return {
        i: np.remainder((tops[i] - tops[1]) - sense * (f - fires[1]), 360.0)
        for i, f in fires.items()
    }


def find_intervals(order: Sequence[int], ready: Mapping[int, float], cycle: float) -> list[float]:
    """Intervals of a firing order on a given crank: from each firing to the next, the shortest that
    the dead centres (`find_dead_centres`) allow.

    Turns that are left over (an even parallel twin fires after 360 and 360 degrees, its pins only
    say 0) go to the intervals that become the least uneven by them, of equal ones to the last.

    Raises:
        InputError: the order takes more than a cycle.
    """
    following = [*order[1:], order[0]]
    intervals = [_to_whole_turn(ready[b] - ready[a]) for a, b in zip(order, following, strict=True)]
    total = round(sum(intervals) / 360) * 360
    if total > cycle:
        raise InputError([_impossible(order, ready, total, cycle)])
    for _ in range(int(cycle - total) // 360):
        shortest = min(reversed(range(len(intervals))), key=lambda k: round(intervals[k], 6))
        intervals[shortest] += 360.0
    return intervals


def find_dead_centres(
    pins: Mapping[int, float], tops: Mapping[int, float], sense: int = 1
) -> dict[int, float]:
    """Where the crank stands when each cylinder is at top dead centre, in [0, 360) after cylinder
    1, whose pin the others are counted from.
    """
    return {
        i: float(np.remainder(sense * ((tops[i] - tops[1]) - pin), 360.0))
        for i, pin in pins.items()
    }


def check_firing(
    fires: Mapping[int, Figure],
    pins: Mapping[int, Figure],
    tops: Mapping[int, Figure],
    sense: int = 1,
) -> Iterator[Problem]:
    """Find the first cylinder that is not at top dead centre when it fires; pins are counted from
    cylinder 1's.
    """
    for i, wanted in find_pins(fires, tops, sense).items():
        off = float(np.max(np.abs(_centred(pins[i] - wanted))))
        if off > TOLERANCE_DEG:
            yield Problem(
                "layout.firing_order",
                f"cylinder {i} is not at top dead centre when it fires: its crank pin stands "
                f"{float(np.ravel(pins[i])[0]) % 360:.6g} deg ahead of cylinder 1's, and would "
                f"have to stand at {float(np.ravel(wanted)[0]):.6g} deg (allowed difference "
                f"{TOLERANCE_DEG:g} deg); change crank.throws, crank.splay, firing_order or "
                "firing_intervals",
            )
            return


def _impossible(
    order: Sequence[int], ready: Mapping[int, float], total: float, cycle: float
) -> Problem:
    """A firing order that takes longer than a cycle, and the first cylinder that would be late if
    it fired evenly.
    """
    interval = cycle / len(order)
    off = np.array([ready[i] - ready[order[0]] - k * interval for k, i in enumerate(order)])
    late = np.flatnonzero(np.abs(_centred(off)) > TOLERANCE_DEG)
    culprit = order[late[0] if len(late) else -1]
    return Problem(
        "layout.firing_order",
        f"{'-'.join(map(str, order))} would take {total:g} deg with these crank.throws, a cycle "
        f"has {cycle:g}; firing evenly, every {interval:g} deg, cylinder {culprit} is the first "
        f"that is not at top dead centre when it fires (allowed difference {TOLERANCE_DEG:g} deg): "
        "change firing_order or crank.throws, or leave crank.throws out",
    )


def _to_whole_turn(angle: float) -> float:
    """The same angle in (0, 360]; what is within the tolerance of 0 is a whole turn."""
    turned = angle % 360
    return turned if turned > TOLERANCE_DEG else turned + 360


def _centred(angle: Figure) -> Figure:
    """The same angle in [-180, 180)."""
    return np.remainder(angle + 180.0, 360.0) - 180.0

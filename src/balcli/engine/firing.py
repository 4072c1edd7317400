"""Firing order <-> crank throws (docs/theory.md).

Cylinder i is at top dead centre when its crank angle is `tau_i`, `sin tau_i = e_i / (r + l_i)`;
firing at `f_i` after cylinder 1 it needs its crank pin at `g_i - g_1 + tau_i - tau_1 - f_i`. Angles
in degrees; they may be arrays of variants.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import accumulate
from typing import Any

import numpy as np

from ..errors import Problem

TOLERANCE = (
    1.0  # deg; real files round offsets, angles and intervals, real mistakes are tens of degrees
)


def instants(order: Sequence[int], intervals: Sequence[Any] | None, cycle: float) -> dict[int, Any]:
    """Angle at which each cylinder fires, after the first of the order; evenly if no intervals are
    given.
    """
    angles = (
        accumulate(intervals, initial=0.0)
        if intervals
        else (cycle * k / len(order) for k in range(len(order)))
    )
    return dict(zip(order, angles, strict=False))


def pins(fires: Mapping[int, Any], top: Mapping[int, Any], sense: int = 1) -> dict[int, Any]:
    """Crank pin that each cylinder needs, after cylinder 1's; `top` is `g_i + tau_i` by cylinder.

    `sense` is -1 where the cylinders turn and the pins stand still, and `top` then `g_i - tau_i`.
    """
    return {
        i: np.remainder((top[i] - top[1]) - sense * (f - fires[1]), 360.0) for i, f in fires.items()
    }


def from_pins(
    order: Sequence[int],
    pin: Mapping[int, Any],
    top: Mapping[int, Any],
    cycle: float,
    sense: int = 1,
) -> list[float] | Problem:
    """Intervals of a firing order on a given crank: from each firing to the next, the shortest that
    the pins allow.

    Turns that are left over (an even parallel twin fires after 360 and 360 degrees, its pins only
    say 0) go to the intervals that become the least uneven by them, of equal ones to the last. A
    Problem if the order takes more than a cycle.
    """
    ready = {
        i: float(np.remainder(sense * ((top[i] - top[1]) - pin[i]), 360.0)) for i in order
    }  # at top dead centre, modulo a turn
    following = [*order[1:], order[0]]
    intervals = [_positive(ready[b] - ready[a]) for a, b in zip(order, following, strict=True)]
    total = round(sum(intervals) / 360) * 360
    if total > cycle:
        return _impossible(order, ready, total, cycle)
    for _ in range(int(cycle - total) // 360):
        shortest = min(reversed(range(len(intervals))), key=intervals.__getitem__)
        intervals[shortest] += 360.0
    return intervals


def disagreement(
    fires: Mapping[int, Any],
    pin: Mapping[int, Any],
    top: Mapping[int, Any],
    sense: int = 1,
    *,
    throws_given: bool = True,
) -> Problem | None:
    """The first cylinder that is not at top dead centre when it fires; pins are counted from
    cylinder 1's.

    Without `throws_given` the pins follow from the firing order, and two rods on one throw ask for
    different ones.
    """
    wanted = pins(fires, top, sense)
    remedy = (
        "change crank.throws, crank.splay, firing_order or firing_intervals, or leave "
        "crank.throws out"
        if throws_given
        else "change crank.splay, firing_order or firing_intervals, or give crank.throws and no "
        "firing_order"
    )
    for i in fires:
        off = float(np.max(np.abs(_centred(pin[i] - wanted[i]))))
        if off > TOLERANCE:
            return Problem(
                "layout.firing_order",
                f"cylinder {i} is not at top dead centre when it fires: its crank pin stands "
                f"{float(np.ravel(pin[i])[0]) % 360:.6g} deg ahead of cylinder 1's, and would "
                "have to stand at "
                f"{float(np.ravel(wanted[i])[0]):.6g} deg (allowed difference {TOLERANCE:g} deg); "
                f"{remedy}",
            )
    return None


def _impossible(
    order: Sequence[int], ready: Mapping[int, float], total: float, cycle: float
) -> Problem:
    interval = cycle / len(order)
    culprit = next(
        (
            i
            for k, i in enumerate(order)
            if abs(_centred(ready[i] - ready[order[0]] - k * interval)) > TOLERANCE
        ),
        order[-1],
    )
    return Problem(
        "layout.firing_order",
        f"{'-'.join(map(str, order))} would take {total:g} deg with these throws, a cycle has "
        f"{cycle:g}; "
        f"firing evenly, every {interval:g} deg, cylinder {culprit} is the first that is not at "
        "top dead centre when it fires "
        f"(allowed difference {TOLERANCE:g} deg): change firing_order or crank.throws, or leave "
        "crank.throws out",
    )


def _positive(angle: float) -> float:
    """The same angle in (0, 360]; what is within the tolerance of 0 is a whole turn."""
    turned = angle % 360
    return turned if turned > TOLERANCE else turned + 360


def _centred(angle: Any) -> Any:
    """The same angle in [-180, 180)."""
    return np.remainder(angle + 180.0, 360.0) - 180.0

"""Firing orders that a crank allows, and yet nobody means."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from ..enginefile.model import EngineFile
from .assembly import Assembly
from .firing import TOLERANCE_DEG, find_even_order, find_instants
from .layout import cycle_deg


def doubt_firing_order(model: EngineFile) -> Iterator[str]:
    """A warning where the cylinders of a file fire unevenly, and in another order would fire evenly
    on the same crank; none where the file gives the intervals.

    An odd number of cylinders in four strokes has all dead centres in one turn, so that an order
    along them, with a long wait behind, takes no more than a cycle.
    """
    parts, layout = Assembly(model), model.layout
    if parts.order is None or layout.firing_intervals or model.crank.throws is None:
        return
    cycle, fires = cycle_deg(layout), parts.fires_deg
    even = find_instants(parts.order, None, cycle)
    if all(abs(fires[number] - at) <= TOLERANCE_DEG for number, at in even.items()):
        return
    turn = find_even_order(parts.order[0], parts.dead_centres_deg, cycle)
    if turn is None:
        return
    gaps = ", ".join(f"{b - a:.6g}" for a, b in pairwise([*fires.values(), cycle]))
    throws = " (or crank.throws, which count in the sense of rotation)"
    yield (
        f"layout.firing_order: {'-'.join(map(str, parts.order))} fires after {gaps} deg with these "
        f"throws, and {'-'.join(map(str, turn))} would evenly, every {cycle / len(turn):.4g} deg; "
        f"change it{throws if len(model.crank.throws) > 1 else ''}, or say "
        f"layout.firing_intervals = [{gaps}] if it is so"
    )

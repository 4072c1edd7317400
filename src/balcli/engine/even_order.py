"""Firing orders that a crank allows, and yet nobody means."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import pairwise

from ..core.phasors import Figure
from ..enginefile.model import EngineFile
from ..limits import MOST_TURNED
from .assembly import Assembly
from .firing import (
    TOLERANCE_DEG,
    find_even_order,
    find_instants,
    find_intervals,
    find_steadiest_order,
)
from .layout import cycle_deg
from .split_pins import find_fitting_splay


def doubt_firing_order(model: EngineFile) -> Iterator[str]:
    """A warning where the cylinders of a file fire unevenly, and in another order would fire evenly
    on the same crank, or where all fire in one revolution of two and need not, or where pins split
    the other way would fire evenly; none where the file gives the intervals.

    Where all dead centres are in one turn and apart, as of an odd number of cylinders or of a vee
    on common pins, an order along them, with a long wait behind, takes no more than a cycle.
    """
    parts, layout = Assembly(model), model.layout
    if parts.order is None or layout.firing_intervals or model.crank.throws is None:
        return
    cycle, fires = cycle_deg(layout), parts.fires_deg
    even = find_instants(parts.order, None, cycle)
    if all(abs(fires[number] - at) <= TOLERANCE_DEG for number, at in even.items()):
        return
    gaps, ready = _list_gaps(fires, cycle), parts.dead_centres_deg
    turn = find_even_order(parts.order[0], ready, cycle)
    if turn is not None:
        better = f"evenly, every {cycle / len(turn):.4g} deg"
    elif 2 < len(gaps) <= MOST_TURNED and max(gaps) > 360 + TOLERANCE_DEG:
        turn = find_steadiest_order(parts.order[0], ready)
        other = find_instants(turn, find_intervals(turn, ready, cycle), cycle)
        better = f"after {_write(_list_gaps(other, cycle))}"
    else:
        yield from _doubt_splay(model, gaps)
        return
    throws = " (or crank.throws, which count in the sense of rotation)"
    yield (
        f"layout.firing_order: {'-'.join(map(str, parts.order))} fires after {_write(gaps)} deg "
        f"with these throws, and {'-'.join(map(str, turn))} would {better}; "
        f"change it{throws if len(model.crank.throws) > 1 else ''}, or say "
        f"layout.firing_intervals = [{_write(gaps)}] if it is so"
    )


def _doubt_splay(model: EngineFile, gaps: list[float]) -> Iterator[str]:
    """A warning where pins are split by as much as they would have to be for even firing, the other
    way. A twin's one pin may be split so on purpose: to balance its first order.
    """
    even = find_fitting_splay(model) if len(model.crank.throws or ()) > 1 else None
    if even and abs(even + model.crank.splay) <= TOLERANCE_DEG:
        yield (
            f"crank.splay is {model.crank.splay:g}, with which the cylinders fire after "
            f"{_write(gaps)} deg, and with {even:g} they would evenly; change it, or say "
            f"layout.firing_intervals = [{_write(gaps)}] if it is so"
        )


def _list_gaps(fires: Mapping[int, Figure], cycle: float) -> list[float]:
    """From each firing to the next, deg."""
    return [float(b - a) for a, b in pairwise([*fires.values(), cycle])]


def _write(gaps: list[float]) -> str:
    return ", ".join(f"{gap:.6g}" for gap in gaps)

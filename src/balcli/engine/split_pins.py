"""Crank pins split by one angle between the rods of each throw, so that cylinders fire in turn."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import groupby

from ..core.phasors import Figure
from ..enginefile.model import EngineFile
from .assembly import Assembly
from .firing import check_firing, find_instants, find_pins, find_splay
from .layout import Plan, cycle_deg


def find_fitting_splay(model: EngineFile) -> float | None:
    """`crank.splay` (deg) with which the cylinders of a file fire in its order and at its
    intervals, evenly where it gives none; None where there is none, or no firing order.
    """
    parts = Assembly(model)
    if parts.order is None or parts.plan.rods_on_throw == 1:
        return None
    cycle = cycle_deg(model.layout)
    fires = find_instants(parts.order, model.layout.firing_intervals, cycle)
    wanted = find_pins(fires, parts.tops_deg, parts.sense)
    splay = find_splay(_list_by_throw(wanted, parts.plan))
    if splay is None:
        return None
    split = Assembly(model.with_table("crank", splay=splay))
    missed = any(check_firing(fires, split.leads_deg, split.tops_deg, split.sense))
    return None if missed else splay


def _list_by_throw(pins: Mapping[int, Figure], plan: Plan) -> list[list[Figure]]:
    """The pins of each throw, bank by bank, from those by cylinder."""
    cells = sorted(plan.cells, key=lambda cell: (cell.throw, cell.bank))
    return [
        [pins[cell.number] for cell in on_throw]
        for _, on_throw in groupby(cells, key=lambda cell: cell.throw)
    ]

"""Find out whether every cylinder is at its dead centre when it fires, and which splay of split
pins brings it there.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from ...errors import InputError, Problem
from ...file.model import EngineFile
from ..layout import check_firing, cycle_deg, find_instants, find_pins
from ..parts import Parts


def find_missed(parts: Parts) -> list[Problem]:
    """Return the mistake of the first cylinder that is not at its dead centre when it fires.
    With articulated rods, cylinders may fire at their true dead centres, or at their nominal ones:
    crank pin on the cylinder's axis.
    """
    if parts.order is None:
        return []
    try:
        fires = parts.fires_deg
    except InputError as error:
        return list(error.problems)
    dead_centres = [parts.true_tops_deg]
    if parts.model.articulation is not None:
        dead_centres.append(parts.pins.tops_deg)
    leads = parts.pins.leads_deg
    missed = [list(check_firing(fires, leads, tops, parts.sense)) for tops in dead_centres]
    return min(missed, key=len)


def find_fitting_splay(model: EngineFile) -> float | None:
    """Return the value of `crank.splay` (deg) with which the cylinders fire in the order and at the
    intervals of the file (evenly if the file gives no intervals). Return None if there is no such
    splay, no firing order, or if rods are articulated.
    """
    parts = Parts(model)
    if parts.order is None or parts.plan.rods_on_throw == 1 or model.articulation is not None:
        return None
    fires = find_instants(parts.order, model.layout.firing_intervals, cycle_deg(model.layout))
    wanted = find_pins(fires, parts.pins.tops_deg, parts.sense)
    first, second = (c.number for c in parts.plan.cells if c.throw == 0 and c.bank < 2)
    if not {first, second} <= fires.keys():
        return None
    lead = np.remainder(wanted[second] - wanted[first] + 180, 360) - 180
    splay = round(float(lead), 3) + 0.0
    split = Parts(model.with_table("crank", splay=splay))
    missed = any(check_firing(fires, split.pins.leads_deg, split.pins.tops_deg, split.sense))
    return None if missed else splay


def list_gaps(parts: Parts) -> list[float]:
    """Return the intervals from each firing to the next, deg, through one cycle."""
    times = [*map(float, parts.fires_deg.values()), cycle_deg(parts.model.layout)]
    return [after - before for before, after in pairwise(times)]


def count_throws_from_first(parts: Parts) -> list[float]:
    """Return the angle of each throw from the first one, deg, in [0, 360)."""
    throws = [float(parts.pins.throws_deg[throw]) for throw in range(parts.plan.throws)]
    return [round(throw - throws[0], 3) % 360 for throw in throws]

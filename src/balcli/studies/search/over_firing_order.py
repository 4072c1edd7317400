"""Search over the even firing orders of an engine."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...core.phasors import Array
from ...engine.build import assemble
from ...engine.layout import cycle_deg, plan_cylinders
from ...engine.numbering import find_fitting_splay
from ...enginefile.model import EngineFile
from ...errors import BalcliError
from .designs import Found, rank_candidates
from .firing_orders import Slots
from .task import Task
from .throws import count_from


def find_slots(model: EngineFile) -> tuple[Slots, Array]:
    """The firings of a cycle, and the cranks with even firing orders, shape (cranks, throws), deg,
    cylinder 1's throw at 0.

    Raises:
        BalcliError: cylinders with throws of their own; there is no even firing order.
    """
    layout = plan_cylinders(model.crank, model.layout)
    top_deg = assemble(model).tops_deg
    if any(own.throw is not None for own in model.cylinder.values()):
        raise BalcliError(
            "cylinders with throws of their own leave no firing order to look for: give "
            "crank.throws and splay alone"
        )
    at_throw = {
        cell.number: float(top_deg[cell.number]) - cell.bank * model.crank.splay
        for cell in layout.cells
    }
    sense = -1 if model.layout.rotary else 1
    slots = Slots(layout.cells, at_throw, cycle_deg(model.layout), sense)
    possible = [model.crank.throws] if model.crank.throws else slots.find_cranks()
    if not possible or next(slots.find_orders(possible[0]), None) is None:
        raise BalcliError(_tell_that_none_is_even(model))
    throws = np.array(possible)
    return slots, count_from(throws[:, :1], throws)


def _tell_that_none_is_even(model: EngineFile) -> str:
    """With the split of the pins by which the file's own order were even, if there is one."""
    told = "these throws allow no even firing order, and no others are looked for"
    splay = find_fitting_splay(model.with_table("layout", firing_intervals=None))
    return told if splay is None else f"{told}; with split pins they do: crank.splay = {splay:g}"


def search_firing_order(task: Task) -> Iterator[Found]:
    model = task.model
    slots, from_first = find_slots(model)
    return (
        one._replace(design=one.design._replace(firing_order=order))
        for one in rank_candidates(model, {"throws": from_first}, task.objective)
        for order in slots.find_orders(one.design.throws or ())
    )

"""Search over the throws of a crank: which of its angles stands where along it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from ...core.phasors import Array
from ...engine.build import assemble
from ...enginefile.model import EngineFile
from ...errors import BalcliError
from .designs import Found, build_candidates, rank_candidates
from .even_firing import fires_evenly
from .task import Task
from .throws import count_from, find_best_throws

IMAGES = 8  # candidates kept for each that is asked for, as many are mirror images


def search_throws(task: Task) -> Iterator[Found]:
    model, objective = give_throws(task.model), task.objective
    if peaks := [q.name for q in objective.quantities if q.part == "peak"]:
        raise BalcliError(
            f"a search over throws adds up orders, which {peaks[0]} does not allow; name orders, "
            "such as force.1.major"
        )

    def can_fire(throws: Array) -> NDArray[np.bool_]:
        return fires_evenly(build_candidates(model, {"throws": throws}), model)

    allowed = can_fire if task.even_firing else None
    throws = find_best_throws(model, objective, IMAGES * task.wanted, allowed, task.tell)
    if len(throws):
        throws = count_from(throws[:, :1], throws)
    return rank_candidates(model, {"throws": throws}, objective)


def give_throws(model: EngineFile) -> EngineFile:
    """The same with the throws that its firing order asks for, where it gives none.

    Raises:
        BalcliError: the crank has one throw, or cylinders have throws of their own.
    """
    if any(own.throw is not None for own in model.cylinder.values()):
        raise BalcliError(
            "cylinders with throws of their own take no part in an arrangement of crank.throws: "
            "give crank.throws and splay alone"
        )
    if model.crank.throws is None and model.layout.firing_order:
        found = assemble(model).throws_deg
        throws = [float(found[throw]) for throw in range(len(found))]
        model = model.with_table("crank", throws=throws)
    if len(model.crank.throws or ()) < 2:
        raise BalcliError(
            "there is nothing to permute: the crank has one throw; give crank.throws, or a "
            "layout.firing_order they follow from"
        )
    return model

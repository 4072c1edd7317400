"""The default remedy: fewest weights and shafts that leave nothing free of orders 1 and 2."""

from __future__ import annotations

from ..engine.build import Engine
from .effects import Slot
from .fitting import Fitting
from .options import SchemeOptions
from .planes import find_counterweight_planes, find_planes
from .reasons import explain_counterweights, explain_shaft
from .remedy import Remedy
from .residual import BACKWARD, FORWARD


def size_auto(engine: Engine, options: SchemeOptions | None = None) -> Remedy:
    """Counterweights for the forward part of order 1, then shafts at -1, +2 and -2, each only where
    that part is not balanced.

    Counterweights stand in the end planes (first and last throw), or in the one plane of all throws
    if that suffices; a shaft carries one eccentric where a force remains and one can take its
    moment too, else two; two opposite ones where only a moment remains.
    """
    fitting = Fitting.start(engine, "auto")
    # A device leaves other orders, and what turns the other way, as they are.
    first, second = fitting.find_residual(1), fitting.find_residual(2)
    slots = [Slot("counterweight", 1, 1, z) for z in find_counterweight_planes(engine, first)]
    fitting = fitting.cancel(slots, FORWARD, explain_counterweights(first), first)
    for residual, sense in ((first, -1), (second, 1), (second, -1)):
        planes = find_planes(engine, residual, sense)
        slots = [Slot("shaft", residual.order, sense, z) for z in planes]
        parts = FORWARD if sense > 0 else BACKWARD
        reason = explain_shaft(residual, sense, len(slots))
        fitting = fitting.cancel(slots, parts, reason, residual)
    return fitting.remedy

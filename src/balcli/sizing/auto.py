"""The default remedy: the fewest weights and shafts that leave no free force or moment of orders 1
and 2.
"""

from __future__ import annotations

from ..engine.build import Engine
from .effects import Slot
from .fitting import Fitting
from .options import SchemeOptions
from .planes import find_counterweight_planes, find_planes
from .reasons import explain_counterweights, explain_shaft
from .remedy import Remedy
from .residual import BACKWARD, FORWARD

_SHAFTS = ((1, -1), (2, 1), (2, -1))  # order and sense


def size_auto(engine: Engine, options: SchemeOptions | None = None) -> Remedy:
    """Counterweights for the forward part of order 1, then shafts at -1, +2 and -2, each only where
    that part is not balanced.

    Counterweights stand in the end planes (first and last throw), or in the one plane of all throws
    if that suffices; a shaft carries one eccentric where a force remains and one can take its
    moment too, else two; two opposite ones where only a moment remains.
    """
    fitting = Fitting.start(engine, "auto")
    residual = fitting.find_residual(1)
    slots = [Slot("counterweight", 1, 1, z) for z in find_counterweight_planes(engine, residual)]
    fitting = fitting.cancel(slots, FORWARD, explain_counterweights(residual))
    for order, sense in _SHAFTS:
        residual = fitting.find_residual(order)
        slots = [Slot("shaft", order, sense, z) for z in find_planes(engine, residual, sense)]
        parts = FORWARD if sense > 0 else BACKWARD
        fitting = fitting.cancel(slots, parts, explain_shaft(residual, sense, len(slots)))
    return fitting.remedy

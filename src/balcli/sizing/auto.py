"""The default remedy: the fewest weights and shafts that leave no free force or moment of orders 1
and 2.
"""

from __future__ import annotations

from ..engine.build import Engine
from . import planes
from .effects import Rest, Slot
from .fitting import BACKWARD, FORWARD, Fitting
from .options import Wish
from .remedy import Remedy

_SHAFTS = ((1, -1), (2, 1), (2, -1))  # order and sense


def auto(engine: Engine, wish: Wish | None = None) -> Remedy:
    """Counterweights for the forward part of order 1, then shafts at -1, +2 and -2, each only where
    that part is not balanced.

    Counterweights stand in the end planes (first and last throw), or in the one plane of all throws
    if that suffices; a shaft carries one eccentric where a force remains and one can take its
    moment too, else two; two opposite ones where only a moment remains.
    """
    fitting = Fitting.of(engine, "auto")
    first = fitting.rest(1)
    where = planes.of_part(engine, first, 1)
    if where and len(set(engine.throws_m)) > 1:
        where = planes.ends(engine)
    fitting = fitting.cancel(
        [Slot("counterweight", 1, 1, z) for z in where], FORWARD, why_weights(first)
    )
    for order, sense in _SHAFTS:
        left = fitting.rest(order)
        slots = [Slot("shaft", order, sense, z) for z in planes.of_part(engine, left, sense)]
        fitting = fitting.cancel(
            slots, FORWARD if sense > 0 else BACKWARD, why_shaft(left, sense, len(slots))
        )
    return fitting.remedy


def what(wish: Rest, sense: int) -> str:
    """What turns at this order in this sense. Sizes stand in the tables, in the reader's units."""
    force, moment = (wish.at(q, sense) for q in ("force", "moment"))
    return (
        f"Order {wish.order} "
        f"{'force and moment' if force and moment else 'force' if force else 'moment'}"
    )


def why_weights(wish: Rest) -> str:
    return (
        f"{what(wish, 1)} turning with the crank: counterweights turn with it too and cancel "
        f"{'both' if wish.at('force', 1) and wish.at('moment', 1) else 'it'}"
    )


def why_shaft(wish: Rest, sense: int, count: int) -> str:
    """One sentence on what is cancelled, why nothing less will do, and how."""
    turning = "with" if sense > 0 else "against"
    how = (
        "one eccentric"
        if count == 1
        else "eccentrics in two planes"
        if wish.at("force", sense)
        else "two opposite eccentrics"
    )
    return (
        f"{what(wish, sense)} turning {turning} the crank: nothing on the crankshaft can cancel "
        "it; "
        f"{how} on a shaft at {sense * wish.order:+d} times crank speed can"
    )

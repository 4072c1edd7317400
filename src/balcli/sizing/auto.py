"""The default remedy: the fewest weights and shafts that leave no free force or moment of orders 1 and 2."""
from __future__ import annotations

from ..engine import Engine
from . import planes
from .fitting import BACKWARD, FORWARD, Fitting
from .remedy import Remedy, told
from .solver import Rest, Slot
from .wish import Wish

_SHAFTS = ((1, -1), (2, 1), (2, -1))        # order and sense


def auto(engine: Engine, wish: Wish | None = None) -> Remedy:
    """Counterweights for the forward part of order 1, then shafts at -1, +2 and -2, each only where that part is not balanced.

    Counterweights stand in the end planes (first and last throw), or in the one plane of all throws if that suffices; a shaft carries
    one eccentric where a force remains and one can take its moment too, else two; two opposite ones where only a moment remains.
    """
    fitting = Fitting.of(engine, "auto")
    first = fitting.rest(1)
    where = planes.of_part(engine, first, 1)
    if where and len(set(engine.throws_m)) > 1:
        where = planes.ends(engine)
    fitting = fitting.cancel([Slot("counterweight", 1, 1, z) for z in where], FORWARD, why_weights(first))
    for order, sense in _SHAFTS:
        left = fitting.rest(order)
        slots = [Slot("shaft", order, sense, z) for z in planes.of_part(engine, left, sense)]
        fitting = fitting.cancel(slots, FORWARD if sense > 0 else BACKWARD, why_shaft(left, sense, len(slots)))
    return fitting.remedy


def size_of(wish: Rest, sense: int) -> str:
    """What turns at this order in this sense: a force with its size, or a moment if there is no force."""
    force, moment = (abs(wish.at(q, sense)) * wish.newton for q in ("force", "moment"))
    if not force:
        return f"moment, {told(moment)} N·m"
    return f"force, {told(force)} N" + (f", with a moment of {told(moment)} N·m" if moment else "")


def why_weights(wish: Rest) -> str:
    return (f"Order 1 {size_of(wish, 1)}, turning with the crank: counterweights turn with it too and cancel "
            f"{'both' if wish.at('force', 1) and wish.at('moment', 1) else 'it'}")


def why_shaft(wish: Rest, sense: int, count: int) -> str:
    """One sentence on what is cancelled, why nothing less will do, and how."""
    turning = "with" if sense > 0 else "against"
    how = "one eccentric" if count == 1 else "eccentrics in two planes" if wish.at("force", sense) else "two opposite eccentrics"
    return (f"Order {wish.order} {size_of(wish, sense)}, turning {turning} the crank: nothing on the crankshaft can cancel it; "
            f"{how} on a shaft at {sense * wish.order:+d} times crank speed can")

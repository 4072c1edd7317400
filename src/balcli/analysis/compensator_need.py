"""Judge by the power related unbalance whether a ship's two-stroke engine with crossheads needs
moment compensators in orders 1 and 2.
"""

from typing import Annotated, NamedTuple

import numpy as np

from ..core.phasors import Phasors
from ..core.records import WrittenAs
from ..engine.engine import Engine
from ..file.fields import order_number
from ..forces.power import at_rated_speed, find_power, name_need
from ..sizing.residual import Scales, is_small
from ..sizing.ship_engines import is_judged_by_power

_ORDERS = (1, 2)  # orders that compensators cancel


class CompensatorNeed(NamedTuple):
    """Need of moment compensators in an order whose moment about y is not small. This moment is
    that of the forces along x, which is vertical in ships' engines.

    Attributes:
        order: Order, 1 or 2.
        Nm_per_kW: Moment about y divided by the power, at the speed of the file (power related
            unbalance); left out if no power is known.
        need: Need in the words of project guides; left out if no power is known.
    """

    order: float
    Nm_per_kW: float | None = None
    need: Annotated[str | None, WrittenAs(key="class")] = None


def find_needs(
    moment: Phasors | None, scales: Scales, small: float, engine: Engine | None
) -> tuple[CompensatorNeed, ...] | None:
    """Return the needs of compensators; None if the engine is not judged as a ship's two-stroke
    engine with crossheads.

    Args:
        moment: Free moment of the engine; None: not known.
        scales: Force, moment and roll of one cylinder.
        small: Share of one cylinder's moment below which the moment about y is small.
        engine: Engine; None: not known.
    """
    if engine is None or not is_judged_by_power(engine):
        return None
    if moment is None:
        return ()
    power = find_power(engine)
    faster = float(at_rated_speed(engine).omega) / float(engine.omega)
    needs = []
    for row, order in enumerate(map(order_number, moment.orders)):
        about_y = float(np.abs(moment.y[row]))
        if order not in _ORDERS or is_small(about_y, small * scales.moment):
            continue
        need = CompensatorNeed(order)
        if power is not None:
            related = power.relate(faster**2 * about_y)
            need = CompensatorNeed(order, related, name_need(related))
        needs.append(need)
    return tuple(needs)

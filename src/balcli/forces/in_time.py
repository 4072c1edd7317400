"""Orders of the time at uneven speed, which are what makes things vibrate.

By the crank angle an order is how often something happens in a turn; at uneven speed that is no
frequency: a force of order 1 over the angle comes early and late, and has sidebands over the time.
"""

from __future__ import annotations

import math
from collections.abc import Collection

from ..core.phasors import Array, Phasors
from ..core.speed_ripple import (
    Timetable,
    count_in_time,
    find_reach,
    find_slowest,
    find_speed,
    find_timetable,
)
from ..engine.build import Engine
from ..errors import BalcliError
from ..limits import MOST_SAMPLES
from .kinds import GAS_KINDS
from .orders import find_relevant_orders
from .spectrum import Spectra, compute_spectra, dense_orders

_MOST_COUNTED = 1 << 26  # samples, each for every order: seconds


def compute_spectra_in_time(
    engine: Engine, orders: Array, kinds: Collection[str]
) -> tuple[Spectra, float]:
    """As `compute_spectra`, by orders of the time, for an engine with uneven speed.

    Returns:
        The spectra, and revolutions in a time over those that the mean speed over the angle would
        make of it.

    Raises:
        BalcliError: a crank that all but stops; a kind of gas is asked of an engine without.
    """
    mixed = [*(line.order for line in engine.ripple), *orders]
    of_inertia, highest = find_relevant_orders(engine).max(), orders.max(initial=0)
    fastest = dense_orders(max(of_inertia, 2 * highest), mixed)
    timetable = _find_timetable(engine, float(fastest[1]), 2 * len(fastest), len(orders))
    in_time: dict[str, Phasors] = {}
    # Gas has orders without end: all that are felt in those of the time.
    of_gas = [name for name in kinds if name in GAS_KINDS]
    reach = max(of_inertia, find_reach(timetable, highest)) if of_gas else 0
    for some, most in ((set(kinds) - set(of_gas), of_inertia), (of_gas, reach)):
        if some:
            found = compute_spectra(engine, dense_orders(most, mixed), some)
            counted = count_in_time([p for _, p in found.items()], timetable, orders)
            in_time |= zip((kind.name for kind, _ in found.items()), counted, strict=True)
    return Spectra(orders, **in_time), timetable.turns


def _find_timetable(engine: Engine, step: float, waves: int, orders: int) -> Timetable:
    """Of so many samples that the fastest of so many waves in a cycle is followed where the crank
    is slowest, and the clock runs fastest; each is counted for so many orders.
    """
    slowest = find_slowest(engine.ripple).value
    samples = 1 << math.ceil(math.log2(16 * waves / slowest))
    if samples > MOST_SAMPLES or samples * orders > _MOST_COUNTED:
        raise BalcliError(
            f"operation.speed_ripple: the crank slows down to {slowest:.3g} of its mean speed; "
            "what vibrates there in time takes more samples than are computed; give a smaller "
            "amplitude or lower orders"
        )
    return find_timetable(find_speed(engine.ripple, step), step, samples)

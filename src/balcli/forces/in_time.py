"""Orders of the time at uneven speed, which are what makes things vibrate.

By the crank angle an order is how often something happens in a turn; at uneven speed that is no
frequency: a force of order 1 over the angle comes early and late, and has sidebands over the time.
"""

from __future__ import annotations

import math
from collections.abc import Collection

from ..core.phasors import Array
from ..core.speed_ripple import Course, count_in_time, find_course, find_slowest, find_speed
from ..engine.build import Engine
from ..errors import BalcliError
from ..limits import MOST_SAMPLES
from .orders import find_relevant_orders
from .spectrum import Spectra, compute_spectra, dense_orders


def compute_spectra_in_time(
    engine: Engine, orders: Array, kinds: Collection[str]
) -> tuple[Spectra, float]:
    """As `compute_spectra`, by orders of the time, for an engine with uneven speed.

    Returns:
        The spectra, and revolutions in a time over those that the mean speed over the angle would
        make of it.

    Raises:
        BalcliError: a crank that all but stops.
    """
    mixed = [*(line.order for line in engine.ripple), *orders]
    highest = max(find_relevant_orders(engine).max(), 2 * orders.max(initial=0))
    over_angle = dense_orders(highest, mixed)
    course = _find_course(engine, float(over_angle[1]), 2 * len(over_angle))
    found = compute_spectra(engine, over_angle, kinds)
    in_time = {kind.name: count_in_time(p, course, orders) for kind, p in found.items()}
    return Spectra(orders, **in_time), course.turns


def _find_course(engine: Engine, step: float, waves: int) -> Course:
    """Of so many samples that the fastest of so many waves in a cycle is followed where the crank
    is slowest, and the clock runs fastest.
    """
    lines = [(line.order, float(line.amplitude), float(line.angle_deg)) for line in engine.ripple]
    slowest = find_slowest(lines).value
    samples = 1 << math.ceil(math.log2(16 * waves / slowest))
    if samples > MOST_SAMPLES:
        raise BalcliError(
            f"operation.speed_ripple: the crank slows down to {slowest:.3g} of its mean speed; "
            "what vibrates there in time takes more samples than are computed; give a smaller "
            "amplitude"
        )
    return find_course(find_speed(lines, step), step, samples)

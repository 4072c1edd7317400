"""Guide-force moments as builders of large engines state them, of inertia alone, without gas."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..core.phasors import Array, Phasors
from ..engine.build import Engine
from .spectrum import considerable, each, relevant_orders


@dataclass(frozen=True)
class Guide:
    """H-type: sum of the cylinders' roll moments, N m. X-type: `sum roll_i (z_i - z_ref) / L`, L
    from the first throw to the last; None where there is only one.
    """

    h: Phasors
    x: Phasors | None


def guide(engine: Engine, orders: Array | None = None) -> Guide:
    """Guide-force moments of an engine without trailing axes, by order (default: those worth
    showing); devices have none.

    Each cylinder's roll moment is that about the crank axis, wherever the point of reference stands
    in x and y.
    """
    axis = replace(engine, reference_m=(0.0, 0.0, engine.reference_m[2]))
    every = relevant_orders(engine) if orders is None else orders
    rolls = each(axis, every, ["roll"])["roll"]
    length = float(np.ptp(engine.throws_m))
    arms = (np.ravel(engine.cylinders.z) - engine.reference_m[2]) / length if length else None
    h, x = _sum(rolls, np.ones(engine.cylinders.count)), None if arms is None else _sum(rolls, arms)
    if orders is None:
        orders = every[considerable(h) | (False if x is None else considerable(x))]
    return Guide(h.select_orders(orders), None if x is None else x.select_orders(orders))


def _sum(rolls: Phasors, weights: Array) -> Phasors:
    total = [float(w) * rolls.select_place(k) for k, w in enumerate(weights)]
    return sum(total[1:], total[0]).settled()

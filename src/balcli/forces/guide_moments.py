"""Guide-force moments as builders of large engines state them, of inertia alone, without gas."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..core.phasors import Array, Phasors
from ..engine.build import Engine
from .orders import find_relevant_orders, mark_considerable
from .spectrum import compute_each_cylinder


@dataclass(frozen=True)
class GuideMoments:
    """Sums of the cylinders' roll moments, N m, by order.

    Attributes:
        h: H-type, their sum.
        x: X-type, `sum roll_i (z_i - z_ref) / L`, L from the first throw to the last; None where
            there is only one.
    """

    h: Phasors
    x: Phasors | None


def compute_guide_moments(engine: Engine, orders: Array | None = None) -> GuideMoments:
    """Guide-force moments of an engine's cylinders; devices have none.

    Each cylinder's roll moment is that about the crank axis, wherever the point of reference stands
    in x and y.

    Args:
        engine: without trailing axes.
        orders: shape (orders,), ascending; default: those worth showing.
    """
    z_ref = engine.reference_m[2]
    about_crank = replace(engine, reference_m=(0.0, 0.0, z_ref))
    every = find_relevant_orders(engine) if orders is None else orders
    rolls = compute_each_cylinder(about_crank, every, ["roll"])["roll"]
    h = _sum_weighted(rolls, np.ones(engine.cylinders.count))
    due = mark_considerable(h)
    x = None
    if length := float(np.ptp(engine.throws_m)):
        x = _sum_weighted(rolls, (np.ravel(engine.cylinders.z) - z_ref) / length)
        due |= mark_considerable(x)
    if orders is None:
        orders = every[due]
    return GuideMoments(h.select_orders(orders), None if x is None else x.select_orders(orders))


def _sum_weighted(rolls: Phasors, weights: Array) -> Phasors:
    """Sum over the cylinders of phasors of shape (orders, cylinders), each times its weight."""
    total = [float(weight) * rolls.select_place(row) for row, weight in enumerate(weights)]
    return sum(total[1:], total[0]).settled()

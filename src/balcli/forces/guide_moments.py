"""Guide-force moments as builders of large engines state them: of inertia, and of the gas where the
engine has some.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..core.phasors import Array, Phasors
from ..engine.build import Engine
from ..limits import HIGHEST_GAS_ORDER_UNASKED
from .orders import find_relevant_orders, list_gas_orders, mark_considerable, merge_orders
from .spectrum import compute_each_cylinder


@dataclass(frozen=True)
class GuideMoments:
    """Sums of the cylinders' roll moments, N m, by order.

    Attributes:
        h: H-type, their sum.
        x: X-type, the moment of the guides' side forces: `sum roll_i (z_i - z_ref) / L_i`; None
            where all cylinders stand at one place, or it is not known where they stand.
        height_m: L of each cylinder by its number, from the crankshaft to the middle of the guide,
            shape (cylinders,).
        with_gas: whether the roll of the gas is in it.
    """

    h: Phasors
    x: Phasors | None
    height_m: Array
    with_gas: bool = False


def compute_guide_moments(
    engine: Engine, orders: Array | None = None, height_m: float | None = None
) -> GuideMoments:
    """Guide-force moments of an engine's cylinders; devices have none.

    Each cylinder's roll moment is that about the crank axis, wherever the point of reference stands
    in x and y. The X-type is that of the project guides of MAN B&W two-stroke engines, section
    17.05: bi-moment `sum force couple x distance`, divided by the height of the guide.

    Args:
        engine: without trailing axes.
        orders: shape (orders,), ascending; default: those worth showing.
        height_m: from the crankshaft to the middle of the guide; default: each rod's length.
    """
    z_ref = engine.reference_m[2]
    about_crank = replace(engine, reference_m=(0.0, 0.0, z_ref))
    roll = "roll" if engine.gas is None else "roll_total"
    every = _find_orders(engine) if orders is None else orders
    rolls = compute_each_cylinder(about_crank, every, [roll])[roll]
    z = np.ravel(engine.cylinders.z)
    h = _sum_weighted(rolls, np.ones(engine.cylinders.count))
    due = mark_considerable(h)
    height = _rod_lengths(engine) if height_m is None else np.full(len(z), height_m)
    x = None
    if np.ptp(z) and engine.places_known:
        x = _sum_weighted(rolls, (z - z_ref) / height)
        due |= mark_considerable(x)
    if orders is None:
        orders = every[due]
    chosen_x = None if x is None else x.select_orders(orders)
    by_number = height[np.argsort(engine.numbers)]
    return GuideMoments(h.select_orders(orders), chosen_x, by_number, engine.gas is not None)


def _find_orders(engine: Engine) -> Array:
    """All that may be worth showing; with gas, no more than is shown of gas."""
    relevant = find_relevant_orders(engine)
    if engine.gas is None:
        return relevant
    few = relevant[relevant <= HIGHEST_GAS_ORDER_UNASKED]
    return merge_orders(few, list_gas_orders(engine))


def _rod_lengths(engine: Engine) -> Array:
    """Length of the rod of each cylinder, m, shape (cylinders,)."""
    c = engine.cylinders
    return np.broadcast_to(np.ravel(c.radius / c.lam), c.count)


def _sum_weighted(rolls: Phasors, weights: Array) -> Phasors:
    """Sum over the cylinders of phasors of shape (orders, cylinders), each times its weight."""
    total = [float(weight) * rolls.select_place(row) for row, weight in enumerate(weights)]
    return sum(total[1:], total[0]).drop_noise()

"""Compute guide-force moments by inertia and gas, as builders of large engines state them."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..core.loads import sum_weighted
from ..core.phasors import Array, Phasors
from ..engine.engine import Engine, refuse_geared
from ..limits import HIGHEST_GAS_ORDER_UNASKED
from .spectrum import (
    compute_spectra,
    find_relevant_orders,
    list_gas_orders,
    mark_considerable,
    merge_orders,
)


class GuideMoments(NamedTuple):
    """Sums of the cylinders' roll moments, N m, by order.

    Attributes:
        h: H-type moment: the sum of the roll moments.
        x: X-type moment, the moment of the guides' side forces: `sum roll_i (z_i - z_ref) / L_i`;
            None if all cylinders have the same axial position, or positions are not known.
        height_m: Height L of the middle of each cylinder's guide above the crankshaft, ascending by
            cylinder number, shape (cylinders,).
        with_gas: Whether the moments include the gas.
    """

    h: Phasors
    x: Phasors | None
    height_m: Array
    with_gas: bool = False


def compute_guide_moments(
    engine: Engine, orders: Array | None = None, height_m: float | None = None
) -> GuideMoments:
    """Return the guide-force moments of an engine's cylinders; devices contribute nothing.

    Roll moments are about the crank axis, even if the point of reference is away from this axis.
    The X-type is defined as in section 17.05 of the project guides of MAN B&W two-stroke engines:
    the bi-moment (the sum of each cylinder's roll moment times its distance from the point of
    reference), divided by the height of the guide.

    Args:
        engine: One engine, not an array of variants.
        orders: Orders, ascending, shape (orders,); default: those worth showing.
        height_m: Height of the guide's middle above the crankshaft; default: each rod's length.
    """
    refuse_geared(engine)
    z_ref = engine.reference_m[2]
    about_crank = replace(engine, reference_m=(0.0, 0.0, z_ref))
    roll = "roll" if engine.gas is None else "roll_total"
    every = find_relevant_orders(engine) if orders is None else orders
    if orders is None and engine.gas is not None:  # above: `list_gas_orders`
        few = every[every <= HIGHEST_GAS_ORDER_UNASKED]
        every = merge_orders(few, list_gas_orders(engine))
    rolls = compute_spectra(about_crank, every, [roll], by_cylinder=True)[roll]
    c = engine.cylinders
    z = np.ravel(engine.cylinders.z)
    h = sum_weighted(rolls, np.ones(c.count))
    due = mark_considerable(h)
    height = np.broadcast_to(np.ravel(c.rod_length) if height_m is None else height_m, c.count)
    x = None
    if np.ptp(z) and engine.places_known and np.isfinite(height).all():
        x = sum_weighted(rolls, (z - z_ref) / height)
        due |= mark_considerable(x)
    if orders is None:
        orders = every[due]
    h = h.select_orders(orders)
    x = x and x.select_orders(orders)
    return GuideMoments(h, x, height[np.argsort(engine.numbers)], engine.gas is not None)

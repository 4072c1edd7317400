"""Find the order with the largest transverse couple, and what causes the couple."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Literal, NamedTuple

import numpy as np

from ..core.phasors import Array, Complex, Phasors
from ..engine.engine import Engine
from ..file.fields import order_number
from ..forces.kinds import COUPLE
from ..forces.spectrum import compute_spectra
from ..sizing.residual import Scales, is_small

CoupleCause = Literal[
    "rods", "offset_pistons", "turning_cylinders", "reference_point", "angular_acceleration"
]

WORTH_NAMING = 0.01  # share of one cylinder's first-order force times the crank radius


class Couple(NamedTuple):
    """The transverse couple of an engine.

    Attributes:
        order: Order of the largest transverse couple.
        causes: What causes the couple at all its orders: rods that differ from two masses at their
            ends, offset pistons, pistons in cylinders that turn, forces whose lines miss the point
            of reference, and the acceleration of turning parts; left out for several cranks.
    """

    order: float
    causes: tuple[CoupleCause, ...] | None = None


def select_couple(couple: Phasors | None, scales: Scales) -> Phasors | None:
    """Return the orders of the transverse couple that are worth naming, compared with the roll of
    one cylinder; None if there are none.

    Args:
        couple: Transverse couple; None: not computed.
        scales: Force, moment and roll of one cylinder.
    """
    if couple is None:
        return None
    sizes = couple.major.tolist()
    due = [not is_small(size, WORTH_NAMING * scales.roll) for size in sizes]
    orders = couple.orders[(couple.orders > 0) & np.array(due, bool)]
    return couple.select_orders(orders) if len(orders) else None


def find_couple(couple: Phasors | None, scales: Scales, engine: Engine) -> Couple | None:
    """Return the order of the largest transverse couple and the causes of the couple; None if no
    order of the couple is worth naming.

    Args:
        couple: Transverse couple of the engine; None: not computed.
        scales: Force, moment and roll of one cylinder.
        engine: One engine, not an array of variants.
    """
    selected = select_couple(couple, scales)
    if selected is None:
        return None
    order = order_number(selected.orders[np.argmax(selected.major)])
    if engine.placed:
        return Couple(order)
    return Couple(order, find_causes(engine, selected.orders, WORTH_NAMING * scales.roll))


def find_causes(engine: Engine, orders: Array, least: float) -> tuple[CoupleCause, ...]:
    """Return the causes of the transverse couple at some orders. The couple is computed for the
    rods alone, then with one further cause after the other. Those that change it are its causes.

    Args:
        engine: Engine with one crank.
        orders: Orders, shape (orders,).
        least: Smallest change of the couple that makes a cause worth naming, N m.
    """
    causes: list[CoupleCause] = []
    before: Complex = np.zeros(len(orders), complex)
    for cause, state in _add_causes(engine):
        couple = compute_spectra(state, orders, [COUPLE.name])[COUPLE.name].x
        if np.any(np.abs(couple - before) > least):
            causes.append(cause)
        before = couple
    return tuple(causes)


def _add_causes(engine: Engine) -> Iterator[tuple[CoupleCause, Engine]]:
    """Yield each possible cause of the couple, with the engine that has this cause and those before
    it.
    """
    *_, z = engine.reference_m
    steady = replace(engine, ripple=())
    about_crank = replace(steady, devices=(), reference_m=(0.0, 0.0, z))
    cylinders = engine.cylinders
    weightless = replace(cylinders, reciprocating=0 * cylinders.reciprocating)
    yield "rods", replace(about_crank, cylinders=weightless)
    yield "turning_cylinders" if engine.rotary else "offset_pistons", about_crank
    if engine.devices or any(engine.reference_m[:2]):
        yield "reference_point", steady
    if engine.ripple:
        yield "angular_acceleration", engine

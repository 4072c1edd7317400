"""Which orders there are, and which of them an engine has worth computing or showing.

An order is how often something happens in a revolution of the crankshaft. Pistons, rods and devices
repeat themselves after each revolution, and have whole orders. What happens once in a cycle of four
strokes (gas pressure, and a crank speed that is uneven by it) has halves of whole numbers. All
orders are therefore multiples of 1/2, and exact as floating-point numbers.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable

import numpy as np
from numpy.typing import NDArray

from ..core.phasors import Array, Phasors
from ..engine.build import Engine
from ..enginefile.fields import shorten
from ..errors import BalcliError, wrong_type
from ..limits import HIGHEST_GAS_ORDER_UNASKED, HIGHEST_ORDER, HIGHEST_ORDER_UNASKED
from .kinds import GAS_KINDS
from .spectrum import Spectra, dense_orders

SHOWN = 1e-6  # share of a quantity's largest order below which an order is not worth showing


def is_order(number: float) -> bool:
    """Whether it is an order that may be asked for: a multiple of 1/2, 0 to HIGHEST_ORDER."""
    return 0 <= number <= HIGHEST_ORDER and number % 0.5 == 0


def check_orders(orders: Iterable[float], engines: Collection[Engine] = ()) -> Array:
    """Orders that were asked for, ascending, each once.

    Args:
        orders: as asked for.
        engines: whose they are: one at least has to have half orders if some are asked for.

    Raises:
        BalcliError: there are none, some are no orders, or half orders that no engine has.
        TypeError: they are no numbers.
    """
    asked = sorted(set(_list_numbers(orders)))
    if not asked or not all(map(is_order, asked)):
        named = ", ".join(shorten(n) for n in asked[:8]) or "none"
        raise BalcliError(f"orders must be multiples of 1/2 from 0 to {HIGHEST_ORDER}, not {named}")
    halves = ", ".join(f"{n:g}" for n in asked if n % 1)
    if halves and engines and all(engine.cycle_revolutions == 1 for engine in engines):
        give = "" if any(engine.gas for engine in engines) else "give [gas], or "
        raise BalcliError(
            f"orders {halves}: half orders are those of gas pressure in four strokes; {give}ask "
            "for whole orders"
        )
    return np.array(asked, float)


def _list_numbers(orders: object) -> list[float]:
    strange: object = orders
    is_number = isinstance(orders, np.ndarray) and orders.ndim == 0
    if isinstance(orders, Iterable) and not (is_number or isinstance(orders, (str, bytes))):
        given = list(orders)
        strangers = [one for one in given if not isinstance(one, (int, float, np.number))]
        if not strangers:
            return given
        strange = strangers[0]
    raise wrong_type("orders", strange, "give numbers, such as [1, 2, 4]")


def parse_order(text: str) -> float | None:
    """The order that a text names, such as `2` or `1.5`; None if it names none."""
    short = len(text) <= len(f"{HIGHEST_ORDER}.5") + 1
    if not short or not re.fullmatch(r"[0-9]+(\.[05])?", text, re.ASCII):
        return None
    number = float(text) if "." in text else int(text)
    return number if is_order(number) else None


def split_order(text: str) -> tuple[float | None, str]:
    """`1.5.amplitude` as the order 1.5 and what comes after it; None where there is no order."""
    match = re.fullmatch(r"([^.]*(?:\.[05](?=\.|$))?)(?:\.(.*))?", text, re.DOTALL)
    if match is None:
        return None, text
    return parse_order(match[1]), match[2] or ""


def find_relevant_orders(engine: Engine) -> Array:
    """The orders 1 .. n beyond which nothing exceeds rounding errors, shape (orders,); 0 .. n at
    uneven speed, with halves where its lines have some.
    """
    of_devices = [device.order for device in engine.devices]
    highest = max([engine.cylinders.find_highest_order(), *of_devices])
    if not engine.ripple:
        return np.arange(1.0, highest + 1)
    lines = [line.order for line in engine.ripple]
    return dense_orders(highest + 2 * max(lines), lines)


def list_gas_orders(engine: Engine) -> Array:
    """Orders of gas torque that are worth showing unless others are asked for: multiples of 1/2 (of
    1 in two-stroke engines) up to HIGHEST_GAS_ORDER_UNASKED, shape (orders,). Of so many cylinders
    that all of these may cancel, also the order of their firing, and its double.
    """
    step = 2 / engine.strokes
    firing = step * len(engine.numbers)
    higher = [firing, 2 * firing] if firing > HIGHEST_GAS_ORDER_UNASKED else []
    return np.array([*np.arange(step, HIGHEST_GAS_ORDER_UNASKED + step, step), *higher])


def mark_considerable(phasors: Phasors) -> NDArray[np.bool_]:
    """Orders in which something exceeds SHOWN of its own largest order, shape (orders,); none above
    HIGHEST_ORDER_UNASKED.
    """
    sizes = phasors.major.reshape(len(phasors.orders), -1).max(axis=1, initial=0)
    large = sizes > SHOWN * sizes.max(initial=0)
    return np.asarray(large & (phasors.orders <= HIGHEST_ORDER_UNASKED))


def choose_orders(found: Spectra, *engines: Engine) -> Array:
    """The orders worth showing: 1 and 2 (and 0), and all in which some kind is considerable, of gas
    those that are listed for one of the engines.
    """
    due = (found.orders <= 2) & (found.orders % 1 == 0)
    listed = set(merge_orders(*map(list_gas_orders, engines)).tolist())
    for kind, phasors in found.items():
        worth = mark_considerable(phasors)
        if kind.name in GAS_KINDS:
            worth &= [order in listed for order in found.orders.tolist()]
        due |= worth
    return found.orders[due]


def merge_orders(*several: Iterable[float]) -> Array:
    """All orders of several, ascending, each once."""
    # np.union1d would import masked arrays, which takes longer than all the rest
    return np.array(sorted({float(order) for orders in several for order in orders}))

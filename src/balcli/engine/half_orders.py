"""List the half orders of an engine's shafts, and the shafts that cause them."""

from __future__ import annotations

from ..core.cylinders import DeviceKind
from .devices import group_eccentrics
from .engine import Engine


def list_half_orders(engine: Engine) -> list[float]:
    """Return the half orders of an engine's shafts, rising."""
    orders = {device.order for device in engine.every_device if device.kind is DeviceKind.SHAFT}
    return sorted(order for order in orders if order % 1)


def list_shafts_of_order(engine: Engine, order: float) -> list[str]:
    """Return the names of the shafts that turn at this multiple of crank speed, in either
    direction.
    """
    models = [engine.model, *(crank.engine.model for crank in engine.placed)]
    names = []
    for model in models:
        for name, entries in group_eccentrics(() if model is None else model.shaft):
            if any(abs(entry.ratio) == order for entry in entries.values()):
                names.append(name)
    return names

"""What gas and inertia together do about the crank's axis, in brief."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from ..engine.arrays import find_first_largest
from .figures import peak_deg, size_or_mean
from .order_tables import fit_largest
from .sheet import NEGLIGIBLE, Grid, degrees, order_name, size_cell, size_text

if TYPE_CHECKING:
    from ..forces.spectrum import Spectra
    from .units import System

_SHOWN = ("torque", "gas", "torque_total", "roll_total")  # names of kinds


def gas_grid(
    spectra: Spectra, system: System, pivot: str, *, every_order: bool, hints: bool
) -> Iterator[Grid]:
    """Inertia torque, gas torque, both together and the roll of the frame, by order, if all of them
    are known; negligible orders are left out unless every one was asked for.

    Args:
        pivot: about what the roll is.
        hints: whether the command that shows more is named.
    """
    found = [phasors for kind, phasors in spectra.items() if kind.name in _SHOWN]
    if len(found) < len(_SHOWN):
        return
    inertia, gas, total, roll = found
    unit = fit_largest(system.moment, *found)
    least = NEGLIGIBLE * float(max(gas.major.max(initial=0), inertia.major.max(initial=0)))

    def row(k: int) -> Iterator[str]:
        order = float(spectra.orders[k])
        yield order_name(order)
        for phasors in (inertia, gas, total, roll):
            yield size_cell(size_or_mean(complex(phasors.x[k]), order), unit)
        at = peak_deg(complex(roll.x[k]), order)
        yield "" if at is None else degrees(at)

    shown = [
        k
        for k, order in enumerate(spectra.orders)
        if order in (1, 2) or every_order or max(p.major[k] for p in found) > least
    ]
    yield Grid(
        f"About {pivot} with gas, {unit.name}",
        ("order", "inertia torque", "gas torque", "torque", "roll of the frame", "peak, deg"),
        tuple(tuple(row(k)) for k in shown),
        "Torque = inertia + gas." + (" Mean torque, flywheel and more: balcli torque." * hints),
    )


def tell_rocking(spectra: Spectra, system: System, pivot: str) -> str:
    """Which order rocks the engine most about a `pivot`, in a sentence; empty: not known."""
    roll, gas, inertia = spectra.roll_total, spectra.gas, spectra.roll
    if roll is None or gas is None or inertia is None:
        return ""
    size = np.where(roll.orders > 0, roll.major, 0)
    if not size.any():
        return f"No order rocks the engine about {pivot}."
    k = int(find_first_largest(size))
    parts = {"gas": float(gas.major[k]), "inertia": float(inertia.major[k])}
    there = {name: value for name, value in parts.items() if value}
    told = ", ".join(f"{name} {size_text(value, system.moment)}" for name, value in there.items())
    if len(there) == 1:
        told = f"{next(iter(there))} alone"
    most = size_text(float(size[k]), system.moment)
    return f"Order {order_name(roll.orders[k])} rocks the engine most: roll of {most} ({told})."

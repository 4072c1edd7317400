"""Fit the devices of single steps of the ladder, in their usual places: counterweights in the end
planes or at every throw, balancer shafts, and compensators at the ends of the engine.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from ..core.cylinders import DeviceKind
from ..engine.engine import Engine
from ..forces.spectrum import compute_spectra
from .fitting import Fitting, Slot, explain_counterweights, explain_shaft, size_unbalances
from .pairs import find_moment_about_y, place_forces
from .planes import explain_ends, find_carriers, find_ends, find_planes
from .residual import FORWARD, Residual, list_parts

_AT_THROWS = (
    "Counterweights at every throw cancel the part of order 1 that turns with the crank where it "
    "arises, so main bearings and crankshaft do not carry it"
)
_COMPENSATES = (
    "Order {} moment about y: two masses that turn in opposite directions make a force along x, "
    "whose moment cancels it; the force remains"
)
_COMPENSATES_AT_ENDS = (
    "Order {} moment about y: at each end of the engine, two masses that turn in opposite "
    "directions make a force along x; the two forces cancel each other and the moment"
)


# ------------------------------------------------------------------ counterweights
def add_at_ends(fitting: Fitting, first: Residual, sense: int = 1) -> Fitting:
    """Return the fitting with counterweights in the end planes. They cancel the part of order 1
    that turns in the direction `sense` (1: as the first crank, -1: against it), and are on the
    first crank that turns in this direction.
    """
    crank = find_carriers(fitting.engine)[sense]
    slots = [Slot.on_crank(crank, z) for z in find_ends(crank.engine)]
    reason = explain_counterweights(first, sense, explain_ends(crank.engine))
    return fitting.cancel(slots, list_parts(sense), reason, first)


def add_at_throws(fitting: Fitting) -> Fitting:
    """Return the fitting with a counterweight at every throw. The cylinders of a throw make a
    force of order 1; the counterweight cancels the part of this force that turns with the crank.
    Each counterweight of the file is subtracted at the nearest throw. If a force or moment remains
    (from stagger, or weights of the file), the smallest additional unbalances cancel it.
    """
    engine = fitting.engine
    throws = fitting.engine.joined_throws_m
    forward = compute_spectra(engine, [1], ("force",), by_cylinder=True)["force"].forward[0]
    unbalances = np.zeros(len(throws), complex)
    np.add.at(unbalances, engine.joined_throw_of_rows, -forward / float(engine.omega) ** 2)
    for device in engine.devices:
        if device.kind is DeviceKind.COUNTERWEIGHT:
            unbalances[np.abs(throws - device.z).argmin()] -= device.forward
    slots = [Slot("counterweight", 1, 1, float(z)) for z in throws]
    fitted = fitting.add(slots, unbalances.tolist(), _AT_THROWS)
    left = fitted.find_residual(1)
    parts = FORWARD if engine.places_known else FORWARD[:1]
    if not any(left.parts[part] for part in parts):
        return fitted
    further = size_unbalances(slots, left, parts).unbalances
    return fitting.add(slots, (unbalances + further).tolist(), _AT_THROWS)


# ------------------------------------------------------------------ shafts
def add_shafts(fitting: Fitting, residual: Residual, senses: Iterable[int]) -> Fitting:
    """Return the fitting with shafts for the parts of an order that turn in these directions. A
    shaft has one eccentric if that cancels force and moment, else two in the end planes.
    """
    for sense in senses:
        planes = find_planes(fitting.engine, residual, sense)
        slots = [Slot("shaft", residual.order, sense, z) for z in planes]
        parts = list_parts(sense)
        reason = explain_shaft(residual, sense, len(slots))
        fitting = fitting.cancel(slots, parts, reason, residual)
    return fitting


# ------------------------------------------------------------------ compensators
def ignore_compensators(engine: Engine) -> Engine:
    """Return the engine with the moments of its compensators but without their forces: for each, an
    opposite force is added at the point of reference, where it makes no moment.
    """
    *_, z = engine.reference_m
    opposite = [
        device._replace(forward=-device.forward, backward=-device.backward, z=float(z), spin=0.0)
        for device in engine.every_device
        if device.compensates
    ]
    return replace(engine, devices=(*engine.devices, *opposite)) if opposite else engine


def add_compensators(
    fitting: Fitting, residual: Residual, places: tuple[float, ...], at: complex = 0j
) -> Fitting:
    """Return the fitting with compensators for the moment of an order about y. Each of them is a
    pair of equal masses that turn in opposite directions and make a force along x.

    Args:
        fitting: Devices so far.
        residual: Residual of the order with these devices.
        places: Places of one or two compensators, z in m.
        at: Place x + iy of all shafts, m.

    Raises:
        BalcliError: The places do not allow it (`place_forces`).
    """
    forces = place_forces(-find_moment_about_y(residual), places, residual.reference.z)
    reason = _COMPENSATES_AT_ENDS if len(places) > 1 else _COMPENSATES
    for z, force in forces.items():
        slots = [
            Slot("shaft", residual.order, sense, z, at, role="compensator") for sense in (1, -1)
        ]
        pair = force / 2, force.conjugate() / 2
        fitting = fitting.add(slots, pair, reason.format(residual.order))
    return fitting

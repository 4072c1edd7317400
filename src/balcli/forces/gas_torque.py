"""Torque on the crank of an engine with gas, over its cycle; and the inertia that moves.

What torsion and mounts build on: the torque by order is `forces.spectrum` (kinds `gas`, `torque`,
`torque_total`, `roll_total`), that of each cylinder with its phase
`forces.spectrum.compute_each_cylinder`; the curves over the crank angle are here.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..core.cylinder_pressure import crank_torque
from ..core.phasors import Array
from ..core.piecewise import Function, PiecewiseCurve, resolved
from ..engine.engine import Engine, find_row
from ..engine.gas import EngineGas
from .curves import compute_inertia_torque, compute_moving_inertia
from .spectrum import compute_spectra, find_relevant_orders, take_gas


class TorqueCurves(NamedTuple):
    """Torque on the crank at crank angles (rad) of one cycle, N m, at the mean speed.

    Attributes:
        gas: of all cylinders' gas.
        total: with the inertia torque.
        gas_once: the gas torque until everything repeats itself, inertia too: after one interval of
            equal cylinders that fire evenly, else after the cycle.
    """

    gas: PiecewiseCurve
    total: PiecewiseCurve
    gas_once: PiecewiseCurve


def find_torque_curves(engine: Engine) -> TorqueCurves:
    """Return the torque of an engine without trailing axes, as if its speed were even.

    Raises:
        BalcliError: The engine has no gas.
    """
    gas, times = take_gas(engine), count_repeats(engine)
    cylinders = [(c.torque, c.fires, c.share) for c in gas.cylinders]
    once = crank_torque(cylinders, gas.cycle / times)
    inertia = find_inertia_torque(engine)
    total = resolved(lambda angle: once.at(angle) + inertia(angle), once.breaks)
    return TorqueCurves(once.repeated(times), total.repeated(times), once)


def count_repeats(engine: Engine) -> int:
    """Return how often everything repeats itself in a cycle: as often as equal cylinders fire, if
    they fire evenly to the last digit. One interval takes a quarter of the time of a cycle.
    """
    gas, c = take_gas(engine), engine.cylinders
    columns = (c.lam, c.eps, c.reciprocating, c.rotating, c.couple)
    gas_is_equal = len(gas.group_equal()) == len(set(gas.shares.tolist())) == 1
    if not gas_is_equal or c.linkage is not None or any(len(column) > 1 for column in columns):
        return 1
    count = len(gas.cylinders)
    fires = sorted(cylinder.nominal_deg for cylinder in gas.cylinders)
    even = [k * gas.cycle_deg / count for k in range(count)]
    return count if np.allclose(fires, even, rtol=0, atol=1e-12) else 1


def find_inertia_torque(engine: Engine) -> Function:
    """Return the inertia torque (N m) at crank angles (rad) of any shape, at the mean speed; 0
    everywhere where cylinders cancel each other's to rounding errors.
    """
    steady = replace(engine, ripple=())
    torque = compute_spectra(steady, find_relevant_orders(steady), ("torque",))["torque"]
    if torque.major.sum() <= torque.noise.sum():
        return np.zeros_like
    return _at_radians(lambda degrees: compute_inertia_torque(steady, degrees))


def find_moving_inertia(engine: Engine) -> Function:
    """Return the moment of inertia about the crank (kg m2) of pistons, rods and throw masses, at
    crank angles (rad) of any shape. Throw masses are left out where the crankshaft's own inertia is
    given, which has them; those of a rotary engine stand still.
    """
    if engine.crank_inertia is not None and not engine.rotary:
        c = engine.cylinders
        throws = np.array([[weighed.share] for weighed in engine.weighed]).reshape(-1)
        engine = replace(engine, cylinders=replace(c, rotating=c.rotating - throws))
    return _at_radians(lambda degrees: compute_moving_inertia(engine, degrees))


def find_constant_inertia(engine: Engine) -> float | None:
    """Return the moment of inertia of crankshaft and flywheel, kg m2; None where the file gives
    neither. The crankshaft of a rotary engine stands still.
    """
    crank = None if engine.rotary else engine.crank_inertia
    given = [v for v in (crank, engine.flywheel_inertia) if v is not None]
    return float(sum(given)) if given else None


def silence(engine: Engine, number: int) -> Engine:
    """Return the engine with a cylinder whose gas does nothing.

    Raises:
        BalcliError: The engine has no gas, or no such cylinder.
    """
    gas: EngineGas = take_gas(engine)
    share = gas.without_share_of(find_row(engine, number, "--misfire"))
    return replace(engine, gas=share, model=None)


def _at_radians(function: Function) -> Function:
    """Return a function of degrees in one axis as one of radians of any shape."""

    def at(angle: Array) -> Array:
        return function(np.degrees(angle.reshape(-1))).reshape(angle.shape)

    return at

"""Curves over the crank angle of an engine with gas, and of one of its cylinders."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..core.phasors import Array
from ..engine.build import Engine
from ..forces.curves import Curves, compute_cylinder_torque, compute_piecemeal
from ..forces.gas import take_gas
from ..forces.kinds import GAS, ROLL, ROLL_TOTAL, TORQUE, TORQUE_TOTAL
from ..forces.rod_forces import compute_rod_forces

_ROUNDING = 1e-14


def add_gas_torque(engine: Engine, curves: Curves) -> Curves:
    """Return the curves of a whole engine, with gas torque, total torque and total roll (N m).

    Args:
        curves: of the engine, from `forces.curves.compute_engine_curves`.
    """
    gas = compute_piecemeal(
        engine, curves.crank_deg, lambda angles: {GAS.key: _find_gas_torque(engine, angles)}
    )[GAS.key]
    gas = _settle(gas)
    inertia, roll = curves.values[TORQUE.key], curves.values[ROLL.key]
    added = {GAS.key: gas, TORQUE_TOTAL.key: inertia + gas, ROLL_TOTAL.key: roll - gas}
    return replace(curves, values={**curves.values, **added})


def _find_gas_torque(engine: Engine, crank_deg: Array) -> Array:
    """Return the torque of all cylinders' gas, N m, shape (angles,)."""
    at = np.radians(crank_deg)
    each = (c.share * c.torque.curve.at(at - c.fires) for c in take_gas(engine).cylinders)
    return sum(each, np.zeros(at.shape))


def add_cylinder_gas(engine: Engine, number: int, curves: Curves) -> Curves:
    """Return the motion of one piston, with pressure (Pa), volume (m3), gas force, side thrust,
    force along the rod, force on its crank or knuckle pin along and across the cylinder (N), and
    the cylinder's torque of gas and inertia (N m); as far as they are known.

    Args:
        curves: of that cylinder, from `forces.curves.compute_cylinder_curves`.
    """
    row = engine.numbers.index(number)
    of_gas = compute_piecemeal(
        engine, curves.crank_deg, lambda angles: _find_cylinder_gas(engine, row, angles)
    )
    settled = {name: _settle(values) for name, values in {**curves.values, **of_gas}.items()}
    return replace(curves, values=settled)


def _find_cylinder_gas(engine: Engine, row: int, crank_deg: Array) -> dict[str, Array]:
    """Return what `add_cylinder_gas` adds for the cylinder in a row, each of shape (angles,).

    Forces across count to the side to which the crank pin moves after top dead centre, which seen
    from a cylinder that turns lies behind it.
    """
    found: dict[str, Array] = {}
    gas = take_gas(engine)
    cylinder = gas.cylinders[row]
    at = np.radians(crank_deg) - cylinder.fires
    if cylinder.torque.pressure is not None:
        forces, side = compute_rod_forces(engine, crank_deg), -1 if engine.rotary else 1
        found["pressure_Pa"] = forces.pressure[row]
        if gas.compression_ratio is not None:
            found["volume_m3"] = cylinder.piston.volume(at, gas.compression_ratio)
        found |= {
            "gas_force_N": forces.gas[row],
            "side_thrust_N": side * forces.thrust[row],
            "rod_force_N": forces.rod[row],
            "pin_x_N": forces.pin[row].real,
            "pin_y_N": side * forces.pin[row].imag,
        }
    inertia = compute_cylinder_torque(engine, row, crank_deg)
    found["torque_Nm"] = inertia + cylinder.share * cylinder.torque.curve.at(at)
    return found


def _settle(values: Array) -> Array:
    """Return values in which rounding errors next to the largest value are 0."""
    return np.where(np.abs(values) <= _ROUNDING * np.abs(values).max(initial=0), 0.0, values)

"""Torque of the gas on the crank, by order, of an engine that has gas (`Engine.gas`).

Gas presses on piston and head alike: it makes no free force and no free moment, only torque and its
reaction on the frame. With t_h the coefficients of one cylinder's torque over its cycle, a cylinder
that fires at the crank angle f adds `t_h e^{i h (theta - f)/2}`: order n = h/2.
"""

from __future__ import annotations

import numpy as np

from ..core.phases import ANGLE, SUM
from ..core.phasors import EPS, Array, Complex, Phasors, unit
from ..engine.build import NO_GAS, Engine
from ..engine.gas import CylinderGas, EngineGas
from ..errors import BalcliError

_LEAST = 24  # harmonics that are computed at least, so that the largest is among them
_QUADRATURE = 8 * EPS  # error of a coefficient, of the largest


def take_gas(engine: Engine) -> EngineGas:
    """Return the gas of an engine.

    Raises:
        BalcliError: The engine has none.
    """
    if engine.gas is None:
        raise BalcliError(f"{engine.name or 'the engine'}: {NO_GAS}")
    return engine.gas


def compute_gas_torque(engine: Engine, orders: Array) -> Phasors:
    """Return the torque of all cylinders' gas on the crank, N m, noise included.

    Args:
        engine: without trailing axes, or variants whose gas may be asked for.
        orders: multiples of 1/2, shape (orders,).

    Raises:
        BalcliError: the engine has no gas.
    """
    if engine.gas_of_variants is not None:
        return engine.gas_of_variants(orders)
    each = compute_gas_torque_of_each(engine, orders)
    count = len(take_gas(engine).cylinders)
    rounding = SUM * count + ANGLE * orders
    noise = each.noise.sum(axis=1) + rounding * np.abs(each.forward).sum(axis=1)
    return Phasors(orders, each.vectors.sum(axis=2), noise)


def compute_gas_torque_of_each(engine: Engine, orders: Array) -> Phasors:
    """Return the torque of each cylinder's gas on the crank, N m, shape (orders, cylinders), the
    cylinders in the order of `engine.numbers`; arguments and errors as of `compute_gas_torque`.
    """
    gas = take_gas(engine)
    courses, errors = find_courses(gas, orders)
    fires = np.stack([_turn(cylinder, orders) for cylinder in gas.cylinders], axis=1)
    return Phasors.from_scalar(orders, courses * fires, errors)


def find_courses(gas: EngineGas, orders: Array) -> tuple[Complex, Array]:
    """Return the torque of each cylinder's gas by its own cycle angle, N m, shape (orders,
    cylinders): `Re sum c_n e^{i n theta}`; and its error, likewise.
    """
    halves = np.rint(2 * orders).astype(np.intp)
    courses = np.empty((len(orders), len(gas.cylinders)), complex)
    errors = np.empty(courses.shape)
    for torque, rows in gas.group_equal():
        lowest = np.abs(torque.harmonics(np.arange(1, _LEAST + 1)))
        courses[:, rows] = torque.harmonics(halves)[:, None]
        errors[:, rows] = _QUADRATURE * float(lowest.max())
    courses *= gas.shares
    return courses, gas.shares * errors


def _turn(cylinder: CylinderGas, orders: Array) -> Complex:
    """e^{-i n f}: the nominal angle turns exactly, so that cylinders that fire evenly cancel."""
    return np.exp(-1j * orders * cylinder.piston.top) * unit(-orders * cylinder.nominal_deg)

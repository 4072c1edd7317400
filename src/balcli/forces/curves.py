"""Compute curves over the crank angle directly from the motion, not as sums of orders.

Inertia: each cylinder has momentum G, moment of momentum h and inertia I at crank speed 1. With
crank speed omega, crank acceleration xi and a prime for the derivative by the crank angle, the
force is -(omega^2 G' + xi G), the couple -(omega^2 h' + xi h) and the inertia torque -(1/2 I'
omega^2 + xi I). Sums below the rounding error of their terms (docs/theory.md) are set to 0.

Gas: the torque of all cylinders on the crank over the cycle, with and without inertia torque.

Torques can also be computed for an array of variants of an engine without linkage, whose trailing
axes then follow the angles.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from ..core.cylinders import find_travel
from ..core.mechanisms import slidercrank as sc
from ..core.mechanisms.motion import Motion
from ..core.phasors import Array, Complex, open_axes, unit
from ..core.piecewise import Function, PiecewiseCurve, resolved
from ..engine.engine import CylinderNumber, Engine, find_row
from ..errors import ArgumentError, BalcliError
from ..file.model import EngineFile, Override
from ..limits import FINEST_STEP_DEG
from .spectrum import compute_spectra, find_relevant_orders, take_gas

Number = TypeVar("Number", np.float64, np.complex128)
AT_ONCE = 200_000  # largest number of cylinders x angles, which bounds the memory


def divide_revolution(step: float = 1.0, revolutions: int = 1) -> Array:
    """Return crank angles from 0 through one revolution or several, deg, without the end, shape
    (angles,).

    Args:
        step: Interval, deg.
        revolutions: Number of revolutions.

    Raises:
        ArgumentError: The step is not between 0.001 and 360.
    """
    if not FINEST_STEP_DEG <= step <= 360:
        raise ArgumentError(
            "{step} {value:g}: give {finest:g} to 360 degrees", value=step, finest=FINEST_STEP_DEG
        )
    steps = np.arange(0.0, np.ceil(360 * revolutions / step - 1e-9))
    return np.round(steps * step, 12)  # so that 3 steps of 0.1 are 0.3


def compute_piecemeal(
    engine: Engine, crank_deg: Array, compute: Callable[[Array], dict[str, NDArray[Number]]]
) -> dict[str, NDArray[Number]]:
    """Return curves by name, each of shape (..., angles), computed piece by piece so that memory
    does not grow with cylinders x angles.

    Args:
        engine: Engine.
        crank_deg: Crank angles, shape (angles,).
        compute: Function that returns the curves at some of the angles.
    """
    step = max(AT_ONCE // engine.cylinders.count, 1)
    starts = range(0, max(len(crank_deg), 1), step)
    pieces = [compute(crank_deg[start : start + step]) for start in starts]
    return {name: np.concatenate([piece[name] for piece in pieces], axis=-1) for name in pieces[0]}


class EngineMotion:
    """Positions and motion of all cylinders of an engine at crank angles. Trailing axes of the
    engine follow the angles; an engine with a linkage must have none.

    Attributes:
        engine: The engine.
        cylinders: Its cylinders.
        radius: Crank radii, m, shape (cylinders, 1) or (1, 1).
        crank_deg: Crank angles, shape (angles,).
        omega: Crank speed, rad/s, shape (angles,).
        xi: Crank acceleration omega d omega/d theta, rad2/s2, shape (angles,).
        pin_deg: Angles of the crank pins from x, shape (cylinders, angles).
        psi: Angles of the crank pins from their cylinders' axes, rad, shape (cylinders, angles).
        axis: Directions of the cylinders, shape (cylinders, 1).
        moved: Motion of pistons and rods, in crank radii, shape (cylinders, angles).
        mass: Masses of the linkage, kg, shape (cylinders, 1) or (1, 1).
    """

    def __init__(self, engine: Engine, crank_deg: Array) -> None:
        self.engine = engine
        self.cylinders = engine.cylinders
        c = engine.cylinders
        self.radius = as_rows(c.radius)
        self.crank_deg = crank_deg
        self.omega, self.xi = find_crank_speed(engine, crank_deg)
        axes = as_rows(c.axis_of_each_deg)
        self.axis = unit(axes)
        turned = open_axes(crank_deg, c.pin_deg.shape[1:])
        self.pin_deg = turned + c.axis_deg[c.first] + as_rows(c.pin_deg)
        self.psi = np.radians(np.remainder(self.pin_deg - axes + 180, 360) - 180)
        self.mass = np.zeros((1, 1)) if c.linkage is None else as_rows(c.linkage.mass)
        self.moved: Motion = (
            sc.SliderCrank(self.psi, as_rows(c.lam), as_rows(c.eps))
            if c.linkage is None
            else c.linkage.motion(self.psi, np.ravel(c.lam), np.ravel(c.eps))
        )

    def travel(self) -> Array:
        """Return the travel of the pistons from top dead centre, in crank radii."""
        c = self.cylinders
        if c.linkage is None:
            return sc.displacement(self.psi, as_rows(c.lam), as_rows(c.eps))
        top = np.radians(find_travel(c).top_deg).reshape(-1, 1)
        highest = c.linkage.motion(top, np.ravel(c.lam), np.ravel(c.eps)).place
        return np.asarray(highest - self.moved.place)


def find_crank_speed(engine: Engine, crank_deg: Array) -> tuple[Array, Array]:
    """Return crank speed omega, rad/s, and acceleration xi = omega d omega/d theta, rad/s2, each of
    shape (angles, *trailing).

    Args:
        engine: Engine.
        crank_deg: Crank angles, deg, shape (angles,).
    """
    angles = open_axes(crank_deg, engine.cylinders.pin_deg.shape[1:])
    ratio = np.ones_like(angles)
    slope = np.zeros_like(angles)
    for line in engine.ripple:
        wave = line.amplitude * unit(line.order * angles - line.angle_deg)
        ratio = ratio + wave.real
        slope = slope - line.order * wave.imag
    return engine.omega * ratio, engine.omega**2 * ratio * slope


def compute_device_forces(engine: Engine, crank_deg: Array) -> Complex:
    """Return the force of each device, x + iy, N, shape (devices, angles).

    Args:
        engine: One engine, not an array of variants.
        crank_deg: Crank angles, deg, shape (angles,).
    """
    omega, xi = find_crank_speed(engine, crank_deg)
    rows = np.empty((len(engine.devices), len(crank_deg)), complex)
    for row, d in enumerate(engine.devices):
        ahead = unit(d.order * crank_deg)
        radial = d.order**2 * omega**2
        along = 1j * d.order * xi
        rows[row] = d.forward * ahead * (radial - along)
        rows[row] += d.backward * np.conj(ahead) * (radial + along)
    return rows


def torque_of_cylinders(motion: EngineMotion) -> Array:
    """Return the inertia torque of each cylinder on the crank, N m, shape (cylinders, angles), from
    I = m_rec s'^2 + m_rot r^2 - H spin^2, plus the inertia of a linkage's masses. m_rec and m_rot
    are the masses at the piston pin and at the crank pin, s is the distance of the piston pin from
    the crank's axis, r the crank radius, `spin` the rod's angular velocity at crank speed 1, and H
    `Cylinders.couple`.
    """
    c = motion.cylinders
    r = motion.radius
    m = motion.moved
    on_axis = as_rows(c.reciprocating) * r**2 * m.velocity * m.acceleration
    half_slope = on_axis + motion.mass * r**2 * m.power - as_rows(c.couple) * m.spin * m.spin_rate
    inertia = _inertia_of_cylinders(motion)
    return np.asarray(-(half_slope * motion.omega**2 + motion.xi * inertia))


def _inertia_of_cylinders(motion: EngineMotion) -> Array:
    """Return the inertia I of each cylinder, kg m2, shape (cylinders, angles)."""
    c = motion.cylinders
    r = motion.radius
    m = motion.moved
    on_axis = as_rows(c.reciprocating) * m.velocity**2 + motion.mass * m.energy
    inertia = r**2 * (on_axis + as_rows(c.rotating)) - as_rows(c.couple) * m.spin**2
    shape = np.broadcast_shapes(inertia.shape, motion.psi.shape)
    return np.asarray(np.broadcast_to(inertia, shape))


def as_rows(values: Array) -> Array:
    """Return values (one for each cylinder, or one for all), shape (cylinders or 1, *trailing), as
    a column that broadcasts with angles.
    """
    return np.asarray(values, float)[:, None]


# ------------------------------------------------------------------ gas and inertia over the cycle
@dataclass(frozen=True, eq=False)
class TorqueCurves:
    """Torque on the crank at crank angles (rad), N m, at the mean speed. The curves of variants
    have a figure.

    Attributes:
        gas_once: Gas torque of all cylinders over one period of the torque: one firing interval if
            equal cylinders fire evenly, else the cycle.
        total_once: Torque of gas and inertia over this period.
        times: Number of periods in a cycle.
    """

    gas_once: PiecewiseCurve
    total_once: PiecewiseCurve
    times: int

    @cached_property
    def gas(self) -> PiecewiseCurve:
        """Gas torque of all cylinders over a cycle."""
        return self.gas_once.repeated(self.times)

    @cached_property
    def total(self) -> PiecewiseCurve:
        """Torque of gas and inertia over a cycle."""
        return self.total_once.repeated(self.times)


def find_torque_curves(engine: Engine) -> TorqueCurves:
    """Return the torque of an engine at constant speed. The engine, its gas or both may be arrays
    of variants.

    Raises:
        BalcliError: The engine has no gas.
    """
    once = find_gas_once(engine)
    inertia = find_inertia_torque(engine)

    def add(angle: Array) -> Array:
        of_gas = once.at(angle)
        of_inertia = inertia(angle)
        further = of_inertia.shape[of_gas.ndim :]
        return open_axes(of_gas, further) + open_axes(of_inertia, of_gas.shape[of_inertia.ndim :])

    total = resolved(add, once.breaks, each=True)
    return TorqueCurves(once, total, count_repeats(engine))


def find_gas_once(engine: Engine) -> PiecewiseCurve:
    """Return the gas torque of an engine over one period (`TorqueCurves.gas_once`).

    Raises:
        BalcliError: The engine has no gas.
    """
    from ..core.cylinder_pressure import crank_torque  # engines without gas do not load it

    gas = take_gas(engine)
    cylinders = [(c.torque, c.fires, c.share) for c in gas.cylinders]
    # If a two-stroke engine is geared to a four-stroke one, it has two cycles in the common cycle.
    twice = [c for c in gas.cylinders if engine.placed and 1.5 * c.torque.curve.period < gas.cycle]
    cylinders += [(c.torque, c.fires + c.torque.curve.period, 0.0) for c in twice]
    return crank_torque(cylinders, gas.cycle / count_repeats(engine))


def count_repeats(engine: Engine) -> int:
    """Return the number of periods of the torque in a cycle: one for each firing if the cylinders
    are equal and fire exactly evenly, else one. (One interval is computed faster than a cycle.)
    """
    gas = take_gas(engine)
    c = engine.cylinders
    if engine.placed:
        return 1
    columns = (c.radius, c.offset, c.lam, c.eps, c.reciprocating, c.rotating, c.couple)
    gas_is_equal = len(gas.group_equal()) == len(set(gas.shares.tolist())) == 1
    if not gas_is_equal or c.linkage is not None or any(len(column) > 1 for column in columns):
        return 1
    count = len(gas.cylinders)
    fires = sorted(cylinder.nominal_deg for cylinder in gas.cylinders)
    even = [k * gas.cycle_deg / count for k in range(count)]
    return count if np.allclose(fires, even, rtol=0, atol=1e-12) else 1


def find_inertia_torque(engine: Engine) -> Function:
    """Return the inertia torque (N m) at the mean speed, as a function of crank angles (rad) of any
    shape, whose values have the shape (*angles, *trailing). It is exactly 0 if the cylinders'
    torques cancel to rounding.
    """
    steady = replace(engine, ripple=())
    torque = compute_spectra(steady, find_relevant_orders(steady), ("torque",))["torque"]
    cancels = torque.major.sum(axis=0) <= torque.noise.sum(axis=0)
    find_sum = _add_cylinders(steady, torque_of_cylinders, cancels.size)

    def find_torque(angle: Array) -> Array:
        if cancels.all():
            return np.zeros(angle.shape + cancels.shape)
        return np.where(cancels, 0.0, find_sum(angle))

    return find_torque


def find_moving_inertia(engine: Engine) -> Function:
    """Return the moment of inertia about the crank (kg m2) of pistons, rods and throw masses, as a
    function of crank angles (rad) of any shape. Throw masses are omitted if the file gives the
    crankshaft's inertia, which includes them, and in rotary engines, where they are at rest.
    """

    def find(motion: EngineMotion) -> Array:
        inertia = _inertia_of_cylinders(motion)
        own = motion.engine
        if own.crank_inertia is None or own.rotary:
            return inertia
        throws = np.array([float(weighed.share) for weighed in own.weighed])
        return inertia - motion.radius**2 * as_rows(throws)

    return _add_cylinders(engine, find)


def silence(engine: Engine, number: CylinderNumber) -> Engine:
    """Return the engine without the gas pressure of one cylinder, as after a misfire.

    Args:
        engine: Engine with gas.
        number: Number of the cylinder.

    Raises:
        BalcliError: The engine has no gas, or no such cylinder, or the cylinder is a dummy.
    """
    gas = take_gas(engine)
    row = find_row(engine, number)
    if not engine.placed and number not in (engine.fires_deg or {number}):
        raise BalcliError(f"cylinder {number} is a dummy piston, which never fires")
    cylinders = [one._replace(share=one.share * (k != row)) for k, one in enumerate(gas.cylinders)]
    model = engine.model and _silence_in_file(engine.model, number)
    return replace(engine, gas=replace(gas, cylinders=tuple(cylinders)), model=model)


def _silence_in_file(model: EngineFile, number: CylinderNumber) -> EngineFile:
    """Return a file without the gas of one cylinder, which may belong to one of several engines."""
    if isinstance(number, str):
        name, _, own = number.rpartition(".")
        cranks = list(model.cranks)
        k = model.crank_names.index(name)
        cranks[k] = _silence_in_file(cranks[k], int(own))
        return model.with_cranks(cranks)
    table = model.cylinder.get(number, Override.model_construct())
    silent = table.model_copy(update={"gas": 0.0})
    return model.model_copy(update={"cylinder": {**model.cylinder, number: silent}})


def _add_cylinders(
    engine: Engine, compute: Callable[[EngineMotion], Array], variants: int = 1
) -> Function:
    """Return the sum of a figure over the cylinders of all cranks, as a function of crank angles
    (rad) of any shape, whose values have the shape (*angles, *trailing).

    Args:
        engine: Engine.
        compute: Function that returns the figure for a motion, shape (cylinders, angles,
            *trailing).
        variants: Number of variants along the trailing axes.
    """
    step = max(AT_ONCE // (engine.cylinders.count * variants), 1)

    def add_up(crank_deg: Array) -> Array:
        motions = (EngineMotion(one.engine, crank_deg + one.phase_deg) for one in engine.cranks)
        return np.asarray(sum(compute(motion).sum(axis=0) for motion in motions))

    def at(angle: Array) -> Array:
        crank_deg = np.degrees(angle.reshape(-1))
        starts = range(0, max(len(crank_deg), 1), step)
        found = np.concatenate([add_up(crank_deg[start : start + step]) for start in starts])
        return found.reshape(angle.shape + found.shape[1:])

    return at

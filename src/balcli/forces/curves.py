"""Curves over the crank angle by direct evaluation: nothing here is a sum of orders.

From momentum G, moment of momentum h and inertia I of each cylinder at crank speed 1. With crank
speed omega, crank acceleration xi and a prime for the derivative with respect to the crank angle:
force -(omega^2 G' + xi G), couple -(omega^2 h' + xi h), inertia torque -(1/2 I' omega^2 + xi I). As
everywhere, what lies within the rounding error of the parts that are added up (docs/theory.md) is
exactly 0.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from ..core.mechanisms import slidercrank as sc
from ..core.mechanisms.motion import Motion
from ..core.phasors import EPS, Array, Complex, unit
from ..core.strokes import find_travel
from ..engine.build import Engine, find_row
from ..errors import BalcliError
from ..limits import FINEST_STEP_DEG
from ..result import Result
from .kinds import COUPLE, FORCE, MOMENT, ROLL, TORQUE

Number = TypeVar("Number", np.float64, np.complex128)
AT_ONCE = 200_000  # cylinders x angles, which bounds the memory
_MOMENTS = (MOMENT.key_along("x"), MOMENT.key_along("y"))
_EVERYWHERE = np.arange(0.0, 360.0, 15.0)  # where the sizes of parts are taken, deg


@dataclass(frozen=True, eq=False, repr=False)
class Curves(Result):
    """Figures over the crank angle.

    Attributes:
        name: of the engine.
        speed_rpm: its crank speed.
        crank_deg: shape (angles,).
        values: by name with unit (`force_x_N`), each of the shape of `crank_deg`.
        moments_known: whether the engine file says where the throws stand; else moments are of
            throws in one plane.
    """

    name: str
    speed_rpm: float
    crank_deg: Array
    values: Mapping[str, Array]
    moments_known: bool = True

    @property
    def summary(self) -> str:
        """Of what, and at how many angles."""
        return f"of {self.name or 'an engine'}: {len(self.crank_deg)} crank angles"

    def known(self) -> dict[str, Array]:
        """The values without moments that are not known."""
        unknown = () if self.moments_known else _MOMENTS
        return {name: values for name, values in self.values.items() if name not in unknown}


def divide_revolution(step: float = 1.0, revolutions: int = 1) -> Array:
    """Crank angles of one revolution, or several, in steps of so many degrees, from 0, without the
    last, shape (angles,).

    Raises:
        BalcliError: the step is not from 0.001 to 360.
    """
    if not FINEST_STEP_DEG <= step <= 360:
        raise BalcliError(
            f"--step {step:g}: give a step of the crank angle from {FINEST_STEP_DEG:g} to 360 "
            "degrees"
        )
    steps = np.arange(0.0, np.ceil(360 * revolutions / step - 1e-9))
    return np.round(steps * step, 12)  # 3 steps of 0.1 are 0.3


def compute_engine_curves(engine: Engine, crank_deg: Array) -> Curves:
    """Free force (N), moment, couple, inertia torque and roll (N m) of a whole engine, devices
    included.

    Args:
        engine: without trailing axes.
        crank_deg: shape (angles,).
    """
    curves = _sum_parts(engine, crank_deg, lambda angles: _compute_engine_parts(engine, angles))
    return replace(curves, moments_known=engine.places_known)


def compute_cylinder_curves(engine: Engine, number: int, crank_deg: Array) -> Curves:
    """Piston travel from top dead centre (m), velocity and acceleration away from it (m/s, m/s2)
    and rod angle (deg) of one cylinder.

    Args:
        engine: without trailing axes.
        number: of the cylinder, as the engine file counts them.
        crank_deg: shape (angles,).

    Raises:
        BalcliError: the engine has no such cylinder.
    """
    row = find_row(engine, number, "--cylinder")
    return _sum_parts(
        engine, crank_deg, lambda angles: _compute_cylinder_parts(engine, row, angles)
    )


def compute_cylinder_torque(engine: Engine, row: int, crank_deg: Array) -> Array:
    """Inertia torque of the cylinder in a row, N m, shape (angles,)."""
    return _torque_of_cylinders(EngineMotion(engine, crank_deg))[row]


def compute_inertia_torque(engine: Engine, crank_deg: Array) -> Array:
    """Inertia torque of all cylinders on the crank, N m, shape (angles,), for an engine without
    trailing axes.
    """
    return _torque_of_cylinders(EngineMotion(engine, crank_deg)).sum(axis=0)


def compute_moving_inertia(engine: Engine, crank_deg: Array) -> Array:
    """Moment of inertia about the crank of pistons, rods and what turns with the pins, kg m2, shape
    (angles,), likewise.
    """
    return _inertia_of_cylinders(EngineMotion(engine, crank_deg)).sum(axis=0)


def _sum_parts(
    engine: Engine, crank_deg: Array, compute: Callable[[Array], dict[str, Array]]
) -> Curves:
    """Curves by their parts. What lies within the rounding error of its parts is 0.

    Args:
        compute: parts at some angles, by name, each of shape (parts, angles).
    """
    noise = {
        name: 8 * len(parts) * EPS * float(np.abs(parts).sum(axis=0).max())
        for name, parts in compute(_EVERYWHERE).items()
    }
    sums = compute_piecemeal(
        engine,
        crank_deg,
        lambda angles: {name: parts.sum(axis=0) for name, parts in compute(angles).items()},
    )
    values = {
        name: np.where(np.abs(curve) <= noise[name], 0.0, curve) for name, curve in sums.items()
    }
    return Curves(engine.name, float(engine.speed_rpm), crank_deg, values)


def compute_piecemeal(
    engine: Engine, crank_deg: Array, compute: Callable[[Array], dict[str, NDArray[Number]]]
) -> dict[str, NDArray[Number]]:
    """Curves by name, each of shape (..., angles), computed at so many angles at a time that memory
    does not grow with both cylinders and angles.

    Args:
        compute: the curves at some of the angles.
    """
    step = max(AT_ONCE // engine.cylinders.count, 1)
    starts = range(0, max(len(crank_deg), 1), step)
    pieces = [compute(crank_deg[start : start + step]) for start in starts]
    return {name: np.concatenate([piece[name] for piece in pieces], axis=-1) for name in pieces[0]}


def _compute_engine_parts(engine: Engine, crank_deg: Array) -> dict[str, Array]:
    """What each cylinder and device does, shape (cylinders and devices, angles)."""
    motion = EngineMotion(engine, crank_deg)
    of_devices = compute_device_forces(engine, crank_deg)
    force = np.concatenate([_force_of_cylinders(motion), of_devices])
    x, y, z = engine.reference_m
    levels = np.array([*np.ravel(engine.cylinders.z), *(d.z for d in engine.devices)], float)
    moment = 1j * (levels - float(z))[:, None] * force
    on_crank = np.zeros(engine.cylinders.count)
    places = np.concatenate([on_crank, [d.place for d in engine.devices]]) - (x + 1j * y)
    arms = (np.conj(places)[:, None] * force).imag
    couple = np.concatenate([_couple_of_cylinders(motion), arms])
    torque = _torque_of_cylinders(motion)
    return {
        FORCE.key_along("x"): force.real,
        FORCE.key_along("y"): force.imag,
        MOMENT.key_along("x"): moment.real,
        MOMENT.key_along("y"): moment.imag,
        COUPLE.key: couple,
        TORQUE.key: torque,
        ROLL.key: np.concatenate([couple, -torque]),
    }


def _compute_cylinder_parts(engine: Engine, row: int, crank_deg: Array) -> dict[str, Array]:
    """Parts of the motion of the cylinder in this row, shape (parts, angles)."""
    motion = EngineMotion(engine, crank_deg)
    m, r = motion.moved, motion.radius
    v, a = -m.velocity[row], -m.acceleration[row]
    angles = np.broadcast_to(np.arctan2(m.lean, m.cosine), motion.psi.shape)
    return {
        "travel_m": r * motion.travel()[row : row + 1],
        "velocity_m_per_s": (r * motion.omega * v)[None],
        "acceleration_m_per_s2": r * np.array([motion.omega**2 * a, motion.xi * v]),
        "rod_angle_deg": np.degrees(angles[row : row + 1]),
    }


class EngineMotion:
    """How all cylinders of an engine stand and move at some crank angles.

    Attributes:
        cylinders: whose motion it is.
        radius: of the crank, m.
        crank_deg: shape (angles,).
        omega, xi: crank speed, rad/s, and acceleration, rad2/s2, shape (angles,).
        pin_deg: of the crank pins from x, shape (cylinders, angles).
        psi: of the crank pins from their cylinders' axes, rad, shape (cylinders, angles).
        axis: directions of the cylinders, shape (cylinders, 1).
        moved: pistons and rods in motion, in crank radii, shape (cylinders, angles).
        mass: on curves of a linkage, kg, shape (cylinders, 1) or (1, 1).
    """

    def __init__(self, engine: Engine, crank_deg: Array) -> None:
        self.cylinders = c = engine.cylinders
        self.radius = float(np.ravel(c.radius)[0])
        self.crank_deg = crank_deg
        self.omega, self.xi = find_crank_speed(engine, crank_deg)
        axes = as_rows(c.axis_of_each_deg)
        self.axis = unit(axes)
        self.pin_deg = crank_deg + float(np.ravel(c.axis_deg)[c.first]) + as_rows(c.pin_deg)
        self.psi = np.radians(np.remainder(self.pin_deg - axes + 180, 360) - 180)
        self.mass = np.zeros((1, 1)) if c.linkage is None else as_rows(c.linkage.mass)
        self.moved: Motion = (
            sc.SliderCrank(self.psi, as_rows(c.lam), as_rows(c.eps))
            if c.linkage is None
            else c.linkage.motion(self.psi, np.ravel(c.lam), np.ravel(c.eps))
        )

    def travel(self) -> Array:
        """Of the pistons, from their top dead centres, in crank radii."""
        c = self.cylinders
        if c.linkage is None:
            return sc.displacement(self.psi, as_rows(c.lam), as_rows(c.eps))
        top = np.radians(find_travel(c).top_deg).reshape(-1, 1)
        highest = c.linkage.motion(top, np.ravel(c.lam), np.ravel(c.eps)).place
        return np.asarray(highest - self.moved.place)


def find_crank_speed(engine: Engine, crank_deg: Array) -> tuple[Array, Array]:
    """Crank speed omega (rad/s) and acceleration xi = omega d omega/d theta, shape (angles,)."""
    ratio, slope = np.ones_like(crank_deg), np.zeros_like(crank_deg)
    for line in engine.ripple:
        wave = line.amplitude * unit(line.order * crank_deg - line.angle_deg)
        ratio, slope = ratio + wave.real, slope - line.order * wave.imag
    return engine.omega * ratio, engine.omega**2 * ratio * slope


def _force_of_cylinders(motion: EngineMotion) -> Complex:
    """N, shape (cylinders, angles)."""
    c, r, w2, xi = motion.cylinders, motion.radius, motion.omega**2, motion.xi
    m = motion.moved
    on_axis = -as_rows(c.reciprocating) * r * (w2 * m.acceleration + xi * m.velocity)
    on_curve = motion.mass * r * (w2 * m.acceleration_of_mass + xi * m.velocity_of_mass)
    piston = (on_axis - on_curve) * motion.axis
    pins = as_rows(c.rotating) * r * (w2 - 1j * xi) * unit(motion.pin_deg)
    return piston + pins


def compute_device_forces(engine: Engine, crank_deg: Array) -> Complex:
    """Force of each device, x + iy, N, shape (devices, angles)."""
    omega, xi = find_crank_speed(engine, crank_deg)
    rows = np.empty((len(engine.devices), len(crank_deg)), complex)
    for row, d in enumerate(engine.devices):
        ahead = unit(d.order * crank_deg)
        radial, along = d.order**2 * omega**2, 1j * d.order * xi
        rows[row] = d.forward * ahead * (radial - along)
        rows[row] += d.backward * np.conj(ahead) * (radial + along)
    return rows


def _couple_of_cylinders(motion: EngineMotion) -> Array:
    """Free couple of each cylinder about the crank's axis, N m, shape (cylinders, angles): h =
    -m_rec e s' + m_rot r^2 - H spin (+ the masses on curves), s' = -r v.
    """
    c, r, m = motion.cylinders, motion.radius, motion.moved
    pull = as_rows(c.reciprocating) * as_rows(c.offset) * r
    on_curve, couple = motion.mass * r**2, as_rows(c.couple)
    h = as_rows(c.rotating) * r**2 - pull * m.velocity - couple * m.spin + on_curve * m.swirl
    slope = on_curve * m.swirl_rate - pull * m.acceleration - couple * m.spin_rate
    return np.asarray(-(motion.omega**2 * slope + motion.xi * h))


def _torque_of_cylinders(motion: EngineMotion) -> Array:
    """Inertia torque of each cylinder on the crank, N m, shape (cylinders, angles): I = m_rec s'^2
    + m_rot r^2 - H spin^2 (+ the masses on curves).
    """
    c, r, m = motion.cylinders, motion.radius, motion.moved
    on_axis = as_rows(c.reciprocating) * r**2 * m.velocity * m.acceleration
    half_slope = on_axis + motion.mass * r**2 * m.power - as_rows(c.couple) * m.spin * m.spin_rate
    inertia = _inertia_of_cylinders(motion)
    return np.asarray(-(half_slope * motion.omega**2 + motion.xi * inertia))


def _inertia_of_cylinders(motion: EngineMotion) -> Array:
    """I of each cylinder, kg m2, shape (cylinders, angles)."""
    c, r, m = motion.cylinders, motion.radius, motion.moved
    on_axis = as_rows(c.reciprocating) * m.velocity**2 + motion.mass * m.energy
    inertia = r**2 * (on_axis + as_rows(c.rotating)) - as_rows(c.couple) * m.spin**2
    return np.asarray(np.broadcast_to(inertia, motion.psi.shape))


def as_rows(values: Array) -> Array:
    """One row a cylinder (or one for all), before the axis of angles."""
    return np.asarray(values, float).reshape(-1, 1)

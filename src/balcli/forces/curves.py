"""Curves over the crank angle by direct evaluation: nothing here is a sum of orders.

From momentum G, moment of momentum h and inertia I of each cylinder at crank speed 1. With crank
speed omega, crank acceleration xi and a prime for the derivative with respect to the crank angle:
force -(omega^2 G' + xi G), couple
-(omega^2 h' + xi h), inertia torque -(1/2 I' omega^2 + xi I). As everywhere, what lies within the
rounding error of the parts that are added up (docs/theory.md) is exactly 0.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from ..core.mechanisms import slidercrank as sc
from ..core.phasors import EPS, Array, Complex, unit
from ..core.strokes import travel as dead_centres
from ..engine.build import Engine
from ..errors import BalcliError
from ..limits import FINEST_STEP_DEG
from .kinds import COUPLE, FORCE, MOMENT, ROLL, TORQUE

AT_ONCE = 200_000  # cylinders x angles, which bounds the memory
_EVERYWHERE = np.arange(0.0, 360.0, 15.0)  # where the sizes of parts are taken, deg


@dataclass(frozen=True)
class Curves:
    """Quantities over the crank angle. `values`: by name with unit (`force_x_N`), each of the shape
    of `crank_deg`.
    """

    name: str
    speed_rpm: float
    crank_deg: Array
    values: Mapping[str, Array]


def crank_angles(step: float = 1.0) -> Array:
    """One revolution in steps of so many degrees, from 0, without 360.

    Raises:
        BalcliError: the step is not from 0.001 to 360.
    """
    if not FINEST_STEP_DEG <= step <= 360:
        raise BalcliError(
            f"--step {step:g}: give a step of the crank angle from {FINEST_STEP_DEG:g} to 360 "
            "degrees"
        )
    return np.arange(0.0, np.ceil(360 / step - 1e-9)) * step


def engine_curves(engine: Engine, crank_deg: Array) -> Curves:
    """Free force (N), moment, couple, inertia torque and roll (N m) of a whole engine, devices
    included.

    Args:
        engine: without trailing axes.
        crank_deg: shape (angles,).
    """
    return _summed(engine, crank_deg, lambda angles: _engine_parts(engine, angles))


def _summed(engine: Engine, crank_deg: Array, parts: Callable[[Array], dict[str, Array]]) -> Curves:
    """Curves by their parts, over so many angles at a time that memory does not grow with both
    cylinders and angles.
    """
    noise = {
        name: 8 * len(some) * EPS * float(np.abs(some).sum(axis=0).max())
        for name, some in parts(_EVERYWHERE).items()
    }
    step = max(AT_ONCE // engine.cylinders.count, 1)
    pieces = [
        {name: some.sum(axis=0) for name, some in parts(crank_deg[k : k + step]).items()}
        for k in range(0, max(len(crank_deg), 1), step)
    ]
    curves = {name: np.concatenate([piece[name] for piece in pieces]) for name in noise}
    return Curves(
        engine.name,
        float(engine.speed_rpm),
        crank_deg,
        MappingProxyType(
            {
                name: np.where(np.abs(curve) <= noise[name], 0.0, curve)
                for name, curve in curves.items()
            }
        ),
    )


def _engine_parts(engine: Engine, crank_deg: Array) -> dict[str, Array]:
    """What each cylinder and device does, shape (cylinders and devices, angles)."""
    motion = _Motion(engine, crank_deg)
    force, arms = _forces(engine, motion)
    x, y, z = engine.reference_m
    moment = 1j * (arms - float(z))[:, None] * force
    places = np.concatenate(
        [np.zeros(engine.cylinders.count), [d.place for d in engine.devices]]
    ) - (x + 1j * y)
    couple = np.concatenate([_couple(engine, motion), (np.conj(places)[:, None] * force).imag])
    torque = _torque(engine, motion)
    return {
        FORCE.key_along("x"): force.real,
        FORCE.key_along("y"): force.imag,
        MOMENT.key_along("x"): moment.real,
        MOMENT.key_along("y"): moment.imag,
        COUPLE.key: couple,
        TORQUE.key: torque,
        ROLL.key: np.concatenate([couple, -torque]),
    }


def cylinder_curves(engine: Engine, number: int, crank_deg: Array) -> Curves:
    """Piston travel from top dead centre (m), velocity and acceleration away from it, rod angle of
    one cylinder.

    Raises:
        BalcliError: the engine has no such cylinder.
    """
    if number not in engine.numbers:
        some = ", ".join(map(str, sorted(engine.numbers)))
        raise BalcliError(
            f"--cylinder {number}: {engine.name or 'the engine'} has the cylinders {some}"
        )
    row = engine.numbers.index(number)

    def parts(crank_deg: Array) -> dict[str, Array]:
        motion = _Motion(engine, crank_deg)
        r, v = motion.radius, motion.v[row]
        return {
            "travel_m": r * motion.travel()[row : row + 1],
            "velocity_m_per_s": (r * motion.omega * v)[None],
            "acceleration_m_per_s2": r * np.array([motion.omega**2 * motion.a[row], motion.xi * v]),
            "rod_angle_deg": np.degrees(motion.beta()[row : row + 1]),
        }

    return _summed(engine, crank_deg, parts)


class _Motion:
    """Crank speed and acceleration, and the mechanisms of all cylinders, shape (cylinders,
    angles).
    """

    def __init__(self, engine: Engine, crank_deg: Array) -> None:
        c = engine.cylinders
        count = (c.count, 1)
        self.radius = float(np.ravel(c.radius)[0])
        self.lam, self.eps = (
            np.broadcast_to(_column(c.lam), count),
            np.broadcast_to(_column(c.eps), count),
        )
        axes = _column(c.axis_of_each_deg)
        self.crank_deg = crank_deg
        self.pin = crank_deg + float(np.ravel(c.axis_deg)[c.first]) + _column(c.pin_deg)  # from x
        self.psi = np.radians(np.remainder(self.pin - axes + 180, 360) - 180)
        self.axis = unit(axes)
        self.omega, self.xi = _speed(engine, crank_deg)
        self.cylinders, mechanism = c, (self.psi, self.lam, self.eps)
        self.linkage = c.linkage
        if c.linkage is None:
            self.linked = None
            self.v, self.a = sc.velocity(*mechanism), sc.acceleration(*mechanism)
            self.spin, self.spin_rate = -sc.rod_rate(*mechanism), -sc.rod_acceleration(*mechanism)
        else:
            self.linked = m = c.linkage.motion(self.psi, np.ravel(c.lam), np.ravel(c.eps))
            self.v, self.a, self.spin, self.spin_rate = (
                -m.velocity,
                -m.acceleration,
                m.spin,
                m.spin_rate,
            )
            self.mass = _column(c.linkage.mass)  # what moves on curves

    def travel(self) -> Array:
        """Of the pistons, from their top dead centres, in crank radii."""
        if self.linkage is None or self.linked is None:
            return sc.displacement(self.psi, self.lam, self.eps)
        top = np.radians(dead_centres(self.cylinders).top_deg).reshape(-1, 1)
        highest = self.linkage.motion(
            top, np.ravel(self.cylinders.lam), np.ravel(self.cylinders.eps)
        ).place
        return np.asarray(highest - self.linked.place)

    def beta(self) -> Array:
        """Angles of the rods, rad."""
        if self.linked is None:
            return np.asarray(np.arctan2(*sc.rod_angle(self.psi, self.lam, self.eps)))
        return np.asarray(np.arcsin(self.linked.lean))


def _speed(engine: Engine, crank_deg: Array) -> tuple[Array, Array]:
    """Crank speed omega (rad/s) and acceleration xi = omega d omega/d theta."""
    ratio, slope = np.ones_like(crank_deg), np.zeros_like(crank_deg)
    for line in engine.ripple:
        wave = line.amplitude * unit(line.order * crank_deg - line.angle_deg)
        ratio, slope = ratio + wave.real, slope - line.order * wave.imag
    return engine.omega * ratio, engine.omega**2 * ratio * slope


def _forces(engine: Engine, motion: _Motion) -> tuple[Complex, Array]:
    """Force of each cylinder and device, shape (cylinders + devices, angles), and its place along
    z.
    """
    c, w2, xi, r = engine.cylinders, motion.omega**2, motion.xi, motion.radius
    crank = unit(motion.pin)
    piston: Complex = _column(c.reciprocating) * r * (w2 * motion.a + xi * motion.v) * motion.axis
    pins = _column(c.rotating) * r * (w2 - 1j * xi) * crank
    if (m := motion.linked) is not None:
        piston = (
            piston
            - motion.mass
            * r
            * (w2 * m.acceleration_of_mass + xi * m.velocity_of_mass)
            * motion.axis
        )
    rows = [*(piston + pins)]
    for d in engine.devices:
        ahead = unit(d.order * motion.crank_deg)
        radial, along = d.order**2 * w2, 1j * d.order * xi
        rows.append(
            d.forward * ahead * (radial - along) + d.backward * np.conj(ahead) * (radial + along)
        )
    return np.array(rows), np.concatenate([np.ravel(c.z), [d.z for d in engine.devices]])


def _couple(engine: Engine, motion: _Motion) -> Array:
    """Free couple of each cylinder about the crank's axis: h = -m_rec e s' + m_rot r^2 - H spin (+
    the masses on curves), s' = -r v.
    """
    c, r = engine.cylinders, motion.radius
    pull = _column(c.reciprocating) * (motion.eps * r / motion.lam) * r
    h = pull * motion.v + _column(c.rotating) * r**2 - _column(c.couple) * motion.spin
    slope = pull * motion.a - _column(c.couple) * motion.spin_rate
    if (m := motion.linked) is not None:
        h = h + motion.mass * r**2 * m.swirl
        slope = slope + motion.mass * r**2 * m.swirl_rate
    return np.asarray(-(motion.omega**2 * slope + motion.xi * h))


def _torque(engine: Engine, motion: _Motion) -> Array:
    """Inertia torque of each cylinder on the crank: I = m_rec s'^2 + m_rot r^2 - H spin^2 (+ the
    masses on curves).
    """
    c, r = engine.cylinders, motion.radius
    mass, couple = _column(c.reciprocating) * r**2, _column(c.couple)
    inertia = mass * motion.v**2 + _column(c.rotating) * r**2 - couple * motion.spin**2
    half_slope = mass * motion.v * motion.a - couple * motion.spin * motion.spin_rate
    if (m := motion.linked) is not None:
        inertia = inertia + motion.mass * r**2 * m.energy
        half_slope = half_slope + motion.mass * r**2 * m.power
    return np.asarray(-(half_slope * motion.omega**2 + motion.xi * inertia))


def _column(values: Array) -> Array:
    """One row a cylinder (or one for all), before the axis of angles."""
    return np.asarray(values, float).reshape(-1, 1)

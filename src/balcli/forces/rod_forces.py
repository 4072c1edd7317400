"""Compute the forces in each cylinder of an engine with gas: on the piston, on the cylinder wall,
along the rod and on its lower pin. They are exact for a rod of distributed mass.

In the cylinder's frame, u points along the axis away from the crank, and v is 90 deg ahead of u in
the direction of rotation. The piston pin is at p, the lower pin of the rod (crank pin, or knuckle
pin of an articulated rod) at f, and `d = p - f`. A rod is equivalent to two masses at its ends (a
at the small end, b at the big end) and a massless body with the moment of inertia -H
(docs/theory.md). With the gas force P towards the crank, the mass M of piston and crosshead, and
the rod's angular acceleration alpha,

    W = W_x + i W_y                                       rod on piston
    W_x = M Re p'' + P
    W_y = (Im d (W_x + a Re p'') + H alpha + S)/Re d - a Im p''
    N   = W_y - M Im p''                                  piston on wall
    Q   = a p'' + b f'' + W - sum K                       pin on rod

Derivatives are by time; p'' has a component across the axis only if the cylinder itself turns. K
are the forces of articulated rods on the knuckle pins of a master rod, S is their moment about the
crank pin. At the place c of the crank pin, the rod causes the torque `Im(conj(c) (-Q))`; virtual
work gives the same torque.
"""

from typing import NamedTuple

import numpy as np

from ..core.mechanisms.motion import PointMass
from ..core.phasors import Array, Complex, unit
from ..engine.engine import Engine
from ..errors import BalcliError
from .curves import EngineMotion, as_rows
from .spectrum import take_gas


class RodForces(NamedTuple):
    """Forces, N, each of shape (cylinders, angles); cylinders are in the order of `engine.numbers`.

    Attributes:
        pressure: Absolute pressure in the head end of the cylinder, Pa.
        gas: Gas force on the piston, positive towards the crank.
        acceleration: Acceleration of the piston along u, m/s2.
        thrust: Force of the piston on the cylinder wall, positive along v.
        rod: Force along the rod at the piston pin, positive in compression.
        pin: Force of the rod on its crank pin or knuckle pin, u + i v. For a master rod, it
            includes the forces of its articulated rods.
        axis: Unit vector u of the cylinder in the engine's axes.
        throw: Unit vector from the crank's axis to the crank pin, in the cylinder's frame.
        lean: Unit vector from the rod's lower pin to its piston pin, in the cylinder's frame.
    """

    pressure: Array
    gas: Array
    acceleration: Array
    thrust: Array
    rod: Array
    pin: Complex
    axis: Complex
    throw: Complex
    lean: Complex


def compute_rod_forces(engine: Engine, crank_deg: Array) -> RodForces:
    """Return the forces at crank angles; at a jump of the pressure, the forces after it.

    Args:
        engine: One engine with gas of known pressure, not an array of variants.
        crank_deg: Crank angles, deg, shape (angles,).

    Raises:
        BalcliError: The engine has no gas, or its cylinder pressure is not known.
    """
    source = take_gas(engine)
    motion = EngineMotion(engine, crank_deg)
    angles = np.radians(crank_deg) - as_rows(source.fires)
    pressure = np.empty_like(angles)
    gas = np.empty_like(angles)
    for torque, rows in source.group_equal():
        if torque.pressure is None:
            raise BalcliError("loads of pins need pressures, but [gas] has only torque harmonics")
        gas[rows] = torque.force_under(torque.pressure.at(angles[rows]))
        pressure[rows] = torque.ends[0].pressure.at(angles[rows])
    gas *= as_rows(source.shares)
    masses = np.array(
        [(w.piston + w.crosshead, w.small_end, w.rotating) for w in engine.weighed], float
    )
    heads, small, big = masses.T[..., None]
    # In a rotary engine, psi is the angle of a cylinder ahead of the crank pin (`linkage.Rotary`).
    turned = unit(np.degrees(motion.psi))
    axis = unit(motion.pin_deg) if engine.rotary else np.broadcast_to(motion.axis, turned.shape)
    throw = np.conj(turned) if engine.rotary else turned
    m = motion.moved
    c = engine.cylinders
    side = 1 if engine.rotary else -1
    lean = np.broadcast_to(m.cosine + 1j * side * m.lean, turned.shape)
    span = as_rows(c.lam) / (motion.radius * lean.real)  # 1/Re d, 0 in harmonic motion
    piston, (foot, foot_acceleration) = _follow_ends(engine, motion, throw)
    up = piston.real
    aside = piston.imag
    along = heads * up + gas
    spin_rate = m.spin_rate * motion.omega**2 + m.spin * motion.xi
    across = lean.imag / lean.real * (along + small * up) - small * aside
    across += as_rows(c.couple) * spin_rate * span
    pin = -(small * piston + big * foot_acceleration + along + 1j * across)
    for master, hung in list_hung_rows(engine).items():
        loads = axis[hung] * pin[hung]
        arms = axis[hung] * foot[hung] - axis[master] * foot[master]
        held = (np.conj(arms) * loads).imag.sum(axis=0) * span[master]
        across[master] += held
        pin[master] += np.conj(axis[master]) * loads.sum(axis=0) - 1j * held
    pressed = lean.real * along + lean.imag * across
    thrust = across - heads * aside
    return RodForces(pressure, gas, up, thrust, pressed, pin, axis, throw, lean)


def list_hung_rows(engine: Engine) -> dict[int, list[int]]:
    """Return the rows of cylinders with articulated rods by the row of their master; empty if there
    are none.
    """
    linkage = engine.cylinders.linkage
    rods = getattr(linkage, "hung", linkage)  # a rotary engine has them in `Rotary.hung`
    hung: dict[int, list[int]] = {}
    for row, master in enumerate(getattr(rods, "master", np.zeros(0)).tolist()):
        if row != master:
            hung.setdefault(master, []).append(row)
    return hung


def _follow_ends(
    engine: Engine, motion: EngineMotion, throw: Complex
) -> tuple[Complex, tuple[Complex, Complex]]:
    """Return accelerations of the piston pins, m/s2, and positions, m, and accelerations of the
    lower ends of the rods, in each cylinder's frame, each of shape (cylinders, angles).
    """
    r = motion.radius
    m = motion.moved

    def follow(point: PointMass, turned: Complex | float = 1.0) -> tuple[Complex, Complex]:
        """Return position and acceleration of a point from its derivatives by the crank angle, in
        crank radii.
        """
        acceleration = r * turned * (point.z2 * motion.omega**2 + point.z1 * motion.xi)
        return r * turned * point.z, np.asarray(acceleration, complex)

    if engine.rotary:  # points of a rotary engine are relative to the direction of the pin
        (_, piston), *knuckle = (follow(point, throw) for point in m.points)
        return piston, knuckle[0] if knuckle else (r * throw, np.zeros_like(throw))
    piston_rate = m.acceleration * motion.omega**2 + m.velocity * motion.xi
    return np.asarray(r * piston_rate, complex), follow(m.pin)

"""Forces in each cylinder of an engine with gas: on the piston, on the cylinder wall, along the rod
and on the crank pin, exact with a rod whose mass is distributed.

In the cylinder's frame, u along its axis away from the crank and v 90 deg ahead in the sense of
rotation: crank pin `c = r e^{i psi}`, piston pin `p = s + i e`, `d = p - c`. A rod is equivalent to
its two masses and a massless couple of inertia -H (docs/theory.md), so that with the gas force P
towards the crank, piston mass M, small end a, big end b and the rod's angular acceleration alpha

    W_x = M s'' + P                            rod on piston
    W_y = (Im d (W_x + a s'') + H alpha)/Re d    the wall takes it
    Q   = a s'' + b c'' + W                    crank pin on rod

(derivatives by time). Its torque, `Im(conj(c) (-Q))`, is that of virtual work.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..core.cylinder_pressure import PressureOnPiston
from ..core.phasors import Array, Complex, unit
from ..engine.build import Engine
from ..errors import BalcliError
from .curves import Motion
from .gas import take_gas


class RodForces(NamedTuple):
    """N, each of shape (cylinders, angles), the cylinders in the order of `engine.numbers`.

    Attributes:
        pressure: in the cylinder, Pa, absolute.
        gas: on the piston, towards the crank.
        thrust: of the piston on the cylinder wall, + along v.
        rod: along the rod at the piston pin, + where it is pressed.
        pin: of the rod on the crank pin, u + i v.
    """

    pressure: Array
    gas: Array
    thrust: Array
    rod: Array
    pin: Complex


def compute_rod_forces(engine: Engine, crank_deg: Array, *, before: bool = False) -> RodForces:
    """Forces at crank angles.

    Args:
        engine: with gas of known pressure, without trailing axes.
        crank_deg: shape (angles,).
        before: at a jump of the pressure, what is before it.

    Raises:
        BalcliError: no gas, no pressures, or articulated or turning cylinders.
    """
    if engine.cylinders.linkage is not None:
        raise BalcliError("loads of pins are known for plain rods, not for articulated or turning")
    pressure, gas = _find_gas_forces(engine, crank_deg, before=before)
    motion = Motion(engine, crank_deg)
    c, r, w2 = engine.cylinders, motion.radius, motion.omega**2
    piston, small, big = _find_masses(engine)
    length, offset = r / motion.lam, motion.eps * r / motion.lam
    up = -r * (w2 * motion.a + motion.xi * motion.v)  # s'' by time; v and a are of the travel
    turned = unit(np.degrees(motion.psi))
    place = length * np.cos(motion.rod_angle()) + r * turned.real
    d = place + 1j * offset - r * turned
    spin_rate = motion.spin_rate * w2 + motion.spin * motion.xi
    along = piston * up + gas
    across = (d.imag * (along + small * up) + _column(c.couple) * spin_rate) / d.real
    pin_rate = (-w2 + 1j * motion.xi) * r * turned
    pin = -(small * up + big * pin_rate + along + 1j * across)
    pressed = (d.real * along + d.imag * across) / length
    return RodForces(pressure, gas, across, pressed, pin)


def _find_gas_forces(engine: Engine, crank_deg: Array, *, before: bool) -> tuple[Array, Array]:
    """Pressure (Pa) and gas force (N) of each cylinder, shape (cylinders, angles)."""
    theta = np.radians(crank_deg)
    pressures, forces = [], []
    for cylinder in take_gas(engine).cylinders:
        torque = cylinder.torque
        if not isinstance(torque, PressureOnPiston):
            raise BalcliError("loads of pins need pressures; harmonics of the torque have none")
        at = theta - cylinder.fires
        pressures.append(torque.pressure.at(at, before=before))
        forces.append(cylinder.share * torque.force(at, before=before))
    return np.stack(pressures), np.stack(forces)


def _find_masses(engine: Engine) -> tuple[Array, Array, Array]:
    """Piston, small and big end of each rod with what turns with it, kg, shape (cylinders, 1)."""
    weighed = engine.weighed
    rotating = np.broadcast_to(np.ravel(engine.cylinders.rotating), len(weighed))
    big = [
        float(all_of_it) - float(w.share) for all_of_it, w in zip(rotating, weighed, strict=True)
    ]
    pistons, small = [w.piston for w in weighed], [w.small_end for w in weighed]
    return _column(np.array(pistons)), _column(np.array(small)), _column(np.array(big))


def _column(values: Array) -> Array:
    """Before the axis of angles."""
    return np.asarray(values, float).reshape(-1, 1)

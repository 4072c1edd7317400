"""Torsional dampers as complex inertias: what the node that carries one feels of it.

Each is a complex moment of inertia J (kg m2) that joins its node's own: the damper takes the torque
`-w^2 J x` when the node turns by x. Where J has a negative imaginary part, it takes energy.
"""

from __future__ import annotations

from math import sqrt

import numpy as np

from .vibration import Complex, Real

_TUNED = 1e-12  # a damper tuned closer than this holds its node as still as figures can say


def viscous_inertia(inertia: float, damping: float, frequency: Real) -> Complex:
    """Of a ring (kg m2) that a fluid drags along (N m s), at w rad/s: `J/(1 + i w J/c)`."""
    return inertia / (1 + 1j * frequency * (inertia / damping))


def pendulum_inertia(mass: float, radius: float, length: float, order: Real) -> Complex:
    """Of a mass (kg) on a pendulum of a length L (m), hung up at a radius R (m), at an order of the
    node's own speed, whatever that is: `m (R + L)^2/(1 - n^2 L/R)`. Tuned to n^2 = R/L, it holds
    its node still.
    """
    return mass * (radius + length) ** 2 / _away_from_zero(1 - order**2 * (length / radius) + 0j)


def pendulum_swing(radius: float, length: float, order: Real) -> Complex:
    """Angle of such a pendulum against its node for each rad by which that swings, both small: `n^2
    (1 + L/R)/(1 - n^2 L/R)`.
    """
    detuning = _away_from_zero(1 - order**2 * (length / radius) + 0j)
    return np.asarray(order**2 * (1 + length / radius) / detuning, complex)


def best_viscous_damping(inertia: float, ratio: float, frequency: float) -> float:
    """Damping c (N m s) of the viscous ring (kg m2) that makes the largest response least, of a
    system of one degree of freedom with a natural frequency w (rad/s) and 1/ratio of its inertia:
    `2 J w / sqrt(2 (1 + ratio) (2 + ratio))`; the response is then 1 + 2/ratio times the static one
    (Den Hartog, Mechanical Vibrations, Houdaille damper).
    """
    return 2 * inertia * frequency / sqrt(2 * (1 + ratio) * (2 + ratio))


def _away_from_zero(detuning: Complex) -> Complex:
    return np.where(np.abs(detuning) < _TUNED, _TUNED, detuning)

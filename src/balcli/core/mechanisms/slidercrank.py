"""The slider-crank in closed form, centred or offset.

All figures are dimensionless. Lengths are in crank radii r. The crank angle psi, in radians, is 0
when the crank pin lies along the cylinder's axis; derivatives are by psi. `lam` = r/l and `eps` =
e/l, where e is the offset of the piston pin's path towards the side to which the crank pin moves
after psi = 0. The mechanism can turn if lam + |eps| < 1. Arguments broadcast against each other.
All functions of psi except `displacement` also accept the complex e^{i psi} instead of psi.

The closed forms are those of every textbook (Lu Jiqing, Meng Sizong, Automobile Engine Design,
1990, (1-2), (1-7), (1-10)). Errors are a few roundings of the largest value over a revolution, even
close to locking, because differences that vanish there are factorized.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from ..phasors import Array, Complex
from .motion import Motion, PointMass


class SliderCrank(Motion):
    """Motion of slider-cranks; arguments as in the functions of this module.

    Let beta be the rod's angle, h = |sin psi|, and q = eps if sin psi >= 0, else -eps. Then
    cos^2 beta = (1 - lam + q + lam (1 - h))(1 - q + lam h), and 1 - h = cos^2 psi/(1 + h). In this
    form, there is no cancellation close to locking.
    """

    def __init__(self, psi: ArrayLike, lam: ArrayLike, eps: ArrayLike = 0.0) -> None:
        z = on_circle(psi)
        lam = np.asarray(lam, float)
        eps = np.asarray(eps, float)
        height = np.abs(z.imag)
        signed = np.where(z.imag < 0, -eps, eps)
        most = 1 - lam
        clearance = (most + signed) + ((1 - most) - lam)  # 1 - lam + q, rounded once
        near = clearance + lam * (z.real**2 / (1 + height))
        cosine = np.sqrt(near * ((1 - signed) + lam * height))
        super().__init__(PointMass(z, 1j * z, -z), lam, lam * z.imag - eps, cosine)


def on_circle(psi: ArrayLike) -> Complex:
    """Return e^{i psi}; the argument is an angle (rad) or e^{i psi} itself."""
    angle = np.asarray(psi)
    return angle if np.iscomplexobj(angle) else np.exp(1j * angle)


def rod_angle(psi: ArrayLike, lam: ArrayLike, eps: ArrayLike = 0.0) -> tuple[Array, Array]:
    """Return (sin beta, cos beta); the rod is at the angle -beta from the cylinder's axis, with sin
    beta = lam sin psi - eps.

    Args:
        psi: Crank angles, rad.
        lam: Crank radius / rod length.
        eps: Offset / rod length.
    """
    motion = SliderCrank(psi, lam, eps)
    return motion.lean, motion.cosine


def displacement(psi: ArrayLike, lam: ArrayLike, eps: ArrayLike = 0.0) -> Array:
    """Return the travel x/r from top dead centre; its relative error is small even near top dead
    centre.

    Top dead centre is at tau with sin tau = eps/(1 + lam). The formula is x/r = 2 sin((psi -
    tau)/2) sin((psi + beta)/2) / cos((beta - tau)/2), with beta = -tau at top dead centre.

    Args:
        psi: Crank angle, rad, real.
        lam, eps: Crank radius and offset over rod length.
    """
    psi = np.asarray(psi, float)
    lam = np.asarray(lam, float)
    eps = np.asarray(eps, float)
    sin_beta, cos_beta = rod_angle(psi, lam, eps)
    sin_tau = eps / (1 + lam)
    cos_tau = np.sqrt((1 - sin_tau) * (1 + sin_tau))
    half = np.sin((psi - np.arcsin(sin_tau)) / 2)
    lift = (cos_beta + cos_tau) + lam * (np.cos(psi) + cos_tau)
    return np.asarray(2 * half * half * lift / (1 + cos_beta * cos_tau + sin_beta * sin_tau))


def velocity(psi: ArrayLike, lam: ArrayLike, eps: ArrayLike = 0.0) -> Array:
    """Return the piston velocity v/(r omega), positive away from top dead centre.

    Args:
        psi: Crank angles, rad.
        lam: Crank radius / rod length.
        eps: Offset / rod length.
    """
    return -SliderCrank(psi, lam, eps).velocity


def acceleration(psi: ArrayLike, lam: ArrayLike, eps: ArrayLike = 0.0) -> Array:
    """Return the piston acceleration j/(r omega^2), positive towards the crankshaft.

    Args:
        psi: Crank angles, rad.
        lam: Crank radius / rod length.
        eps: Offset / rod length.
    """
    return -SliderCrank(psi, lam, eps).acceleration


def fastest(lam: ArrayLike) -> tuple[Array, Array]:
    """Return the crank angle (rad, below 90 degrees) at which the piston of the centred mechanism
    is fastest, and its velocity over r omega.

    The acceleration vanishes if cos psi = lam sin^2 psi cos beta; with t = sin^2 psi, this is 1 - t
    = lam^2 t^2 (1 - lam^2 t), which Newton's method solves.
    """
    lam = np.asarray(lam, float)
    square = lam**2
    t = 1 / (1 + square)
    for _ in range(8):
        rest = (1 - t) - square * t**2 * (1 - square * t)
        t = t + rest / (1 + square * t * (2 - 3 * square * t))
    psi = np.arctan2(np.sqrt(t), lam * t * np.sqrt(1 - square * t))
    return np.asarray(psi), velocity(psi, lam)


def fastest_two_term(lam: ArrayLike) -> tuple[Array, Array]:
    """Return the crank angle (rad) at which the two-term velocity sin psi + lam/2 sin 2 psi is
    largest, and its value there. The angle follows from cos psi = (sqrt(1 + 8 lam^2) - 1)/(4 lam).
    """
    lam = np.asarray(lam, float)
    psi = np.arccos(2 * lam / (1 + np.sqrt(1 + 8 * lam**2)))
    return np.asarray(psi), np.asarray(np.sin(psi) * (1 + lam * np.cos(psi)))

"""Rotary engines: the crank stands still and the cylinders turn about it, their pistons with them.

Seen from its cylinder, the crank turns backward: with psi now the cylinder's angle ahead of the crank pin, and offset and
rod angle counted as always towards the side to which the crank pin moves, the piston is at `e^{i psi} (s - i e)` from the
direction of the pin, and its rod turns at `1 + beta'`. So in `inertia.Cylinders` pin and axis change their parts: `axis_deg`
are the directions of the pins, which stand still, and `pin_deg` those of the cylinders, which turn.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from . import slidercrank
from .harmonics import Array
from .linkage import Linkage, Motion


@dataclass(frozen=True)
class Rotary(Linkage):
    """Turning cylinders; `mass` is the reciprocating mass of each, which moves along no fixed line."""

    def motion(self, psi: Array, lam: Array, eps: Array) -> Motion:
        lam, eps = lam[..., None], eps[..., None]
        turned = slidercrank.on_circle(psi)
        sine, cosine = slidercrank.rod_angle(psi, lam, eps)
        place = turned.real + cosine / lam
        velocity, acceleration = -slidercrank.velocity(psi, lam, eps), -slidercrank.acceleration(psi, lam, eps)
        seen = place - 1j * (eps / lam)
        still = np.zeros_like(place)
        return Motion(
            lean=sine, place=place, velocity=velocity, acceleration=acceleration,
            spin=1 + slidercrank.rod_rate(psi, lam, eps),
            spin_rate=slidercrank.rod_acceleration(psi, lam, eps) + still,
            z=turned * seen,
            z1=turned * (velocity + 1j * seen),
            z2=turned * (acceleration + 2j * velocity - seen))

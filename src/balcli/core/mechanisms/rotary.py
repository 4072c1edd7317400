"""Rotary engines: the crank stands still and the cylinders turn about it, their pistons with them.

Seen from its cylinder, the crank turns backward: with psi now the cylinder's angle ahead of the
crank pin, and offset and rod angle counted as always towards the side to which the crank pin moves,
all that moves does so in the mirror: a point w of the mechanism is at `e^{i psi} conj(w)` from the
direction of the pin, the piston w = s + i e among them, and a rod that turns at `b` turns at `1 -
b`. So in `Cylinders` pin and axis change their parts: `axis_deg` are the directions of the
pins, which stand still, and `pin_deg` those of the cylinders, which turn.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..phasors import Array, Complex
from . import slidercrank
from .articulated import Articulated
from .linkage import Linkage, Motion, Point


@dataclass(frozen=True)
class Rotary(Linkage):
    """Turning cylinders; `mass` is the reciprocating mass of each, which moves along no fixed line,
    and what an articulated rod puts on its knuckle pin.

    Attributes:
        hung: master and articulated rods as seen from the cylinders, that is in the mirror; None
        where all are on the crank pin.
        on_knuckle: share of the mass that is on the knuckle pin, shape (cylinders, *trailing).
    """

    hung: Articulated | None = None
    on_knuckle: Array | None = None
    turning: ClassVar[bool] = True

    def figures(self, lam: Array, eps: Array) -> tuple[Array | Complex, ...]:
        if self.hung is None or self.on_knuckle is None:
            return lam, eps
        return *self.hung.figures(lam, eps), self.on_knuckle

    def motion(self, psi: Array | Complex, lam: Array, eps: Array) -> Motion:
        m = _plain(psi, lam, eps) if self.hung is None else self.hung.motion(psi, lam, eps)
        turned = slidercrank.on_circle(psi)
        piston = m.place + 1j * (eps / lam)[..., None]
        points = [_seen(turned, piston, m.velocity, m.acceleration)]
        if self.on_knuckle is not None:
            share, (knuckle,) = self.on_knuckle[..., None], m.points
            points = [
                points[0]._replace(share=1 - share),
                _seen(turned, *knuckle[:3])._replace(share=share),
            ]
        return m._replace(spin=1 - m.spin, spin_rate=-m.spin_rate, points=tuple(points))


def _plain(psi: Array | Complex, lam: Array, eps: Array) -> Motion:
    """Rods that are all on the crank pin."""
    lam, eps = lam[..., None], eps[..., None]
    sine, cosine = slidercrank.rod_angle(psi, lam, eps)
    place = slidercrank.on_circle(psi).real + cosine / lam
    return Motion(
        lean=sine,
        place=place,
        velocity=-slidercrank.velocity(psi, lam, eps),
        acceleration=-slidercrank.acceleration(psi, lam, eps),
        spin=-slidercrank.rod_rate(psi, lam, eps),
        spin_rate=np.zeros_like(place) - slidercrank.rod_acceleration(psi, lam, eps),
        points=(),
    )


def _seen(turned: Complex, w: Complex, w1: Complex | Array, w2: Complex | Array) -> Point:
    """A point of the mechanism from the direction of the pin, and its derivatives."""
    w, w1, w2 = np.conj(w), np.conj(w1), np.conj(w2)
    return Point(turned * w, turned * (w1 + 1j * w), turned * (w2 + 2j * w1 - w))

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
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ..phasors import Array, Complex, Figure, compose
from .articulated import Articulated, hang
from .linkage import Linkage
from .motion import Motion, PointMass
from .slidercrank import SliderCrank, on_circle


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

    def move(self, psi: Array | Complex, *figures: NDArray[Any]) -> Motion:
        lam, eps, *hung = figures
        if not hung:
            return TurningMotion(psi, SliderCrank(psi, lam, eps), eps / lam)
        *of_knuckle, share = hung
        return TurningMotion(psi, hang(psi, lam, eps, *of_knuckle), eps / lam, share)


class TurningMotion(Motion):
    """Cylinders that turn.

    Args:
        psi: crank angles (rad) or e^{i psi}.
        inside: the mechanisms as seen from their cylinders.
        offset: of the pistons, in crank radii.
        on_knuckle: share of the mass on the knuckle pin of `inside`, which then has one.
    """

    def __init__(
        self, psi: Array | Complex, inside: Motion, offset: Array, on_knuckle: Figure | None = None
    ) -> None:
        vars(self).update(vars(inside))
        self._inside, self._turned = inside, on_circle(psi)
        velocity, acceleration = (
            np.asarray(figure, complex) for figure in (inside.velocity, inside.acceleration)
        )
        place = compose(inside.place, np.asarray(offset))
        piston = PointMass(place, velocity, acceleration)
        if on_knuckle is None:
            self.points = (self._see(piston, 1.0),)
        else:
            knuckle = self._see(inside.points[0], on_knuckle)
            self.points = self._see(piston, 1 - on_knuckle), knuckle

    def _see(self, point: PointMass, share: Figure) -> PointMass:
        """Return a point of the mechanism as seen from the direction of the pin."""
        w, w1, w2 = map(np.conj, point[:3])
        first, second = w1 + 1j * w, w2 + 2j * w1 - w
        return PointMass(self._turned * w, self._turned * first, self._turned * second, share)

    @property
    def spin(self) -> Array:
        return 1 - self._inside.spin

    @property
    def spin_rate(self) -> Array:
        return -self._inside.spin_rate

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
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ..phasors import Array, Complex, Figure, compose
from . import slidercrank
from .articulated import Articulated, hang
from .linkage import Linkage
from .motion import Motion, PointMass


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
            return TurningMotion(psi, slidercrank.SliderCrank(psi, lam, eps), eps / lam)
        *of_knuckle, share = hung
        return TurningMotion(psi, hang(psi, lam, eps, *of_knuckle), eps / lam, share)


class _Seen(PointMass):
    """A point of the mechanism from the direction of the pin; `turned` is e^{i psi}."""

    def __init__(self, turned: Complex, point: PointMass, share: Figure = 1.0) -> None:
        self._turned, self._point, self.share = turned, point, share

    @cached_property
    def z(self) -> Complex:
        return self._turned * np.conj(self._point.z)

    @cached_property
    def z1(self) -> Complex:
        w, w1 = np.conj(self._point.z), np.conj(self._point.z1)
        return np.asarray(self._turned * (w1 + 1j * w))

    @cached_property
    def z2(self) -> Complex:
        w, w1, w2 = np.conj(self._point.z), np.conj(self._point.z1), np.conj(self._point.z2)
        return np.asarray(self._turned * (w2 + 2j * w1 - w))


class _Piston(PointMass):
    """The piston on its cylinder's axis, at its offset in crank radii."""

    def __init__(self, motion: Motion, offset: Array) -> None:
        self._motion, self._offset = motion, offset

    @cached_property
    def z(self) -> Complex:
        return compose(self._motion.place, np.asarray(self._offset))

    @property
    def z1(self) -> Complex:
        return np.asarray(self._motion.velocity, complex)

    @property
    def z2(self) -> Complex:
        return np.asarray(self._motion.acceleration, complex)


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
        self._inside = inside
        turned, piston = slidercrank.on_circle(psi), _Piston(inside, offset)
        if on_knuckle is None:
            self.points = (_Seen(turned, piston),)
        else:
            (knuckle,) = inside.points
            self.points = _Seen(turned, piston, 1 - on_knuckle), _Seen(turned, knuckle, on_knuckle)

    @property
    def lean(self) -> Array:
        return self._inside.lean

    @property
    def place(self) -> Array:
        return self._inside.place

    @property
    def velocity(self) -> Array:
        return self._inside.velocity

    @property
    def acceleration(self) -> Array:
        return self._inside.acceleration

    @property
    def spin(self) -> Array:
        return 1 - self._inside.spin

    @property
    def spin_rate(self) -> Array:
        return -self._inside.spin_rate

    @property
    def condition(self) -> Array | float:
        return self._inside.condition

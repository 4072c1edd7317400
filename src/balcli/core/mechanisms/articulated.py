"""Articulated rods: hinged to the big end of a master rod, as in radials and some V engines
(docs/theory.md).

In crank radii, with the master rod at the angle -beta_m in its own frame, the knuckle pin moves on
`K = e^{i psi_m} + k e^{-i beta_m}`; turned into the articulated cylinder's frame, its rod hangs on
K as a plain one hangs on the crank pin. A master rod is the case k = 0.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..phasors import EPS, Array, Complex, compose, unit
from . import slidercrank
from .linkage import Linkage
from .motion import Motion, PointMass


class KnucklePin(PointMass):
    """K in the cylinder's frame, by the motion of its master rod.

    Args:
        psi: crank angles of the cylinder (rad) or e^{i psi}.
        knuckle, lead_deg: as in `Articulated`.
        lam, eps: of the master.
    """

    def __init__(
        self, psi: Array | Complex, knuckle: Complex, lead_deg: Array, lam: Array, eps: Array
    ) -> None:
        lead = unit(lead_deg)
        self._crank = slidercrank.on_circle(psi)  # e^{i psi_m} turned back by the lead
        self._master = slidercrank.SliderCrank(self._crank * lead, lam, eps)
        self._knuckle = np.conj(lead) * knuckle

    @cached_property
    def _arm(self) -> Complex:
        sine, cosine = self._master.angle
        return np.asarray(self._knuckle * compose(cosine, -sine))

    @cached_property
    def z(self) -> Complex:
        return self._crank + self._arm

    @cached_property
    def z1(self) -> Complex:
        spin = self._master.spin
        return 1j * (self._crank + compose(spin * self._arm.real, spin * self._arm.imag))

    @cached_property
    def z2(self) -> Complex:
        bend = compose(self._master.spin**2, -self._master.spin_rate)
        return np.asarray(-self._crank - bend * self._arm)


class HungMotion(Motion):
    """Articulated rods in motion, which hang on their knuckle pins as plain ones on the crank pin.

    Args:
        pin: the knuckle pin.
        lam, eps: of the articulated rod.
    """

    def __init__(self, pin: KnucklePin, lam: Array, eps: Array) -> None:
        self._pin, self._lam, self._eps = pin, lam, eps
        self.points = (pin,)

    @cached_property
    def lean(self) -> Array:
        return self._lam * self._pin.z.imag - self._eps

    @cached_property
    def condition(self) -> Array:
        return np.asarray(1 / (1 - np.minimum(np.abs(self.lean), 1 - EPS)))

    @cached_property
    def _cosine(self) -> Array:
        return np.asarray(np.sqrt((1 - self.lean) * (1 + self.lean)))

    @cached_property
    def _tangent(self) -> Array:
        return self.lean / self._cosine

    @cached_property
    def place(self) -> Array:
        return self._pin.z.real + self._cosine / self._lam

    @cached_property
    def velocity(self) -> Array:
        return self._pin.z1.real - self._tangent * self._pin.z1.imag

    @cached_property
    def acceleration(self) -> Array:
        k1, k2 = self._pin.z1, self._pin.z2
        straight = k2.real - self._tangent * k2.imag
        return np.asarray(straight + self.spin * k1.imag / self._cosine**2)

    @cached_property
    def spin(self) -> Array:
        return -(self._lam * self._pin.z1.imag / self._cosine)

    @cached_property
    def spin_rate(self) -> Array:
        bend = self._lam * self._pin.z2.imag / self._cosine
        return np.asarray(-(bend + self.spin**2 * self._tangent))


@dataclass(frozen=True)
class Articulated(Linkage):
    """Master and articulated rods; `mass` is what each articulated rod puts on its knuckle pin.

    Attributes:
        master: row of each cylinder's master (its own for a master), shape (cylinders,).
        knuckle: knuckle pins from the crank pin, x along the master rod, in crank radii, shape
        (cylinders, *trailing).
        lead_deg: crank angle of the master less the cylinder's own, deg, shape (cylinders,
        *trailing).
    """

    master: NDArray[np.intp]
    knuckle: Complex
    lead_deg: Array

    def figures(self, lam: Array, eps: Array) -> tuple[Array | Complex, ...]:
        each = [np.broadcast_to(a, (len(self.master), *a.shape[1:])) for a in (lam, eps)]
        return *each, self.knuckle, self.lead_deg, *(a[self.master] for a in each)

    def move(self, psi: Array | Complex, *figures: NDArray[Any]) -> HungMotion:
        return hang(psi, *figures)

    def bound_lean(self, lam: Array, eps: Array) -> Array:
        """What the sine of each rod's angle to the cylinder's axis does not exceed, shape
        (cylinders, *trailing): knuckle pins are at most a crank and a knuckle radius away.
        """
        return np.asarray(lam * (1 + np.abs(self.knuckle)) + np.abs(eps))


def hang(psi: Array | Complex, *figures: NDArray[Any]) -> HungMotion:
    """Rods in motion, by the figures of `Articulated`."""
    lam, eps, knuckle, lead_deg, *of_master = figures
    return HungMotion(KnucklePin(psi, knuckle, lead_deg, *of_master), lam, eps)

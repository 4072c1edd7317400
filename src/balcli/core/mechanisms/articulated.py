"""Articulated rods: hinged to the big end of a master rod, as in radials and some V engines
(docs/theory.md).

In crank radii, with the master rod at the angle -beta_m in its own frame, the knuckle pin moves on
`K = e^{i psi_m} + k e^{-i beta_m}`; turned into the articulated cylinder's frame, its rod hangs on
K as a plain one hangs on the crank pin. A master rod is the case k = 0.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..phasors import EPS, Array, Complex, unit
from . import slidercrank
from .linkage import Linkage, Motion, Point


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
        of_master = (
            np.broadcast_to(a, (len(self.master), *a.shape[1:]))[self.master] for a in (lam, eps)
        )
        return lam, eps, self.knuckle, self.lead_deg, *of_master

    def motion(self, psi: Array | Complex, lam: Array, eps: Array) -> Motion:
        lam, eps = (
            np.broadcast_to(a, (len(self.master), *a.shape[1:]))[..., None] for a in (lam, eps)
        )
        k, k1, k2 = self._knuckles(psi, lam, eps)
        sine = lam * k.imag - eps
        cosine = np.sqrt((1 - sine) * (1 + sine))
        tangent, rate = sine / cosine, lam * k1.imag / cosine
        return Motion(
            lean=sine,
            place=k.real + cosine / lam,
            velocity=k1.real - tangent * k1.imag,
            acceleration=k2.real - tangent * k2.imag - rate * k1.imag / cosine**2,
            spin=-rate,
            spin_rate=-(lam * k2.imag / cosine + rate**2 * tangent),
            points=(Point(k, k1, k2),),
            condition=1 / (1 - np.minimum(np.abs(sine), 1 - EPS)),
        )

    def find_distinct(
        self, lam: Array, eps: Array
    ) -> tuple[Articulated, Array, Array, NDArray[np.intp] | slice]:
        if self.knuckle.ndim > 1:
            return self, lam, eps, slice(None)
        lam, eps = (np.broadcast_to(a, self.knuckle.shape) for a in (lam, eps))
        figures = np.stack(
            [
                lam,
                eps,
                lam[self.master],
                eps[self.master],
                self.knuckle.real,
                self.knuckle.imag,
                self.lead_deg,
            ]
        )
        _, rows, which = np.unique(figures, axis=1, return_index=True, return_inverse=True)
        which = which.reshape(-1)  # numpy 2.0 alone gives it two axes
        few = Articulated(
            np.broadcast_to(self.mass, which.shape)[rows],
            which[self.master[rows]],
            self.knuckle[rows],
            self.lead_deg[rows],
        )
        return few, lam[rows], eps[rows], which

    def _knuckles(
        self, psi: Array | Complex, lam: Array, eps: Array
    ) -> tuple[Complex, Complex, Complex]:
        """K and its two derivatives in each cylinder's frame."""
        lead = unit(self.lead_deg)[..., None]
        crank = slidercrank.on_circle(psi)  # e^{i psi_m} turned back by the lead
        mechanism = crank * lead, lam[self.master], eps[self.master]
        sine, cosine = slidercrank.rod_angle(*mechanism)
        rate, bend = slidercrank.rod_rate(*mechanism), slidercrank.rod_acceleration(*mechanism)
        arm = np.conj(lead) * self.knuckle[..., None] * (cosine - 1j * sine)
        return crank + arm, 1j * (crank - rate * arm), -crank - (rate**2 + 1j * bend) * arm

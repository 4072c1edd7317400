"""Articulated rods: hinged to the big end of a master rod, as in radials and some V engines
(docs/theory.md).

In crank radii, with the master rod at the angle -beta_m in its own frame, the knuckle pin moves on
`K = e^{i psi_m} + k e^{-i beta_m}`; turned into the articulated cylinder's frame, its rod hangs on
K as a plain one hangs on the crank pin. A master rod is the case k = 0.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..phasors import EPS, Array, Complex, compose, unit
from .linkage import Linkage
from .motion import Motion, PointMass
from .slidercrank import SliderCrank, on_circle


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

    def move(self, psi: Array | Complex, *figures: NDArray[Any]) -> Motion:
        return hang(psi, *figures)

    def bound_lean(self, lam: Array, eps: Array) -> Array:
        """What the sine of each rod's angle to the cylinder's axis does not exceed, shape
        (cylinders, *trailing): knuckle pins are at most a crank and a knuckle radius away.
        """
        return np.asarray(lam * (1 + np.abs(self.knuckle)) + np.abs(eps))


def hang(
    psi: Array | Complex,
    lam: Array,
    eps: Array,
    knuckle: Complex,
    lead_deg: Array,
    master_lam: Array,
    master_eps: Array,
) -> Motion:
    """Return articulated rods in motion, which hang on their knuckle pins as plain ones on the
    crank pin.

    Args:
        psi: crank angles of the cylinders (rad) or e^{i psi}.
        lam, eps, knuckle, lead_deg: of the articulated rods, as in `Articulated`.
        master_lam, master_eps: of the master rods.
    """
    pin = follow_knuckle(on_circle(psi), knuckle, lead_deg, master_lam, master_eps)
    lean = lam * pin.z.imag - eps
    condition = 1 / (1 - np.minimum(np.abs(lean), 1 - EPS))
    return Motion(pin, lam, lean, np.sqrt((1 - lean) * (1 + lean)), (pin,), condition)


def follow_knuckle(
    crank: Complex, knuckle: Complex, lead_deg: Array, lam: Array, eps: Array
) -> PointMass:
    """Return the knuckle pins K in the cylinders' frames by the motion of their master rods;
    `crank` is e^{i psi}, lam and eps are those of the masters.
    """
    lead = unit(lead_deg)
    master = SliderCrank(crank * lead, lam, eps)  # e^{i psi_m}, turned back by the lead
    arm = np.conj(lead) * knuckle * compose(master.cosine, -master.lean)
    bend = compose(master.spin**2, -master.spin_rate)
    return PointMass(crank + arm, 1j * (crank + master.spin * arm), -crank - bend * arm)

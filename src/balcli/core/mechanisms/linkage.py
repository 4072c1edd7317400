"""Mechanisms with masses on planar curves: common parts of articulated rods and rotary engines.

A plain slider-crank needs no more than its piston's motion along the cylinder's axis. Here another
mass moves on a closed curve `z(psi)` (complex, in crank radii, in the cylinder's frame): the
knuckle pin of an articulated rod, the piston of a cylinder that itself turns, or shares of it on
both. It adds two components of force, a moment of momentum and a kinetic energy, all of which are
harmonics of the crank angle like the others, sampled over a revolution.

Articulated rods: hinged to the big end of a master rod, as in radials and some V engines
(docs/theory.md).

In crank radii, with the master rod at the angle -beta_m in its own frame, the knuckle pin moves on
`K = e^{i psi_m} + k e^{-i beta_m}`; turned into the articulated cylinder's frame, its rod hangs on
K as a plain one hangs on the crank pin. A master rod is the case k = 0.

Rotary engines: the crank stands still and the cylinders turn about it, their pistons with them.

Seen from its cylinder, the crank turns backward: with psi now the cylinder's angle ahead of the
crank pin, and offset and rod angle counted as always towards the side to which the crank pin moves,
all that moves does so in the mirror: a point w of the mechanism is at `e^{i psi} conj(w)` from the
direction of the pin, the piston w = s + i e among them, and a rod that turns at `b` turns at `1 -
b`. So in `Cylinders` pin and axis change their parts: `axis_deg` are the directions of the
pins, which stand still, and `pin_deg` those of the cylinders, which turn.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Collection
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..phasors import EPS, Array, Complex, Figure, Numbers, compose, unit
from .closed_form import Harmonics, Rows
from .harmonics import count_samples, find_distinct, sample_mechanisms
from .motion import Motion, PointMass
from .slidercrank import SliderCrank, on_circle

STEPS = 1440  # crank angles that do not miss a lock
_FEWEST_SAMPLES = 32
_AT_ONCE = 1 << 16  # cylinders x angles of figures by themselves
_SHARPEST = frozenset({"piston", "rod", "along", "across"})  # series that decay the slowest


@dataclass(frozen=True)
class Linkage(ABC):
    """The mechanism of an engine whose cylinders are more than slider-cranks.

    Attributes:
        mass: mass that moves on each cylinder's curve, kg, shape (cylinders or 1, *trailing).
    """

    mass: Array
    turning: ClassVar[bool] = False  # whether cylinders, and so rods, turn about a crank at rest

    @abstractmethod
    def figures(self, lam: Array, eps: Array) -> tuple[Array | Complex, ...]:
        """Return the figures by which the cylinders' mechanisms differ, without masses, each of
        shape (cylinders or 1, *trailing).

        Args:
            lam: Crank radius / rod length, as in `Cylinders`.
            eps: Offset / rod length, as in `Cylinders`.
        """

    @abstractmethod
    def move(self, psi: Array | Complex, *figures: Numbers) -> Motion:
        """Return the mechanisms in motion.

        Args:
            psi: their own crank angles (rad) or e^{i psi}, shape (samples,) or one row each.
            figures: as `figures` gives them, with a last axis of length 1 for the samples; or
                without, where the samples are the first axis of psi.
        """

    def motion(self, psi: Array | Complex, lam: Array, eps: Array) -> Motion:
        """Return the cylinders in motion.

        Args:
            psi: their own crank angles (rad) or e^{i psi}, shape (samples,) or one row each.
            lam, eps: crank radius and offset over rod length, shape (cylinders or 1, *trailing).
        """
        return self.move(psi, *(values[..., None] for values in self.figures(lam, eps)))

    def find_distinct_harmonics(
        self, orders: ArrayLike, lam: Array, eps: Array, wanted: Collection[str]
    ) -> tuple[Harmonics, Rows]:
        """Return harmonics of the mechanisms that differ, and which of them each cylinder has.

        Args:
            orders: whole, shape (orders,).
            lam, eps: shape (cylinders or 1, *trailing).
            wanted: names of series (`closed_form.SERIES`).
        """
        few, which = find_distinct(*self.figures(lam, eps))
        highest = float(np.max(orders, initial=0))
        return self._sample(few, orders, wanted, highest)[0], which

    def sample(
        self, figure: Callable[[Motion], Array], psi: Array, lam: Array, eps: Array
    ) -> Array:
        """Return a figure of the motion at crank angles that all cylinders share, shape (cylinders,
        *trailing, angles); angles are taken in steps that keep memory small.

        Args:
            figure: Figure of a motion.
            psi: Crank angles, rad, shape (angles,).
            lam: Crank radius / rod length, as in `Cylinders`.
            eps: Offset / rod length, as in `Cylinders`.
        """
        count = max(len(self.mass), lam.size, eps.size)
        step = max(_AT_ONCE // count, 1)
        return np.concatenate(
            [figure(self.motion(psi[k : k + step], lam, eps)) for k in range(0, len(psi), step)],
            axis=-1,
        )

    def count_all_samples(self, lam: Array, eps: Array) -> tuple[int, int]:
        """Return how many mechanisms differ, and about how many samples of a revolution all of them
        take.

        Args:
            lam: Crank radius / rod length, as in `Cylinders`.
            eps: Offset / rod length, as in `Cylinders`.
        """
        count = len(find_distinct(*self.figures(lam, eps))[0][0])
        leans = self.sample(lambda motion: motion.lean, revolution(STEPS), lam, eps)
        return count, count * int(count_samples(float(np.abs(leans).max()), 0.0))

    def find_highest_order(self, lam: Array, eps: Array) -> int:
        """Return the order beyond which no coefficient exceeds rounding.

        Args:
            lam: Crank radius / rod length, as in `Cylinders`.
            eps: Offset / rod length, as in `Cylinders`.
        """
        few, _ = find_distinct(*self.figures(lam, eps))
        return int(self._sample(few, [], _SHARPEST, np.inf)[1].max()) // 2

    def _sample(
        self, few: tuple[Numbers, ...], orders: ArrayLike, wanted: Collection[str], highest: float
    ) -> tuple[Harmonics, NDArray[np.intp]]:
        counts = np.full(len(few[0]), _FEWEST_SAMPLES)
        return sample_mechanisms(orders, wanted, self.move, few, counts, highest)


def revolution(count: int) -> Array:
    """Return crank angles of so many samples."""
    return np.arange(count, dtype=float) * (2 * np.pi / count)


@dataclass(frozen=True)
class Articulated(Linkage):
    """Master and articulated rods; `mass` is the mass of each articulated rod on its knuckle pin.

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

    def move(self, psi: Array | Complex, *figures: Numbers) -> Motion:
        return hang(psi, *figures)


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
    crank, lead = on_circle(psi), unit(lead_deg)
    master = SliderCrank(crank * lead, master_lam, master_eps)  # e^{i psi_m}, turned back by lead
    arm = np.conj(lead) * knuckle * compose(master.cosine, -master.lean)
    bend = compose(master.spin**2, -master.spin_rate)
    pin = PointMass(crank + arm, 1j * (crank + master.spin * arm), -crank - bend * arm)
    lean = lam * pin.z.imag - eps
    condition = 1 / (1 - np.minimum(np.abs(lean), 1 - EPS))
    return Motion(pin, lam, lean, np.sqrt((1 - lean) * (1 + lean)), (pin,), condition)


@dataclass(frozen=True)
class Rotary(Linkage):
    """Turning cylinders; `mass` is the reciprocating mass of each, which moves along no fixed line,
    with the mass of an articulated rod on its knuckle pin.

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

    def move(self, psi: Array | Complex, *figures: Numbers) -> Motion:
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

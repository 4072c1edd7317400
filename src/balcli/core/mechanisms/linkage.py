"""Compute mechanisms with masses on planar curves: articulated rods and rotary engines.

In a plain slider-crank, the reciprocating mass moves along the cylinder's axis. Here a mass moves
on a closed curve `z(psi)` (complex, in crank radii, in the cylinder's frame): the curve of the
knuckle pin of an articulated rod, the curve of the piston in a turning cylinder, or both, each with
a share of the mass. The mass causes two components of force, a moment of momentum and a kinetic
energy. Their harmonics are computed from samples over a revolution.

Articulated rods are hinged to the big end of a master rod, as in radial and some V engines
(docs/theory.md). Let the master rod be at the angle -beta_m in the frame of its cylinder, and k be
the knuckle pin's position from the crank pin (x along the master rod), in crank radii. Then the
knuckle pin moves on `K = e^{i psi_m} + k e^{-i beta_m}`. The articulated rod is connected to K as a
plain rod is to the crank pin. A master rod is the case k = 0.

In rotary engines, the crank stands still and the cylinders turn about it with their pistons. Seen
from its cylinder, the crank turns backward. Let psi be the cylinder's angle ahead of the crank pin;
offset and rod angle count, as always, towards the side to which the crank pin moves. Then the
motion is the mirror image of that of a stationary cylinder. A point w of the mechanism (such as the
piston, w = s + i e) is at `e^{i psi} conj(w)` relative to the direction of the pin. The angular
velocity `b` of a rod becomes `1 - b`. In `Cylinders`, pin and axis are therefore exchanged:
`axis_deg` are the directions of the pins, which are at rest, and `pin_deg` are those of the
cylinders, which turn.
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

STEPS = 1440  # with this number of samples of a revolution, no locking position is missed
_FEWEST_SAMPLES = 32
_AT_ONCE = 1 << 16  # largest number of cylinders x angles that are computed at once
_SHARPEST = frozenset({"piston", "rod", "along", "across"})  # series whose orders decay slowest


@dataclass(frozen=True, eq=False, repr=False)
class Linkage(ABC):
    """The mechanism of an engine whose cylinders are not plain slider-cranks.

    Attributes:
        mass: Mass on each cylinder's curve, kg, shape (cylinders or 1, *trailing).
    """

    mass: Array
    turning: ClassVar[bool] = False  # whether cylinders turn about a crank at rest

    @abstractmethod
    def figures(self, lam: Array, eps: Array) -> tuple[Array | Complex, ...]:
        """Return the figures that determine the mechanism of each cylinder, without masses, each of
        shape (cylinders or 1, *trailing).

        Args:
            lam: Crank radius / rod length, as in `Cylinders`.
            eps: Offset / rod length, as in `Cylinders`.
        """

    @abstractmethod
    def move(self, psi: Array | Complex, *figures: Numbers) -> Motion:
        """Return the motion of mechanisms.

        Args:
            psi: Crank angles of the mechanisms (rad) or e^{i psi}, shape (samples,) or one row for
                each mechanism.
            figures: Results of `figures`, with a last axis of length 1 for the samples; without
                this axis if samples are the first axis of psi.
        """

    def motion(self, psi: Array | Complex, lam: Array, eps: Array) -> Motion:
        """Return the motion of all cylinders.

        Args:
            psi: Crank angles of the cylinders (rad) or e^{i psi}, shape (samples,) or one row for
                each cylinder.
            lam, eps: Crank radius and offset over rod length, shape (cylinders or 1, *trailing).
        """
        return self.move(psi, *(values[..., None] for values in self.figures(lam, eps)))

    def find_distinct_harmonics(
        self, orders: ArrayLike, lam: Array, eps: Array, wanted: Collection[str]
    ) -> tuple[Harmonics, Rows]:
        """Return the harmonics of all different mechanisms, and the index of each cylinder's
        mechanism.

        Args:
            orders: Whole orders, shape (orders,).
            lam, eps: Crank radius and offset over rod length, shape (cylinders or 1, *trailing).
            wanted: Names of series (`closed_form.SERIES`).
        """
        few, which = find_distinct(*self.figures(lam, eps))
        highest = float(np.max(orders, initial=0))
        return self._sample(few, orders, wanted, highest)[0], which

    def sample(
        self, figure: Callable[[Motion], Array], psi: Array, lam: Array, eps: Array
    ) -> Array:
        """Return a figure of the motion at crank angles that are the same for all cylinders, shape
        (cylinders, *trailing, angles). Angles are divided into blocks to save memory.

        Args:
            figure: Function that returns the figure of a motion.
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
        """Return the number of different mechanisms, and about how many samples of a revolution
        they need together.

        Args:
            lam: Crank radius / rod length, as in `Cylinders`.
            eps: Offset / rod length, as in `Cylinders`.
        """
        count = len(find_distinct(*self.figures(lam, eps))[0][0])
        leans = self.sample(lambda motion: motion.lean, revolution(STEPS), lam, eps)
        return count, count * int(count_samples(float(np.abs(leans).max()), 0.0))

    def find_highest_order(self, lam: Array, eps: Array) -> int:
        """Return the order beyond which all coefficients are below rounding.

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
    """Return this many equally spaced crank angles of a revolution, rad."""
    return np.arange(count, dtype=float) * (2 * np.pi / count)


@dataclass(frozen=True, eq=False, repr=False)
class Articulated(Linkage):
    """Master and articulated rods; `mass` is the mass of each articulated rod on its knuckle pin.

    Attributes:
        master: Row of each cylinder's master cylinder (for a master cylinder, its own row), shape
            (cylinders,).
        knuckle: Position of the knuckle pins from the crank pin, x along the master rod, in crank
            radii, shape (cylinders, *trailing).
        lead_deg: Crank angle from the master cylinder's axis less crank angle from the cylinder's
            axis, deg, shape (cylinders, *trailing).
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
    """Return the motion of articulated rods, whose lower ends are on their knuckle pins.

    Args:
        psi: Crank angles of the cylinders (rad) or e^{i psi}.
        lam, eps: Crank radius and offset over rod length of the articulated rods.
        knuckle, lead_deg: As in `Articulated`.
        master_lam, master_eps: Crank radius and offset over rod length of the master rods.
    """
    crank = on_circle(psi)
    lead = unit(lead_deg)
    master = SliderCrank(crank * lead, master_lam, master_eps)  # in the master's frame
    arm = np.conj(lead) * knuckle * compose(master.cosine, -master.lean)
    bend = compose(master.spin**2, -master.spin_rate)
    pin = PointMass(crank + arm, 1j * (crank + master.spin * arm), -crank - bend * arm)
    lean = lam * pin.z.imag - eps
    condition = 1 / (1 - np.minimum(np.abs(lean), 1 - EPS))
    return Motion(pin, lam, lean, np.sqrt((1 - lean) * (1 + lean)), (pin,), condition)


@dataclass(frozen=True, eq=False, repr=False)
class Rotary(Linkage):
    """Turning cylinders; `mass` is the reciprocating mass of each cylinder, plus the mass of an
    articulated rod on its knuckle pin.

    Attributes:
        hung: Master and articulated rods as seen from the cylinders (mirrored); None if all rods
            are on the crank pin.
        on_knuckle: Share of the mass that is on the knuckle pin, shape (cylinders, *trailing).
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
    """Motion of cylinders that turn.

    Args:
        psi: Crank angles (rad) or e^{i psi}.
        inside: Motion as seen from the cylinders.
        offset: Offset of the pistons, in crank radii.
        on_knuckle: Share of the mass on the knuckle pin of `inside`; None if there is no knuckle
            pin.
    """

    def __init__(
        self, psi: Array | Complex, inside: Motion, offset: Array, on_knuckle: Figure | None = None
    ) -> None:
        vars(self).update(vars(inside))
        self._inside = inside
        self._turned = on_circle(psi)
        place = compose(inside.place, np.asarray(offset))
        z1, z2 = (np.asarray(rate, complex) for rate in (inside.velocity, inside.acceleration))
        piston = PointMass(place, z1, z2)
        shares = (1.0,) if on_knuckle is None else (1 - on_knuckle, on_knuckle)
        self.points = tuple(map(self._see, (piston, *inside.points), shares))

    def _see(self, point: PointMass, share: Figure) -> PointMass:
        """Return a point of the mechanism relative to the direction of the pin."""
        w, w1, w2 = map(np.conj, point[:3])
        first = w1 + 1j * w
        second = w2 + 2j * w1 - w
        return PointMass(self._turned * w, self._turned * first, self._turned * second, share)

    @property
    def spin(self) -> Array:
        return 1 - self._inside.spin

    @property
    def spin_rate(self) -> Array:
        return -self._inside.spin_rate

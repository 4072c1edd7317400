"""Mechanisms with masses on planar curves, sampled over a revolution: what articulated rods and
rotary engines share.

A plain slider-crank needs no more than its piston's motion along the cylinder's axis. Here another
mass moves on a closed curve `z(psi)` (complex, in crank radii, in the cylinder's frame): the
knuckle pin of an articulated rod, the piston of a cylinder that itself turns, or shares of it on
both. It adds two components of force, a moment of momentum and a kinetic energy, all of which are
harmonics of the crank angle like the others (`fourier.Curve`).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from functools import reduce
from operator import add
from typing import ClassVar, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..phasors import Array, Complex, Figure
from .fourier import (
    NONE,
    SAMPLING,
    Curve,
    Harmonics,
    Rows,
    amplify_rounding,
    transform,
    unit_circle,
)
from .harmonics import count_samples

STEPS = 1440  # crank angles that do not miss a lock
FEWEST_SAMPLES, MOST_SAMPLES = 64, 1 << 18
_AT_ONCE = 1 << 16  # cylinders x angles of figures by themselves


class Point(NamedTuple):
    """A closed curve with its derivatives, and the share of the mass that moves on it."""

    z: Complex
    z1: Complex
    z2: Complex
    share: Figure = 1.0


class Motion(NamedTuple):
    """A mechanism in motion; each of shape (cylinders, *trailing, samples), lengths in crank
    radii.
    """

    lean: Array  # sine of the rod's angle beta to the cylinder's axis
    place: Array  # s of the piston along its axis
    velocity: Array  # s'
    acceleration: Array  # s''
    spin: Array  # angular velocity of the rod, in the crank's sense
    spin_rate: Array
    points: tuple[Point, ...]  # where the mass is
    condition: Array | float = 1.0  # relative error of rod and piston, in roundings: near a lock

    @property
    def velocity_of_mass(self) -> Complex:
        """Of unit mass on its points, likewise all that follows."""
        return reduce(add, (p.share * p.z1 for p in self.points))

    @property
    def acceleration_of_mass(self) -> Complex:
        """Derivative of `velocity_of_mass`."""
        return reduce(add, (p.share * p.z2 for p in self.points))

    @property
    def swirl(self) -> Array:
        """Moment of momentum."""
        return reduce(add, (p.share * (np.conj(p.z) * p.z1).imag for p in self.points))

    @property
    def swirl_rate(self) -> Array:
        """Derivative of `swirl`."""
        return reduce(add, (p.share * (np.conj(p.z) * p.z2).imag for p in self.points))

    @property
    def energy(self) -> Array:
        """Twice the kinetic energy."""
        return reduce(add, (p.share * np.abs(p.z1) ** 2 for p in self.points))

    @property
    def power(self) -> Array:
        """Half the derivative of `energy`."""
        return reduce(add, (p.share * (np.conj(p.z1) * p.z2).real for p in self.points))


@dataclass(frozen=True)
class Linkage(ABC):
    """The mechanism of an engine whose cylinders are more than slider-cranks.

    Attributes:
        mass: what moves on each cylinder's curve, kg, shape (cylinders or 1, *trailing).
    """

    mass: Array
    turning: ClassVar[bool] = False  # whether cylinders, and so rods, turn about a crank at rest

    @abstractmethod
    def figures(self, lam: Array, eps: Array) -> tuple[Array | Complex, ...]:
        """What distinguishes the mechanisms of the cylinders, masses left out, each of shape
        (cylinders or 1, *trailing); lam and eps as in `Cylinders`.
        """

    @abstractmethod
    def motion(self, psi: Array | Complex, lam: Array, eps: Array) -> Motion:
        """The cylinders in motion.

        Args:
            psi: their own crank angles (rad) or e^{i psi}, shape (samples,) or one row each.
            lam, eps: crank radius and offset over rod length, shape (cylinders or 1, *trailing).
        """

    def find_distinct(self, lam: Array, eps: Array) -> tuple[Linkage, Array, Array, Rows]:
        """The mechanisms that differ, their lam and eps, and which of them each cylinder has."""
        return self, lam, eps, slice(None)

    def find_distinct_harmonics(
        self, orders: ArrayLike, lam: Array, eps: Array, *, rod: bool, energy: bool
    ) -> tuple[Harmonics, Rows]:
        """Harmonics of the mechanisms that differ, and which of them each cylinder has.

        Accelerations are sampled as such, so that no order's error grows.

        Args:
            orders: whole, shape (orders,).
            lam, eps: shape (cylinders or 1, *trailing).
            rod, energy: whether the series of the rods, and of the kinetic energies, are wanted.
        """
        few, *mechanisms, which = self.find_distinct(lam, eps)
        return few._find_harmonics(orders, *mechanisms, rod=rod, energy=energy), which

    def _find_harmonics(
        self, orders: ArrayLike, lam: Array, eps: Array, *, rod: bool, energy: bool
    ) -> Harmonics:
        m = self._sample_revolution(lam, eps)
        shake = -m.acceleration_of_mass
        return Harmonics(
            piston=transform(-m.acceleration, orders, m.condition),
            rod=transform(m.spin_rate, orders, m.condition) if rod else NONE,
            kinetic=transform(m.velocity**2, orders, m.condition) if energy else NONE,
            rod_kinetic=transform(m.spin**2, orders, m.condition) if energy and rod else NONE,
            curve=Curve(
                along=transform(shake.real, orders),
                across=transform(shake.imag, orders),
                couple=transform(-m.swirl_rate, orders),
                kinetic=transform(m.energy, orders) if energy else NONE,
                momentum=m.swirl.mean(axis=-1),
            ),
            turns=float(self.turning),
        )

    def sample(
        self, figure: Callable[[Motion], Array], psi: Array, lam: Array, eps: Array
    ) -> Array:
        """A figure of the motion at crank angles that all cylinders share, by so many at a time
        that memory stays small.
        """
        count = max(len(self.mass), lam.size, eps.size)
        step = max(_AT_ONCE // count, 1)
        return np.concatenate(
            [figure(self.motion(psi[k : k + step], lam, eps)) for k in range(0, len(psi), step)],
            axis=-1,
        )

    def count_all_samples(self, lam: Array, eps: Array) -> tuple[int, int]:
        """How many mechanisms differ, and about how many samples of a revolution they take
        together.
        """
        few, *mechanisms, _ = self.find_distinct(lam, eps)
        lean = np.abs(few.sample(lambda m: m.lean, revolution(STEPS), *mechanisms)).max(axis=-1)
        return lean.size, lean.size * count_samples(lean.max(), 0.0)

    def find_highest_order(self, lam: Array, eps: Array) -> int:
        """The order beyond which nothing exceeds rounding errors."""
        few, *mechanisms, _ = self.find_distinct(lam, eps)
        return int(few._sample_revolution(*mechanisms).place.shape[-1]) // 2

    def _sample_revolution(self, lam: Array, eps: Array) -> Motion:
        """A revolution on as many points (a power of two) as leave neither alias nor tail above
        rounding.
        """
        count = FEWEST_SAMPLES
        while True:
            motion = self.motion(unit_circle(count), lam, eps)
            if count >= MOST_SAMPLES or _is_resolved(motion):
                return motion
            count *= 2


def revolution(count: int) -> Array:
    """Crank angles of so many samples."""
    return np.arange(count, dtype=float) * (2 * np.pi / count)


def _is_resolved(motion: Motion) -> bool:
    """Whether there are enough samples."""
    return (
        _ends_in_rounding(motion.acceleration, motion.condition)
        and _ends_in_rounding(motion.spin_rate, motion.condition)
        and _ends_in_rounding(motion.acceleration_of_mass)
    )


def _ends_in_rounding(samples: Array | Complex, condition: Array | float = 1.0) -> bool:
    """Whether the upper half of the spectrum holds rounding errors alone."""
    sizes = np.abs(np.fft.fft(samples, norm="forward"))
    count = samples.shape[-1]
    tails = sizes[..., count // 4 : -(count // 4)].max(axis=-1)
    rounding = np.maximum(amplify_rounding(samples, condition), 1.0)
    return bool(np.all(tails <= SAMPLING / 4 * rounding))

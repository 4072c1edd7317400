"""Mechanisms with masses on planar curves, sampled over a revolution: what articulated rods and
rotary engines share.

A plain slider-crank needs no more than its piston's motion along the cylinder's axis. Here another
mass moves on a closed curve `z(psi)` (complex, in crank radii, in the cylinder's frame): the
knuckle pin of an articulated rod, the piston of a cylinder that itself turns, or shares of it on
both. It adds two components of force, a moment of momentum and a kinetic energy, all of which are
harmonics of the crank angle like the others (`harmonics.Curve`).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .harmonics import (
    NONE,
    SAMPLING,
    Array,
    Curve,
    Harmonics,
    Rows,
    circle,
    from_samples,
    points,
    rounding,
)

STEPS = 1440  # crank angles that do not miss a lock
FEWEST_SAMPLES, MOST_SAMPLES = 64, 1 << 18
_AT_ONCE = 1 << 16  # cylinders x angles of figures by themselves


class Point(NamedTuple):
    """A closed curve with its derivatives, and the share of the mass that moves on it."""

    z: NDArray[np.complex128]
    z1: NDArray[np.complex128]
    z2: NDArray[np.complex128]
    share: Any = 1.0


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
    condition: Array | float = (
        1.0  # relative error of what the rod does, in roundings: near its lock they are amplified
    )

    def of(self, what: Callable[[Point], Any]) -> Any:
        """What unit mass does, shared out over its points."""
        return sum(p.share * what(p) for p in self.points)

    @property
    def velocity_of_mass(self) -> NDArray[np.complex128]:
        return self.of(lambda p: p.z1)

    @property
    def acceleration_of_mass(self) -> NDArray[np.complex128]:
        return self.of(lambda p: p.z2)

    @property
    def swirl(self) -> Array:
        """Moment of momentum."""
        return self.of(lambda p: (np.conj(p.z) * p.z1).imag)

    @property
    def swirl_rate(self) -> Array:
        return self.of(lambda p: (np.conj(p.z) * p.z2).imag)

    @property
    def energy(self) -> Array:
        """Twice the kinetic energy."""
        return self.of(lambda p: np.abs(p.z1) ** 2)

    @property
    def power(self) -> Array:
        """Half the derivative of that."""
        return self.of(lambda p: (np.conj(p.z1) * p.z2).real)


@dataclass(frozen=True)
class Linkage(ABC):
    """The mechanism of an engine whose cylinders are more than slider-cranks.

    Attributes:
        mass: what moves on each cylinder's curve, kg, shape (cylinders or 1, *trailing).
    """

    mass: Array
    turning: ClassVar[bool] = (
        False  # whether the cylinders, and so the rods, turn about a crank that stands still
    )

    @property
    @abstractmethod
    def figures(self) -> tuple[NDArray[Any], ...]:
        """What distinguishes the cylinders, each of shape (cylinders or 1, *trailing)."""

    @abstractmethod
    def motion(self, psi: Array, lam: Array, eps: Array) -> Motion:
        """The cylinders at their own crank angles psi, shape (samples,) or one row each, or at e^{i
        psi}; lam and eps as in `Cylinders`.
        """

    def distinct(self, lam: Array, eps: Array) -> tuple[Linkage, Array, Array, Rows]:
        """The mechanisms that differ, their lam and eps, and which of them each cylinder has."""
        return self, lam, eps, slice(None)

    def harmonics(
        self, orders: ArrayLike, lam: Array, eps: Array, *, rod: bool, energy: bool
    ) -> tuple[Harmonics, Rows]:
        """Those of the mechanisms that differ, for whole orders, and which of them each cylinder
        has; accelerations are sampled as such, so that no order's error grows.
        """
        few, *mechanisms, which = self.distinct(lam, eps)
        return few._harmonics(orders, *mechanisms, rod=rod, energy=energy), which

    def _harmonics(
        self, orders: ArrayLike, lam: Array, eps: Array, *, rod: bool, energy: bool
    ) -> Harmonics:
        m = self._sampled(lam, eps)
        shake = -m.acceleration_of_mass
        return Harmonics(
            piston=from_samples(-m.acceleration, orders, m.condition),
            rod=from_samples(m.spin_rate, orders, m.condition) if rod else NONE,
            kinetic=from_samples(m.velocity**2, orders, m.condition) if energy else NONE,
            rod_kinetic=from_samples(m.spin**2, orders, m.condition) if energy and rod else NONE,
            curve=Curve(
                along=from_samples(shake.real, orders),
                across=from_samples(shake.imag, orders),
                couple=from_samples(-m.swirl_rate, orders),
                kinetic=from_samples(m.energy, orders) if energy else NONE,
                momentum=m.swirl.mean(axis=-1),
            ),
            turns=float(self.turning),
        )

    def each(self, name: str, psi: Array, lam: Array, eps: Array) -> Array:
        """One figure of `Motion` at crank angles that all cylinders share, by so many at a time
        that memory stays small.
        """
        count = max(len(self.mass), lam.size, eps.size)
        step = max(_AT_ONCE // count, 1)
        return np.concatenate(
            [
                getattr(self.motion(psi[k : k + step], lam, eps), name)
                for k in range(0, len(psi), step)
            ],
            axis=-1,
        )

    def samples(self, lam: Array, eps: Array) -> tuple[int, int]:
        """How many mechanisms differ, and about how many samples of a revolution they take
        together.
        """
        few, *mechanisms, _ = self.distinct(lam, eps)
        lean = np.abs(few.each("lean", revolution(STEPS), *mechanisms)).max(axis=-1)
        return lean.size, lean.size * points(lean.max(), 0.0)

    def highest(self, lam: Array, eps: Array) -> int:
        """The order beyond which nothing exceeds rounding errors."""
        few, *mechanisms, _ = self.distinct(lam, eps)
        return int(few._sampled(*mechanisms).place.shape[-1]) // 2

    def _sampled(self, lam: Array, eps: Array) -> Motion:
        """A revolution on as many points (a power of two) as leave neither alias nor tail above
        rounding.
        """
        count = FEWEST_SAMPLES
        while True:
            motion = self.motion(circle(count), lam, eps)
            rod = (
                _resolved(samples, motion.condition)
                for samples in (motion.acceleration, motion.spin_rate)
            )
            if count >= MOST_SAMPLES or (all(rod) and _resolved(motion.acceleration_of_mass)):
                return motion
            count *= 2


def revolution(count: int) -> Array:
    """Crank angles of so many samples."""
    return np.arange(count, dtype=float) * (2 * np.pi / count)


def _resolved(samples: NDArray[Any], condition: Array | float = 1.0) -> bool:
    """Whether the upper half of the spectrum holds rounding errors alone."""
    sizes = np.abs(np.fft.fft(samples, norm="forward"))
    count = samples.shape[-1]
    tails = sizes[..., count // 4 : -(count // 4)].max(axis=-1)
    return bool(np.all(tails <= SAMPLING / 4 * np.maximum(rounding(samples, condition), 1.0)))

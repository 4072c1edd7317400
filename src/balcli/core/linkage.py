"""Mechanisms with masses on planar curves, sampled over a revolution: what articulated rods and rotary engines share.

A plain slider-crank needs no more than its piston's motion along the cylinder's axis. Here another mass moves on a closed
curve `z(psi)` (complex, in crank radii, in the cylinder's frame): the knuckle pin of an articulated rod, the piston of a
cylinder that itself turns. It adds two components of force, a moment of momentum and a kinetic energy, all of which are
harmonics of the crank angle like the others (`harmonics.Curve`).
"""
from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .harmonics import NONE, SAMPLING, Array, Curve, Harmonics, from_samples

FEWEST, MOST = 64, 1 << 18          # samples


class Motion(NamedTuple):
    """A mechanism in motion; each of shape (cylinders, *trailing, samples), lengths in crank radii."""

    lean: Array                         # sine of the rod's angle beta to the cylinder's axis
    place: Array                        # s of the piston along its axis
    velocity: Array                     # s'
    acceleration: Array                 # s''
    spin: Array                         # angular velocity of the rod, in the crank's sense
    spin_rate: Array
    z: NDArray[np.complex128]           # the mass on the curve, and its derivatives
    z1: NDArray[np.complex128]
    z2: NDArray[np.complex128]


@dataclass(frozen=True)
class Linkage(ABC):
    """The mechanism of an engine whose cylinders are more than slider-cranks.

    Attributes:
        mass: what moves on each cylinder's curve, kg, shape (cylinders or 1, *trailing).
    """

    mass: Array

    @abstractmethod
    def motion(self, psi: Array, lam: Array, eps: Array) -> Motion:
        """The cylinders at their own crank angles psi, shape (samples,) or one row each; lam and eps as in `Cylinders`."""

    def harmonics(self, orders: ArrayLike, lam: Array, eps: Array, *, rod: bool = True, energy: bool = True) -> Harmonics:
        """Harmonics of all cylinders for whole orders; accelerations are sampled as such, so that no order's error grows."""
        m = self._sampled(lam, eps)
        swirl = np.conj(m.z) * m.z1
        return Harmonics(
            piston=from_samples(-m.acceleration, orders),
            rod=from_samples(m.spin_rate, orders) if rod else NONE,
            kinetic=from_samples(m.velocity**2, orders) if energy else NONE,
            rod_kinetic=from_samples(m.spin**2, orders) if energy and rod else NONE,
            curve=Curve(
                along=from_samples(-m.z2.real, orders),
                across=from_samples(-m.z2.imag, orders),
                couple=from_samples(-(np.conj(m.z) * m.z2).imag, orders),
                kinetic=from_samples(np.abs(m.z1) ** 2, orders) if energy else NONE,
                momentum=swirl.imag.mean(axis=-1)),
            turns=m.spin.mean(axis=-1))

    def highest(self, lam: Array, eps: Array) -> int:
        """The order beyond which nothing exceeds rounding errors."""
        return int(self._sampled(lam, eps).z.shape[-1]) // 2

    def _sampled(self, lam: Array, eps: Array) -> Motion:
        """A revolution on as many points (a power of two) as leave neither alias nor tail above rounding."""
        count = FEWEST
        while True:
            motion = self.motion(revolution(count), lam, eps)
            if count >= MOST or all(map(_resolved, (motion.acceleration, motion.spin_rate, motion.z2))):
                return motion
            count *= 2


def revolution(count: int) -> Array:
    """Crank angles of so many samples."""
    return np.arange(count, dtype=float) * (2 * np.pi / count)


def _resolved(samples: NDArray[np.generic]) -> bool:
    """Whether the upper half of the spectrum holds rounding errors alone."""
    sizes = np.abs(np.fft.fft(samples, norm="forward"))
    count = samples.shape[-1]
    return bool(sizes[..., count // 4:-(count // 4)].max() <= SAMPLING / 4 * max(sizes.max(), 1.0))

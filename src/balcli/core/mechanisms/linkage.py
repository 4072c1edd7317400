"""Mechanisms with masses on planar curves: what articulated rods and rotary engines share.

A plain slider-crank needs no more than its piston's motion along the cylinder's axis. Here another
mass moves on a closed curve `z(psi)` (complex, in crank radii, in the cylinder's frame): the
knuckle pin of an articulated rod, the piston of a cylinder that itself turns, or shares of it on
both. It adds two components of force, a moment of momentum and a kinetic energy, all of which are
harmonics of the crank angle like the others (`fourier.Curve`), sampled over a revolution.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Collection
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..phasors import Array, Complex
from .fourier import Harmonics, Rows
from .harmonics import Distinct, count_samples, find_distinct
from .motion import Motion
from .sampled import Sampled, sample_mechanisms

STEPS = 1440  # crank angles that do not miss a lock
_FEWEST_SAMPLES = 32
_AT_ONCE = 1 << 16  # cylinders x angles of figures by themselves
_SHARPEST = frozenset({"piston", "rod", "along", "across"})  # series that decay the slowest


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
    def move(self, psi: Array | Complex, *figures: NDArray[Any]) -> Motion:
        """Mechanisms in motion.

        Args:
            psi: their own crank angles (rad) or e^{i psi}, shape (samples,) or one row each.
            figures: as `figures` gives them, with a last axis of length 1 for the samples; or
                without, where the samples are the first axis of psi.
        """

    def motion(self, psi: Array | Complex, lam: Array, eps: Array) -> Motion:
        """The cylinders in motion.

        Args:
            psi: their own crank angles (rad) or e^{i psi}, shape (samples,) or one row each.
            lam, eps: crank radius and offset over rod length, shape (cylinders or 1, *trailing).
        """
        return self.move(psi, *(values[..., None] for values in self.figures(lam, eps)))

    def find_distinct_harmonics(
        self, orders: ArrayLike, lam: Array, eps: Array, wanted: Collection[str]
    ) -> tuple[Harmonics, Rows]:
        """Harmonics of the mechanisms that differ, and which of them each cylinder has.

        Args:
            orders: whole, shape (orders,).
            lam, eps: shape (cylinders or 1, *trailing).
            wanted: names of series (`fourier.SERIES`).
        """
        few = find_distinct(*self.figures(lam, eps))
        highest = float(np.max(orders, initial=0))
        return self._sample(few, orders, wanted, highest).series, few.which

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
        """How many mechanisms differ, and about how many samples of a revolution all take."""
        count = len(find_distinct(*self.figures(lam, eps)).figures[0])
        leans = self.sample(lambda motion: motion.lean, revolution(STEPS), lam, eps)
        return count, count * int(count_samples(float(np.abs(leans).max()), 0.0))

    def find_highest_order(self, lam: Array, eps: Array) -> int:
        """The order beyond which nothing exceeds rounding errors."""
        found = self._sample(find_distinct(*self.figures(lam, eps)), [], _SHARPEST, np.inf)
        return int(found.counts.max()) // 2

    def _sample(
        self, few: Distinct, orders: ArrayLike, wanted: Collection[str], highest: float
    ) -> Sampled:
        counts = np.full(len(few.figures[0]), _FEWEST_SAMPLES)
        return sample_mechanisms(orders, wanted, self.move, few.figures, counts, highest)


def revolution(count: int) -> Array:
    """Crank angles of so many samples."""
    return np.arange(count, dtype=float) * (2 * np.pi / count)

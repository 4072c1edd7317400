"""Mechanisms in motion: what moves in a cylinder along the crank angle, each figure worked out when
it is first asked for.

All figures have the shape (*mechanisms, samples), lengths are in crank radii; rates are derivatives
with respect to the crank angle.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from functools import cached_property, reduce
from operator import add
from typing import TypeAlias

import numpy as np

from ..phasors import Array, Complex, Figure


class PointMass(ABC):
    """A mass on a closed curve `z(psi)`, complex, x along the cylinder's axis.

    Attributes:
        share: of the mass on curves that moves on this one.
    """

    share: Figure = 1.0

    @property
    @abstractmethod
    def z(self) -> Complex:
        """The curve."""

    @property
    @abstractmethod
    def z1(self) -> Complex:
        """Its derivative."""

    @property
    @abstractmethod
    def z2(self) -> Complex:
        """Its second derivative."""


class Motion(ABC):
    """Pistons, rods and masses on curves of mechanisms in motion.

    Attributes:
        points: where the masses on curves are; none in a plain slider-crank.
    """

    points: tuple[PointMass, ...] = ()

    @property
    @abstractmethod
    def lean(self) -> Array:
        """Sine of the rod's angle beta to the cylinder's axis."""

    @property
    @abstractmethod
    def place(self) -> Array:
        """s of the piston along its axis, from the crank's axis."""

    @property
    @abstractmethod
    def velocity(self) -> Array:
        """s'"""

    @property
    @abstractmethod
    def acceleration(self) -> Array:
        """s''"""

    @property
    @abstractmethod
    def spin(self) -> Array:
        """Angular velocity of the rod, in the crank's sense."""

    @property
    @abstractmethod
    def spin_rate(self) -> Array:
        """Derivative of `spin`."""

    @property
    def condition(self) -> Array | float:
        """Relative error of piston and rod, in roundings: large near a lock."""
        return 1.0

    # -------------------------------------------------------------- unit mass on its points
    @property
    def velocity_of_mass(self) -> Complex:
        """Of unit mass on its points, likewise all that follows."""
        return reduce(add, (p.share * p.z1 for p in self.points))

    @cached_property
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


Move: TypeAlias = Callable[..., Motion]  # of e^{i psi} and figures that tell mechanisms apart

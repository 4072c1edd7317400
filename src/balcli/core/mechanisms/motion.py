"""Compute the motion of a rod and its piston. The lower end of the rod is on a moving pin. Each
figure is computed when it is first used.

All figures have the shape (*mechanisms, samples). Lengths are in crank radii; rates are derivatives
by the crank angle. Let z be the place of the rod's lower end (complex, x along the cylinder's
axis), s the distance of the piston pin from the crank's axis along the cylinder, and beta the rod's
angle to the cylinder's axis. `lam` is crank radius / rod length, `eps` offset / rod length. Then
`sin beta = lam Im z - eps`, and

    s = Re z + cos beta/lam
    s' = Re z' - tan beta Im z'
    beta' = lam Im z'/cos beta
    s'' = Re z'' - tan beta Im z'' - beta' Im z'/cos^2 beta
    beta'' = lam Im z''/cos beta + beta'^2 tan beta
"""

from collections.abc import Callable
from functools import cached_property
from typing import NamedTuple, TypeAlias

import numpy as np

from ..phasors import Array, Complex, Figure, Numbers

_NONE: Numbers = np.zeros(())  # sum over no masses


class PointMass(NamedTuple):
    """A mass on a closed curve (complex, x along the cylinder's axis).

    Attributes:
        z: Position on the curve, over the crank angle.
        z1: First derivative of the curve by the crank angle.
        z2: Second derivative of the curve by the crank angle.
        share: Share of the linkage's mass that moves on this curve.
    """

    z: Complex
    z1: Complex
    z2: Complex
    share: Figure = 1.0


class Motion:
    """Motion of mechanisms: of their pistons, their rods and their masses on curves.

    Args:
        pin: Lower ends of the rods.
        lam: Crank radius over rod length.
        lean: Sine of the rods' angle beta to the cylinders' axes.
        cosine: Cosine of the rods' angle beta.
        points: Masses on curves; empty for plain slider-cranks.
        condition: Relative error of the motion of piston and rod, as a multiple of one rounding
            error; large close to locking.
    """

    def __init__(
        self,
        pin: PointMass,
        lam: Array,
        lean: Array,
        cosine: Array,
        points: tuple[PointMass, ...] = (),
        condition: Array | float = 1.0,
    ) -> None:
        self.pin = pin
        self._lam = lam
        self.cosine = cosine
        self._tangent = lean / cosine
        self.lean = lean
        self.points = points
        self.condition = condition

    @cached_property
    def place(self) -> Array:
        """Distance s of the piston pin from the crank's axis along the cylinder, in crank radii."""
        return np.asarray(self.pin.z.real + self.cosine / self._lam)

    @cached_property
    def velocity(self) -> Array:
        """Derivative s' of the piston pin's distance by the crank angle, in crank radii."""
        return np.asarray(self.pin.z1.real - self._tangent * self.pin.z1.imag)

    @cached_property
    def acceleration(self) -> Array:
        """Second derivative s'' of the piston pin's distance by the crank angle, in crank radii."""
        straight = self.pin.z2.real - self._tangent * self.pin.z2.imag
        return np.asarray(straight - self._rate * self.pin.z1.imag / self.cosine**2)

    @cached_property
    def _rate(self) -> Array:
        """Derivative beta' of the rod's angle by the crank angle."""
        return np.asarray(self._lam * self.pin.z1.imag / self.cosine)

    @property
    def spin(self) -> Array:
        """Angular velocity of the rod at crank speed 1, positive in the direction in which the
        crank turns.
        """
        return -self._rate

    @property
    def spin_rate(self) -> Array:
        """Derivative of `spin` by the crank angle."""
        bend = self._lam * self.pin.z2.imag / self.cosine
        return np.asarray(-(bend + self._rate**2 * self._tangent))

    # -------------------------------------------------------------- unit mass on the curves
    @property
    def velocity_of_mass(self) -> Complex:
        """Momentum of unit mass on the curves; the figures below are for unit mass as well."""
        return sum((p.share * p.z1 for p in self.points), _NONE)

    @cached_property
    def acceleration_of_mass(self) -> Complex:
        """Derivative of `velocity_of_mass` by the crank angle."""
        return sum((p.share * p.z2 for p in self.points), _NONE)

    @property
    def swirl(self) -> Array:
        """Moment of momentum about the crank's axis."""
        return sum((p.share * (np.conj(p.z) * p.z1).imag for p in self.points), _NONE)

    @property
    def swirl_rate(self) -> Array:
        """Derivative of `swirl` by the crank angle."""
        return sum((p.share * (np.conj(p.z) * p.z2).imag for p in self.points), _NONE)

    @property
    def energy(self) -> Array:
        """Twice the kinetic energy."""
        return sum((p.share * np.abs(p.z1) ** 2 for p in self.points), _NONE)

    @property
    def power(self) -> Array:
        """Half the derivative of `energy`."""
        return sum((p.share * (np.conj(p.z1) * p.z2).real for p in self.points), _NONE)


Move: TypeAlias = Callable[..., Motion]  # from e^{i psi} and figures of mechanisms

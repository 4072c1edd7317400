"""Fourier series of a mechanism over a revolution of its crank, with bounds of their errors.

Every function of the crank angle psi is written `Re sum c_n e^{i n psi}`, so a cosine series has
real and a sine series imaginary coefficients. All is for one crank of radius 1 turning at speed 1.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from ..phasors import Array, Complex

Rows: TypeAlias = NDArray[np.intp]  # the mechanism of each cylinder, by its number


@dataclass(frozen=True, eq=False)
class Series:
    """Coefficients of a Fourier series, of many mechanisms side by side.

    Attributes:
        c: shape (orders, cylinders, *trailing), or (orders, any axes); real for cosines alone.
        noise: bound of their error, which broadcasts to `c`; 0 where it is some ulp of each.
    """

    c: Array | Complex
    noise: Array | float = 0.0
    __array_ufunc__ = None  # array * series is ours to answer

    def __add__(self, other: Series) -> Series:
        return Series(self.c + other.c, self.noise + other.noise)

    def __rmul__(self, factor: Array) -> Series:
        return Series(factor * self.c, abs(factor) * self.noise)

    def select_orders(self, rows: slice) -> Series:
        """Return the orders in these rows."""
        return self if self is NONE else Series(self.c[rows], self.noise)

    def select_cylinders(self, which: Rows) -> Series:
        """Return the mechanisms with these numbers."""
        if self is NONE:
            return self
        noise = self.noise if np.ndim(self.noise) == 0 else np.asarray(self.noise)[which]
        return Series(self.c[:, which], noise)


NONE = Series(np.zeros((1, 1)))  # a series that is not wanted


class Curve(NamedTuple):
    """Series of unit mass on a closed curve z(psi) (complex, crank radii, x along the cylinder)."""

    along: Series  # -Re z''
    across: Series  # -Im z''
    couple: Series  # -Im(conj(z) z''): minus the rate of its moment of momentum
    energy: Series  # |z'|^2
    swirl: Series  # Im(conj(z) z'): moment of momentum


class Harmonics(NamedTuple):
    """The Fourier series of a mechanism, or of many; those that are not wanted are `NONE`."""

    piston: Series  # -s''/r: acceleration towards the crank
    rod: Series  # -beta'': angular acceleration of the rod, in the crank's sense
    kinetic: Series  # (s'/r)^2
    rod_kinetic: Series  # beta'^2
    curve: Curve | None = None  # of a further mass that moves in the plane, where there is one
    turns: float = 0.0  # of the rod for each of the crank

    def select_orders(self, rows: slice) -> Harmonics:
        """Return the orders in these rows."""
        return self._change_each(lambda series: series.select_orders(rows))

    def select_cylinders(self, which: Rows) -> Harmonics:
        """Return the mechanisms with these numbers."""
        return self._change_each(lambda series: series.select_cylinders(which))

    def _change_each(self, change: Callable[[Series], Series]) -> Harmonics:
        curve = self.curve and Curve(*map(change, self.curve))
        own = change(self.piston), change(self.rod), change(self.kinetic), change(self.rod_kinetic)
        return Harmonics(*own, curve, self.turns)


# Names of all series, as they are asked for.
SERIES = frozenset(
    {"piston", "rod", "kinetic", "rod_kinetic", "along", "across", "couple", "energy", "swirl"}
)

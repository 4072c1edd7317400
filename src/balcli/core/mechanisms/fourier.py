"""Fourier series of a mechanism over a revolution of its crank, with bounds of their errors.

Every function of the crank angle psi is written `Re sum c_n e^{i n psi}`, so a cosine series has
real and a sine series imaginary coefficients. All is for one crank of radius 1 turning at speed 1.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

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


# Series of a mechanism, or of many, by name:
#   piston: -s''/r, acceleration towards the crank
#   rod: -beta'', angular acceleration of the rod, in the crank's sense
#   kinetic, rod_kinetic: (s'/r)^2 and beta'^2
# and of unit mass on a closed curve z(psi) (complex, crank radii, x along the cylinder):
#   along, across: -Re z'' and -Im z''
#   couple: -Im(conj(z) z''), minus the rate of its moment of momentum
#   energy: |z'|^2
#   swirl: Im(conj(z) z'), moment of momentum
Harmonics: TypeAlias = dict[str, Series]
SERIES = frozenset(
    {"piston", "rod", "kinetic", "rod_kinetic", "along", "across", "couple", "energy", "swirl"}
)


def select_orders(harmonics: Harmonics, rows: slice) -> Harmonics:
    """Return the orders in these rows."""
    return {name: Series(series.c[rows], series.noise) for name, series in harmonics.items()}


def select_cylinders(harmonics: Harmonics, which: Rows) -> Harmonics:
    """Return the series of the mechanisms with these numbers."""

    def select(noise: Array | float) -> Array | float:
        return noise if np.ndim(noise) == 0 else np.asarray(noise)[which]

    return {name: Series(s.c[:, which], select(s.noise)) for name, s in harmonics.items()}

"""Fourier coefficients of the centred slider-crank in closed form.

With `w = sqrt((1 - lam)(1 + lam))` and `x = lam/(1 + w)`, the rod angle beta obeys

    cos beta = |1 + x^2 e^{2 i psi}| / (1 + x^2) = (1 + w)/2 [c_0 + 2 sum c_m cos 2 m psi]
    c_m = binom(1/2, m) x^2m F(-1/2, m - 1/2; m + 1; x^4)        (Gauss's function F)

and every other coefficient is a combination of these (docs/theory.md):

    -s''/r = cos psi + sum A_n cos n psi
    A_n = n^2 c_{n/2} / x
    -beta'' = sum D_n sin n psi
    D_n = n lam (1 + w)/2 [(n+2) c_{(n+1)/2} - (n-2) c_{(n-1)/2}]
    (s'/r)^2 = sum K_n cos n psi
    K_n = [(n+1) c_{(n+1)/2} - (n-1) c_{(n-1)/2}] / x for odd n
    K_n = S_n for even n, but K_2 = S_2 - 1
    (beta'/lam)^2 = (cos psi/cos beta)^2 = sum S_n cos n psi, a geometric series

Signs of c_m alternate from m = 1 on, and all terms of F after the first have the same sign, so
there is no cancellation. The relative error of order n is about n roundings, like that of x^n.

`Series` are Fourier series of a mechanism over a revolution of its crank, with bounds of their
errors. Every function of the crank angle psi is written `Re sum c_n e^{i n psi}`, so a cosine
series has real and a sine series imaginary coefficients. Crank radius and crank speed are 1.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..phasors import EPS, Array, Complex

Rows: TypeAlias = NDArray[np.intp]  # index of the mechanism of each cylinder


@dataclass(frozen=True, eq=False)
class Series:
    """Coefficients of a Fourier series for many mechanisms side by side.

    Attributes:
        c: Coefficients, shape (orders, cylinders, *trailing) or (orders, *any axes); real for a
            series of cosines.
        noise: Bound of the absolute error of the coefficients; it broadcasts to `c`. 0 means that
            the error is a few ulp of each coefficient.
    """

    c: Array | Complex
    noise: Array | float = 0.0
    __array_ufunc__ = None  # array * series calls our __rmul__

    def __add__(self, other: Series) -> Series:
        return Series(self.c + other.c, self.noise + other.noise)

    def __rmul__(self, factor: Array) -> Series:
        return Series(factor * self.c, abs(factor) * self.noise)


# Names of the series of one or many mechanisms:
#   piston: -s''/r, acceleration towards the crank
#   rod: -beta'', angular acceleration of the rod, positive in the crank's direction of rotation
#   kinetic, rod_kinetic: (s'/r)^2 and beta'^2
# and for unit mass on a closed curve z(psi) (complex, in crank radii, x along the cylinder):
#   along, across: -Re z'' and -Im z''
#   couple: -Im(conj(z) z''), minus the rate of the moment of momentum
#   energy: |z'|^2
#   swirl: Im(conj(z) z'), moment of momentum
Harmonics: TypeAlias = dict[str, Series]
SERIES = frozenset(
    {"piston", "rod", "kinetic", "rod_kinetic", "along", "across", "couple", "energy", "swirl"}
)


def select_cylinders(harmonics: Harmonics, which: Rows, orders: slice = slice(None)) -> Harmonics:
    """Return the series of each cylinder's mechanism.

    Args:
        harmonics: Series by name, shape (orders, mechanisms).
        which: Index of the mechanism of each cylinder.
        orders: Rows of the wanted orders.
    """
    return {
        name: Series(s.c[orders][:, which], np.broadcast_to(s.noise, s.c.shape[1:])[which])
        for name, s in harmonics.items()
    }


def find_harmonics(
    orders: ArrayLike, lam: ArrayLike, wanted: Collection[str] = SERIES
) -> Harmonics:
    """Return Fourier series of centred slider-cranks, coefficients of shape (orders, *lam.shape).

    Args:
        orders: shape (orders,), not negative, at most about 4096; orders that are not whole have
            coefficients 0.
        lam: crank radius over rod length, from 0 (harmonic motion) to 1, any shape.
        wanted: names of series: piston (A_n), rod (D_n, as -i D_n), kinetic (K_n), rod_kinetic
            (lam^2 S_n).
    """
    lam = np.asarray(lam, float)
    n = np.asarray(orders, float).reshape(-1, *(1,) * lam.ndim)
    w = np.sqrt((1 - lam) * (1 + lam))
    x = lam / (1 + w)
    by_x = np.where(x == 0, 1.0, x)  # harmonic motion has lam = 0, and no terms divided by x
    cosine = _expand_cosine(int(n.max(initial=0)) // 2 + 2, x)

    def take(step: int) -> Array:
        """Return c_{(n + step)/2}; 0 if its index is not whole."""
        m = (n.ravel() + step) / 2
        return cosine[np.where(m % 1 == 0, m, -1).astype(np.intp)]  # the last row holds zeros

    even = np.where(n % 4 == 2, 2.0, -2.0) * w / (1 + w) ** 2 * x ** np.maximum(n - 2, 0)
    square = np.where(n == 0, 1 / (1 + w), np.where(n % 2 == 0, even, 0.0))  # S_n
    coefficients: dict[str, Array | Complex] = {"rod_kinetic": lam**2 * square}
    if "piston" in wanted:
        coefficients["piston"] = (n == 1) + n**2 * take(0) / by_x
    if "rod" in wanted:
        coefficients["rod"] = -0.5j * n * lam * (1 + w) * ((n + 2) * take(1) - (n - 2) * take(-1))
    if "kinetic" in wanted:
        odd = ((n + 1) * take(1) - (n - 1) * take(-1)) / by_x
        coefficients["kinetic"] = odd + square - (n == 2)
    return {name: Series(c) for name, c in coefficients.items() if name in wanted}


def _expand_cosine(count: int, x: Array) -> Array:
    """Return c_m for m = 0 .. count-1 and a row of zeros, shape (count + 1, *x.shape)."""
    m = np.arange(float(count)).reshape(-1, *(1,) * x.ndim)
    binomials = np.cumprod(np.where(m == 0, 1.0, 1.5 / np.maximum(m, 1) - 1), axis=0)
    z = x**4
    gauss = np.ones((count, *x.shape))
    terms = 1 + int(np.log(EPS / 64) / np.log(z.max(initial=1e-99)))  # the rest is rounding
    for j in range(terms, 0, -1):  # Horner's rule
        gauss *= (m + (j - 1.5)) / (m + j) * ((j - 1.5) / j * z)
        gauss += 1
    gauss *= binomials * x ** (2 * m)
    return np.concatenate([gauss, np.zeros((1, *x.shape))])


def piston(orders: ArrayLike, lam: ArrayLike) -> Array:
    """Return the coefficients A_n of the piston acceleration, `-s''/r = sum A_n cos n psi`, shape
    (orders, *lam).

    Args:
        orders: Orders n.
        lam: Crank radius / rod length, any shape.
    """
    return np.asarray(find_harmonics(orders, lam, ["piston"])["piston"].c, float)


def rod(orders: ArrayLike, lam: ArrayLike) -> Array:
    """Return the coefficients D_n of the rod's angular acceleration, `-beta'' = sum D_n sin n psi`,
    shape (orders, *lam).

    Args:
        orders: Orders n.
        lam: Crank radius / rod length, any shape.
    """
    return -find_harmonics(orders, lam, ["rod"])["rod"].c.imag

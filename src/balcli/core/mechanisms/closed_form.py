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
    K_n = [(n+1) c_{(n+1)/2} - (n-1) c_{(n-1)/2}] / x for odd n, S_n - (n = 2) for even n
    (beta'/lam)^2 = (cos psi/cos beta)^2 = sum S_n cos n psi, a geometric series

Signs of c_m alternate from m = 1 on, and all terms of F after the first have one sign, so that
nothing cancels. The relative error of order n is about n roundings: that of x^n.
"""

from __future__ import annotations

from collections.abc import Collection

import numpy as np
from numpy.typing import ArrayLike

from ..phasors import EPS, Array
from .fourier import NONE, SERIES, Harmonics, Series


class ClosedForm:
    """Fourier coefficients of centred slider-cranks, each of shape (orders, *lam.shape).

    Args:
        orders: shape (orders,), not negative, at most 4096 or so; orders that are not whole have
            coefficients 0.
        lam: crank radius over rod length, between 0 and 1, any shape.
    """

    def __init__(self, orders: ArrayLike, lam: ArrayLike) -> None:
        self._lam = np.asarray(lam, float)
        self._n = np.asarray(orders, float).reshape(-1, *(1,) * self._lam.ndim)
        self._w = np.sqrt((1 - self._lam) * (1 + self._lam))
        self._x = self._lam / (1 + self._w)
        self._cosine = _expand_cosine(int(self._n.max(initial=0)) // 2 + 2, self._x)

    def piston(self) -> Array:
        """Coefficients A_n of the piston acceleration, `-s''/r = sum A_n cos n psi`."""
        return (self._n == 1) + self._n**2 * self._c(0) / self._x

    def rod(self) -> Array:
        """Coefficients D_n of the rod's angular acceleration, `-beta'' = sum D_n sin n psi`."""
        n = self._n
        difference = (n + 2) * self._c(1) - (n - 2) * self._c(-1)
        return n * self._lam * (1 + self._w) / 2 * difference

    def kinetic(self) -> Array:
        """Coefficients K_n of the squared piston velocity, `(s'/r)^2 = sum K_n cos n psi`."""
        n = self._n
        odd = ((n + 1) * self._c(1) - (n - 1) * self._c(-1)) / self._x
        return odd + self._square() - (n == 2)

    def rod_kinetic(self) -> Array:
        """Coefficients B_n of the squared rod speed, `beta'^2 = sum B_n cos n psi`."""
        return self._lam**2 * self._square()

    def _c(self, step: int) -> Array:
        """Return c_{(n + step)/2}, 0 where its index is not whole."""
        m = (self._n.ravel() + step) / 2
        whole = m % 1 == 0
        rows = np.where(whole, m, -1).astype(np.intp)  # the last row holds zeros
        return self._cosine[rows]

    def _square(self) -> Array:
        """Return S_n."""
        n, w = self._n, self._w
        even = np.where(n % 4 == 2, 2.0, -2.0) * w / (1 + w) ** 2 * self._x ** np.maximum(n - 2, 0)
        return np.where(n == 0, 1 / (1 + w), np.where(n % 2 == 0, even, 0.0))


def _expand_cosine(count: int, x: Array) -> Array:
    """Return c_m for m = 0 .. count-1 and a row of zeros, shape (count + 1, *x.shape)."""
    m = np.arange(float(count)).reshape(-1, *(1,) * x.ndim)
    binomials = np.cumprod(np.where(m == 0, 1.0, 1.5 / np.maximum(m, 1) - 1), axis=0)
    z = x**4
    gauss = np.ones((count, *x.shape))
    for j in range(_count_terms(z), 0, -1):  # Horner's rule
        gauss *= (m + (j - 1.5)) / (m + j) * ((j - 1.5) / j * z)
        gauss += 1
    gauss *= binomials * x ** (2 * m)
    return np.concatenate([gauss, np.zeros((1, *x.shape))])


def _count_terms(z: Array) -> int:
    """Return after how many powers of z < 1 the next is below rounding."""
    return 1 + int(np.log(EPS / 64) / np.log(z.max(initial=1e-99)))


def piston(orders: ArrayLike, lam: ArrayLike) -> Array:
    """Return A_n (`ClosedForm.piston`)."""
    return ClosedForm(orders, lam).piston()


def rod(orders: ArrayLike, lam: ArrayLike) -> Array:
    """Return D_n (`ClosedForm.rod`)."""
    return ClosedForm(orders, lam).rod()


def kinetic(orders: ArrayLike, lam: ArrayLike) -> Array:
    """Return K_n (`ClosedForm.kinetic`)."""
    return ClosedForm(orders, lam).kinetic()


def rod_kinetic(orders: ArrayLike, lam: ArrayLike) -> Array:
    """Return B_n (`ClosedForm.rod_kinetic`)."""
    return ClosedForm(orders, lam).rod_kinetic()


def find_harmonics(
    orders: ArrayLike, lam: ArrayLike, wanted: Collection[str] = SERIES
) -> Harmonics:
    """Return the series in `wanted` (names of `fourier.SERIES`)."""
    of = ClosedForm(orders, lam)
    return Harmonics(
        piston=Series(of.piston()) if "piston" in wanted else NONE,
        rod=Series(np.asarray(-1j * of.rod(), complex)) if "rod" in wanted else NONE,
        kinetic=Series(of.kinetic()) if "kinetic" in wanted else NONE,
        rod_kinetic=Series(of.rod_kinetic()) if "rod_kinetic" in wanted else NONE,
    )

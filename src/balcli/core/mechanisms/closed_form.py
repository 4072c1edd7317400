"""Closed forms of the Fourier coefficients of the centred slider-crank, without cancellation.

They are good to about 1e-14 relative in every order and for every lambda in (0, 1). With `w =
cos(arcsin lambda)` and `x = tan(arcsin(lambda)/2)`,

    cos beta = (1+w)/2 |1 + x^2 e^{2 i psi}|

has a binomial series in powers of `x^2`, whose products are Gauss's functions `G_m(x^4)`, `G_m(z) =
F(-1/2, m-1/2; m+1; z)`. All coefficients are sums of two of their terms at most.

In every function `orders` have the shape (orders,), not negative and at most 4096 or so, and the
result has the shape (orders, *lam.shape); orders that are not whole have none.
"""

from __future__ import annotations

import math
from collections.abc import Collection
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..cached_property import cached_property
from ..phasors import EPS, Array, Figure
from .fourier import NONE, SERIES, Harmonics, Series

_AT_ONCE = 1 << 18  # factors of Gauss's functions that are kept in memory


def piston(orders: ArrayLike, lam: ArrayLike) -> Array:
    """A_n of `-s''/r = sum A_n cos n psi`: A_1 = 1, other odd orders 0.

    `A_2m = (2m)^2 binom(1/2, m) x^(2m-1) G_m`.
    """
    return _Ladder(orders, lam).piston()


def rod(orders: ArrayLike, lam: ArrayLike) -> Array:
    """D_k of `-beta'' = sum D_k sin k psi`; even orders 0.

    From `-beta'' = lambda w^2 sin psi / cos^3 beta`; Euler's transformation turns the series of
    `cos^-3 beta` into that of `cos beta`: `D_k = lambda (1+w)/2 (f_(k-1)/2 - f_(k+1)/2)`, `f_m =
    binom(-3/2, m) x^2m G_m`. The f alternate: no cancellation.
    """
    return _Ladder(orders, lam).rod()


def kinetic(orders: ArrayLike, lam: ArrayLike) -> Array:
    """K_n of `(s'/r)^2 = sum K_n cos n psi`.

    Odd orders are the product of `sin psi` with the even part of s': `K_n = A_(n+1)/(n+1) -
    A_(n-1)/(n-1)`; even ones are `cos^2 psi / cos^2 beta - cos 2 psi`, a geometric series.
    """
    return _Ladder(orders, lam).kinetic()


def rod_kinetic(orders: ArrayLike, lam: ArrayLike) -> Array:
    """B_n of `beta'^2 = sum B_n cos n psi` (`= (lambda cos psi / cos beta)^2`); odd orders 0."""
    return _Ladder(orders, lam).rod_kinetic()


def find_harmonics(
    orders: ArrayLike, lam: ArrayLike, wanted: Collection[str] = SERIES
) -> Harmonics:
    """These coefficients, as far as they are wanted (`fourier.SERIES`)."""
    ladder = _Ladder(orders, lam)
    return Harmonics(
        piston=Series(ladder.piston()) if "piston" in wanted else NONE,
        rod=Series(np.asarray(-1j * ladder.rod(), complex)) if "rod" in wanted else NONE,
        kinetic=Series(ladder.kinetic()) if "kinetic" in wanted else NONE,
        rod_kinetic=Series(ladder.rod_kinetic()) if "rod_kinetic" in wanted else NONE,
    )


class _Ladder:
    """The terms of which all coefficients are made, for m = 0 .. (highest order)/2 + 1 as rungs.

    `x` as computed is off by some ulp, which the 2m-th power would multiply; one Newton step on
    `lambda (1 + x^2) = 2x`, with the residual in twice the working precision, gives that error
    (`slip`), and powers are corrected for it. A single lambda is a plain float here, which is
    quicker than numpy's arrays.
    """

    def __init__(self, orders: ArrayLike, lam: ArrayLike) -> None:
        n, ratio = np.asarray(orders, float), np.asarray(lam, float)
        self._rows = n.astype(np.intp)
        self._known = _numbers(int(self._rows.max(initial=0)) // 2 + 2, ratio.ndim)
        self._rows[self._rows != n] = -1
        self._lam: Figure = ratio.item() if ratio.size == 1 else ratio
        self._w: Figure = _root((1 - self._lam) * (1 + self._lam))
        x = self._lam / (1 + self._w)
        slip = _residual(self._lam, x) / (2 * self._w * x)
        self._x = x * (1 + slip)
        twice = self._known.twice
        self._power = x**twice * (1 + twice * slip)  # x^2m, a few ulp for any m
        self._terms = self._power * _gauss(self._known.m, x**4 * (1 + 4 * slip))

    def piston(self) -> Array:
        return self._of_orders(self._known.twice * self._over_order, self._known.first)

    def rod(self) -> Array:
        f = self._known.minus_three_halves * self._terms
        return self._of_orders(0.0, self._lam * (1 + self._w) / 2 * (f[:-1] - f[1:]))

    def kinetic(self) -> Array:
        even, a = self._square.copy(), self._over_order
        even[1] = -(1 + self._w**2) / (1 + self._w) ** 2
        return self._of_orders(even, a[1:] - a[:-1])

    def rod_kinetic(self) -> Array:
        return self._of_orders(self._lam**2 * self._square, 0.0)

    @cached_property
    def _over_order(self) -> Array:
        """A_2m / 2m"""
        return self._known.one_half * self._terms / self._x

    @cached_property
    def _square(self) -> Array:
        """Coefficients of `cos^2 psi / cos^2 beta` of even orders: 1/(1+w), then `2w/(1+w)^2
        (-1)^(m-1) x^(2m-2)`.
        """
        square = np.empty_like(self._power)
        square[0] = 1 / (1 + self._w)
        lead = 2 * self._w / (1 + self._w) ** 2
        square[1:] = self._known.sign * (lead * self._power[:-1])
        return square

    def _of_orders(self, even: Array | float, odd: Array | float) -> Array:
        """The rows wanted of coefficients of even orders (every rung) and odd ones (all but the
        last); orders that are not whole have the last row, of zeros.
        """
        dense = np.zeros((2 * len(self._power), *self._power.shape[1:]))
        dense[:-1:2] = even
        dense[1:-1:2] = odd
        return dense[self._rows]


class _Numbers(NamedTuple):
    """What no lambda changes, for m = 0, 1 .. as a column; `sign` and `first` are shorter by 1."""

    m: Array
    twice: Array  # 2m
    one_half: Array  # 2m binom(1/2, m)
    minus_three_halves: Array  # binom(-3/2, m)
    sign: Array  # 1, -1, 1 ..
    first: Array  # 1, 0, 0 ..


@lru_cache(maxsize=16)
def _numbers(count: int, axes: int) -> _Numbers:
    """The numbers of so many rungs, columns before so many axes of lambda."""
    m = np.arange(float(count))
    half, minus = _binomials(count)
    sign, first = 1 - 2 * (m[:-1] % 2), (m[:-1] == 0).astype(float)
    columns = m, 2 * m, 2 * m * half, minus, sign, first
    return _Numbers(*(column.reshape(-1, *(1,) * axes) for column in columns))


def _binomials(count: int) -> tuple[Array, Array]:
    """binom(1/2, m) and binom(-3/2, m) for m = 0 .. count-1, each correctly rounded."""
    half, minus = np.empty(count), np.empty(count)
    middle = 1  # binom(2m, m), exactly
    for m in range(count):
        half[m] = -((-1) ** m) * middle / ((2 * m - 1) << 2 * m)
        minus[m] = (-1) ** m * (2 * m + 1) * middle / (1 << 2 * m)
        middle = middle * 2 * (2 * m + 1) // (m + 1)
    return half, minus


def _gauss(m: Array, z: Figure) -> Array:
    """Gauss's `F(-1/2, m-1/2; m+1; z)` for m as a column, shape (m, *z.shape): of one z as
    the sum of its terms, of several by Horner's rule.

    All terms after the first have one sign, and each is less than z times the one before.
    """
    largest = max(z if isinstance(z, float) else float(z.max(initial=0.0)), 1e-300)
    terms = 1 + int(math.log(EPS / 64) / math.log(largest))
    step = max(_AT_ONCE // len(m), 1)
    if isinstance(z, float) and terms <= step:  # few calls instead of two a term
        coefficients, powers = _coefficients(terms, m.shape)
        return np.asarray(np.add.reduce(coefficients * z**powers))
    total: Figure = 1.0
    for last in range(terms, 0, -step):
        for ratio in _ratios(last, max(last - step, 0), m.shape):
            factor = ratio * z
            factor *= total
            factor += 1.0
            total = factor
    return np.asarray(total)


@lru_cache(maxsize=8)
def _coefficients(terms: int, shape: tuple[int, ...]) -> tuple[Array, Array]:
    """Those of the powers of z in G_m, and these powers as a column, the highest (the smallest
    term) first, shape (terms + 1, *shape of the column m).
    """
    ratios = _ratios(terms, 0, shape)
    ascending = np.cumprod(np.concatenate([np.ones((1, *shape)), ratios[::-1]]), axis=0)
    powers = np.arange(float(terms), -1.0, -1.0).reshape(-1, *(1,) * len(shape))
    return ascending[::-1].copy(), powers


@lru_cache(maxsize=8)
def _ratios(last: int, before: int, shape: tuple[int, ...]) -> Array:
    """What makes each coefficient of G_m from the one before, the last term first and down to
    `before` (without it), shape (terms, *shape of the column m).
    """
    m = np.arange(float(shape[0])).reshape(shape)
    j = np.arange(last, before, -1.0).reshape(-1, *(1,) * m.ndim)
    return (j - 1.5) / j * ((m + j - 1.5) / (m + j))


def _root(square: Figure) -> Figure:
    return math.sqrt(square) if isinstance(square, float) else np.sqrt(square)


def _residual(lam: Figure, x: Figure) -> Figure:
    """`lambda (1 + x^2) - 2x = lambda - x (2 - lambda x)` to twice the working precision."""
    p, p_low = _product(lam, x)
    s = 2 - p
    s_low = (2 - s) - p - p_low
    t, t_low = _product(x, s)
    return (lam - t) - t_low - x * s_low


def _product(a: Figure, b: Figure) -> tuple[Figure, Figure]:
    """a b as an unevaluated sum of two floats (Dekker's product)."""
    p = a * b
    a_high, a_low = _split(a)
    b_high, b_low = _split(b)
    return p, ((a_high * b_high - p) + a_high * b_low + a_low * b_high) + a_low * b_low


def _split(a: Figure) -> tuple[Figure, Figure]:
    """The upper and the lower half of the digits."""
    c = 134217729.0 * a  # 2^27 + 1
    high = c - (c - a)
    return high, a - high

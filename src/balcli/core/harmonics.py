"""Fourier coefficients of the slider-crank mechanism, for one crank of radius 1 turning at speed 1.

Every function of the crank angle psi is written `Re sum c_n e^{i n psi}`, so a cosine series has real and a sine series
imaginary coefficients. Centred mechanisms have closed forms without cancellation, good to about 1e-14 *relative* in every
order and for every lambda in (0, 1); offset ones are sampled, which is good to about 1e-16 *absolute*.
"""
from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import comb

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import slidercrank

Array = NDArray[np.float64]
EPS = float(np.finfo(float).eps)


@dataclass(frozen=True)
class Series:
    """Coefficients c_n, shape (orders, cylinders or any axes), and their own error bound, which broadcasts to it (0: some ulp)."""

    c: NDArray[np.complex128]
    noise: Array | float = 0.0
    __array_ufunc__ = None              # array * series is ours to answer

    def __add__(self, other: Series) -> Series:
        return Series(self.c + other.c, self.noise + other.noise)

    def __rmul__(self, factor: Array) -> Series:
        return Series(factor * self.c, np.abs(factor) * self.noise)


@dataclass(frozen=True)
class Curve:
    """What unit mass does on a closed curve z(psi) (complex, in crank radii, x along the cylinder's axis)."""

    along: Series                       # -Re z''
    across: Series                      # -Im z''
    couple: Series                      # -Im(conj(z) z''): minus the rate of its moment of momentum
    kinetic: Series                     # |z'|^2
    momentum: Array                     # mean of Im(conj(z) z'), shape (cylinders, *trailing)


@dataclass(frozen=True)
class Harmonics:
    """The Fourier series of a mechanism (or many); those of rod and energy may be left out."""

    piston: Series                      # -s''/r: acceleration towards the crank
    rod: Series                         # -beta'': angular acceleration of the rod, in the crank's sense
    kinetic: Series                     # (s'/r)^2
    rod_kinetic: Series                 # beta'^2
    curve: Curve | None = None          # of a further mass, where a mechanism has one that moves in the plane
    turns: Array | float = 0.0          # of the rod for each of the crank


NONE = Series(np.zeros((1, 1), complex))


def of(orders: ArrayLike, lam: Array, eps: Array, *, rod: bool = True, energy: bool = True) -> Harmonics:
    """Harmonics of mechanisms by lambda and offset ratio, shapes (cylinders, *trailing); equal ones are computed once.

    Raises nothing: that every mechanism turns (`lambda + |eps| < 1`) is the caller's to see to.
    """
    if lam.ndim > 1 or lam.size * eps.size == 1:
        return _of_distinct(orders, lam, eps, rod=rod, energy=energy)
    both = np.stack(np.broadcast_arrays(lam, eps))
    distinct, which = np.unique(both, axis=1, return_inverse=True)
    each = [_of_distinct(orders, *pair, rod=rod, energy=energy) for pair in distinct.T[:, :, None]]

    def gather(name: str) -> Series:
        series: list[Series] = [getattr(one, name) for one in each]
        noise = np.concatenate([np.broadcast_to(s.noise, s.c.shape[1:]) for s in series])
        return Series(np.concatenate([s.c for s in series], axis=1)[:, which], noise[which])
    return Harmonics(gather("piston"), gather("rod"), gather("kinetic"), gather("rod_kinetic"))


def _of_distinct(orders: ArrayLike, lam: Array, eps: Array, *, rod: bool, energy: bool) -> Harmonics:
    return sampled(orders, lam, eps, rod=rod, energy=energy) if np.any(eps) else centred(orders, lam, rod=rod, energy=energy)


# ------------------------------------------------------------------ centred: closed form
def piston(orders: ArrayLike, lam: ArrayLike) -> Array:
    """A_n of `-s''/r = sum A_n cos n psi`, shape (orders, *lam.shape): A_1 = 1, other odd orders 0.

    `A_2m = (2m)^2 binom(1/2, m) x^(2m-1) G_m`, x = tan(arcsin(lambda)/2); see `_Modulus`.
    """
    return _piston(*_column(orders, lam))


def rod(orders: ArrayLike, lam: ArrayLike) -> Array:
    """D_k of `-beta'' = sum D_k sin k psi`, shape (orders, *lam.shape), even orders 0.

    From `-beta'' = lambda w^2 sin psi / cos^3 beta`; Euler's transformation turns the series of `cos^-3 beta` into that of
    `cos beta`: `D_k = lambda (1+w)/2 (f_(k-1)/2 - f_(k+1)/2)`, `f_m = binom(-3/2, m) x^2m G_m`. The f alternate: no cancellation.
    """
    return _rod(*_column(orders, lam))


def kinetic(orders: ArrayLike, lam: ArrayLike) -> Array:
    """K_n of `(s'/r)^2 = sum K_n cos n psi`, shape (orders, *lam.shape).

    Odd orders are the product of `sin psi` with the even part of s': `K_n = A_(n+1)/(n+1) - A_(n-1)/(n-1)`; even ones are
    `cos^2 psi / cos^2 beta - cos 2 psi`, a geometric series.
    """
    return _kinetic(*_column(orders, lam))


def rod_kinetic(orders: ArrayLike, lam: ArrayLike) -> Array:
    """B_n of `beta'^2 = sum B_n cos n psi` (`= (lambda cos psi / cos beta)^2`), shape (orders, *lam.shape), odd orders 0."""
    n, q = _column(orders, lam)
    return q.lam**2 * _square(n, q)


def centred(orders: ArrayLike, lam: ArrayLike, *, rod: bool = True, energy: bool = True) -> Harmonics:
    """All coefficients of centred mechanisms for orders >= 0, each of shape (orders, *lam.shape)."""
    n, q = _column(orders, lam)
    return Harmonics(
        piston=Series(_piston(n, q) + 0j),
        rod=Series(-1j * _rod(n, q)) if rod else NONE,
        kinetic=Series(_kinetic(n, q) + 0j) if energy else NONE,
        rod_kinetic=Series(q.lam**2 * _square(n, q) + 0j) if energy and rod else NONE,
    )


class _Modulus:
    """What all series share: `x = tan(arcsin(lambda)/2)`, `w = cos(arcsin lambda)`, powers of x and the functions G_m.

    x is the nome-like argument in which `cos beta = (1+w)/2 |1 + x^2 e^{2 i psi}|` has its binomial series. `x` as computed
    is off by some ulp, which the 2m-th power would multiply; one Newton step on `lambda (1 + x^2) = 2x`, with the residual in
    twice the working precision, gives that error (`slip`), and powers are corrected for it.
    """

    def __init__(self, lam: Array, highest: int) -> None:
        self.lam = lam
        self.w = np.sqrt((1 - lam) * (1 + lam))
        self.x = lam / (1 + self.w)
        self.slip = _residual(lam, self.x) / (2 * self.w * self.x)
        self.G = _G(highest, self.x**4 * (1 + 4 * self.slip))

    def power(self, n: Array | int) -> Array:
        """x^n, relative error of a few ulp for any n."""
        raised: Array = self.x**n * (1 + n * self.slip)
        return raised


def _column(orders: ArrayLike, lam: ArrayLike) -> tuple[Array, _Modulus]:
    """Orders as a column before the axes of lambda."""
    ratio = np.asarray(lam, float)
    n = np.asarray(orders, float)
    return n.reshape(-1, *(1,) * ratio.ndim), _Modulus(ratio, int(n.max(initial=0)) // 2 + 1)


def _piston(n: Array, q: _Modulus) -> Array:
    even = (n % 2 == 0) & (n > 0)
    m = np.where(even, n, 2) / 2
    value = (2 * m) ** 2 * _take(_binomials(q.G.shape[0])[0], m) * q.power(2 * m - 1) * _take(q.G, m)
    return np.where(even, value, n == 1)


def _rod(n: Array, q: _Modulus) -> Array:
    odd = n % 2 == 1
    m = (np.where(odd, n, 1) - 1) / 2
    binomial = _binomials(q.G.shape[0])[1]

    def f(m: Array) -> Array:
        return _take(binomial, m) * q.power(2 * m) * _take(q.G, m)
    return np.where(odd, q.lam * (1 + q.w) / 2 * (f(m) - f(m + 1)), 0)


def _kinetic(n: Array, q: _Modulus) -> Array:
    below, above = np.where(n > 1, n - 1, 1), n + 1
    odd = _piston(above, q) / above - np.where(n > 1, _piston(below, q) / below, 0)
    even = np.where(n == 2, -(1 + q.w**2) / (1 + q.w) ** 2, _square(n, q))
    return np.where(n % 2 == 1, odd, even)


def _square(n: Array, q: _Modulus) -> Array:
    """Coefficients of `cos^2 psi / cos^2 beta`."""
    even = n % 2 == 0
    m = np.where(even & (n > 0), n, 2) / 2
    value = 2 * q.w / (1 + q.w) ** 2 * (1 - 2 * ((m - 1) % 2)) * q.power(2 * m - 2)
    return np.where(even, np.where(n > 0, value, 1 / (1 + q.w)), 0)


def _take(table: Array, m: Array) -> Array:
    """Rows of a table by the orders of a column."""
    rows: Array = table[m.astype(int).ravel()]
    return rows.reshape(-1, *(m.shape[1:] if rows.ndim < m.ndim or rows.ndim == 1 else rows.shape[1:]))


@lru_cache(maxsize=32)
def _binomials(count: int) -> tuple[Array, Array]:
    """binom(1/2, m) and binom(-3/2, m) for m = 0 .. count-1, each correctly rounded."""
    half = [-(-1) ** m * comb(2 * m, m) / (4**m * (2 * m - 1)) for m in range(count)]
    minus = [(-1) ** m * (2 * m + 1) * comb(2 * m, m) / 4**m for m in range(count)]
    return np.array(half), np.array(minus)


def _G(highest: int, z: Array) -> Array:
    """Gauss's `F(-1/2, m-1/2; m+1; z)` for m = 0 .. highest, shape (highest+1, *z.shape), by Horner's rule.

    All terms after the first have one sign, and each is less than z times the one before.
    """
    largest = float(z.max(initial=0.0))
    terms = 2 + int(np.log(EPS / 64) / np.log(max(largest, 1e-300)))
    m = np.arange(highest + 1.0).reshape(-1, *(1,) * z.ndim)
    total = np.ones((highest + 1, *z.shape))
    for j in range(terms, 0, -1):
        total = 1 + (j - 1.5) / j * ((m + j - 1.5) / (m + j)) * z * total
    return total


def _residual(lam: Array, x: Array) -> Array:
    """`lambda (1 + x^2) - 2x = lambda - x (2 - lambda x)` to twice the working precision."""
    p, p_low = _product(lam, x)
    s = 2 - p
    s_low = (2 - s) - p - p_low
    t, t_low = _product(x, s)
    return (lam - t) - t_low - x * s_low


def _product(a: Array, b: Array) -> tuple[Array, Array]:
    """a b as an unevaluated sum of two floats (Dekker's product)."""
    p = a * b
    a_high, a_low = _split(a)
    b_high, b_low = _split(b)
    return p, ((a_high * b_high - p) + a_high * b_low + a_low * b_high) + a_low * b_low


def _split(a: Array) -> tuple[Array, Array]:
    c = 134217729.0 * a                     # 2^27 + 1
    high = c - (c - a)
    return high, a - high


# ------------------------------------------------------------------ offset: sampled
def sampled(orders: ArrayLike, lam: Array, eps: Array, *, rod: bool = True, energy: bool = True) -> Harmonics:
    """The same for offset mechanisms, whole orders, from one revolution of samples; lam and eps are broadcast.

    Accelerations are sampled as such, not differentiated, so that no order's error grows.
    """
    psi = np.arange(count := points(lam, eps)) * (2 * np.pi / count)
    arguments = psi, np.asarray(lam)[..., None], np.asarray(eps)[..., None]
    return Harmonics(
        piston=from_samples(slidercrank.acceleration(*arguments), orders),
        rod=from_samples(-slidercrank.rod_acceleration(*arguments), orders) if rod else NONE,
        kinetic=from_samples(slidercrank.velocity(*arguments) ** 2, orders) if energy else NONE,
        rod_kinetic=from_samples(slidercrank.rod_rate(*arguments) ** 2, orders) if energy and rod else NONE,
    )


SAMPLING = 16 * EPS         # error of a sampled coefficient, in units of the largest


def from_samples(samples: Array, orders: ArrayLike) -> Series:
    """Coefficients of whole orders from one revolution of samples (last axis), shape (orders, *the other axes)."""
    n, count = np.asarray(orders), samples.shape[-1]
    spectrum = np.moveaxis(np.fft.rfft(samples) / count, -1, 0)
    spectrum[1:] *= 2
    inside = (n % 1 == 0) & (n < count // 2)
    rows = spectrum[np.where(inside, n, 0).astype(int)]
    c = np.where(inside.reshape(-1, *(1,) * (rows.ndim - 1)), rows, 0)
    return Series(c, SAMPLING * np.abs(spectrum).max(axis=0))


def points(lam: ArrayLike, eps: ArrayLike) -> int:
    """Number of samples (a power of two) that leaves neither alias nor tail above rounding in any of these mechanisms.

    Coefficients decay like `x^n`, x = tan(arcsin(lambda')/2), `lambda' = lambda / (1 - |eps|)`.
    """
    steep = np.minimum(np.max(np.asarray(lam) / (1 - np.abs(eps))), 1 - EPS)
    decay = -np.log(steep / (1 + np.sqrt((1 - steep) * (1 + steep))))
    return 1 << int(np.ceil(np.log2(max(-2.4 * np.log(EPS) / decay, 16))))

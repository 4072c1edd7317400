"""Fourier coefficients of the slider-crank mechanism, for one crank of radius 1 turning at speed 1.

Every function of the crank angle psi is written `Re sum c_n e^{i n psi}`, so a cosine series has
real and a sine series imaginary coefficients. Centred mechanisms have closed forms without
cancellation, good to about 1e-14 *relative* in every order and for every lambda in (0, 1); offset
ones are sampled, which is good to about 1e-16 *absolute*.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[Any]
Rows: TypeAlias = NDArray[np.intp] | slice
EPS = float(np.finfo(float).eps)
HARDEST = 1 << 16  # samples of a revolution that a mechanism takes at 1 - 1e-6 of its lock
CLOSED_FORM = 4096  # highest order of closed forms; only mechanisms near their lock have more
_AT_ONCE = 1 << 18  # factors of Gauss's functions that are kept in memory


@dataclass(frozen=True, eq=False)
class Series:
    """Coefficients c_n (real: of cosines alone), shape (orders, cylinders or any axes), and their
    own error bound, which broadcasts to it (0: some ulp).
    """

    c: Array
    noise: Array | float = 0.0
    __array_ufunc__ = None  # array * series is ours to answer

    def __add__(self, other: Series) -> Series:
        return Series(self.c + other.c, self.noise + other.noise)

    def of_orders(self, which: slice) -> Series:
        """Those of the orders in these rows; what is left out has none."""
        return self if self is NONE else Series(self.c[which], self.noise)

    def of_rows(self, which: NDArray[np.intp]) -> Series:
        """Those of these cylinders; a single row stands for all."""
        if self.c.shape[1] == 1:
            return self
        return Series(self.c[:, which], np.broadcast_to(self.noise, self.c.shape[1:])[which])

    def __rmul__(self, factor: Array) -> Series:
        return Series(factor * self.c, abs(factor) * self.noise)


class Curve(NamedTuple):
    """What unit mass does on a closed curve z(psi) (complex, in crank radii, x along the cylinder's
    axis).
    """

    along: Series  # -Re z''
    across: Series  # -Im z''
    couple: Series  # -Im(conj(z) z''): minus the rate of its moment of momentum
    kinetic: Series  # |z'|^2
    momentum: Array  # mean of Im(conj(z) z'), shape (cylinders, *trailing)


class Harmonics(NamedTuple):
    """The Fourier series of a mechanism (or many); those of rod and energy may be left out."""

    piston: Series  # -s''/r: acceleration towards the crank
    rod: Series  # -beta'': angular acceleration of the rod, in the crank's sense
    kinetic: Series  # (s'/r)^2
    rod_kinetic: Series  # beta'^2
    curve: Curve | None = (
        None  # of a further mass, where a mechanism has one that moves in the plane
    )
    turns: float = 0.0  # of the rod for each of the crank

    def of_orders(self, which: slice) -> Harmonics:
        """Of the orders in these rows."""
        return self._each(lambda series: series.of_orders(which))

    def of_rows(self, which: Rows) -> Harmonics:
        """With the mechanisms of these rows."""
        if isinstance(which, slice):
            return self
        chosen = self._each(lambda series: series.of_rows(which))
        curve = chosen.curve and chosen.curve._replace(momentum=chosen.curve.momentum[which])
        return chosen._replace(curve=curve)

    def _each(self, change: Callable[[Series], Series]) -> Harmonics:
        """With every series changed."""
        c = self.curve
        return Harmonics(
            change(self.piston),
            change(self.rod),
            change(self.kinetic),
            change(self.rod_kinetic),
            c
            and Curve(
                change(c.along), change(c.across), change(c.couple), change(c.kinetic), c.momentum
            ),
            self.turns,
        )


NONE = Series(np.zeros((1, 1)))  # what is left out


def of(
    orders: ArrayLike, lam: Array, eps: Array, *, rod: bool = True, energy: bool = True
) -> Harmonics:
    """Harmonics of mechanisms by lambda and offset ratio, shapes (cylinders, *trailing).

    Raises nothing: that every mechanism turns (`lambda + |eps| < 1`) is the caller's to see to.
    """
    few, which = of_distinct(orders, lam, eps, rod=rod, energy=energy)
    return few.of_rows(which)


def of_distinct(
    orders: ArrayLike, lam: Array, eps: Array, *, rod: bool, energy: bool
) -> tuple[Harmonics, Rows]:
    """Those of the mechanisms that differ, and which of them each cylinder has."""
    if lam.ndim > 1 or lam.size * eps.size == 1:
        return _of_all(orders, lam, eps, rod=rod, energy=energy), slice(None)
    pairs, which = distinct(lam, eps)
    each = [_of_all(orders, *np.array([pair]).T, rod=rod, energy=energy) for pair in pairs]

    def gather(name: str) -> Series:
        series: list[Series] = [getattr(one, name) for one in each]
        if series[0] is NONE:
            return NONE
        noise = np.concatenate([np.broadcast_to(s.noise, s.c.shape[1:]) for s in series])
        return Series(np.concatenate([s.c for s in series], axis=1), noise)

    return Harmonics(
        gather("piston"), gather("rod"), gather("kinetic"), gather("rod_kinetic")
    ), which


def samples(lam: Array, eps: Array) -> tuple[int, int]:
    """How many mechanisms differ, and how many samples of a revolution they take together."""
    pairs, _ = distinct(lam, eps)
    return len(pairs), sum(points(*pair) for pair in pairs)


def distinct(lam: Array, eps: Array) -> tuple[list[tuple[float, float]], NDArray[np.intp]]:
    """(lambda, eps) of the mechanisms that differ, of shapes (cylinders or 1,), and which of them
    each cylinder has.
    """
    pairs = list(zip(*(v.tolist() for v in np.broadcast_arrays(lam, eps)), strict=True))
    place = {pair: k for k, pair in enumerate(dict.fromkeys(pairs))}
    return list(place), np.array([place[pair] for pair in pairs])


def _of_all(orders: ArrayLike, lam: Array, eps: Array, *, rod: bool, energy: bool) -> Harmonics:
    if np.count_nonzero(eps) or np.max(orders, initial=0) > CLOSED_FORM:
        return sampled(orders, lam, eps, rod=rod, energy=energy)
    if lam.size == 1:
        return _of_one(np.asarray(orders, float).tobytes(), lam.item(), lam.shape, rod, energy)
    return centred(orders, lam, rod=rod, energy=energy)


@lru_cache(maxsize=64)
def _of_one(
    orders: bytes, lam: float, shape: tuple[int, ...], rod: bool, energy: bool
) -> Harmonics:
    """Those of one mechanism, kept: sizing and analysing an engine ask for the same again and
    again.
    """
    return centred(np.frombuffer(orders), np.full(shape, lam), rod=rod, energy=energy)


# ------------------------------------------------------------------ centred: closed form
def piston(orders: ArrayLike, lam: ArrayLike) -> Array:
    """A_n of `-s''/r = sum A_n cos n psi`, shape (orders, *lam.shape): A_1 = 1, other odd orders 0.

    `A_2m = (2m)^2 binom(1/2, m) x^(2m-1) G_m`, x = tan(arcsin(lambda)/2); see `_Ladder`.
    """
    return _Ladder(orders, lam).piston()


def rod(orders: ArrayLike, lam: ArrayLike) -> Array:
    """D_k of `-beta'' = sum D_k sin k psi`, shape (orders, *lam.shape), even orders 0.

    From `-beta'' = lambda w^2 sin psi / cos^3 beta`; Euler's transformation turns the series of
    `cos^-3 beta` into that of `cos beta`: `D_k = lambda (1+w)/2 (f_(k-1)/2 - f_(k+1)/2)`, `f_m =
    binom(-3/2, m) x^2m G_m`. The f alternate: no cancellation.
    """
    return _Ladder(orders, lam).rod()


def kinetic(orders: ArrayLike, lam: ArrayLike) -> Array:
    """K_n of `(s'/r)^2 = sum K_n cos n psi`, shape (orders, *lam.shape).

    Odd orders are the product of `sin psi` with the even part of s': `K_n = A_(n+1)/(n+1) -
    A_(n-1)/(n-1)`; even ones are `cos^2 psi / cos^2 beta - cos 2 psi`, a geometric series.
    """
    return _Ladder(orders, lam).kinetic()


def rod_kinetic(orders: ArrayLike, lam: ArrayLike) -> Array:
    """B_n of `beta'^2 = sum B_n cos n psi` (`= (lambda cos psi / cos beta)^2`), shape (orders,
    *lam.shape), odd orders 0.
    """
    return _Ladder(orders, lam).rod_kinetic()


def centred(
    orders: ArrayLike, lam: ArrayLike, *, rod: bool = True, energy: bool = True
) -> Harmonics:
    """All coefficients of centred mechanisms for orders >= 0, each of shape (orders,
    *lam.shape).
    """
    ladder = _Ladder(orders, lam)
    return Harmonics(
        piston=Series(ladder.piston()),
        rod=Series(-1j * ladder.rod()) if rod else NONE,
        kinetic=Series(ladder.kinetic()) if energy else NONE,
        rod_kinetic=Series(ladder.rod_kinetic()) if energy and rod else NONE,
    )


class _Ladder:
    """The terms of which all series are made, for m = 0 .. (highest order)/2 + 1.

    With `w = cos(arcsin lambda)` and `x = tan(arcsin(lambda)/2)`, `cos beta = (1+w)/2 |1 + x^2 e^{2
    i psi}|` has its binomial series in powers of x^2, with Gauss's functions `G_m(x^4)`. `x` as
    computed is off by some ulp, which the 2m-th power would multiply; one Newton step on `lambda (1
    + x^2) = 2x`, with the residual in twice the working precision, gives that error (`slip`), and
    powers are corrected for it. A single lambda is a plain float here, which is quicker than
    numpy's arrays.
    """

    def __init__(self, orders: ArrayLike, lam: ArrayLike) -> None:
        ratio = np.asarray(lam, float)
        self._rows = _rows(np.asarray(orders, float).tobytes(), ratio.ndim)
        self._lam: Any = ratio.item() if ratio.size == 1 else ratio
        sqrt: Any = math.sqrt if ratio.size == 1 else np.sqrt
        self._w = sqrt((1 - self._lam) * (1 + self._lam))
        x = self._lam / (1 + self._w)
        slip = _residual(self._lam, x) / (2 * self._w * x)
        self._x = x * (1 + slip)
        twice = 2 * self._rows.m
        self._power = x**twice * (1 + twice * slip)  # x^2m, a few ulp for any m
        self._gauss = self._power * _G(self._rows.m, x**4 * (1 + 4 * slip))

    def piston(self) -> Array:
        rows = self._rows
        return rows.n_if_even * self._over_order[rows.half] + rows.first

    def rod(self) -> Array:
        rows = self._rows
        f = rows.minus_three_halves * self._gauss
        return rows.odd * (self._lam * (1 + self._w) / 2 * (f[rows.half] - f[rows.half_up]))

    def kinetic(self) -> Array:
        rows, a = self._rows, self._over_order
        odd = rows.odd * (a[rows.half_up] - a[rows.half])
        return odd + np.where(rows.second, -(1 + self._w**2) / (1 + self._w) ** 2, self._square)

    def rod_kinetic(self) -> Array:
        return self._lam**2 * self._square

    @cached_property
    def _over_order(self) -> Array:
        """A_2m / 2m"""
        return self._rows.one_half * self._gauss / self._x

    @cached_property
    def _square(self) -> Array:
        """Coefficients of `cos^2 psi / cos^2 beta` by order: 1/(1+w), then `2w/(1+w)^2 (-1)^(m-1)
        x^(2m-2)`.
        """
        rows, lead = self._rows, 2 * self._w / (1 + self._w) ** 2
        return rows.sign_if_even * (lead * self._power[rows.half_down]) + rows.zeroth / (
            1 + self._w
        )


class _Rows(NamedTuple):
    """What the series need of the orders alone, columns before the axes of lambda."""

    half: NDArray[np.intp]  # rows of the ladder: n/2 or (n-1)/2, the next one, the one before
    half_up: NDArray[np.intp]
    half_down: NDArray[np.intp]
    n_if_even: Array
    sign_if_even: Array  # (-1)^(m-1) for n = 2m > 0
    odd: NDArray[np.bool_]
    zeroth: NDArray[np.bool_]
    first: NDArray[np.bool_]
    second: NDArray[np.bool_]
    m: Array  # the ladder
    one_half: Array  # 2m binom(1/2, m)
    minus_three_halves: Array  # binom(-3/2, m)


@lru_cache(maxsize=64)
def _rows(orders: bytes, axes: int) -> _Rows:
    def column(values: ArrayLike) -> Array:
        return np.asarray(values).reshape(-1, *(1,) * axes)

    n = np.frombuffer(orders)
    even, half = (n % 2 == 0) & (n > 0), (n // 2).astype(int)
    m = np.arange(half.max(initial=0) + 2)
    one_half, minus = _binomials(len(m))
    signs = column(np.where(even, 2 * (half % 2) - 1, 0))
    return _Rows(
        half,
        half + 1,
        np.maximum(half - 1, 0),
        column(np.where(even, n, 0)),
        signs,
        *map(
            column, (n % 2 == 1, n == 0, n == 1, n == 2, m.astype(float), 2 * m * one_half, minus)
        ),
    )


def _binomials(count: int) -> tuple[Array, Array]:
    """binom(1/2, m) and binom(-3/2, m) for m = 0 .. count-1, each correctly rounded."""
    half, minus, middle = np.empty(count), np.empty(count), 1  # middle: binom(2m, m), exactly
    for m in range(count):
        half[m] = -((-1) ** m) * middle / ((2 * m - 1) << 2 * m)
        minus[m] = (-1) ** m * (2 * m + 1) * middle / (1 << 2 * m)
        middle = middle * 2 * (2 * m + 1) // (m + 1)
    return half, minus


def _G(m: Array, z: Any) -> Any:
    """Gauss's `F(-1/2, m-1/2; m+1; z)` for m = 0, 1 .. as a column, shape (m, *z.shape), by
    Horner's rule.

    All terms after the first have one sign, and each is less than z times the one before.
    """
    single = isinstance(z, float)
    largest = max(z if single else z.max(initial=0.0), 1e-300)
    terms = 1 + int(math.log(EPS / 64) / math.log(largest))
    most = max(_AT_ONCE // len(m), 1)
    total: Any = 1.0
    for last in range(terms, 0, -most):
        ratios = _ratios(last, max(last - most, 0), m.shape)
        for ratio in ratios * z if single else (ratio * z for ratio in ratios):
            total = 1 + ratio * total
    return total


@lru_cache(maxsize=8)
def _ratios(last: int, before: int, shape: tuple[int, ...]) -> Array:
    """What makes each coefficient of G_m from the one before, the last term first and down to
    `before` (without it), shape (terms, *shape of the column m).
    """
    m = np.arange(float(shape[0])).reshape(shape)
    j = np.arange(last, before, -1.0).reshape(-1, *(1,) * m.ndim)
    return (j - 1.5) / j * ((m + j - 1.5) / (m + j))


def _residual(lam: Any, x: Any) -> Any:
    """`lambda (1 + x^2) - 2x = lambda - x (2 - lambda x)` to twice the working precision."""
    p, p_low = _product(lam, x)
    s = 2 - p
    s_low = (2 - s) - p - p_low
    t, t_low = _product(x, s)
    return (lam - t) - t_low - x * s_low


def _product(a: Any, b: Any) -> tuple[Any, Any]:
    """a b as an unevaluated sum of two floats (Dekker's product)."""
    p = a * b
    a_high, a_low = _split(a)
    b_high, b_low = _split(b)
    return p, ((a_high * b_high - p) + a_high * b_low + a_low * b_high) + a_low * b_low


def _split(a: Any) -> tuple[Any, Any]:
    c = 134217729.0 * a  # 2^27 + 1
    high = c - (c - a)
    return high, a - high


# ------------------------------------------------------------------ offset: sampled
def sampled(
    orders: ArrayLike, lam: Array, eps: Array, *, rod: bool = True, energy: bool = True
) -> Harmonics:
    """The same for offset mechanisms, whole orders, from one revolution of samples; lam and eps are
    broadcast.

    Accelerations are sampled as such, not differentiated, so that no order's error grows.
    """
    from . import slidercrank

    many = np.ndim(lam) > 1  # variants; of one engine an order is the same among any others
    count = points(lam, eps, np.max(orders, initial=0) if many else math.inf)
    arguments = circle(count), np.asarray(lam)[..., None], np.asarray(eps)[..., None]
    return Harmonics(
        piston=from_samples(slidercrank.acceleration(*arguments), orders),
        rod=from_samples(-slidercrank.rod_acceleration(*arguments), orders) if rod else NONE,
        kinetic=from_samples(slidercrank.velocity(*arguments) ** 2, orders) if energy else NONE,
        rod_kinetic=from_samples(slidercrank.rod_rate(*arguments) ** 2, orders)
        if energy and rod
        else NONE,
    )


SAMPLING = 16 * EPS  # error of a sampled coefficient, in units of the curve's root mean square


def circle(count: int) -> Array:
    """e^{i psi} at evenly spaced psi, each component within 2 ulp of itself: `np.exp` would round
    psi before.
    """
    from ..phasors import unit

    return unit(np.arange(count) * (360 / count))


def from_samples(samples: Array, orders: ArrayLike, condition: Array | float = 1.0) -> Series:
    """Coefficients of whole orders from one revolution of samples (last axis), shape (orders, *the
    other axes).

    `condition`: the error of each sample, relative and in roundings.
    """
    n, count = np.asarray(orders), samples.shape[-1]
    spectrum = np.moveaxis(np.fft.rfft(samples) / count, -1, 0)
    spectrum[1:] *= 2
    inside = (n % 1 == 0) & (n < count // 2)
    rows = spectrum[np.where(inside, n, 0).astype(int)]
    c = np.where(inside.reshape(-1, *(1,) * (rows.ndim - 1)), rows, 0)
    return Series(c, SAMPLING * rounding(samples, condition))


def rounding(samples: Array, condition: Array | float = 1.0) -> Array:
    """What one rounding of every sample does to a coefficient, in units of the rounding: root mean
    square of the samples and, where they are not good to some ulp, mean of what each is multiplied
    by.
    """
    spread = np.sqrt(2 * np.mean(np.abs(samples) ** 2, axis=-1))
    return (
        spread
        if np.isscalar(condition)
        else np.asarray(spread + np.mean(np.abs(samples) * condition, axis=-1))
    )


def points(lam: ArrayLike, eps: ArrayLike, highest: float = math.inf) -> int:
    """Number of samples (a power of two) that leaves no alias above rounding in orders up to the
    highest, nor a tail beyond it, in any of these mechanisms.

    Coefficients decay like `x^n`, x = tan(arcsin(lambda')/2), `lambda' = lambda / (1 - |eps|)`;
    order n of N samples is mixed with N - n.
    """
    steep = np.minimum(np.max(np.asarray(lam) / (1 - np.abs(eps))), 1 - EPS)
    decay = -np.log(steep / (1 + np.sqrt((1 - steep) * (1 + steep))))
    last = -1.2 * np.log(EPS) / decay  # the order beyond which all is rounding
    return 1 << int(np.ceil(np.log2(max(last + min(highest, last), 16))))

"""Fourier series of a mechanism over a revolution of its crank, with bounds of their errors.

Every function of the crank angle psi is written `Re sum c_n e^{i n psi}`, so a cosine series has
real and a sine series imaginary coefficients. All is for one crank of radius 1 turning at speed 1.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..phasors import EPS, Array, Complex, unit

Rows: TypeAlias = NDArray[np.intp]  # which of several mechanisms each cylinder has

SAMPLING = 16 * EPS  # error of a sampled coefficient, in units of the curve's root mean square


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
        """The orders in these rows; what is left out (`NONE`) has none."""
        return self if self is NONE else Series(self.c[rows], self.noise)

    def select_cylinders(self, which: Rows) -> Series:
        """The mechanisms with these numbers; what is left out (`NONE`) has none."""
        if self is NONE:
            return self
        if which.size == self.c.shape[1] and np.array_equal(which.ravel(), np.arange(which.size)):
            shape = np.shape(self.noise) and which.shape  # all, in their order
            return Series(self.c.reshape(-1, *which.shape), np.reshape(self.noise, shape))
        noise = self.noise if np.ndim(self.noise) == 0 else np.asarray(self.noise)[which]
        return Series(self.c[:, which], noise)


NONE = Series(np.zeros((1, 1)))  # what is left out


class Curve(NamedTuple):
    """What unit mass does on a closed curve z(psi) (complex, crank radii, x along the cylinder)."""

    along: Series  # -Re z''
    across: Series  # -Im z''
    couple: Series  # -Im(conj(z) z''): minus the rate of its moment of momentum
    energy: Series  # |z'|^2
    swirl: Series  # Im(conj(z) z'): moment of momentum


class Harmonics(NamedTuple):
    """The Fourier series of a mechanism, or of many; those that are not wanted are left out."""

    piston: Series  # -s''/r: acceleration towards the crank
    rod: Series  # -beta'': angular acceleration of the rod, in the crank's sense
    kinetic: Series  # (s'/r)^2
    rod_kinetic: Series  # beta'^2
    curve: Curve | None = None  # of a further mass that moves in the plane, where there is one
    turns: float = 0.0  # of the rod for each of the crank

    def select_orders(self, rows: slice) -> Harmonics:
        """The orders in these rows."""
        return self._change_each(lambda series: series.select_orders(rows))

    def select_cylinders(self, which: Rows) -> Harmonics:
        """The mechanisms with these numbers."""
        if which.shape == self.piston.c.shape[1:] == (1,):  # there is but one
            return self
        return self._change_each(lambda series: series.select_cylinders(which))

    def _change_each(self, change: Callable[[Series], Series]) -> Harmonics:
        curve = self.curve and Curve(*map(change, self.curve))
        own = change(self.piston), change(self.rod), change(self.kinetic), change(self.rod_kinetic)
        return Harmonics(*own, curve, self.turns)


# Names of all series, as they are asked for.
SERIES = frozenset(
    {"piston", "rod", "kinetic", "rod_kinetic", "along", "across", "couple", "energy", "swirl"}
)


def join_mechanisms(each: Sequence[Harmonics]) -> Harmonics:
    """Several mechanisms without curves side by side."""
    return Harmonics(
        _join([one.piston for one in each]),
        _join([one.rod for one in each]),
        _join([one.kinetic for one in each]),
        _join([one.rod_kinetic for one in each]),
    )


def _join(each: list[Series]) -> Series:
    if each[0] is NONE or len(each) == 1:
        return each[0]
    noises = [np.broadcast_to(series.noise, series.c.shape[1:]) for series in each]
    return Series(np.concatenate([series.c for series in each], axis=1), np.concatenate(noises))


# ------------------------------------------------------------------ from samples
def unit_circle(count: int) -> Complex:
    """e^{i psi} at so many evenly spaced psi, each component within 2 ulp of itself: `np.exp` would
    round psi before.
    """
    return unit(np.arange(count) * (360 / count))


def pick_orders(spectrum: Complex, orders: ArrayLike) -> Complex:
    """The coefficients of these orders in transforms (`rfft`) of revolutions, shape (*any axes,
    samples/2 + 1); order first. Orders that are not whole, or that samples do not show, are 0.
    """
    n, half = np.asarray(orders), spectrum.shape[-1] - 1
    inside = (n % 1 == 0) & (n < half)
    numbers = np.where(inside, n, 0).astype(int)
    scale = np.where(numbers == 0, 1, 2) * inside
    picked = spectrum[..., numbers] / (2 * half) * scale
    return np.moveaxis(picked, -1, 0)


def amplify_rounding(samples: Array, condition: Array | float = 1.0) -> Array:
    """What one rounding of every sample does to a coefficient, in units of the rounding.

    It is the root mean square of the samples and, where they are not good to some ulp, the mean of
    what each is multiplied by (`condition`). Shape of the samples without their last axis.
    """
    spread: Array = np.sqrt(2 * np.mean(samples**2, axis=-1))
    if np.ndim(condition) == 0:
        return spread
    return spread + np.mean(np.abs(samples) * condition, axis=-1)

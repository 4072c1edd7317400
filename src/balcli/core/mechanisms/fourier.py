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

Rows: TypeAlias = NDArray[np.intp] | slice  # which of several mechanisms each cylinder has

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

    def select_cylinders(self, which: NDArray[np.intp]) -> Series:
        """The mechanisms with these numbers; a single one stands for all."""
        if self.c.shape[1] == 1:
            return self
        return Series(self.c[:, which], np.broadcast_to(self.noise, self.c.shape[1:])[which])


NONE = Series(np.zeros((1, 1)))  # what is left out


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
    """The Fourier series of a mechanism, or of many; those of rod and energy may be left out."""

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
        if isinstance(which, slice):
            return self
        chosen = self._change_each(lambda series: series.select_cylinders(which))
        if chosen.curve is None:
            return chosen
        return chosen._replace(curve=chosen.curve._replace(momentum=chosen.curve.momentum[which]))

    def _change_each(self, change: Callable[[Series], Series]) -> Harmonics:
        c = self.curve
        if c is not None:
            series = change(c.along), change(c.across), change(c.couple), change(c.kinetic)
            c = Curve(*series, c.momentum)
        own = change(self.piston), change(self.rod), change(self.kinetic), change(self.rod_kinetic)
        return Harmonics(*own, c, self.turns)


def join_mechanisms(each: Sequence[Harmonics]) -> Harmonics:
    """Several mechanisms without curves side by side."""
    return Harmonics(
        _join([one.piston for one in each]),
        _join([one.rod for one in each]),
        _join([one.kinetic for one in each]),
        _join([one.rod_kinetic for one in each]),
    )


def _join(each: list[Series]) -> Series:
    if each[0] is NONE:
        return NONE
    noises = [np.broadcast_to(series.noise, series.c.shape[1:]) for series in each]
    return Series(np.concatenate([series.c for series in each], axis=1), np.concatenate(noises))


# ------------------------------------------------------------------ from samples
def unit_circle(count: int) -> Complex:
    """e^{i psi} at so many evenly spaced psi, each component within 2 ulp of itself: `np.exp` would
    round psi before.
    """
    return unit(np.arange(count) * (360 / count))


def transform(samples: Array, orders: ArrayLike, condition: Array | float = 1.0) -> Series:
    """Coefficients of whole orders from one revolution of evenly spaced samples.

    Args:
        samples: shape (*any axes, samples).
        orders: shape (orders,); those that are not whole, or beyond what the samples show, are 0.
        condition: error of each sample, relative and in roundings, shape of the samples.

    Returns: shape (orders, *the other axes).
    """
    n, count = np.asarray(orders), samples.shape[-1]
    spectrum = np.moveaxis(np.fft.rfft(samples) / count, -1, 0)
    spectrum[1:] *= 2
    inside = (n % 1 == 0) & (n < count // 2)
    rows = spectrum[np.where(inside, n, 0).astype(int)]
    c = np.where(inside.reshape(-1, *(1,) * (rows.ndim - 1)), rows, 0)
    return Series(c, SAMPLING * amplify_rounding(samples, condition))


def amplify_rounding(samples: Array | Complex, condition: Array | float = 1.0) -> Array:
    """What one rounding of every sample does to a coefficient, in units of the rounding.

    It is the root mean square of the samples and, where they are not good to some ulp, the mean of
    what each is multiplied by (`condition`). Shape of the samples without their last axis.
    """
    spread: Array = np.sqrt(2 * np.mean(np.abs(samples) ** 2, axis=-1))
    if np.isscalar(condition):
        return spread
    return spread + np.mean(np.abs(samples) * condition, axis=-1)

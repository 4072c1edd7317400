"""Represent periodic forces, moments and scalars by order: each order is two rotating vectors.

`F(theta) = sum over n of forward_n e^{i n theta} + backward_n e^{-i n theta}`. Vectors in the plane
are complex numbers x + iy. A scalar (couple, torque, roll) is the special case `backward =
conj(forward)`. The mean (order 0) is kept in `forward`. Arrays have the orders first, then any
trailing axes (crank angles, variants of a sweep).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array: TypeAlias = NDArray[np.float64]
Complex: TypeAlias = NDArray[np.complex128]
Numbers: TypeAlias = NDArray[Any]  # real or complex
Figure: TypeAlias = float | Array  # a number, or an array of variants

EPS = float(np.finfo(float).eps)
# e^{i x} for x = 0, 15 .. 345 degrees, from the cosines of the first quarter turn
_COSINES = np.array([1, (6**0.5 + 2**0.5) / 4, 0.75**0.5, 0.5**0.5, 0.5, (6**0.5 - 2**0.5) / 4, 0])
_UNITS = np.outer([1, 1j, -1, -1j], _COSINES[:6] + 1j * _COSINES[:0:-1]).ravel()


def unit(degrees: ArrayLike) -> Complex:
    """Return e^{i x} for angles x in degrees, any shape, within 2 ulp. It is exact at multiples of
    30 and 45 degrees, also beyond a whole turn.

    The value at the nearest multiple of 15 degrees comes from a table, and is turned by the
    remaining angle, which floating point computes exactly.
    """
    x = np.asarray(degrees, float)
    steps = np.rint(x / 15)
    rest = np.radians(x - 15 * steps)
    return _UNITS[steps.astype(np.intp) % 24] * compose(np.cos(rest), np.sin(rest))


def compose(real: NDArray[np.floating[Any]], imaginary: NDArray[np.floating[Any]]) -> Complex:
    """Return real + i imaginary. This is quicker than a sum of complex arrays.

    Args:
        real: Real part, any shape.
        imaginary: Imaginary part, of a shape that broadcasts with it.
    """
    result = np.empty(np.broadcast_shapes(real.shape, imaginary.shape), complex)
    result.real = real
    result.imag = imaginary
    return result


def open_axes(values: NDArray[Any], further: tuple[int, ...]) -> NDArray[Any]:
    """Return values with axes of length 1 added at the end, one for each of the `further` axes, so
    that they broadcast with an array of shape (*values, *further).
    """
    return values.reshape(values.shape + (1,) * len(further))


def put_together(forward: Array | Complex, backward: Array | Complex) -> Complex:
    """Return both vectors as one array, shape (2, *their common shape).

    Args:
        forward: Vectors that turn with the crank.
        backward: Vectors that turn against the crank.
    """
    return np.array(np.broadcast_arrays(forward, backward))


def wrap_degrees(degrees: ArrayLike, turn: float) -> Array:
    """Return directions wrapped to (-turn/2, turn/2], in the shape of `degrees`; nan stays nan.

    Args:
        degrees: Directions, deg, any shape.
        turn: 180 for lines, 360 for vectors.
    """
    wrapped = turn / 2 - np.remainder(turn / 2 - np.asarray(degrees, float), turn)
    # The remainder of a barely negative number rounds to a whole turn.
    return np.where(wrapped <= -turn / 2, turn / 2, wrapped)


@dataclass(frozen=True, eq=False)
class Phasors:
    """Rotating vectors by order, and the rounding error that they may carry.

    Attributes:
        orders: Orders, real numbers from 0 on, shape (orders,).
        vectors: Vectors that turn with the crank, then vectors that turn against it, shape (2,
            orders, *trailing).
        noise: Bound of the rounding error of each vector; it broadcasts to (orders, *trailing).
    """

    orders: Array
    vectors: Complex
    noise: Array
    __array_ufunc__ = None  # array * phasors calls our __rmul__

    @classmethod
    def of(cls, orders: Array, forward: Complex, backward: Complex, noise: Array) -> Phasors:
        """Return the phasors of two rotating vectors.

        Args:
            orders: Orders, shape (orders,).
            forward: Vectors that turn with the crank, shape (orders, *trailing).
            backward: Vectors that turn against the crank, shape (orders, *trailing).
            noise: Bound of the rounding error of each vector.
        """
        return cls(orders, put_together(forward, backward), noise)

    @classmethod
    def from_scalar(cls, orders: Array, coefficients: Complex, noise: Array) -> Phasors:
        """Return the phasors of the scalar `Re sum c_n e^{i n theta}`. A mean (order 0) is kept in
        `forward`; its `backward` is 0.

        Args:
            orders: Orders, shape (orders,).
            coefficients: c_n, shape (orders, *trailing).
            noise: Bound of the rounding error of each vector.
        """
        half = coefficients / 2
        mean = open_axes(orders, half.shape[1:]) == 0
        forward = np.where(mean, coefficients.real, half)
        backward = np.where(mean, 0, half.conj())
        return cls.of(orders, forward, backward, noise)

    @property
    def forward(self) -> Complex:
        """Vectors that turn with the crank, shape (orders, *trailing)."""
        return self.vectors[0]

    @property
    def backward(self) -> Complex:
        """Vectors that turn against the crank, shape (orders, *trailing)."""
        return self.vectors[1]

    def __add__(self, other: Phasors) -> Phasors:
        return Phasors(self.orders, self.vectors + other.vectors, self.noise + other.noise)

    def __sub__(self, other: Phasors) -> Phasors:
        return Phasors(self.orders, self.vectors - other.vectors, self.noise + other.noise)

    def __rmul__(self, factor: complex | Figure | Complex) -> Phasors:
        """Return the phasors scaled and, by a complex factor, turned."""
        size: Any = abs(factor)  # quicker than np.abs for a plain number
        return Phasors(self.orders, factor * self.vectors, size * self.noise)

    def about(self, p: complex | Complex) -> Phasors:
        """Return the moment about z of this force at the point p = x + iy: `Im(conj(p) F)`, a
        scalar.
        """
        moment = np.conjugate(p) * self.forward - p * np.conjugate(self.backward)
        return Phasors.from_scalar(self.orders, -1j * moment, 2 * np.abs(p) * self.noise)

    def drop_noise(self) -> Phasors:
        """Return these phasors with each vector that lies within its rounding error set to exactly
        0.
        """
        vectors = np.where(self._sizes <= self.noise, 0, self.vectors)
        return Phasors(self.orders, vectors, self.noise)

    def select_orders(self, orders: ArrayLike) -> Phasors:
        """Return the phasors of these orders, each of which must exist."""
        rows = np.searchsorted(self.orders, np.asarray(orders, float))
        noise = np.broadcast_to(self.noise, self.vectors.shape[1:])
        return Phasors(self.orders[rows], self.vectors[:, rows], noise[rows])

    def select_place(self, place: int) -> Phasors:
        """Return the phasors at one index of the trailing axis."""
        noise = np.broadcast_to(self.noise, self.vectors.shape[1:])
        return Phasors(self.orders, self.vectors[:, :, place], noise[:, place])

    @cached_property
    def _sizes(self) -> Array:
        """Sizes of the forward and backward vectors, shape (2, orders, *trailing)."""
        return np.abs(self.vectors)

    # -------------------------------------------------------------- size and direction of an order
    @property
    def balanced(self) -> NDArray[np.bool_]:
        return np.asarray((self.forward == 0) & (self.backward == 0))

    @property
    def major(self) -> Array:
        """Longer semi-axis of the ellipse that the vector of an order describes in a cycle of this
        order; for a scalar, its amplitude.
        """
        ahead, astern = self._sizes
        return ahead + astern

    @property
    def minor(self) -> Array:
        """Shorter semi-axis of the same ellipse; 0 if it is within its rounding error."""
        ahead, astern = self._sizes
        minor = np.abs(ahead - astern)
        return np.where(minor <= 2 * self.noise, 0, minor)

    @property
    def axis_deg(self) -> Array:
        """Angle of the longer axis of the ellipse from x, deg in (-90, 90]; nan for a circle, a
        balanced order or a mean.
        """
        angle = np.degrees((np.angle(self.forward) + np.angle(self.backward)) / 2)
        turned = wrap_degrees(angle, 180)
        # Rounding must not flip an axis from 90 to -90 degrees.
        turned = np.where(turned < 1e-6 - 90, 90.0, turned)
        there = (self.forward != 0) & (self.backward != 0)
        return np.where(there, turned, np.nan)

    @property
    def x(self) -> Complex:
        """Coefficients c_n of the components along x, `Re(c_n e^{i n theta})`; 0 below rounding."""
        return self._project(1.0)

    @property
    def y(self) -> Complex:
        """Coefficients c_n of the components along y, `Re(c_n e^{i n theta})`; 0 below rounding."""
        return self._project(-1j)

    def turn(self, degrees: float) -> Phasors:
        """Return the phasors with every vector turned by an angle, deg."""
        noise = self.noise + 2 * EPS * self.major
        return Phasors(self.orders, unit(degrees) * self.vectors, noise)

    def _project(self, turn: complex) -> Complex:
        """Return the coefficients of the components along the axis that the factor turns onto x."""
        ahead = turn * self.forward
        against = turn * self.backward
        mean = open_axes(self.orders, ahead.shape[1:]) == 0
        c = np.where(mean, ahead.real, ahead + np.conj(against))
        return np.where(np.abs(c) <= 2 * self.noise, 0, c)

    def values(self, theta: ArrayLike) -> Complex:
        """Return the sum over all orders at crank angles (rad), in the shape of `theta`. The
        phasors must have no trailing axes.
        """
        angles = np.asarray(theta, float)
        turning = np.exp(1j * np.multiply.outer(angles, self.orders))
        curve: Complex = turning @ self.forward + np.conj(turning) @ self.backward
        return curve


def join_orders(parts: Sequence[Phasors]) -> Phasors:
    """Return the orders of several phasors, one after the other, as one."""
    noises = [np.broadcast_to(p.noise, p.vectors.shape[1:]) for p in parts]
    return Phasors(
        np.concatenate([p.orders for p in parts]),
        np.concatenate([p.vectors for p in parts], axis=1),
        np.concatenate(noises),
    )


def join_places(parts: Sequence[Phasors]) -> Phasors:
    """Join several phasors along their trailing axis (places); phasors without this axis are one
    place.
    """
    vectors = [p.vectors.reshape(2, len(p.orders), -1) for p in parts]
    noises = [np.broadcast_to(p.noise, p.vectors.shape[1:]) for p in parts]
    return Phasors(parts[0].orders, np.concatenate(vectors, axis=2), np.column_stack(noises))

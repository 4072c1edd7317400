"""Phasors of many variants as products that are not multiplied out: factors that vary along some
axes (what each of equal cylinders does) and vectors that vary along others (where they point).

The size of a product is the product of the sizes: amplitudes need no complex number for each
variant, and orders that nobody reads cost nothing.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import NamedTuple

import numpy as np

from .phasors import Array, Complex, Figure, Phasors


class Product(NamedTuple):
    """A factor and a vector, each of shape (orders, *trailing)."""

    factor: Array | Complex
    vector: Complex

    @property
    def narrow(self) -> bool:
        """Whether it takes much more room than what it is a product of."""
        product = math.prod(np.broadcast_shapes(self.factor.shape, self.vector.shape))
        return product > max(self.factor.size, self.vector.size)


class FactoredPhasors(Phasors):
    """Phasors whose vectors are products, which are found where they are asked for.

    Args:
        orders: shape (orders,).
        sides: what forward and backward vectors are products of.
        noise: bound of the rounding error of either, shape (orders, *trailing).
        settled: whether a product that lies within the noise is exactly 0.
    """

    _sides: tuple[Product, Product]
    _settled: bool

    def __init__(
        self, orders: Array, sides: tuple[Product, Product], noise: Array, *, settled: bool = False
    ) -> None:
        vars(self).update(orders=orders, noise=noise, _sides=sides, _settled=settled)

    @property
    def narrow(self) -> bool:
        """Whether they take much more room multiplied than as they are."""
        return all(side.narrow for side in self._sides)

    @cached_property
    def forward(self) -> Complex:
        return self._multiply(0)

    @cached_property
    def backward(self) -> Complex:
        return self._multiply(1)

    @cached_property
    def vectors(self) -> Complex:
        return np.array(np.broadcast_arrays(self.forward, self.backward))

    def _multiply(self, side: int) -> Complex:
        product: Complex = np.multiply(*self._sides[side])
        return np.where(self._sizes[side] == 0, 0, product) if self._settled else product

    @cached_property
    def _sizes(self) -> Array:
        shapes = (each.shape for side in self._sides for each in side)
        sizes = np.empty((2, *np.broadcast_shapes(*shapes)))
        for size, side in zip(sizes, self._sides, strict=True):
            np.multiply(np.abs(side.factor), np.abs(side.vector), out=size)
        if not self._settled:
            return sizes
        nothing = sizes <= self.noise
        return np.where(nothing, 0, sizes) if np.count_nonzero(nothing) else sizes

    def __rmul__(self, factor: complex | Figure | Complex) -> FactoredPhasors:
        ahead, astern = (Product(side.factor, factor * side.vector) for side in self._sides)
        return FactoredPhasors(self.orders, (ahead, astern), np.abs(factor) * self.noise)

    def drop_noise(self) -> FactoredPhasors:
        return FactoredPhasors(self.orders, self._sides, self.noise, settled=True)

    def select_row(self, row: int) -> FactoredPhasors:
        only = slice(row, row + 1)
        ahead, astern = (Product(side.factor[only], side.vector[only]) for side in self._sides)
        return FactoredPhasors(
            self.orders[only], (ahead, astern), self.noise[only], settled=self._settled
        )

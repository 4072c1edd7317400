"""Compute the phases of the cylinders' vectors, order by order, and sums over the cylinders. The
phases depend only on the geometry of the engine.

Cylinder i of bank b has its pin at `pin_i` (degrees ahead of cylinder 1's pin) and its axis at
`axis_b`. A harmonic `Re c e^{i n psi}`, `psi = theta + axis_1 + pin_i - axis_b`, of a force along
the cylinder's axis gives

    forward_n  = 1/2 sum_b e^{i (axis_b - n (axis_b - axis_1))} S_b
    backward_n = 1/2 sum_b e^{i (axis_b + n (axis_b - axis_1))} conj(S_b)

where `S_b` is the sum of `c_i e^{i n pin_i}` over the bank's cylinders. So each bank is summed
once, and terms that do not vary between variants are computed once. Axes of arrays: orders,
cylinders (or banks), then any trailing axes; an axis along which nothing varies has length 1.
"""

from __future__ import annotations

import math
from functools import cached_property
from itertools import groupby

import numpy as np

from .cylinders import Cylinders
from .mechanisms.closed_form import Series
from .mechanisms.harmonics import narrow
from .phasors import EPS, Array, Complex, Phasors, unit

TURN = 360  # deg
SUM = 8 * EPS  # rounding error of a sum, per term, relative to the terms
ANGLE = np.pi * EPS  # rad, rounding error of an angle up to 360 deg; n times as large for order n
_ALL = slice(None)


class Phases:
    """The phases of an engine's cylinders for some orders, and sums over the cylinders.

    Attributes:
        orders: The orders, shape (orders,).
        n: The orders as a column, shape (orders, 1, *1), to broadcast with cylinders; `*1` are
            trailing axes of length 1.
        count: Number of cylinders.
        rounding: Bound of the error of a sum over cylinders, relative to its terms, in the shape of
            `n`.
    """

    def __init__(self, cylinders: Cylinders, orders: Array) -> None:
        axis = cylinders.axis_deg
        pin = cylinders.pin_deg
        self.orders = orders
        self.n = orders.reshape(-1, *(1,) * pin.ndim)
        self.count = cylinders.count
        self.rounding = self.count * SUM + ANGLE * self.n
        self._axis = axis
        self._turn = self.n * (axis - axis[cylinders.first])
        self._starts = cylinders.starts
        self._moving: dict[int, Complex] = {}  # e^{i n pin} by cylinder, (orders, *trailing)
        if pin.ndim == 1:
            self._still = unit(self.n * pin)  # e^{i n pin}, (orders, cylinders, *1)
        else:
            self._part_variants(pin)

    def _part_variants(self, pin: Array) -> None:
        """Separate pins that vary between variants from pins that do not, because a sweep of one
        throw does not move the others. Pins that move alike are computed once.
        """
        rows = [narrow(row) for row in pin]
        stays = np.array([row.size == 1 for row in rows]).reshape(-1, *(1,) * (pin.ndim - 1))
        first = pin[(_ALL, *(slice(1),) * (pin.ndim - 1))]
        self._still = unit(self.n * first) * stays
        for k, row in enumerate(rows):
            if row.size > 1:
                twin = next((j for j in self._moving if np.array_equal(rows[j], row)), k)
                self._moving[k] = unit(self.n[:, 0] * row) if twin == k else self._moving[twin]

    # -------------------------------------------------------------- sums over the cylinders
    def add_vectors(
        self, vectors: Series, arms: Array | None = None, sizes: Array | None = None
    ) -> Phasors:
        """Return the sum of the cylinders' vectors, each times its (real) arm if there are arms.

        Args:
            vectors: Rotating vectors of each cylinder in its own frame (x along its axis), shape
                (2, orders, cylinders or 1, *trailing): forward vectors, then the conjugates of
                backward vectors; and their rounding errors. Length 1: equal for all cylinders.
            arms: Factors of the vectors, shape (cylinders, *trailing); None: 1.
            sizes: Factors of the rounding errors, in the shape of the arms: the sizes of the terms
                from which the arms are computed.
        """
        sums = self._add(self._planar, vectors.c, arms)
        np.conjugate(sums[1], out=sums[1])
        return Phasors(self.orders, sums, self.add_figures(np.asarray(vectors.noise), sizes))

    def add_scalars(self, series: Series) -> Phasors:
        """Return the sum of the cylinders' scalars; the scalars of each bank are turned by `e^{i n
        (axis_1 - axis)}`.
        """
        noise = self.add_figures(self.rounding * np.abs(series.c) + series.noise)
        (total,) = self._add(unit(-self._turn[None]), series.c[None], None)
        return Phasors.from_scalar(self.orders, total, noise)

    def add_figures(self, values: Array, sizes: Array | None = None) -> Array:
        """Return the sum of `values * sizes` over the cylinders, shape (orders, *trailing).

        Args:
            values: Values, shape (orders, cylinders or 1, *trailing).
            sizes: Factors, shape (cylinders, *trailing); None: 1.
        """
        if values.shape[1] > 1:
            return np.add.reduce(values if sizes is None else values * sizes, axis=1)
        return values[:, 0] * (self.count if sizes is None else np.add.reduce(sizes, axis=0))

    def _add(self, turns: Complex, sides: Array | Complex, arms: Array | None) -> Complex:
        """Return `sum over banks of turns * sum over its cylinders of arms * vectors * e^{i n
        pin}`.

        Args:
            turns: Rotation e^{i angle} of each bank, shape (sides, orders, banks, *trailing).
            sides: Vectors, forward and backward, shape (sides, orders, cylinders or 1, *trailing).
            arms: Factors of the vectors; None: 1.

        Returns: shape (sides, orders, *trailing).
        """
        if sides.shape[2] == 1:
            factors = (self._ones if arms is None else arms)[None]
            return np.asarray(sides[:, :, 0] * self._add_turned(turns, factors))
        each = (side if arms is None else arms * side for side in sides)
        own = [self._add_turned(turns[k : k + 1], factors) for k, factors in enumerate(each)]
        return np.concatenate(own)

    def _add_turned(self, turns: Complex, factors: Array | Complex) -> Complex:
        """Return the turned sum of the phases times factors, shape (1 or orders, cylinders,
        *trailing).
        """
        of_banks = np.add.reduceat(factors * self._still, self._starts, axis=1)
        total: Complex = np.add.reduce(turns * of_banks, axis=2)
        for bank, rows in groupby(self._moving, self._bank):
            moving = sum(factors[:, k] * self._moving[k] for k in rows)
            total = total + turns[:, :, bank] * moving
        return total

    @cached_property
    def _ones(self) -> Array:
        """A 1 for each cylinder, shape (cylinders, *1)."""
        return np.ones((self.count, *self.n.shape[2:]))

    def _bank(self, cylinder: int) -> int:
        return int(np.searchsorted(self._starts, cylinder, "right")) - 1

    @cached_property
    def _planar(self) -> Complex:
        """Turns of each bank's forward vectors and of the conjugates of its backward ones:
        `e^{i (n (axis_1 - axis) +- axis)}`, shape (2, orders, banks, *trailing).
        """
        turns = unit(np.array((self._axis - self._turn, self._axis + self._turn)))
        np.conjugate(turns[1], out=turns[1])
        return turns


class SeparatePhases(Phases):
    """Phases whose "sums" return the terms of each cylinder, shape (orders, cylinders). The engine
    must have no trailing axes.
    """

    def add_figures(self, values: Array, sizes: Array | None = None) -> Array:
        """Return the terms of the sum, one for each cylinder.

        Args:
            values: Figures of the cylinders.
            sizes: Factors of the figures; None: 1.
        """
        return values * (self._ones if sizes is None else sizes)

    def _add(self, turns: Complex, sides: Array | Complex, arms: Array | None) -> Complex:
        """Return the terms of the sum, shape (sides, orders, cylinders)."""
        counts = np.diff([*self._starts, self.count])
        arms = self._ones if arms is None else arms
        return np.asarray(np.repeat(turns, counts, axis=2) * (arms * sides * self._still))


RPM = math.pi / 30  # 1 rpm in rad/s

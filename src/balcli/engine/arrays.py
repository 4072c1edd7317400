"""Figures that may vary, and their values for all cylinders as arrays: one row a cylinder, before
any axes of variants.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.phasors import Array, Complex, Figure

_ROUNDING = 1e-9  # share of the largest by which rounding may set equal values apart


def place_in_plane(x: Figure, y: Figure) -> complex | Complex:
    """x + iy."""
    return cast("complex | Complex", x + 1j * y)


def column(values: Sequence[Figure], rank: int) -> Array:
    """One row for each of the values, shape (len(values), *trailing).

    The values broadcast against each other; plain numbers get `rank` trailing axes of length 1.
    """
    if any(isinstance(value, np.ndarray) for value in values):
        rows: Array = np.stack(np.broadcast_arrays(*values)) + 0.0  # in place: -0.0 becomes 0.0
    else:
        rows = np.array(values) + 0.0
    return rows.reshape(len(values), *rows.shape[1:] or (1,) * rank)


def shared_column(values: Sequence[Figure], rank: int) -> Array:
    """The same, or a single row, shape (1, *trailing), where all values are equal."""
    rows = column(values, rank)
    return rows[:1] if len(rows) > 1 and (rows == rows[:1]).all() else rows


def find_first_largest(values: ArrayLike) -> NDArray[np.intp]:
    """Row of the largest of some values (rows, ...), shape (...); of those that rounding alone sets
    apart the first.
    """
    found = np.asarray(values, float)
    largest = found.max(axis=0)
    return np.asarray((found >= largest - _ROUNDING * np.abs(largest)).argmax(axis=0))


def ranked(values: ArrayLike) -> Array:
    """The values to ten digits, any shape, to put them in order by: those that differ by rounding
    alone are equal.
    """
    mantissa, exponent = np.frexp(np.asarray(values, float))
    return np.ldexp(np.round(mantissa, 10), exponent)

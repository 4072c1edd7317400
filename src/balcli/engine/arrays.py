"""Values of cylinders as arrays: one row each, before any axes of variants."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray


def column(values: Sequence[Any], rank: int) -> NDArray[Any]:
    """One row each, shape (len(values), *trailing); scalars get trailing axes of length 1."""
    rows = np.broadcast_arrays(*(np.asarray(v) for v in values))
    stacked = np.stack(rows) + 0.0
    return stacked.reshape(len(values), *stacked.shape[1:] or (1,) * rank)


def ranked(values: ArrayLike) -> NDArray[np.float64]:
    """The values to ten digits, any shape, to put them in order by: those that differ by rounding
    alone are equal.
    """
    mantissa, exponent = np.frexp(np.asarray(values, float))
    return np.ldexp(np.round(mantissa, 10), exponent)


def shared(values: Sequence[Any], rank: int) -> NDArray[Any]:
    """The same, or a single row where all are equal."""
    rows = column(values, rank)
    return rows[:1] if (rows == rows[:1]).all() else rows

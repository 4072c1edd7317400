"""Weighted linear least squares of a few unknowns, real or complex, to a few roundings.

By singular values (Golub and Van Loan, Matrix Computations, 4th ed., 5.5): where the unknowns are
not determined, the smallest of all solutions is taken. The solution is then refined on its own
residual, so that what can be cancelled is cancelled to rounding.
"""

from __future__ import annotations

from typing import Generic, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

Number = TypeVar("Number", np.float64, np.complex128)

_LOST = 1e-14  # singular values below this share of the largest are rounding errors
_DEPENDENT = 1e-12  # the same of columns of size 1: what they cannot tell apart
_REFINEMENTS = 2
_TAKES_PART = 1e-6  # a smaller share of a column in a combination is a rounding error


class Solution(NamedTuple, Generic[Number]):
    """The unknowns that fit the readings best.

    Attributes:
        x: shape (unknowns,).
        residual: `target - matrix @ x`, shape (readings,).
        left: norm of the weighted residual over that of the weighted target (0 if both are 0).
        condition: largest over smallest singular value of the weighted matrix; infinite where
            the smallest is a rounding error.
        rank: of the weighted matrix; if less than the number of unknowns, other x fit as well.
    """

    x: NDArray[Number]
    residual: NDArray[Number]
    left: float
    condition: float
    rank: int


def solve(
    matrix: NDArray[Number], target: NDArray[Number], weights: NDArray[np.float64] | None = None
) -> Solution[Number]:
    """The smallest x for which `matrix @ x` is nearest to the target.

    Args:
        matrix: what one unit of each unknown does to each reading, shape (readings, unknowns).
            Units should make columns similar in size: one of 1e-14 of another counts as zeros.
        target: shape (readings,).
        weights: factors of the rows, shape (readings,): the sum of `|weight * residual|^2` becomes
            least. All 1 if not given.

    Raises numpy's LinAlgError for figures that are not finite.
    """
    scale = np.ones(len(target)) if weights is None else weights
    u, s, vh = np.linalg.svd(scale[:, None] * matrix, full_matrices=False)
    kept = s > _LOST * s[0]
    inverse = (vh[kept].conj().T / s[kept]) @ u[:, kept].conj().T
    x = np.zeros_like(matrix, shape=matrix.shape[1])
    for _ in range(1 + _REFINEMENTS):
        x = x + inverse @ (scale * (target - matrix @ x))
    residual = target - matrix @ x
    size = float(np.linalg.norm(scale * target))
    left = float(np.linalg.norm(scale * residual)) / (size or 1.0)
    condition = float(s[0] / s[-1]) if kept.all() else float("inf")
    return Solution(x, residual, left, condition, int(np.count_nonzero(kept)))


def find_dependent_columns(matrix: NDArray[Number]) -> list[int]:
    """The unknowns that the readings cannot tell apart: columns that are combinations of others.

    Columns count by their direction, whatever their size. A column of zeros is found, too. Empty
    where every unknown is determined.

    Args:
        matrix: shape (readings, unknowns).
    """
    sizes = np.linalg.norm(matrix, axis=0)
    directions = matrix / np.where(sizes > 0, sizes, 1.0)
    _, s, vh = np.linalg.svd(directions)
    rank = np.count_nonzero(s > _DEPENDENT * s[0])
    combinations = np.abs(vh[rank:])  # of columns, each of which gives nothing
    taking_part = np.any(combinations > _TAKES_PART, axis=0)
    return [int(k) for k in np.flatnonzero(taking_part)]

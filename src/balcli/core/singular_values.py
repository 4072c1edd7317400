"""Singular values to full relative accuracy, the smallest as well as the largest."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.floating]
Complex = NDArray[np.complexfloating]
Indices = NDArray[np.intp]

_ORTHOGONAL = 1e-15  # cosine between two columns that counts as none, times sqrt(rows)
_SWEEPS = 60  # convergence is quadratic; 3 to 6 are usual


def find_singular_vectors(matrix: Real, rank: int) -> tuple[Real, Real]:
    """Nonzero singular values (rank,), rising, and the right singular vectors (rank, columns) that
    belong to them, for a matrix (rows, columns) of known rank.

    Of a matrix whose rows and columns differ by any powers of ten, LAPACK finds the small values
    only relative to the largest. Here a QR decomposition with complete pivoting takes the scales
    apart, and one-sided Jacobi rotations of the rows of R keep each as accurate as it is determined
    (Demmel, Gu, Eisenstat, Slapnicar, Veselic and Drmac, Linear Algebra Appl. 299, 1999): about
    1e-15 for the incidence matrix of a tree, whatever its scales (Demmel and Gragg, 1993).
    """
    turned = _orthogonalise(_triangularise(matrix, rank).T)
    values = np.sqrt(np.sum(turned**2, axis=0))
    rising = np.argsort(values, kind="stable")
    return values[rising], (turned / values)[:, rising].T


def _triangularise(matrix: Real, rank: int) -> Real:
    """The rows of R, (rank, columns), in the order of the matrix' columns: Householder's QR that
    takes the longest column next and in it the largest element.
    """
    work = matrix.copy()
    order = np.arange(work.shape[1])
    for k in range(rank):
        column = k + int(np.argmax(np.sum(work[k:, k:] ** 2, axis=0)))
        work[:, [k, column]] = work[:, [column, k]]
        order[[k, column]] = order[[column, k]]
        row = k + int(np.argmax(np.abs(work[k:, k])))
        work[[k, row]] = work[[row, k]]
        mirror = work[k:, k].copy()
        mirror[0] += np.copysign(np.sqrt(mirror @ mirror), mirror[0])
        work[k:, k:] -= np.outer(mirror, 2 / (mirror @ mirror) * (mirror @ work[k:, k:]))
        work[k + 1 :, k] = 0
    result = np.empty((rank, work.shape[1]))
    result[:, order] = work[:rank]
    return result


def _orthogonalise(columns: Real) -> Real:
    """The columns turned among each other, pair by pair, until all are orthogonal."""
    columns = columns.copy()
    tolerance = _ORTHOGONAL * np.sqrt(len(columns))
    for _ in range(_SWEEPS):
        skew = [_turn_pairs(columns, *pairs, tolerance) for pairs in _rounds(columns.shape[1])]
        if max(skew, default=0) <= tolerance:
            break
    return columns


def _turn_pairs(
    columns: Real, left: NDArray[np.intp], right: NDArray[np.intp], tolerance: float
) -> float:
    """Turns disjoint pairs of columns in place until each is orthogonal; returns the largest cosine
    that was found.
    """
    x, y = columns[:, left], columns[:, right]
    xx, yy, xy = np.sum(x * x, axis=0), np.sum(y * y, axis=0), np.sum(x * y, axis=0)
    cosine = np.abs(xy) / (np.sqrt(xx) * np.sqrt(yy))
    skew = cosine > tolerance
    half = (yy - xx) / np.where(skew, 2 * xy, 1)
    tangent = np.where(skew, np.copysign(1, half) / (np.abs(half) + np.hypot(1, half)), 0)
    c = 1 / np.hypot(1, tangent)
    s = c * tangent
    columns[:, left] = c * x - s * y
    columns[:, right] = s * x + c * y
    return float(cosine.max(initial=0))


def _rounds(count: int) -> Iterator[tuple[NDArray[np.intp], NDArray[np.intp]]]:
    """All pairs of `count` columns in rounds of disjoint pairs, as a tournament is drawn up: one
    player stays, the others move on by one seat.
    """
    seats = list(range(count + count % 2))
    for _ in range(len(seats) - 1):
        met = zip(seats[: len(seats) // 2], reversed(seats), strict=False)
        pairs = [sorted(pair) for pair in met if max(pair) < count]
        left, right = np.array(pairs, dtype=np.intp).reshape(-1, 2).T
        yield left, right
        seats = [seats[0], seats[-1], *seats[1:-1]]

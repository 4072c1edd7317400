"""Eigenvalues and equations at 50 digits (mpmath): what floating point is measured against."""

import mpmath
import numpy as np

DIGITS = 50


def to_matrix(values):
    """A matrix of 50 digits of the exact values of a numpy array, real or complex."""
    return mpmath.matrix([[mpmath.mpmathify(complex(x)) for x in row] for row in values])


def angular_frequencies(springs, stiffness, mass):
    """All natural frequencies, rising, rad/s, of `S^T k S x = w^2 M x` for a diagonal mass, massless ones condensed.

    Args:
        springs: S (springs, dof).
        stiffness: (springs,).
        mass: (dof,), some of them 0.
    """
    with mpmath.workdps(DIGITS):
        rows = to_matrix(springs).apply(mpmath.re)
        k = [mpmath.mpf(float(x)) for x in stiffness]
        matrix = rows.T * mpmath.diag(k) * rows
        light = [int(i) for i in np.flatnonzero(np.asarray(mass) == 0)]
        heavy = [int(i) for i in np.flatnonzero(np.asarray(mass) > 0)]
        kept = _part(matrix, heavy, heavy)
        if light:
            coupling = _part(matrix, light, heavy)
            kept -= coupling.T * mpmath.inverse(_part(matrix, light, light)) * coupling
        scale = mpmath.diag([1 / mpmath.sqrt(mpmath.mpf(float(mass[i]))) for i in heavy])
        squares = mpmath.eigsy(scale * kept * scale, eigvals_only=True)
        return np.array([float(mpmath.sqrt(abs(square))) for square in squares])


def solve(matrix, load):
    """The solution (n,) of complex equations (n, n) x = (n,)."""
    with mpmath.workdps(DIGITS):
        return to_complex(mpmath.lu_solve(matrix, load))


def to_complex(vector):
    return np.array([complex(x) for x in vector])


def _part(matrix, rows, columns):
    return mpmath.matrix([[matrix[i, j] for j in columns] for i in rows])

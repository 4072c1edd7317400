"""Complex unknowns in convex regions: least squares, and the smallest largest residual.

Least squares within regions: `x = P(x - slope / L)` holds at the optimum and nowhere else, P being
the projection on the regions. Newton's method solves this equation; where its step is worse than
the projected gradient, that is taken.

The largest residual by Lawson's iteration (Lawson, Contributions to the theory of linear least
maximum approximation, thesis, UCLA 1961): least squares with the shares g as weights, every share
then multiplied by its residual. For any shares with sum 1 the least `sum g |r|^2` is a lower bound
of the largest `|r|^2`, so every round proves how near the optimum it is.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from .least_squares import solve
from .phasors import Array, Complex

_ROUNDS = 1000  # of Lawson's iteration
_GAP = 1e-8  # share of the largest residual by which the bound may be less
_REVIVED = 1e-9  # share of the largest residual that a reading counts for even if its own is 0
_STEPS = 500  # of Newton's method or the projected gradient; 5 are usual
_SETTLED = 1e-15  # share of the size of x
_VANISHES = 1e-13  # share of the target below which a residual is rounding
_NO_POINTS = np.zeros(0, dtype=complex)


class Region(NamedTuple):
    """A convex region of the complex plane: a disc, or what has edges around it.

    Attributes:
        centre, radius: of the disc.
        starts, ways, lengths: where every edge starts, its direction (size 1), and its length,
            which may be infinite. Without edges the region is a disc.
        inward: directions (size 1) from every edge into the region.
    """

    centre: complex = 0j
    radius: float = np.inf
    starts: Complex = _NO_POINTS
    ways: Complex = _NO_POINTS
    lengths: Array = np.zeros(0)
    inward: Complex = _NO_POINTS

    def project(self, y: complex) -> tuple[complex, Array]:
        """Return the nearest point of the region, and the derivative of that by y, shape (2, 2)."""
        if not len(self.starts):
            distance = abs(y - self.centre)
            if distance <= self.radius:
                return y, np.eye(2)
            share, tangent = self.radius / distance, 1j * (y - self.centre) / distance
            return self.centre + share * (y - self.centre), share * _spread(tangent)
        if (_along(self.inward, y - self.starts) > 0).all():
            return y, np.eye(2)
        along, nearest = self._find_nearest(y)
        k = int(np.argmin(np.abs(nearest - y)))
        on_edge = 0 < along[k] < self.lengths[k]
        return complex(nearest[k]), _spread(self.ways[k]) if on_edge else np.zeros((2, 2))

    def has(self, x: complex, noise: float) -> bool:
        """Whether x is in the region, or no farther away than the noise."""
        return bool(abs(self.project(x)[0] - x) <= noise)

    def has_at_edge(self, x: complex, noise: float) -> bool:
        """Whether the edge is as near x as the noise. A line is all edge."""
        if not len(self.starts):
            return bool(abs(self.radius - abs(x - self.centre)) <= noise)
        return bool(np.abs(self._find_nearest(x)[1] - x).min() <= noise)

    def find_least(self, slope: complex, far: float) -> float:
        """Return the least `Re(conj(slope) y)` of all y in the region with `|y| <= far`."""
        if not len(self.starts):
            return float(_along(slope, self.centre) - abs(slope) * min(self.radius, far))
        ends = self.starts + self.ways * np.minimum(self.lengths, far)
        return float(_along(slope, np.append(self.starts, ends)).min())

    def _find_nearest(self, y: complex) -> tuple[Array, Complex]:
        along = np.clip(_along(self.ways, y - self.starts), 0, self.lengths)
        return along, self.starts + along * self.ways


ANYWHERE = Region()


class Smallest(NamedTuple):
    """Unknowns that make residuals small.

    Attributes:
        x: shape (unknowns,).
        residual: `target - matrix @ x`, without weights, shape (readings,).
        largest: largest weighted residual.
        bound: no x within the regions has a smaller largest weighted residual than this; nan where
            that was not asked for.
    """

    x: Complex
    residual: Complex
    largest: float
    bound: float


def minimise_squares(
    matrix: Complex, target: Complex, weights: Array, regions: Sequence[Region] = ()
) -> Smallest:
    """Find the x within the regions with the least sum of `|weight * (target - matrix @ x)|^2`.

    Args:
        matrix: shape (readings, unknowns), its columns independent.
        target: shape (readings,).
        weights: positive factors of the readings, shape (readings,).
        regions: one for every unknown; none: anywhere.
    """
    columns, goal, sizes, scaled = _scale(matrix, target, weights, regions)
    x: Complex = _solve_within(columns, goal, scaled, np.zeros_like(matrix[0])) / sizes
    residual = target - matrix @ x
    return Smallest(x, residual, float(np.abs(weights * residual).max()), float("nan"))


def minimise_largest(
    matrix: Complex, target: Complex, weights: Array, regions: Sequence[Region] = ()
) -> Smallest:
    """Find the x within the regions with the smallest largest `weight * |target - matrix @ x|`.

    Args: as for `minimise_squares`.
    """
    columns, goal, sizes, scaled = _scale(matrix, target, weights, regions)
    weakest = np.linalg.svd(columns, compute_uv=False)[-1]
    shares = np.full(len(goal), 1 / len(goal))
    x = best = np.zeros_like(matrix[0])
    bound, least = 0.0, float(np.abs(goal).max())
    for _ in range(_ROUNDS):
        root = np.sqrt(shares)
        x = _solve_within(root[:, None] * columns, root * goal, scaled, x)
        residual = goal - columns @ x
        left = np.abs(residual)
        if left.max() <= least:
            best, least = x, float(left.max())
        # no better x is farther away: it leaves at most as much
        far = 2 * np.sqrt(len(goal)) * left.max() / weakest + np.abs(x)
        slope = -2 * columns.conj().T @ (shares * residual)
        lowest = [r.find_least(*pair) for r, *pair in zip(scaled, slope, far, strict=True)]
        square = shares @ left**2 - _along(slope, x).sum() + sum(lowest)
        bound = max(bound, float(np.sqrt(max(square, 0.0))))
        if least - bound <= _GAP * least or least <= _VANISHES * np.abs(goal).max():
            break
        shares = shares * (left + _REVIVED * left.max())
        shares /= shares.sum()
    if least <= _VANISHES * np.abs(goal).max():
        bound = 0.0
    x = best / sizes
    residual = target - matrix @ x
    return Smallest(x, residual, float(np.abs(weights * residual).max()), bound)


def _scale(
    matrix: Complex, target: Complex, weights: Array, regions: Sequence[Region]
) -> tuple[Complex, Complex, Array, list[Region]]:
    """Return weighted columns of size 1, the weighted target, the columns' sizes, and the regions
    of `size * x`.
    """
    columns = weights[:, None] * matrix
    sizes = np.linalg.norm(columns, axis=0)
    regions = regions or [ANYWHERE] * len(sizes)
    scaled = [
        region._replace(
            centre=region.centre * size,
            radius=region.radius * size,
            starts=region.starts * size,
            lengths=region.lengths * size,
        )
        for region, size in zip(regions, sizes, strict=True)
    ]
    return columns / sizes, weights * target, sizes, scaled


def _solve_within(matrix: Complex, target: Complex, regions: list[Region], x: Complex) -> Complex:
    """Return the least squares solution within the regions, found from x."""
    free = solve(matrix, target).x
    if all(region.has(one, 0.0) for region, one in zip(regions, free, strict=True)):
        return free
    square, pull = matrix.conj().T @ matrix, matrix.conj().T @ target
    steepest = float(np.linalg.norm(square, 2))
    shrunk = np.eye(2 * len(x)) - _as_real(square) / steepest
    for _ in range(_STEPS):
        step, change = _project(regions, x + (pull - square @ x) / steepest)
        if np.abs(step - x).max() <= _SETTLED * np.abs(step).max():
            break
        miss = (step - x).view(float)
        newton = np.linalg.lstsq(np.eye(len(miss)) - change @ shrunk, miss, rcond=None)[0]
        quick, _ = _project(regions, x + newton.view(complex))
        left = [float(np.linalg.norm(target - matrix @ one)) for one in (quick, step)]
        x = quick if left[0] <= left[1] * (1 + _SETTLED) else step
    return x


def _project(regions: list[Region], y: Complex) -> tuple[Complex, Array]:
    """Return the nearest point within all regions, and its derivative in real numbers."""
    change = np.zeros((2 * len(y), 2 * len(y)))
    points = np.empty_like(y)
    for k, (region, one) in enumerate(zip(regions, y, strict=True)):
        points[k], change[2 * k : 2 * k + 2, 2 * k : 2 * k + 2] = region.project(complex(one))
    return points, change


def _as_real(matrix: Complex) -> Array:
    """Return a complex matrix as it acts on real and imaginary parts, which alternate."""
    turns = np.array([[1.0, 0], [0, 1]]), np.array([[0.0, -1], [1, 0]])
    return np.kron(matrix.real, turns[0]) + np.kron(matrix.imag, turns[1])


def _along(direction: Complex | complex, y: Complex | complex) -> Array:
    return np.asarray((np.conj(direction) * y).real)


def _spread(direction: complex) -> Array:
    """Return the projection on a line through 0, in real numbers."""
    parts = np.array([direction.real, direction.imag])
    return np.outer(parts, parts)

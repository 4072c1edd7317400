"""Fit unknowns to readings. `solve` minimises the sum of the squared residuals. `minimise` keeps
every unknown within a convex region of the complex plane, and minimises the sum of the squares or
the largest residual.

`solve` uses singular values (Golub and Van Loan, Matrix Computations, 4th ed., 5.5). Where the
unknowns are not determined, it returns the solution with the smallest norm. Then it fits the
residual again and adds the result, so that every residual that can vanish does so to rounding.

Least squares within regions: only the optimum fulfils `x = P(x - g / L)`. P is the projection on
the regions, g the gradient of the sum of squares and L the largest curvature of this sum. Newton's
method solves the equation. If the step `x -> P(x - g / L)` reduces the sum of squares more than
Newton's step, it is taken instead.

The largest residual is minimised by Lawson's iteration (Lawson, Contributions to the theory of
linear least maximum approximation, thesis, UCLA 1961). Each reading has a share w. Solve least
squares with the shares as weights, multiply every share by the size of its reading's residual r,
and repeat. For any shares with the sum 1, the least `sum w |r|^2` is a lower bound of the largest
`|r|^2`, so every round yields a bound of its distance from the optimum.
"""

from collections.abc import Sequence
from typing import Generic, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from .phasors import Array, Complex

Number = TypeVar("Number", np.float64, np.complex128)

_LOST = 1e-14  # singular values below this share of the largest are rounding errors
_DEPENDENT = 1e-12  # for columns of size 1, a smaller singular value means dependent columns
_REFINEMENTS = 2
_TAKES_PART = 1e-6  # smaller coefficients of a column in a combination are rounding errors


class Solution(NamedTuple, Generic[Number]):
    """The unknowns that fit the readings best.

    Attributes:
        x: The unknowns, shape (unknowns,).
        residual: `target - matrix @ x`, shape (readings,).
        left: Norm of the weighted residual over that of the weighted target (0 if both are 0).
        condition: Largest over smallest singular value of the weighted matrix; infinite if the
            smallest is a rounding error.
        rank: Rank of the weighted matrix; if it is below the number of unknowns, other x fit
            equally well.
    """

    x: NDArray[Number]
    residual: NDArray[Number]
    left: float
    condition: float
    rank: int


def solve(
    matrix: NDArray[Number],
    target: NDArray[Number],
    weights: NDArray[np.float64] | None = None,
    lost: float = _LOST,
) -> Solution[Number]:
    """Return the smallest x for which `matrix @ x` is nearest to the target.

    Args:
        matrix: Effect of one unit of each unknown on each reading, shape (readings, unknowns).
            Choose units that make columns similar in size: a column that is 1e-14 times another
            counts as zeros.
        target: Readings to fit, shape (readings,).
        weights: Weights of the readings, shape (readings,); None: all are 1. The sum of `|weight *
            residual|^2` is minimised.
        lost: Singular values below this share of the largest count as zeros.

    Raises:
        LinAlgError: A value is not finite.
    """
    scale = np.ones(len(target)) if weights is None else weights
    u, s, vh = np.linalg.svd(scale[:, None] * matrix, full_matrices=False)
    kept = s > lost * s[0]
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
    """Return the indices of unknowns that the readings cannot tell apart: their columns are
    combinations of other columns.

    Only the directions of columns matter, not their sizes. A column of zeros is returned as well.
    The list is empty if every unknown is determined.

    Args:
        matrix: Effect of each unknown on each reading, shape (readings, unknowns).
    """
    sizes = np.linalg.norm(matrix, axis=0)
    directions = matrix / np.where(sizes > 0, sizes, 1.0)
    _, s, vh = np.linalg.svd(directions)
    rank = np.count_nonzero(s > _DEPENDENT * s[0])
    combinations = np.abs(vh[rank:])  # coefficients with which columns add up to 0
    return np.flatnonzero(np.any(combinations > _TAKES_PART, axis=0)).tolist()


_ROUNDS = 1000  # largest number of rounds of Lawson's iteration
_GAP = 1e-8  # relative distance of the largest residual from its bound that ends the iteration
_REVIVED = 1e-9  # this part of the largest residual is added to each, so that no share becomes 0
_STEPS = 500  # largest number of steps of Newton's method or the projected gradient; 5 are usual
_SETTLED = 1e-15  # a step below this share of x ends the iteration
_VANISHES = 1e-13  # a residual below this share of the target is rounding
_NO_POINTS = np.zeros(0, dtype=complex)


class Region(NamedTuple):
    """A convex region of the complex plane: a disc, a polygon or a wedge.

    Attributes:
        centre: Centre of the disc; a region without edges is a disc.
        radius: Radius of the disc.
        starts: Start of every edge.
        ways: Directions of the edges (size 1); the region lies on their left.
        lengths: Lengths of the edges. Plus infinity: the edge has no end; minus infinity: the edge
            comes from infinity and ends at its point in `starts`.
    """

    centre: complex = 0j
    radius: float = np.inf
    starts: Complex = _NO_POINTS
    ways: Complex = _NO_POINTS
    lengths: Array = np.zeros(0)

    def find_depth(self, x: complex) -> float:
        """Return the distance of a point from the edge of the region; negative outside."""
        if len(self.starts):
            return float((np.conj(self.ways) * (x - self.starts)).imag.min())
        return float(self.radius - abs(x - self.centre))

    def project(self, x: complex) -> tuple[complex, Array]:
        """Return the nearest point of the region, and its derivative by x as a matrix of shape
        (2, 2), whose rows and columns are real and imaginary part.
        """
        if self.find_depth(x) > 0:
            return x, np.eye(2)
        if not len(self.starts):
            out = x - self.centre
            share = self.radius / abs(out)
            return self.centre + share * out, share * _project_on(1j * out / abs(out))
        along = (np.conj(self.ways) * (x - self.starts)).real
        kept = np.clip(along, np.minimum(self.lengths, 0), np.maximum(self.lengths, 0))
        nearest = self.starts + kept * self.ways
        k = int(np.abs(nearest - x).argmin())
        change = _project_on(self.ways[k]) if kept[k] == along[k] else np.zeros((2, 2))
        return complex(nearest[k]), change


class Smallest(NamedTuple):
    """Result of `minimise`.

    Attributes:
        x: The unknowns, shape (unknowns,).
        residual: `target - matrix @ x`, without weights, shape (readings,).
        bound: Lower bound of the largest weighted residual for all x within the regions; None for
            least squares.
    """

    x: Complex
    residual: Complex
    bound: float | None


def minimise(
    matrix: Complex,
    target: Complex,
    weights: Array,
    regions: Sequence[Region] = (),
    *,
    largest: bool = False,
) -> Smallest:
    """Return the x within the regions that makes `weight * |target - matrix @ x|` smallest.

    Args:
        matrix: Effect of each unknown on each reading, shape (readings, unknowns); its columns are
            independent.
        target: Readings to fit, shape (readings,).
        weights: Positive weights of the readings, shape (readings,).
        regions: Region of every unknown; empty: unknowns may lie anywhere.
        largest: Whether to minimise the largest weighted residual, not the sum of squares.
    """
    columns = weights[:, None] * matrix
    goal = weights * target
    sizes = np.linalg.norm(columns, axis=0)
    shares = np.full(len(goal), 1 / len(goal))
    x = best = np.zeros_like(matrix[0])
    bound = 0.0
    least = np.inf
    for _ in range(_ROUNDS if largest else 1):  # the first round has equal shares: least squares
        root = np.sqrt(shares)
        weighted = root[:, None] * columns / sizes
        x, settled = _solve_within(weighted, root * goal, sizes, regions, x)
        left = np.abs(goal - columns @ (x / sizes))
        if settled:
            bound = max(bound, float(np.sqrt(shares @ left**2)))
        if left.max() <= least:
            best = x
            least = float(left.max())
        if least <= _VANISHES * np.abs(goal).max():
            bound = 0.0
            break
        if least - bound <= _GAP * least:
            break
        shares = shares * (left + _REVIVED * left.max())
        shares /= shares.sum()
    return Smallest(best / sizes, target - matrix @ (best / sizes), bound if largest else None)


def _solve_within(
    matrix: Complex, target: Complex, sizes: Array, regions: Sequence[Region], x: Complex
) -> tuple[Complex, bool]:
    """Return the least squares solution with `x / sizes` in the regions, and whether the iteration
    that starts at x has converged.
    """
    free = solve(matrix, target).x
    if (_project(regions, sizes, free)[0] == free).all():
        return free, True
    square = matrix.conj().T @ matrix
    pull = matrix.conj().T @ target
    steepest = float(np.linalg.norm(square, 2))
    turn = np.array([[0, -1], [1, 0]])  # each complex number is two rows: real, imaginary
    curvature = np.kron(square.real, np.eye(2)) + np.kron(square.imag, turn)
    shrunk = np.eye(2 * len(x)) - curvature / steepest
    for _ in range(_STEPS):
        step, change = _project(regions, sizes, x + (pull - square @ x) / steepest)
        if np.abs(step - x).max() <= _SETTLED * np.abs(step).max():
            return x, True
        miss = (step - x).view(float)
        newton = np.linalg.lstsq(np.eye(len(miss)) - change @ shrunk, miss, rcond=None)[0]
        quick, _ = _project(regions, sizes, x + newton.view(complex))
        left = [float(np.linalg.norm(target - matrix @ one)) for one in (quick, step)]
        x = quick if left[0] <= left[1] * (1 + _SETTLED) else step
    return x, False


def _project(regions: Sequence[Region], sizes: Array, y: Complex) -> tuple[Complex, Array]:
    """Return the point nearest to y with `point / sizes` in the regions, and its derivative by y (a
    real matrix).
    """
    points = y.copy()
    change = np.eye(2 * len(y))
    for k, region in enumerate(regions):
        inner = y[k] / sizes[k]
        point, change[2 * k : 2 * k + 2, 2 * k : 2 * k + 2] = region.project(inner)
        points[k] = y[k] if point == inner else point * sizes[k]
    return points, change


def _project_on(direction: complex) -> Array:
    """Return the real (2, 2) matrix of the projection on a line through 0."""
    parts = np.array([direction.real, direction.imag])
    return np.outer(parts, parts)

"""Complex unknowns that make the largest of several residuals smallest, with a proof of how near
the optimum they are; and least squares: both also with unknowns that must stay in convex regions.

One barrier method serves both (Boyd and Vandenberghe, Convex Optimization, 11.3): Newton's method
on smooth functions whose minima lead near the optimum, then on the conditions of the optimum
themselves.

What is proved: for any shares `g >= 0` with sum 1 and prices `p >= 0`, the largest `|r|^2` is at
least `sum g |r|^2 + sum p excess`, so at least the smallest value that this quadratic can take
(Lawson's bound). At the optimum both agree: residuals with a share are all equal, and unknowns with
a price are at the edge of their region.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .least_squares import Solution, solve
from .phasors import Array, Complex

_GAP = 1e-8  # of the objective, at which the barrier ends
_STEEPER = 10.0  # how much steeper the barrier gets from round to round
_CENTRING_STEPS = 400  # 10 are usual; the first round takes 80 where regions differ in size
_SETTLED = 1e-10  # half the squared Newton decrement
_SHORTEST_STEP = 1e-10
_FINAL_STEPS = 8  # of Newton's method on the conditions of the optimum
_OUTSIDE = 1e-11  # share of the size of an unknown, of which it may be outside by rounding
_VANISHES = 1e-13  # share of the target below which a residual is rounding
_FLAT = 1e-9  # sine of an angle that is 0


class Region(NamedTuple):
    """A convex region of the complex plane: all x with `Re(conj(normal) x) <= support` for every
    edge and `|x - centre| <= radius`.

    Attributes:
        inside: a point that is at no edge.
        line: direction of the line through 0 in which the region lies, if it has no area.
    """

    inside: complex = 0j
    normals: Complex = np.zeros(0, dtype=complex)
    supports: Array = np.zeros(0)
    centre: complex = 0j
    radius: float = np.inf
    line: complex | None = None

    def has(self, x: complex, noise: float) -> bool:
        """Whether it has x, or a point no farther away than the noise."""
        beyond = (np.conj(self.normals) * x).real - self.supports
        return abs(x - self.centre) <= self.radius + noise and bool((beyond <= noise).all())

    def has_at_edge(self, x: complex, noise: float) -> bool:
        """Whether an x that it has is as near its edge as the noise. A line is all edge."""
        room = self.supports - (np.conj(self.normals) * x).real
        return bool(min(room.min(initial=np.inf), self.radius - abs(x - self.centre)) <= noise)

    def find_ends(self) -> NDArray[np.bool_]:
        """Which edges are not along its own line."""
        if self.line is None:
            return np.ones(len(self.normals), dtype=bool)
        return np.abs((np.conj(self.normals) * self.line).real) > _FLAT


ANYWHERE = Region()


def make_disc(radius: float, centre: complex = 0j) -> Region:
    """Unknowns of limited size."""
    return Region(centre, centre=centre, radius=radius)


class Smallest(NamedTuple):
    """The unknowns that were looked for.

    Attributes:
        x: shape (unknowns,).
        residual: `target - matrix @ x`, without weights, shape (readings,).
        largest: of the weighted residuals.
        bound: no x within the regions has a smaller largest weighted residual than this; nan where
            that was not asked for.
    """

    x: Complex
    residual: Complex
    largest: float
    bound: float


def minimise_largest(
    matrix: Complex, target: Complex, weights: Array, regions: Sequence[Region] = ()
) -> Smallest:
    """The x for which the largest `weight * |target - matrix @ x|` is smallest.

    Args:
        matrix: shape (readings, unknowns), its columns independent.
        target: shape (readings,). weights: positive factors of the readings.
        regions: of every unknown; none: anywhere.
    """
    start = _solve_scaled(matrix, target, weights)
    largest = float(np.abs(weights * start.residual).max())
    if largest <= _VANISHES * np.abs(weights * target).max(initial=0) and _fits(start.x, regions):
        return Smallest(start.x, start.residual, largest, 0.0)
    problem = _Problem(weights[:, None] * matrix, weights * target, regions, largest_only=True)
    x, bound = problem.minimise()
    residual = target - matrix @ x
    return Smallest(x, residual, float(np.abs(weights * residual).max()), bound)


def minimise_squares(
    matrix: Complex, target: Complex, weights: Array, regions: Sequence[Region] = ()
) -> Smallest:
    """The x for which the sum of `|weight * (target - matrix @ x)|^2` is least.

    Args: as of `minimise_largest`.
    """
    x = _solve_scaled(matrix, target, weights).x
    if not _fits(x, regions):
        problem = _Problem(weights[:, None] * matrix, weights * target, regions, largest_only=False)
        x, _ = problem.minimise()
    residual = target - matrix @ x
    return Smallest(x, residual, float(np.abs(weights * residual).max()), float("nan"))


def _solve_scaled(matrix: Complex, target: Complex, weights: Array) -> Solution[np.complex128]:
    """Least squares, whatever the sizes of the columns."""
    sizes = np.linalg.norm(weights[:, None] * matrix, axis=0)
    found = solve(matrix / sizes, target, weights)
    return found._replace(x=found.x / sizes)


def _fits(x: Complex, regions: Sequence[Region]) -> bool:
    return all(region.has(one, 0.0) for one, region in zip(x, regions, strict=bool(regions)))


class _Optimum(NamedTuple):
    """Real unknowns z, the objective's bound s, shares of the readings, prices of the edges."""

    z: Array
    s: float
    shares: Array
    prices: Array


class _Problem:
    """Smallest s of all `s >= |residual|^2` (or smallest sum of the squares), in real unknowns z:
    two for every x, one where its region is a line. Columns and target are scaled to size 1.

    Every edge of a region is a condition `excess <= 0` on one x: first those of the discs, then
    those of the half-planes.
    """

    def __init__(
        self, matrix: Complex, target: Complex, regions: Sequence[Region], largest_only: bool
    ) -> None:
        regions = regions or [ANYWHERE] * matrix.shape[1]
        self._size = float(np.abs(target).max()) or 1.0
        self._columns = np.linalg.norm(matrix, axis=0)
        self._matrix = matrix / self._columns
        self._target = target / self._size
        self._largest_only = largest_only
        self._set_conditions(regions, self._columns / self._size)
        self._basis = _find_basis(regions)
        rows = self._matrix @ self._basis
        self._rows = np.stack([rows.real, rows.imag])  # (2, readings, real unknowns)
        self._parts = np.stack([self._basis.real, self._basis.imag])  # (2, unknowns, real unknowns)

    def _set_conditions(self, regions: Sequence[Region], scale: Array) -> None:
        round_ones = [k for k, region in enumerate(regions) if np.isfinite(region.radius)]
        self._centres = np.array([regions[k].centre * scale[k] for k in round_ones], dtype=complex)
        self._radii = np.array([regions[k].radius * scale[k] for k in round_ones])
        edges = [region.find_ends() for region in regions]
        straight = np.repeat(np.arange(len(regions)), [int(edge.sum()) for edge in edges])
        self._owner = np.concatenate([np.array(round_ones, dtype=int), straight])
        self._normals = np.concatenate(
            [region.normals[edge] for region, edge in zip(regions, edges, strict=True)]
        )
        self._supports = scale[straight] * np.concatenate(
            [region.supports[edge] for region, edge in zip(regions, edges, strict=True)]
        )
        self._bend = np.where(np.arange(len(self._owner)) < len(round_ones), 2.0, 0.0)
        self._inside = scale * np.array([region.inside for region in regions], dtype=complex)
        wedges = [bool(len(r.supports)) and not r.supports.any() for r in regions]
        self._inside[wedges] /= np.abs(self._inside[wedges])

    def minimise(self) -> tuple[Complex, float]:
        """The optimal x, and the bound below which no largest residual is."""
        near = self._follow_barrier()
        best, bound = near, self._find_bound(near)
        for fine in self._refine(near):
            found = self._find_bound(fine)
            x = self._basis @ fine.z
            outside = self._excess(x).max(initial=0.0) > _OUTSIDE * (1 + np.abs(x).max()) ** 2
            if not outside and self._objective(fine.z) - found < self._objective(best.z) - bound:
                best, bound = fine, found
        x = (self._basis @ best.z) * self._size / self._columns
        return x, np.sqrt(max(bound, 0.0)) * self._size

    # -------------------------------------------------------------- figures
    def _residual(self, z: Array) -> Complex:
        return np.asarray(self._target - self._matrix @ (self._basis @ z))

    def _squares(self, z: Array) -> Array:
        residual = self._residual(z)
        return residual.real**2 + residual.imag**2

    def _slopes(self, z: Array) -> Array:
        """Of the squares by z."""
        residual = self._residual(z)
        parts = np.stack([residual.real, residual.imag])
        return np.asarray(-2 * np.einsum("pri,pr->ri", self._rows, parts))

    def _objective(self, z: Array) -> float:
        squares = self._squares(z)
        return float(squares.max() if self._largest_only else squares.sum())

    def _excess(self, x: Complex) -> Array:
        """Of every condition, positive outside."""
        discs = len(self._radii)
        straight = (np.conj(self._normals) * x[self._owner[discs:]]).real - self._supports
        return np.append(
            np.abs(x[self._owner[:discs]] - self._centres) ** 2 - self._radii**2, straight
        )

    def _find_outward(self, x: Complex) -> Complex:
        """Slope of every excess, in the plane of its own x."""
        discs = len(self._radii)
        return np.append(2 * (x[self._owner[:discs]] - self._centres), self._normals)

    def _spread(self, outward: Complex, chosen: NDArray[np.intp]) -> Array:
        """Slopes of some conditions by z, shape (conditions, real unknowns)."""
        return (np.conj(outward[chosen])[:, None] * self._basis[self._owner[chosen]]).real

    def _collect(self, values: Array) -> Array:
        """The sum of the conditions of each x."""
        return np.bincount(self._owner, values, minlength=len(self._basis)).astype(float)

    def _pull(self, outward: Complex, push: Array) -> Array:
        """`sum push * slope` by z."""
        real, imag = self._parts
        by_x = self._collect(push * outward.real), self._collect(push * outward.imag)
        return np.asarray(by_x[0] @ real + by_x[1] @ imag)

    def _curvature(self, shares: Array, prices: Array) -> Array:
        """Second derivatives of `sum share |r|^2 + sum price excess`."""
        second = 2 * np.einsum("pri,r,prj->ij", self._rows, shares, self._rows)
        bend = self._collect(prices * self._bend)
        return np.asarray(second + np.einsum("pki,k,pkj->ij", self._parts, bend, self._parts))

    def _find_bound(self, optimum: _Optimum) -> float:
        """The least that shares and prices leave: no objective within the regions is smaller.

        It is a quadratic whose value, slope and curvature are known where we are. Along each
        principal axis it falls by `slope^2 / (2 curvature)` at most, and by `slope * distance`: no
        optimum is farther away than what leaves residuals as large as here.
        """
        if min(optimum.shares.min(), optimum.prices.min(initial=0)) < 0:
            return -np.inf
        z, x = optimum.z, self._basis @ optimum.z
        value = optimum.shares @ self._squares(z) + optimum.prices @ self._excess(x)
        slope = optimum.shares @ self._slopes(z) + self._pull(self._find_outward(x), optimum.prices)
        curvature, axes = np.linalg.eigh(self._curvature(optimum.shares, optimum.prices))
        rows = self._rows.reshape(-1, len(z))
        left = np.sqrt(len(self._target) * self._objective(z))
        distance = np.linalg.norm(z) + (np.linalg.norm(self._target) + left) / np.linalg.norm(
            rows, ord=-2
        )
        along = np.abs(slope @ axes)
        steep = np.where(curvature > 0, along / np.where(curvature > 0, curvature, 1.0), np.inf)
        return float(value - along @ np.minimum(steep / 2, distance))

    # -------------------------------------------------------------- to the neighbourhood
    def _follow_barrier(self) -> _Optimum:
        """Near the optimum, inside the regions."""
        z = (np.conj(self._basis) * self._inside[:, None]).real.sum(axis=0)
        point = np.append(z, 2 * self._squares(z).max())
        count = len(self._owner) + (len(self._target) if self._largest_only else 0)
        steepness = count / self._objective(z)
        while count > _GAP * steepness * self._objective(point[:-1]):
            steepness *= _STEEPER
            point = self._centre(point, steepness)
        z, s = point[:-1], float(point[-1])
        prices = -1 / (steepness * self._excess(self._basis @ z))
        if not self._largest_only:
            return _Optimum(z, s, np.ones(len(self._target)), prices)
        shares = 1 / (s - self._squares(z))
        return _Optimum(z, s, shares / shares.sum(), prices)

    def _value(self, point: Array, steepness: float) -> float:
        """Of the objective with its barrier; infinite outside."""
        room, squares = -self._excess(self._basis @ point[:-1]), self._squares(point[:-1])
        slack = point[-1] - squares if self._largest_only else np.ones(1)
        if min(room.min(initial=1), slack.min()) <= 0:
            return float("inf")
        objective = point[-1] if self._largest_only else squares.sum()
        return float(steepness * objective - np.log(slack).sum() - np.log(room).sum())

    def _derivatives(self, point: Array, steepness: float) -> tuple[Array, Array]:
        """Gradient and second derivatives of that value."""
        z, size = point[:-1], len(point)
        x, slopes = self._basis @ z, self._slopes(z)
        outward, push = self._find_outward(x), -1 / self._excess(x)
        gradient, second = np.zeros(size), np.zeros((size, size))
        if self._largest_only:
            pull = 1 / (point[-1] - self._squares(z))
            slopes = np.append(slopes, -np.ones((len(slopes), 1)), axis=1)
            gradient += pull @ slopes
            gradient[-1] += steepness
            second += (slopes * pull[:, None] ** 2).T @ slopes
        else:
            pull = np.full(len(slopes), steepness)
            gradient[:-1] += pull @ slopes
            second[-1, -1] = 1.0  # s is not used
        gradient[:-1] += self._pull(outward, push)
        second[:-1, :-1] += self._curvature(pull, push) + self._square(outward * push)
        return gradient, second

    def _square(self, slopes: Complex) -> Array:
        """The sum of `slope slope^T` of all conditions, by z."""
        parts = np.stack([slopes.real, slopes.imag])
        sums = [[self._collect(one * other) for other in parts] for one in parts]
        return np.asarray(np.einsum("pki,pqk,qkj->ij", self._parts, sums, self._parts))

    def _centre(self, point: Array, steepness: float) -> Array:
        """The minimum for one steepness, by Newton's method with steps that stay inside."""
        value = self._value(point, steepness)
        for _ in range(_CENTRING_STEPS):
            gradient, second = self._derivatives(point, steepness)
            scale = 1 / np.sqrt(np.diagonal(second))
            scaled = second * np.outer(scale, scale)
            step = -scale * np.linalg.lstsq(scaled, scale * gradient, rcond=None)[0]
            decrement = -float(gradient @ step)
            if decrement / 2 <= _SETTLED:
                break
            length = 1.0
            while self._value(point + length * step, steepness) > value - 1e-4 * length * decrement:
                length /= 2
                if length < _SHORTEST_STEP:
                    return point  # nothing but rounding is left to win
            point = point + length * step
            value = self._value(point, steepness)
        return point

    # -------------------------------------------------------------- to the optimum
    def _refine(self, near: _Optimum) -> Iterator[_Optimum]:
        """Newton's method on the conditions of the optimum: squares with a share are all s, edges
        with a price are met, and the weighted slopes vanish.
        """
        slack = 1 - self._squares(near.z) / near.s
        sharing = np.flatnonzero(near.shares > slack) if self._largest_only else np.zeros(0, int)
        room, widest = -self._excess(self._basis @ near.z), -self._excess(self._inside)
        priced = np.flatnonzero(near.prices * widest**2 > room)
        z, s = near.z, near.s
        shares, prices = near.shares.copy(), np.zeros(len(near.prices))
        prices[priced] = near.prices[priced]
        if self._largest_only:
            shares = np.zeros(len(near.shares))
            shares[sharing] = near.shares[sharing]
        n, a, b = len(z), len(sharing), len(priced)
        for _ in range(_FINAL_STEPS):
            x, slopes = self._basis @ z, self._slopes(z)
            outward = self._find_outward(x)
            system = np.zeros((n + 1 + a + b, n + 1 + a + b))
            system[:n, :n] = self._curvature(shares, prices)
            system[:n, n + 1 : n + 1 + a] = slopes[sharing].T
            system[:n, n + 1 + a :] = self._spread(outward, priced).T
            system[n, n + 1 : n + 1 + a] = -1.0
            system[n + 1 :, : n + 1] = system[: n + 1, n + 1 :].T
            if not a:
                system[n, n] = 1.0  # s is not used
            wrong = np.concatenate(
                [
                    shares @ slopes + self._pull(outward, prices),
                    [1 - shares[sharing].sum() if a else 0.0],
                    self._squares(z)[sharing] - s,
                    self._excess(x)[priced],
                ]
            )
            step = np.linalg.lstsq(system, -wrong, rcond=None)[0]
            z, s = z + step[:n], s + step[n]
            shares[sharing] += step[n + 1 : n + 1 + a]
            prices[priced] += step[n + 1 + a :]
            yield _Optimum(z, s, shares.copy(), prices.copy())


def _find_basis(regions: Sequence[Region]) -> Complex:
    """What each real unknown is of each x, shape (unknowns, real unknowns)."""
    found = [
        (k, direction)
        for k, region in enumerate(regions)
        for direction in ([1, 1j] if region.line is None else [region.line])
    ]
    basis = np.zeros((len(regions), len(found)), dtype=complex)
    for j, (k, direction) in enumerate(found):
        basis[k, j] = direction
    return basis

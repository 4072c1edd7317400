"""Complex unknowns that make the largest of several residuals smallest, with a proof of how near
the optimum they are; and least squares with unknowns of limited size.

Both are convex, and one barrier method serves both (Boyd and Vandenberghe, Convex Optimization,
11.3): Newton's method on smooth functions whose minima lead near the optimum, then on the
conditions of the optimum themselves.

What is proved: for any shares `g >= 0` with sum 1 and prices `p >= 0`, the largest `|r|^2` is at
least `sum g |r|^2 + sum p (|x|^2 - most^2)`, so at least the smallest value that this can take,
which is a problem of least squares (Lawson's bound). At the optimum both agree: residuals with a
share are all equal, and unknowns with a price are at their limit.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .least_squares import Solution, solve

Complex = NDArray[np.complex128]
Array = NDArray[np.float64]

_GAP = 1e-8  # of the objective, at which the barrier ends
_STEEPER = 10.0  # how much steeper the barrier gets from round to round
_CENTRING_STEPS = 40
_SETTLED = 1e-10  # half the squared Newton decrement
_SHORTEST_STEP = 1e-10
_FINAL_STEPS = 8  # of Newton's method on the conditions of the optimum
_BINDS = 1 - 1e-7  # share of its limit above which an unknown is at it
_VANISHES = 1e-13  # share of the target below which a residual is rounding


class Smallest(NamedTuple):
    """The unknowns that were looked for.

    Attributes:
        x: shape (unknowns,).
        residual: `target - matrix @ x`, without weights, shape (readings,).
        largest: of the weighted residuals.
        bound: no x within the limits has a smaller largest weighted residual than this; nan where
            that was not asked for.
    """

    x: Complex
    residual: Complex
    largest: float
    bound: float


def minimise_largest(
    matrix: Complex, target: Complex, weights: Array, most: Array | None = None
) -> Smallest:
    """The x for which the largest `weight * |target - matrix @ x|` is smallest.

    Args:
        matrix: shape (readings, unknowns), its columns independent.
        target: shape (readings,). weights: positive factors of the readings.
        most: upper limits of `|x|`, infinite where there is none, shape (unknowns,).
    """
    start = _solve_scaled(matrix, target, weights)
    limits = np.full(matrix.shape[1], np.inf) if most is None else most
    largest = float(np.abs(weights * start.residual).max())
    if largest <= _VANISHES * np.abs(weights * target).max(initial=0) and _fits(start.x, limits):
        return Smallest(start.x, start.residual, largest, 0.0)
    problem = _Problem(weights[:, None] * matrix, weights * target, limits, largest_only=True)
    x, bound = problem.minimise()
    residual = target - matrix @ x
    return Smallest(x, residual, float(np.abs(weights * residual).max()), bound)


def minimise_squares_within(
    matrix: Complex, target: Complex, weights: Array, most: Array
) -> Smallest:
    """The x with `|x| <= most` for which the sum of `|weight * (target - matrix @ x)|^2` is least.

    Args:
        matrix: shape (readings, unknowns), its columns independent.
        target: shape (readings,). weights: positive factors of the readings.
        most: upper limits, infinite where there is none, shape (unknowns,).
    """
    x = _solve_scaled(matrix, target, weights).x
    if not _fits(x, most):
        problem = _Problem(weights[:, None] * matrix, weights * target, most, largest_only=False)
        x, _ = problem.minimise()
    residual = target - matrix @ x
    return Smallest(x, residual, float(np.abs(weights * residual).max()), float("nan"))


def find_limited(x: Complex, most: Array) -> list[int]:
    """Which unknowns are at their limit."""
    return [int(k) for k in np.flatnonzero(np.abs(x) >= _BINDS * most)]


def _solve_scaled(matrix: Complex, target: Complex, weights: Array) -> Solution[np.complex128]:
    """Least squares, whatever the sizes of the columns."""
    sizes = np.linalg.norm(weights[:, None] * matrix, axis=0)
    found = solve(matrix / sizes, target, weights)
    return found._replace(x=found.x / sizes)


def _fits(x: Complex, most: Array) -> bool:
    return bool((np.abs(x) <= most).all())


class _Optimum(NamedTuple):
    """Real unknowns z, the objective's bound s, shares of the readings, prices of the limits."""

    z: Array
    s: float
    shares: Array
    prices: Array


class _Problem:
    """Smallest s of all `s >= |residual|^2` (or smallest sum of the squares), in real unknowns z:
    real parts of x, then imaginary parts. Columns and target are scaled to size 1.
    """

    def __init__(self, matrix: Complex, target: Complex, most: Array, largest_only: bool) -> None:
        self._size = float(np.abs(target).max())
        self._columns = np.linalg.norm(matrix, axis=0)
        self._matrix = matrix / self._columns
        self._target = target / self._size
        self._most = most * self._columns / self._size
        self._limited = np.flatnonzero(np.isfinite(self._most))
        self._largest_only = largest_only
        rows = np.concatenate([self._matrix, 1j * self._matrix], axis=1)
        self._rows = np.stack([rows.real, rows.imag])  # (2, readings, real unknowns)

    def minimise(self) -> tuple[Complex, float]:
        """The optimal x, and the bound below which no largest residual is."""
        near = self._follow_barrier()
        best, bound = near, self._find_bound(near)
        for fine in self._refine(near):
            found = self._find_bound(fine)
            if self._objective(fine.z) - found < self._objective(best.z) - bound:
                best, bound = fine, found
        x = self._complex(best.z) * self._size / self._columns
        return x, np.sqrt(max(bound, 0.0)) * self._size

    # -------------------------------------------------------------- figures
    def _complex(self, z: Array) -> Complex:
        count = self._matrix.shape[1]
        return np.asarray(z[:count] + 1j * z[count:])

    def _squares(self, z: Array) -> Array:
        residual = self._target - self._matrix @ self._complex(z)
        return residual.real**2 + residual.imag**2

    def _slopes(self, z: Array) -> Array:
        """Of the squares by z."""
        residual = self._target - self._matrix @ self._complex(z)
        parts = np.stack([residual.real, residual.imag])
        return np.asarray(-2 * np.einsum("pri,pr->ri", self._rows, parts))

    def _objective(self, z: Array) -> float:
        squares = self._squares(z)
        return float(squares.max() if self._largest_only else squares.sum())

    def _excess(self, z: Array) -> Array:
        """Squares of limited unknowns less those of their limits."""
        k = self._limited
        return np.asarray(np.abs(self._complex(z)[k]) ** 2 - self._most[k] ** 2)

    def _excess_slopes(self, z: Array) -> Array:
        slopes = np.zeros((len(self._limited), len(z)))
        for row, k in enumerate(self._limited):
            pair = [k, len(z) // 2 + k]
            slopes[row, pair] = 2 * z[pair]
        return slopes

    def _curvature(self, shares: Array, prices: Array) -> Array:
        """Second derivatives of `sum share |r|^2 + sum price |x|^2`."""
        second = 2 * np.einsum("pri,r,prj->ij", self._rows, shares, self._rows)
        for price, k in zip(prices, self._limited, strict=True):
            for j in (k, len(second) // 2 + k):
                second[j, j] += 2 * price
        return np.asarray(second)

    def _find_bound(self, optimum: _Optimum) -> float:
        """The least that shares and prices leave: no objective within the limits is smaller."""
        if min(optimum.shares.min(), optimum.prices.min(initial=0)) < 0:
            return -np.inf
        roots = np.sqrt(optimum.shares)
        limits = np.zeros((len(self._limited), self._matrix.shape[1]), dtype=complex)
        limits[np.arange(len(limits)), self._limited] = np.sqrt(optimum.prices)
        rows = np.concatenate([roots[:, None] * self._matrix, limits])
        target = np.concatenate([roots * self._target, np.zeros(len(limits))])
        left = np.linalg.norm(solve(rows, target).residual) ** 2
        return float(left - optimum.prices @ self._most[self._limited] ** 2)

    # -------------------------------------------------------------- to the neighbourhood
    def _follow_barrier(self) -> _Optimum:
        """Near the optimum, inside the limits."""
        free = solve(self._matrix, self._target).x
        x = free * min(1.0, 0.5 * float((self._most / np.maximum(np.abs(free), 1e-300)).min()))
        z = np.concatenate([x.real, x.imag])
        point = np.append(z, 2 * self._squares(z).max())
        count = len(self._limited) + (len(self._target) if self._largest_only else 0)
        steepness = count / self._objective(z)
        while count > _GAP * steepness * self._objective(point[:-1]):
            steepness *= _STEEPER
            point = self._centre(point, steepness)
        z, s = point[:-1], float(point[-1])
        prices = -1 / (steepness * self._excess(z))
        if not self._largest_only:
            return _Optimum(z, s, np.ones(len(self._target)), prices)
        shares = 1 / (s - self._squares(z))
        return _Optimum(z, s, shares / shares.sum(), prices)

    def _value(self, point: Array, steepness: float) -> float:
        """Of the objective with its barrier; infinite outside."""
        room, squares = -self._excess(point[:-1]), self._squares(point[:-1])
        slack = point[-1] - squares if self._largest_only else np.ones(1)
        if min(room.min(initial=1), slack.min()) <= 0:
            return float("inf")
        objective = point[-1] if self._largest_only else squares.sum()
        return float(steepness * objective - np.log(slack).sum() - np.log(room).sum())

    def _derivatives(self, point: Array, steepness: float) -> tuple[Array, Array]:
        """Gradient and second derivatives of that value."""
        z, size = point[:-1], len(point)
        slopes, outward = self._slopes(z), self._excess_slopes(z)
        push = -1 / self._excess(z)
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
        gradient[:-1] += push @ outward
        second[:-1, :-1] += self._curvature(pull, push)
        second[:-1, :-1] += (outward * push[:, None] ** 2).T @ outward
        return gradient, second

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
        """Newton's method on the conditions of the optimum: squares with a share are all s, limits
        with a price are met, and the weighted slopes vanish.
        """
        slack = 1 - self._squares(near.z) / near.s
        sharing = np.flatnonzero(near.shares > slack) if self._largest_only else np.zeros(0, int)
        priced = np.flatnonzero(
            near.prices * self._most[self._limited] ** 2 > -self._excess(near.z)
        )
        z, s = near.z, near.s
        shares, prices = near.shares.copy(), np.zeros(len(near.prices))
        prices[priced] = near.prices[priced]
        if self._largest_only:
            shares = np.zeros(len(near.shares))
            shares[sharing] = near.shares[sharing]
        n, a, b = len(z), len(sharing), len(priced)
        for _ in range(_FINAL_STEPS):
            slopes, outward = self._slopes(z), self._excess_slopes(z)
            system = np.zeros((n + 1 + a + b, n + 1 + a + b))
            system[:n, :n] = self._curvature(shares, prices)
            system[:n, n + 1 : n + 1 + a] = slopes[sharing].T
            system[:n, n + 1 + a :] = outward[priced].T
            system[n, n + 1 : n + 1 + a] = -1.0
            system[n + 1 :, : n + 1] = system[: n + 1, n + 1 :].T
            if not a:
                system[n, n] = 1.0  # s is not used
            wrong = np.concatenate(
                [
                    shares @ slopes + prices @ outward,
                    [1 - shares[sharing].sum() if a else 0.0],
                    self._squares(z)[sharing] - s,
                    self._excess(z)[priced],
                ]
            )
            step = np.linalg.lstsq(system, -wrong, rcond=None)[0]
            z, s = z + step[:n], s + step[n]
            shares[sharing] += step[n + 1 : n + 1 + a]
            prices[priced] += step[n + 1 + a :]
            yield _Optimum(z, s, shares.copy(), prices.copy())

"""Balance shafts turned unevenly by an eccentric slider: the best throw and mass for a single
cylinder (Wang, section 2.4).

Two shafts, symmetric to the cylinder axis, turn by phi(theta); their force along the axis is `2 m_b
r_b omega^2 (phi'^2 cos phi + phi'' sin phi) = -2 m_b r_b omega^2 (cos phi)''` (the sign of the
second term is misprinted in the source). In units of m r omega^2 what remains is `P = f(theta) - 2
mu g(theta; k)`, an even function; k and mu are sought.

Below, `c` holds cosine coefficients of an even function, shape (orders,), and `x` the two unknowns
k and mu, shape (2,).
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from itertools import combinations, product

import numpy as np
from numpy.typing import NDArray

from ..core.mechanisms import closed_form
from ..core.phasors import Array, Complex
from ..errors import BalcliError
from .scheme_figures import Optimum

DESIGNS = ("a", "b")  # pin on the shaft, slot in the disc; pin on the disc, slot on the shaft
CRITERIA = ("largest", "mean")
FORCES = ("orders 1+2", "all orders")  # cos theta + lambda cos 2 theta; the exact force
_LEAST_K, _MOST_K = 1.2, 1e12  # k is sought between; nearer to 1 its series is too long
_COUNT = 512  # samples of a revolution: enough for k above _LEAST_K
_GRID = np.linspace(0, np.pi, 1025)
_ORDERS = np.arange(_COUNT // 4)
_ROUNDS = 60
_NOISE = 5e-16  # of the transform; squares of the orders would multiply it
_SETTLED = 1e-10  # relative
_FARTHEST_TO_PEAK, _FARTHEST_TO_MEAN = 0.25, 0.1  # share of k by which it moves in one step
_SINGULAR = 1e-14  # determinant of a triple that fixes nothing
_BELOW_0 = -1e-12  # a weight above this is 0 but for rounding
_NEWTON_STEPS = 8  # from the middle of a cell of the grid to a root, to rounding


def find_optimum(design: str, criterion: str, engine_force: str, lam: float) -> Optimum:
    """The best k and mu of one design by one criterion.

    Args:
        design, criterion, engine_force: of DESIGNS, CRITERIA, FORCES.
        lam: crank radius over rod length.

    Raises BalcliError where lambda is so large that the search does not settle.
    """
    engine = _expand_engine_force(engine_force, lam)
    try:
        x = _minimise_peak(design, engine, np.array([2 / lam, 0.5]))
        if criterion == "mean":
            x = _minimise_mean(design, engine, x)
    except (np.linalg.LinAlgError, ArithmeticError):
        raise BalcliError(
            f"eccentric-slider: no optimum was found for design {design} at lambda = {lam:g}: the "
            "second order is too strong for an eccentric smaller than its pin radius"
        ) from None
    remaining = _find_remaining(design, engine, x)
    primitive = _evaluate(remaining, _find_zeros(remaining), -1)
    return Optimum(
        design,
        criterion,
        engine_force,
        k=float(x[0]),
        mu=float(x[1]),
        largest=float(np.abs(_evaluate(remaining, _find_extremes(remaining))).max()),
        mean=float(np.abs(np.diff(primitive)).sum()) / np.pi,
    )


def find_optima(lam: float) -> tuple[Optimum, ...]:
    """The optima of both designs by both criteria for both forces: first the smallest peak of
    design a for orders 1 and 2.

    At lambda above 0.6 some searches do not settle, as k would fall below 1: their optima are left
    out. Raises BalcliError if the first one does not settle.
    """
    (force, design, criterion), *others = product(FORCES, DESIGNS, CRITERIA)
    optima = [find_optimum(design, criterion, force, lam)]
    for force, design, criterion in others:
        with suppress(BalcliError):
            optima.append(find_optimum(design, criterion, force, lam))
    return tuple(optima)


def expand_shaft_wave(design: str, k: float) -> tuple[Array, Array]:
    """Cosine coefficients of cos phi over the crank angle, and their derivatives by k."""
    theta = np.arange(_COUNT) * np.float64(2 * np.pi / _COUNT)
    step = 1e-30  # complex step: the derivative to rounding
    wave = _find_cos_phi(design, theta, k + 1j * step)
    return _find_cosines(wave.real), _find_cosines(wave.imag / step)


def _find_cos_phi(design: str, theta: Array, k: complex) -> Complex:
    """cos phi at crank angles theta, same shape; phi is the angle of the shafts."""
    wave: Complex
    if design == "a":
        wave = (np.cos(theta) * np.sqrt(k**2 - np.sin(theta) ** 2) - np.sin(theta) ** 2) / k
    else:
        wave = (k * np.cos(theta) - 1) / np.sqrt(1 + k**2 - 2 * k * np.cos(theta))
    return wave


def _find_cosines(samples: Array) -> Array:
    """Cosine coefficients of an even function from samples of one revolution."""
    c = np.fft.rfft(samples).real / _COUNT * 2
    return np.where(np.abs(c) > _NOISE, c, 0)[: len(_ORDERS)]


def _expand_engine_force(engine_force: str, lam: float) -> Array:
    """Cosine coefficients of the force of the piston in units of m r omega^2."""
    if engine_force == "all orders":
        return closed_form.piston(_ORDERS, lam)
    return np.where(_ORDERS == 1, 1.0, np.where(_ORDERS == 2, lam, 0.0))


def _find_remaining(design: str, engine: Array, x: Array) -> Array:
    """Cosine coefficients of P, what remains of the engine's force."""
    if not _LEAST_K < x[0] < _MOST_K:
        raise ArithmeticError(f"k must stay above {_LEAST_K}")
    return engine - 2 * x[1] * _ORDERS**2 * expand_shaft_wave(design, x[0])[0]


def _find_slopes(design: str, x: Array) -> Array:
    """Derivatives of the coefficients of P by k and by mu, shape (2, orders)."""
    wave, by_k = expand_shaft_wave(design, x[0])
    return -2 * _ORDERS**2 * np.stack([x[1] * by_k, wave])


# ------------------------------------------------------------------ even series
def _evaluate(c: Array, theta: Array, derivative: int = 0) -> Array:
    """Values at some angles, shape (angles,), or (angles, 2) for two series in rows; differentiated
    so many times, or integrated (-1).
    """
    rate = (np.where(_ORDERS, _ORDERS, np.inf) if derivative < 0 else _ORDERS) ** float(derivative)
    angle = np.multiply.outer(theta, _ORDERS) + derivative * np.pi / 2
    values: Array = np.cos(angle) @ (rate * c).T
    return values


def _find_extremes(c: Array) -> Array:
    """Angles in [0, pi] of the extremes, the two ends among them."""
    slope = _evaluate(c, _GRID, 1)
    inside = _find_roots(
        lambda theta: _evaluate(c, theta, 1),
        lambda theta: _evaluate(c, theta, 2),
        np.flatnonzero(slope[1:-2] * slope[2:-1] < 0) + 1,
    )
    return np.concatenate([[0.0], inside, [np.pi]])


def _find_zeros(c: Array) -> Array:
    """0, the zeros in between, and pi."""
    values = _evaluate(c, _GRID)
    inside = _find_roots(
        lambda theta: _evaluate(c, theta),
        lambda theta: _evaluate(c, theta, 1),
        np.flatnonzero(values[:-1] * values[1:] < 0),
    )
    return np.concatenate([[0.0], inside, [np.pi]])


def _find_roots(
    f: Callable[[Array], Array], slope: Callable[[Array], Array], cells: NDArray[np.intp]
) -> Array:
    """The root in each of these cells of the grid, by Newton's method kept inside."""
    low, high = _GRID[cells], _GRID[cells + 1]
    theta = (low + high) / 2
    for _ in range(_NEWTON_STEPS):
        theta = np.clip(theta - f(theta) / slope(theta), low, high)
    return theta


# ------------------------------------------------------------------ the two criteria
def _minimise_peak(design: str, engine: Array, x: Array) -> Array:
    """Exchange: the linearised problem over the extremes of P, whose solution three of them fix,
    until nothing moves.
    """
    for _ in range(_ROUNDS):
        remaining = _find_remaining(design, engine, x)
        theta = _find_extremes(remaining)
        values = _evaluate(remaining, theta)
        slopes = np.sign(values)[:, None] * _evaluate(_find_slopes(design, x), theta)
        move = _exchange(np.abs(values), slopes)
        x = _move(x, move, _FARTHEST_TO_PEAK)
        if np.all(np.abs(move) <= _SETTLED * np.abs(x)):
            return x
    raise ArithmeticError("no convergence")


def _exchange(values: Array, slopes: Array) -> Array:
    """The step d that makes the largest of `values + slopes d` smallest: that of the triple whose
    bound is highest (de la Vallee-Poussin).

    Args:
        values, slopes: shapes (extremes,) and (extremes, 2).
    """
    top, best = -np.inf, None
    for triple in map(list, combinations(range(len(values)), 3)):
        system = np.column_stack([slopes[triple], -np.ones(3)])
        if abs(np.linalg.det(system)) < _SINGULAR:
            continue
        weights = np.linalg.solve(system.T, [0, 0, -1.0])
        solution = np.linalg.solve(system, -values[triple])
        if np.all(weights >= _BELOW_0) and solution[2] > top:
            top, best = solution[2], solution[:2]
    if best is None:
        raise ArithmeticError("no three extremes balance")
    return np.asarray(best)


def _minimise_mean(design: str, engine: Array, x: Array) -> Array:
    """Newton's method on the gradient of the integral of |P|, in closed form by the zeros of P."""

    def find_gradient(x: Array) -> Array:
        remaining = _find_remaining(design, engine, x)
        zeros = _find_zeros(remaining)
        signs = np.sign(_evaluate(remaining, (zeros[:-1] + zeros[1:]) / 2))
        gradient: Array = signs @ np.diff(_evaluate(_find_slopes(design, x), zeros, -1), axis=0)
        return gradient

    for _ in range(_ROUNDS):
        columns = [
            (find_gradient(x + step) - find_gradient(x - step)) / (2 * step.sum())
            for step in np.diag(1e-6 * x)
        ]
        move = -np.linalg.solve(np.column_stack(columns), find_gradient(x))
        x = _move(x, move, _FARTHEST_TO_MEAN)
        if np.all(np.abs(move) <= _SETTLED * np.abs(x)):
            return x
    raise ArithmeticError("no convergence")


def _move(x: Array, move: Array, share: float) -> Array:
    """The unknowns moved so far that k changes by this share of itself at most."""
    farthest: float = share * x[0] / max(abs(move[0]), 1e-300)
    return x + move * min(1.0, farthest)

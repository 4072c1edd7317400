"""Balance shafts turned unevenly by an eccentric slider: the best throw and mass for a single
cylinder (Wang, section 2.4).

Two shafts, symmetric to the cylinder axis, turn by phi(theta); their force along the axis is `2 m_b
r_b omega^2 (phi'^2 cos phi + phi'' sin phi) = -2 m_b r_b omega^2 (cos phi)''` (the sign of the
second term is misprinted in the source). In units of m r omega^2 what remains is `P = f(theta) - 2
mu g(theta; k)`, an even function; k and mu are sought.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from itertools import combinations, product
from typing import Any

import numpy as np

from ..core.mechanisms import closed_form
from ..core.phasors import Array
from ..errors import BalcliError

DESIGNS = ("a", "b")  # pin on the shaft, slot in the disc; pin on the disc, slot on the shaft
CRITERIA = ("largest", "mean")
FORCES = ("orders 1+2", "all orders")  # cos theta + lambda cos 2 theta; the exact force
_COUNT = 512  # samples of a revolution: enough for k above 1.2
_GRID = np.linspace(0, np.pi, 1025)
_ORDERS = np.arange(_COUNT // 4)
_ROUNDS = 60
_NOISE = 5e-16  # of the transform; squares of the orders would multiply it
_SETTLED = 1e-10  # relative


@dataclass(frozen=True)
class Optimum:
    """Best k = r_b/e and mu = m_b r_b/(m r), and the largest and mean absolute force that remain,
    in units of m r omega^2.
    """

    design: str
    criterion: str
    force: str
    k: float
    mu: float
    largest: float
    mean: float


def best(design: str, criterion: str, force: str, lam: float) -> Optimum:
    """The optimum of one design by one criterion; BalcliError where lambda is so large that the
    search does not settle.
    """
    engine = _engine_force(force, lam)
    try:
        x = _smallest_peak(design, engine, np.array([2 / lam, 0.5]))
        if criterion == "mean":
            x = _smallest_mean(design, engine, x)
    except (np.linalg.LinAlgError, ArithmeticError):
        raise BalcliError(
            f"eccentric-slider: no optimum was found for design {design} at lambda = {lam:g}: the "
            "second order is too strong "
            "for an eccentric smaller than its pin radius"
        ) from None
    rest = _remaining(design, engine, x)
    zeros = _zeros(rest)
    primitive = _values(rest, zeros, -1)
    mean = float(np.abs(np.diff(primitive)).sum()) / np.pi
    return Optimum(
        design,
        criterion,
        force,
        float(x[0]),
        float(x[1]),
        float(np.abs(_values(rest, _extrema(rest))).max()),
        mean,
    )


def settled(lam: float) -> list[Optimum]:
    """All optima that there are; at lambda above 0.6 some search does not settle, as k would fall
    below 1.
    """
    found = []
    for force, design, criterion in product(FORCES, DESIGNS, CRITERIA):
        with suppress(BalcliError):
            found.append(best(design, criterion, force, lam))
    return found


def shafts(design: str, k: Any) -> tuple[Array, Array]:
    """Cosine coefficients of `g m^-2 = cos phi` up to sign, i.e. of cos phi, and of its derivative
    by k.
    """
    theta = np.arange(_COUNT, dtype=np.float64) * (2 * np.pi / _COUNT)
    step = 1e-30  # complex step: the derivative to rounding
    wave = _cos_phi(design, theta, k + 1j * step)
    return _cosines(wave.real), _cosines(wave.imag / step)


def _cos_phi(design: str, theta: Array, k: Any) -> Any:
    if design == "a":
        return (np.cos(theta) * np.sqrt(k**2 - np.sin(theta) ** 2) - np.sin(theta) ** 2) / k
    return (k * np.cos(theta) - 1) / np.sqrt(1 + k**2 - 2 * k * np.cos(theta))


def _cosines(samples: Array) -> Array:
    c: Array = np.fft.rfft(samples).real / _COUNT * 2
    return np.where(np.abs(c) > _NOISE, c, 0)[: len(_ORDERS)]


def _engine_force(force: str, lam: float) -> Array:
    if force == "all orders":
        return closed_form.piston(_ORDERS, lam)
    return np.where(_ORDERS == 1, 1.0, np.where(_ORDERS == 2, lam, 0.0))


def _remaining(design: str, engine: Array, x: Array) -> Array:
    """Cosine coefficients of what remains."""
    if not (1.2 < x[0] < 1e12):
        raise ArithmeticError("k must stay above 1")
    return engine - 2 * x[1] * _ORDERS**2 * shafts(design, x[0])[0]


def _slopes(design: str, x: Array) -> Array:
    """Its derivatives by k and mu, shape (2, orders)."""
    wave, by_k = shafts(design, x[0])
    return -2 * _ORDERS**2 * np.stack([x[1] * by_k, wave])


def _values(c: Array, theta: Array, derivative: int = 0) -> Array:
    """The even series at some angles, differentiated (or integrated, -1) so many times."""
    rate = (np.where(_ORDERS, _ORDERS, np.inf) if derivative < 0 else _ORDERS) ** float(derivative)
    angle = np.multiply.outer(theta, _ORDERS) + derivative * np.pi / 2
    values: Array = np.cos(angle) @ (rate * c).T
    return values


def _extrema(c: Array) -> Array:
    """Angles in [0, pi] of the extremes of an even series."""
    slope = _values(c, _GRID, 1)
    inside = _root(
        lambda t: _values(c, t, 1),
        lambda t: _values(c, t, 2),
        np.flatnonzero(slope[1:-2] * slope[2:-1] < 0) + 1,
    )
    return np.concatenate([[0.0], inside, [np.pi]])


def _zeros(c: Array) -> Array:
    """0, the zeros of an even series in between, and pi."""
    values = _values(c, _GRID)
    inside = _root(
        lambda t: _values(c, t),
        lambda t: _values(c, t, 1),
        np.flatnonzero(values[:-1] * values[1:] < 0),
    )
    return np.concatenate([[0.0], inside, [np.pi]])


def _root(f: Callable[[Array], Array], df: Callable[[Array], Array], cells: Any) -> Array:
    """Roots in these cells of the grid, by Newton's method kept inside."""
    low, high = _GRID[cells], _GRID[cells + 1]
    theta = (low + high) / 2
    for _ in range(8):
        theta = np.clip(theta - f(theta) / df(theta), low, high)
    return theta


def _smallest_peak(design: str, engine: Array, x: Array) -> Array:
    """Exchange: the linearised problem over the extremes of P, whose solution three of them fix,
    until nothing moves.
    """
    for _ in range(_ROUNDS):
        rest = _remaining(design, engine, x)
        theta = _extrema(rest)
        values = _values(rest, theta)
        rows = np.sign(values)[:, None] * _values(_slopes(design, x), theta)
        move = _exchange(np.abs(values), rows)
        x = x + move * min(1.0, 0.25 * x[0] / max(abs(move[0]), 1e-300))
        if np.all(np.abs(move) <= _SETTLED * np.abs(x)):
            return x
    raise ArithmeticError("no convergence")


def _exchange(values: Array, rows: Array) -> Array:
    """The step d that makes the largest of `values + rows d` smallest: that of the triple whose
    bound is highest (de la Vallee-Poussin).
    """
    top, best = -np.inf, None
    for triple in combinations(range(len(values)), 3):
        system = np.column_stack([rows[list(triple)], -np.ones(3)])
        if abs(np.linalg.det(system)) < 1e-14:
            continue
        weights = np.linalg.solve(system.T, [0, 0, -1.0])
        solution = np.linalg.solve(system, -values[list(triple)])
        if np.all(weights >= -1e-12) and solution[2] > top:
            top, best = solution[2], solution[:2]
    if best is None:
        raise ArithmeticError("no three extremes balance")
    return np.asarray(best)


def _smallest_mean(design: str, engine: Array, x: Array) -> Array:
    """Newton's method on the gradient of the integral of |P|, which the zeros of P give in closed
    form.
    """

    def gradient(x: Array) -> Array:
        rest = _remaining(design, engine, x)
        zeros = _zeros(rest)
        signs = np.sign(_values(rest, (zeros[:-1] + zeros[1:]) / 2))
        found: Array = signs @ np.diff(_values(_slopes(design, x), zeros, -1), axis=0)
        return found

    for _ in range(_ROUNDS):
        steps = np.diag(1e-6 * x)
        jacobian = np.column_stack(
            [(gradient(x + h) - gradient(x - h)) / (2 * h.sum()) for h in steps]
        )
        move = -np.linalg.solve(jacobian, gradient(x))
        x = x + move * min(1.0, 0.1 * x[0] / max(abs(move[0]), 1e-300))
        if np.all(np.abs(move) <= _SETTLED * np.abs(x)):
            return x
    raise ArithmeticError("no convergence")

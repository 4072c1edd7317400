"""Mass, damping and stiffness: natural modes, and the motion that harmonic loads cause.

Every motion and load by order is complex, its value in time `Re(c e^{i w t})`. Frequencies w are in
rad/s and of any shape, commonly (orders, speeds) as `frequencies` makes them; whatever has one
value for each degree of freedom carries these as its last axis: (orders, speeds, dof).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

Real = NDArray[np.floating]
Complex = NDArray[np.complexfloating]
Indices = NDArray[np.intp]

UNDAMPED = 2e-9  # a loss factor up to here is none: no machine vibrates for a billion turns
ROUNDING = 1e-12  # a share of damping, or a distance of two frequencies, up to here is rounding
_UNMOVED = 1e-10  # a share of the load up to here does not drive a mode
_SINGULAR = 1e-11  # a motion in which the load does less than this share of all work is a mode
_RANK = 1e-13  # singular values below this share of the largest are 0


class Modes(NamedTuple):
    """Natural modes without damping, lowest first; the rigid ones lead.

    Attributes:
        omega: (modes,) angular frequencies, rad/s; of rigid modes exactly 0.
        shapes: (modes, dof), of unit modal mass: `shapes M shapes^T = 1`.
        rigid: how many of them are rigid.
    """

    omega: Real
    shapes: Real
    rigid: int


class Resonance(NamedTuple):
    """An undamped mode (its index in `Modes`) met by an order at a speed (rad/s)."""

    mode: int
    order: float
    speed: float


class UndampedResonanceError(ValueError):
    """A load drives an undamped mode at its own frequency (rad/s), where no steady motion exists.

    Attributes:
        frequency: rad/s.
    """

    def __init__(self, frequency: float) -> None:
        self.frequency = frequency
        super().__init__(f"undamped resonance at {frequency:.6g} rad/s")


def frequencies(orders: ArrayLike, speeds: ArrayLike) -> Real:
    """Return the angular frequency of each order at each speed, shape (orders, *speeds).

    Args:
        orders: Orders, shape (orders,).
        speeds: Speeds, rad/s, any shape.
    """
    return np.multiply.outer(np.asarray(orders, float), np.asarray(speeds, float))


def find_modes(springs: Real, stiffness: Real, mass: Real, rigid: Real | None = None) -> Modes:
    """Return natural modes of masses on springs.

    The frequencies are the singular values of `k^1/2 S M^-1/2`, not the roots of the eigenvalues of
    `(S^T k S, M)`: squaring would lose half the figures of the low ones.

    Args:
        springs: S (springs, dof), stretch of each spring for a unit of each motion.
        stiffness: k (springs,), above 0.
        mass: M (dof, dof), positive definite, or its diagonal (dof,).
        rigid: (count, dof), all independent motions that stretch no spring; left out: none.
    """
    rigid = np.zeros((0, springs.shape[1])) if rigid is None else rigid
    root = np.diag(np.sqrt(mass)) if mass.ndim == 1 else np.linalg.cholesky(mass)  # L: M = L L^T
    scaled = np.sqrt(stiffness)[:, None] * np.linalg.solve(root, springs.T).T
    _, falling, turned = np.linalg.svd(scaled, full_matrices=False)
    elastic = slice(springs.shape[1] - len(rigid))
    omega, turned = falling[elastic][::-1], turned[elastic][::-1]
    mixed = np.linalg.qr((rigid @ root).T, mode="r")
    signed = mixed * np.copysign(1, np.diag(mixed))[:, None]
    still = np.linalg.solve(signed.T, rigid)  # each of unit modal mass, orthogonal to the others
    shapes = np.concatenate([still, np.linalg.solve(root.T, turned.T).T])
    return Modes(np.concatenate([np.zeros(len(still)), omega]), shapes, len(still))


def scale_shapes(shapes: Real) -> Real:
    """Return mode shapes (modes, dof) with their largest element +1 (of equal ones the first)."""
    size = np.abs(shapes)
    near = size >= size.max(axis=1, keepdims=True) * (1 - 1e-9)
    largest = np.take_along_axis(shapes, np.argmax(near, axis=1)[:, None], axis=1)
    return shapes / largest


def modal_loss(modes: Modes, stiffness: Complex, damping: Real) -> Real:
    """Return the loss factor (modes,) of every mode, `x^T (Im K + w C) x / w^2`; rigid modes have
    0.

    A mode alone at resonance is magnified by its inverse.

    Args:
        modes: of n degrees of freedom.
        stiffness: K (n, n) with its loss.
        damping: C (n, n), N s/m or N m s.
    """
    x, omega = modes.shapes, modes.omega
    lost = np.einsum("mi,ij,mj->m", x, stiffness.imag, x)
    damped = omega * np.einsum("mi,ij,mj->m", x, damping, x)
    return np.where(omega > 0, (lost + damped) / np.where(omega > 0, omega, 1) ** 2, 0)


def find_resonances(
    modes: Modes, loss: Real, orders: Real, speeds: Real, load: Complex
) -> tuple[Resonance, ...]:
    """Return undamped modes that a load drives at their own frequency somewhere in a range of
    speeds, between the speeds computed too: there, motion has no bound.

    Args:
        modes: with shapes (modes, dof).
        loss: (modes,) as of `modal_loss`.
        orders: (orders,).
        speeds: (speeds,) rad/s, rising; the range runs from the first to the last.
        load: that broadcasts to (orders, speeds, dof).
    """
    load = np.broadcast_to(load, (len(orders), len(speeds), modes.shapes.shape[1]))
    undamped = (modes.omega > 0) & (loss <= UNDAMPED)
    met = [
        Resonance(int(mode), float(order), float(modes.omega[mode] / order))
        for mode in np.flatnonzero(undamped)
        for row, order in enumerate(orders)
        if order > 0 and _drives(modes, mode, float(order), speeds, load[row])
    ]
    return tuple(met)


def _drives(modes: Modes, mode: np.intp, order: float, speeds: Real, load: Complex) -> bool:
    """Whether the load (speeds, dof) of one order feeds the mode where it meets it."""
    speed = modes.omega[mode] / order
    if not speeds[0] * (1 - _UNMOVED) <= speed <= speeds[-1] * (1 + _UNMOVED):
        return False
    after = int(np.clip(np.searchsorted(speeds, speed), 1, max(len(speeds) - 1, 1)))
    beside = load[after - 1 : after + 1]
    work = np.abs(beside @ modes.shapes[mode])
    most = np.abs(modes.shapes).max(axis=0)  # that any mode moves each coordinate
    return bool(np.any(work > _UNMOVED * (np.abs(beside) @ most)))


def solve_response(
    stiffness: Complex, damping: Real, mass: Real, frequency: Real, load: Complex
) -> Complex:
    """Return the motion q (*frequency, dof) under a harmonic load: `(K + i w C - w^2 M) q = f`.

    Where nothing is damped, an undamped mode that is not driven stays at rest at its own frequency.

    Args:
        stiffness: K (dof, dof), complex where it has loss; or (*frequency, dof, dof).
        damping: C (dof, dof), or (*frequency, dof, dof).
        mass: M (dof, dof), positive definite.
        frequency: w in rad/s, any shape.
        load: f that broadcasts to (*frequency, dof).

    Raises:
        UndampedResonanceError: a load drives an undamped mode at its own frequency.
    """
    frequency = np.asarray(frequency, float)
    load = np.broadcast_to(load, (*frequency.shape, len(mass)))
    w = frequency[..., None, None]
    dynamic = np.asarray(stiffness + 1j * w * damping - w * w * mass, complex)
    return solve_equations(dynamic, load, frequency, np.zeros(frequency.shape, bool))


def solve_equations(
    matrix: Complex, load: Complex, frequency: Real, singular: NDArray[np.bool_]
) -> Complex:
    """Return solutions (*frequency, n) of equations (*frequency, n, n) of motion, the least ones
    where these are singular.

    Args:
        singular: (*frequency,), where they are known to be so.

    Raises:
        UndampedResonanceError: somewhere there is no solution.
    """
    solution = np.zeros(load.shape, complex)
    regular = ~singular
    try:
        solution[regular] = np.linalg.solve(matrix[regular], load[regular][..., None])[..., 0]
    except np.linalg.LinAlgError:
        found = np.linalg.cond(matrix) > 1 / _RANK
        return solve_equations(matrix, load, frequency, singular | found)
    size = np.abs(solution)
    stored = (size[..., None, :] @ np.abs(matrix) @ size[..., None])[..., 0, 0]
    singular = singular | (np.sum(size * np.abs(load), axis=-1) < _SINGULAR * stored)
    if np.any(singular):
        inverse = np.linalg.pinv(matrix[singular], rcond=_RANK)
        solution[singular] = (inverse @ load[singular][..., None])[..., 0]
        left = np.abs((matrix @ solution[..., None])[..., 0] - load).max(axis=-1)
        resonant = singular & (left > 1e-8 * np.abs(load).max(axis=-1))
        for met in np.broadcast_to(frequency, resonant.shape)[resonant][:1].tolist():
            raise UndampedResonanceError(met)
    return solution

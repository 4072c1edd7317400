"""Compute natural modes of a system with mass, damping and stiffness, and its motion under harmonic
loads.

Every motion and load of an order is a complex number c; its value in time is `Re(c e^{i w t})`.
Frequencies w are in rad/s and have any shape, commonly (orders, speeds). Arrays
with a value for each degree of freedom (dof) have the shape (orders, speeds, dof).
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.floating]
Complex = NDArray[np.complexfloating]
Indices = NDArray[np.intp]

UNDAMPED = 2e-9  # a loss factor up to this counts as 0: a vibration would take 1e8 periods to decay
# Smaller shares of damping and smaller relative distances of frequencies are rounding errors.
ROUNDING = 1e-12
# A load does not drive a mode if its work on the mode shape is below this share of the work that it
# could do at most on any mode.
_UNMOVED = 1e-10
# Equations A x = f are singular if |x| |f| is below this share of |x| |A| |x|.
_SINGULAR = 1e-11
_RANK = 1e-13  # singular values below this share of the largest are 0


class Modes(NamedTuple):
    """Natural modes without damping: rigid modes first, then by rising frequency.

    Attributes:
        omega: Angular frequencies, rad/s, shape (modes,); exactly 0 for rigid modes.
        shapes: Mode shapes of unit modal mass (`shapes M shapes^T = 1`), shape (modes, dof).
        rigid: Number of rigid modes.
    """

    omega: Real
    shapes: Real
    rigid: int


class Resonance(NamedTuple):
    """An undamped mode (its index in `Modes`) that an order excites at a crank speed (rad/s)."""

    mode: int
    order: float
    speed: float


class UndampedResonanceError(ValueError):
    """A load drives an undamped mode at its own frequency (rad/s), where no steady motion exists.

    Attributes:
        frequency: Frequency of the mode, rad/s.
    """

    def __init__(self, frequency: float) -> None:
        self.frequency = frequency
        super().__init__(f"undamped resonance at {frequency:.6g} rad/s")


def find_modes(springs: Real, stiffness: Real, mass: Real, rigid: Real | None = None) -> Modes:
    """Return natural modes of masses on springs.

    The frequencies are the singular values of `k^1/2 S M^-1/2`. The roots of the eigenvalues of
    `(S^T k S, M)` are the same, but the squaring would cost low frequencies half their digits.

    Args:
        springs: S, stretch of each spring per unit of each motion, shape (springs, dof).
        stiffness: k of each spring, above 0, shape (springs,).
        mass: M, positive definite, shape (dof, dof), or its diagonal, shape (dof,).
        rigid: All independent motions that stretch no spring, shape (count, dof); None: there are
            none.
    """
    rigid = np.zeros((0, springs.shape[1])) if rigid is None else rigid
    root = np.diag(np.sqrt(mass)) if mass.ndim == 1 else np.linalg.cholesky(mass)  # L: M = L L^T
    scaled = np.sqrt(stiffness)[:, None] * np.linalg.solve(root, springs.T).T
    _, falling, turned = np.linalg.svd(scaled, full_matrices=False)
    elastic = slice(springs.shape[1] - len(rigid))
    omega = falling[elastic][::-1]
    turned = turned[elastic][::-1]
    mixed = np.linalg.qr((rigid @ root).T, mode="r")
    signed = mixed * np.copysign(1, np.diag(mixed))[:, None]
    still = np.linalg.solve(signed.T, rigid)  # of unit modal mass, orthogonal to each other
    shapes = np.concatenate([still, np.linalg.solve(root.T, turned.T).T])
    return Modes(np.concatenate([np.zeros(len(still)), omega]), shapes, len(still))


def scale_shapes(shapes: Real) -> Real:
    """Return mode shapes (modes, dof), scaled so that the largest element (the first of equal ones)
    is 1.
    """
    size = np.abs(shapes)
    near = size >= size.max(axis=1, keepdims=True) * (1 - 1e-9)
    largest = np.take_along_axis(shapes, np.argmax(near, axis=1)[:, None], axis=1)
    return shapes / largest


def modal_loss(modes: Modes, stiffness: Complex, damping: Real) -> Real:
    """Return the loss factor `x^T (Im K + w C) x / w^2` of every mode, shape (modes,); it is 0 for
    rigid modes. Here x is the mode shape and w the angular frequency of the mode.

    At resonance, a single mode is magnified by the inverse of its loss factor.

    Args:
        modes: Modes of a system with n degrees of freedom.
        stiffness: K with its loss as imaginary part, shape (n, n).
        damping: C, N s/m or N m s, shape (n, n).
    """
    x = modes.shapes
    omega = modes.omega
    lost = np.einsum("mi,ij,mj->m", x, stiffness.imag, x)
    damped = omega * np.einsum("mi,ij,mj->m", x, damping, x)
    return np.where(omega > 0, (lost + damped) / np.where(omega > 0, omega, 1) ** 2, 0)


def find_resonances(
    modes: Modes, loss: Real, orders: Real, speeds: Real, load: Complex
) -> tuple[Resonance, ...]:
    """Return the undamped modes that a load drives at their own frequency somewhere in a range of
    speeds, also between the given speeds. The motion has no bound there.

    Args:
        modes: Natural modes.
        loss: Loss factors from `modal_loss`, shape (modes,).
        orders: Orders of the load, shape (orders,).
        speeds: Rising speeds, rad/s, shape (speeds,); the range runs from the first to the last.
        load: Load, which broadcasts to (orders, speeds, dof).
    """
    load = np.broadcast_to(load, (len(orders), len(speeds), modes.shapes.shape[1]))
    undamped = (modes.omega > 0) & (loss <= UNDAMPED)
    return tuple(
        Resonance(int(mode), float(order), float(modes.omega[mode] / order))
        for mode in np.flatnonzero(undamped)
        for row, order in enumerate(orders)
        if order > 0 and _drives(modes, mode, float(order), speeds, load[row])
    )


def _drives(modes: Modes, mode: np.intp, order: float, speeds: Real, load: Complex) -> bool:
    """Return whether the load of one order, shape (speeds, dof), drives the mode at its
    frequency.
    """
    speed = modes.omega[mode] / order
    if not speeds[0] * (1 - _UNMOVED) <= speed <= speeds[-1] * (1 + _UNMOVED):
        return False
    after = int(np.clip(np.searchsorted(speeds, speed), 1, max(len(speeds) - 1, 1)))
    beside = load[after - 1 : after + 1]
    work = np.abs(beside @ modes.shapes[mode])
    most = np.abs(modes.shapes).max(axis=0)  # largest motion of each coordinate in any mode
    return bool(np.any(work > _UNMOVED * (np.abs(beside) @ most)))


def solve_response(
    stiffness: Complex, damping: Real, mass: Real, frequency: Real, load: Complex
) -> Complex:
    """Return the motion q under a harmonic load, `(K + i w C - w^2 M) q = f`, shape (*frequency,
    dof).

    An undamped mode that the load does not drive stays at rest at its own frequency.

    Args:
        stiffness: K, complex if it has loss, shape (dof, dof) or (*frequency, dof, dof).
        damping: C, shape (dof, dof) or (*frequency, dof, dof).
        mass: M, positive definite, shape (dof, dof).
        frequency: w in rad/s, any shape.
        load: f, which broadcasts to (*frequency, dof).

    Raises:
        UndampedResonanceError: A load drives an undamped mode at its own frequency.
    """
    frequency = np.asarray(frequency, float)
    load = np.broadcast_to(load, (*frequency.shape, len(mass)))
    w = frequency[..., None, None]
    dynamic = np.asarray(stiffness + 1j * w * damping - w * w * mass, complex)
    return solve_equations(dynamic, load, frequency, np.zeros(frequency.shape, bool))


def solve_equations(
    matrix: Complex, load: Complex, frequency: Real, singular: NDArray[np.bool_]
) -> Complex:
    """Return the solution of the equations of motion at each frequency, shape (*frequency, n); the
    smallest solution where the equations are singular.

    Args:
        matrix: Matrices of the equations, shape (*frequency, n, n).
        load: Right sides, shape (*frequency, n).
        frequency: Frequencies for error messages, rad/s.
        singular: Whether the equations are known to be singular, shape (*frequency,).

    Raises:
        UndampedResonanceError: The equations have no solution at a frequency.
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

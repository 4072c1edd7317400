"""Compute stiffness, damping, rest position and natural modes of a rigid body on mounts.

A motion is a vector of six numbers along the engine's axes: displacement of the centre of gravity
(m) and rotation (rad). A load has the corresponding forces (N) and moments about the centre of
gravity (N m). Motions and loads of an order are phasors; see `core.vibration`.

`name_mode` describes a mode in words. Pictures show the body as a block of even density with its
mass and moments of inertia.
"""

from __future__ import annotations

from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..core.vibration import ROUNDING, Complex, Modes, Real, find_modes
from ..file.fields import join_words

_NO_SHARE = 1e-14  # smaller shares of a mode's energy are rounding errors
_UNCOUPLED = 1e-14  # smaller couplings, relative to both motions' stiffness, are rounding errors
_FREE = 1e-9  # a singular value below this share of the largest means an unrestrained motion


class Body(NamedTuple):
    """A rigid body.

    Attributes:
        mass: Mass, kg.
        centre: Centre of gravity, m, shape (3,).
        inertia: Inertia tensor about the centre, kg m2, shape (3, 3); off-diagonal terms are
            negative products of inertia.
    """

    mass: float
    centre: Real
    inertia: Real


class Mounts(NamedTuple):
    """Mounts between a body and the ground; each has springs along three axes.

    Attributes:
        at: Positions in the same coordinates as the body's centre, m, shape (mounts, 3).
        axes: Axes of each mount as columns, shape (mounts, 3, 3).
        stiffness: Static or dynamic stiffness along the axes, N/m, shape (mounts, 3).
        loss: Loss factors, shape (mounts, 3).
        damping: Damping along the axes, N s/m, shape (mounts, 3).
    """

    at: Real
    axes: Real
    stiffness: Real
    loss: Real
    damping: Real


# ------------------------------------------------------------------ geometry
def complete_axes(first: ArrayLike, second: ArrayLike) -> Real:
    """Return unit vectors along two perpendicular vectors and, by the right-hand rule, along the
    third axis, as columns (3, 3).
    """
    one, two = (np.asarray(axis) / np.linalg.norm(axis) for axis in (first, second))
    return np.stack([one, two, np.cross(one, two)], axis=1)


def turn_axes(about_x: float, about_y: float, about_z: float) -> Real:
    """Return axes turned by angles (rad) about x, then y, then z, as columns: `Rz Ry Rx`."""

    def turn(angle: float, axis: int) -> Real:
        c = np.cos(angle)
        s = np.sin(angle)
        return np.roll([[1, 0, 0], [0, c, -s], [0, s, c]], (axis, axis), (0, 1))

    return turn(about_z, 2) @ turn(about_y, 1) @ turn(about_x, 0)


def carry_points(points: ArrayLike, centre: ArrayLike) -> Real:
    """Return the displacement of points p of the body for a unit of each motion, shape (points, 3,
    6): the matrix `[I, -(p - c) x]` with the unit matrix I, the centre c and the cross product x.
    Its transpose converts forces at the points to a load.
    """
    arms = np.atleast_2d(np.asarray(points, float)) - np.asarray(centre, float)
    still = np.broadcast_to(np.eye(3), (len(arms), 3, 3))
    return np.concatenate([still, np.cross(arms[:, None], np.eye(3))], axis=-1)


def load_at_centre(
    force: Complex, moment: Complex, reference: ArrayLike, centre: ArrayLike
) -> Complex:
    """Return the load (..., 6) of a force F (..., 3) through a reference point and a moment M (...,
    3) about that point. The moment about the centre of gravity is `M + (reference - centre) x F`.
    """
    arm = np.asarray(reference, float) - np.asarray(centre, float)
    return np.concatenate([force, moment + np.cross(arm, force)], axis=-1)


# ------------------------------------------------------------------ matrices
def mass_matrix(body: Body) -> Real:
    """Return the mass matrix (6, 6) about the centre of gravity, kg and kg m2."""
    zeros = np.zeros((3, 3))
    return np.block([[body.mass * np.eye(3), zeros], [zeros, body.inertia]])


def stretch_mounts(body: Body, mounts: Mounts) -> Real:
    """Return the travel of each mount along its axes for a unit of each motion, (mounts, 3, 6)."""
    return np.swapaxes(mounts.axes, 1, 2) @ carry_points(mounts.at, body.centre)


def couple_mounts(body: Body, mounts: Mounts) -> tuple[Complex, Real]:
    """Return the forces on every mount along the engine's axes: spring forces, with loss, for a
    unit of each motion, and dashpot forces for a unit of each velocity, shape (mounts, 3, 6) each.
    """
    travel = stretch_mounts(body, mounts)
    springs = mounts.axes @ ((mounts.stiffness * (1 + 1j * mounts.loss))[..., None] * travel)
    return np.asarray(springs, complex), mounts.axes @ (mounts.damping[..., None] * travel)


def stiffness_matrix(body: Body, mounts: Mounts) -> Complex:
    """Return the stiffness matrix (6, 6) about the centre of gravity; losses make it complex."""
    return _add_up(body, mounts, couple_mounts(body, mounts)[0])


def damping_matrix(body: Body, mounts: Mounts) -> Real:
    """Return the damping matrix (6, 6) of the dashpots about the centre of gravity."""
    return _add_up(body, mounts, couple_mounts(body, mounts)[1]).real


def _add_up(body: Body, mounts: Mounts, forces: Complex | Real) -> Complex:
    """Return the matrix (6, 6) of loads about the centre of gravity from forces (mounts, 3, 6) on
    the mounts.

    Couplings of two motions that are rounding errors become 0; otherwise a mount at rest would have
    a force of 1e-17 N.
    """
    matrix = np.einsum("mij,mik->jk", carry_points(mounts.at, body.centre), forces)
    own = np.sqrt(np.abs(np.diag(matrix)))
    return np.where(np.abs(matrix) > _UNCOUPLED * np.outer(own, own), matrix, 0j)


# ------------------------------------------------------------------ properties
def find_free_motions(body: Body, mounts: Mounts) -> Real:
    """Return independent motions that no mount restrains, shape (count, 6); empty if the body is
    fully restrained.
    """
    springs = np.sqrt(mounts.stiffness)[..., None] * stretch_mounts(body, mounts)
    _, values, rows = np.linalg.svd(np.concatenate([springs.reshape(-1, 6), np.zeros((6, 6))]))
    return rows[values <= _FREE * max(values[0], np.finfo(float).tiny)]


def find_body_modes(body: Body, mounts: Mounts) -> Modes:
    """Return the six undamped natural modes of a fully restrained body, with shapes (6, 6) about
    the centre of gravity.
    """
    travel = stretch_mounts(body, mounts).reshape(-1, 6)
    stiff = mounts.stiffness.reshape(-1) > 0
    return find_modes(travel[stiff], mounts.stiffness.reshape(-1)[stiff], mass_matrix(body))


def share_energy(modes: Modes, body: Body) -> Real:
    """Return the share of each motion in each mode's kinetic energy, shape (modes, 6):
    `x_i (M x)_i` with the mode's shape x and the mass matrix M. The shares of a mode add up to 1.
    Products of inertia may make some shares negative; rounding errors become 0.
    """
    shares = modes.shapes * (modes.shapes @ mass_matrix(body))
    return np.where(np.abs(shares) < _NO_SHARE, 0.0, shares)


def roll_axis(body: Body, crank: ArrayLike = (0.0, 0.0, 1.0)) -> Real:
    """Return the torque roll axis, a unit vector (3,): the axis through the centre of gravity about
    which a free body turns under a torque about the crankshaft.
    """
    axis = np.linalg.solve(body.inertia, np.asarray(crank, float))
    return axis / np.linalg.norm(axis)


def elastic_centre(stiffness: Real, centre: ArrayLike) -> Real:
    """Return the elastic centre, m, shape (3,), from the stiffness (6, 6) about the centre of
    gravity: the point about which the spring forces of pure displacements have the smallest
    moments, in mean square over all directions of a unit force.

    K_uu and K_ru are the forces and moments for unit displacements. A displacement u needs the
    force `F = K_uu u` and the moment `K_ru u = N F` with `N = K_ru K_uu^-1`. A force at
    the point p has the moment `p x F`. Hence p follows from the antisymmetric part of N; the
    symmetric part is the same for any point.
    """
    moments = np.linalg.solve(stiffness[:3, :3].T, stiffness[3:, :3].T).T
    skew = (moments - moments.T) / 2
    return np.asarray(centre, float) + skew[[2, 0, 1], [1, 2, 0]]


# ------------------------------------------------------------------ loads
def settle_body(body: Body, mounts: Mounts, load: Real) -> tuple[Real, Real]:
    """Return forces and travel of the mounts of a fully restrained body under a steady load (6,).

    Returns:
        Forces of the body on its mounts along the engine's axes, N, and travel of its mounting
        points, m, shape (mounts, 3) each.
    """
    motion = np.linalg.solve(stiffness_matrix(body, mounts).real, load)
    springs, _ = couple_mounts(body, mounts)
    return springs.real @ motion, carry_points(mounts.at, body.centre) @ motion


def drop_rounding(values: ArrayLike, size: ArrayLike | None = None) -> Real:
    """Return values as an array in which rounding errors, relative to a size, are replaced by 0.

    Args:
        values: Values, any shape.
        size: Size, which broadcasts against the values; default: the largest magnitude.
    """
    magnitudes = np.abs(values)
    whole = magnitudes.max(initial=0.0) if size is None else np.asarray(size)
    return np.where(magnitudes > ROUNDING * whole, values, 0.0)


AXES = ("x", "y", "z", "rx", "ry", "rz")
ROLL = AXES.index("rz")  # the turn about the crankshaft's axis
_ALONE = 0.8  # a motion with this share of the energy names a mode alone
_PART = 0.15  # a motion with this share of the energy is one of several that name a mode
_STEEP = 0.8  # least cosine of the angle between the vertical and an axis called up and down
_EXACT = 1e-9  # smaller components of a direction are rounding errors


def name_motions(up: Real) -> tuple[str, ...]:
    """Return the names of the motions along x, y, z and about them.

    Rotation about z, the crankshaft's axis, is always roll. If no axis is near the vertical, no
    motion is called up and down.

    Args:
        up: Vector opposite to the weight, shape (3,).
    """
    upright = int(np.argmax(np.abs(up)))
    steep = abs(up[upright]) >= _STEEP * np.linalg.norm(up)
    if upright == 2 or not steep:
        along = "up and down" if steep else "along z"
        return "along x", "along y", along, "turn about x", "turn about y", "roll"
    names = ["sideways", "sideways", "lengthways", "pitch", "pitch", "roll"]
    names[upright] = "up and down"
    names[3 + upright] = "yaw"
    return tuple(names)


def name_mode(shares: Real, names: tuple[str, ...]) -> str:
    """Return a description of a mode by its largest motions, at most three.

    Args:
        shares: Shares of the energy, shape (6,).
        names: Names of the motions, from `name_motions`.
    """
    falling = np.argsort(-shares, kind="stable")
    if shares[falling[0]] >= _ALONE:
        return names[falling[0]]
    return join_words([names[k] for k in falling[:3] if shares[k] >= _PART])


def describe_free_motion(motion: Real) -> str:
    """Return a description of an unrestrained motion (6,): a displacement along a direction,
    or a rotation about an axis.
    """
    shift = motion[:3]
    turn = motion[3:]
    turns = np.linalg.norm(turn) > _FREE * np.linalg.norm(shift)
    vector = turn if turns else shift
    vector = vector / vector[np.argmax(np.abs(vector))]
    direction = np.where(np.abs(vector) < _EXACT, 0.0, vector)
    along = "({:.3g}, {:.3g}, {:.3g})".format(*direction)
    if np.count_nonzero(direction) == 1:
        along = AXES[int(np.argmax(direction))]
    return f"{'turning about' if turns else 'moving along'} {along}"


_FLATTEST = 0.05  # smallest squared side of a drawn block, as a share of the largest
# On the page, x points up, z to the right, y to the left and towards the reader.
PROJECTION = np.array([[0.0, -0.62, 0.86], [1.0, -0.34, -0.28]])


def find_corners(body: Body) -> Real:
    """Return the corners of the block, m, about the centre of gravity, shape (8, 3); corners whose
    indices differ in one bit share an edge.

    Edges are parallel to the engine's axes; products of inertia are ignored.
    """
    moments = np.diagonal(body.inertia)
    squares = 1.5 * (moments.sum() - 2 * moments) / body.mass
    half = np.sqrt(np.maximum(squares, _FLATTEST * squares.max()))
    return np.array(list(product((-1.0, 1.0), repeat=3))) * half

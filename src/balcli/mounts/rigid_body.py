"""A rigid body on mounts: its stiffness, statics, natural modes and forced vibration.

Motion is six numbers about the centre of gravity along the engine's axes: displacement x, y, z (m)
and rotation about x, y, z (rad). Loads match: forces (N) and moments about the centre of gravity
(N m). By order both are complex, frequencies in rad/s of any shape; see `vibration`.

`name_motion` puts motions of a rigid body into words. Pictures show the body as an even block with
its mass and moments of inertia.
"""

from __future__ import annotations

from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ..core.vibration import ROUNDING, Complex, Modes, Real, find_modes
from ..file.fields import join_words

_NO_SHARE = 1e-14  # of a mode's energy, which is 1
_UNCOUPLED = 1e-14  # share of the stiffness of both motions: a smaller coupling is rounding
_FREE = 1e-9  # singular values below this share of the largest mean a motion that nothing holds


class Body(NamedTuple):
    """A rigid body.

    Attributes:
        mass: Mass, kg.
        centre: Centre of gravity, m, shape (3,).
        inertia: Inertia tensor about it, kg m2, shape (3, 3), products of inertia negative.
    """

    mass: float
    centre: Real
    inertia: Real


class Mounts(NamedTuple):
    """Springs along three axes each, that hold a body to the ground.

    Attributes:
        at: Positions in the coordinates of the body's centre, m, shape (mounts, 3).
        axes: Axes of each mount as columns, shape (mounts, 3, 3).
        stiffness: Static or dynamic stiffness along these, N/m, shape (mounts, 3).
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
    """Return unit vectors along two perpendicular axes of any length, and the third by the
    right-hand rule, as columns (3, 3).
    """
    one, two = (np.asarray(axis) / np.linalg.norm(axis) for axis in (first, second))
    return np.stack([one, two, np.cross(one, two)], axis=1)


def turn_axes(about_x: float, about_y: float, about_z: float) -> Real:
    """Return axes turned by these angles (rad) about x, then y, then z, `Rz Ry Rx`, as columns."""

    def turn(angle: float, axis: int) -> Real:
        c, s = np.cos(angle), np.sin(angle)
        return np.roll([[1, 0, 0], [0, c, -s], [0, s, c]], (axis, axis), (0, 1))

    return turn(about_z, 2) @ turn(about_y, 1) @ turn(about_x, 0)


def carry_points(points: ArrayLike, centre: ArrayLike) -> Real:
    """Return the displacement of points of the body for a unit of each of its motions, shape
    (points, 3, 6): `[1, -(p - c) x]`. The transpose turns forces at the points into a load.
    """
    arms = np.atleast_2d(np.asarray(points, float)) - np.asarray(centre, float)
    still = np.broadcast_to(np.eye(3), (len(arms), 3, 3))
    return np.concatenate([still, np.cross(arms[:, None], np.eye(3))], axis=-1)


def load_at_centre(
    force: Complex, moment: Complex, reference: ArrayLike, centre: ArrayLike
) -> Complex:
    """Return the load (..., 6) of a force (..., 3) through a reference point and a moment (..., 3)
    about it: about the centre of gravity the moment is `M + (reference - centre) x F`.
    """
    arm = np.asarray(reference, float) - np.asarray(centre, float)
    return np.concatenate([force, moment + np.cross(arm, force)], axis=-1)


def find_screw(motion: Real, centre: ArrayLike) -> tuple[Real, Real | None]:
    """Return the axis about which a small motion of a body turns it; a slide along it is left out.

    Args:
        motion: Motion, shape (6,).
        centre: Centre of gravity, m, shape (3,).

    Returns:
        Unit vector along the axis, its largest component positive, and the point of the axis that
        is closest to the centre of gravity, m. Where nothing turns, the direction of the
        displacement and None.
    """
    shift, turn = motion[:3], motion[3:]
    turns = np.linalg.norm(turn) > _FREE * np.linalg.norm(shift)
    vector = turn if turns else shift
    largest = vector[np.argmax(np.abs(vector))]
    direction = vector / np.copysign(np.linalg.norm(vector), largest)
    point = np.asarray(centre, float) + np.cross(turn, shift) / (turn @ turn) if turns else None
    return direction, point


# ------------------------------------------------------------------ matrices
def mass_matrix(body: Body) -> Real:
    """Return the mass matrix (6, 6) about the centre of gravity: kg, kg m2."""
    zeros = np.zeros((3, 3))
    return np.block([[body.mass * np.eye(3), zeros], [zeros, body.inertia]])


def stretch_mounts(body: Body, mounts: Mounts) -> Real:
    """Return the travel of every mount along its axes for a unit of each motion, (mounts, 3, 6)."""
    return np.swapaxes(mounts.axes, 1, 2) @ carry_points(mounts.at, body.centre)


def couple_mounts(body: Body, mounts: Mounts) -> tuple[Complex, Real]:
    """Return the force on every mount along the engine's axes for a unit of each motion of the
    body: of springs with their loss, and of dashpots, for a unit of each speed; (mounts, 3, 6).
    """
    travel = stretch_mounts(body, mounts)
    springs = mounts.axes @ ((mounts.stiffness * (1 + 1j * mounts.loss))[..., None] * travel)
    return np.asarray(springs, complex), mounts.axes @ (mounts.damping[..., None] * travel)


def stiffness_matrix(body: Body, mounts: Mounts) -> Complex:
    """Return the stiffness (6, 6) about the centre of gravity, complex where mounts have loss."""
    return _add_up(body, mounts, couple_mounts(body, mounts)[0])


def damping_matrix(body: Body, mounts: Mounts) -> Real:
    """Return the damping (6, 6) of the dashpots about the centre of gravity."""
    return _add_up(body, mounts, couple_mounts(body, mounts)[1]).real


def _add_up(body: Body, mounts: Mounts, forces: Complex | Real) -> Complex:
    """Return the load (6, 6) about the centre of gravity of forces (mounts, 3, 6) on the mounts.

    Couplings of two motions are 0 where they are rounding: else a mount that nothing moves would
    have a force of 1e-17 N.
    """
    matrix = np.einsum("mij,mik->jk", carry_points(mounts.at, body.centre), forces)
    own = np.sqrt(np.abs(np.diag(matrix)))
    return np.where(np.abs(matrix) > _UNCOUPLED * np.outer(own, own), matrix, 0j)


# ------------------------------------------------------------------ properties
def find_free_motions(body: Body, mounts: Mounts) -> Real:
    """Return independent motions that no mount holds, shape (count, 6); empty for a body that is
    held.
    """
    springs = np.sqrt(mounts.stiffness)[..., None] * stretch_mounts(body, mounts)
    _, values, rows = np.linalg.svd(np.concatenate([springs.reshape(-1, 6), np.zeros((6, 6))]))
    return rows[values <= _FREE * max(values[0], np.finfo(float).tiny)]


def find_body_modes(body: Body, mounts: Mounts) -> Modes:
    """Return the six natural modes without damping of a body that is held in every way; shapes
    (6, 6) about the centre of gravity.
    """
    travel = stretch_mounts(body, mounts).reshape(-1, 6)
    stiff = mounts.stiffness.reshape(-1) > 0
    return find_modes(travel[stiff], mounts.stiffness.reshape(-1)[stiff], mass_matrix(body))


def share_energy(modes: Modes, body: Body) -> Real:
    """Return the share of each mode's kinetic energy in each motion, `x_i (M x)_i`, shape (modes,
    6); sums are 1. Products of inertia may make some negative; rounding errors are 0.
    """
    shares = modes.shapes * (modes.shapes @ mass_matrix(body))
    return np.where(np.abs(shares) < _NO_SHARE, 0.0, shares)


def roll_axis(body: Body, crank: ArrayLike = (0.0, 0.0, 1.0)) -> Real:
    """Return the unit vector (3,) of the axis through the centre of gravity about which a torque
    about the crankshaft turns a free body.
    """
    axis = np.linalg.solve(body.inertia, np.asarray(crank, float))
    return axis / np.linalg.norm(axis)


def elastic_centre(stiffness: Real, centre: ArrayLike) -> Real:
    """Return the point (3,) about which the spring forces of pure displacements have the smallest
    moments, in mean square over the directions of a unit force, m, by the stiffness (6, 6) about
    the centre of gravity.

    A displacement u needs the force `K_uu u` and the moment `K_ru u` = `N F`. A force at p has the
    moment `p x F`. So p is the antisymmetric part of N; the symmetric part remains for any point.
    """
    moments = np.linalg.solve(stiffness[:3, :3].T, stiffness[3:, :3].T).T
    skew = (moments - moments.T) / 2
    return np.asarray(centre, float) + skew[[2, 0, 1], [1, 2, 0]]


# ------------------------------------------------------------------ loads
def settle_body(body: Body, mounts: Mounts, load: Real) -> tuple[Real, Real]:
    """Return the rest of a body that is held in every way, under a steady load (6,).

    Returns:
        Forces of the body on its mounts along the engine's axes, N, and travel of its mounting
        points, m, shape (mounts, 3) each.
    """
    motion = np.linalg.solve(stiffness_matrix(body, mounts).real, load)
    springs, _ = couple_mounts(body, mounts)
    return springs.real @ motion, carry_points(mounts.at, body.centre) @ motion


def drop_rounding(values: ArrayLike, size: ArrayLike | None = None) -> Real:
    """Return values as an array; those that are rounding next to a size are 0.

    Args:
        values: Values, any shape.
        size: Size, of a shape to which that of the values is broadcast; default: the largest value.
    """
    magnitudes = np.abs(values)
    whole = magnitudes.max(initial=0.0) if size is None else np.asarray(size)
    return np.where(magnitudes > ROUNDING * whole, values, 0.0)


AXES = ("x", "y", "z", "rx", "ry", "rz")
ROLL = AXES.index("rz")  # the turn about the crankshaft's axis
_ALONE = 0.8  # share of the energy with which a motion counts as one alone
_PART = 0.15  # share with which it is named beside another
_STEEP = 0.8  # cosine: an axis farther from the vertical is not up and down
_EXACT = 1e-9  # of a direction: what is less is rounding


def name_motions(up: Real) -> tuple[str, ...]:
    """Return the names of the motions along x, y, z and about them.

    Turns about z, the crankshaft's axis, are always roll. Where no axis is near the vertical, none
    is up and down.

    Args:
        up: Vector against the weight, shape (3,).
    """
    upright = int(np.argmax(np.abs(up)))
    steep = abs(up[upright]) >= _STEEP * np.linalg.norm(up)
    if upright == 2 or not steep:
        along = "up and down" if steep else "along z"
        return "along x", "along y", along, "turn about x", "turn about y", "roll"
    names = ["sideways", "sideways", "lengthways", "pitch", "pitch", "roll"]
    names[upright], names[3 + upright] = "up and down", "yaw"
    return tuple(names)


def name_mode(shares: Real, names: tuple[str, ...]) -> str:
    """Return a mode in words, by its largest motions, at most three.

    Args:
        shares: Shares of the energy, shape (6,).
        names: As of `name_motions`.
    """
    falling = np.argsort(-shares, kind="stable")
    if shares[falling[0]] >= _ALONE:
        return names[falling[0]]
    return join_words([names[k] for k in falling[:3] if shares[k] >= _PART])


def describe_free_motion(motion: Real, centre: Real) -> str:
    """Return a motion (6,) that nothing holds in words: a displacement, or a turn about a line."""
    direction, point = find_screw(motion, centre)
    direction = np.where(np.abs(direction) < _EXACT, 0.0, direction)
    along = "({:.3g}, {:.3g}, {:.3g})".format(*direction)
    if np.count_nonzero(direction) == 1:
        along = AXES[int(np.argmax(np.abs(direction)))]
    if point is None:
        return f"moving along {along}"
    x, y, z = 1e3 * np.where(np.abs(point) < _EXACT, 0.0, point)
    return f"turning about {along} through ({x:.4g}, {y:.4g}, {z:.4g}) mm"


_FLATTEST = 0.05  # square of a side, of the largest, below which a block is not drawn
# On the page x of the engine is up, z runs to the right, y to the left and towards the reader.
PROJECTION = np.array([[0.0, -0.62, 0.86], [1.0, -0.34, -0.28]])


def find_corners(body: Body) -> Real:
    """Return the corners of the block, m, about the centre of gravity, shape (8, 3); corners whose
    numbers differ in one bit share an edge.

    Sides lie along the engine's axes; products of inertia are left out.
    """
    moments = np.diagonal(body.inertia)
    squares = 1.5 * (moments.sum() - 2 * moments) / body.mass
    half = np.sqrt(np.maximum(squares, _FLATTEST * squares.max()))
    return np.array(list(product((-1.0, 1.0), repeat=3))) * half

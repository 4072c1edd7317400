"""Forced vibration of torsional chains.

Angles and torques by order are complex, their values in time `Re(c e^{i w t})`; frequencies are in
rad/s and of any shape, nodes or shafts on the last axis. See `vibration`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .torsional_chain import Chain, Damping, find_pieces, find_still, grow_branches, incidence
from .vibration import Complex, Real, solve_equations

_WEAK_PIVOT = 1e-3  # sums that cancel to less than this are solved anew, with pivoting
_RESONANT = 1e-9  # the same of the whole chain


class Twist(NamedTuple):
    """Forced vibration.

    Attributes:
        angle: (*frequency, nodes) rad.
        torque: (*frequency, shafts) N m in the speed of each shaft's end, positive where it drives
            the end on; its damping part included.
    """

    angle: Complex
    torque: Complex


class _Equations(NamedTuple):
    """Equations of motion of a chain, point by point (a point is a frequency).

    Attributes:
        w: (points,) rad/s.
        own: (nodes, points) dynamic stiffness of each node by itself.
        flexible: (shafts, points) 1/stiffness of each shaft.
        load: (nodes, points) torques, N m.
        carrying: (shafts,) which shafts carry anything.
    """

    w: Real
    own: Complex
    flexible: Complex
    load: Complex
    carrying: NDArray[np.bool_]


class _Solution(NamedTuple):
    """Motion of a chain.

    Attributes:
        angle: (nodes, points).
        torque: (shafts, points).
        weak: (points,) where a sum cancelled too much, because a branch by itself or the whole
            chain is near a resonance without damping: there the solution needs pivoting.
        singular: (points,) where the whole chain is at such a resonance.
    """

    angle: Complex
    torque: Complex
    weak: NDArray[np.bool_]
    singular: NDArray[np.bool_]


def respond_chain(
    chain: Chain,
    damping: Damping,
    frequency: ArrayLike,
    load: Complex,
    attached: Complex | float = 0.0,
) -> Twist:
    """Return the steady vibration under harmonic torques.

    Args:
        chain: Inertias and shafts.
        damping: Losses of shafts and nodes.
        frequency: w (rad/s), any shape, commonly (orders, speeds).
        load: Torques (N m) on the nodes, that broadcast to (*frequency, nodes).
        attached: Complex inertias of dampers (kg m2), likewise; see `torsional_dampers`.

    Raises:
        UndampedResonanceError: a load drives an undamped mode at its own frequency.
        ValueError: a shaft that is a dashpot alone, at a frequency of 0.
    """
    frequency = np.asarray(frequency, float)
    shape = (*frequency.shape, len(chain.inertia))

    def flatten(values: Complex | float) -> Complex:
        return np.broadcast_to(np.asarray(values, complex), shape).reshape(-1, shape[-1]).T

    w = frequency.ravel()
    own = 1j * np.outer(damping.nodes, w) - np.outer(chain.inertia, w * w)
    if np.any(attached):
        own -= w * w * flatten(attached)
    carrying = (chain.stiffness > 0) | (damping.dashpots > 0)
    carrying &= ~(chain.clamped[chain.start] & chain.clamped[chain.end])
    flexible = _find_flexibilities(chain, damping, w, carrying)
    equations = _Equations(w, own, flexible, flatten(load), carrying)
    angle, torque, weak, singular = _solve_tree(chain, equations)
    if np.any(weak):
        some = _Equations(
            w[weak], own[:, weak], flexible[:, weak], equations.load[:, weak], carrying
        )
        angle[:, weak], torque[:, weak] = _solve_dense(chain, some, singular[weak])
        angle[find_still(chain)] = 0
    moved, twisted = (part.T.reshape(*frequency.shape, len(part)) for part in (angle, torque))
    return Twist(moved, twisted)


def _find_flexibilities(
    chain: Chain, damping: Damping, w: Real, carrying: NDArray[np.bool_]
) -> Complex:
    """Return 1/stiffness (shafts, points) of every shaft that carries anything, of others 0."""
    k, c = np.where(np.isinf(chain.stiffness), 0, chain.stiffness), damping.dashpots
    stiffness = np.outer(k * (1 + 1j * damping.loss), np.ones_like(w)) + 1j * np.outer(c, w)
    bends = carrying & np.isfinite(chain.stiffness)
    if np.any(stiffness[bends] == 0):
        raise ValueError("a shaft that is a dashpot alone carries nothing at a frequency of 0")
    flexible = np.zeros_like(stiffness)
    flexible[bends] = 1 / stiffness[bends]
    return flexible


def _find_roots(chain: Chain, shafts: NDArray[np.bool_]) -> list[int]:
    """Of every piece the free node that is heaviest at common speed."""
    pieces = find_pieces(chain, shafts)
    weight = np.where(chain.clamped, -1, chain.inertia * pieces.pace**2)
    return [
        int(max(np.flatnonzero(pieces.first == first), key=lambda node: weight[node]))
        for first in np.unique(pieces.first)
    ]


def _solve_tree(chain: Chain, equations: _Equations) -> _Solution:
    """Solve the equations by taking the nodes off the tree one by one, from its ends to the
    heaviest.

    Each node goes with its shaft as a flexibility s, so that stiff shafts, meshes and massless
    nodes need no exception and a twist is no small difference of large angles: with stiffness d
    and load f of a node and all that hangs on it, the parent feels `far^2 d/(near^2 + s d)` and
    `-near far f/(near^2 + s d)`. A chain with loops is weak everywhere.
    """
    w, own, flexible, load, carrying = equations
    roots = _find_roots(chain, carrying)
    branches = grow_branches(chain, roots, carrying)
    stiff, load, size = own.copy(), load.copy(), np.abs(own)
    pivots, felt, pushed, angle = np.zeros((4, *own.shape), complex)
    torque = np.zeros(flexible.shape, complex)
    weak = np.full(len(w), len(branches) < np.count_nonzero(carrying))
    singular = np.zeros(len(w), bool)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):  # there it is weak
        for child, parent, shaft, near, far in reversed(branches):
            if chain.clamped[child]:
                mesh = flexible[shaft] == 0
                weak |= mesh
                felt[child] = np.where(mesh, 0, 1 / flexible[shaft])
            else:
                part = flexible[shaft] * stiff[child]
                pivots[child] = near**2 + part
                weak |= np.abs(pivots[child]) <= _WEAK_PIVOT * (near**2 + np.abs(part))
                felt[child], pushed[child] = (
                    stiff[child] / pivots[child],
                    load[child] / pivots[child],
                )
            stiff[parent] += far**2 * felt[child]
            load[parent] -= near * far * pushed[child]
            size[parent] += far**2 * np.abs(felt[child])
        for root in roots:
            if not chain.clamped[root]:
                singular |= np.abs(stiff[root]) <= _RESONANT * size[root]
                angle[root] = load[root] / stiff[root]
        for child, parent, shaft, near, far in branches:
            torque[shaft] = near * pushed[child] + far * felt[child] * angle[parent]
            if not chain.clamped[child]:
                moved = near * far * angle[parent] / pivots[child]
                angle[child] = flexible[shaft] * pushed[child] - moved
    return _Solution(angle, torque, weak | singular, singular)


def _solve_dense(
    chain: Chain, equations: _Equations, singular: NDArray[np.bool_]
) -> tuple[Complex, Complex]:
    """Angles (nodes, points) and torques (shafts, points) from equations of both, with pivoting:
    `d x + B^T T = f`, `B x = s T`, all scaled by a stiffness of the chain.
    """
    w, own, flexible, load, carrying = equations
    elastic = np.isfinite(chain.stiffness) & (chain.stiffness > 0)
    scale = float(np.median(chain.stiffness[elastic])) if np.any(elastic) else 1.0
    nodes, shafts = np.arange(len(own)), len(own) + np.arange(np.count_nonzero(carrying))
    unknowns = len(nodes) + len(shafts)
    rows = incidence(chain)[carrying]
    matrix = np.zeros((len(w), unknowns, unknowns), complex)
    matrix[:, nodes, nodes] = own.T / scale
    matrix[:, nodes[:, None], shafts] = rows.T
    matrix[:, shafts[:, None], nodes] = rows
    matrix[:, shafts, shafts] = -scale * flexible[carrying].T
    held = np.flatnonzero(chain.clamped)
    matrix[:, held, :] = 0
    matrix[:, :, held] = 0
    matrix[:, held, held] = 1
    right = np.zeros((len(w), unknowns), complex)
    right[:, nodes] = np.where(chain.clamped, 0, load.T / scale)
    solution = solve_equations(matrix, right, w, singular).T
    torque = np.zeros((len(chain.start), len(w)), complex)
    torque[carrying] = scale * solution[shafts]
    return solution[nodes], torque

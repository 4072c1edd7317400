"""Forced vibration of torsional chains.

Angles and torques by order are complex, their values in time `Re(c e^{i w t})`; frequencies are in
rad/s and of any shape, nodes or shafts on the last axis. See `vibration`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .torsional_chain import (
    Branch,
    Chain,
    Damping,
    find_pieces,
    find_still,
    grow_branches,
    incidence,
)
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
    """What moves a chain, frequency by frequency.

    Attributes:
        frequency: (*frequency,) rad/s.
        own: (nodes, *frequency) dynamic stiffness of each node by itself.
        flexible: 1/stiffness of each shaft, that broadcasts to (shafts, *frequency).
        load: (nodes, *frequency).
        carrying: (shafts,) which shafts carry anything.
    """

    frequency: Real
    own: Complex
    flexible: Complex
    load: Complex
    carrying: NDArray[np.bool_]

    def at(self, where: NDArray[np.bool_]) -> _Equations:
        """Some of the frequencies."""
        shape = (len(self.flexible), *self.frequency.shape)
        flexible = np.broadcast_to(self.flexible, shape)
        own, flexible, load = (each[:, where] for each in (self.own, flexible, self.load))
        return _Equations(self.frequency[where], own, flexible, load, self.carrying)


class _Solution(NamedTuple):
    """Motion of a chain: angle (nodes, *frequency), torque (shafts, *frequency), and where
    (*frequency,) it needs another method: where a sum cancelled too much, because a branch by
    itself or the whole is near a resonance without damping; and where the whole is.
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
    """Steady vibration under harmonic torques.

    Args:
        frequency: w (rad/s), any shape, commonly (orders, speeds).
        load: torques (N m) on the nodes, that broadcast to (*frequency, nodes).
        attached: complex inertias of dampers (kg m2), likewise; see `torsional_dampers`.

    Raises:
        UndampedResonanceError: a load drives an undamped mode at its own frequency.
        ValueError: a shaft that is a dashpot alone, at a frequency of 0.
    """
    equations = _set_up(chain, damping, np.asarray(frequency, float), load, attached)
    angle, torque, weak, singular = _solve_tree(chain, equations)
    if np.any(weak):
        angle[:, weak], torque[:, weak] = _solve_dense(chain, equations.at(weak), singular[weak])
        angle[find_still(chain)] = 0
    return Twist(np.moveaxis(angle, 0, -1), np.moveaxis(torque, 0, -1))


def _set_up(
    chain: Chain, damping: Damping, w: Real, load: Complex, attached: Complex | float
) -> _Equations:
    shape = (*w.shape, len(chain.inertia))
    forces = np.moveaxis(np.broadcast_to(np.asarray(load, complex), shape), -1, 0)
    own = np.multiply.outer(1j * damping.nodes, w) - np.multiply.outer(chain.inertia, w * w)
    if np.any(attached):
        own -= w * w * np.moveaxis(np.broadcast_to(attached, shape), -1, 0)
    carrying = (chain.stiffness > 0) | (damping.dashpots > 0)
    carrying &= ~(chain.clamped[chain.start] & chain.clamped[chain.end])
    return _Equations(w, own, _flexibilities(chain, damping, w, carrying), forces, carrying)


def _flexibilities(chain: Chain, damping: Damping, w: Real, carrying: NDArray[np.bool_]) -> Complex:
    """1/stiffness of every shaft that carries anything; of others 0. As (shafts, *frequency), or
    one for all frequencies where nothing depends on them.
    """
    k, c = np.where(np.isinf(chain.stiffness), 0, chain.stiffness), damping.dashpots
    w = w if np.any(c) else np.ones((1,) * w.ndim)
    complex_stiffness = np.multiply.outer(k * (1 + 1j * damping.loss), np.ones_like(w))
    complex_stiffness += 1j * np.multiply.outer(c, w)
    bends = carrying & np.isfinite(chain.stiffness)
    if np.any(complex_stiffness[bends] == 0):
        raise ValueError("a shaft that is a dashpot alone carries nothing at a frequency of 0")
    flexible = np.zeros_like(complex_stiffness)
    flexible[bends] = 1 / complex_stiffness[bends]
    return flexible


def _find_roots(chain: Chain, shafts: NDArray[np.bool_]) -> list[int]:
    """Of every piece the free node that is heaviest at common speed."""
    pieces = find_pieces(chain, shafts)
    weight = np.where(chain.clamped, -1, chain.inertia * pieces.pace**2)
    return [
        int(max(np.flatnonzero(pieces.first == first), key=lambda node: weight[node]))
        for first in np.unique(pieces.first)
    ]


class _Folded(NamedTuple):
    """A tree folded towards its roots: each node with all that hangs on it.

    Attributes:
        own, load: (nodes, *frequency) dynamic stiffness and load.
        pivots: (nodes, *frequency) what was divided by to take the node off its parent.
        felt, pushed: (nodes, *frequency) own and load over that.
        weak: (*frequency,) where a pivot is small against its parts, or a mesh holds a node still.
    """

    own: Complex
    load: Complex
    pivots: Complex
    felt: Complex
    pushed: Complex
    weak: NDArray[np.bool_]


def _solve_tree(chain: Chain, equations: _Equations) -> _Solution:
    """Takes the nodes off the tree one by one, from its ends to the heaviest, each with its shaft
    as flexibility, so that stiff shafts, meshes and massless nodes need no exception and twist is
    no small difference of large angles. A chain with loops is weak everywhere.
    """
    flexible = equations.flexible
    roots = _find_roots(chain, equations.carrying)
    branches = grow_branches(chain, roots, equations.carrying)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):  # there it is weak
        folded = _fold(chain, equations, branches)
        weak = folded.weak | (len(branches) < np.count_nonzero(equations.carrying))
        angle = np.zeros(folded.own.shape, complex)
        torque = np.zeros((len(flexible), *angle.shape[1:]), complex)
        singular = np.zeros_like(weak)
        for root in roots:
            if not chain.clamped[root]:
                size = np.abs(equations.own[root])
                for child, _, _, _, far in (each for each in branches if each.parent == root):
                    size += far**2 * np.abs(folded.felt[child])
                singular |= np.abs(folded.own[root]) <= _RESONANT * size
                angle[root] = folded.load[root] / folded.own[root]
        for child, parent, shaft, near, far in branches:
            torque[shaft] = near * folded.pushed[child] + far * folded.felt[child] * angle[parent]
            if not chain.clamped[child]:
                moved = near * far * angle[parent] / folded.pivots[child]
                angle[child] = flexible[shaft] * folded.pushed[child] - moved
    return _Solution(angle, torque, weak | singular, singular)


def _fold(chain: Chain, equations: _Equations, branches: list[Branch]) -> _Folded:
    """With stiffness d and load f of a node and all that hangs on it, and its shaft's flexibility
    s, the parent feels `far^2 d/(near^2 + s d)` and `-near far f/(near^2 + s d)`.
    """
    own, load = equations.own.copy(), equations.load.copy()
    weak = np.zeros(own.shape[1:], bool)
    pivots, felt, pushed = (np.zeros(own.shape, complex) for _ in range(3))
    for child, parent, shaft, near, far in reversed(branches):
        if chain.clamped[child]:
            mesh = equations.flexible[shaft] == 0
            weak |= mesh
            felt[child] = np.where(mesh, 0, 1 / equations.flexible[shaft])
        else:
            part = equations.flexible[shaft] * own[child]
            pivots[child] = near**2 + part
            weak |= np.abs(pivots[child]) <= _WEAK_PIVOT * (near**2 + np.abs(part))
            felt[child], pushed[child] = own[child] / pivots[child], load[child] / pivots[child]
        own[parent] += far**2 * felt[child]
        load[parent] -= near * far * pushed[child]
    return _Folded(own, load, pivots, felt, pushed, weak)


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

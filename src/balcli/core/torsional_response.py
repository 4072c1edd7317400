"""Forced vibration of torsional chains.

Angles and torques by order are complex, their values in time `Re(c e^{i w t})`; frequencies are in
rad/s and of any shape, nodes or shafts on the last axis. See `vibration`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .singular_values import Complex, Real
from .sorted_sets import sort_distinct
from .torsional_chain import Branch, Chain, Damping, find_pieces, grow_branches, incidence
from .vibration import solve_equations

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
        flexible: (shafts, *frequency) 1/stiffness of each shaft.
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
        own, flexible, load = (each[:, where] for each in (self.own, self.flexible, self.load))
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
    return Twist(np.moveaxis(angle, 0, -1), np.moveaxis(torque, 0, -1))


def _set_up(
    chain: Chain, damping: Damping, w: Real, load: Complex, attached: Complex | float
) -> _Equations:
    shape = (*w.shape, len(chain.inertia))
    inertia = np.moveaxis(np.broadcast_to(chain.inertia + attached, shape), -1, 0)
    forces = np.moveaxis(np.broadcast_to(np.asarray(load, complex), shape), -1, 0)
    own = 1j * np.multiply.outer(damping.nodes, w) - w * w * inertia
    carrying = (chain.stiffness > 0) | (damping.dashpots > 0)
    carrying &= ~(chain.clamped[chain.start] & chain.clamped[chain.end])
    return _Equations(w, own, _flexibilities(chain, damping, w, carrying), forces, carrying)


def _flexibilities(chain: Chain, damping: Damping, w: Real, carrying: NDArray[np.bool_]) -> Complex:
    """1/stiffness (shafts, *frequency) of every shaft that carries anything; of others 0."""
    k, c = np.where(np.isinf(chain.stiffness), 0, chain.stiffness), damping.dashpots
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
        for first in sort_distinct(pieces.first)
    ]


class _Folded(NamedTuple):
    """A tree folded towards its roots: each node with all that hangs on it.

    Attributes:
        own, load: (nodes, *frequency) dynamic stiffness and load.
        size: (nodes, *frequency) sum of the absolute values that make up `own`.
        pivots: (nodes, *frequency) what was divided by to take the node off its parent.
        felt, pushed: (nodes, *frequency) own and load over that.
        weak: (*frequency,) where a pivot is small against its parts.
    """

    own: Complex
    load: Complex
    size: Real
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
    folded = _fold(chain, equations, branches)
    weak = folded.weak | (len(branches) < np.count_nonzero(equations.carrying))
    angle, torque = np.zeros_like(folded.own), np.zeros_like(flexible)
    singular = np.zeros_like(weak)
    for root in roots:
        if not chain.clamped[root]:
            total, cancels = _guard(folded.own[root], folded.size[root], _RESONANT)
            singular |= cancels
            angle[root] = folded.load[root] / total
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
    size, weak = np.abs(own), np.zeros(own.shape[1:], bool)
    pivots, felt, pushed = np.ones_like(own), np.zeros_like(own), np.zeros_like(own)
    for child, parent, shaft, near, far in reversed(branches):
        if chain.clamped[child]:
            felt[child] = 1 / equations.flexible[shaft]
        else:
            part = equations.flexible[shaft] * own[child]
            parts = near**2 + np.abs(part)
            pivots[child], cancels = _guard(near**2 + part, parts, _WEAK_PIVOT)
            weak |= cancels
            felt[child], pushed[child] = own[child] / pivots[child], load[child] / pivots[child]
        own[parent] += far**2 * felt[child]
        size[parent] += far**2 * np.abs(felt[child])
        load[parent] -= near * far * pushed[child]
    return _Folded(own, load, size, pivots, felt, pushed, weak)


def _guard(total: Complex, size: Real, share: float) -> tuple[Complex, NDArray[np.bool_]]:
    """A divisor that is 1 where it would be less than a share of its parts, and where that is."""
    cancels = np.abs(total) <= share * size
    return np.where(cancels, 1, total), cancels


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

"""Compute torsional chains: inertias (nodes) joined by shafts and gears. Dampers are treated as
complex inertias.

A shaft twists by `ratio x_start - x_end`, where x are the angles of its nodes. A shaft with a ratio
other than 1 has a gear mesh at its start, and its stiffness refers to the speed of its end. A mesh
alone is a rigid shaft (stiffness inf). Nodes and shafts usually form a tree; loops (split power)
are allowed.

A damper adds a complex moment of inertia J (kg m2) to its node: when the node vibrates with the
angle x at the frequency w (rad/s), the damper takes the torque `-w^2 J x`. The damper absorbs
energy if the imaginary part of J is negative.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.vibration import Complex, Indices, Real

SAME_RATIO = 1e-9  # relative difference below which two gear ratios count as equal


class ChainShaft(NamedTuple):
    """A shaft between two nodes, given by their indices. `stiffness` (N m/rad, inf if rigid) refers
    to the speed of the shaft's end; `ratio` is this speed divided by the speed of its start.
    """

    start: int
    end: int
    stiffness: float
    ratio: float = 1.0


class Pieces(NamedTuple):
    """Connected pieces of a chain.

    Attributes:
        first: (nodes,) first node of the piece that each node belongs to.
        pace: (nodes,) speed of each node divided by that of the first node of its piece.
    """

    first: Indices
    pace: Real


class Chain(NamedTuple):
    """Nodes and shafts as arrays.

    Attributes:
        inertia: (nodes,) moment of inertia of each node, kg m2; 0: massless.
        start: (shafts,) index of the node at the start of each shaft.
        end: (shafts,) index of the node at the end of each shaft.
        ratio: (shafts,) speed of the end divided by that of the start.
        stiffness: (shafts,) N m/rad at the speed of the end; inf: rigid, or a mesh of gears.
        clamped: (nodes,) whether a node is held.
    """

    inertia: Real
    start: Indices
    end: Indices
    ratio: Real
    stiffness: Real
    clamped: NDArray[np.bool_]


class Damping(NamedTuple):
    """Losses of shafts and nodes; dampers, which are complex inertias, are not included.

    Attributes:
        loss: (shafts,) loss factors; a shaft of stiffness k has the complex stiffness
            k (1 + i loss).
        dashpots: (shafts,) dashpot parallel to each shaft, N m s/rad.
        nodes: (nodes,) damping of each node against ground, N m s/rad.
    """

    loss: Real
    dashpots: Real
    nodes: Real


class Branch(NamedTuple):
    """A node (`child`) joined to another node (`parent`) by a shaft. The shaft twists by
    `near x_child + far x_parent`, where x are the angles of the two nodes.
    """

    child: int
    parent: int
    shaft: int
    near: float
    far: float


def join_chain(
    inertia: ArrayLike, shafts: Iterable[ChainShaft], clamped: Sequence[int] = ()
) -> Chain:
    """Return the chain of nodes with these moments of inertia (kg m2, 0: massless). The result is
    not checked: gears may lock it.
    """
    table = np.array(list(shafts), float).reshape(-1, len(ChainShaft._fields))
    start = table[:, 0].astype(np.intp)
    end = table[:, 1].astype(np.intp)
    j = np.asarray(inertia, float)
    held = np.isin(np.arange(len(j)), clamped)
    return Chain(j, start, end, table[:, 3], table[:, 2], held)


def find_pieces(chain: Chain, shafts: NDArray[np.bool_] | None = None) -> Pieces:
    """Return the pieces of the chain, whose nodes are connected by the selected shafts (mask, shape
    (shafts,); None: all shafts).
    """
    joining = np.ones(len(chain.start), bool) if shafts is None else shafts
    if not np.any(joining):
        return Pieces(np.arange(len(chain.inertia)), np.ones(len(chain.inertia)))
    first = np.full(len(chain.inertia), -1)
    pace = np.ones(len(chain.inertia))
    for node in range(len(first)):
        if first[node] < 0:
            first[node] = node
            for child, parent, _, near, far in grow_branches(chain, [node], joining):
                first[child] = node
                pace[child] = -far / near * pace[parent]
    return Pieces(first, pace)


def find_still(chain: Chain) -> NDArray[np.bool_]:
    """Return a mask (nodes,) of the nodes that cannot move: clamped nodes, and nodes that mesh with
    them.
    """
    meshes = find_pieces(chain, np.isinf(chain.stiffness))
    return np.isin(meshes.first, meshes.first[chain.clamped])


def rigid_motions(chain: Chain) -> Real:
    """Return the rigid-body motions, shape (motions, nodes): for each piece that can turn freely,
    the angles of its nodes, 1 at its first node. The ratios of a loop must be consistent.
    """
    pieces = find_pieces(chain, chain.stiffness > 0)
    free = np.setdiff1d(pieces.first, pieces.first[chain.clamped])
    return np.where(pieces.first == free[:, None], pieces.pace, 0)


def incidence(chain: Chain) -> Real:
    """Return the twist of every shaft for a unit angle of each node, shape (shafts, nodes)."""
    rows = np.zeros((len(chain.start), len(chain.inertia)))
    each = np.arange(len(chain.start))
    rows[each, chain.start] = chain.ratio
    rows[each, chain.end] -= 1
    return rows


def follow_gears(chain: Chain) -> tuple[Real, Indices]:
    """Return the angle of every node for a unit angle of each independent node, shape (nodes, dof),
    and the indices of the independent nodes, shape (dof,). Of nodes that mesh, the first is
    independent; nodes that cannot move are not among the independent nodes.
    """
    meshes = find_pieces(chain, np.isinf(chain.stiffness))
    independent = np.unique(meshes.first[~find_still(chain)])
    return np.where(meshes.first[:, None] == independent, meshes.pace[:, None], 0), independent


def grow_branches(chain: Chain, roots: Sequence[int], shafts: NDArray[np.bool_]) -> list[Branch]:
    """Return the branches from these roots outward, along the selected shafts (mask, shape
    (shafts,)).
    """
    joined: dict[int, list[Branch]] = {}
    for shaft in np.flatnonzero(shafts).tolist():
        start = int(chain.start[shaft])
        end = int(chain.end[shaft])
        ratio = float(chain.ratio[shaft])
        joined.setdefault(start, []).append(Branch(end, start, shaft, -1.0, ratio))
        joined.setdefault(end, []).append(Branch(start, end, shaft, ratio, -1.0))
    reached = {*roots}
    branches = list[Branch]()
    outward = list(roots)
    for parent in outward:
        for branch in joined.get(parent, ()):
            if branch.child not in reached:
                branches.append(branch)
                reached.add(branch.child)
                outward.append(branch.child)
    return branches


_TUNED = 1e-12  # smallest detuning, which avoids a division by zero


def viscous_inertia(inertia: float | Real, damping: float | Real, frequency: Real) -> Complex:
    """Return the complex inertia `J/(1 + i w J/c)` of a viscous ring, from its inertia J (kg m2),
    its damping c (N m s) and the frequency w (rad/s); the arguments broadcast.
    """
    return inertia / (1 + 1j * frequency * (inertia / damping))


def pendulum_inertia(mass: float, radius: float, length: float, order: Real) -> Complex:
    """Return the effective inertia `m (R + L)^2/(1 - n^2 L/R)` of a centrifugal pendulum of mass m
    (kg) and length L (m) with its pivot at a radius R (m), for n oscillations in each turn of its
    node. A pendulum with n^2 = R/L holds its node at rest.
    """
    return mass * (radius + length) ** 2 / _detune(radius, length, order)


def pendulum_swing(radius: float, length: float, order: Real) -> Complex:
    """Return the angle of a pendulum relative to its node over the angle of the node, for small
    angles: `n^2 (1 + L/R)/(1 - n^2 L/R)`, with the symbols of `pendulum_inertia`.
    """
    return order**2 * (1 + length / radius) / _detune(radius, length, order)


def best_viscous_damping(inertia: float, ratio: float, frequency: float) -> float:
    """Return the damping c (N m s) with which a viscous ring minimises the peak response of a
    system of one degree of freedom: `c = 2 J w / sqrt(2 (1 + ratio) (2 + ratio))`, where J (kg m2)
    is the ring's inertia, `ratio` is J over the system's inertia, and w (rad/s) is the natural
    frequency. The peak is then 1 + 2/ratio times the static response (Den Hartog, Mechanical
    Vibrations, Houdaille damper).
    """
    return 2 * inertia * frequency / sqrt(2 * (1 + ratio) * (2 + ratio))


def _detune(radius: float, length: float, order: Real) -> Complex:
    """Return `1 - n^2 L/R`, or a tiny number in place of 0."""
    detuning = 1 - order**2 * (length / radius) + 0j
    return np.where(np.abs(detuning) < _TUNED, _TUNED, detuning)

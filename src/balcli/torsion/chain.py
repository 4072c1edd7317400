"""Torsional chains: inertias on shafts and gears, and how the nodes are joined.

A chain is a tree of nodes joined by shafts. A shaft from one node to another twists by `ratio
x_start - x_end`: its stiffness counts in the speed of its end, and a gear ratio other than 1 means
a mesh at its start. A mesh alone is a shaft that is rigid (stiffness inf). Loops are allowed, where
power is split.

Torsional dampers as complex inertias.

A damper is a complex moment of inertia J (kg m2) that is added to that of its node: the damper
takes the torque `-w^2 J x` when the node turns by x. It takes energy if the imaginary part of J is
negative.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import sqrt
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.vibration import Complex, Indices, Real

SAME_RATIO = 1e-9  # two ways round a loop of gears that differ by less turn alike


class ChainShaft(NamedTuple):
    """A shaft between two nodes (their indices), N m/rad in the speed of its end; inf: rigid."""

    start: int
    end: int
    stiffness: float
    ratio: float = 1.0


class Pieces(NamedTuple):
    """Nodes that turn together, piece by piece.

    Attributes:
        first: (nodes,) the first node of the piece that each belongs to.
        pace: (nodes,) speed of each over that of this first node.
        locked: (nodes,) whether a loop of the piece has ratios that contradict each other.
    """

    first: Indices
    pace: Real
    locked: NDArray[np.bool_]


class Chain(NamedTuple):
    """Nodes and shafts as arrays.

    Attributes:
        inertia: (nodes,) kg m2; 0: massless.
        start, end: (shafts,) nodes that each shaft joins.
        ratio: (shafts,) speed of the end over that of the start.
        stiffness: (shafts,) N m/rad in the speed of the end; inf: a mesh of gears.
        clamped: (nodes,) which are held.
    """

    inertia: Real
    start: Indices
    end: Indices
    ratio: Real
    stiffness: Real
    clamped: NDArray[np.bool_]


class Damping(NamedTuple):
    """Losses of a chain, without those of dampers that are given as complex inertias.

    Attributes:
        loss: (shafts,) loss factors: stiffness k (1 + i loss).
        dashpots: (shafts,) N m s/rad, parallel to each shaft.
        nodes: (nodes,) N m s/rad, against ground.
    """

    loss: Real
    dashpots: Real
    nodes: Real


class Branch(NamedTuple):
    """A node joined to another by a shaft, which twists by `near x_child + far x_parent`."""

    child: int
    parent: int
    shaft: int
    near: float
    far: float


def join_chain(
    inertia: ArrayLike, shafts: Iterable[ChainShaft], clamped: Sequence[int] = ()
) -> Chain:
    """Return the chain of nodes with these moments of inertia (kg m2, 0: massless), joined by
    shafts, whether or not it can turn.
    """
    table = np.array(list(shafts), float).reshape(-1, len(ChainShaft._fields))
    start, end = table[:, 0].astype(np.intp), table[:, 1].astype(np.intp)
    j = np.asarray(inertia, float)
    held = np.isin(np.arange(len(j)), clamped)
    return Chain(j, start, end, table[:, 3], table[:, 2], held)


def find_pieces(chain: Chain, shafts: NDArray[np.bool_] | None = None) -> Pieces:
    """Return the nodes that are connected by some of the shafts (shafts,), or by all."""
    joining = np.ones(len(chain.start), bool) if shafts is None else shafts
    first, pace = np.full(len(chain.inertia), -1), np.ones(len(chain.inertia))
    for node in range(len(first)):
        if first[node] < 0:
            first[node] = node
            for child, parent, _, near, far in grow_branches(chain, [node], joining):
                first[child], pace[child] = node, -far / near * pace[parent]
    off = np.abs(pace[chain.end] - pace[chain.start] * chain.ratio)
    torn = joining & (off > SAME_RATIO * np.abs(pace[chain.end]))
    return Pieces(first, pace, np.isin(first, first[chain.start[torn]]))


def find_still(chain: Chain) -> NDArray[np.bool_]:
    """Return which nodes (nodes,) stand still: clamped ones, and nodes that mesh with these."""
    meshes = find_pieces(chain, np.isinf(chain.stiffness))
    return np.isin(meshes.first, meshes.first[chain.clamped])


def rigid_motions(chain: Chain) -> Real:
    """(count, nodes): the angles of nodes that turn together without twisting a shaft, 1 at the
    first of them; one row for each piece that can.
    """
    pieces = find_pieces(chain, chain.stiffness > 0)
    stopped = np.unique(pieces.first[chain.clamped | pieces.locked])
    free = np.setdiff1d(pieces.first, stopped)
    return np.where(pieces.first == free[:, None], pieces.pace, 0)


def incidence(chain: Chain) -> Real:
    """(shafts, nodes): twist of every shaft for a unit angle of each node."""
    rows = np.zeros((len(chain.start), len(chain.inertia)))
    each = np.arange(len(chain.start))
    rows[each, chain.start] = chain.ratio
    rows[each, chain.end] -= 1
    return rows


def follow_gears(chain: Chain) -> tuple[Real, Indices]:
    """Return the angle of every node for a unit angle of each independent one, shape (nodes, dof),
    and the independent nodes (dof,): the first of nodes joined by meshes; none at rest.
    """
    meshes = find_pieces(chain, np.isinf(chain.stiffness))
    independent = np.unique(meshes.first[~find_still(chain)])
    return np.where(meshes.first[:, None] == independent, meshes.pace[:, None], 0), independent


def grow_branches(chain: Chain, roots: Sequence[int], shafts: NDArray[np.bool_]) -> list[Branch]:
    """Return the branches from these roots outward, along some of the shafts (shafts,)."""
    joined: dict[int, list[Branch]] = {}
    for shaft in np.flatnonzero(shafts).tolist():
        start, end = int(chain.start[shaft]), int(chain.end[shaft])
        ratio = float(chain.ratio[shaft])
        joined.setdefault(start, []).append(Branch(end, start, shaft, -1.0, ratio))
        joined.setdefault(end, []).append(Branch(start, end, shaft, ratio, -1.0))
    reached, branches, outward = {*roots}, list[Branch](), list(roots)
    for parent in outward:
        for branch in joined.get(parent, ()):
            if branch.child not in reached:
                branches.append(branch)
                reached.add(branch.child)
                outward.append(branch.child)
    return branches


_TUNED = 1e-12  # a damper tuned closer than this holds its node as still as figures can say


def viscous_inertia(inertia: float | Real, damping: float | Real, frequency: Real) -> Complex:
    """Return the inertia of a ring (J, kg m2) in a fluid (c, N m s) at w rad/s, or of several that
    broadcast: `J/(1 + i w J/c)`.
    """
    return inertia / (1 + 1j * frequency * (inertia / damping))


def pendulum_inertia(mass: float, radius: float, length: float, order: Real) -> Complex:
    """Return the inertia of a mass (kg) on a pendulum of a length L (m), hung up at a radius R (m),
    at an order of the speed of its node: `m (R + L)^2/(1 - n^2 L/R)`. Tuned to n^2 = R/L, it
    holds its node still.
    """
    return mass * (radius + length) ** 2 / _detune(radius, length, order)


def pendulum_swing(radius: float, length: float, order: Real) -> Complex:
    """Return the angle of a pendulum against its node for each rad of swing of the node, both
    small: `n^2 (1 + L/R)/(1 - n^2 L/R)`.
    """
    return order**2 * (1 + length / radius) / _detune(radius, length, order)


def best_viscous_damping(inertia: float, ratio: float, frequency: float) -> float:
    """Return the damping c (N m s) of a viscous ring (kg m2) for the smallest largest response of a
    system of one degree of freedom with a natural frequency w (rad/s) and 1/ratio of its inertia:
    `2 J w / sqrt(2 (1 + ratio) (2 + ratio))`. The response is then 1 + 2/ratio times the static one
    (Den Hartog, Mechanical Vibrations, Houdaille damper).
    """
    return 2 * inertia * frequency / sqrt(2 * (1 + ratio) * (2 + ratio))


def _detune(radius: float, length: float, order: Real) -> Complex:
    """Return `1 - n^2 L/R`, where it is not 0."""
    detuning = 1 - order**2 * (length / radius) + 0j
    return np.where(np.abs(detuning) < _TUNED, _TUNED, detuning)

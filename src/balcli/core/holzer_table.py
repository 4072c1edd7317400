"""Holzer's table: a torsional chain at one frequency, node by node, as the books draw it up."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .torsional_chain import Branch, Chain, find_still, grow_branches
from .vibration import Real


class Holzer(NamedTuple):
    """Holzer's table, one row a node, in the nodes' order.

    Attributes:
        angle: of each node.
        torque: of its inertia, `J w^2 angle`.
        total: torque of all inertias up to this node, which its shaft onward carries.
        stiffness: of the shaft onward in the node's own speed; of the last node 0.
        twist: of that shaft, total over stiffness.
        residual: what is left at the last node; 0 at a natural frequency, unless that node is
            clamped, when its angle is 0 instead.
    """

    angle: Real
    torque: Real
    total: Real
    stiffness: Real
    twist: Real
    residual: float


def tabulate_holzer(chain: Chain, frequency: float, first: int = 0, last: int = -1) -> Holzer:
    """Holzer's table at w (rad/s), from the first node, whose angle is 1, to the last.

    A branch beside the way from the first to the last moves as the way makes it: its torque joins
    at the node that it hangs on. Dampers and loss are left out, as in the books.

    Raises:
        ValueError: the chain has a loop or two pieces; a node meshes with a clamped one; a node of
            the way before the last is clamped; a branch at resonance needs the node it hangs on at
            rest.
    """
    count = len(chain.inertia)
    stiff = chain.stiffness > 0
    branches = grow_branches(chain, [last % count], stiff)
    if not len(branches) == count - 1 == np.count_nonzero(stiff):
        raise ValueError("Holzer's table needs a chain in one piece, without loops")
    if np.any(find_still(chain) & ~chain.clamped):
        raise ValueError(
            "Holzer's table cannot have what meshes with a fixed node; fix it, too, and leave the "
            "gear out"
        )
    onward = {branch.child: branch for branch in branches}
    way = []
    while first in onward:
        way.append(onward[first])
        first = onward[first].parent
    if any(chain.clamped[branch.child] for branch in way):
        raise ValueError("Holzer's table can lead to a clamped node, but not over it")
    hung = [branch for branch in branches if branch not in way]
    own = _hang(chain, hung, -(frequency**2) * chain.inertia)
    angle, total = _pass_on(chain, way, hung, own)
    stiffness, twist = np.zeros(count), np.zeros(count)
    for child, _, shaft, near, _ in branches:
        stiffness[child] = near**2 * chain.stiffness[shaft]
        twist[child] = total[child] / stiffness[child]
    torque = frequency**2 * chain.inertia * angle
    return Holzer(angle, torque, total, stiffness, twist, float(total[last]))


def _hang(chain: Chain, hung: list[Branch], own: Real) -> Real:
    """Dynamic stiffness (nodes,) of every node with all that hangs on it."""
    for child, parent, shaft, near, far in reversed(hung):
        if chain.clamped[child]:
            own[parent] += far**2 * chain.stiffness[shaft]
            continue
        pivot = near**2 + own[child] / chain.stiffness[shaft]
        if pivot == 0:
            raise ValueError(f"the branch of node {child} is at resonance by itself")
        own[parent] += far**2 * own[child] / pivot
    return own


def _pass_on(chain: Chain, way: list[Branch], hung: list[Branch], own: Real) -> tuple[Real, Real]:
    """Angles, and the torque that every node passes on: along the way, then out to the branches."""
    angle, arrived = np.zeros(len(own)), np.zeros(len(own))
    angle[way[0].child if way else 0] = 1
    for child, parent, shaft, near, far in way:
        torque = (arrived[child] - own[child] * angle[child]) / near
        angle[parent] = (torque / chain.stiffness[shaft] - near * angle[child]) / far
        arrived[parent] = -far * torque
    for child, parent, shaft, near, far in hung:
        if chain.clamped[child]:
            arrived[child] = near * far * chain.stiffness[shaft] * angle[parent]
        else:
            angle[child] = -near * far * angle[parent]
            angle[child] /= near**2 + own[child] / chain.stiffness[shaft]
    return angle, arrived - own * angle

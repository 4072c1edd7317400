"""Holzer's table: a torsional chain at one frequency, node by node, as the books draw it up."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .torsional_chain import Chain, find_still, grow_branches
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
    """Return Holzer's table at w (rad/s), from the first node, whose angle is 1, to the last.

    Its angles x and torques T of shafts solve the equations of the chain, `near x_child + far
    x_parent = T/k` for each shaft and `w^2 J x = sum of T` for each node but the last: there the
    sum is the residual. A branch beside the way from the first node to the last moves as the way
    makes it. Dampers and loss are left out, as in the books.

    Args:
        chain: Inertias and shafts.
        frequency: w, rad/s.
        first: Node whose angle is 1.
        last: Node at which the table ends.

    Raises:
        ValueError: the chain has a loop or two pieces; a node meshes with a clamped one; a node of
            the way before the last is clamped; a branch is at resonance by itself.
    """
    count = len(chain.inertia)
    last, stiff = last % count, chain.stiffness > 0
    branches = grow_branches(chain, [last], stiff)
    if not len(branches) == count - 1 == np.count_nonzero(stiff):
        raise ValueError("Holzer's table needs a chain in one piece, without loops")
    if np.any(find_still(chain) & ~chain.clamped):
        raise ValueError(
            "Holzer's table cannot have what meshes with a fixed node; fix it, too, and leave the "
            "gear out"
        )
    parents, node = {branch.child: branch.parent for branch in branches}, first
    while node in parents:
        if chain.clamped[node]:
            raise ValueError("Holzer's table can lead to a clamped node, but not over it")
        node = parents[node]
    inertial = frequency**2 * chain.inertia
    unit = float(inertial.max()) or 1.0  # N m; torques are as large as angles in it
    matrix, right = np.zeros((2 * count, 2 * count)), np.zeros(2 * count)
    matrix[range(count), range(count)] = inertial / unit
    for row, (child, parent, shaft, near, far) in enumerate(branches, count):
        matrix[row, [child, parent]] = near, far
        matrix[row, row] = -unit / chain.stiffness[shaft]
        matrix[[child, parent], row] = -near, -far
    for node in np.flatnonzero(chain.clamped).tolist():
        matrix[node] = np.arange(2 * count) == node
    matrix[last] = np.arange(2 * count) == first
    right[last] = 1.0
    matrix[-1, -1] = 1.0  # there is one shaft less than nodes
    try:
        solution = np.linalg.solve(matrix, right)
    except np.linalg.LinAlgError:
        raise ValueError("a branch is at resonance by itself") from None
    angle, torque = solution[:count], inertial * solution[:count]
    total, stiffness, twist = torque.copy(), np.zeros(count), np.zeros(count)
    for carried, (child, parent, shaft, near, far) in zip(solution[count:], branches, strict=False):
        total[child] = near * unit * carried
        stiffness[child] = near**2 * chain.stiffness[shaft]
        twist[child] = total[child] / stiffness[child]
        if parent == last:
            total[last] -= far * unit * carried
    return Holzer(angle, torque, total, stiffness, twist, float(total[last]))

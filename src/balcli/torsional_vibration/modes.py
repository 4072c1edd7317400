"""Compute natural modes of a torsional system (frequencies, shapes, positions of nodes, losses),
and critical speeds, at which orders excite modes.

A mode has vibration nodes, places that do not move. The nodes of the chain are its inertias.

Holzer's table lists angles and torques of a chain at one frequency, node by node, as in textbooks.
"""

from __future__ import annotations

import math
from operator import attrgetter
from typing import Annotated, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.phases import RPM
from ..core.records import HIDDEN
from ..core.vibration import Complex, Indices, Modes, Real, find_modes, scale_shapes
from ..file.fields import order_number
from .chain import (
    Chain,
    Damping,
    find_pieces,
    find_still,
    follow_gears,
    grow_branches,
    incidence,
    rigid_motions,
)
from .system import Excitation, TorsionalSystem

# A node is at rest if its angle is below this share of the largest angle, and of the angle of the
# node through which it is reached from those that move.
_AT_REST = 1e-9
_SMALL = 1e-6  # angles below this share of the largest are computed anew, because of rounding


def find_chain_modes(chain: Chain) -> Modes:
    """Return the natural modes with shapes (modes, nodes) of unit modal mass. Frequencies have
    relative errors of about 1e-15; those of rigid motions are exactly 0. Massless nodes add no
    mode.
    """
    follow, independent = follow_gears(chain)
    mass = chain.inertia @ follow**2
    elastic = np.isfinite(chain.stiffness) & (chain.stiffness > 0)
    heavy = mass > 0
    springs, stiffness, carried = _condense(
        (incidence(chain) @ follow)[elastic], chain.stiffness[elastic], np.flatnonzero(~heavy)
    )
    rigid = rigid_motions(chain)[:, independent][:, heavy]
    modes = find_modes(springs[:, heavy], stiffness, mass[heavy], rigid)
    shapes = np.zeros((len(modes.omega), len(mass)))
    shapes[:, heavy] = modes.shapes
    for dof, by_others in reversed(carried):
        shapes[:, dof] = shapes @ by_others
    return Modes(modes.omega, shapes @ follow.T, modes.rigid)


def _condense(
    springs: Real, stiffness: Real, massless: Indices
) -> tuple[Real, Real, list[tuple[int, Real]]]:
    """Return springs (springs, dof) and their stiffness (springs,) with the massless degrees of
    freedom eliminated. The third result lists each eliminated degree of freedom with its factors
    (dof,): its angle is their product with the other angles.

    The springs k_i that meet at a massless node become a spring `k_i k_j/sum k` between any two of
    their other ends (Lagrange's identity). All terms are positive, so nothing cancels.
    """
    carried = []
    for dof in massless.tolist():
        meet = springs[:, dof] != 0
        a = springs[meet, dof]
        k = stiffness[meet]
        ends = springs[meet].copy()
        ends[:, dof] = 0
        total = (k * a) @ a
        carried.append((dof, -(k * a) @ ends / total))
        i, j = np.triu_indices(len(a), 1)
        between = a[j, None] * ends[i] - a[i, None] * ends[j]
        springs = np.concatenate([springs[~meet], between])
        stiffness = np.concatenate([stiffness[~meet], k[i] * k[j] / total])
    return springs, stiffness, carried


def chain_loss(
    chain: Chain, damping: Damping, modes: Modes, attached: Complex | float = 0.0
) -> Real:
    """Return the loss factor (modes,) of every mode: energy lost in a cycle, divided by 2 pi
    times the vibration energy; 0 for rigid modes.

    Args:
        attached: Complex inertias of dampers at the natural frequencies; they broadcast to (modes,
            nodes).
    """
    elastic = np.isfinite(chain.stiffness)
    twist = (modes.shapes @ incidence(chain)[elastic].T) ** 2
    moved = modes.shapes**2
    loss = chain.stiffness[elastic] * damping.loss[elastic]
    felt = np.asarray(attached, complex).imag * moved
    lost = twist @ loss - modes.omega**2 * felt.sum(axis=1)
    lost += modes.omega * (twist @ damping.dashpots[elastic] + moved @ damping.nodes)
    return np.where(modes.omega > 0, lost / np.where(modes.omega > 0, modes.omega, 1) ** 2, 0)


def locate_nodes(chain: Chain, shape: Real, omega: float) -> tuple[Indices, Indices]:
    """Return the positions of the vibration nodes of a mode: the shafts whose ends turn against
    each other, and the nodes of the chain that are at rest between neighbours that turn against
    each other. Of meshed wheels at rest, only the first is listed.

    Args:
        chain: Inertias and shafts.
        shape: (nodes,) angle of each node.
        omega: Angular frequency of the mode, rad/s.
    """
    shape = _refine_small_angles(chain, shape, omega)
    moves = _find_moving(chain, shape)
    ahead = np.where(moves, np.sign(shape), 0)
    across = ahead[chain.start] * ahead[chain.end] * np.sign(chain.ratio)
    meshes = find_pieces(chain, np.isinf(chain.stiffness))
    pulled = np.zeros((2, len(shape)), bool)  # whether a neighbour turns forward, and backward
    for here, there in ((chain.start, chain.end), (chain.end, chain.start)):
        way = ahead[there] * np.sign(chain.ratio * meshes.pace[here])
        wheel = meshes.first[here]
        pulled[0, wheel[way > 0]] = pulled[1, wheel[way < 0]] = True
    at_rest = pulled.all(axis=0) & ~moves & ~find_still(chain)
    return np.flatnonzero((across < 0) & np.isfinite(chain.stiffness)), np.flatnonzero(at_rest)


def _refine_small_angles(chain: Chain, shape: Real, omega: float) -> Real:
    """Return the angles of a mode, the small ones with their own accuracy. Behind soft shafts,
    angles fall by a factor from inertia to inertia, and soon below the rounding error of the
    largest one, by which their signs would be lost. They follow from the large angles, because no
    torque is left over at their inertias.

    Args:
        chain: Inertias and shafts.
        shape: (nodes,) angle of each node.
        omega: Angular frequency of the mode, rad/s.
    """
    follow, independent = follow_gears(chain)
    angles = shape[independent]
    small = np.abs(angles) < _SMALL * np.abs(angles).max(initial=0.0)
    if not np.any(small):
        return shape
    elastic = np.isfinite(chain.stiffness)
    springs = incidence(chain)[elastic] @ follow
    left_over = (springs.T * chain.stiffness[elastic]) @ springs
    left_over -= omega**2 * np.diag(chain.inertia @ follow**2)
    applied = left_over[np.ix_(small, ~small)] @ angles[~small]
    try:
        refined = np.linalg.solve(left_over[np.ix_(small, small)], -applied)
    except np.linalg.LinAlgError:
        return shape  # these inertias could also vibrate by themselves
    if np.abs(refined).max() > _SMALL * np.abs(angles).max():
        return shape  # nearly so
    angles[small] = refined
    exact: Real = follow @ angles
    return exact


def _find_moving(chain: Chain, shape: Real) -> NDArray[np.bool_]:
    """Return a mask (nodes,) of the nodes that move in a mode."""
    size = np.abs(shape)
    moves = size > _AT_REST * size.max()
    roots = np.flatnonzero(moves).tolist()
    for branch in grow_branches(chain, roots, chain.stiffness > 0):
        follows = size[branch.child] > _AT_REST * size[branch.parent]
        moves[branch.child] = moves[branch.parent] and follows
    return moves


# Work below this share of the work that all torques would do in phase is a rounding error.
_UNDRIVEN = 1e-10


class NaturalMode(NamedTuple):
    """Natural mode in which shafts twist.

    Attributes:
        frequency_Hz: Natural frequency.
        shape: Actual angle of each node, not reduced by gears, divided by the largest.
        nodes: Number of vibration nodes, places that do not move.
        node_in: Names of the shafts with a vibration node: their ends turn against each other.
        node_at: Names of the nodes of the chain that are at rest between nodes that move.
        loss: Loss factor of the mode by dampers, shafts and nodes together.
        number: Number of the mode, from 1.
    """

    frequency_Hz: float
    shape: Real
    nodes: int
    node_in: tuple[str, ...]
    node_at: tuple[str, ...]
    loss: float
    number: Annotated[int, HIDDEN]

    @property
    def omega(self) -> float:
        """Natural frequency, rad/s."""
        return 2 * np.pi * self.frequency_Hz


class Critical(NamedTuple):
    """Speed at which an order excites a mode.

    Attributes:
        mode: Number of the mode, from 1.
        order: Order of the excitation.
        speed_rpm: Critical speed.
        phase_sum: Magnitude of a sum over all torques of this order, divided by the largest of
            their amplitudes. Each term is the phasor of a torque times the angle, in the mode, of
            the node on which this torque acts.
        work_share: Work at this critical speed divided by the sum of the works at all critical
            speeds of the mode.
        work: Work (J) of all torques in one cycle of vibration with an amplitude of 1 rad where the
            shape is 1.
    """

    mode: int
    order: float
    speed_rpm: float
    phase_sum: float
    work_share: float
    work: Annotated[float, HIDDEN]


class OutsideCritical(NamedTuple):
    """Critical speed just outside the range of speeds.

    Attributes:
        mode: Number of the mode, from 1.
        order: Order of the excitation.
        speed_rpm: Critical speed.
        phase_sum: As for a critical speed in the range.
        work: As for a critical speed in the range.
    """

    mode: int
    order: float
    speed_rpm: float
    phase_sum: float
    work: Annotated[float, HIDDEN]


def find_natural_modes(system: TorsionalSystem) -> tuple[NaturalMode, ...]:
    """Return the modes in which shafts twist, lowest first."""
    modes = find_chain_modes(system.chain)
    loss = chain_loss(system.chain, system.damping, modes, system.attached_rings(modes.omega))
    natural_modes = []
    for k, shape in enumerate(scale_shapes(modes.shapes)[modes.rigid :], modes.rigid):
        in_shafts, at_nodes = locate_nodes(system.chain, shape, float(modes.omega[k]))
        mode = NaturalMode(
            frequency_Hz=float(modes.omega[k]) / (2 * np.pi),
            shape=shape,
            nodes=len(in_shafts) + len(at_nodes),
            node_in=tuple(system.shafts[each] for each in in_shafts),
            node_at=tuple(system.nodes[each] for each in at_nodes),
            loss=float(loss[k]),
            number=k - modes.rigid + 1,
        )
        natural_modes.append(mode)
    return tuple(natural_modes)


class _Drive(NamedTuple):
    """What torques do at the critical speeds of each mode and order, shape (modes, orders).

    Attributes:
        orders: Orders, shape (orders,).
        rpm: Critical speeds.
        work: Sum of the works of all torques, over pi, J, with their phases.
        most: Sum of the works without phases.
        largest: Largest amplitude of a torque, N m.
    """

    orders: Real
    rpm: Real
    work: Real
    most: Real
    largest: Real


def find_criticals(
    system: TorsionalSystem,
    modes: tuple[NaturalMode, ...],
    range_rpm: tuple[float, float] | None = None,
) -> tuple[Critical, ...]:
    """Return the critical speeds, sorted by falling work. The work of a torque without a known
    phase is added.

    Args:
        system: System with an excitation.
        modes: Natural modes.
        range_rpm: First and last speed, rpm; None: all speeds.
    """
    if system.excitation is None:
        return ()
    low, high = range_rpm or (0.0, np.inf)
    drive = _find_drive(system.excitation, modes, low, high)
    for own in system.unphased:
        drive = _add_drive(drive, _find_drive(own, modes, low, high))
    counted = (drive.rpm >= low * (1 - 1e-12)) & (drive.rpm <= high * (1 + 1e-12))
    counted &= drive.work > _UNDRIVEN * drive.most
    total = np.sum(drive.work, axis=1, where=counted)
    criticals = []
    for m, k in np.argwhere(counted):
        work = float(drive.work[m, k])
        critical = Critical(
            mode=modes[m].number,
            order=order_number(float(drive.orders[k])),
            speed_rpm=float(drive.rpm[m, k]),
            phase_sum=work / float(drive.largest[m, k]),
            work_share=work / float(total[m]),
            work=math.pi * work,
        )
        criticals.append(critical)
    return tuple(sorted(criticals, key=lambda critical: -critical.work))


def _find_drive(
    excitation: Excitation, modes: tuple[NaturalMode, ...], low: float, high: float
) -> _Drive:
    """Return what an excitation does at its critical speeds; torques are computed at speeds (rpm)
    from `low` to `high`.
    """
    orders = excitation.orders
    moved = np.array([mode.shape[excitation.nodes] for mode in modes])
    moved = moved.reshape(len(modes), 1, len(excitation.nodes))
    speeds = np.array([mode.omega for mode in modes])[:, None] / orders
    within = np.clip(speeds, low * RPM, high * RPM)  # speeds outside are ignored
    torque = excitation.at_own(within)
    work = torque * moved
    return _Drive(
        orders=orders,
        rpm=speeds / RPM,
        work=np.abs(work.sum(axis=-1)),
        most=np.abs(work).sum(axis=-1),
        largest=np.abs(torque).max(axis=-1, initial=0.0),
    )


def _add_drive(drive: _Drive, own: _Drive) -> _Drive:
    """Return what two excitations do in the worst phase; the second one has a single order."""
    same = np.flatnonzero(drive.orders == own.orders[0])
    if not len(same):
        joined = [np.append(every, some, axis=-1) for every, some in zip(drive, own, strict=True)]
        return _Drive._make(joined)
    added = np.zeros_like(drive.work)
    added[:, same] = own.work
    largest = drive.largest.copy()
    largest[:, same] = np.maximum(largest[:, same], own.largest)
    return drive._replace(work=drive.work + added, most=drive.most + added, largest=largest)


def sum_phases(excitation: Excitation, modes: tuple[NaturalMode, ...], omega: float) -> Real:
    """Return the phase sum of every mode and order at one speed, shape (modes, orders): the
    magnitude of the sum over all torques of an order, each times the angle of its node in the mode,
    divided by the largest torque of this order; nan where there is no torque.

    Args:
        excitation: Orders and torques.
        modes: Natural modes.
        omega: Speed of the reference node, rad/s.
    """
    torque = excitation.at(np.array([omega]))[:, 0, :]
    moved = np.array([mode.shape[excitation.nodes] for mode in modes])
    phasors = np.abs(moved.reshape(len(modes), len(excitation.nodes)) @ torque.T)
    largest = np.abs(torque).max(axis=1)
    unknown = np.full_like(phasors, np.nan)
    return np.divide(phasors, largest, out=unknown, where=largest > 0)


_OUTSIDE = 0.2  # share of the first and last speed up to which criticals outside are listed


def find_criticals_outside(
    system: TorsionalSystem, modes: tuple[NaturalMode, ...], range_rpm: tuple[float, float]
) -> tuple[OutsideCritical, ...]:
    """Return the critical speeds in the 20 % below and above a range of speeds, by rising speed.

    Args:
        system: System with an excitation.
        modes: Natural modes.
        range_rpm: First and last speed, rpm.
    """
    first, last = range_rpm
    inside = find_criticals(system, modes, range_rpm)
    near = find_criticals(system, modes, (first * (1 - _OUTSIDE), last * (1 + _OUTSIDE)))
    within = {(critical.mode, critical.order) for critical in inside}
    outside = []
    for critical in near:
        if (critical.mode, critical.order) not in within:
            shown = OutsideCritical(
                mode=critical.mode,
                order=critical.order,
                speed_rpm=critical.speed_rpm,
                phase_sum=critical.phase_sum,
                work=critical.work,
            )
            outside.append(shown)
    return tuple(sorted(outside, key=attrgetter("speed_rpm")))


class Holzer(NamedTuple):
    """Holzer's table, one row for each node, in the order of the chain's nodes.

    Attributes:
        angle: (nodes,) angle of each node, rad.
        torque: (nodes,) torque `J w^2 angle` of each node with the inertia J at the frequency w,
            N m.
        total: (nodes,) torque of all inertias up to this node, carried by the shaft to the next.
        stiffness: (nodes,) stiffness of the shaft to the next node, reduced to the speed of this
            node; 0 at the last node.
        twist: (nodes,) twist of the shaft to the next node, total over stiffness.
        residual: torque that is left at the last node; 0 at a natural frequency. If the last node
            is clamped, the angle of the last row is 0 at a natural frequency instead.
    """

    angle: Real
    torque: Real
    total: Real
    stiffness: Real
    twist: Real
    residual: float


def tabulate_holzer(chain: Chain, frequency: float, first: int = 0, last: int = -1) -> Holzer:
    """Return Holzer's table at a frequency w (rad/s). The angle of the first node is 1.

    Angles x and torques T of shafts solve `near x_child + far x_parent = T/k` for each shaft
    of stiffness k (`chain.Branch` defines the gear factors near and far, and the parent), and
    `w^2 J x = sum of T` for each node of inertia J except the last, where the difference of the two
    sides is the residual. Branches off the line from
    the first node to the last are allowed. Dampers and losses are ignored, as in textbooks.

    Args:
        chain: Inertias and shafts.
        frequency: w, rad/s.
        first: Node whose angle is 1.
        last: Node at which the table ends.

    Raises:
        ValueError: The chain has a loop or two pieces; a node meshes with a clamped node; a node on
            the line other than the last is clamped; a branch resonates by itself.
    """
    count = len(chain.inertia)
    last = last % count
    stiff = chain.stiffness > 0
    branches = grow_branches(chain, [last], stiff)
    if not len(branches) == count - 1 == np.count_nonzero(stiff):
        raise ValueError("Holzer's table needs a chain in one piece, without loops")
    if np.any(find_still(chain) & ~chain.clamped):
        raise ValueError("Holzer's table cannot have gears that mesh with a fixed node")
    parents = {branch.child: branch.parent for branch in branches}
    node = first
    while node in parents:
        if chain.clamped[node]:
            raise ValueError("Holzer's table can end at a clamped node, but not pass it")
        node = parents[node]
    inertial = frequency**2 * chain.inertia
    twisting = incidence(chain)[stiff]
    unit = float(inertial.max()) or 1.0  # N m; in this unit torques are about as large as angles
    softness = np.diag(unit / chain.stiffness[stiff])
    matrix = np.block([[np.diag(inertial / unit), -twisting.T], [twisting, -softness]])
    alone = np.eye(len(matrix))
    held = np.flatnonzero(chain.clamped)
    matrix[held] = alone[held]
    matrix[last] = alone[first]
    try:
        solution = np.linalg.solve(matrix, alone[last])
    except np.linalg.LinAlgError:
        raise ValueError("a branch is at resonance by itself") from None
    angle = solution[:count]
    carried = np.zeros(len(stiff))
    carried[stiff] = unit * solution[count:]
    total = inertial * angle - incidence(chain).T @ carried
    stiffness = np.zeros(count)
    for child, _, shaft, near, _ in branches:
        total[child] = near * carried[shaft]
        stiffness[child] = near**2 * chain.stiffness[shaft]
    twist = np.divide(total, stiffness, out=np.zeros(count), where=stiffness > 0)
    return Holzer(angle, inertial * angle, total, stiffness, twist, float(total[last]))

"""Compute the forced steady vibration of a torsional system, order by order at given speeds.

Angles and torques are phasors c; their values in time are `Re(c e^{i w t})`. Frequencies w (rad/s)
may have any shape; the last axis of a result counts nodes or shafts. See `core.vibration`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.peaks import find_swing, sum_amplitudes
from ..core.phases import RPM
from ..core.vibration import (
    UNDAMPED,
    Complex,
    Indices,
    Real,
    UndampedResonanceError,
    solve_equations,
)
from ..errors import BalcliError
from ..limits import MOST_TORSION_TORQUES
from .chain import (
    Chain,
    Damping,
    find_pieces,
    find_still,
    grow_branches,
    incidence,
    viscous_inertia,
)
from .modes import chain_loss, find_chain_modes
from .poles import find_poles
from .system import Excitation, TorsionalSystem

_WEAK_PIVOT = 1e-3  # sums that cancel to less than this share of their terms need pivoting
_RESONANT = 1e-9  # resonance: the chain's dynamic stiffness is below this share of its terms


class Twist(NamedTuple):
    """Phasors of a forced vibration.

    Attributes:
        angle: (*frequency, nodes) angle of each node, rad.
        torque: (*frequency, shafts) torque of each shaft, referred to the speed of its node `end`,
            N m, damping included; positive if it drives that node forward.
    """

    angle: Complex
    torque: Complex


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
        load: Torques on the nodes (N m); they broadcast to (*frequency, nodes).
        attached: Complex inertias of dampers (kg m2); they broadcast to (*frequency, nodes); see
            `TorsionalSystem.attached_rings`.

    Raises:
        UndampedResonanceError: A load drives an undamped mode at its own frequency.
        ValueError: A shaft is a dashpot without a spring, and a frequency is 0.
    """
    frequency = np.asarray(frequency, float)
    shape = (*frequency.shape, len(chain.inertia))
    w = frequency.ravel()
    load = np.ascontiguousarray(np.broadcast_to(load, shape).reshape(-1, shape[-1]).T, complex)
    moving = chain.inertia + np.asarray(attached, complex)
    moving = np.broadcast_to(moving, shape).reshape(-1, shape[-1]).T
    own = np.multiply(moving, -w * w, order="C")
    own += 1j * np.outer(damping.nodes, w)
    carrying = (chain.stiffness > 0) | (damping.dashpots > 0)
    carrying &= ~(chain.clamped[chain.start] & chain.clamped[chain.end])
    flexible = _find_flexibilities(chain, damping, w, carrying)
    angle, torque, weak, singular = _solve_tree(chain, carrying, own, flexible, load)
    if np.any(weak):
        some = own[:, weak], flexible[:, weak], load[:, weak]
        angle[:, weak], torque[:, weak] = _solve_dense(
            chain, carrying, *some, w[weak], singular[weak]
        )
        angle[find_still(chain)] = 0
    return Twist(*(part.T.reshape(*frequency.shape, len(part)) for part in (angle, torque)))


def _find_flexibilities(
    chain: Chain, damping: Damping, w: Real, carrying: NDArray[np.bool_]
) -> Complex:
    """Return 1/stiffness (shafts, points) of every shaft that carries torque; 0 for others."""
    k = np.where(np.isinf(chain.stiffness), 0, chain.stiffness)
    c = damping.dashpots
    stiffness = (k * (1 + 1j * damping.loss))[:, None] + 1j * np.outer(c, w)
    bends = carrying & np.isfinite(chain.stiffness)
    if np.any(stiffness[bends] == 0):
        raise ValueError("a shaft that is only a dashpot carries no torque at a frequency of 0")
    return np.divide(1, stiffness, out=np.zeros_like(stiffness), where=bends[:, None])


def _find_roots(chain: Chain, shafts: NDArray[np.bool_]) -> list[int]:
    """Return one node for each connected piece of the chain: of the nodes that are not clamped, the
    node whose inertia, reduced to a common speed, is the largest.
    """
    pieces = find_pieces(chain, shafts)
    weight = np.where(chain.clamped, -1, chain.inertia * pieces.pace**2)
    heaviest = {pieces.first[node]: node for node in weight.argsort().tolist()}  # last of each
    return [*heaviest.values()]


def _solve_tree(
    chain: Chain, carrying: NDArray[np.bool_], own: Complex, flexible: Complex, load: Complex
) -> tuple[Complex, Complex, NDArray[np.bool_], NDArray[np.bool_]]:
    """Solve the equations by eliminating the nodes of the tree one by one, from its ends to the
    heaviest node. This takes a fifteenth of the time of `_solve_dense`.

    Let d be the dynamic stiffness of a node with all nodes beyond it, f the load on them, s the
    flexibility (1/stiffness) of the shaft from the node to its parent, and near and far the gear
    factors of this shaft (see `chain.Branch`). To eliminate the node, the stiffness
    `far^2 d/(near^2 + s d)` and the load `-near far f/(near^2 + s d)` are added to the parent.
    Because s and d may be 0, rigid shafts, meshes and massless nodes need no exception. Twists are
    not computed as small differences of large angles. A chain with loops cannot be solved in this
    way; all its points are marked as weak.

    Args:
        chain: Inertias and shafts.
        carrying: (shafts,) whether a shaft carries torque.
        own: (nodes, points) dynamic stiffness of each node by itself; a point is a frequency.
        flexible: (shafts, points) 1/stiffness of each shaft.
        load: (nodes, points) torques, N m.

    Returns:
        Angles (nodes, points), torques (shafts, points) and two masks (points,). The first marks
        weak points, where a sum cancelled because a branch or the whole chain is near an undamped
        resonance; they need a solution with pivoting. The second marks points where the whole chain
        is at such a resonance.
    """
    roots = _find_roots(chain, carrying)
    branches = grow_branches(chain, roots, carrying)
    stiff = own.copy()
    load = load.copy()
    size = _bound(own)
    inverse, felt, pushed, angle = np.zeros((4, *own.shape), complex)
    torque = np.zeros(flexible.shape, complex)
    weak = np.full(own.shape[1], len(branches) < np.count_nonzero(carrying))
    singular = np.zeros(own.shape[1], bool)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):  # such points are weak
        for child, parent, shaft, near, far in reversed(branches):
            if chain.clamped[child]:
                mesh = flexible[shaft] == 0
                weak |= mesh
                felt[child] = np.where(mesh, 0, 1 / flexible[shaft])
            else:
                part = flexible[shaft] * stiff[child]
                pivot = near**2 + part
                weak |= _bound(pivot) <= _WEAK_PIVOT * (near**2 + _bound(part))
                inverse[child] = 1 / pivot
                felt[child] = stiff[child] * inverse[child]
                pushed[child] = load[child] * inverse[child]
            stiff[parent] += far**2 * felt[child]
            load[parent] -= near * far * pushed[child]
            size[parent] += far**2 * _bound(felt[child])
        for root in roots:
            if not chain.clamped[root]:
                singular |= _bound(stiff[root]) <= _RESONANT * size[root]
                angle[root] = load[root] / stiff[root]
        for child, parent, shaft, near, far in branches:
            torque[shaft] = near * pushed[child] + far * felt[child] * angle[parent]
            if not chain.clamped[child]:
                moved = near * far * angle[parent] * inverse[child]
                angle[child] = flexible[shaft] * pushed[child] - moved
    return angle, torque, weak | singular, singular


def _bound(values: Complex) -> Real:
    """Return `|Re c| + |Im c|`, which is |c| to 1.42 |c|, in a third of the time."""
    return np.abs(values.real) + np.abs(values.imag)


def _solve_dense(
    chain: Chain,
    carrying: NDArray[np.bool_],
    own: Complex,
    flexible: Complex,
    load: Complex,
    w: Real,
    singular: NDArray[np.bool_],
) -> tuple[Complex, Complex]:
    """Solve `d x + B^T T = f`, `B x = s T` for the angles x (nodes, points) and the torques T
    (shafts, points) with pivoting, scaled by a stiffness of the chain. Here d and f are the dynamic
    stiffness and the load of each node by itself, s is the flexibility of each shaft, and B is the
    incidence matrix. The arguments are those of `_solve_tree`, the frequencies w (rad/s), and the
    mask of points at a resonance.
    """
    elastic = np.isfinite(chain.stiffness) & (chain.stiffness > 0)
    scale = float(np.median(chain.stiffness[elastic])) if np.any(elastic) else 1.0
    free = ~chain.clamped[:, None]
    twist = incidence(chain)[carrying] * ~chain.clamped
    nodes = len(own)
    diagonal = np.arange(len(own) + len(twist))
    matrix = np.zeros((len(w), len(diagonal), len(diagonal)), complex)
    matrix[:, :nodes, nodes:] = twist.T
    matrix[:, nodes:, :nodes] = twist
    each = np.concatenate([np.where(free, own / scale, 1), -scale * flexible[carrying]])
    matrix[:, diagonal, diagonal] = each.T
    right = np.zeros((len(w), len(diagonal)), complex)
    right[:, :nodes] = np.where(free, load / scale, 0).T
    solution = solve_equations(matrix, right, w, singular).T
    torque = np.zeros((len(chain.start), len(w)), complex)
    torque[carrying] = scale * solution[nodes:]
    return solution[:nodes], torque


_EDGE = 1e-10  # a resonance outside the range of speeds by less than this share counts as inside
_AT_A_TIME = 1 << 16  # number of angles and torques computed at once: more leave the cache


class Curves(NamedTuple):
    """Vibration at speeds. The curves are the torques of all shafts (N m), the angle of the free
    end and the angles of pendulums (rad).

    Attributes:
        orders: Orders of the excitation, shape (orders,).
        phasors: Phasors (orders, speeds, curves).
        heat: Power of dampers, W, shape (speeds, dampers): viscous rings, then rubber.
        unphased: Amplitudes by torques whose phase to the cylinders is not known, shape (torques,
            speeds, curves).
    """

    orders: Real
    phasors: Complex
    heat: Real
    unphased: Real

    @property
    def swings(self) -> Real:
        """Half of peak to peak of each curve, shape (speeds, curves): orders add with their phases,
        and torques without a known phase add in the worst phase.
        """
        return find_half_swing(self.orders, self.phasors) + self.unphased.sum(axis=0)

    @property
    def sums(self) -> Real:
        """Sum of all amplitudes of each curve, shape (speeds, curves)."""
        return np.asarray(sum_amplitudes(self.phasors) + self.unphased.sum(axis=0))

    def select(self, speeds: Indices, curves: Indices) -> Curves:
        """Return single curves at single speeds, given by their indices, shape (choices,)."""
        phasors = self.phasors[:, speeds, curves]
        return Curves(self.orders, phasors, self.heat, self.unphased[:, speeds, curves])


def find_half_swing(orders: Real, phasors: Complex, least: Real | None = None) -> Real:
    """Return half of peak to peak of curves, shape (...), from their phasors (orders, ...). Where
    this is below `least`, shape (...), it may be an upper bound that is below `least`, too.
    """
    if not len(orders):
        return np.zeros(phasors.shape[1:])
    return np.asarray(find_swing(orders, phasors, least).half)


def _move(system: TorsionalSystem, excitation: Excitation, rpm: Real) -> tuple[Complex, Real]:
    """Return the phasors and the heat that `Curves` describes, for an excitation."""
    speeds = rpm * RPM
    w = np.multiply.outer(excitation.orders, speeds)
    load = excitation.at(speeds) @ np.equal.outer(excitation.nodes, np.arange(len(system.nodes)))
    attached = system.attached_rings(w) + system.attached_pendulums(excitation.orders[:, None])
    try:
        twist = respond_chain(system.chain, system.damping, w, load, attached)
    except UndampedResonanceError as error:
        row, _ = np.unravel_index(np.abs(w - error.frequency).argmin(), w.shape)
        order = excitation.orders[row]
        omega = error.frequency
        raise BalcliError(
            f"the natural frequency of {omega / (2 * np.pi):.6g} Hz is excited by order {order:g} "
            f"at {omega / (RPM * order):.6g} rpm and nothing damps it: its vibration has no bound; "
            "give a loss factor (loss = 0.02), or damping"
        ).within(system.file) from None
    swings = system.swing_pendulums(excitation.orders, twist.angle)
    parts = twist.torque, twist.angle[:, :, system.ends[:1]], swings
    return np.concatenate(parts, axis=-1), _find_heat(system, w, *twist).sum(axis=0)


def _find_heat(system: TorsionalSystem, w: Real, angle: Complex, torque: Complex) -> Real:
    """Return the power that dampers dissipate, W, shape (orders, speeds, dampers): viscous rings
    `-w^3 Im J |x|^2/2`, with the complex inertia J and the angle x of the node; then rubber (the
    last shafts) `w loss |T|^2/(2 k (1 + loss^2))`, with the torque T and the stiffness k.
    """
    nodes, inertia, damping = np.array(system.rings, float).reshape(-1, 3).T
    ring = viscous_inertia(inertia, damping, w[..., None])
    oil = -(w[..., None] ** 3) * ring.imag * np.abs(angle[..., nodes.astype(int)]) ** 2
    first = len(system.shafts) - system.rubber_rings
    loss = system.damping.loss[first:]
    stiffness = system.chain.stiffness[first:]
    softness = loss / (stiffness * (1 + loss**2))
    rubber = w[..., None] * softness * np.abs(torque[..., first:]) ** 2
    return np.concatenate([oil, rubber], axis=-1) / 2


def compute_in_parts(system: TorsionalSystem, rpm: Real) -> Iterator[Curves]:
    """Yield the curves of `compute_curves` for consecutive groups of speeds, which bounds the
    memory.
    """
    excitation = system.require_excitation()
    work = len(excitation.orders) * (len(system.nodes) + len(system.shafts))
    for some in np.array_split(rpm, len(rpm) * work // _AT_A_TIME + 1):
        phasors, heat = _move(system, excitation, some)
        unphased = np.zeros((len(system.unphased), *phasors.shape[1:]))
        for torque, alone in enumerate(system.unphased):
            own, own_heat = _move(system, alone, some)
            unphased[torque] = np.abs(own[0])
            heat = heat + own_heat
        yield Curves(excitation.orders, phasors, heat, unphased)


def compute_curves(system: TorsionalSystem, rpm: Real) -> Curves:
    """Return torques, swings and the heat of dampers at speeds (speeds,), rpm.

    Raises:
        BalcliError: Nothing excites the system, or an undamped mode is driven at its own frequency.
    """
    parts = list(compute_in_parts(system, rpm))
    return Curves(
        orders=parts[0].orders,
        phasors=np.concatenate([part.phasors for part in parts], axis=1),
        heat=np.concatenate([part.heat for part in parts]),
        unphased=np.concatenate([part.unphased for part in parts], axis=1),
    )


# ------------------------------------------------------------------ limits of the computation
def refuse_unbounded(system: TorsionalSystem, rpm: Real) -> None:
    """Check that the vibration over a range of speeds (rpm) is bounded and fits into memory.

    Raises:
        BalcliError: There are too many torques by order, shaft and speed, or an undamped mode is
            driven at its own frequency.
    """
    excitation = system.require_excitation()
    count = len(excitation.orders) * len(rpm) * len(system.shafts)
    if count > MOST_TORSION_TORQUES:
        text = f"{count} torques (orders x speeds x shafts), but at most {MOST_TORSION_TORQUES}"
        raise BalcliError(f"{text} can be kept: take fewer speeds or orders")
    lossy = (system.damping.loss > 0) | (system.damping.dashpots > 0)
    if np.all(lossy | np.isinf(system.chain.stiffness)):  # every elastic shaft has losses
        return
    modes = find_chain_modes(system.chain)
    loss = chain_loss(system.chain, system.damping, modes, system.attached_rings(modes.omega))
    free = modes.omega[(modes.omega > 0) & (loss <= UNDAMPED)]
    none = Damping(*(np.zeros_like(each) for each in system.damping))
    for order in system.every_order.tolist():
        if system.pendulums:  # their inertia, and so the modes, depend on the order
            poles = find_poles(system, order)
            free = poles.imag[(poles.imag > 0) & (-2 * poles.real <= UNDAMPED * np.abs(poles))]
        met = free / (RPM * order)
        met = met[(met >= rpm[0] * (1 - _EDGE)) & (met <= rpm[-1] * (1 + _EDGE))]
        if not len(met):
            continue
        undamped = replace(system, damping=none, rings=())
        for own in (excitation, *system.unphased):
            alone = own.only(np.array([order]))
            if len(alone.orders):
                _move(undamped, alone, met)  # raises if the order drives the mode

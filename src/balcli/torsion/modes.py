"""Natural modes of a torsional system by their numbers, where their nodes lie, and which orders
meet them at which speed.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.speeds import RPM
from ..core.torsional_chain import Chain, Damping, find_still
from ..core.torsional_modes import chain_loss, count_nodes, find_chain_modes, find_chain_poles
from ..core.vibration import Complex, Real, scale_shapes
from .system import Excitation, TorsionalSystem, ViscousRing

_UNDRIVEN = 1e-10  # work up to this share of what all torques could do together is rounding


class NaturalMode(NamedTuple):
    """An elastic mode.

    Attributes:
        number: from 1.
        omega: rad/s.
        shape: (nodes,) angle of each node by itself, the largest +1.
        nodes: how many shafts have ends that move oppositely.
        still: their names: there lie the nodes.
        at_rest: names of the nodes of the chain that are nodes of the mode themselves.
        loss: loss factor, dampers and shafts together.
    """

    number: int
    omega: float
    shape: Real
    nodes: int
    still: tuple[str, ...]
    at_rest: tuple[str, ...]
    loss: float

    @property
    def frequency_hz(self) -> float:
        """Natural frequency in Hz."""
        return self.omega / (2 * np.pi)


class Critical(NamedTuple):
    """A speed at which an order meets a mode.

    Attributes:
        mode: its number.
        order: of the reference.
        speed_rpm: `60 f/n`.
        phase_sum: sum over cylinders of the mode's angle there, each with the phase of its torque
            and in parts of the largest torque.
        work: of all torques in one cycle of vibration by 1 rad where the shape is 1, J.
        work_share: of all work at this mode's criticals.
    """

    mode: int
    order: float
    speed_rpm: float
    phase_sum: float
    work: float
    work_share: float


def find_natural_modes(system: TorsionalSystem) -> tuple[NaturalMode, ...]:
    """The elastic modes, lowest first."""
    modes = find_chain_modes(system.chain)
    loss = chain_loss(system.chain, system.damping, modes, system.attached(modes.omega))
    elastic = slice(modes.rigid, None)
    shapes = scale_shapes(modes.shapes[elastic])
    figures = zip(modes.omega[elastic].tolist(), shapes, loss[elastic].tolist(), strict=True)
    return tuple(
        NaturalMode(
            number,
            omega,
            shape,
            count_nodes(system.chain, shape),
            find_still_shafts(system, shape),
            find_nodes_at_rest(system, shape),
            lost,
        )
        for number, (omega, shape, lost) in enumerate(figures, 1)
    )


def find_poles(system: TorsionalSystem, order: float | None = None) -> Complex:
    """Poles (poles,) of the damped system, rad/s, as of `find_chain_poles`: rings in oil are nodes
    of their own, and pendulums have the inertia of an order; without it they are left out.
    """
    chain, damping = system.chain, system.damping
    if order is not None:
        hanging = system.attached_pendulums(np.array(order)).real
        chain = chain._replace(inertia=chain.inertia + hanging)
    return find_chain_poles(*_hang_rings(chain, damping, system.rings))


def _hang_rings(
    chain: Chain, damping: Damping, rings: tuple[ViscousRing, ...]
) -> tuple[Chain, Damping]:
    """A chain with rings in oil as nodes, each on a shaft that is a dashpot alone."""
    count, none = len(chain.inertia), np.zeros(len(rings))
    on = np.array([ring.node for ring in rings], np.intp)
    hung = Chain(
        np.append(chain.inertia, [ring.inertia for ring in rings]),
        np.append(chain.start, on),
        np.append(chain.end, count + np.arange(len(rings))),
        np.append(chain.ratio, np.ones(len(rings))),
        np.append(chain.stiffness, none),
        np.append(chain.clamped, none.astype(bool)),
    )
    oil = np.append(damping.dashpots, [ring.damping for ring in rings])
    return hung, Damping(np.append(damping.loss, none), oil, np.append(damping.nodes, none))


def find_still_shafts(system: TorsionalSystem, shape: Real) -> tuple[str, ...]:
    """Names of the shafts whose ends move oppositely in a mode (nodes,)."""
    chain = system.chain
    moved = shape[chain.end] * shape[chain.start] * np.sign(chain.ratio)
    moves = _mark_moving(shape)
    still = (moved < 0) & moves[chain.end] & moves[chain.start] & np.isfinite(chain.stiffness)
    return tuple(system.shafts[k] for k in np.flatnonzero(still))


def find_nodes_at_rest(system: TorsionalSystem, shape: Real) -> tuple[str, ...]:
    """Names of the nodes at rest in a mode (nodes,) between others that turn against each other."""
    chain, moves = system.chain, _mark_moving(shape)
    pulled = np.zeros((2, len(shape)), bool)  # one way and the other
    for here, there in ((chain.start, chain.end), (chain.end, chain.start)):
        ahead = shape[there] * chain.ratio > 0
        for way, shafts in enumerate((ahead, ~ahead)):
            pulled[way, here[shafts & moves[there]]] = True
    at_rest = pulled.all(axis=0) & ~moves & ~find_still(chain)
    return tuple(system.nodes[k] for k in np.flatnonzero(at_rest))


def _mark_moving(shape: Real) -> NDArray[np.bool_]:
    """Which nodes move in a mode, more than by rounding."""
    return np.asarray(np.abs(shape) > 1e-9 * np.abs(shape).max())


def find_criticals(
    excitation: Excitation, modes: tuple[NaturalMode, ...], range_rpm: tuple[float, float] | None
) -> tuple[Critical, ...]:
    """Criticals, in a range of speeds if there is one, those that do most work first."""
    found = [critical for mode in modes for critical in _meet(excitation, mode, range_rpm)]
    return tuple(sorted(found, key=lambda each: -each.work))


def _meet(
    excitation: Excitation, mode: NaturalMode, range_rpm: tuple[float, float] | None
) -> list[Critical]:
    """Criticals of one mode."""
    orders = excitation.orders
    speeds = mode.omega / orders
    torque = np.diagonal(excitation.at(speeds), axis1=0, axis2=1).T  # (orders, sources)
    moved = mode.shape[excitation.nodes]
    largest = np.abs(torque).max(axis=1)
    phasors = np.abs(torque @ moved)
    rpm = speeds / RPM
    low, high = range_rpm or (0.0, np.inf)
    inside = (rpm >= low * (1 - 1e-12)) & (rpm <= high * (1 + 1e-12))
    counted = inside & (phasors > _UNDRIVEN * (np.abs(torque) @ np.abs(moved)))
    work = np.where(counted, np.pi * phasors, 0)
    total = work.sum()
    return [
        Critical(
            mode.number,
            float(orders[k]),
            float(rpm[k]),
            float(phasors[k] / largest[k]),
            float(work[k]),
            float(work[k] / total),
        )
        for k in np.flatnonzero(counted)
    ]

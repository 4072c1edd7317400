"""Natural modes of a torsional system, where their nodes lie, and which orders meet them at which
speed.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from ..core.speeds import RPM
from ..core.torsional_chain import Chain, Damping
from ..core.torsional_modes import chain_loss, find_chain_modes, find_chain_poles, locate_nodes
from ..core.vibration import Complex, Real, scale_shapes
from ..documents.records import HIDDEN
from .system import Excitation, TorsionalSystem, whole_order

_UNDRIVEN = 1e-10  # work up to this share of what all torques could do together is rounding


@dataclass(frozen=True, eq=False, kw_only=True)
class NaturalMode:
    """Natural mode in which shafts twist.

    Attributes:
        frequency_Hz: Natural frequency.
        shape: Angle of each node by itself, relative to the largest.
        nodes: Number of places that do not move.
        node_in: Names of the shafts with such a place, because their ends turn against each other.
        node_at: Names of the nodes of the chain that do not move between others that do.
        loss: Loss factor of dampers and shafts together.
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


@dataclass(frozen=True, kw_only=True)
class Critical:
    """Speed at which an order excites a mode.

    Attributes:
        mode: Number of the mode, from 1.
        order: Order of the excitation.
        speed_rpm: Critical speed.
        phase_sum: Vector sum over the cylinders of the mode's angle at each, with the phase of its
            torque, relative to the largest torque.
        work_share: Share of all work that is done on the mode at its critical speeds.
        work: Work of all torques in one cycle of vibration by 1 rad where the shape is 1, J.
    """

    mode: int
    order: float
    speed_rpm: float
    phase_sum: float
    work_share: float
    work: Annotated[float, HIDDEN]


def find_natural_modes(system: TorsionalSystem) -> tuple[NaturalMode, ...]:
    """Return the modes in which shafts twist, lowest first."""
    modes = find_chain_modes(system.chain)
    loss = chain_loss(system.chain, system.damping, modes, system.attached(modes.omega))
    found = []
    for k, shape in enumerate(scale_shapes(modes.shapes)[modes.rigid :], modes.rigid):
        in_shafts, at_nodes = locate_nodes(system.chain, shape)
        mode = NaturalMode(
            frequency_Hz=float(modes.omega[k]) / (2 * np.pi),
            shape=shape,
            nodes=len(in_shafts) + len(at_nodes),
            node_in=tuple(system.shafts[each] for each in in_shafts),
            node_at=tuple(system.nodes[each] for each in at_nodes),
            loss=float(loss[k]),
            number=k - modes.rigid + 1,
        )
        found.append(mode)
    return tuple(found)


def find_poles(system: TorsionalSystem, order: float | None = None) -> Complex:
    """Return the poles (poles,) of the damped system, rad/s, as of `find_chain_poles`.

    Args:
        system: Its rings in oil become nodes, each on a shaft that is a dashpot alone.
        order: Order at which pendulums have their inertia; None: they are left out.
    """
    chain, damping, rings = system.chain, system.damping, system.rings
    inertia = chain.inertia
    if order is not None:
        inertia = inertia + system.attached_pendulums(np.array(order)).real
    none, on = np.zeros(len(rings)), [ring.node for ring in rings]
    with_rings = Chain(
        np.append(inertia, [ring.inertia for ring in rings]),
        np.append(chain.start, np.array(on, np.intp)),
        np.append(chain.end, len(inertia) + np.arange(len(rings))),
        np.append(chain.ratio, none + 1),
        np.append(chain.stiffness, none),
        np.append(chain.clamped, none.astype(bool)),
    )
    oil = np.append(damping.dashpots, [ring.damping for ring in rings])
    losses = Damping(np.append(damping.loss, none), oil, np.append(damping.nodes, none))
    return find_chain_poles(with_rings, losses)


def find_criticals(
    excitation: Excitation,
    modes: tuple[NaturalMode, ...],
    range_rpm: tuple[float, float] | None = None,
) -> tuple[Critical, ...]:
    """Return the critical speeds, in a range (rpm) if there is one, most work first."""
    orders, (low, high) = excitation.orders, range_rpm or (0.0, np.inf)
    found = []
    for mode in modes:
        speeds = mode.omega / orders
        torque = np.diagonal(excitation.at(speeds), axis1=0, axis2=1).T  # (orders, sources)
        moved, rpm = mode.shape[excitation.nodes], speeds / RPM
        phasors = np.abs(torque @ moved)
        counted = (rpm >= low * (1 - 1e-12)) & (rpm <= high * (1 + 1e-12))
        counted &= phasors > _UNDRIVEN * (np.abs(torque) @ np.abs(moved))
        total = phasors[counted].sum()
        found += [
            Critical(
                mode=mode.number,
                order=whole_order(float(orders[k])),
                speed_rpm=float(rpm[k]),
                phase_sum=float(phasors[k] / np.abs(torque[k]).max()),
                work_share=float(phasors[k] / total),
                work=float(np.pi * phasors[k]),
            )
            for k in np.flatnonzero(counted)
        ]
    return tuple(sorted(found, key=lambda each: -each.work))

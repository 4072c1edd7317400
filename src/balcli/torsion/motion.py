"""Steady vibration of a torsional system at any speeds, order by order."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..core.speeds import RPM
from ..core.torsional_modes import chain_loss, find_chain_modes
from ..core.torsional_response import respond_chain
from ..core.vibration import (
    UNDAMPED,
    Complex,
    Real,
    UndampedResonanceError,
    find_resonances,
    frequencies,
)
from ..errors import BalcliError
from ..limits import MOST_TORSION_TORQUES
from .modes import find_poles
from .system import TorsionalSystem

_AT_A_TIME = 1 << 20  # samples of a cycle, or torques by order, of all shafts and speeds


class ChainMotion(NamedTuple):
    """Angles (orders, speeds, nodes) and torques (orders, speeds, shafts) by order, complex, those
    of pendulums against their nodes (orders, speeds, pendulums), and power lost in dampers (orders,
    speeds, dampers).
    """

    angle: Complex
    torque: Complex
    pendulums: Complex
    heat: Real

    @property
    def curves(self) -> Complex:
        """What swings, by order (orders, speeds, curves): torques of all shafts, angle of the first
        node, angles of pendulums.
        """
        return np.concatenate([self.torque, self.angle[:, :, :1], self.pendulums], axis=-1)


def move(system: TorsionalSystem, rpm: Real) -> ChainMotion:
    """Motion order by order at these speeds (rpm)."""
    excitation, speeds = system.require_excitation(), rpm * RPM
    w = frequencies(excitation.orders, speeds)
    load = excitation.on_nodes(speeds, len(system.nodes))
    order = np.broadcast_to(excitation.orders[:, None], w.shape)
    attached = system.attached(w, order) if system.rings or system.pendulums else 0.0
    try:
        twist = respond_chain(system.chain, system.damping, w, load, attached)
    except UndampedResonanceError as error:
        row, _ = np.unravel_index(np.abs(w - error.frequency).argmin(), w.shape)
        met = float(excitation.orders[row])
        raise _refuse_resonance(system, error.frequency, met) from None
    heat = _heat_of_oil(system, w, twist.angle), _heat_of_rubber(system, w, twist.torque)
    swings = system.swing_pendulums(excitation.orders, twist.angle)
    return ChainMotion(twist.angle, twist.torque, swings, np.concatenate(heat, axis=-1))


def _heat_of_rubber(system: TorsionalSystem, w: Real, torque: Complex) -> Real:
    """Power (orders, speeds, rings) that rubber turns to heat: `w loss |T|^2/(2 k (1 + loss^2))`;
    its shafts are the last ones.
    """
    first = len(system.shafts) - (len(system.nodes) - 1 - system.last)
    loss, stiffness = system.damping.loss[first:], system.chain.stiffness[first:]
    softness = loss / (stiffness * (1 + loss**2))
    return np.asarray(w[..., None] / 2 * softness * np.abs(torque[..., first:]) ** 2)


def _heat_of_oil(system: TorsionalSystem, w: Real, angle: Complex) -> Real:
    """Power (orders, speeds, rings) that rings in oil turn to heat: `-w^3 Im J |x|^2/2`."""
    found = np.zeros((*w.shape, len(system.rings)))
    for k, ring in enumerate(system.rings):
        slip = w * (ring.inertia / ring.damping)
        lagging = ring.inertia * slip / (1 + slip**2)
        found[..., k] = w**3 * lagging * np.abs(angle[..., ring.node]) ** 2 / 2
    return found


def stress_by_torque(system: TorsionalSystem) -> Real:
    """(shafts,) Pa for 1 N m; nan where there is no diameter."""
    found = [np.nan if s is None else s.stress_by_torque for s in system.sections]
    return np.array(found)


def refuse_torsional_resonance(system: TorsionalSystem, rpm: Real) -> None:
    """Refuse a range in which an undamped mode is driven at its own frequency."""
    lossy = (system.damping.loss > 0) | (system.damping.dashpots > 0)
    if np.all(lossy | np.isinf(system.chain.stiffness)):  # whatever twists, loses
        return
    if system.pendulums:  # their inertia differs from order to order, and so do the modes
        _drive_undamped(system, rpm)
        return
    modes = find_chain_modes(system.chain)
    loss = chain_loss(system.chain, system.damping, modes, system.attached(modes.omega))
    excitation, speeds = system.require_excitation(), rpm * RPM
    load = excitation.on_nodes(speeds, len(system.nodes))
    met = find_resonances(modes, loss, excitation.orders, speeds, load)
    if met:
        raise _refuse_resonance(system, float(modes.omega[met[0].mode]), met[0].order)


def _drive_undamped(system: TorsionalSystem, rpm: Real) -> None:
    """Vibration at every speed of a range at which an order meets an undamped resonance: there is
    one only where it drives nothing.
    """
    excitation = system.require_excitation()
    for order in excitation.orders:
        poles = find_poles(system, float(order))
        free = poles[(poles.imag > 0) & (-2 * poles.real <= UNDAMPED * np.abs(poles))]
        met = free.imag / (RPM * order)
        met = met[(met >= rpm[0]) & (met <= rpm[-1])]
        if len(met):
            move(replace(system, excitation=excitation.only(order)), met)


def _refuse_resonance(system: TorsionalSystem, omega: float, order: float) -> BalcliError:
    return system.refusal(
        f"the natural frequency of {omega / (2 * np.pi):.6g} Hz is excited by order {order:g} at "
        f"{omega / (RPM * order):.6g} rpm and nothing damps it: its vibration has no bound; give a "
        "loss factor (loss = 0.02), or damping"
    )


def refuse_too_many(system: TorsionalSystem, speeds: int) -> None:
    """Refuse more torques by order, shaft and speed than memory is meant for."""
    orders, shafts = len(system.require_excitation().orders), len(system.shafts)
    if orders * speeds * shafts > MOST_TORSION_TORQUES:
        raise BalcliError(
            f"{orders} orders at {speeds} speeds in {shafts} shafts are {orders * speeds * shafts} "
            f"torques, and at most {MOST_TORSION_TORQUES} are kept: take fewer speeds or orders"
        )


def split_speeds(system: TorsionalSystem, speeds: Real, samples: float = 1) -> Iterator[slice]:
    """Pieces of the range that keep memory small; `samples`: of a cycle, taken of every curve."""
    work = len(system.require_excitation().orders) * (len(system.nodes) + len(system.shafts))
    size = max(int(_AT_A_TIME / max(samples * (len(system.shafts) + 1), work)), 1)
    for start in range(0, len(speeds), size):
        yield slice(start, min(start + size, len(speeds)))

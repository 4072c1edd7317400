"""Steady vibration of a torsional system at any speeds, order by order."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..core.speeds import RPM
from ..core.torsional_chain import Damping
from ..core.torsional_modes import chain_loss, find_chain_modes
from ..core.torsional_response import respond_chain
from ..core.vibration import (
    UNDAMPED,
    Complex,
    Real,
    UndampedResonanceError,
    frequencies,
)
from ..errors import BalcliError
from ..limits import MOST_TORSION_TORQUES
from .modes import find_poles
from .system import TorsionalSystem

_EDGE = 1e-10  # share of a speed by which a resonance may lie beyond the range
_AT_A_TIME = 1 << 20  # angles and torques by order, at all speeds, which bounds the memory


class ChainMotion(NamedTuple):
    """Steady vibration by order, complex.

    Attributes:
        angle: (orders, speeds, nodes) rad.
        torque: (orders, speeds, shafts) N m.
        pendulums: (orders, speeds, pendulums) angles against their nodes, rad.
        heat: (orders, speeds, dampers) power lost in dampers, W; rings in oil first, then rubber.
    """

    angle: Complex
    torque: Complex
    pendulums: Complex
    heat: Real


def move(system: TorsionalSystem, rpm: Real) -> ChainMotion:
    """Return the vibration at speeds (speeds,), rpm.

    Raises:
        BalcliError: nothing excites the system; an undamped mode is driven at its own frequency.
    """
    excitation, speeds = system.require_excitation(), rpm * RPM
    w = frequencies(excitation.orders, speeds)
    load = excitation.on_nodes(speeds, len(system.nodes))
    attached: Complex | float = 0.0
    if system.rings or system.pendulums:
        attached = system.attached(w, np.broadcast_to(excitation.orders[:, None], w.shape))
    try:
        twist = respond_chain(system.chain, system.damping, w, load, attached)
    except UndampedResonanceError as error:
        row, _ = np.unravel_index(np.abs(w - error.frequency).argmin(), w.shape)
        met = float(excitation.orders[row])
        raise _refuse_resonance(system, error.frequency, met) from None
    swings = system.swing_pendulums(excitation.orders, twist.angle)
    return ChainMotion(*twist, swings, _find_heat(system, w, *twist))


def _find_heat(system: TorsionalSystem, w: Real, angle: Complex, torque: Complex) -> Real:
    """Return the power (orders, speeds, dampers) that dampers turn to heat, W: rings in oil
    `-w^3 Im J |x|^2/2`, rubber, which is the last of the shafts, `w loss |T|^2/(2 k (1 + loss^2))`.
    """
    inertia, damping = (np.array([ring[k] for ring in system.rings], float) for k in (1, 2))
    slip = w[..., None] * (inertia / damping)
    lagging = inertia * slip / (1 + slip**2)
    oil = (
        w[..., None] ** 3 * lagging * np.abs(angle[..., [ring.node for ring in system.rings]]) ** 2
    )
    first = len(system.shafts) - (len(system.nodes) - 1 - system.last)
    loss, stiffness = system.damping.loss[first:], system.chain.stiffness[first:]
    softness = loss / (stiffness * (1 + loss**2))
    rubber = w[..., None] * softness * np.abs(torque[..., first:]) ** 2
    return np.concatenate([oil, rubber], axis=-1) / 2


def compute_curves(system: TorsionalSystem, rpm: Real) -> tuple[Complex, Real]:
    """Return what swings, and the heat of dampers, at speeds (speeds,), rpm.

    Returns:
        Phasors (orders, speeds, curves) of torques of all shafts (N m), the angle of the first node
        and those of pendulums (rad), and heat (speeds, dampers), W.
    """
    work = len(system.require_excitation().orders) * (len(system.nodes) + len(system.shafts))
    size = max(_AT_A_TIME // max(work, 1), 1)
    curves, heat = [], []
    for start in range(0, max(len(rpm), 1), size):
        motion = move(system, rpm[start : start + size])
        parts = motion.torque, motion.angle[:, :, :1], motion.pendulums
        curves.append(np.concatenate(parts, axis=-1))
        heat.append(motion.heat.sum(axis=0))
    return np.concatenate(curves, axis=1), np.concatenate(heat)


def stress_by_torque(system: TorsionalSystem) -> Real:
    """Return the stress (shafts,) for 1 N m, Pa; nan where there is no diameter."""
    return np.array([np.nan if s is None else s.stress_by_torque for s in system.sections])


# ------------------------------------------------------------------ what cannot be computed
def refuse_unbounded(system: TorsionalSystem, rpm: Real) -> None:
    """Refuse a range of speeds (rpm) that is beyond computing.

    Raises:
        BalcliError: more torques by order, shaft and speed than memory is meant for; an undamped
            mode that is driven at its own frequency.
    """
    excitation = system.require_excitation()
    orders, shafts = len(excitation.orders), len(system.shafts)
    if orders * len(rpm) * shafts > MOST_TORSION_TORQUES:
        raise BalcliError(
            f"{orders} orders at {len(rpm)} speeds in {shafts} shafts are "
            f"{orders * len(rpm) * shafts} torques, and at most {MOST_TORSION_TORQUES} are kept: "
            "take fewer speeds or orders"
        )
    lossy = (system.damping.loss > 0) | (system.damping.dashpots > 0)
    if np.all(lossy | np.isinf(system.chain.stiffness)):  # whatever twists, loses
        return
    modes = find_chain_modes(system.chain)
    loss = chain_loss(system.chain, system.damping, modes, system.attached(modes.omega))
    free = modes.omega[(modes.omega > 0) & (loss <= UNDAMPED)]
    none = Damping(*(np.zeros_like(each) for each in system.damping))
    for order in excitation.orders.tolist():
        if system.pendulums:  # their inertia differs from order to order, and so do the modes
            poles = find_poles(system, order)
            free = poles.imag[(poles.imag > 0) & (-2 * poles.real <= UNDAMPED * np.abs(poles))]
        met = free / (RPM * order)
        met = met[(met >= rpm[0] * (1 - _EDGE)) & (met <= rpm[-1] * (1 + _EDGE))]
        if len(met):  # raises where the order drives the mode
            alone = excitation.only(np.array([order]))
            move(replace(system, damping=none, rings=(), excitation=alone), met)


def _refuse_resonance(system: TorsionalSystem, omega: float, order: float) -> BalcliError:
    return system.refusal(
        f"the natural frequency of {omega / (2 * np.pi):.6g} Hz is excited by order {order:g} at "
        f"{omega / (RPM * order):.6g} rpm and nothing damps it: its vibration has no bound; give a "
        "loss factor (loss = 0.02), or damping"
    )

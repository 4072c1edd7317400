"""A body on its mounts by itself: its equations of motion and natural modes."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..core.rigid_body import (
    Settled,
    damping_matrix,
    find_body_modes,
    mass_matrix,
    settle_body,
    share_energy,
    stiffness_matrix,
)
from ..core.vibration import Complex, Modes, Real, modal_loss
from .build import MountedBody
from .motions import name_mode, name_motions


class BodyModes(NamedTuple):
    """Equations `(K + i w C - w^2 M) q = f` about the center of gravity, and their natural modes.

    Attributes:
        stiffness, damping, mass: K (dynamic), C and M, SI, shape (6, 6).
        modes: Modes without damping, lowest first.
        loss: Loss factor of each mode, shape (6,).
        shares: Share of the kinetic energy of each mode in each motion, shape (modes, 6).
        motions: Each mode in words.
    """

    stiffness: Complex
    damping: Real
    mass: Real
    modes: Modes
    loss: Real
    shares: Real
    motions: tuple[str, ...]

    @property
    def hertz(self) -> Real:
        """Natural frequencies, Hz, shape (6,)."""
        return self.modes.omega / (2 * np.pi)


def find_mounted_modes(mounted: MountedBody) -> BodyModes:
    """Return the equations of motion and the natural modes of a body on its mounts."""
    body, mounts = mounted.body, mounted.dynamic
    modes, names = find_body_modes(body, mounts), name_motions(-mounted.weight)
    stiffness, damping = stiffness_matrix(body, mounts), damping_matrix(body, mounts)
    shares = share_energy(modes, body)
    motions = tuple(name_mode(share, names) for share in shares)
    loss = modal_loss(modes, stiffness, damping)
    return BodyModes(stiffness, damping, mass_matrix(body), modes, loss, shares, motions)


def settle(mounted: MountedBody, torque: float = 0.0) -> Settled:
    """Return the body at rest under its weight, with static stiffness.

    Args:
        torque: Mean torque about the crankshaft's axis on the body, N m; it has no effect where the
            body carries the load, for then it acts between parts of the body.
    """
    leaning = 0.0 if mounted.carries_load else torque
    load = np.concatenate([mounted.weight, [0.0, 0.0, leaning]])
    return settle_body(mounted.body, mounted.static, load)

"""A body on its mounts by itself: natural modes, torque roll axis, elastic centre, rest."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..core.rigid_body import (
    ElasticCentre,
    Settled,
    damping_matrix,
    elastic_centre,
    find_body_modes,
    roll_axis,
    settle_body,
    share_energy,
    stiffness_matrix,
)
from ..core.vibration import Modes, Real, modal_loss
from ..engine.arrays import find_first_largest
from .build import MountedBody
from .motions import name_mode, name_motions


class BodyMode(NamedTuple):
    """One natural mode.

    Attributes:
        omega: rad/s, undamped.
        shares: (6,) of its kinetic energy in each motion; their sum is 1.
        shape: (6,) of the centre of gravity, m and rad, of unit modal mass.
        motion: what it is, in words.
        loss: factor by which it is damped; alone at resonance it is magnified by the inverse.
    """

    omega: float
    shares: Real
    shape: Real
    motion: str
    loss: float

    @property
    def hertz(self) -> float:
        """Its frequency."""
        return self.omega / (2 * np.pi)


@dataclass(frozen=True, eq=False)
class BodyModes:
    """What a body on its mounts is without an engine that runs.

    Attributes:
        six: the modes, lowest first.
        modes: the same, for computing.
        loss: (6,) of each mode.
        roll_axis: (3,) unit vector through the centre of gravity, about which a torque about the
            crankshaft turns the body where nothing holds it.
        centre: where forces move the body with the least turning.
        settled: at rest under its weight and a mean torque.
        stiffness: (6, 6) about the centre of gravity, dynamic, N/m, N, N m.
    """

    six: tuple[BodyMode, ...]
    modes: Modes
    loss: Real
    roll_axis: Real
    centre: ElasticCentre
    settled: Settled
    stiffness: Real


def find_mounted_modes(mounted: MountedBody, torque: float = 0.0) -> BodyModes:
    """Modes with dynamic stiffness, and the rest with static stiffness.

    Args:
        torque: N m, mean, about the crankshaft's axis on the body; it does not count where the body
            carries the load, too: there it acts between parts of the body.
    """
    body, mounts = mounted.body, mounted.dynamic
    modes = find_body_modes(body, mounts)
    complex_stiffness = stiffness_matrix(body, mounts)
    loss = modal_loss(modes, complex_stiffness, damping_matrix(body, mounts))
    motions = name_motions(mounted.up)
    shares = share_energy(modes, body)
    six = tuple(
        BodyMode(
            float(modes.omega[k]),
            shares[k],
            _point_forward(modes.shapes[k], shares[k]),
            name_mode(shares[k], motions),
            float(loss[k]),
        )
        for k in range(len(modes.omega))
    )
    leaning = 0.0 if mounted.carries_load else torque
    load = np.concatenate([mounted.weight, [0.0, 0.0, leaning]])
    return BodyModes(
        six,
        modes,
        loss,
        roll_axis(body),
        elastic_centre(complex_stiffness.real, body.centre),
        settle_body(body, mounted.static, load),
        complex_stiffness.real,
    )


def _point_forward(shape: Real, shares: Real) -> Real:
    """The shape, its motion with the largest share of the energy positive, of equals the first."""
    return shape * np.copysign(1.0, shape[find_first_largest(shares)])

"""Forced vibration of a rigid body on its mounts, put together from the functions of `core`."""

from typing import NamedTuple

import numpy as np

from balcli.core.vibration import solve_response
from balcli.mounts.rigid_body import couple_mounts, damping_matrix, mass_matrix, stiffness_matrix


def apply_couplings(couplings, motion) -> np.ndarray:
    """Return the vectors (..., places, 3) of couplings (places, 3, 6) and a motion (..., 6)."""
    found = motion @ couplings.reshape(-1, 6).T
    return found.reshape(*motion.shape[:-1], -1, 3)


class BodyResponse(NamedTuple):
    """Motion (*frequency, 6) of the centre of gravity, and forces (*frequency, mounts, 3) on the mounts."""

    motion: np.ndarray
    forces: np.ndarray


def respond_body(body, mounts, frequency, load) -> BodyResponse:
    """Steady vibration under harmonic loads (*frequency, 6) at frequencies in rad/s."""
    w = np.asarray(frequency, float)
    stiffness, damping = stiffness_matrix(body, mounts), damping_matrix(body, mounts)
    motion = solve_response(stiffness, damping, mass_matrix(body), w, load)
    return BodyResponse(motion, press_mounts(body, mounts, w, motion))


def press_mounts(body, mounts, frequency, motion) -> np.ndarray:
    w, (springs, dashpots) = np.asarray(frequency, float), couple_mounts(body, mounts)
    return apply_couplings(springs, motion) + 1j * w[..., None, None] * apply_couplings(dashpots, motion)

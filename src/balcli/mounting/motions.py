"""Motions of a rigid body in words."""

from __future__ import annotations

import numpy as np

from ..core.rigid_body import find_screw
from ..core.vibration import Real
from ..enginefile.exclusive import join_words

AXES = ("x", "y", "z", "rx", "ry", "rz")
ROLL = AXES.index("rz")  # the turn about the crankshaft's axis
_ALONE = 0.8  # share of the energy with which a motion counts as one alone
_PART = 0.15  # share with which it is named beside another
_STEEP = 0.8  # cosine: an axis farther from the vertical is not up and down
_EXACT = 1e-9  # of a direction: what is less is rounding


def name_motions(up: Real) -> tuple[str, ...]:
    """Return the names of the motions along x, y, z and about them.

    Turns about z, the crankshaft's axis, are always roll. Where no axis is near the vertical, none
    is up and down.

    Args:
        up: Vector against the weight, shape (3,).
    """
    upright = int(np.argmax(np.abs(up)))
    steep = abs(up[upright]) >= _STEEP * np.linalg.norm(up)
    if upright == 2 or not steep:
        along = "up and down" if steep else "along z"
        return "along x", "along y", along, "turn about x", "turn about y", "roll"
    names = ["sideways", "sideways", "lengthways", "pitch", "pitch", "roll"]
    names[upright], names[3 + upright] = "up and down", "yaw"
    return tuple(names)


def name_mode(shares: Real, names: tuple[str, ...]) -> str:
    """Return a mode in words, by its largest motions, at most three.

    Args:
        shares: Shares of the energy, shape (6,).
        names: As of `name_motions`.
    """
    falling = np.argsort(-shares, kind="stable")
    if shares[falling[0]] >= _ALONE:
        return names[falling[0]]
    return join_words([names[k] for k in falling[:3] if shares[k] >= _PART])


def describe_free_motion(motion: Real, centre: Real) -> str:
    """Return a motion (6,) that nothing holds in words: a displacement, or a turn about a line."""
    screw = find_screw(motion, centre)
    direction = np.where(np.abs(screw.direction) < _EXACT, 0.0, screw.direction)
    along = "({:.3g}, {:.3g}, {:.3g})".format(*direction)
    if np.count_nonzero(direction) == 1:
        along = AXES[int(np.argmax(np.abs(direction)))]
    if screw.point is None:
        return f"moving along {along}"
    x, y, z = 1e3 * np.where(np.abs(screw.point) < _EXACT, 0.0, screw.point)
    return f"turning about {along} through ({x:.4g}, {y:.4g}, {z:.4g}) mm"

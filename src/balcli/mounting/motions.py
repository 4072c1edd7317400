"""Motions of a rigid body in words."""

from __future__ import annotations

import numpy as np

from ..core.rigid_body import find_screw
from ..core.vibration import Real

AXES = ("x", "y", "z", "rx", "ry", "rz")
ROLL = AXES.index("rz")  # the turn about the crankshaft's axis
_ALONG = ("x", "y", "z")
_ALONE = 0.8  # share of the energy with which a motion counts as one alone
_PART = 0.15  # share with which it is named beside another
_STEEP = 0.8  # cosine: an axis farther from the vertical is not up and down
_EXACT = 1e-9  # of a direction: what is less is rounding


def name_motions(up: Real) -> tuple[str, ...]:
    """What x, y, z and the turns about them are called where the body stands with `up` upwards.

    Turns about z, the crankshaft's axis, are always its roll. Where no axis is near the vertical,
    none is up and down.
    """
    upright = int(np.argmax(np.abs(up)))
    steep = abs(float(up[upright])) >= _STEEP
    if upright == 2 or not steep:
        along = "up and down" if steep else "along z"
        return "along x", "along y", along, "turn about x", "turn about y", "roll"
    names = ["sideways", "sideways", "lengthways", "pitch", "pitch", "roll"]
    names[upright], names[3 + upright] = "up and down", "yaw"
    return tuple(names)


def name_mode(shares: Real, names: tuple[str, ...]) -> str:
    """What a mode of these shares (6,) of the energy is: its largest motions, at most three."""
    falling = np.argsort(-shares, kind="stable")
    if shares[falling[0]] >= _ALONE:
        return names[falling[0]]
    told = [names[k] for k in falling[:3] if shares[k] >= _PART]
    *front, last = told
    return f"{', '.join(front)} and {last}" if front else last


def describe_free_motion(motion: Real, centre: Real) -> str:
    """A motion (6,) that nothing holds: a displacement, or a turn about a line."""
    screw = find_screw(motion, centre)
    along = _describe_direction(screw.direction)
    if screw.point is None:
        return f"moving along {along}"
    x, y, z = 1e3 * np.where(np.abs(screw.point) < _EXACT, 0.0, screw.point)
    return f"turning about {along} through ({x:.4g}, {y:.4g}, {z:.4g}) mm"


def _describe_direction(direction: Real) -> str:
    """`x`, or its components."""
    for axis, name in enumerate(_ALONG):
        if abs(abs(direction[axis]) - 1) < _EXACT:
            return name
    return "({:.3g}, {:.3g}, {:.3g})".format(*np.where(np.abs(direction) < _EXACT, 0.0, direction))

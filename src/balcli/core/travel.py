"""Stroke and dead centres of every piston; those of articulated ones differ from the crank's throw and angle."""
from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .articulated import Articulated
from .harmonics import Array
from .inertia import Cylinders
from .linkage import revolution

_STEPS = 720


class Travel(NamedTuple):
    """One value a cylinder, shape (cylinders, *trailing)."""

    stroke: Array           # m
    top_deg: Array          # each cylinder's own crank angle (0: pin along the axis) at top dead centre
    bottom_deg: Array       # the same at the lower dead centre, less 180


def travel(c: Cylinders) -> Travel:
    """Strokes and dead centres: closed form for plain slider-cranks (`sin tau = e/(l + r)`, `e/(l - r)` below), found on the
    curve for articulated ones."""
    if isinstance(c.linkage, Articulated):
        return _articulated(c, c.linkage)
    top, bottom = c.eps / (1 + c.lam), c.eps / (1 - c.lam)
    reach = (1 + c.lam) * np.sqrt((1 - top) * (1 + top)) - (1 - c.lam) * np.sqrt((1 - bottom) * (1 + bottom))
    shape = np.broadcast_shapes(c.pin_deg.shape, reach.shape)
    found = c.radius / c.lam * reach, np.degrees(np.arcsin(top)), np.degrees(np.arcsin(bottom))
    return Travel(*(np.broadcast_to(a, shape) for a in found))


def _articulated(c: Cylinders, linkage: Articulated) -> Travel:
    psi = revolution(_STEPS)
    place = linkage.travel(psi, c.lam, c.eps)
    top = _refined(c, linkage, psi[place.argmax(axis=-1)])
    bottom = _refined(c, linkage, psi[place.argmin(axis=-1)])
    reach = [linkage.travel(at[..., None], c.lam, c.eps)[..., 0] for at in (top, bottom)]
    centred = np.remainder(np.degrees(top) + 180, 360) - 180
    return Travel(np.asarray(c.radius * (reach[0] - reach[1])), centred, np.remainder(np.degrees(bottom), 360) - 180)


def _refined(c: Cylinders, linkage: Articulated, psi: Array) -> Array:
    """Newton's method for the zeros of the piston's velocity beside these angles, one each cylinder."""
    for _ in range(6):
        motion = linkage.motion(psi[..., None], c.lam, c.eps)
        psi = psi - (motion.velocity / motion.acceleration)[..., 0]
    return psi

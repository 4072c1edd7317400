"""Stroke and dead centres of every piston; those of articulated ones differ from the crank's throw
and angle.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .cylinders import Cylinders
from .mechanisms.linkage import Linkage, revolution
from .phasors import Array

_STEPS = 720


class Travel(NamedTuple):
    """One value a cylinder, shape (cylinders, *trailing)."""

    stroke: Array  # m
    top_deg: Array  # each cylinder's own crank angle (0: pin along the axis) at top dead centre
    bottom_deg: Array  # the same at the lower dead centre, less 180


def find_travel(c: Cylinders) -> Travel:
    """Strokes and dead centres of all cylinders.

    They have a closed form for plain slider-cranks (`sin tau = e/(l + r)` at the top, `e/(l - r)`
    at the bottom), and are found on the curve of the motion for others.
    """
    found = _find_by_formula(c) if c.linkage is None else _find_on_curve(c, c.linkage)
    shape = c.pin_deg.shape
    each = (np.broadcast_to(v, np.broadcast_shapes(shape, v.shape)) for v in found)
    return Travel(*each)


def _find_by_formula(c: Cylinders) -> tuple[Array, Array, Array]:
    top, bottom = c.eps / (1 + c.lam), c.eps / (1 - c.lam)
    high = (1 + c.lam) * np.sqrt((1 - top) * (1 + top))
    low = (1 - c.lam) * np.sqrt((1 - bottom) * (1 + bottom))
    angles = np.degrees(np.arcsin(top)), np.degrees(np.arcsin(bottom))
    return c.radius / c.lam * (high - low), *angles


def _find_on_curve(c: Cylinders, linkage: Linkage) -> tuple[Array, Array, Array]:
    psi = revolution(_STEPS)
    place = linkage.sample(lambda motion: motion.place, psi, c.lam, c.eps)
    top = _refine(c, linkage, psi[place.argmax(axis=-1)])
    bottom = _refine(c, linkage, psi[place.argmin(axis=-1)])
    high, low = (linkage.motion(at[..., None], c.lam, c.eps).place[..., 0] for at in (top, bottom))
    centred = np.remainder(np.degrees(top) + 180, 360) - 180
    return c.radius * (high - low), centred, np.degrees(bottom) - 180


def _refine(c: Cylinders, linkage: Linkage, psi: Array) -> Array:
    """Newton's method for the zeros of the pistons' velocity beside these angles (rad)."""
    for _ in range(6):
        motion = linkage.motion(psi[..., None], c.lam, c.eps)
        psi = psi - (motion.velocity / motion.acceleration)[..., 0]
    return psi

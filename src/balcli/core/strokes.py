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


def travel(c: Cylinders) -> Travel:
    """Strokes and dead centres: in closed form for plain slider-cranks (`sin tau = e/(l + r)`,
    below `e/(l - r)`), found on the curve for others.
    """
    found = _plain(c) if c.linkage is None else _sampled(c, c.linkage)
    return Travel(
        *(
            np.broadcast_to(values, np.broadcast_shapes(c.pin_deg.shape, values.shape))
            for values in found
        )
    )


def _plain(c: Cylinders) -> tuple[Array, ...]:
    top, bottom = c.eps / (1 + c.lam), c.eps / (1 - c.lam)
    reach = (1 + c.lam) * np.sqrt((1 - top) * (1 + top)) - (1 - c.lam) * np.sqrt(
        (1 - bottom) * (1 + bottom)
    )
    return c.radius / c.lam * reach, np.degrees(np.arcsin(top)), np.degrees(np.arcsin(bottom))


def _sampled(c: Cylinders, linkage: Linkage) -> tuple[Array, ...]:
    psi = revolution(_STEPS)
    place = linkage.sample(lambda motion: motion.place, psi, c.lam, c.eps)
    top = _refined(c, linkage, psi[place.argmax(axis=-1)])
    bottom = _refined(c, linkage, psi[place.argmin(axis=-1)])
    high, low = (linkage.motion(at[..., None], c.lam, c.eps).place[..., 0] for at in (top, bottom))
    centred = np.remainder(np.degrees(top) + 180, 360) - 180
    return c.radius * (high - low), centred, np.degrees(bottom) - 180


def _refined(c: Cylinders, linkage: Linkage, psi: Array) -> Array:
    """Newton's method for the zeros of the piston's velocity beside these angles, one each
    cylinder.
    """
    for _ in range(6):
        motion = linkage.motion(psi[..., None], c.lam, c.eps)
        psi = psi - (motion.velocity / motion.acceleration)[..., 0]
    return psi

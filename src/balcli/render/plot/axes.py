"""What several pictures share: units, the plane of forces and moments, looks.

The plane is seen from the free end: x up, y to the right, so that the crank turns clockwise.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ...core.phasors import Array, Complex, Phasors
from ..units import ShownUnit
from .style import BLUE, GREEN, RED, SOFT

if TYPE_CHECKING:
    from matplotlib.axes import Axes

FINE = np.radians(np.arange(0, 360.5, 1))  # crank angles at which one order is drawn
LOOKS = ((BLUE, "-", ""), (RED, (0, (5, 1.5)), "////"), (GREEN, (0, (1.5, 1)), "...."))


def divide_cycle(*curves: Phasors | None) -> Array:
    """Crank angles, rad, at which curves are drawn: to 720 deg if one of them has half orders."""
    halves = any(np.any(c.orders[~c.balanced] % 1) for c in curves if c is not None)
    return np.radians(np.arange((720 if halves else 360) + 1))


def set_up_plane(ax: Axes, curves: Sequence[Complex | None], what: str, s: ShownUnit) -> float:
    """Make the axes a square with the origin in its middle, x up; returns its half side."""
    largest = max(np.abs(c).max(initial=0) for c in curves if c is not None) / s.size
    limit = float(largest or 1) * 1.25
    ax.set(
        xlim=(-limit, limit),
        ylim=(-limit, limit),
        aspect="equal",
        xlabel=f"{what} along y, {s.name}",
        ylabel=f"{what} along x, {s.name}",
    )
    ax.locator_params(nbins=5)
    ax.axhline(0, color=SOFT, linewidth=0.7)
    ax.axvline(0, color=SOFT, linewidth=0.7)
    if not largest:
        ax.set(xticks=[0], yticks=[0])
    return limit


def overlap(apart: complex, limit: float) -> bool:
    """Whether two crank angles, written so far apart (x up) in a plane with this half side, would
    lie on one another.
    """
    return abs(apart.real) < 0.07 * limit and abs(apart.imag) < 0.16 * limit

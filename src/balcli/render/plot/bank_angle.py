"""Pictures of a vee over its bank angle: the path of the force's tip, and its two vectors."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ...studies.pictures import Banks
from ..units import ShownUnit
from .plane import FINE, set_up_plane
from .style import BLUE, INK, RED, put_legend_above

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_BANKS_DEG = (0, 30, 60, 90, 120, 150, 180)


def draw_end_curves(ax: Axes, banks: Banks, unit: ShownUnit) -> None:
    """Draw the path of the force's tip for several bank angles."""
    from matplotlib import colormaps

    shown = [int(np.argmin(np.abs(banks.angles_deg - angle))) for angle in _BANKS_DEG]
    s = unit.fit(float(banks.force.major.max(initial=0)))
    ahead, against = banks.force.forward[0, shown], banks.force.backward[0, shown]
    turn = np.exp(1j * FINE)
    paths = (ahead[:, None] * turn + against[:, None] / turn) / s.size
    set_up_plane(ax, float(np.abs(paths).max()), "force", s.name)
    for path, angle, shade in zip(paths, _BANKS_DEG, np.linspace(0, 0.9, 7), strict=True):
        colour = colormaps["viridis"](shade)
        ax.plot(
            path.imag, path.real, "o-", color=colour, markevery=360, markersize=3, label=f"{angle}°"
        )
    ax.set_title(f"Force of order {banks.order:g}: path of its tip by bank angle")
    put_legend_above(ax, len(_BANKS_DEG))


def draw_roses(ax: Any, banks: Banks, unit: ShownUnit) -> None:
    """Draw the sizes of both rotating vectors as radii in the directions of the two banks, whose
    angle is varied.
    """
    ahead, against = np.abs(banks.force.forward[0]), np.abs(banks.force.backward[0])
    largest = float(max(ahead.max(), against.max()))
    s = unit.fit(largest)
    ax.set_theta_zero_location("N")
    ax.set_theta_direction(-1)
    half = np.radians(banks.angles_deg) / 2
    for size, colour, style, label in (
        (ahead, BLUE, "-", "with the crank"),
        (against, RED, (0, (5, 1.5)), "against it"),
    ):
        both = np.concatenate([size[::-1], size]) / s.size
        angles = np.concatenate([-half[::-1], half])
        ax.plot(angles, both, color=colour, linestyle=style, label=label)
    if banks.own_deg <= 180:
        for side in (-0.5, 0.5):
            ax.axvline(np.radians(side * banks.own_deg), color=INK, linewidth=0.9, linestyle=":")
    marks = np.arange(-90, 91, 30)
    ax.set_thetagrids(marks, [f"{abs(2 * mark):g}°" for mark in marks])
    ax.set(thetamin=-90, thetamax=90, rmax=1.08 * largest / s.size or 1)
    ax.set_title(f"Its two vectors by bank angle, {s.name} (dotted: this engine)", pad=6)
    ax.legend(loc="lower center", bbox_to_anchor=(0.5, 0.02), ncols=2)

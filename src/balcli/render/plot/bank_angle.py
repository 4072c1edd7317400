"""The force of a vee over its bank angle."""

from __future__ import annotations

from itertools import cycle
from typing import TYPE_CHECKING, Any

import numpy as np

from ...core.phasors import Phasors
from ...studies.pictures import Banks
from ..units import Unit
from .axes import FINE, set_up_plane
from .style import BLUE, INK, RED

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SHOWN_DEG = (0, 30, 60, 90, 120, 150, 180)  # bank angles


def draw_end_curves(ax: Axes, banks: Banks, unit: Unit) -> None:
    """Draw the way of the force's tip for several bank angles."""
    shown = [int(np.argmin(np.abs(banks.angles_deg - angle))) for angle in SHOWN_DEG]
    s = unit.fit(float(banks.force.major.max(initial=0)))
    ways = [
        Phasors(
            banks.force.orders, banks.force.forward[:, k], banks.force.backward[:, k], np.zeros(1)
        ).values(FINE)
        for k in shown
    ]
    limit = set_up_plane(ax, ways, "force", s)
    for side, k, way, shade in zip(
        cycle((1, -1)), shown, ways, np.linspace(0.25, 1, len(shown)), strict=False
    ):
        ax.plot(way.imag / s.size, way.real / s.size, color=BLUE, alpha=shade, linewidth=1.2)
        far = np.abs(way) > (1 - 1e-6) * np.abs(way).max(initial=0)  # labels to either side in turn
        tip = max(way[far] / s.size, key=lambda v: side * (v.real + v.imag), default=0j)
        out = tip / abs(tip) if abs(tip) > 0.02 * limit else 1
        spot = tip + 0.07 * limit * out
        ax.text(
            spot.imag, spot.real, f"{banks.angles_deg[k]:g}°", ha="center", va="center", fontsize=7
        )
    ax.set_title(f"Force of order {banks.order:g}: path of its tip by bank angle", pad=6)


def draw_roses(ax: Any, banks: Banks, unit: Unit) -> None:
    """Draw the sizes of both rotating vectors as radii in the directions of the two banks, whose
    angle is varied.
    """
    from matplotlib.ticker import MaxNLocator

    ahead, against = np.abs(banks.force.forward[0]), np.abs(banks.force.backward[0])
    s = unit.fit(float(max(ahead.max(), against.max())))
    ax.set_theta_zero_location("N")
    ax.set_theta_direction(-1)
    ax.set(thetamin=-90, thetamax=90)
    half = np.radians(banks.angles_deg) / 2
    for size, colour, style, label in (
        (ahead, BLUE, "-", "with the crank"),
        (against, RED, (0, (5, 1.5)), "against it"),
    ):
        there_and_back = np.concatenate([size[::-1], size]) / s.size
        ax.plot(
            np.concatenate([-half[::-1], half]),
            there_and_back,
            color=colour,
            linestyle=style,
            label=label,
        )
    if banks.own_deg <= 180:
        for side in (-0.5, 0.5):
            ax.axvline(np.radians(side * banks.own_deg), color=INK, linewidth=0.9, linestyle=":")
    ax.set_thetagrids(np.arange(-90, 91, 30), [f"{abs(2 * a):g}°" for a in np.arange(-90, 91, 30)])
    ax.set_rmax(1.08 * max(ahead.max(), against.max()) / s.size or 1)
    ax.set_rticks(
        [r for r in MaxNLocator(3).tick_values(0, ax.get_rmax()) if 0 < r < ax.get_rmax()]
    )
    ax.set_title(f"Its two vectors by bank angle, {s.name} (dotted: this engine)", pad=6)
    ax.legend(loc="lower center", bbox_to_anchor=(0.5, 0.02), ncols=2)

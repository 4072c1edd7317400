"""The force of a vee over its bank angle."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ...core.phasors import Complex, Phasors
from ...studies.pictures import Banks
from ..units import ShownUnit
from .axes import FINE, set_up_plane
from .style import BLUE, INK, RED

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SHOWN_DEG = (0, 30, 60, 90, 120, 150, 180)  # bank angles


def draw_end_curves(ax: Axes, banks: Banks, unit: ShownUnit) -> None:
    """Draw the way of the force's tip for several bank angles."""
    shown = [int(np.argmin(np.abs(banks.angles_deg - angle))) for angle in SHOWN_DEG]
    s = unit.fit(float(banks.force.major.max(initial=0)))
    ways = [
        Phasors(banks.force.orders, banks.force.vectors[:, :, k], np.zeros(1)).values(FINE)
        for k in shown
    ]
    limit = set_up_plane(ax, ways, "force", s)
    ways = [way / s.size for way in ways]
    spots = place_labels(ways, limit)
    for k, way, spot, shade in zip(shown, ways, spots, np.linspace(0.25, 1, 7), strict=True):
        ax.plot(way.imag, way.real, color=BLUE, alpha=shade, linewidth=1.2)
        ax.text(
            spot.imag, spot.real, f"{banks.angles_deg[k]:g}°", ha="center", va="center", fontsize=7
        )
    ax.set_title(f"Force of order {banks.order:g}: path of its tip by bank angle", pad=6)


def place_labels(ways: Sequence[Complex], limit: float) -> list[complex]:
    """A place for the label of each curve: beside it, as far from the middle as there is one where
    it covers no curve, no axis and no other label; if there is none, where it is freest.

    Args:
        limit: half the side of the picture.
    """
    axis = np.linspace(-limit, limit, 101)
    lines = np.concatenate([*ways, axis, 1j * axis])
    taken: list[complex] = []
    for way in ways:
        spots = _list_spots(way, limit)
        room = np.abs(spots[:, None] - lines).min(axis=1) / 0.06
        if taken:
            to_labels = np.abs(spots[:, None] - np.array(taken)).min(axis=1)
            room = np.minimum(room, to_labels / 0.15)
        room = np.minimum(np.round(room / limit, 3), 1)  # in what a label needs, no more than that
        taken.append(complex(spots[room.argmax()]))
    return taken


def _list_spots(way: Complex, limit: float) -> Complex:
    """Places ahead of a curve and to either side of it, those far from the middle first."""
    ends = way[:: len(way) // 72]
    size = np.abs(ends)
    ends = ends[np.argsort(-np.round(size / limit, 3), kind="stable")]
    size = np.abs(ends)
    out = np.where(size > 0.02 * limit, ends / np.where(size > 0, size, 1), 1 + 1j)
    return (ends[:, None] + 0.075 * limit * out[:, None] * np.array([1, 1j, -1j])).ravel()


def draw_roses(ax: Any, banks: Banks, unit: ShownUnit) -> None:
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

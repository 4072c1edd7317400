"""Picture of an engine on its mounts: forces over speed, orders that meet modes, motion of points,
and the body moving in each mode.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations
from textwrap import fill
from typing import TYPE_CHECKING, Any

import numpy as np

from ...core.vibration import Real
from ...engine.arrays import find_first_largest
from ...mounting.modes import BodyMode
from ...mounting.report import MountReport
from ...mounting.response import MountingResponse
from ..body_block import PROJECTION, find_corners
from ..sheet import NAMELESS, number, order_name
from ..units import ShownUnit, System
from .style import (
    BLUE,
    FAINT,
    INK,
    MANY_LOOKS,
    PAPER,
    RED,
    SOFT,
    fit_name,
    open_figure,
    put_title,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_WIDEST, _THINNEST = 7.0, 0.6  # lines of orders, points
_SWING = 0.22  # of the body's size, by which its farthest corner moves in a picture of a mode


def make_mounts(result: MountReport, system: System) -> Figure:
    """Return the picture of an engine on its mounts."""
    response, mounted = result.response, result.mounted
    with open_figure(*((11.0, 3.2) if response is None else (11.0, 8.6))) as fig:
        put_title(fig, f"{fit_name(result.name or NAMELESS)}: on its mounts")
        lower: Any = fig
        if response is not None:
            halves: Any = fig.subfigures(2, 1, height_ratios=(2.1, 1))
            upper, lower = halves
            axes = upper.subplots(1, 3 if mounted.point_names else 2)
            forces, motions = [("", response.force_peak)], [("", response.motion_peak)]
            for other in result.beside:
                name = f", {fit_name(other.name, 20)}"
                forces.append((name, other.response.force_peak))
                motions.append((name, other.response.motion_peak))
            _draw_curves(axes[0], response.speeds_rpm, mounted.names, forces, system.force)
            axes[0].set_title("Force of each mount")
            _draw_meetings(axes[1], result, response)
            if mounted.point_names:
                rpm, points = response.speeds_rpm, mounted.point_names
                _draw_curves(axes[2], rpm, points, motions, system.length)
                axes[2].set_title("Motion of points")
        shapes = lower.subplots(1, 6)
        for k, (ax, mode) in enumerate(zip(shapes, result.modes.six, strict=True), 1):
            _draw_mode(ax, k, mode, result)
        return fig


def _draw_curves(
    ax: Axes,
    speeds_rpm: Real,
    names: Sequence[str],
    curves: Sequence[tuple[str, Real]],
    unit: ShownUnit,
) -> None:
    """Draw a curve over speed for each name; the curves of schemes are thin, in the same colour.

    Args:
        curves: what is added to each name, and values of shape (speeds, names).
    """
    for k, (name, (line, colour)) in enumerate(zip(names, MANY_LOOKS, strict=False)):
        for scheme, values in curves:
            ax.plot(
                speeds_rpm,
                values[:, k] / unit.size,
                color=colour,
                linestyle="-." if scheme else line,
                linewidth=1.0 if scheme else 1.8,
                label=f"{fit_name(name, 20)}{scheme}",
            )
    ax.set_ylim(bottom=0)
    ax.set(xlabel="rpm", ylabel=f"{unit.name}, all orders")
    ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=2)


def _draw_meetings(ax: Axes, result: MountReport, response: MountingResponse) -> None:
    """Draw orders over speed, as wide as the force of the mount with the largest, and modes."""
    hardest = int(find_first_largest([worst.value for worst in response.worst_force]))
    force = response.force[:, :, hardest]
    largest = force.max() or 1.0
    rpm = response.speeds_rpm
    highest = 2.5 * result.modes.six[-1].hertz
    for n, order in enumerate(response.loads.orders):
        hertz = order * rpm / 60
        width = np.maximum(_WIDEST * force[n] / largest, _THINNEST)
        ax.scatter(rpm, hertz, s=width**2, color=BLUE, linewidths=0, zorder=3)
        ax.plot(rpm, hertz, color=BLUE, linewidth=_THINNEST)
        inside = np.flatnonzero(hertz < 0.97 * highest)
        if len(inside):
            last = inside[-1]
            ax.text(rpm[last], hertz[last], f" {order_name(order)}", color=INK, va="bottom")
    for mode in result.modes.six:
        ax.axhline(mode.hertz, color=RED, linewidth=0.8)
    ax.set_ylim(0, highest)
    ax.set_xlim(rpm[0], rpm[-1] if len(rpm) > 1 else rpm[0] + 1)
    ax.set_title("Orders (blue) meet modes (red)")
    ax.set_xlabel(f"rpm; width: force of {fit_name(result.mounted.names[hardest], 20)}")
    ax.set_ylabel("Hz")


def _draw_mode(ax: Axes, k: int, mode: BodyMode, result: MountReport) -> None:
    """Draw a block of the body's mass and inertia with its mounts, at rest and displaced."""
    body = result.mounted.body
    corners = find_corners(body)
    turned = mode.shape[:3] + np.cross(mode.shape[3:], corners)
    farthest = float(np.linalg.norm(turned, axis=1).max()) or 1.0
    scale = _SWING * 2 * float(corners.max()) / farthest
    places = result.mounted.dynamic.at - body.centre
    moved = places + scale * (mode.shape[:3] + np.cross(mode.shape[3:], places))
    for points, colour, width in ((corners, FAINT, 1.0), (corners + scale * turned, BLUE, 1.4)):
        flat = points @ PROJECTION.T
        for i, j in combinations(range(8), 2):
            if np.sum(corners[i] != corners[j]) == 1:
                ax.plot(*flat[[i, j]].T, color=colour, linewidth=width)
    rest, away = places @ PROJECTION.T, moved @ PROJECTION.T
    ax.plot(*rest.T, "o", color=SOFT, markersize=3, markerfacecolor=PAPER)
    for one, other in zip(rest, away, strict=True):
        ax.plot(*np.stack([one, other]).T, color=SOFT, linewidth=0.8)
    ax.plot(*away.T, "o", color=RED, markersize=3)
    ax.set_aspect("equal")
    ax.set_axis_off()
    ax.set_title(f"{k}: {number(mode.hertz, 3)} Hz\n{fill(mode.motion, 22)}", fontsize=8.5, pad=4)

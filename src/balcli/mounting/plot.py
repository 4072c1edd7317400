"""Draw an engine on its mounts: forces over speed, orders that meet modes, motion of points, and
the motion of the body in each mode.
"""

from __future__ import annotations

from itertools import combinations
from textwrap import fill
from typing import TYPE_CHECKING

import numpy as np

from ..core.vibration import Real
from ..show.plot_style import (
    BLUE,
    FAINT,
    MANY_LOOKS,
    PAPER,
    RED,
    SOFT,
    fit_name,
    open_figure,
    put_title,
)
from ..show.sheet import NAMELESS, number, order_name
from ..show.units import System
from .build import BodyMode, find_mounted_modes
from .records import BodyResponse, MountReport
from .response import trace_peaks
from .rigid_body import PROJECTION, find_corners
from .show import Kind, list_kinds

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, FigureBase

    from ..show.plot_style import Look


_WIDEST = 7.0
_THINNEST = 0.6  # largest and smallest line width of orders, in points (1/72 inch)
_POINTS = 400  # least number of points of a curve
_SWING = 0.22  # drawn travel of the corner that moves most, as a share of the body's size


def make_mounts(result: MountReport, system: System) -> Figure:
    """Return the picture of an engine on its mounts."""
    response = result.response if hasattr(result, "response") else None
    with open_figure(11.0, 3.2 if response is None else 8.6) as fig:
        put_title(fig, f"{fit_name(result.name or NAMELESS)}: on its mounts")
        lower: FigureBase = fig
        if response is not None:
            (upper,), (lower,) = fig.subfigures(2, 1, squeeze=False, height_ratios=(2.1, 1))
            meet = any(mode.meets for mode in result.modes)
            kinds = list_kinds(system)[: 1 + bool(response.points)]
            axes = upper.subplots(1, len(kinds) + meet, squeeze=False)[0]
            for ax, kind in zip(axes, kinds, strict=False):
                _draw_curves(ax, result, kind)
            if meet:
                _draw_meetings(axes[-1], result, response)
        for k, (ax, mode) in enumerate(zip(lower.subplots(1, 6), result.modes, strict=True), 1):
            _draw_mode(ax, k, mode, result)
        return fig


def _draw_curves(ax: Axes, result: MountReport, kind: Kind) -> None:
    """Draw a curve over speed for each mount or point. Curves of the engine with a scheme and of
    other engines are thinner and have the colour of the same mount or point.
    """
    labels = ["", *(f", {fit_name(other.name, 20)}" for other in result.beside)]
    for label, response in zip(labels, result.responses, strict=True):
        speeds = _refine(response.speeds_rpm)
        modes = find_mounted_modes(result.mounted)
        peaks = trace_peaks(result.mounted, modes, response.loads, speeds)
        count = len(response.mounts)
        heights = peaks[:, :count] if kind.part == "mount" else 1e3 * peaks[:, count:]  # m to mm
        looks = zip(kind.places(response), heights.T, MANY_LOOKS, strict=False)
        for (name, _, _, _), curve, (line, colour) in looks:
            look: Look = {"color": colour, "linestyle": "-." if label else line}
            width = 1.0 if label else 1.8
            shown = f"{fit_name(name, 20)}{label}"
            ax.plot(speeds, curve / kind.unit.size, label=shown, linewidth=width, **look)
    ax.set_ylim(bottom=0)
    title = "Force of each mount" if kind.part == "mount" else "Motion of points"
    ax.set(xlabel="rpm", ylabel=f"{kind.unit.name}, all orders", title=title)
    ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=2)


def _refine(speeds_rpm: Real) -> Real:
    """Return the speeds and, between them, as many as a smooth curve needs."""
    pieces = -(-_POINTS // max(len(speeds_rpm) - 1, 1))
    numbers = np.arange(len(speeds_rpm))
    fine = np.linspace(0, len(speeds_rpm) - 1, pieces * (len(speeds_rpm) - 1) + 1)
    return np.interp(fine, numbers, speeds_rpm)


def _draw_meetings(ax: Axes, result: MountReport, response: BodyResponse) -> None:
    """Draw the frequencies of modes, and of orders over speed. The line width of an order shows
    its force on the mount with the largest force.
    """
    mount = max(response.mounts, key=lambda mount: round(mount.worst.force_N, 6))
    largest = max(each.force_N.max() for each in mount.orders) or 1.0
    rpm = response.speeds_rpm
    highest = 2.5 * result.modes[-1].frequency_Hz
    for order, force in mount.orders:
        hertz = order * rpm / 60
        width = np.maximum(_WIDEST * force / largest, _THINNEST)
        ax.scatter(rpm, hertz, s=width**2, color=BLUE, linewidths=0, zorder=3)
        ax.plot(rpm, hertz, color=BLUE, linewidth=_THINNEST)
        end = min(rpm[-1], 0.97 * highest * 60 / order)
        ax.text(end, order * end / 60, f" {order_name(order)}", va="bottom", clip_on=True)
    for mode in result.modes:
        ax.axhline(mode.frequency_Hz, color=RED, linewidth=0.8)
    ax.set(xlim=(rpm[0], max(rpm[-1], rpm[0] + 1)), ylim=(0, highest), ylabel="Hz")
    ax.set_xlabel(f"rpm; width: force of {fit_name(mount.name, 20)}")
    ax.set_title("Orders (blue) meet modes (red)")


def _draw_mode(ax: Axes, k: int, mode: BodyMode, result: MountReport) -> None:
    """Draw a block with the body's mass and inertia, and the mounts, at rest and displaced in a
    mode.
    """
    body = result.mounted.body
    corners = find_corners(body)
    places = result.mounted.dynamic.at - body.centre
    turned, carried = (mode.shape[:3] + np.cross(mode.shape[3:], p) for p in (corners, places))
    farthest = float(np.linalg.norm(turned, axis=1).max()) or 1.0
    scale = _SWING * 2 * float(corners.max()) / farthest
    for points, colour, width in ((corners, FAINT, 1.0), (corners + scale * turned, BLUE, 1.4)):
        flat = points @ PROJECTION.T
        for i, j in combinations(range(8), 2):
            if np.sum(corners[i] != corners[j]) == 1:
                ax.plot(*flat[[i, j]].T, color=colour, linewidth=width)
    rest = places @ PROJECTION.T
    away = (places + scale * carried) @ PROJECTION.T
    ax.plot(*rest.T, "o", color=SOFT, markersize=3, markerfacecolor=PAPER)
    ax.plot(*np.stack([rest.T, away.T], axis=1), color=SOFT, linewidth=0.8)
    ax.plot(*away.T, "o", color=RED, markersize=3)
    ax.set_aspect("equal")
    ax.set_axis_off()
    named = f"{k}: {number(mode.frequency_Hz, 3)} Hz\n{fill(mode.motion, 22)}"
    ax.set_title(named, fontsize=8.5, pad=4)

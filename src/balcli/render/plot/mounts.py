"""Picture of an engine on its mounts: forces over speed, orders that meet modes, motion of points,
and the body moving in each mode.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
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
    Form,
    fit_name,
    open_figure,
    put_title,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_MOST_CURVES = len(MANY_LOOKS)
_WIDEST, _THINNEST = 7.0, 0.6  # lines of orders, points
_LABEL_HEIGHT = 0.035  # of an axis
_SWING = 0.22  # of the body's size, by which its farthest corner moves in a picture of a mode
_SIZE, _SHAPES_ALONE = (11.0, 8.6), (11.0, 3.2)


def make_mounts(result: MountReport, form: Form, system: System) -> Figure:
    """The picture, to be saved in this form."""
    title = f"{fit_name(result.name or NAMELESS)}: on its mounts"
    with open_figure(*(_SHAPES_ALONE if result.response is None else _SIZE), form) as fig:
        put_title(fig, title)
        if result.response is None:
            shapes = fig.subplots(1, 6)
        else:
            halves: Any = fig.subfigures(2, 1, height_ratios=(2.1, 1))
            upper, lower = halves
            several = upper.subplots(1, 3 if result.mounted.point_names else 2)
            rpm, beside = result.response.speeds_rpm, list(_name_responses(result, result.response))
            forces = [(each.force_peak, more) for each, more in beside]
            _draw_curves(several[0], rpm, result.mounted.names, forces, system.force)
            several[0].set_title("Force of each mount")
            _draw_meetings(several[1], result, result.response)
            if result.mounted.point_names:
                motions = [(each.motion_peak, more) for each, more in beside]
                _draw_curves(several[2], rpm, result.mounted.point_names, motions, system.length)
                several[2].set_title("Motion of points")
            shapes = lower.subplots(1, 6)
        for k, (ax, mode) in enumerate(zip(shapes, result.modes.six, strict=True), 1):
            _draw_mode(ax, k, mode, result)
        return fig


def _name_responses(
    result: MountReport, own: MountingResponse
) -> Iterator[tuple[MountingResponse, str]]:
    """The engine's own and what is shown beside, with what to add to a name."""
    yield own, ""
    yield from ((other.response, f", {fit_name(other.name, 20)}") for other in result.beside)


def _draw_curves(
    ax: Axes,
    speeds_rpm: Real,
    names: Sequence[str],
    curves: Sequence[tuple[Real, str]],
    unit: ShownUnit,
) -> None:
    """Over speed, a curve for each name; those with a scheme are thin and of the same look."""
    for k, name in enumerate(names[:_MOST_CURVES]):
        line, colour = MANY_LOOKS[k]
        for values, more in curves:
            ax.plot(
                speeds_rpm,
                [unit.of(value) for value in values[:, k]],
                color=colour,
                linestyle="-." if more else line,
                linewidth=1.0 if more else 1.8,
                label=f"{fit_name(name, 20)}{more}",
            )
    ax.set_ylim(bottom=0)
    ax.set(xlabel="rpm", ylabel=f"{unit.name}, all orders")
    ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=2)


def _draw_meetings(ax: Axes, result: MountReport, response: MountingResponse) -> None:
    """Orders over speed, as wide as the force of the mount that feels most; modes lie across."""
    hardest = int(find_first_largest([worst.value for worst in response.worst_force]))
    force = response.force[:, :, hardest]
    largest = force.max() or 1.0
    rpm = response.speeds_rpm
    highest = 2.5 * result.modes.six[-1].hertz
    for n, order in enumerate(response.loads.orders):
        hertz = order * rpm / 60
        width = np.maximum(_WIDEST * force[n] / largest, _THINNEST)
        if width.max() > _THINNEST:
            ax.scatter(rpm, hertz, s=width**2, color=BLUE, linewidths=0, zorder=3)
        ax.plot(rpm, hertz, color=BLUE, linewidth=_THINNEST)
        inside = hertz < 0.97 * highest
        if inside.any():
            last = int(np.flatnonzero(inside)[-1])
            ax.text(rpm[last], hertz[last], f" {order_name(order)}", color=INK, va="bottom")
    six = [mode.hertz for mode in result.modes.six]
    for frequency in six:
        ax.axhline(frequency, color=RED, linewidth=0.8)
    for label, frequency in _name_modes(six, _LABEL_HEIGHT * highest):
        ax.text(rpm[-1], frequency, label, color=RED, ha="right", va="bottom")
    ax.set_ylim(0, highest)
    ax.set_xlim(rpm[0], rpm[-1] if len(rpm) > 1 else rpm[0] + 1)
    ax.set_title("Orders (blue) meet modes (red)")
    ax.set_xlabel(f"rpm; width: force of {fit_name(result.mounted.names[hardest], 20)}")
    ax.set_ylabel("Hz")


def _name_modes(frequencies: Sequence[float], least: float) -> list[tuple[str, float]]:
    """Numbers of modes, ascending, and where to write them: those nearer than `least` together, at
    the highest of them.
    """
    named: list[tuple[str, float]] = []
    for k, frequency in enumerate(frequencies, 1):
        if named and frequency - named[-1][1] < least:
            named[-1] = f"{named[-1][0]}, {k}", frequency
        else:
            named.append((f"{k}", frequency))
    return named


def _draw_mode(ax: Axes, k: int, mode: BodyMode, result: MountReport) -> None:
    """A block of the body's mass and inertia, at rest and at its swing's end, with its mounts."""
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

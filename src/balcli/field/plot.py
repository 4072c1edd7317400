"""Polar picture of field balancing: readings before and after on the left, weights on the right."""

from __future__ import annotations

from itertools import cycle
from typing import TYPE_CHECKING, Any

import numpy as np

from ..core.records import angle_deg
from ..show.plot_style import BLUE, INK, MANY_LOOKS, PAPER, SOFT, fit_name, open_figure, put_title
from ..show.sheet import number
from .answer import FieldBalance
from .show import name_readings

if TYPE_CHECKING:
    from matplotlib.figure import Figure


_MOST_LABELLED = 8  # readings; more names would overlap


def make_field(result: FieldBalance) -> Figure:
    """Return the picture of a rotor before and after balancing."""
    with open_figure(11.0, 6.2) as fig:
        left, right = fig.subplots(1, 2, subplot_kw={"projection": "polar"})
        _draw_readings(left, result)
        _draw_weights(right, result)
        unit = f", {result.unit}" if result.unit else ""
        readings = f"Readings{unit}; phases count {result.phases} rotation"
        weights = f"Weights, {result.weight_unit}; angles count {result.weights} rotation"
        for ax, sense, title in ((left, result.phases, readings), (right, result.weights, weights)):
            ax.set_theta_zero_location("N")  # the rotor turns anticlockwise
            ax.set_theta_direction(1 if sense == "with" else -1)
            ax.set_thetagrids(np.arange(0, 360, 30))
            ax.set_title(title, pad=24)
            ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.08), ncols=3)
        name = fit_name(result.name or "rotor without a name")
        put_title(fig, f"{name}: field balancing")
        return fig


def _draw_readings(ax: Any, result: FieldBalance) -> None:
    """Draw each reading from a hollow dot (in the last run) to a full one (predicted)."""
    hollow: Any = {"color": SOFT, "markerfacecolor": PAPER}
    ends = [*zip(result.before, result.residual, strict=True)]
    for name, (start, end) in zip(name_readings(result), ends, strict=True):
        angles, sizes = [np.angle(start or end), np.angle(end or start)], [abs(start), abs(end)]
        ax.plot(angles, sizes, color=SOFT, linewidth=1, linestyle=(0, (4, 2)))
        ax.plot(angles[:1], sizes[:1], "o", **hollow)
        ax.plot(angles[1:], sizes[1:], "o", color=BLUE, markersize=5, zorder=3)
        if len(ends) <= _MOST_LABELLED:
            label = f"{fit_name(name, 30)}: {number(abs(start), 3)}"
            ax.annotate(label, (angles[0], sizes[0]), xytext=(6, 5), textcoords="offset points")
    ax.plot([], [], "o", label=fit_name(result.runs.state, 30), **hollow)
    ax.plot([], [], "o", color=BLUE, label="after (predicted)")
    ax.set_ylim(0, 1.25 * (float(np.abs(ends).max()) or 1.0))


def _draw_weights(ax: Any, result: FieldBalance) -> None:
    """Draw the weight of every plane as a ray, and the pieces of which the shop makes it."""
    drilled = result.file.drill is not None
    marks: Any = {"marker": "x" if drilled else "s", "markerfacecolor": "none", "linestyle": ""}
    sizes = [0.0]
    for each, (line, colour) in zip(result.corrections, cycle(MANY_LOOKS), strict=False):
        name = fit_name(each.plane, 30)
        rays = [(each.step, name, line, 2.0)]
        if each.wanted is not None:
            wanted = each.wanted - each.weight + each.step
            rays.append((wanted, f"{name}, wanted", ":", 1.0))
        for weight, label, style, width in rays:
            text = f"{label}: {number(abs(weight), 3)} at {angle_deg(weight):.1f} deg"
            look: Any = {"color": colour, "linestyle": style, "linewidth": width}
            angle, size = np.angle(weight), abs(weight)
            ax.plot([angle, angle], [0, size], label=text, **look)
            ax.plot([angle], [size], "o", color=colour, markersize=5)
            sizes.append(size)
        if drilled or result.file.places:
            for piece in each.pieces:
                ax.plot([np.radians(piece.angle_deg)], [piece.weight], color=colour, **marks)
                sizes.append(piece.weight)
    if drilled or result.file.places:
        ax.plot([], [], color=INK, label="holes" if drilled else "places", **marks)
    ax.set_ylim(0, 1.15 * (max(sizes) or 1.0))

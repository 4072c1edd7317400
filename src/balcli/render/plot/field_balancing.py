"""Polar picture of field balancing: readings before and after on the left, weights on the right."""

from __future__ import annotations

from itertools import cycle
from typing import TYPE_CHECKING, Any

import numpy as np

from ...field_balancing.balance import FieldBalance
from ...field_balancing.influence import find_senses
from ...field_balancing.shop import find_angle_deg
from ..field_balancing import find_label
from ..sheet import number
from .style import BLUE, INK, MANY_LOOKS, PAPER, SOFT, fit_name, open_figure, put_title

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_MOST_LABELLED = 8  # readings; more names would overlap


def make_field(result: FieldBalance) -> Figure:
    """Return the picture of a rotor before and after balancing."""
    phases, weights = find_senses(result.file)
    with open_figure(11.0, 6.2) as fig:
        left, right = fig.subplots(1, 2, subplot_kw={"projection": "polar"})
        _draw_readings(left, result)
        _draw_weights(right, result)
        unit = f", {result.file.unit}" if result.file.unit else ""
        _finish(left, phases, f"Readings{unit}; phases count {phases} rotation")
        _finish(
            right, weights, f"Weights, {result.file.weight_unit}; angles count {weights} rotation"
        )
        name = fit_name(result.file.name or "rotor without a name")
        put_title(fig, f"{name}: field balancing")
        return fig


def _finish(ax: Any, sense: str, title: str) -> None:
    """Put 0 at the top; the rotor turns anticlockwise."""
    ax.set_theta_zero_location("N")
    ax.set_theta_direction(1 if sense == "with" else -1)
    ax.set_thetagrids(np.arange(0, 360, 30))
    ax.set_title(title, pad=24)
    ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.08), ncols=3)


def _draw_readings(ax: Any, result: FieldBalance) -> None:
    """Draw each reading from a hollow dot (in the last run) to a full one (predicted)."""
    before, after = result.influence.now, result.after
    hollow: Any = {"color": SOFT, "markerfacecolor": PAPER}
    for k, (start, end) in enumerate(zip(before, after, strict=True)):
        angles, sizes = _polar(start, end)
        ax.plot(angles, sizes, color=SOFT, linewidth=1, linestyle=(0, (4, 2)))
        ax.plot(angles[:1], sizes[:1], "o", **hollow)
        ax.plot(angles[1:], sizes[1:], "o", color=BLUE, markersize=5, zorder=3)
        if len(before) <= _MOST_LABELLED:
            label = f"{fit_name(find_label(result, k), 30)}: {number(abs(start), 3)}"
            ax.annotate(label, (angles[0], sizes[0]), xytext=(6, 5), textcoords="offset points")
    ax.plot([], [], "o", label=fit_name(result.influence.state, 30), **hollow)
    ax.plot([], [], "o", color=BLUE, label="after (predicted)")
    ax.set_ylim(0, 1.25 * (float(np.abs([*before, *after]).max()) or 1.0))


def _draw_weights(ax: Any, result: FieldBalance) -> None:
    """Draw the weight of every plane as a ray, and the pieces of which the shop makes it."""
    drilled = result.file.drill is not None
    marks: Any = {"marker": "x" if drilled else "s", "markerfacecolor": "none", "linestyle": ""}
    sizes = [0.0]
    for p, (line, colour) in zip(result.planes, cycle(MANY_LOOKS), strict=False):
        name = fit_name(p.plane, 30)
        rays = [(p.step, name, line, 2.0)]
        if p.limited:
            rays.append((p.wanted, f"{name}, wanted", ":", 1.0))
        for weight, label, style, width in rays:
            angles, radii = _polar(0j, weight)
            text = f"{label}: {number(abs(weight), 3)} at {find_angle_deg(weight):.1f} deg"
            look: Any = {"color": colour, "linestyle": style, "linewidth": width}
            ax.plot([angles[1]] * 2, radii, label=text, **look)
            ax.plot(angles[1:], radii[1:], "o", color=colour, markersize=5)
            sizes.append(abs(weight))
        if drilled or result.file.places:
            for piece in p.pieces:
                ax.plot([np.radians(piece.angle_deg)], [piece.weight], color=colour, **marks)
                sizes.append(piece.weight)
    if drilled or result.file.places:
        ax.plot([], [], color=INK, label="holes" if drilled else "places", **marks)
    ax.set_ylim(0, 1.15 * (max(sizes) or 1.0))


def _polar(start: complex, end: complex) -> tuple[list[float], list[float]]:
    """Return angles (rad) and sizes of two vectors; a vector of 0 has the angle of the other."""
    return [float(np.angle(start or end)), float(np.angle(end or start))], [abs(start), abs(end)]

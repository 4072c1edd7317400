"""Polar picture of field balancing: readings before and after on the left, weights on the right."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from ...field_balancing.balance import FieldBalance, PlaneCorrection
from ...field_balancing.influence import find_senses
from ...field_balancing.shop import find_angle_deg
from ..field_balancing import find_label
from ..sheet import number
from .style import BLUE, GREEN, INK, PAPER, RED, SOFT, Form, fit_name, open_figure, put_title

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from matplotlib.projections.polar import PolarAxes

_COLOURS = (BLUE, RED, GREEN, INK)
_LINES = ("-", "--", "-.", ":")
_MOST_LABELLED = 8  # readings; more names would lie on one another
_SIZE = (11.0, 6.2)


def make_field(result: FieldBalance, form: Form) -> Figure:
    """The picture, to be saved in this form."""
    phases, weights = find_senses(result.file)
    with open_figure(*_SIZE, form) as fig:
        fig.set_layout_engine("none")
        left, right = (_add_polar(fig, place) for place in (0.06, 0.56))
        _draw_readings(left, result)
        _draw_weights(right, result)
        unit = f", {result.file.unit}" if result.file.unit else ""
        _set_up(left, phases, f"Readings{unit}; phases count {phases} rotation")
        _set_up(
            right, weights, f"Weights, {result.file.weight_unit}; angles count {weights} rotation"
        )
        name = fit_name(result.file.name or "rotor without a name")
        put_title(fig, f"{name}: field balancing")
        return fig


def _add_polar(fig: Figure, left: float) -> PolarAxes:
    axes: Any = fig.add_axes((left, 0.13, 0.38, 0.674), projection="polar")
    return cast("PolarAxes", axes)


def _set_up(ax: PolarAxes, sense: str, title: str) -> None:
    """0 at the top; the rotor turns anticlockwise, so what counts with it goes that way round."""
    ax.set_theta_zero_location("N")
    ax.set_theta_direction(1 if sense == "with" else -1)
    ax.set_thetagrids(np.arange(0, 360, 30))
    ax.set_title(title, pad=24)
    ax.set_rlabel_position(15)
    ax.set_yticks(ax.get_yticks()[::2])
    ax.spines["polar"].set_color(SOFT)
    ax.annotate(
        "",
        xy=(0.02, 0.86),
        xytext=(0.14, 0.98),
        xycoords="axes fraction",
        arrowprops={"arrowstyle": "->", "color": SOFT, "connectionstyle": "arc3,rad=0.2"},
    )
    ax.text(0.0, 0.99, "rotation", transform=ax.transAxes, color=SOFT, ha="left")
    ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.08), ncols=3)


def _draw_readings(ax: PolarAxes, result: FieldBalance) -> None:
    """Each reading goes from a hollow dot (found, or in the last run) to a full one (predicted)."""
    before, after = result.influence.now, result.after
    for k, (start, end) in enumerate(zip(before, after, strict=True)):
        angles, sizes = _polar([complex(start), complex(end)])
        ax.plot(angles, sizes, color=SOFT, linewidth=1, linestyle=(0, (4, 2)))
        ax.plot(angles[:1], sizes[:1], "o", color=SOFT, markerfacecolor=PAPER)
        ax.plot(angles[1:], sizes[1:], "o", color=BLUE, markersize=5, zorder=3)
        if len(before) <= _MOST_LABELLED:
            label = f"{fit_name(find_label(result, k), 30)}: {number(abs(start), 3)}"
            ax.annotate(label, (angles[0], sizes[0]), xytext=(6, 5), textcoords="offset points")
    state = fit_name(result.influence.state, 30)
    ax.plot([], [], "o", color=SOFT, markerfacecolor=PAPER, label=state)
    ax.plot([], [], "o", color=BLUE, label="after (predicted)")
    ax.set_ylim(0, 1.25 * (float(np.abs(np.concatenate([before, after])).max()) or 1.0))


def _draw_weights(ax: PolarAxes, result: FieldBalance) -> None:
    """Every plane's weight as a ray from the axis, where the shop puts it, what does not fit."""
    drilled = result.file.drill is not None
    largest = 0.0
    for k, p in enumerate(result.planes):
        colour, line = _COLOURS[k % len(_COLOURS)], _LINES[k // len(_COLOURS) % len(_LINES)]
        name = fit_name(p.plane, 30)
        _draw_ray(ax, p.step, name, {"color": colour, "linestyle": line, "linewidth": 2})
        sizes = [abs(p.step), *_draw_places(ax, p, colour, result)]
        if p.limited:
            _draw_ray(ax, p.wanted, f"{name}, wanted", {"color": colour, "linestyle": (0, (1, 2))})
            sizes.append(abs(p.wanted))
        largest = max([largest, *sizes])
    if drilled or result.file.places:
        marker = "x" if drilled else "s"
        ax.plot(
            [],
            [],
            marker,
            color=INK,
            markerfacecolor="none",
            label="holes" if drilled else "places",
        )
    ax.set_ylim(0, 1.15 * (largest or 1.0))


def _draw_ray(ax: PolarAxes, weight: complex, name: str, style: dict[str, Any]) -> None:
    """From the axis to a weight."""
    angles, sizes = _polar([0j, weight])
    text = f"{name}: {number(abs(weight), 3)} at {find_angle_deg(weight):.1f} deg"
    ax.plot([angles[1]] * 2, sizes, label=text, **style)
    ax.plot(angles[1:], sizes[1:], "o", color=style["color"], markersize=5)


def _draw_places(
    ax: PolarAxes, p: PlaneCorrection, colour: str, result: FieldBalance
) -> Sequence[float]:
    """Marks at what the shop puts on, or removes; their sizes."""
    if not (result.file.drill or result.file.places):
        return ()
    marker = "x" if result.file.drill else "s"
    for piece in p.pieces:
        ax.plot(
            [np.radians(piece.angle_deg)],
            [piece.weight],
            marker,
            color=colour,
            markersize=7,
            markerfacecolor="none",
        )
    return [piece.weight for piece in p.pieces]


def _polar(values: list[complex]) -> tuple[list[float], list[float]]:
    """Angles (rad) and amounts; what is nothing is drawn at the angle of the first."""
    first = values[0] or values[-1]
    angles = [float(np.angle(value if value else first)) for value in values]
    return angles, [abs(value) for value in values]

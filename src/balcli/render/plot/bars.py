"""The largest value of each order as a bar."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ...core.phasors import Array, Phasors
from ..order_tables import fit_largest
from ..sheet import number, order_name
from ..units import ShownUnit
from ..view import VISIBLE
from .axes import LOOKS
from .legends import put_legend_above
from .style import BLUE, RED, SOFT

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def draw_vector_bars(
    ax: Axes, curve: Phasors, what: str, unit: ShownUnit, before: Phasors | None = None
) -> None:
    """Draw the largest value of each order as a bar: the part that turns with the crank, and upon
    it the part against; dashed what there was before.
    """
    shown = visible_rows(curve, before)
    s = fit_largest(unit, *(p for p in (curve, before) if p is not None))
    ahead = np.abs(curve.forward[shown]) / s.size
    against = np.abs(curve.backward[shown]) / s.size
    places = np.arange(len(shown))
    if before is not None:
        old = _largest_values(before, curve.orders[shown]) / s.size
        look: Any = {"facecolor": "none", "edgecolor": SOFT, "linestyle": (0, (3, 2))}
        ax.bar(places, old, 0.72, label="before", **look)
    ax.bar(places, ahead, 0.56, color=BLUE, label="with the crank")
    ax.bar(places, against, 0.56, bottom=ahead, color=RED, hatch="////", label="against it")
    _label_bars(ax, curve.orders[shown], ahead + against, f"{what}, {s.name}")


def draw_scalar_bars(ax: Axes, curves: Mapping[str, Phasors], unit: ShownUnit) -> None:
    """Draw the amplitudes of several scalars, side by side."""
    shown = sorted({k for curve in curves.values() for k in visible_rows(curve)})
    s = fit_largest(unit, *curves.values())
    for (label, curve), look, shift in zip(curves.items(), LOOKS, (-0.27, 0, 0.27), strict=False):
        ax.bar(
            np.arange(len(shown)) + shift,
            curve.major[shown] / s.size,
            0.25,
            color=look[0],
            hatch=look[2],
            label=label,
        )
    _label_bars(ax, next(iter(curves.values())).orders[shown], None, f"moment, {s.name}")


def visible_rows(curve: Phasors, before: Phasors | None = None) -> list[int]:
    """Rows of the orders that are large enough to be seen, always with 1 and 2; at most ten."""
    major = (
        curve.major
        if before is None
        else np.maximum(curve.major, _largest_values(before, curve.orders))
    )
    always = (curve.orders == 1) | (curve.orders == 2)
    due = np.flatnonzero(always | (major > VISIBLE * major.max(initial=0)))
    keep = due[np.argsort(-major[due], kind="stable")[:10]]
    return sorted(keep.tolist())


def _largest_values(curve: Phasors, orders: Array) -> Array:
    """Largest values for these orders, 0 where one is not there."""
    there = dict(zip(curve.orders.tolist(), curve.major.tolist(), strict=True))
    return np.array([there.get(n, 0.0) for n in orders.tolist()])


def _label_bars(ax: Axes, orders: Array, tops: Array | None, label: str) -> None:
    """Orders below the bars, their values at `tops` if there are such, and the legend."""
    ax.set_xticks(np.arange(len(orders)), [order_name(n) for n in orders])
    ax.set(xlabel="order", ylabel=label, xlim=(-0.6, len(orders) - 0.4))
    ax.grid(False, axis="x")
    ax.locator_params(axis="y", nbins=4)
    for place, top in enumerate(() if tops is None else tops):
        ax.annotate(
            number(float(top), 3),
            (place, top),
            (0, 2),
            textcoords="offset points",
            ha="center",
            fontsize=7,
        )
    highest = ax.dataLim.y1
    ax.set_ylim(0, 1.35 * highest or 1)
    if not highest:
        ax.set_yticks([0])
    put_legend_above(ax)

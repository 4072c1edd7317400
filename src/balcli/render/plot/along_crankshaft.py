"""Largest values at places along the crankshaft."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ...forces.crankshaft import AlongCrank
from ..units import System
from .legends import put_legend_above
from .style import BLUE, SOFT

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def draw_along(
    ax: Axes,
    now_and_before: Sequence[AlongCrank],
    title: str,
    what: str,
    system: System,
    steps: str,
    over: str,
) -> None:
    """Draw the largest values over a revolution, or a cycle, at places along the crank.

    Args:
        now_and_before: one curve, or two to compare.
        title: of the picture.
        what: is measured, "force" or "moment".
        steps: how matplotlib joins the places; empty: columns.
        over: what the values are the largest of.
    """
    curves = [
        (found.z_m / system.length.size, np.array([p.value for p in found.peaks]))
        for found in now_and_before
    ]
    unit = system.force if what == "force" else system.moment
    s = unit.fit(max((float(values.max()) for _, values in curves), default=0.0))
    looks: Any = (
        (
            {"color": BLUE, "linewidth": 2.2, "zorder": 3},
            "after" if len(curves) > 1 else f"largest over {over}",
        ),
        ({"color": SOFT, "linewidth": 1.1, "linestyle": (0, (4, 2)), "zorder": 2}, "before"),
    )
    for (z, values), (look, label) in zip(curves, looks, strict=False):
        ax.plot(z, values / s.size, "o", color=look["color"], markersize=4, zorder=look["zorder"])
        if steps:
            ax.plot(z, values / s.size, drawstyle=steps, label=label, **look)
        else:
            ax.vlines(z, 0, values / s.size, label=label, **look)
    ax.set(ylabel=f"{what}, {s.name}")
    ax.set_title(title if curves else f"{title}: one throw, bearings not known")
    ax.set_ylim(bottom=0)
    if curves:
        put_legend_above(ax)

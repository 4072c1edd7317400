"""Free forces over the balance factor of a counterweight."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..units import Unit
from .axes import LOOKS, choose_scale, put_legend_above
from .style import BLUE, SOFT

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def draw_factors(ax: Axes, rows: Sequence[Mapping[str, float]], force: Unit, moment: Unit) -> None:
    """Draw the largest force and its components over the balance factor; the moment on an axis of
    its own where there is one.

    Args:
        rows: one a factor, with the keys of the scheme's sweep (N and N m).
    """
    share = [row["factor"] for row in rows]
    s = choose_scale(force, max(row["peak_force_N"] for row in rows))
    lines = (
        ("peak_force_N", "force"),
        ("along_N", "along the first bank"),
        ("across_N", "across it"),
    )
    for (key, label), look in zip(lines, LOOKS, strict=True):
        ax.plot(
            share,
            [row[key] / s.size for row in rows],
            color=look[0],
            linestyle=look[1],
            label=label,
        )
    best = min(rows, key=lambda row: (round(row["peak_force_N"], 6), row["peak_moment_Nm"]))
    ax.plot(best["factor"], best["peak_force_N"] / s.size, "o", color=BLUE)
    ax.set(
        xlabel="balance factor: share of the reciprocating mass in the counterweights",
        ylabel=f"largest over a revolution, {s.name}",
        xlim=(share[0], share[-1]),
    )
    ax.set_ylim(bottom=0)
    ax.set_title(f"Largest free force over the balance factor; best at {best['factor']:g}")
    moments = np.array([row["peak_moment_Nm"] for row in rows])
    if moments.max() > 0:
        t = choose_scale(moment, float(moments.max()))
        right = ax.twinx()
        right.plot(share, moments / t.size, color=SOFT, linestyle=(0, (4, 2)), linewidth=1.2)
        right.set_ylabel(f"moment (dashed grey), {t.name}")
        right.set_ylim(bottom=0)
        right.grid(False)
    put_legend_above(ax)

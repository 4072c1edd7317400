"""Pictures of studies: over the balance factor, over the bank angle of a vee, and along the
crankshaft.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import cycle
from typing import TYPE_CHECKING, Any

import numpy as np

from ...core.phasors import Phasors
from ...forces.crankshaft import AlongCrank
from ...sizing.details import FactorPeaks
from ...studies.pictures import Banks
from ..units import Unit
from .draw import FINE, LOOKS, legend_above, plane, scale
from .style import BLUE, INK, RED, SOFT

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def factors(ax: Axes, rows: Sequence[FactorPeaks], force: Unit, moment: Unit) -> None:
    """Largest force and its components over the balance factor; the moment on an axis of its own
    where there is one.
    """
    share = [row.factor for row in rows]
    s = scale(force, max(row.force for row in rows))
    lines = (
        ([row.force for row in rows], "force"),
        ([row.along for row in rows], "along the first bank"),
        ([row.across for row in rows], "across it"),
    )
    for (values, label), look in zip(lines, LOOKS, strict=True):
        ax.plot(
            share,
            np.array(values) / s.size,
            color=look[0],
            linestyle=look[1],
            label=label,
        )
    best = min(rows, key=lambda row: (round(row.force, 6), row.moment))
    ax.plot(best.factor, best.force / s.size, "o", color=BLUE)
    ax.set(
        xlabel="balance factor: share of the reciprocating mass in the counterweights",
        ylabel=f"largest over a revolution, {s.name}",
        xlim=(share[0], share[-1]),
    )
    ax.set_ylim(bottom=0)
    ax.set_title(f"Largest free force over the balance factor; best at {best.factor:g}")
    moments = np.array([row.moment for row in rows])
    if moments.max() > 0:
        t = scale(moment, float(moments.max()))
        right = ax.twinx()
        right.plot(share, moments / t.size, color=SOFT, linestyle=(0, (4, 2)), linewidth=1.2)
        right.set_ylabel(f"moment (dashed grey), {t.name}")
        right.set_ylim(bottom=0)
        right.grid(False)
    legend_above(ax)


def along(
    ax: Axes,
    now_and_before: Sequence[AlongCrank],
    titles: tuple[str, str],
    unit: Unit,
    steps: str = "default",
) -> None:
    """Largest values over a revolution at places along the crank: a line, steps, or (no steps
    named) columns.
    """
    title, what = titles
    curves = [
        (found.z_m * 1e3, np.array([p.value for p in found.peaks])) for found in now_and_before
    ]
    s = scale(unit, max((float(values.max()) for _, values in curves), default=0.0))
    looks: Any = (
        (
            {"color": BLUE, "linewidth": 2.2, "zorder": 3},
            "after" if len(curves) > 1 else "largest over a revolution",
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
        legend_above(ax)


_SWUNG = (0, 30, 60, 90, 120, 150, 180)


def end_curves(ax: Axes, banks: Banks, unit: Unit) -> None:
    """The way of the force's tip for several bank angles."""
    shown = [int(np.argmin(np.abs(banks.angles_deg - angle))) for angle in _SWUNG]
    s = scale(unit, float(banks.force.major.max(initial=0)))
    ways = [
        Phasors(
            banks.force.orders, banks.force.forward[:, k], banks.force.backward[:, k], np.zeros(1)
        ).values(FINE)
        for k in shown
    ]
    limit = plane(ax, ways, "force", s)
    for side, k, way, shade in zip(
        cycle((1, -1)), shown, ways, np.linspace(0.25, 1, len(shown)), strict=False
    ):
        ax.plot(way.imag / s.size, way.real / s.size, color=BLUE, alpha=shade, linewidth=1.2)
        far = np.abs(way) > (1 - 1e-6) * np.abs(way).max(initial=0)  # labels to either side in turn
        tip = max(way[far] / s.size, key=lambda v: side * (v.real + v.imag), default=0j)
        out = tip / abs(tip) if abs(tip) > 0.02 * limit else 1
        spot = tip + 0.07 * limit * out
        ax.text(
            spot.imag, spot.real, f"{banks.angles_deg[k]:g}°", ha="center", va="center", fontsize=7
        )
    ax.set_title(f"Force of order {banks.order}: way of its tip by bank angle", pad=6)


def roses(ax: Any, banks: Banks, unit: Unit) -> None:
    """Both vectors as radii in the directions of the two banks: what a pair of shafts has to turn,
    and their places.
    """
    from matplotlib.ticker import MaxNLocator

    ahead, against = np.abs(banks.force.forward[0]), np.abs(banks.force.backward[0])
    s = scale(unit, float(max(ahead.max(), against.max())))
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

"""The way of a vector's tip over a revolution."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...core.phasors import Complex, Phasors
from ..sheet import NOTHING, size_text
from ..units import ShownUnit
from ..view import VISIBLE
from .axes import overlap, set_up_plane
from .legends import put_legend_above
from .style import BLUE, INK, PAPER, SOFT

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def draw_locus(
    ax: Axes, curve: Phasors, what: str, unit: ShownUnit, before: Phasors | None = None
) -> None:
    """Draw where the tip of the vector goes in a revolution, with crank angles along it; dashed a
    second locus to compare with.
    """
    values, old = _values_once(curve), None if before is None else _values_once(before)
    s = unit.fit(max(np.abs(v).max(initial=0) for v in (values, old) if v is not None))
    limit = set_up_plane(ax, [values, old], what, s)
    if old is not None:
        ax.plot(
            old.imag / s.size,
            old.real / s.size,
            color=SOFT,
            linewidth=1,
            linestyle=(0, (4, 2)),
            label="before",
        )
    ax.plot([], [], color=BLUE, label="after")
    if old is not None:
        put_legend_above(ax)
    largest = float(np.abs(values).max())
    if largest < 0.15 * limit * s.size:  # crank angles would lie on one another
        if largest < 0.02 * limit * s.size:
            ax.plot(0, 0, "o", color=BLUE, markersize=4)
        else:
            ax.plot(values.imag / s.size, values.real / s.size, color=BLUE)
        told = f"at most {size_text(largest, unit, 3)}" if largest else NOTHING
        ax.text(
            0,
            largest / s.size + 0.06 * limit,
            told,
            ha="center",
            va="bottom",
            bbox={"facecolor": PAPER, "edgecolor": "none", "pad": 1},
        )
        return
    ax.plot(values.imag / s.size, values.real / s.size, color=BLUE)
    _mark_crank_angles(ax, curve, s, limit)


def _values_once(curve: Phasors) -> Complex:
    """Values along the locus, no part twice: dashes over one another would make a full line."""
    return curve.values(np.radians(np.arange(find_period_deg(curve) + 1)))


def _mark_crank_angles(ax: Axes, curve: Phasors, s: ShownUnit, limit: float) -> None:
    """Draw dots at every twelfth of the period, and crank angles at every second one, on the outer
    side of the curve.
    """
    period = find_period_deg(curve)
    marks = np.arange(12) * period / 12
    n = curve.orders
    slope = Phasors.of(n, 1j * n * curve.forward, -1j * n * curve.backward, n * curve.noise)
    at, along = curve.values(np.radians(marks)), slope.values(np.radians(marks))
    ax.plot(at.imag / s.size, at.real / s.size, "o", color=BLUE, markersize=2.6)
    side = -1 if _turning(curve) >= 0 else 1  # left or right of the way, in x up and y right
    written: list[complex] = []
    for mark, place, way in zip(marks[::2], at[::2], along[::2], strict=True):
        normal = 1j * side * way if abs(way) > 0.05 * np.abs(along).max(initial=0) else place
        out = normal / abs(normal) if abs(normal) else 1
        spot = place / s.size + 0.085 * limit * out
        if any(overlap(spot - other, limit) for other in written):
            continue
        ax.text(spot.imag, spot.real, f"{mark:g}°", ha="center", va="center", fontsize=7, color=INK)
        written.append(spot)
    _draw_arrow(ax, curve.values(np.radians([0.04 * period, 0.055 * period])) / s.size, limit)


def _draw_arrow(ax: Axes, step: Complex, limit: float) -> None:
    """Draw which way the tip goes, from the first place to the second."""
    way = step[1] - step[0]
    if abs(way) > 1e-4 * limit:
        tip = step[0] + way / abs(way) * 0.02 * limit
        ax.annotate(
            "",
            (tip.imag, tip.real),
            (step[0].imag, step[0].real),
            arrowprops={"arrowstyle": "-|>", "color": BLUE, "linewidth": 1.2, "mutation_scale": 13},
        )


def find_period_deg(curve: Phasors) -> int:
    """The crank angle after which the curve repeats itself, as far as can be seen."""
    seen = curve.orders[curve.major > VISIBLE * curve.major.max(initial=0)]
    repeats = int(np.gcd.reduce((2 * seen).astype(int), initial=0))  # in two revolutions
    return 720 // min(repeats, 24) if repeats else 360


def _turning(curve: Phasors) -> float:
    """Twice the area inside the locus, positive if it is run through with the crank."""
    return float((curve.orders * (np.abs(curve.forward) ** 2 - np.abs(curve.backward) ** 2)).sum())

"""Pressure, torque over the cycle, and polar diagrams of loads, of an engine with gas."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...core.phasors import Array, Complex
from ...torque.pictures import MainLoads, PinLoads, Pressures, Torques
from ..units import ShownUnit, System
from .charts import set_crank_axis
from .plane import draw_path, set_up_plane
from .style import BLUE, GREEN, INK, RED, SOFT, put_legend_above

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_COLUMNS = 7  # polar diagrams side by side


def draw_pressure(ax: Axes, found: Pressures, unit: ShownUnit) -> None:
    """Draw pressure over the cycle angle."""
    s = unit.fit(float(found.pressure.max()))
    ax.plot(found.cycle_deg, found.pressure / s.size, color=BLUE)
    ax.axvline(0, color=SOFT, linewidth=0.7)
    set_crank_axis(ax, found.cycle_deg, "cycle angle from the firing dead centre, deg")
    ax.set(ylim=(0, None), ylabel=f"pressure, {s.name}")
    ax.set_title("Pressure in cylinder 1")


def draw_p_v(ax: Axes, found: Pressures, system: System) -> None:
    """Draw pressure over volume."""
    s = system.pressure.fit(float(found.pressure.max()))
    v = system.volume.fit(float(found.volume.max()))
    ax.plot(found.volume / v.size, found.pressure / s.size, color=BLUE)
    base = "" if found.clearance_known else " above the smallest"
    ax.set(xlim=(0, None), ylim=(0, None), ylabel=f"pressure, {s.name}")
    ax.set_xlabel(f"volume{base}, {v.name}")
    ax.set_title("Indicator diagram of cylinder 1")


def draw_torque(ax: Axes, found: Torques, unit: ShownUnit) -> None:
    """Draw gas, inertia and total torque, the surplus areas above and below the mean, and where the
    crank is slowest and fastest.
    """
    s = unit.fit(float(np.abs(found.total).max()))
    crank, total, mean = found.crank_deg, found.total / s.size, found.mean / s.size
    ax.fill_between(crank, total, mean, where=total >= mean, color=BLUE, alpha=0.18, linewidth=0)
    ax.fill_between(crank, total, mean, where=total <= mean, color=RED, alpha=0.18, linewidth=0)
    ax.plot(crank, found.gas / s.size, color=GREEN, linewidth=1, linestyle="--", label="gas")
    ax.plot(crank, found.inertia / s.size, color=RED, linewidth=1, linestyle=":", label="inertia")
    ax.plot(crank, total, color=INK, label="total")
    ax.axhline(mean, color=SOFT, linewidth=0.9, label="mean")
    set_crank_axis(ax, crank)
    ax.set_ylabel(f"torque, {s.name}")
    for angle, word, marker in (
        (found.surplus.start, "slowest", "v"),
        (found.surplus.end, "fastest", "^"),
    ):
        at = float(np.degrees(angle)) % crank[-1]
        side = "right" if at > 0.8 * crank[-1] else "left"
        ax.plot([at], [mean], marker, color=INK, markersize=5)
        ax.text(at, mean, f" {word} ", ha=side, va="bottom", fontsize=7)
    ax.set_title("Torque on the crank")
    put_legend_above(ax)


def draw_pin(fig: Figure, found: PinLoads, unit: ShownUnit) -> None:
    """Draw the load of crank pin 1 as the crank feels it, and as the rod does."""
    left, right = fig.subplots(1, 2)
    limit = float(np.abs(found.in_crank).max())
    _draw_polar(left, found.in_crank, found.crank_deg, unit, limit)
    left.set_title(f"Crank pin of cylinder {found.cylinder}, on the crank", pad=6)
    left.set(xlabel="ahead of the throw", ylabel="along the throw, outward")
    _draw_polar(right, found.in_rod, found.crank_deg, unit, limit)
    right.set_title("The same, seen from the rod", pad=6)
    right.set(xlabel="across the rod", ylabel="along the rod, to the piston")


def draw_main(fig: Figure, found: MainLoads, unit: ShownUnit) -> None:
    """Draw the load of every main bearing as the block feels it, and as the shaft does."""
    count = len(found.in_block)
    columns = min(count, _COLUMNS)
    rows = -(-count // columns)
    fig.set_size_inches(0.4 + 2.6 * columns, 0.6 + 5.6 * rows)
    limit = float(np.abs(found.in_block).max())
    for side, (loads, body) in enumerate(((found.in_block, "block"), (found.in_shaft, "shaft"))):
        for k in range(count):
            place = (2 * (k // columns) + side) * columns + k % columns + 1
            ax = fig.add_subplot(2 * rows, columns, place)
            _draw_polar(ax, loads[k], found.crank_deg, unit, limit)
            ax.set_title(f"Main bearing {k + 1}, {body}", pad=6)


def _draw_polar(
    ax: Axes, force: Complex, crank_deg: Array, unit: ShownUnit, largest: float
) -> None:
    """Draw the path of a force's tip, x up and y to the right; `largest` of all its pictures, N."""
    s = unit.fit(largest)
    limit = set_up_plane(ax, largest / s.size, "", "")
    draw_path(ax, force / s.size, crank_deg, 45, limit)
    ax.text(0.98, 0.02, s.name, transform=ax.transAxes, ha="right", va="bottom", fontsize=7)

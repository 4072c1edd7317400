"""Pressure, torque over the cycle, and polar diagrams of loads, of an engine with gas."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...core.phasors import Array, Complex
from ...core.speed_variation import Surplus
from ...torque.pictures import MainLoads, PinLoads, Pressures, Torques
from ..units import ShownUnit, System
from .axes import overlap
from .legends import put_legend_above
from .style import BLUE, FAINT, GREEN, INK, RED, SOFT

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_MARKS = 8  # crank angles that are told along a locus, in a revolution
_COLUMNS = 7  # of polar diagrams side by side


def draw_pressure(ax: Axes, found: Pressures, unit: ShownUnit) -> None:
    """Draw pressure over the cycle angle."""
    s = unit.fit(float(found.pressure.max()))
    ax.plot(found.cycle_deg, found.pressure / s.size, color=BLUE)
    ax.axvline(0, color=SOFT, linewidth=0.7)
    first, last = (round(float(v)) for v in found.cycle_deg[[0, -1]])
    ax.set(
        xlim=(first, last),
        xticks=np.arange(first, last + 1, (last - first) // 8),
        ylim=(0, None),
        xlabel="cycle angle from the firing dead centre, deg",
        ylabel=f"pressure, {s.name}",
    )
    ax.set_title("Pressure in cylinder 1")


def draw_p_v(ax: Axes, found: Pressures, system: System) -> None:
    """Draw pressure over volume."""
    s = system.pressure.fit(float(found.pressure.max()))
    v = system.volume.fit(float(found.volume.max()))
    ax.plot(found.volume / v.size, found.pressure / s.size, color=BLUE)
    beside = "" if found.clearance_known else " above the smallest"
    ax.set(xlim=(0, None), ylim=(0, None), ylabel=f"pressure, {s.name}")
    ax.set_xlabel(f"volume{beside}, {v.name}")
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
    cycle = round(float(crank[-1]))
    ax.set(
        xlim=(0, cycle),
        xticks=np.arange(0, cycle + 1, cycle // 8),
        xlabel="crank angle, deg",
        ylabel=f"torque, {s.name}",
    )
    _mark_speeds(ax, found.surplus, cycle, mean)
    ax.set_title("Torque on the crank", pad=18)
    put_legend_above(ax)


def _mark_speeds(ax: Axes, surplus: Surplus, cycle: int, mean: float) -> None:
    marks = ((surplus.start, "slowest", "v"), (surplus.end, "fastest", "^"))
    for angle, word, marker in marks:
        at = float(np.degrees(angle)) % cycle
        ax.plot([at], [mean], marker=marker, color=INK, markersize=5, linestyle="none")
        beside = "right" if at > 0.8 * cycle else "left"
        ax.annotate(
            word,
            (at, mean),
            xytext=(4 if beside == "left" else -4, 5),
            textcoords="offset points",
            ha=beside,
            fontsize=7,
        )


def draw_pin(fig: Figure, found: PinLoads, unit: ShownUnit) -> None:
    """Draw the load of crank pin 1 as the crank feels it, and as the rod does."""
    left, right = fig.subplots(1, 2)
    _draw_polar(left, found.in_crank, found.crank_deg, unit)
    left.set_title(f"Crank pin of cylinder {found.cylinder}, on the crank")
    left.set(xlabel="ahead of the throw", ylabel="along the throw, outward")
    _draw_polar(right, found.in_rod, found.crank_deg, unit)
    right.set_title("The same, seen from the rod")
    right.set(xlabel="across the rod", ylabel="along the rod, to the piston")


def draw_main(fig: Figure, found: MainLoads, unit: ShownUnit) -> None:
    """Draw the load of every main bearing as the block feels it, and as the shaft does."""
    count = len(found.in_block)
    columns = min(count, _COLUMNS)
    rows = -(-count // columns)
    fig.set_size_inches(0.4 + 2.6 * columns, 0.6 + 5.6 * rows)
    axes = fig.subplots(2 * rows, columns, squeeze=False)
    for ax in axes.flat:
        ax.set_axis_off()
    limit = 1.1 * float(np.abs(found.in_block).max())
    for k in range(count):
        for side, loads, where in ((0, found.in_block, "block"), (1, found.in_shaft, "shaft")):
            ax = axes[2 * (k // columns) + side, k % columns]
            ax.set_axis_on()
            _draw_polar(ax, loads[k], found.crank_deg, unit, limit)
            ax.set_title(f"Main bearing {k + 1}, {where}")


def _draw_polar(
    ax: Axes, force: Complex, crank_deg: Array, unit: ShownUnit, limit: float | None = None
) -> None:
    """Draw the way of a force's tip, x up and y to the right, with crank angles along it."""
    half = 1.1 * float(np.abs(force).max()) if limit is None else limit
    s = unit.fit(half)
    values = force / s.size
    ax.axhline(0, color=FAINT, linewidth=0.8)
    ax.axvline(0, color=FAINT, linewidth=0.8)
    ax.plot(values.imag, values.real, color=BLUE, linewidth=1.1)
    side = half / s.size
    ax.set(xlim=(-side, side), ylim=(-side, side), aspect="equal")
    ax.locator_params(nbins=5)
    step, written = 360 // _MARKS, list[complex]()
    for mark in range(0, round(float(crank_deg[-1])), step):
        at = int(np.argmin(np.abs(crank_deg - mark)))
        ax.plot(values.imag[at], values.real[at], "o", color=BLUE, markersize=2.2)
        near = any(overlap(complex(values[at]) - other, side) for other in written)
        if mark % (2 * step) == 0 and not near:
            written.append(complex(values[at]))
            ax.annotate(
                f"{mark}°",
                (values.imag[at], values.real[at]),
                xytext=(3, 3),
                textcoords="offset points",
                fontsize=6,
                color=SOFT,
            )
    ax.text(0.98, 0.02, s.name, transform=ax.transAxes, ha="right", va="bottom", fontsize=7)

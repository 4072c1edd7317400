"""Draw the figures of an analysis: bars by order, curves over crank angle and balance factor, and
values along the crankshaft.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import cycle as repeat
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from ..core.phasors import Array, Phasors, unit as unit_vector
from ..engine.engine import Engine, find_row
from ..forces.crankshaft import AlongCrank
from ..show.plot_style import (
    BLUE,
    GREEN,
    INK,
    MANY_LOOKS,
    PAPER,
    RED,
    SOFT,
    Look,
    put_legend_above,
)
from ..show.sheet import VISIBLE, number, order_name, size_text
from ..show.units import ShownUnit, System
from ..sizing.bobweights import FactorPeaks
from .crank_drive import CrankTorques, weigh_cylinders
from .curves import compute_curves_by_step, compute_cylinder_curves
from .order_tables import fit_largest
from .piston import choose_cylinder, choose_unit, piston

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


_LOOKS = ((BLUE, "-", ""), (RED, (0, (5, 1.5)), "////"), (GREEN, (0, (1.5, 1)), "...."))
_DASHED: Look = {"color": SOFT, "linewidth": 1.1, "linestyle": (0, (4, 2))}


def draw_vector_bars(
    ax: Axes, curve: Phasors, what: str, unit: ShownUnit, before: Phasors | None = None
) -> None:
    """Draw the largest value of each order as a bar of two parts: the vector that turns with the
    crank, and on top of it the vector that turns against the crank.

    Args:
        ax: Axes to draw on.
        curve: Phasors of the vector, shape (orders,).
        what: Name of the quantity.
        unit: Unit of the quantity.
        before: Phasors of the same orders before balancing, whose largest values are drawn dashed;
            None if there are none.
    """
    shown = visible_rows(curve, before)
    s = fit_largest(unit, *(p for p in (curve, before) if p is not None))
    ahead = np.abs(curve.forward[shown]) / s.size
    against = np.abs(curve.backward[shown]) / s.size
    places = np.arange(len(shown))
    if before is not None:
        look: Look = {"facecolor": "none", "edgecolor": SOFT, "linestyle": (0, (3, 2))}
        ax.bar(places, before.major[shown] / s.size, 0.72, label="before", **look)
    ax.bar(places, ahead, 0.56, color=BLUE, label="with the crank")
    upper = ax.bar(places, against, 0.56, bottom=ahead, color=RED, hatch="////", label="against it")
    labels = [number(float(top), 3) for top in ahead + against]
    ax.bar_label(upper, labels, padding=2, fontsize=7)
    _finish_bars(ax, curve.orders[shown], f"{what}, {s.name}")


def draw_scalar_bars(ax: Axes, curves: Mapping[str, Phasors], unit: ShownUnit) -> None:
    """Draw the amplitudes of several moments about the crank, side by side.

    Args:
        ax: Axes to draw on.
        curves: Phasors by label, all with the same orders.
        unit: Unit of the moments.
    """
    shown = sorted({k for curve in curves.values() for k in visible_rows(curve)})
    s = fit_largest(unit, *curves.values())
    for (label, curve), look, shift in zip(curves.items(), _LOOKS, (-0.27, 0, 0.27), strict=False):
        sizes = curve.major[shown] / s.size
        places = np.arange(len(shown)) + shift
        ax.bar(places, sizes, 0.25, color=look[0], hatch=look[2], label=label)
    _finish_bars(ax, next(iter(curves.values())).orders[shown], f"moment, {s.name}")


def visible_rows(curve: Phasors, before: Phasors | None = None) -> list[int]:
    """Return the row numbers of orders 1 and 2 and of orders large enough to be seen; at most ten.

    Args:
        curve: Phasors, shape (orders,).
        before: Phasors of the same orders that are drawn as well; None if there are none.
    """
    major = curve.major if before is None else np.maximum(curve.major, before.major)
    always = (curve.orders == 1) | (curve.orders == 2)
    due = np.flatnonzero(always | (major > VISIBLE * major.max(initial=0)))
    return sorted(due[np.argsort(-major[due], kind="stable")[:10]].tolist())


def _finish_bars(ax: Axes, orders: Array, label: str) -> None:
    ax.set_xticks(np.arange(len(orders)), [order_name(n) for n in orders])
    ax.set(xlabel="order", ylabel=label, xlim=(-0.6, len(orders) - 0.4))
    ax.grid(False, axis="x")
    ax.locator_params(axis="y", nbins=4)
    ax.set_ylim(0, 1.35 * ax.dataLim.y1 or 1)
    put_legend_above(ax)


def draw_curves(
    ax: Axes,
    crank: Array,
    lines: Mapping[str, Array],
    what: str,
    unit: ShownUnit,
    dashed: Mapping[str, Array] = MappingProxyType({}),
) -> None:
    """Draw values over the crank angle.

    Args:
        ax: Axes to draw on.
        crank: Crank angles, rad, shape (angles,).
        lines: Values by label, each of shape (angles,).
        what: Name of the quantity.
        unit: Unit of the quantity.
        dashed: Further values by label, drawn dashed, such as those before balancing.
    """
    s = unit.fit(float(np.abs([*lines.values(), *dashed.values()]).max()))
    crank = np.degrees(crank)
    for label, line in dashed.items():
        ax.plot(crank, line / s.size, label=label, **_DASHED)
    for (label, line), look in zip(lines.items(), _LOOKS, strict=False):
        ax.plot(crank, line / s.size, color=look[0], linestyle=look[1], label=label)
    ax.axhline(0, color=SOFT, linewidth=0.7)
    set_crank_axis(ax, crank)
    ax.set_ylabel(f"{what}, {s.name}")
    ax.locator_params(axis="y", nbins=5)
    put_legend_above(ax)


def set_crank_axis(ax: Axes, crank_deg: Array, label: str = "crank angle, deg") -> None:
    """Make the crank angle the x axis, with ticks every 90 degrees.

    Args:
        ax: Axes to change.
        crank_deg: Crank angles that are drawn, deg, shape (angles,).
        label: Label of the axis.
    """
    first, last = (round(float(angle)) for angle in crank_deg[[0, -1]])
    ax.set(xlim=(first, last), xticks=np.arange(first, last + 1, 90), xlabel=label)


def draw_factors(
    ax: Axes, rows: Sequence[FactorPeaks], force: ShownUnit, moment: ShownUnit | None
) -> None:
    """Draw the largest force and its components over the balance factor, and the largest moment on
    a second axis.

    Args:
        ax: Axes to draw on.
        rows: Largest values by factor.
        force: Unit of forces.
        moment: Unit of moments; None if moments are not known.
    """
    share = [row.factor for row in rows]
    moments = np.array([row.peak_moment_Nm for row in rows])
    s = force.fit(max(row.peak_force_N for row in rows))
    forces = np.array([(row.peak_force_N, row.along_N, row.across_N) for row in rows]).T / s.size
    labels = ("force", "along the first bank", "across it")
    for values, label, look in zip(forces, labels, _LOOKS, strict=True):
        ax.plot(share, values, color=look[0], linestyle=look[1], label=label)
    best = min(rows, key=lambda row: row.cost)
    least = size_text(best.peak_force_N, force)
    if best.by_moment and moment is not None:
        least = f"moment {size_text(best.peak_moment_Nm, moment)}"
    ax.plot(best.factor, best.peak_force_N / s.size, "o", color=BLUE)
    ax.set(
        xlabel="balance factor: share of the reciprocating mass in the counterweights",
        ylabel=f"largest over a revolution, {s.name}",
        xlim=(share[0], share[-1]),
        ylim=(0, None),
        title=f"Largest free force over the balance factor; best at {best.factor:.4g} ({least})",
    )
    if moment is not None and moments.max() > 0:
        t = moment.fit(float(moments.max()))
        right = ax.twinx()
        right.plot(share, moments / t.size, **_DASHED)
        right.set(ylabel=f"moment (dashed grey), {t.name}", ylim=(0, None))
        right.grid(False)
    put_legend_above(ax)


def draw_along(
    ax: Axes, curves: Sequence[AlongCrank], what: str, system: System, steps: str, over: str
) -> None:
    """Draw the largest values at places along the crankshaft.

    Args:
        ax: Axes to draw on.
        curves: Loads; a second entry has the loads before balancing, drawn dashed.
        what: "force" or "moment".
        system: System of units.
        steps: matplotlib's drawstyle of the line between the places; empty: vertical lines.
        over: Span over which the largest values are taken, such as "the cycle".
    """
    unit = system.force if what == "force" else system.moment
    values = [np.array([peak.value for peak in curve.peaks]) for curve in curves]
    s = unit.fit(float(max(map(np.max, values))))
    now: Look = {"color": BLUE, "linewidth": 2.2, "zorder": 3}
    labels = ("after", "before") if len(curves) > 1 else (f"largest over {over}",)
    for curve, sizes, look, label in zip(curves, values, (now, _DASHED), labels, strict=False):
        z = curve.z_m / system.length.size
        ax.plot(z, sizes / s.size, "o", color=look["color"], markersize=4)
        if steps:
            ax.plot(z, sizes / s.size, drawstyle=steps, label=label, **look)
        else:
            ax.vlines(z, 0, sizes / s.size, label=label, **look)
    ax.set(ylabel=f"{what}, {s.name}", ylim=(0, None))
    put_legend_above(ax)


# ------------------------------------------------------------------ crank drive
_STEP = 0.5  # step of drawn crank angles, deg
_MOTIONS = {  # titles, by names of curves
    "travel_m": "Piston {}: travel from the outer dead centre",
    "velocity_m_per_s": "Velocity towards the crank",
    "acceleration_m_per_s2": "Acceleration towards the crank",
}
_FORCES = ("side thrust", "rod force")
_ON_PAPER = {"facecolor": PAPER, "edgecolor": "none", "pad": 0.5}


def draw_piston(fig: Figure, engine: Engine, number: int, system: System) -> None:
    """Draw travel, velocity and acceleration of a piston over the crank angle from the cylinder's
    axis. If the gas pressure is known, side thrust and rod force over the cycle are drawn below.

    Args:
        fig: Empty figure, whose height is set.
        engine: One engine, not an array of variants; the curves are those at its mean speed.
        number: Number of the cylinder.
        system: System of units.

    Raises:
        BalcliError: The engine has no such cylinder.
    """
    steady = replace(engine, ripple=())
    row = find_row(engine, number)
    motion = choose_cylinder(piston(steady), number).mechanisms[0]
    own_deg = np.arange(0.0, 360 + _STEP / 2, _STEP)
    turned = own_deg - float(np.ravel(engine.cylinders.angle_deg)[row])
    curves = compute_cylinder_curves(steady, number, turned)
    outer = motion.outer_dead_center_own_deg % 360
    inner = motion.inner_dead_center_own_deg
    v = motion.velocity
    a = motion.acceleration
    extremes = (
        ((inner, motion.stroke_m), (outer, 0.0)),
        ((v.max_own_deg, v.max_m_per_s), (v.min_own_deg, v.min_m_per_s)),
        ((a.max_own_deg, a.max_m_per_s2), (a.min_own_deg, a.min_m_per_s2)),
    )
    cycle = None if engine.gas is None else compute_curves_by_step(steady, number, _STEP)
    with_forces = cycle is not None and "rod_force_N" in cycle.curves
    count = 4 if with_forces else 3
    fig.set_figheight(0.6 + 2.4 * count)
    axes = fig.subplots(count, 1)
    for ax, (name, title), peaks in zip(axes, _MOTIONS.items(), extremes, strict=False):
        unit = choose_unit(name, system)
        points = [(angle, value / unit.size) for angle, value in peaks]
        _draw_motion(ax, own_deg, curves[name] / unit.size, points)
        for angle in (outer, inner):
            ax.axvline(angle, color=INK, linewidth=0.9, linestyle=":")
        ax.set(title=title.format(number), ylabel=unit.name)
    put_legend_above(axes[0])
    places = f"dead centres, {outer:.4g} and {inner:.4g}"
    axes[2].set_xlabel(f"crank angle from the cylinder's axis, deg; dotted: {places}")
    if cycle is not None and with_forces:
        forces = {name: cycle.curves[f"{name.replace(' ', '_')}_N"] for name in _FORCES}
        draw_curves(axes[3], np.radians(cycle.crank_deg), forces, "force", system.force)
        axes[3].set_title("Side thrust and rod force over the cycle")


def _draw_motion(
    ax: Axes, own_deg: Array, exact: Array, extremes: Sequence[tuple[float, float]]
) -> None:
    """Draw a motion over a revolution, its first two harmonics and, dashed, their sum with the
    mean; mark the highest and the lowest point.
    """
    mean, *waves = np.fft.rfft(exact[:-1], norm="forward")[:3]
    parts = [2 * (c * unit_vector(n * own_deg)).real for n, c in enumerate(waves, 1)]
    for order, (part, color) in enumerate(zip(parts, (RED, GREEN), strict=True), 1):
        ax.plot(own_deg, part, color=color, linewidth=0.9, label=f"order {order}")
    dashed = _DASHED | {"color": INK, "linewidth": 0.9, "zorder": 3}
    ax.plot(own_deg, mean.real + sum(parts), label="mean and orders 1, 2", **dashed)
    ax.plot(own_deg, exact, color=BLUE, linewidth=2.2, label="exact")
    for (angle, value), side in zip(extremes, (1, -1), strict=True):
        beside = (angle < 20) - (angle > 340)  # inwards from an edge of the picture
        ax.plot([angle], [value], "o", color=INK, markersize=4, zorder=4)
        shift = (6 * beside, 9 * side)
        align = ("center", "left", "right")[beside]
        label: Look = {"xytext": shift, "textcoords": "offset points", "ha": align, "va": "center"}
        ax.annotate(number(value), (angle, value), fontsize=7.5, bbox=_ON_PAPER, **label)
    ax.axhline(0, color=SOFT, linewidth=0.7)
    ax.margins(y=0.2)
    ax.locator_params(axis="y", nbins=6)
    set_crank_axis(ax, own_deg, "")


def draw_journals(fig: Figure, engine: Engine, unit: ShownUnit) -> None:
    """Draw the torque in every main journal over the cycle, at the mean speed.

    Args:
        fig: Empty figure.
        engine: One engine, not an array of variants.
        unit: Unit of the torques.

    Raises:
        BalcliError: The crank of a rotary engine stands still.
    """
    cycle_deg = 360.0 if engine.gas is None else engine.gas.cycle_deg
    degrees = np.arange(0.0, cycle_deg + _STEP / 2, _STEP)
    torques = CrankTorques.of(engine)
    angle = np.radians(degrees)
    curves = {
        f"main {place}": torques.sample(angle, weights)
        for (kind, place), weights in weigh_cylinders(engine).items()
        if kind == "main"
    }
    ax = fig.subplots()
    s = unit.fit(max(float(np.abs(each).max()) for each in curves.values()))
    for (place, curve), (line, color) in zip(curves.items(), repeat(MANY_LOOKS), strict=False):
        ax.plot(degrees, curve / s.size, linestyle=line, color=color, label=place)
    set_crank_axis(ax, degrees)
    what = "inertia" if engine.gas is None else "gas and inertia"
    ax.set(ylabel=f"torque, {s.name}", title=f"Torque of {what} in the main journals")
    ax.legend(loc="center left", bbox_to_anchor=(1, 0.5))

"""Draw the figures of an analysis: bars by order, curves over crank angle and balance factor, and
values along the crankshaft.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import cycle as repeat
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..core.phasors import Array, Phasors, unit as unit_vector
from ..engine.engine import Engine, find_row
from ..forces.crankshaft import AlongCrank
from ..forces.kinds import COUPLE, GAS, ROLL, ROLL_TOTAL, TORQUE, Kind
from ..show.plot_style import (
    BEFORE,
    BLUE,
    COUPLE as COUPLE_COLOUR,
    GAS as GAS_COLOUR,
    INK,
    MANY_LOOKS,
    PAPER,
    SOFT,
    TORQUE as TORQUE_COLOUR,
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


class _CurveLook(NamedTuple):
    """Colour, line style and hatch of a curve."""

    colour: str
    line: str | tuple[float, tuple[float, ...]]
    hatch: str = ""

    @property
    def of_line(self) -> Look:
        """Arguments of matplotlib for a line."""
        return {"color": self.colour, "linestyle": self.line}


_LONG_DASHES = (0, (5, 1.5))
# A component, the other one, and their sum.
_COMPONENTS = (_CurveLook(BLUE, "-"), _CurveLook(BLUE, _LONG_DASHES), _CurveLook(INK, "-"))
_OF_KIND = {  # moments about the crank
    COUPLE: _CurveLook(COUPLE_COLOUR, (0, (1.5, 1)), "...."),
    TORQUE: _CurveLook(TORQUE_COLOUR, _LONG_DASHES, "////"),
    GAS: _CurveLook(GAS_COLOUR, (0, (3, 1, 1, 1)), "xxxx"),
    ROLL: _CurveLook(INK, "-"),
    ROLL_TOTAL: _CurveLook(INK, "-"),
}
_DASHED: Look = {"color": BEFORE, "linewidth": 1.3, "linestyle": (0, (4, 2))}
_LETTER = 0.018  # width of a letter above a bar, as a share of the axis
_MOST_TICKS = 12  # numbers on an axis of orders


def draw_vector_bars(
    ax: Axes, curve: Phasors, quantity: str, unit: ShownUnit, before: Phasors | None = None
) -> None:
    """Draw the largest value of each order as a bar of two parts: the vector that turns with the
    crank, and on top of it the vector that turns against the crank.

    Args:
        ax: Axes to draw on.
        curve: Phasors of the vector, shape (orders,).
        quantity: Name of the quantity.
        unit: Unit of the quantity.
        before: Phasors of the same orders before balancing, whose largest values are drawn dashed;
            None if there are none.
    """
    shown = visible_rows(curve, before)
    s = fit_largest(unit, *(p for p in (curve, before) if p is not None))
    ahead = np.abs(curve.forward[shown]) / s.size
    against = np.abs(curve.backward[shown]) / s.size
    orders = curve.orders[shown]
    gap = _find_gap(orders)
    if before is not None:
        look: Look = {"facecolor": "none", "edgecolor": BEFORE, "linestyle": (0, (3, 2))}
        ax.bar(orders, before.major[shown] / s.size, 0.72 * gap, label="before", **look)
    width = 0.56 * gap
    ax.bar(orders, ahead, width, color=BLUE, label="with the crank")
    ax.bar(orders, against, width, bottom=ahead, color=BLUE, hatch="////", label="against it")
    _finish_bars(ax, orders, f"{quantity}, {s.name}")
    _write_sizes(ax, orders, ahead + against)


def _write_sizes(ax: Axes, orders: Array, sizes: Array) -> None:
    """Write the size of each order above its bar; of two that would touch, only the larger one."""
    span = float(np.ptp(ax.get_xlim()))
    written: list[tuple[float, float]] = []  # places, and half the widths of their texts
    for k in np.argsort(-sizes, kind="stable"):
        text = number(float(sizes[k]), 3)
        place = float(orders[k])
        half = _LETTER * span * len(text) / 2
        is_free = all(abs(place - other) > half + taken for other, taken in written)
        if sizes[k] and is_free:
            look: Look = {"xytext": (0, 2), "textcoords": "offset points", "fontsize": 7}
            ax.annotate(text, (place, float(sizes[k])), ha="center", va="bottom", **look)
            written.append((place, half))


def draw_scalar_bars(ax: Axes, curves: Mapping[Kind, Phasors], unit: ShownUnit) -> None:
    """Draw the amplitudes of several moments about the crank, side by side.

    Args:
        ax: Axes to draw on.
        curves: Phasors by kind, all with the same orders.
        unit: Unit of the moments.
    """
    shown = sorted({k for curve in curves.values() for k in visible_rows(curve)})
    s = fit_largest(unit, *curves.values())
    orders = next(iter(curves.values())).orders[shown]
    gap = _find_gap(orders)
    for (kind, curve), shift in zip(curves.items(), (-0.27, 0, 0.27), strict=True):
        look = _OF_KIND[kind]
        look_of_bar: Look = {"color": look.colour, "hatch": look.hatch, "label": kind.label}
        ax.bar(orders + gap * shift, curve.major[shown] / s.size, 0.25 * gap, **look_of_bar)
    _finish_bars(ax, orders, f"moment, {s.name}")


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
    set_order_axis([ax], orders)
    ax.set(xlabel="order", ylabel=label)
    ax.grid(False, axis="x")
    ax.locator_params(axis="y", nbins=4)
    ax.set_ylim(0, 1.35 * ax.dataLim.y1 or 1)
    put_legend_above(ax)


def _find_gap(orders: Array) -> float:
    """Return the distance between neighbouring orders: 1, or 1/2 with half orders."""
    return 0.5 if np.any(orders % 1) else 1.0


def set_order_axis(axes: Sequence[Axes], orders: Array) -> None:
    """Make the order the axis of bars, from the lowest of these orders (1, or 1/2) to the highest.

    Args:
        axes: Axes of bars, which get the same ends, so that equal orders have equal places.
        orders: Orders in any of them.
    """
    gap = _find_gap(orders)
    highest = float(orders.max(initial=2.0))
    count = round((highest - gap) / gap) + 1
    step = gap * -(-count // _MOST_TICKS)
    even = np.arange(step, highest + gap / 2, step)
    away = np.abs(even[:, None] - orders).min(axis=1, initial=np.inf)
    ticks = np.union1d(orders, even[away >= step / 2])  # every bar has its order below it
    for ax in axes:
        ax.set_xticks(ticks, [order_name(n) for n in ticks])
        ax.set_xlim(0.4 * gap, highest + 0.6 * gap)


def draw_curves(
    ax: Axes,
    crank: Array,
    lines: Mapping[str, Array],
    quantity: str,
    unit: ShownUnit,
    dashed: Mapping[str, Array] = MappingProxyType({}),
    looks: Sequence[_CurveLook] = _COMPONENTS,
) -> None:
    """Draw values over the crank angle.

    Args:
        ax: Axes to draw on.
        crank: Crank angles, rad, shape (angles,).
        lines: Values by label, each of shape (angles,).
        quantity: Name of the quantity.
        unit: Unit of the quantity.
        dashed: Further values by label, drawn dashed, such as those before balancing.
        looks: Looks of the lines; default: two components, and their sum.
    """
    s = unit.fit(float(np.abs([*lines.values(), *dashed.values()]).max()))
    crank = np.degrees(crank)
    for label, line in dashed.items():
        ax.plot(crank, line / s.size, label=label, **_DASHED)
    for (label, line), look in zip(lines.items(), looks, strict=False):
        ax.plot(crank, line / s.size, label=label, **look.of_line)
    ax.axhline(0, color=SOFT, linewidth=0.7)
    set_crank_axis(ax, crank)
    ax.set_ylabel(f"{quantity}, {s.name}")
    ax.locator_params(axis="y", nbins=5)
    put_legend_above(ax)


def draw_scalars(
    ax: Axes,
    crank: Array,
    curves: Mapping[Kind, Phasors],
    unit: ShownUnit,
    dashed: Mapping[str, Array],
) -> None:
    """Draw moments about the crank over the crank angle, as `draw_curves`.

    Args:
        ax: Axes to draw on.
        crank: Crank angles, rad, shape (angles,).
        curves: Phasors by kind.
        unit: Unit of the moments.
        dashed: Further values by label.
    """
    lines = {kind.label: curve.values(crank).real for kind, curve in curves.items()}
    looks = [_OF_KIND[kind] for kind in curves]
    draw_curves(ax, crank, lines, "moment", unit, dashed, looks)


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
    s = force.fit_values(row.peak_force_N for row in rows)
    forces = np.array([(row.along_N, row.across_N, row.peak_force_N) for row in rows]).T / s.size
    labels = ("along the first bank", "across it", "force")
    for values, label, look in zip(forces, labels, _COMPONENTS, strict=True):
        ax.plot(share, values, label=label, **look.of_line)
    best = min(rows, key=lambda row: row.cost)
    least = size_text(best.peak_force_N, force)
    if best.by_moment and moment is not None:
        least = f"moment {size_text(best.peak_moment_Nm, moment)}"
    ax.plot(best.factor, best.peak_force_N / s.size, "o", color=INK)
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
    ax: Axes, curves: Sequence[AlongCrank], quantity: str, system: System, steps: str, over: str
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
    unit = system.force if quantity == "force" else system.moment
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
    ax.set(ylabel=f"{quantity}, {s.name}", ylim=(0, None))
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
    for order, (part, line) in enumerate(zip(parts, ("--", ":"), strict=True), 1):
        ax.plot(own_deg, part, line, color=BEFORE, linewidth=1.1, label=f"order {order}")
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
    s = unit.fit_values(float(np.abs(curve).max()) for curve in curves.values())
    for (place, curve), (line, color) in zip(curves.items(), repeat(MANY_LOOKS), strict=False):
        ax.plot(degrees, curve / s.size, linestyle=line, color=color, label=place)
    set_crank_axis(ax, degrees)
    what = "inertia" if engine.gas is None else "gas and inertia"
    ax.set(ylabel=f"torque, {s.name}", title=f"Torque of {what} in the main journals")
    ax.legend(loc="center left", bbox_to_anchor=(1, 0.5))

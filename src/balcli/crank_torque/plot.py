"""Draw the pages of an engine with gas: pressure, torque over the cycle, and polar diagrams.

Curves are computed every half degree over one cycle, at the mean speed.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ..analysis.plot import set_crank_axis
from ..core.phasors import Array, Complex, unit
from ..core.shaft_speed import surplus
from ..engine.engine import Engine
from ..forces.curves import find_torque_curves
from ..forces.loads_with_gas import compute_bearing_loads
from ..forces.rod_forces import compute_rod_forces, list_hung_rows
from ..forces.spectrum import take_gas
from ..show.plane import draw_path, set_up_plane
from ..show.plot_style import BLUE, GAS, INK, RED, SOFT, TORQUE, put_legend_above
from ..show.units import ShownUnit, System
from .answer import choose_firing_cylinder

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


_STEP = 0.5  # step of the crank angle, deg
_BESIDE = 1e-7  # distance of the points on both sides of a jump, deg
_COLUMNS = 7  # largest number of polar diagrams side by side


def draw_gas(fig: Figure, engine: Engine, page: str, system: System) -> None:
    """Draw a page of an engine with gas.

    Args:
        fig: Empty figure.
        engine: One engine, not an array of variants.
        page: Name of the page: pressure, p-v, torque, pin or main.
        system: Units.

    Raises:
        BalcliError: The engine has no gas, or lacks data for the page.
    """
    steady = replace(engine, ripple=())
    if page in ("pressure", "p-v"):
        _draw_pressure(fig.subplots(), steady, system, over_volume=page == "p-v")
    elif page == "torque":
        _draw_torque(fig.subplots(), steady, system.moment)
    elif page == "pin":
        _draw_pin(fig, steady, system.force)
    else:
        _draw_main(fig, steady, system.force)


def _divide(low: float, high: float, breaks: Array) -> Array:
    """Return angles of a cycle every half degree, and on both sides of each break."""
    inside = low + np.remainder(breaks - low, high - low)
    every = [np.arange(low, high + _STEP / 2, _STEP), inside - _BESIDE, inside + _BESIDE]
    found = np.sort(np.concatenate(every))
    return found[(found >= low) & (found <= high)]


def _draw_pressure(ax: Axes, engine: Engine, system: System, *, over_volume: bool) -> None:
    """Draw the pressure of a cylinder over the cycle angle, from one gas-exchange dead centre to
    the next, or over the volume.
    """
    gas = take_gas(engine)
    number = choose_firing_cylinder(engine)
    cylinder = gas.cylinders[engine.numbers.index(number)]
    half = gas.cycle_deg / 2
    angle = _divide(-half, half, np.degrees(cylinder.torque.breaks))
    at = np.radians(angle)
    ends = cylinder.torque.ends
    pressures = [cylinder.find_end_pressure(end, at) for end in ends]
    volumes = [cylinder.piston.end_volume(at, end) for end in ends]
    s = system.pressure.fit_values(float(pressure.max()) for pressure in pressures)
    v = system.volume.fit_values(float(volume.max()) for volume in volumes)
    looks = ((BLUE, "-"), (RED, "--"))
    for end, pressure, volume, (colour, style) in zip(
        ends, pressures, volumes, looks, strict=False
    ):
        x = volume / v.size if over_volume else angle
        label = f"{end.name} end"
        ax.plot(x, pressure / s.size, color=colour, linestyle=style, label=label)
    if len(ends) > 1:
        put_legend_above(ax)
    ax.set(ylim=(0, None), ylabel=f"pressure, {s.name}")
    if over_volume:
        base = " above the smallest" if any(end.clearance is None for end in ends) else ""
        title = f"Indicator diagram of cylinder {number}"
        ax.set(xlim=(0, None), xlabel=f"volume{base}, {v.name}", title=title)
    else:
        centre = "outer" if gas.has_pump_ends else "firing"
        ax.axvline(0, color=SOFT, linewidth=0.7)
        set_crank_axis(ax, angle, f"cycle angle from the {centre} dead centre, deg")
        ax.set_title(f"Pressure in cylinder {number}")


def _draw_torque(ax: Axes, engine: Engine, unit: ShownUnit) -> None:
    """Draw gas, inertia and total torque, the surplus areas above and below the mean, and the
    angles at which the crank is slowest and fastest.
    """
    curves = find_torque_curves(engine)
    crank = _divide(0.0, take_gas(engine).cycle_deg, np.degrees(curves.gas.breaks))
    torques = [curve.at(np.radians(crank)) for curve in (curves.gas, curves.total)]
    s = unit.fit(float(np.abs(torques[1]).max()))
    gas = torques[0] / s.size
    total = torques[1] / s.size
    mean = curves.total.mean / s.size
    ax.fill_between(crank, total, mean, where=total >= mean, color=BLUE, alpha=0.18, linewidth=0)
    ax.fill_between(crank, total, mean, where=total <= mean, color=RED, alpha=0.18, linewidth=0)
    ax.plot(crank, gas, color=GAS, linewidth=1, linestyle="--", label="gas")
    ax.plot(crank, total - gas, color=TORQUE, linewidth=1, linestyle=":", label="inertia")
    ax.plot(crank, total, color=INK, label="total")
    ax.axhline(mean, color=SOFT, linewidth=0.9, label="mean")
    set_crank_axis(ax, crank)
    ax.set(ylabel=f"torque, {s.name}", title="Torque on the crank")
    above = surplus(curves.total)
    for angle, word, marker in ((above.start, "slowest", "v"), (above.end, "fastest", "^")):
        at = float(np.degrees(angle)) % crank[-1]
        side = "right" if at > 0.8 * crank[-1] else "left"
        ax.plot([at], [mean], marker, color=INK, markersize=5)
        ax.text(at, mean, f" {word} ", ha=side, va="bottom", fontsize=7)
    put_legend_above(ax)


def _list_angles(engine: Engine) -> Array:
    return np.arange(0.0, take_gas(engine).cycle_deg + _STEP / 2, _STEP)


def _draw_pin(fig: Figure, engine: Engine, unit: ShownUnit) -> None:
    """Draw the load of a crank pin twice: relative to the crank (real part outward along the throw)
    and relative to the rod (real part towards the piston). The pin carries the rod of the cylinder
    that is shown by default; if that rod is articulated, it is the pin of its master rod.
    """
    first = engine.numbers.index(choose_firing_cylinder(engine))
    on_pin = (master for master, hung in list_hung_rows(engine).items() if first in hung)
    row = next(on_pin, first)
    angle = _list_angles(engine)
    forces = compute_rod_forces(engine, angle)
    pin = forces.pin[row]
    number = engine.numbers[row]
    limit = float(np.abs(pin).max())
    left, right = fig.subplots(1, 2)
    _draw_polar(left, pin / forces.throw[row], angle, unit, limit)
    left.set_title(f"Crank pin of cylinder {number}, seen from the crank", pad=6)
    left.set(xlabel="ahead of the throw", ylabel="along the throw, outward")
    _draw_polar(right, pin / forces.lean[row], angle, unit, limit)
    right.set_title("The same load, seen from the rod", pad=6)
    right.set(xlabel="across the rod", ylabel="along the rod, to the piston")


def _draw_main(fig: Figure, engine: Engine, force: ShownUnit) -> None:
    """Draw the load of every main bearing relative to the block and relative to the shaft."""
    angle = _list_angles(engine)
    in_block = compute_bearing_loads(engine, angle)
    columns = min(len(in_block), _COLUMNS)
    rows = -(-len(in_block) // columns)
    fig.set_size_inches(0.4 + 2.6 * columns, 0.6 + 5.6 * rows)
    limit = float(np.abs(in_block).max())
    for side, (loads, body) in enumerate(((in_block, "block"), (in_block * unit(-angle), "shaft"))):
        for k, load in enumerate(loads):
            place = (2 * (k // columns) + side) * columns + k % columns + 1
            ax = fig.add_subplot(2 * rows, columns, place)
            _draw_polar(ax, load, angle, force, limit)
            ax.set_title(f"Main bearing {k + 1}, {body}", pad=6)


def _draw_polar(
    ax: Axes, force: Complex, crank_deg: Array, unit: ShownUnit, largest: float
) -> None:
    """Draw the path of a force's tip, x up and y to the right; `largest` (N) is the largest force
    of all pictures that share the scale.
    """
    s = unit.fit(largest)
    limit = set_up_plane(ax, largest / s.size)
    draw_path(ax, force / s.size, crank_deg, 45, limit)
    ax.text(0.98, 0.02, s.name, transform=ax.transAxes, ha="right", va="bottom", fontsize=7)

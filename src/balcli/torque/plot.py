"""Pictures of an engine with gas: pressure, torque over the cycle, and polar diagrams of loads.

Curves are computed at close angles over one cycle.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np

from ..analysis.plot import set_crank_axis
from ..core.phasors import Array, Complex, unit
from ..core.speed_ripple import Surplus, surplus
from ..engine.engine import Engine
from ..forces.curves import find_torque_curves
from ..forces.rod_forces import compute_rod_forces, list_hung_rows
from ..forces.spectrum import take_gas
from ..show.plane import draw_path, set_up_plane
from ..show.plot_style import BLUE, GREEN, INK, RED, SOFT, put_legend_above
from ..show.units import ShownUnit, System
from .loads import find_bearing_loads

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


PAGES = ("pressure", "p-v", "torque", "pin", "main")
_STEP = 0.5  # deg
_BESIDE = 1e-7  # deg, on both sides of a jump


class Pressures(NamedTuple):
    """Pressure that counts in cylinder 1 over its cycle, each of shape (angles,).

    Attributes:
        cycle_deg: from one gas-exchange dead centre to the next, 0 at firing.
        pressure: Pa.
        volume: m3; above the smallest volume if the clearance is not known.
        clearance_known: whether the compression ratio is given.
    """

    cycle_deg: Array
    pressure: Array
    volume: Array
    clearance_known: bool


class Torques(NamedTuple):
    """Torque over a cycle, N m, each of shape (angles,), its mean and the surplus above that."""

    crank_deg: Array
    gas: Array
    inertia: Array
    total: Array
    mean: float
    surplus: Surplus


class PinLoads(NamedTuple):
    """Force of the rod on cylinder 1's crank pin, N, shape (angles,).

    Attributes:
        crank_deg: crank angles.
        in_crank: force seen from the crank, real outward along the throw.
        in_rod: force seen from the rod, real towards the piston.
        cylinder: number of the cylinder whose rod it is: 1, or its master rod's.
    """

    crank_deg: Array
    in_crank: Complex
    in_rod: Complex
    cylinder: int


class MainLoads(NamedTuple):
    """Force of the shaft on each main bearing as block and shaft feel it, N, shape (bearings,
    angles).
    """

    crank_deg: Array
    in_block: Complex
    in_shaft: Complex


GasPicture: TypeAlias = Pressures | Torques | PinLoads | MainLoads  # what one of PAGES shows


def compute_picture(engine: Engine, what: str) -> GasPicture:
    """Return the curves of a page of `PAGES`, at the mean speed.

    Raises:
        BalcliError: the engine has no gas, or lacks what the page shows.
    """
    compute: dict[str, Callable[[Engine], GasPicture]] = {
        "torque": _find_torques,
        "pin": _find_pin,
        "main": _find_main,
    }
    return compute.get(what, _find_pressures)(replace(engine, ripple=()))


def _find_pressures(engine: Engine) -> Pressures:
    gas = take_gas(engine)
    cylinder = gas.cylinders[engine.numbers.index(1)]
    half = gas.cycle_deg / 2
    angle = _divide(-half, half, np.degrees(cylinder.torque.breaks), gas.cycle_deg)
    at = np.radians(angle)
    known = gas.compression_ratio is not None
    volume = cylinder.piston.volume(at, gas.compression_ratio or math.inf)
    return Pressures(angle, cylinder.find_pressure(at), volume, known)


def _find_torques(engine: Engine) -> Torques:
    curves = find_torque_curves(engine)
    cycle = take_gas(engine).cycle_deg
    angle = _divide(0.0, cycle, np.degrees(curves.gas.breaks), cycle)
    at = np.radians(angle)
    gas, total = curves.gas.at(at), curves.total.at(at)
    return Torques(angle, gas, total - gas, total, curves.total.mean, surplus(curves.total))


def _find_pin(engine: Engine) -> PinLoads:
    first = engine.numbers.index(1)
    on_pin = (master for master, hung in list_hung_rows(engine).items() if first in hung)
    row = next(on_pin, first)
    angle = np.arange(0.0, take_gas(engine).cycle_deg + _STEP / 2, _STEP)
    found = compute_rod_forces(engine, angle)
    pin, number = found.pin[row], engine.numbers[row]
    return PinLoads(angle, pin / found.throw[row], pin / found.lean[row], number)


def _find_main(engine: Engine) -> MainLoads:
    angle = np.arange(0.0, take_gas(engine).cycle_deg + _STEP / 2, _STEP)
    loads = find_bearing_loads(engine)[1](angle)
    return MainLoads(angle, loads, loads * unit(-angle))


def _divide(low: float, high: float, breaks: Array, cycle: float) -> Array:
    """Return angles every half degree, and on both sides of each break."""
    inside = low + np.remainder(breaks - low, cycle)
    every = [np.arange(low, high + _STEP / 2, _STEP), inside - _BESIDE, inside + _BESIDE]
    found = np.sort(np.concatenate(every))
    return found[(found >= low) & (found <= high)]


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
    limit = set_up_plane(ax, largest / s.size)
    draw_path(ax, force / s.size, crank_deg, 45, limit)
    ax.text(0.98, 0.02, s.name, transform=ax.transAxes, ha="right", va="bottom", fontsize=7)

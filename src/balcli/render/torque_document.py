"""What a program reads of the torque on the crank, of an engine or of a given curve: JSON, and the
same figures as CSV.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from ..core.piecewise import PiecewiseCurve
from ..core.speed_variation import Surplus
from ..core.speeds import RPM
from ..forces.kinds import TORQUE_TOTAL
from ..torque.analysis import TorqueAnalysis, degrees_in_cycle
from ..torque.flywheel import Flywheel
from ..torque.given_curve import CurveAnalysis
from ..torque.loads import CycleLoad
from .csv import Rows
from .figures import (
    Entry,
    FigureRow,
    clean,
    kind_entries,
    order_entries,
    order_rows,
    scalar_entry,
    silent_entries,
)
from .sheet import order_number
from .units import System

Result = TorqueAnalysis | CurveAnalysis

# Endings of keys in JSON, by the units of CSV; a name in degrees or rpm says so in both.
_ENDINGS = {"N·m": "_Nm", "J": "_J", "Pa": "_Pa", "W": "_W", "kg·m²": "_kg_m2"}


class _Figure(NamedTuple):
    """A figure of the whole cycle.

    Attributes:
        part: what it is of: engine, torque, energy or flywheel.
        value: SI, degrees or rpm; words; or numbers of cylinders.
    """

    part: str
    name: str
    unit: str
    value: float | str | tuple[int, ...] | None

    @property
    def key(self) -> str:
        """In JSON."""
        return self.name + _ENDINGS.get(self.unit, "")

    def row(self, quantity: str, system: System) -> FigureRow:
        """In CSV."""
        value, unit = self.value, system.instead_of(self.unit)
        if isinstance(value, tuple):
            value = " ".join(map(str, value))
        elif isinstance(value, float):
            value = unit.of(value)
        return FigureRow(0, quantity, None, self.name, value, unit.name)


# ------------------------------------------------------------------ figures of the cycle
def _list_figures(result: Result) -> Iterator[_Figure]:
    """All that are known, but for loads and what goes by order."""
    if isinstance(result, CurveAnalysis):
        curve, cycle_deg = result.torque, float(np.degrees(result.torque.period))
        yield from _list_mean(result, cycle_deg)
    else:
        curve, cycle_deg = result.curves.total, float(result.cycle_deg)
        yield from _list_work(result)
    yield from _list_extremes(curve, cycle_deg)
    yield from _list_energy(result.surplus, cycle_deg)
    if result.flywheel is not None:
        yield from _list_flywheel(result.flywheel)


def _list_work(result: TorqueAnalysis) -> Iterator[_Figure]:
    yield _Figure("engine", "speed_rpm", "rpm", clean(result.engine.speed_rpm))
    for key, numbers in silent_entries(result.engine.silent).items():
        yield _Figure("engine", key, "", tuple(numbers))
    yield _Figure("engine", "cycle_deg", "deg", result.cycle_deg)
    yield _Figure("engine", "imep", "Pa", clean(result.imep))
    if result.bmep is not None:
        yield _Figure("engine", "bmep", "Pa", clean(result.bmep))
    if (highest := result.max_pressure) is not None:
        yield _Figure("engine", "max_pressure", "Pa", clean(highest.value))
        yield _Figure("engine", "max_pressure_deg", "deg", clean(np.degrees(highest.angle)))
    yield _Figure("engine", "mean_torque", "N·m", clean(result.mean_torque))
    yield _Figure("engine", "power", "W", clean(result.power))


def _list_mean(result: CurveAnalysis, cycle_deg: float) -> Iterator[_Figure]:
    speed, mean = result.shaft.mean_speed, result.torque.mean
    if speed is not None:
        yield _Figure("engine", "speed_rpm", "rpm", clean(speed / RPM))
    yield _Figure("engine", "cycle_deg", "deg", round_angle(cycle_deg))
    yield _Figure("engine", "mean_torque", "N·m", clean(mean))
    if speed is not None:
        yield _Figure("engine", "power", "W", clean(mean * speed))


def _list_extremes(torque: PiecewiseCurve, cycle_deg: float) -> Iterator[_Figure]:
    lowest, highest = torque.extremes()
    for name, extreme in (("max", highest), ("min", lowest)):
        at = clean(degrees_in_cycle(extreme.angle, cycle_deg))
        yield _Figure("torque", name, "N·m", clean(extreme.value))
        yield _Figure("torque", f"{name}_deg", "deg", at)
    yield _Figure("torque", "reversals", "", torque.reversals())


def _list_energy(surplus: Surplus, cycle_deg: float) -> Iterator[_Figure]:
    start, end = (degrees_in_cycle(angle, cycle_deg) for angle in (surplus.start, surplus.end))
    yield _Figure("energy", "surplus", "J", clean(surplus.energy))
    yield _Figure("energy", "from_deg", "deg", clean(start))
    yield _Figure("energy", "to_deg", "deg", clean(end))
    yield _Figure("energy", "work", "J", clean(surplus.work))


def _list_flywheel(flywheel: Flywheel) -> Iterator[_Figure]:
    speed = flywheel.speed
    figures = (
        ("inertia", "kg·m²", flywheel.mean),
        ("moving_parts", "kg·m²", flywheel.moving),
        ("fluctuation", "", speed and speed.fluctuation),
        ("fluctuation_small", "", speed and speed.small),
        ("needed", "kg·m²", flywheel.needed),
        ("speed_max_rpm", "rpm", speed and speed.highest.value / RPM),
        ("speed_min_rpm", "rpm", speed and speed.lowest.value / RPM),
    )
    for name, unit, value in figures:
        if value is not None:
            yield _Figure("flywheel", name, unit, clean(value))
    if flywheel.stall:
        yield _Figure("flywheel", "stall", "", flywheel.stall)


def round_angle(degrees: float) -> float | int:
    """To 1e-9 degrees, a whole one without a decimal point."""
    near = round(degrees, 9)
    return int(near) if near == int(near) else near


# ------------------------------------------------------------------ JSON
def document(result: Result) -> dict[str, Any]:
    """`balcli.torque/1`."""
    parts: defaultdict[str, dict[str, Any]] = defaultdict(dict)
    for figure in _list_figures(result):
        value = list(figure.value) if isinstance(figure.value, tuple) else figure.value
        parts[figure.part][figure.key] = value
    return {
        "format": "balcli.torque/1",
        **parts.pop("engine"),
        "torque": parts.pop("torque"),
        "orders": list(_list_orders(result)),
        **parts,
        **({} if isinstance(result, CurveAnalysis) else _load_entries(result)),
    }


def _list_orders(result: Result) -> Iterator[Entry]:
    if isinstance(result, CurveAnalysis):
        for order, entry in _curve_orders(result):
            yield {"order": order, "torque_Nm": entry}
        return
    single = order_entries(result.single)
    for entry, one in zip(order_entries(result.spectra), single, strict=True):
        yield entry | {"one_cylinder": {k: v for k, v in one.items() if k != "order"}}


def _curve_orders(result: CurveAnalysis) -> Iterator[tuple[float, Entry]]:
    """Each order of a given curve, and its figures as JSON has them."""
    for n, c in zip(result.orders, result.harmonics, strict=True):
        yield order_number(round(n, 9)), scalar_entry(c, n, bool(c == 0))


def _list_loads(result: TorqueAnalysis) -> Iterator[tuple[str, str, tuple[CycleLoad, ...]]]:
    """Kinds of loads that were asked for and are known, and what bears each of them."""
    told = result.loads
    pins = ("pin", "cylinder", told.pin), ("knuckle", "cylinder", told.knuckle)
    for kind, bearer, loads in (*pins, ("main", "bearing", told.main)):
        if loads is not None:
            yield kind, bearer, loads


def _load_entries(result: TorqueAnalysis) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for kind, bearer, loads in _list_loads(result):
        found[kind] = [_load_entry(bearer, load, result.cycle_deg) for load in loads]
    if result.loads.obstacle:
        found["obstacle"] = result.loads.obstacle
    return {"loads": found} if found else {}


def _load_entry(bearer: str, load: CycleLoad, cycle_deg: float) -> dict[str, Any]:
    entry: dict[str, Any] = {bearer: load.name}
    if bearer == "bearing":
        entry["position_mm"] = clean(load.z_m * 1e3)
    entry |= {
        "max_N": clean(load.largest.value),
        "max_deg": clean(degrees_in_cycle(load.largest.angle, cycle_deg)),
        "mean_N": clean(load.mean),
    }
    return entry if load.pressure is None else entry | {"pressure_Pa": clean(load.pressure)}


# ------------------------------------------------------------------ CSV
def rows(result: Result, system: System) -> Rows:
    """A figure a line, as of `analyze`; cylinder 0 is the engine, an empty order the cycle."""
    header = ("cylinder", "quantity", "order", "figure", "value", "unit")
    return Rows(header, _list_rows(result, system))


def _list_rows(result: Result, system: System) -> Iterator[FigureRow]:
    # An engine's torque by order is that of inertia here, as in `analyze`.
    whole = "torque" if isinstance(result, CurveAnalysis) else TORQUE_TOTAL.name
    for figure in _list_figures(result):
        yield figure.row(whole if figure.part == "torque" else figure.part, system)
    if isinstance(result, CurveAnalysis):
        for order, entry in _curve_orders(result):
            yield from order_rows("torque", order, entry, system.moment)
        return
    yield from _load_rows(result, system)
    for cylinder, spectra in ((0, result.spectra), (result.cylinder, result.single)):
        for kind, phasors in spectra.items():
            entries = kind_entries(kind, phasors)
            for order, entry in zip(spectra.orders, entries, strict=True):
                yield from order_rows(kind.name, order, entry, system.unit(kind), cylinder)


def _load_rows(result: TorqueAnalysis, system: System) -> Iterator[FigureRow]:
    """Pins by cylinder; bearings by their number, in place of an order."""
    unit, stress = system.force, system.stress
    for kind, bearer, loads in _list_loads(result):
        for load in loads:
            cylinder, number = (0, load.name) if bearer == "bearing" else (load.name, None)
            angle = clean(degrees_in_cycle(load.largest.angle, result.cycle_deg))
            at = cylinder, kind, number
            yield FigureRow(*at, "max", unit.of(load.largest.value), unit.name)
            yield FigureRow(*at, "max_deg", angle, "deg")
            yield FigureRow(*at, "mean", unit.of(load.mean), unit.name)
            if load.pressure is not None:
                yield FigureRow(*at, "pressure", stress.of(load.pressure), stress.name)
    if result.loads.obstacle:
        yield FigureRow(0, "main", None, "obstacle", result.loads.obstacle, "")

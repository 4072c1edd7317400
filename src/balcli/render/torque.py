"""What a person reads of the torque on the crank: of an engine, or of a given curve."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from ..core.piecewise import PiecewiseCurve
from ..core.speed_variation import Surplus
from ..core.speeds import RPM
from ..limits import MOST_HARMONICS_UNASKED
from ..torque.analysis import KINDS_OF_TORQUE, TorqueAnalysis, degrees_in_cycle
from ..torque.flywheel import Flywheel, Speed
from ..torque.given_curve import CurveAnalysis
from ..torque.loads import CycleLoad
from .engine_facts import list_silent, tell_speed, tell_strokes
from .figures import size_or_mean
from .order_tables import show_peak_deg
from .sheet import NAMELESS, Facts, Grid, Sheet, Text, degrees, given, number, order_name, size_text
from .torque_document import Result, document, round_angle, rows
from .units import ShownUnit, System

__all__ = ["document", "rows", "sheet"]

SAME_MEAN = 1e-6  # of the largest torque: figures of files are rounded
_NO_INERTIA = "The uneven speed is not known: no inertia is given ([crank] inertia, [flywheel])."


def sheet(result: Result, system: System) -> Sheet:
    """Work, torque over the cycle, flywheel, and torque by order."""
    if isinstance(result, CurveAnalysis):
        return _curve_sheet(result, system)
    name = result.engine.name or NAMELESS
    parts: list[Grid | Facts | Text] = [_work_facts(result, system)]
    parts.append(_course_facts(result.curves.total, result.surplus, result.cycle_deg, system))
    if result.flywheel is None:
        parts.append(Text("Flywheel", (_NO_INERTIA,)))
    crank = 0.0 if result.engine.rotary else result.engine.crank_inertia
    parts += _flywheel_facts(
        result.flywheel, result.cycle_deg, system, None if crank is None else float(crank)
    )
    parts += _load_tables(result, system)
    parts.append(_order_table(result, system))
    return Sheet(f"{name}: torque on the crank", tuple(parts))


def _curve_sheet(result: CurveAnalysis, system: System) -> Sheet:
    cycle = float(np.degrees(result.torque.period))
    parts: tuple[Grid | Facts | Text, ...] = (
        _curve_facts(result, system),
        _course_facts(result.torque, result.surplus, cycle, system),
        *_flywheel_facts(result.flywheel, cycle, system),
        _curve_table(result, system),
    )
    return Sheet(f"{result.name}: torque", parts)


def tenths(angle_deg: float) -> str:
    """An angle within a cycle, to a tenth of a degree."""
    return f"{round(angle_deg, 6) + 0.0:.1f}"


def _size(value: float, unit: ShownUnit) -> str:
    """As `size_text`, with as many digits as most figures."""
    return size_text(value, unit, None)


def _load_tables(result: TorqueAnalysis, system: System) -> Iterator[Grid | Text]:
    if result.loads.pin:
        yield _load_table("Crank pins", "cylinder", result.loads.pin, result.cycle_deg, system)
    if (hung := result.loads.knuckle) is not None:
        yield _load_table("Knuckle pins", "cylinder", hung, result.cycle_deg, system)
    if result.loads.main:
        grid = _load_table("Main bearings", "bearing", result.loads.main, result.cycle_deg, system)
        yield grid._replace(
            note="Half-way between neighbouring throws and as far outside the end ones; the shaft "
            "counts as cut in each."
        )
    if result.loads.obstacle:
        yield Text("Main bearings", (f"Not known: {result.loads.obstacle}.",))


def _load_table(
    title: str, word: str, loads: tuple[CycleLoad, ...], cycle_deg: float, system: System
) -> Grid:
    unit = system.force.fit(max(load.largest.value for load in loads))
    pressures = [load.pressure for load in loads if load.pressure is not None]
    pressed = len(pressures) == len(loads)
    stress = system.stress.fit(max(pressures, default=0.0))

    def row(load: CycleLoad) -> Iterator[str]:
        yield str(load.name)
        yield number(unit.of(load.largest.value))
        yield tenths(degrees_in_cycle(load.largest.angle, cycle_deg))
        yield number(unit.of(load.mean))
        if load.pressure is not None and pressed:
            yield number(stress.of(load.pressure), 4)

    heads = (word, f"largest, {unit.name}", "at, deg", f"mean, {unit.name}")
    rows = tuple(tuple(row(load)) for load in loads)
    return Grid(title, (*heads, stress.name) if pressed else heads, rows)


def _work_facts(result: TorqueAnalysis, system: System) -> Facts:
    gas = result.max_pressure
    pairs = [("cycle", f"{tell_strokes(result.engine)}, {round_angle(result.cycle_deg)} deg")]
    pairs.append(("speed", tell_speed(result.engine, steady=True)))
    mean = f"{_size(result.imep, system.pressure)} indicated"
    if result.bmep is not None:
        mean += f", {_size(result.bmep, system.pressure)} brake"
    pairs.append(("mean pressure", mean))
    if gas is not None:
        at = degrees(float(np.degrees(gas.angle)))
        largest = _size(gas.value, system.pressure)
        pairs.append(("largest pressure", f"{largest}, {at} deg after firing"))
    pairs += list_silent(result.engine.silent)
    kinds = {" indicated": 1.0}
    if result.mechanical_efficiency is not None:
        kinds[" brake"] = result.mechanical_efficiency
    return Facts((*pairs, *_mean_pairs(result.mean_torque, result.power, system, kinds)))


def _mean_pairs(
    mean: float, power: float | None, system: System, kinds: Mapping[str, float]
) -> Iterator[tuple[str, str]]:
    """Mean torque and power, with the share of them that each kind is, such as " brake"."""

    def told(value: float, unit: ShownUnit) -> str:
        of_all = unit.fit(value)
        sizes = ((number(of_all.of(share * value)), kind) for kind, share in kinds.items())
        return ", ".join(f"{size} {of_all.name}{kind}" for size, kind in sizes)

    yield "mean torque", told(mean, system.moment)
    if power is not None:
        yield "power", told(power, system.power)


def _curve_facts(result: CurveAnalysis, system: System) -> Facts:
    pairs = [("period", f"{round_angle(float(np.degrees(result.torque.period)))} deg")]
    speed = result.shaft.mean_speed
    if speed is not None:
        pairs.append(("speed", f"{given(speed / RPM)} rpm"))
    power = None if speed is None else result.torque.mean * speed
    pairs += _mean_pairs(result.torque.mean, power, system, {"": 1.0})
    if result.load is not None:
        curves = (result.torque, result.load)
        rounded = SAME_MEAN * max(abs(e.value) for curve in curves for e in curve.extremes())
        mean, rest = result.load.mean, result.torque.mean - result.load.mean
        told = f"{_size(mean if abs(mean) > rounded else 0.0, system.moment)} in the mean"
        if abs(rest) > rounded:
            told += f", and {_size(rest, system.moment)} evenly"
        pairs.append(("load", told))
    return Facts(tuple(pairs))


def _course_facts(
    torque: PiecewiseCurve, surplus: Surplus, cycle_deg: float, system: System
) -> Facts:
    lowest, highest = torque.extremes()
    unit = system.moment.fit(max(abs(lowest.value), abs(highest.value)))
    start, end = (tenths(degrees_in_cycle(a, cycle_deg)) for a in (surplus.start, surplus.end))

    def told(value: float, angle: float) -> str:
        at = tenths(degrees_in_cycle(angle, cycle_deg))
        return f"{number(unit.of(value))} {unit.name} at {at} deg"

    pairs = (
        ("largest", told(highest.value, highest.angle)),
        ("smallest", told(lowest.value, lowest.angle)),
        ("reversals", str(torque.reversals())),
        ("work of a cycle", _size(surplus.work, system.energy)),
        ("surplus", f"{_size(surplus.energy, system.energy)} from {start} to {end} deg"),
    )
    return Facts(pairs, "Torque over the cycle")


def _flywheel_facts(
    flywheel: Flywheel | None, cycle_deg: float, system: System, crank: float | None = None
) -> Iterator[Facts]:
    """`crank`: inertia of the crankshaft by itself, kg m2, if it is known; 0 if it stands still."""
    if flywheel is None:
        return
    pairs, unit = [], system.inertia
    if flywheel.mean is not None:
        inertia = _size(flywheel.mean, unit)
        if flywheel.moving:
            inertia += f", of it moving parts {number(unit.of(flywheel.moving))}"
        pairs.append(("inertia", inertia))
    if flywheel.speed is not None:
        pairs += _speed_pairs(flywheel.speed, cycle_deg)
    if flywheel.stall:
        pairs.append(("speed", flywheel.stall))
    if flywheel.needed is not None:
        share = _tell_share_of_flywheel(flywheel.needed, flywheel.moving, crank, unit)
        pairs.append(("needed", f"{_size(flywheel.needed, unit)} in all{share}"))
    yield Facts(tuple(pairs), "Flywheel")


def _tell_share_of_flywheel(
    needed: float, moving: float, crank: float | None, unit: ShownUnit
) -> str:
    """How much of the inertia that is needed (kg m2) moving parts and crankshaft leave to the
    flywheel; nothing where moving parts are not known.
    """
    if not moving:
        return ""
    own = needed - moving - (crank or 0.0)
    if own <= 0:
        return ", which is there without a flywheel"
    place = "crankshaft and flywheel" if crank is None else "the flywheel"
    return f", {number(unit.of(own))} of it in {place}"


def _speed_pairs(speed: Speed, cycle_deg: float) -> Iterator[tuple[str, str]]:
    share = f"1/{number(1 / speed.fluctuation, 4)}" if speed.fluctuation else "0"
    small = number(100 * speed.small, 4)
    yield (
        "fluctuation",
        f"{number(100 * speed.fluctuation, 4)} % ({share}); {small} % by the rule for small ones",
    )
    low, high = (
        f"{number(e.value / RPM, 6)} rpm at {tenths(degrees_in_cycle(e.angle, cycle_deg))} deg"
        for e in (speed.lowest, speed.highest)
    )
    yield "speed", f"{low} to {high}"


def _order_table(result: TorqueAnalysis, system: System) -> Grid:
    """Orders in which the engine or the one cylinder has something."""
    spectra, alone = result.spectra, result.single["gas"]
    columns = [spectra[kind] for kind in KINDS_OF_TORQUE]
    largest = max(float(abs(phasors.x).max(initial=0)) for phasors in (*columns, alone))
    unit = system.moment.fit(largest)

    def cells(k: int) -> Iterator[str]:
        n = float(spectra.orders[k])
        yield order_name(n)
        for phasors in columns:
            yield from _amplitude(complex(phasors.x[k]), n, unit)
        yield number(unit.of(size_or_mean(complex(alone.x[k]), n)), 4)

    every = [*(phasors for _, phasors in spectra.items()), alone]
    shown = [k for k in range(len(spectra.orders)) if not all(p.balanced[k] for p in every)]
    return Grid(
        f"Torque by order, {unit.name}",
        (
            *("order", "gas", "at, deg", "inertia", "at, deg", "total", "at, deg"),
            f"gas of {result.cylinder}",
        ),
        tuple(tuple(cells(k)) for k in shown),
        f"The last column is what the gas of cylinder {result.cylinder} does alone.",
    )


def _amplitude(c: complex, order: float, unit: ShownUnit) -> tuple[str, str]:
    return (number(unit.of(size_or_mean(c, order)), 5), show_peak_deg(c, order)) if c else ("0", "")


def _curve_table(result: CurveAnalysis, system: System) -> Grid:
    unit = system.moment.fit(float(abs(result.harmonics).max(initial=0)))
    rows = tuple(
        (f"{round(float(n), 9):g}", *_amplitude(complex(c), float(n), unit))
        for n, c in zip(result.orders, result.harmonics, strict=True)
    )
    title = f"Torque by order, {unit.name}"
    note = "--orders asks for higher ones." if len(rows) == MOST_HARMONICS_UNASKED else ""
    return Grid(title, ("order", "torque", "peak, deg"), rows, note=note)

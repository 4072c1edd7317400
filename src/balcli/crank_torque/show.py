"""Show the torque of an engine or of a given curve as tables and CSV."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import partial
from itertools import chain
from typing import Any

from ..core.records import Node, find_unit, list_figures, remove_unit, to_document
from ..engine.engine import CylinderNumber, Engine
from ..forces.kinds import GAS, TORQUE, TORQUE_TOTAL
from ..limits import MOST_HARMONICS_UNASKED
from ..show.engine_facts import list_silent, tell_speed, tell_strokes
from ..show.figures import FigureRow, Harmonic, order_rows
from ..show.formats import Renderer, Rows
from ..show.sheet import (
    NAMELESS,
    Column,
    Facts,
    Grid,
    Sheet,
    Text,
    degrees,
    given,
    number,
    order_name,
    size_text,
    tell_assumed,
)
from ..show.units import ShownUnit, System
from .flywheel import Flywheel
from .loads import CycleLoads
from .pump_show import show_ends, show_rod_loads
from .records import TorqueAnalysis, Torques, find_brake_share, write_whole

_NO_INERTIA = "The uneven speed is not known: no inertia is given ([crank] inertia, [flywheel])."
_size = partial(size_text, digits=None)  # a size with the default number of digits
_PARTS = ("torque", "energy", "flywheel", "loads", "orders", "ends")


# ------------------------------------------------------------------ CSV
def rows(result: TorqueAnalysis, system: System) -> Rows:
    """Return CSV with one figure in each line, as for `analyze`. Cylinder 0 is the whole engine;
    lines with an empty order refer to the whole cycle.
    """
    header = ("cylinder", "quantity", "order", "figure", "value", "unit")
    return Rows(header, _list_rows(result, to_document(result), system))


def _list_rows(result: TorqueAnalysis, document: Node, system: System) -> Iterator[FigureRow]:
    # In lines of an engine, "torque" is the inertia torque, as in `analyze`.
    names = {kind.key: kind.name for kind in (TORQUE, GAS, TORQUE_TOTAL)}
    places: list[tuple[CylinderNumber, Any]] = [(0, document["orders"])]
    if result.engine is None:
        names[TORQUE_TOTAL.key] = TORQUE.name
    else:
        places.append((result.cylinder, [entry["one_cylinder"] for entry in document["orders"]]))
    head = {key: value for key, value in document.items() if key not in ("format", *_PARTS)}
    for key in {"no_gas_in", "no_burning_in"} & head.keys():
        head[key] = " ".join(map(str, head[key]))
    parts = [("engine", head), (names[TORQUE_TOTAL.key], document["torque"])]
    parts += [(key, document.get(key, {})) for key in ("energy", "flywheel")]
    for key, loads in document.get("loads", {}).items():
        if key == "obstacle":  # why there are no loads of main bearings, in words
            parts.append(("main", {key: loads}))
        else:
            parts += [(key, load) for load in loads]
    parts += [(f"{end['end']} end", end) for end in document.get("ends", ())]
    for quantity, part in parts:
        yield from _write(quantity, part, system)
    for cylinder, entries in places:
        for key, name in names.items():
            for row, entry in zip(document["orders"], entries, strict=True):
                if key in entry:
                    yield from order_rows(name, row["order"], entry[key], system.moment, cylinder)


def _write(quantity: str, part: Node, system: System) -> Iterator[FigureRow]:
    """Yield a line for every figure. Lines of pins have the number of the cylinder; lines of
    bearings have the number of the bearing in the column of the order.
    """
    cylinder = part.get("cylinder", 0)
    order = part.get("bearing")
    for name, value, _ in list_figures(part, ("cylinder", "bearing", "position_mm")):
        unit = system.instead_of(find_unit(name))
        fixed = unit.name in ("deg", "rpm")
        yield FigureRow(
            cylinder,
            quantity,
            order,
            name if fixed else remove_unit(name),
            unit.of(value) if isinstance(value, float) else value,
            unit.name,
        )


# ------------------------------------------------------------------ for people
def sheet(result: TorqueAnalysis, system: System) -> Sheet:
    """Return the sheet: work, torque over the cycle, flywheel, loads, and torque by order."""
    what = "torque on the crank" if result.engine else "torque"
    title = f"{result.name or NAMELESS}: {what}"
    parts: list[Grid | Facts | Text] = [Facts(tuple(_list_work(result, system)))]
    parts.append(_describe_course(result, system))
    if result.ends is not None:
        parts.append(show_ends(result.ends, system))
    if hasattr(result, "flywheel"):
        parts.append(Facts(tuple(_list_flywheel(result, result.flywheel, system)), "Flywheel"))
    elif result.engine is not None:
        parts.append(Text("Flywheel", (_NO_INERTIA,)))
    if hasattr(result, "loads"):
        parts += _make_load_tables(result, result.loads, system)
    parts.append(_make_order_table(result, system))
    return Sheet(title, tuple(parts))


def tenths(angle_deg: float) -> str:
    """Return an angle within a cycle as text, rounded to a tenth of a degree."""
    return f"{round(angle_deg, 6) + 0.0:.1f}"


def _list_work(result: TorqueAnalysis, system: System) -> Iterator[tuple[str, str]]:
    efficiencies = {"": 1.0}
    period = f"{write_whole(result.cycle_deg)} deg"
    if (engine := result.engine) is None:
        yield "period", period
        if result.speed_rpm is not None:
            yield "speed", f"{given(result.speed_rpm)} rpm"
    else:
        yield "cycle", f"{tell_strokes(engine)}, {period}"
        yield "speed", tell_speed(engine, steady=True)
        if result.assumed:
            yield "assumed", tell_assumed(result.assumed)
        absorbs = (result.imep_Pa or 0.0) < 0
        sign = -1.0 if absorbs else 1.0
        efficiencies = {" absorbed" if absorbs else " indicated": sign}
        brake_share = find_brake_share(engine, result.imep_Pa or 0.0)
        if brake_share is not None:
            efficiencies[" brake"] = sign * brake_share
        if result.max_pressure_Pa is not None:
            size = _size(result.max_pressure_Pa, system.pressure)
            at = result.max_pressure_deg
            is_pump = engine.is_pump or (absorbs and engine.strokes == 2)
            start = "the outer dead centre" if is_pump else "firing"
            yield "largest pressure", f"{size}, {degrees(at or 0.0)} deg after {start}"
        yield from list_silent(engine.silent)
    for name, value, of in (
        ("mean pressure", result.imep_Pa, system.pressure),
        ("mean torque", result.mean_torque_Nm, system.moment),
        ("power", result.power_W, system.power),
    ):
        if value is not None:
            unit = of.fit(value)  # the same unit for indicated and brake value
            sizes = []
            for kind, efficiency in efficiencies.items():
                sizes.append(f"{number(unit.of(value * efficiency))} {unit.name}{kind}")
            yield name, ", ".join(sizes)
    if result.load_Nm is not None:
        yield "load", _tell_load(*result.load_Nm, system.moment)


def _tell_load(mean: float, constant: float, unit: ShownUnit) -> str:
    """Return in words the mean torque of the load, and its constant part in addition."""
    load = f"{_size(mean, unit)} on average"
    if constant:
        load += f", and {_size(constant, unit)} constant"
    return load


def _describe_course(result: TorqueAnalysis, system: System) -> Facts:
    torque = result.torque
    energy = result.energy
    unit = system.moment.fit(max(abs(torque.min_Nm), abs(torque.max_Nm)))

    def tell(value: float, angle_deg: float) -> str:
        return f"{number(unit.of(value))} {unit.name} at {tenths(angle_deg)} deg"

    surplus = _size(energy.surplus_J, system.energy)
    pairs = (
        ("largest", tell(torque.max_Nm, torque.max_deg)),
        ("smallest", tell(torque.min_Nm, torque.min_deg)),
        ("reversals", str(torque.reversals)),
        ("work of a cycle", _size(energy.work_J, system.energy)),
        ("surplus", f"{surplus} from {tenths(energy.from_deg)} to {tenths(energy.to_deg)} deg"),
    )
    return Facts(pairs, "Torque over the cycle")


def _list_flywheel(
    result: TorqueAnalysis, wheel: Flywheel, system: System
) -> Iterator[tuple[str, str]]:
    unit = system.inertia
    moving = wheel.moving_parts_kg_m2
    if hasattr(wheel, "inertia_kg_m2"):
        inertia = _size(wheel.inertia_kg_m2, unit)
        if moving:
            inertia += f", including {number(unit.of(moving))} of moving parts"
        yield "inertia", inertia
    if hasattr(wheel, "fluctuation"):
        share = wheel.fluctuation
        small = number(100 * wheel.fluctuation_small)
        one_in = f"1/{number(1 / share)}" if share else "0"
        exact = number(100 * share)
        yield "fluctuation", f"{exact} % ({one_in}); {small} % by the rule for small fluctuations"
        lowest = f"{number(wheel.speed_min_rpm, 6)} rpm at {tenths(wheel.speed_min_deg)} deg"
        highest = f"{number(wheel.speed_max_rpm, 6)} rpm at {tenths(wheel.speed_max_deg)} deg"
        yield "speed", f"{lowest} to {highest}"
    if wheel.stall:
        yield "speed", wheel.stall
    if hasattr(wheel, "needed_kg_m2"):
        needed = f"{_size(wheel.needed_kg_m2, unit)} in total"
        if result.engine is not None and moving:
            rest = _tell_rest(result.engine, wheel.needed_kg_m2 - moving, unit)
            needed += f", {rest}"
        yield "needed", needed


def _tell_rest(engine: Engine, turning: float, unit: ShownUnit) -> str:
    """Return in words how much of the needed inertia the flywheel must have.

    Args:
        engine: Engine with or without a flywheel.
        turning: Needed inertia of all parts that only turn, kg m2.
        unit: Unit of the text.
    """
    own = (engine.find_constant_inertia() or 0.0) - float(engine.flywheel_inertia or 0.0)
    rest = turning - own
    if rest <= 0:
        return "which needs no flywheel"
    is_crank_known = engine.rotary or engine.crank_inertia is not None
    place = "the flywheel" if is_crank_known else "crankshaft and flywheel"
    return f"including {number(unit.of(rest))} in {place}"


def _make_load_tables(
    result: TorqueAnalysis, loads: CycleLoads, system: System
) -> Iterator[Grid | Text]:
    cut = "The shaft is treated as cut in each bearing."
    if result.engine is None or not result.engine.has_given_bearings:
        cut = (
            "Bearings are assumed half-way between neighbouring throws; the end bearings are the "
            f"same distance outside the end throws. {cut}"
        )
    for title, word, loaded, note in (
        ("Crank pins", "cylinder", getattr(loads, "pin", ()), ""),
        ("Knuckle pins", "cylinder", loads.knuckle or (), ""),
        ("Main bearings", "bearing", getattr(loads, "main", ()), cut),
    ):
        if not loaded:
            continue
        unit = system.force.fit_values(load.max_N for load in loaded)
        heads = [
            Column(word, words=True),
            Column(f"largest, {unit.name}"),
            Column("at, deg"),
            Column(f"mean, {unit.name}"),
        ]
        rows = []
        for load in loaded:
            largest = number(unit.of(load.max_N))
            mean = number(unit.of(load.mean_N))
            rows.append([str(getattr(load, word)), largest, tenths(load.max_deg), mean])
        pressures = [load.pressure_Pa for load in loaded if load.pressure_Pa is not None]
        if len(pressures) == len(loaded):
            stress = system.stress.fit(max(pressures))
            heads.append(Column(stress.name))
            for row, pressure in zip(rows, pressures, strict=True):
                row.append(number(stress.of(pressure)))
        yield Grid.of_rows(title, heads, rows, note)
    if hasattr(loads, "rod"):
        yield show_rod_loads(loads.rod, system)
    if loads.obstacle:
        yield Text("Main bearings", (f"Not known: {loads.obstacle}.",))


def _make_order_table(result: TorqueAnalysis, system: System) -> Grid:
    """Return a table of torque by order, without orders in which neither the engine nor the
    shown cylinder has a torque.
    """
    every = [order.torques for order in result.orders]
    alone: list[Harmonic] = []
    if result.engine is None:
        kinds = {"torque": _list_harmonics(every, "torque_Nm")}
        angle = "peak, deg"
        note = "--orders lists higher orders." if len(every) == MOST_HARMONICS_UNASKED else ""
        shown = [*range(len(every))]
        names = [f"{order.order:g}" for order in result.orders]
    else:
        kinds = {
            "gas": _list_harmonics(every, "gas_torque_Nm"),
            "inertia": _list_harmonics(every, "inertia_torque_Nm"),
            "total": _list_harmonics(every, "torque_Nm"),
        }
        alone = _list_harmonics([order.one_cylinder for order in result.orders], "gas_torque_Nm")
        angle = "at, deg"
        note = f"The last column is the gas torque of cylinder {result.cylinder} only."
        rows = enumerate(zip(*kinds.values(), alone, strict=True))
        shown = [k for k, row in rows if not all(harmonic.balanced for harmonic in row)]
        names = [order_name(order.order) for order in result.orders]
    columns = [Column("order", [names[k] for k in shown], words=True)]
    amplitudes = [harmonic.amplitude for harmonic in chain(*kinds.values(), alone)]
    unit = system.moment.fit_values(amplitudes)

    def write(harmonics: list[Harmonic], digits: int) -> list[str]:
        cells = []
        for k in shown:
            harmonic = harmonics[k]
            value = harmonic.amplitude if result.orders[k].order else harmonic.cos
            cells.append(number(unit.of(value), digits))
        return cells

    for name, harmonics in kinds.items():
        columns.append(Column(name, write(harmonics, 5)))
        at = [degrees(harmonics[k].peak_deg) if harmonics[k].amplitude else "" for k in shown]
        columns.append(Column(angle, at))
    if alone:
        columns.append(Column(f"gas of {result.cylinder}", write(alone, 4)))
    return Grid(f"Torque by order, {unit.name}", columns, note)


def _list_harmonics(parts: Iterable[Torques | None], key: str) -> list[Harmonic]:
    """Return one torque of every order."""
    return [getattr(part, key) for part in parts]


RENDERER = Renderer(sheet=sheet, rows=rows)

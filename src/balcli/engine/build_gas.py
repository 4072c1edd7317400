"""From [gas], and what cylinders say of it, to the gas in an engine's cylinders.

Indicator diagrams: measured pressures over the crank angle, in files beside the engine file;
straight lines between the rows, periodic.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import fields, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.cylinder_pressure import GasError, GasPiston, GasTorque, find_highest, pistons, press
from ..core.gas_cycle import GasCycle, Goal, Process, find_cycle_mistakes, gas_cycle
from ..core.phasors import Array
from ..core.piecewise import PiecewiseCurve, polyline, resolved
from ..errors import BalcliError, InputError, Problem
from ..file.csv_columns import GAUGE_UNITS, Head, NumberColumns, locate_beside, read_columns
from ..file.doubts import MAX_PRESSURE
from ..file.gas_tables import DIAGRAM_KEYS, Gas
from ..file.model import Override
from ..file.units import ANGLE, BAR, PRESSURE
from ..limits import HIGHEST_TABLE_ORDER, MOST_DIFFERENT_GAS
from .gas import CylinderGas, EngineGas
from .layout import find_first

if TYPE_CHECKING:
    from ..core.cylinders import Cylinders
    from .parts import Parts


ATMOSPHERE = 101325.0  # Pa, what gauge pressures lack
WIDEST_GAP = 30.0  # deg between two rows; beyond, straight lines say nothing about an engine
FLAT_GAP = 45.0  # deg; the same while the gas is exchanged, where the pressure hardly changes
_FLAT = 0.01  # of the highest pressure
_SAME = 1e-6  # deg; rows so near to one period apart are the two ends of it
_OTHERS = ("MPa", "kPa", "Pa", "psi", *GAUGE_UNITS)
HEADS = (
    Head("angle_deg", ANGLE),
    Head("pressure_bar", PRESSURE, tuple(f"pressure_{unit}" for unit in _OTHERS)),
)
LOW_PRESSURE = 0.1  # bar; a throttled engine draws in at 0.3
ASK_GAUGE = '; is it over the atmosphere? Then give pressure = "gauge"'
NEAR_DEG = 45.0  # from the firing dead centre: there the pressure of every engine is highest
SAME_IMEP = 0.03  # by which a diagram may miss the stated mean effective pressure


def build_diagram(gas: Gas, name: str, columns: NumberColumns, strokes: int) -> PiecewiseCurve:
    """Return the absolute pressure (Pa) over a cycle by the columns of the file of this name.

    Raises:
        BalcliError: The first mistake in the file, by its line.
    """
    kind = "gauge" if _is_gauge(gas, columns) else "absolute"
    for below in np.flatnonzero(_absolute(gas, columns) < 0).tolist():
        right, hint = ("at least the vacuum", "") if kind == "gauge" else ("0 or more", ASK_GAUGE)
        found = columns.as_written(below, 1)
        message = f"line {columns.lines[below]}: the {kind} pressure is {found}: give {right}"
        raise BalcliError(f"{name}: {message}{hint}")
    angle, pressure, _ = _read(gas, columns, 180.0 * strokes)
    for row, message in find_diagram_mistakes(angle, pressure, strokes=strokes):
        line = "" if row is None else f"line {columns.lines[row]}: "
        raise BalcliError(f"{name}: {line}{message}")
    firing = 360.0 if gas.zero == "gas-exchange" else 0.0
    return draw_diagram(angle, pressure, strokes=strokes, firing_deg=firing - gas.phase)


def _absolute(gas: Gas, columns: NumberColumns) -> Array:
    """Return the absolute pressures of all rows, Pa."""
    gauge = ATMOSPHERE if _is_gauge(gas, columns) else 0.0
    return np.array(columns.column(1)) * BAR + gauge


def _read(gas: Gas, columns: NumberColumns, period: float) -> tuple[Array, Array, int]:
    """Return angles (deg) and absolute pressures (Pa) of a cycle, and how many the file has: of
    several, one after the other, the mean at the angles of the first.
    """
    angle, pressure = np.array(columns.column(0)), _absolute(gas, columns)
    steps = np.diff(angle)
    starts = np.flatnonzero(steps < -period / 2)  # every cycle counts from its own beginning
    if len(angle) < 2 or not (np.delete(steps, starts) > 0).all():
        return angle, pressure, 1
    angle = angle + period * np.searchsorted(starts, np.arange(len(angle)) - 0.5)
    span = angle[-1] - angle[0]
    kept = np.append(
        True, np.diff(angle) > _SAME
    )  # the end of a cycle is the beginning of the next
    if not (np.diff(angle) > -_SAME).all():
        return np.array(columns.column(0)), pressure, 1
    count = round((span + np.median(steps)) / period)
    if count < 2 or abs(span - count * period) > 2 * np.median(steps) + _SAME:
        return angle, pressure, 1
    first = angle < angle[0] + period - _SAME
    every = angle[first] + period * np.arange(count)[:, np.newaxis]
    mean = np.interp(every, angle[kept], pressure[kept]).mean(axis=0)
    return angle[first], mean, count


def _is_gauge(gas: Gas, columns: NumberColumns) -> bool:
    return gas.pressure == "gauge" or columns.units[1] in GAUGE_UNITS


def _is_closed(angle: Array, period: float) -> bool:
    """Return whether a diagram has a row at both ends of the period; the first holds."""
    return len(angle) > 1 and abs(angle[-1] - angle[0] - period) < _SAME


def draw_diagram(
    angle_deg: ArrayLike, pressure: ArrayLike, *, strokes: int = 4, firing_deg: float = 0.0
) -> PiecewiseCurve:
    """Return the pressure at cycle angles, of rows without what `find_diagram_mistakes` finds.

    Args:
        angle_deg: Rising angles, shape (rows,).
        pressure: Absolute, Pa, shape (rows,).
        strokes: 4 or 2; the period is 720 or 360 deg.
        firing_deg: Angle at which the piston is at its firing dead centre: 0 less the phase, or
            360 less the phase where the diagram counts from the gas-exchange dead centre.
    """
    angle, values = np.asarray(angle_deg, float), np.asarray(pressure, float)
    period = 180.0 * strokes
    kept = slice(-1 if _is_closed(angle, period) else None)
    corners = np.append(angle[kept], angle[0] + period) - firing_deg
    return polyline(np.radians(corners), np.append(values[kept], values[0]))


def find_diagram_mistakes(
    angle_deg: ArrayLike, pressure: ArrayLike, *, strokes: int = 4
) -> Iterator[tuple[int | None, str]]:
    """Yield what is wrong with the rows of a diagram: the row (from 0; None: the diagram) and the
    mistake; arguments as of `draw_diagram`.
    """
    angle, values = np.asarray(angle_deg, float), np.asarray(pressure, float)
    period = 180.0 * strokes
    if len(angle) < 2:
        yield None, f"has {len(angle)} rows; a cycle of {period:g}° needs more"
        return
    falling = (np.flatnonzero(np.diff(angle) <= 0) + 1).tolist()
    for row in falling:
        yield row, f"the angle {angle[row]:g}° does not exceed the {angle[row - 1]:g}° before it"
    if falling:
        return
    span = angle[-1] - angle[0]
    if span > period + _SAME:
        yield None, f"covers {span:g}°; a cycle of {strokes} strokes has {period:g}°"
        return
    flat = np.abs(values - np.roll(values, 1)) <= _FLAT * values.max()
    widest = np.where(flat, FLAT_GAP, WIDEST_GAP)  # behind the row before, or the last
    close = f"give rows at most {WIDEST_GAP:g}° apart"
    for row in (np.flatnonzero(np.diff(angle) > widest[1:]) + 1).tolist():
        gap = angle[row] - angle[row - 1]
        yield row, f"lies {gap:g}° after the row before it: {close}"
    if (gap := period - span) > widest[0]:
        yield None, f"covers {span:g}° of {period:g}°, a gap of {gap:g}° at its end: {close}"


def list_doubts(
    gas: Gas, path: str, name: str, columns: NumberColumns, found: PiecewiseCurve, imep: float
) -> Iterator[str]:
    """Yield what is suspicious of a diagram, each with its path in the engine file.

    Args:
        gas: The table of the file.
        path, name: Key and name of the diagram's file.
        columns: Columns of this file.
        found: Pressure at cycle angles, Pa.
        imep: Indicated mean effective pressure, Pa.
    """
    angle, pressure, count = _read(gas, columns, math.degrees(found.period))
    if count > 1:
        yield f"{path}: {name}: has {count} cycles; their mean is taken"
    unit = columns.units[1].removesuffix("g")
    scale = columns.scales[1] * BAR  # Pa
    first, last = pressure[0] / scale, pressure[-1] / scale
    if first != last and _is_closed(angle, math.degrees(found.period)):
        yield (
            f"{path}: {name}: the last row closes the cycle with {last:.4g} {unit}, the first has "
            f"{first:.4g} {unit}; the first is taken"
        )
    top, value = find_highest(found)
    if abs(math.degrees(top)) > NEAR_DEG:
        yield (
            f"{path}: the highest pressure, {value / scale:.4g} {unit}, stands at "
            f"{math.degrees(top):.4g} deg from the firing dead centre, where within "
            f"{NEAR_DEG:g} is usual; are gas.zero and gas.phase right?"
        )
    if value > MAX_PRESSURE * BAR:
        yield (
            f"{path}: the highest pressure is {value / scale:.4g} {unit}, where at most "
            f"{MAX_PRESSURE * BAR / scale:.4g} is usual; does the heading of its column "
            "name the right unit?"
        )
    lowest = found.extremes()[0].value / scale
    if lowest * scale < LOW_PRESSURE * BAR:
        yield (
            f"{path}: the lowest pressure is {lowest:.4g} {unit} absolute, where at least "
            f"{LOW_PRESSURE * BAR / scale:.4g} is usual{ASK_GAUGE}"
        )
    stated, measured = gas.imep if path == "gas.indicator" else None, imep / BAR
    if stated is not None and abs(measured - stated) > SAME_IMEP * abs(stated):
        yield (
            f"gas.imep is {stated:g} bar, and the diagram has {measured:.4g} bar; a phase of one "
            "degree makes 3 to 7 %: is gas.phase right?"
        )


# Heat of fuel that uses up all air, over pressure times volume of that air: 2.95 MJ/kg of petrol
# and Diesel fuel alike, at 300 K; more than HEAT_MOST is doubted.
HEAT_OF_AIR, HEAT_MOST = 34, 40.0


def build_gas(parts: Parts, cylinders: Cylinders | None = None) -> EngineGas:
    """Return the gas of an engine whose tables fit together otherwise.

    Args:
        parts: The engine with [gas].
        cylinders: Cylinders with other mechanisms than its own, if it is theirs.

    Raises:
        InputError: Every mistake of [gas], of what cylinders say of it, and of the files named
            there.
    """
    return _Builder(parts, parts.cylinders if cylinders is None else cylinders).build()


class _Own(NamedTuple):
    """What the file says of the gas of one cylinder.

    Attributes:
        path: Key of its diagram.
        indicator: Name of the file with its diagram; None where it has none.
        heat: Heat supplied in a computed cycle, J, where the file says so.
        heat_path: Key of this heat.
        share: Factor of the gas force.
    """

    path: str
    indicator: str | None
    heat: float | None
    heat_path: str
    share: float


class _Builder:
    """The gas of an engine while it is put together."""

    def __init__(self, parts: Parts, cylinders: Cylinders) -> None:
        self.parts, self.model, self.cylinders = parts, parts.model, cylinders
        self.gas = self._vary(parts.model.gas or Gas.model_construct())
        self.strokes = parts.model.layout.strokes
        self.problems: list[Problem] = []
        self.doubts: list[str] = []
        self.own = [self._find_own(number) for number in parts.numbers]
        self.measured = any(own.indicator is not None for own in self.own)
        self._overfed = False
        self._read: dict[str, NumberColumns] = {}

    def build(self) -> EngineGas:
        bore = self._take("piston.bore", self.model.piston.bore)
        self.problems += self._list_contradictions(bore)
        self._refuse()
        mechanisms, own = self.cylinders.mechanisms, self.own
        found = pistons(self.cylinders, math.pi / 4 * ((bore or 0.0) / 1e3) ** 2)
        like, first = [], dict[object, int]()
        for row, mechanism in enumerate(mechanisms):
            key = (*mechanism, own[row].indicator, own[row].heat)
            like.append(first.setdefault(key, row))
        if len(first) > MOST_DIFFERENT_GAS:
            most = f"at most {MOST_DIFFERENT_GAS} are computed"
            many = f"{len(first)} cylinders differ in mechanism, heat or diagram; {most}"
            self.problems.append(Problem("gas", f"{many}: give more of them the same figures"))
            self._refuse()
        torques = {row: self._find_torque(row, found[row]) for row in first.values()}
        self._refuse()
        self.doubts += self._list_idle()
        nominal = self._find_nominal([piston.top for piston in found])
        cylinders = [
            CylinderGas(found[row], torque, nominal[row], own[row].share, own[row].heat, like[row])
            for row in range(len(found))
            if (torque := torques[like[row]]) is not None
        ]
        return EngineGas(
            tuple(cylinders),
            180 * self.strokes,
            self.gas.mechanical_efficiency,
            self.gas.compression_ratio,
            tuple(self.doubts),
        )

    def _refuse(self) -> None:
        if self.problems:
            raise InputError(list(dict.fromkeys(self.problems)))

    # -------------------------------------------------------------- figures of the file
    def _vary(self, gas: Gas) -> Gas:
        """Return [gas] with other figures in place of some, and of what says the same."""
        varied = self.parts.figures.of_table("gas")
        if not varied:
            return gas
        displaced = {rival for key in varied for rival in gas.rivals(key)}
        said = {key: getattr(gas, key) for key in gas.model_fields_set - displaced}
        return Gas.model_construct(**said | {key: float(value) for key, value in varied.items()})

    def _take(self, path: str, given: float | None) -> float | None:
        found = self.parts.figures.take_optional(path, given)
        return None if found is None else float(found)

    def _find_own(self, number: int) -> _Own:
        path = f"cylinder.{number}"
        table = self.model.cylinder.get(number, Override.model_construct())
        heat = self._take(f"{path}.heat", table.heat)
        heat_path = "gas.heat" if heat is None else f"{path}.heat"
        share = self._take(f"{path}.gas", 1.0 if table.gas is None else table.gas) or 0.0
        if table.indicator is not None:
            return _Own(f"{path}.indicator", table.indicator, None, heat_path, share)
        heat = self.gas.heat if heat is None else heat
        indicator = self.gas.indicator
        heat = heat if indicator is None else None
        return _Own("gas.indicator", indicator, heat, heat_path, share)

    def _columns(self, name: str, wanted: tuple[Head, ...]) -> NumberColumns:
        if name not in self._read:
            self._read[name] = read_columns(locate_beside(self.model.folder, name), wanted)
        return self._read[name]

    # -------------------------------------------------------------- what does not fit together
    def _list_contradictions(self, bore: float | None) -> Iterator[Problem]:
        gas, two_stroke = self.gas, self.strokes == 2
        yield from (Problem("gas", fault) for fault in gas.contradictions())  # of what varies
        if bore is None:
            yield Problem.of_missing("piston.bore", "gas presses on its area, such as bore = 86")
        if not two_stroke and self.parts.order is None and len(self.parts.numbers) > 1:
            yield Problem.of_missing(
                "layout.firing_order",
                "a four-stroke cylinder fires in every second revolution, and only "
                "the firing order says in which, such as firing_order = [1, 3, 4, 2]",
            )
        own_heat = (
            "belongs to a computed cycle, and [gas] has none; give the cylinder a diagram of its "
            "own (indicator)"
        )
        ports = (
            "has no meaning in a two-stroke cycle, whose ports close where the exhaust opened: "
            "leave it out"
        )
        zero = 'a two-stroke cycle has no gas-exchange dead centre; give "firing"'
        for number, table in self.model.cylinder.items():
            if gas.cycle is None and table.heat is not None:
                yield Problem(f"cylinder.{number}.heat", own_heat)
        for key in () if self.measured else DIAGRAM_KEYS:
            if key in gas.model_fields_set:
                yield Problem(f"gas.{key}", "belongs to an indicator diagram; leave it out")
        if two_stroke and gas.intake_closes is not None:
            yield Problem("gas.intake_closes", ports)
        if two_stroke and gas.zero == "gas-exchange":
            yield Problem("gas.zero", zero)

    def _list_idle(self) -> Iterator[str]:
        """Yield the keys of [gas] that change nothing of this engine, each with the reason."""
        given = self.gas.model_fields_set
        if self.gas.harmonics and not self.measured and "crankcase" in given:
            yield "gas.crankcase changes nothing beside harmonics, which are of the torque"
        if self.strokes == 2 and "exhaust" in given:
            yield (
                "gas.exhaust changes nothing in a two-stroke cycle: while its ports are open the "
                "pressure is that of intake"
            )

    # -------------------------------------------------------------- one cylinder
    def _find_torque(self, row: int, piston: GasPiston) -> GasTorque | None:
        """Return the torque of a cylinder; None after a mistake."""
        own, gas = self.own[row], self.gas
        name = own.indicator or gas.harmonics
        if name is None:
            cycle = self._compute_cycle(row, piston)
            if cycle is None:
                return None
            return press(piston, cycle.pressure, cycle.breaks, gas.crankcase * BAR)
        try:
            if own.indicator is None:
                return self._read_harmonics(name, piston)
            columns = self._columns(name, HEADS)
            pressure = build_diagram(gas, name, columns, self.strokes)
        except BalcliError as error:
            path = "gas.harmonics" if own.indicator is None else own.path
            self.problems.append(Problem(path, str(error)))
            return None
        found = press(piston, pressure, pressure.breaks, gas.crankcase * BAR)
        self.doubts += list_doubts(gas, own.path, name, columns, pressure, found.imep)
        return found

    def _read_harmonics(self, name: str, piston: GasPiston) -> GasTorque:
        """Return the torque of a builders' table: T/(A r) = a cos n c + b sin n c, c from the
        firing dead centre.
        """
        columns = self._columns(name, (Head("order"), Head("cos"), Head("sin")))
        orders, cosines, sines = (np.array(columns.column(k)) for k in range(3))
        if not len(orders):
            raise BalcliError(f"{name}: has no rows; give order,cos,sin in each")

        def refuse(rows: NDArray[np.bool_], what: str) -> None:
            for row in np.flatnonzero(rows)[:1].tolist():
                line = f"{name}: line {columns.lines[row]}"
                told = {"order": orders[row], "sine": sines[row], "last": orders[row - 1]}
                raise BalcliError(f"{line}: {what.format(**told)}")

        step = 2 / self.strokes
        refuse(
            np.append(False, np.diff(orders) <= 0),
            "order {order:g} is not above the {last:g} before it",
        )
        above = f"order {{order:g}} is above {HIGHEST_TABLE_ORDER}, where no table goes"
        refuse(orders > HIGHEST_TABLE_ORDER, above)
        mean = "order 0 has sin {sine:g}; it is the mean, which has no sine: write 0"
        refuse((orders == 0) & (sines != 0), mean)
        multiples = f"a cycle of {self.strokes} strokes has multiples of {step:g}"
        refuse((orders < 0) | (orders % step != 0), f"order {{order:g}}: {multiples}")
        size = piston.area * piston.radius * BAR

        def torque(angle: Array) -> Array:
            turned = np.multiply.outer(angle, orders)
            return size * (np.cos(turned) @ cosines + np.sin(turned) @ sines)

        breaks = np.array([0.0, self.strokes * np.pi])
        return GasTorque(piston, breaks, resolved(torque, breaks))

    def _compute_cycle(self, row: int, piston: GasPiston) -> GasCycle | None:
        heat, process, goal = self.own[row].heat, self._find_process(), self._find_goal()
        if heat is not None:
            goal = Goal("heat", heat)
        if heat == 0:  # it expands as it was compressed
            process = replace(process, cycle="otto", expansion_index=process.compression_index)
        wrong = list(find_cycle_mistakes(piston, process, goal))
        try:
            if not wrong:
                cycle = gas_cycle(piston, process, goal)
                self.doubts += self._doubt_heat(row, cycle, piston, goal)
                return cycle
        except GasError as error:
            wrong = [error]
        self.problems += (self._locate(error, row) for error in wrong)
        return None

    def _doubt_heat(
        self, row: int, cycle: GasCycle, piston: GasPiston, goal: Goal
    ) -> Iterator[str]:
        """Yield a warning, once, of more heat than the air of the charge burns."""
        intake, ratio = self.gas.intake, self.gas.compression_ratio or math.nan
        charge = intake * BAR * float(piston.volume(cycle.breaks[0], ratio))
        if self._overfed or not cycle.heat > HEAT_MOST * charge:
            return
        self._overfed = True
        yield (
            f"{self._locate(GasError(goal.name, ''), row).path} takes {cycle.heat:.4g} J of heat "
            f"in each cycle, {cycle.heat / charge:.2g} times the pressure times the volume of its "
            f"charge; fuel for all of that air gives some {HEAT_OF_AIR:g} times; is gas.intake = "
            f"{intake:.4g} bar right? It is absolute, and more where the engine is supercharged"
        )

    def _locate(self, error: GasError, row: int) -> Problem:
        """Return a mistake of a cylinder's cycle by its path in the file."""
        number, own = self.parts.numbers[row], self.own[row]
        if error.field == "heat":
            return Problem(own.heat_path, str(error))
        if error.field == "expansion_index" and own.heat == 0:
            what = f"where cylinder {number} burns nothing, it expands as it was compressed"
            return Problem("gas.compression_index", f"{error}; {what}")
        if error.field == "imep" and self.gas.bmep is not None:
            return Problem("gas.bmep", f"over mechanical_efficiency, the imep, {error}")
        return Problem(f"gas.{error.field}", str(error))

    # -------------------------------------------------------------- computed cycles
    def _find_process(self) -> Process:
        keys = [field.name for field in fields(Process) if field.name != "strokes"]
        given: dict[str, Any] = {key: getattr(self.gas, key) for key in keys}
        for key in ("intake", "exhaust", "max_pressure"):
            given[key] = given[key] and given[key] * BAR
        return Process(strokes=self.strokes, **given)

    def _find_goal(self) -> Goal:
        """Return what a computed cycle is to have."""
        g = self.gas
        if g.heat is not None:
            return Goal("heat", g.heat)
        if g.cut_off is not None:
            return Goal("cut_off", g.cut_off)
        if g.bmep is not None:
            return Goal("imep", g.bmep * BAR / (g.mechanical_efficiency or math.nan))
        if g.imep is not None:
            return Goal("imep", g.imep * BAR)
        return Goal("max_pressure", (g.max_pressure or 0.0) * BAR)

    # -------------------------------------------------------------- firing
    def _find_nominal(self, tops: list[float]) -> list[float]:
        """Return `CylinderGas.nominal_deg` of each row. Cylinder 1 (`find_first`) fires in
        [-180, 180) deg of crank angle, the others next to when the firing order has them fire.
        """
        parts, cycle = self.parts, 180.0 * self.strokes
        phi, fires = self.cylinders.angle_deg, parts.fires_deg
        origin = find_first(fires) if fires else 1
        first = parts.numbers.index(origin)
        found = []
        for row, number in enumerate(parts.numbers):
            at = 0.0 - float(phi[row])
            top = math.degrees(tops[row] - tops[first])
            wanted = float(fires[number] - fires[origin]) if number in fires else 0.0
            at += 360.0 * round((wanted - top - at) / 360.0)
            found.append(at % cycle)
        return found

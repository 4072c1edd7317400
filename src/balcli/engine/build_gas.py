"""From [gas], and what cylinders say of it, to the gas in an engine's cylinders."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import fields, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.cylinder_pressure import GasError, GasPiston, GasTorque, pistons, press
from ..core.gas_cycle import GasCycle, Goal, Process, find_cycle_mistakes, gas_cycle
from ..core.phasors import Array
from ..core.piecewise import resolved
from ..enginefile.csv_columns import NumberColumns, locate_beside, read_columns
from ..enginefile.gas_tables import DIAGRAM_KEYS, Gas
from ..enginefile.model import Override
from ..enginefile.units import BAR
from ..errors import BalcliError, InputError, Problem
from ..limits import HIGHEST_TABLE_ORDER
from . import indicator_diagram as diagrams
from .gas import CylinderGas, EngineGas

# Heat of fuel that uses up all air, over pressure times volume of that air: 2.95 MJ/kg of petrol
# and Diesel fuel alike, at 300 K; more than HEAT_MOST is doubted.
HEAT_OF_AIR, HEAT_MOST = 34, 40.0

if TYPE_CHECKING:
    from ..core.cylinders import Cylinders
    from .assembly import Assembly


def build_gas(parts: Assembly, cylinders: Cylinders | None = None) -> EngineGas:
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

    def __init__(self, parts: Assembly, cylinders: Cylinders) -> None:
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

    def _columns(self, name: str, wanted: tuple[tuple[str, ...], ...]) -> NumberColumns:
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
            columns = self._columns(name, diagrams.HEADS)
            pressure = diagrams.build_diagram(gas, name, columns, self.strokes)
        except BalcliError as error:
            path = "gas.harmonics" if own.indicator is None else own.path
            self.problems.append(Problem(path, str(error)))
            return None
        found = press(piston, pressure, pressure.breaks, gas.crankcase * BAR)
        self.doubts += diagrams.list_doubts(gas, own.path, name, columns, pressure, found.imep)
        return found

    def _read_harmonics(self, name: str, piston: GasPiston) -> GasTorque:
        """Return the torque of a builders' table: T/(A r) = a cos n c + b sin n c, c from the
        firing dead centre.
        """
        columns = self._columns(name, (("order",), ("cos",), ("sin",)))
        orders, cosines, sines = (np.array(columns.column(k)) for k in range(3))
        if not len(orders):
            raise BalcliError(f"{name}: has no rows; give order,cos,sin in each")

        def refuse(rows: NDArray[np.bool_], what: str) -> None:
            for row in np.flatnonzero(rows)[:1].tolist():
                line = f"{name}: line {columns.lines[row]}"
                raise BalcliError(f"{line}: {what.format(order=orders[row], sine=sines[row])}")

        step = 2 / self.strokes
        refuse(np.append(False, np.diff(orders) <= 0), "orders have to rise")
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
        """Return `CylinderGas.nominal_deg` of each row. Cylinder 1 fires in [-180, 180) deg of
        crank angle, the others next to when the firing order has them fire.
        """
        parts, cycle = self.parts, 180.0 * self.strokes
        phi, first = self.cylinders.angle_deg, parts.numbers.index(1)
        fires = parts.fires_deg if parts.order is not None else {}
        found = []
        for row, number in enumerate(parts.numbers):
            at = 0.0 - float(phi[row])
            top = math.degrees(tops[row] - tops[first])
            wanted = float(fires[number] - fires[1]) if number in fires else 0.0
            at += 360.0 * round((wanted - top - at) / 360.0)
            found.append(at % cycle)
        return found

"""From [gas], and what cylinders say of it, to the gas in an engine's cylinders."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ..core.combustion import Burn, Diesel, Dual, Otto, Wiebe
from ..core.cylinder_pressure import (
    CylinderPressure,
    GasError,
    GasPiston,
    GasTorque,
    PressureOnPiston,
    pistons,
)
from ..core.gas_cycle import GasCycle, Goal, Process, find_cycle_mistakes, gas_cycle
from ..core.phasors import Figure
from ..core.tangential_force import tangential_torque
from ..enginefile.csv_columns import NumberColumns, locate_beside, read_columns
from ..enginefile.gas_tables import DIAGRAM_KEYS, Gas
from ..enginefile.units import BAR
from ..errors import BalcliError, InputError, Problem
from ..limits import HIGHEST_TABLE_ORDER
from . import indicator_diagram as diagrams
from .gas import CylinderGas, EngineGas
from .indicator_diagram import GasSource

# Heat of fuel that uses up all air, over pressure times volume of that air: 2.95 MJ/kg of petrol
# and Diesel fuel alike, at 300 K; more than HEAT_MOST is doubted.
HEAT_OF_AIR, HEAT_MOST = 34, 40.0

if TYPE_CHECKING:
    from ..core.cylinders import Cylinders
    from .assembly import Assembly


def build_gas(parts: Assembly, cylinders: Cylinders | None = None) -> EngineGas:
    """The gas of an engine whose tables fit together otherwise.

    Args:
        cylinders: that have other mechanisms than its own, if it is theirs.

    Raises:
        InputError: every mistake of [gas], of what cylinders say of it, and of the files named
            there.
    """
    return _Builder(parts, parts.cylinders if cylinders is None else cylinders).build()


class _Builder:
    """The gas of an engine while it is put together."""

    def __init__(self, parts: Assembly, cylinders: Cylinders) -> None:
        gas = parts.model.gas
        if gas is None:
            raise ValueError("an engine file without [gas]")
        self.parts, self.gas = parts, _vary(gas, parts.figures.of_table("gas"))
        self.cylinders = cylinders
        self.strokes = parts.model.layout.strokes
        self.problems: list[Problem] = []
        self.doubts: list[str] = []
        self._overfed = False
        self._read: dict[str, NumberColumns] = {}

    def build(self) -> EngineGas:
        self.problems += self._check_tables()
        self._refuse()
        c, bore = self.cylinders, self._bore or 0.0
        found = pistons(c, math.pi / 4 * (bore / 1e3) ** 2)
        like = self._find_like()
        numbers = self.parts.numbers
        torques = {row: self._torque(numbers[row], found[row]) for row in dict.fromkeys(like)}
        self._refuse()
        self.doubts += self._find_idle()
        nominal = self._find_nominal([piston.top for piston in found])
        return EngineGas(
            tuple(
                CylinderGas(
                    found[row],
                    torque,
                    nominal[row],
                    self._share(numbers[row]),
                    self._heat(numbers[row]),
                    first,
                )
                for row, first in enumerate(like)
                if (torque := torques[first]) is not None
            ),
            180 * self.strokes,
            self.gas.mechanical_efficiency,
            self.gas.compression_ratio,
            tuple(self.doubts),
        )

    def _refuse(self) -> None:
        if self.problems:
            raise InputError(list(dict.fromkeys(self.problems)))

    # -------------------------------------------------------------- what does not fit together
    def _check_tables(self) -> Iterator[Problem]:
        model, gas = self.parts.model, self.gas
        yield from (Problem("gas", fault) for fault in gas.contradictions())  # of what varies
        if self._bore is None:
            yield Problem.of_missing("piston.bore", "gas presses on its area, such as bore = 86")
        if self.strokes == 4 and self.parts.order is None and len(self.parts.numbers) > 1:
            yield Problem.of_missing(
                "layout.firing_order",
                "a four-stroke cylinder fires in every second revolution, and only "
                "the firing order says in which, such as firing_order = [1, 3, 4, 2]",
            )
        if gas.cycle is None:
            for number, table in model.cylinder.items():
                if table.heat is not None:
                    yield Problem(
                        f"cylinder.{number}.heat",
                        "belongs to a computed cycle, and [gas] has none; give the cylinder a "
                        "diagram of its own (indicator)",
                    )
        yield from self._find_misplaced()

    def _find_misplaced(self) -> Iterator[Problem]:
        """Keys of [gas] that this engine cannot have."""
        gas = self.gas
        for key in () if self._is_measured else DIAGRAM_KEYS:
            if key in gas.model_fields_set:
                yield Problem(f"gas.{key}", "belongs to an indicator diagram; leave it out")
        if self.strokes == 2 and gas.zero == "gas-exchange":
            yield Problem(
                "gas.zero", 'a two-stroke cycle has no gas-exchange dead centre; give "firing"'
            )

    def _find_idle(self) -> Iterator[str]:
        """Keys of [gas] that change nothing of this engine, each with the reason."""
        given = self.gas.model_fields_set
        if self.gas.harmonics and not self._is_measured and "crankcase" in given:
            yield "gas.crankcase changes nothing beside harmonics, which are of the torque"
        if self.strokes == 2 and "exhaust" in given:
            yield (
                "gas.exhaust changes nothing in a two-stroke cycle: while its ports are open the "
                "pressure is that of intake"
            )

    @property
    def _is_measured(self) -> bool:
        """Whether any cylinder has an indicator diagram."""
        tables = self.parts.model.cylinder.values()
        return bool(self.gas.indicator) or any(table.indicator is not None for table in tables)

    @property
    def _bore(self) -> float | None:
        """Mm."""
        given = self.parts.model.piston.bore
        found = self.parts.figures.take_optional("piston.bore", given)
        return None if found is None else float(found)

    # -------------------------------------------------------------- one cylinder
    def _share(self, number: int) -> float:
        own = self.parts.model.cylinder.get(number)
        given = 1.0 if own is None or own.gas is None else own.gas
        return float(self.parts.figures.take(f"cylinder.{number}.gas", given))

    def _heat(self, number: int) -> float | None:
        """Supplied in a cycle that is computed, J, where the file says so."""
        if self._source(number).indicator is not None:
            return None
        own = self._own_heat(number)
        return self.gas.heat if own is None else own

    def _own_heat(self, number: int) -> float | None:
        own = self.parts.model.cylinder.get(number)
        given = None if own is None else own.heat
        found = self.parts.figures.take_optional(f"cylinder.{number}.heat", given)
        return None if found is None else float(found)

    def _source(self, number: int) -> GasSource:
        own = self.parts.model.cylinder.get(number)
        if own is not None and own.indicator is not None:
            return GasSource(f"cylinder.{number}.indicator", own.indicator)
        return GasSource("gas.indicator", self.gas.indicator)

    def _find_like(self) -> list[int]:
        """`CylinderGas.like` of each row."""
        first: dict[tuple[object, ...], int] = {}
        each = zip(self.cylinders.mechanisms, self.parts.numbers, strict=True)
        return [
            first.setdefault((*mechanism, self._source(number).indicator, self._heat(number)), row)
            for row, (mechanism, number) in enumerate(each)
        ]

    def _torque(self, number: int, piston: GasPiston) -> GasTorque | None:
        """That of a cylinder; None after a mistake."""
        source = self._source(number)
        try:
            return self._make(number, source, piston)
        except BalcliError as error:
            path = source.path if source.indicator is not None else "gas.harmonics"
            self.problems.append(Problem(path, str(error)))
            return None

    def _make(self, number: int, source: GasSource, piston: GasPiston) -> GasTorque | None:
        gas = self.gas
        if source.indicator is not None:
            columns = self._columns(source.indicator, diagrams.HEADS)
            measured = diagrams.build_diagram(gas, source.indicator, columns, self.strokes)
            found = PressureOnPiston(piston, measured, gas.crankcase * BAR)
            self.doubts += diagrams.list_doubts(gas, source, columns, found)
            return found
        if gas.harmonics is not None:
            return self._harmonics(gas.harmonics, piston)
        pressure = self._cycle(number, piston)
        return None if pressure is None else PressureOnPiston(piston, pressure, gas.crankcase * BAR)

    def _columns(self, name: str, wanted: tuple[tuple[str, ...], ...]) -> NumberColumns:
        if name not in self._read:
            path = locate_beside(self.parts.model.folder, name)
            self._read[name] = read_columns(path, wanted)
        return self._read[name]

    # -------------------------------------------------------------- builders' tables
    def _harmonics(self, name: str, piston: GasPiston) -> GasTorque:
        columns = self._columns(name, (("order",), ("cos",), ("sin",)))
        orders, cosines, sines = (np.array(columns.column(k)) for k in range(3))
        if not len(orders):
            raise BalcliError(f"{name}: has no rows; give order,cos,sin in each")
        if len(not_rising := np.flatnonzero(np.diff(orders) <= 0)):
            line = columns.lines[not_rising[0] + 1]
            raise BalcliError(f"{name}: line {line}: orders have to rise")
        if len(high := np.flatnonzero(orders > HIGHEST_TABLE_ORDER)):
            raise BalcliError(
                f"{name}: line {columns.lines[high[0]]}: order {orders[high[0]]:g} is above "
                f"{HIGHEST_TABLE_ORDER}, where no table goes"
            )
        if not orders[0] and sines[0]:
            raise BalcliError(
                f"{name}: line {columns.lines[0]}: order 0 has sin {sines[0]:g}; it is the mean, "
                "which has no sine: write 0"
            )
        radius = float(self.cylinders.radius)
        try:
            return tangential_torque(
                orders,
                cosines * BAR,
                sines * BAR,
                area=piston.area,
                radius=radius,
                strokes=self.strokes,
            )
        except GasError as error:
            raise BalcliError(f"{name}: {error}") from None

    # -------------------------------------------------------------- computed cycles
    def _cycle(self, number: int, piston: GasPiston) -> CylinderPressure | None:
        process, burn, goal = self._process(), self._burn(), find_goal(self.gas)
        heat = self._heat(number)
        if heat is not None:
            goal = Goal("heat", heat)
        if heat == 0:  # it expands as it was compressed
            burn, process = Otto(), replace(process, expansion_index=process.compression_index)
        wrong = list(find_cycle_mistakes(piston, process, burn, goal))
        if not wrong:
            try:
                cycle = gas_cycle(piston, process, burn, goal)
            except GasError as error:
                wrong = [error]
            else:
                self.doubts += self._doubt_heat(cycle, number)
                return cycle
        self.problems += (self._locate(error, number) for error in wrong)
        return None

    def _doubt_heat(self, cycle: GasCycle, number: int) -> Iterator[str]:
        """More heat than the air of the charge burns, told once."""
        piston, process, _, goal = cycle.asked
        charge = process.intake * float(piston.volume(cycle.corners[0], process.compression_ratio))
        if self._overfed or not cycle.heat > HEAT_MOST * charge:
            return
        self._overfed = True
        path = self._locate(GasError(goal.name, ""), number).path
        yield (
            f"{path} takes {cycle.heat:.4g} J of heat in each cycle, {cycle.heat / charge:.2g} "
            f"times the pressure times the volume of its charge; fuel for all of that air gives "
            f"some {HEAT_OF_AIR:g} times; is gas.intake = {process.intake / BAR:.4g} bar right? It "
            "is absolute, and more where the engine is supercharged"
        )

    def _locate(self, error: GasError, number: int) -> Problem:
        """A mistake of a cylinder's cycle by its path in the file."""
        if error.field == "heat" and self._own_heat(number) is not None:
            return Problem(f"cylinder.{number}.heat", str(error))
        if error.field == "expansion_index" and self._heat(number) == 0:
            what = f"where cylinder {number} burns nothing, it expands as it was compressed"
            return Problem("gas.compression_index", f"{error}; {what}")
        if error.field == "imep" and self.gas.bmep is not None:
            return Problem("gas.bmep", f"over mechanical_efficiency, the imep, {error}")
        return Problem(f"gas.{error.field}", str(error))

    def _process(self) -> Process:
        g = self.gas
        return Process(
            compression_ratio=_find_known(g.compression_ratio),
            strokes=self.strokes,
            compression_index=g.compression_index,
            expansion_index=g.expansion_index,
            intake=g.intake * BAR,
            exhaust=g.exhaust * BAR,
            exhaust_opens_deg=g.exhaust_opens,
            intake_closes_deg=g.intake_closes,
        )

    def _burn(self) -> Burn:
        g = self.gas
        match g.cycle:
            case "diesel":
                return Diesel()
            case "dual":
                return Dual(_find_known(g.max_pressure) * BAR)
            case "wiebe":
                return Wiebe(g.burn_start, g.burn_duration, g.burn_shape)
            case _:
                return Otto()

    # -------------------------------------------------------------- firing
    def _find_nominal(self, tops: list[float]) -> list[float]:
        """`CylinderGas.nominal_deg` of each row. Cylinder 1 fires in [-180, 180) deg of crank
        angle, the others next to when the firing order has them fire.
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


def _vary(gas: Gas, varied: Mapping[str, Figure]) -> Gas:
    """With other figures in place of some, and of what says the same."""
    if not varied:
        return gas
    displaced = {rival for key in varied for rival in gas.rivals(key)}
    said = {key: getattr(gas, key) for key in gas.model_fields_set - displaced}
    return Gas.model_construct(**said | {key: float(value) for key, value in varied.items()})


def find_goal(gas: Gas) -> Goal:
    """What a computed cycle is to have."""
    if gas.imep is not None:
        return Goal("imep", gas.imep * BAR)
    if gas.bmep is not None:
        return Goal("imep", gas.bmep * BAR / _find_known(gas.mechanical_efficiency))
    if gas.heat is not None:
        return Goal("heat", gas.heat)
    if gas.cut_off is not None:
        return Goal("cut_off", gas.cut_off)
    return Goal("max_pressure", _find_known(gas.max_pressure) * BAR)


def _find_known(figure: float | None) -> float:
    """A figure that the rules of [gas] ask for; nan after a mistake."""
    return math.nan if figure is None else figure

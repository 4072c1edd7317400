"""Gas in an engine's cylinders: which torque it makes in each, and when each fires.

The cycle angle of a cylinder is 0 at the upper dead centre of its own mechanism next to which it
fires; which of the two revolutions of a four-stroke cycle that is, the firing order says.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..core import pressure_diagram as diagrams
from ..core.combustion import Burn, Diesel, Dual, Otto, Wiebe
from ..core.cylinder_pressure import (
    CylinderPressure,
    GasError,
    GasTorque,
    Piston,
    PressureOnPiston,
    pistons,
)
from ..core.gas_cycle import Goal, Process, gas_cycle
from ..core.gas_cycle import mistakes as cycle_mistakes
from ..core.phasors import Array, Figure
from ..core.tangential_force import tangential_torque
from ..enginefile.csv_columns import Columns, locate_beside, read_columns
from ..enginefile.gas_tables import DIAGRAM_KEYS, GOALS, Gas
from ..enginefile.suspicious import MAX_PRESSURE
from ..enginefile.units import INCH, POUND_FORCE
from ..errors import BalcliError, InputError, Problem
from ..limits import HIGHEST_TABLE_ORDER

if TYPE_CHECKING:
    from ..core.cylinders import Cylinders
    from .assembly import Assembly

BAR = 1e5  # Pa
_PSI = POUND_FORCE / float(INCH) ** 2  # Pa
_GAUGE_HEADS = {"pressure_barg": BAR, "pressure_psig": _PSI}  # over the atmosphere
PRESSURE_HEADS = {
    "pressure_bar": BAR,
    "pressure_MPa": 1e6,
    "pressure_kPa": 1e3,
    "pressure_Pa": 1.0,
    "pressure_psi": _PSI,
    **_GAUGE_HEADS,
}
LOW_PRESSURE = 0.1  # bar; a throttled engine draws in at 0.3
ASK_GAUGE = '; is it over the atmosphere? Then give pressure = "gauge"'
NEAR_DEG = 45.0  # from the firing dead centre: there the pressure of every engine is highest
SAME_IMEP = 0.03  # by which a diagram may miss the stated mean effective pressure


class CylinderGas(NamedTuple):
    """Gas of one cylinder.

    Attributes:
        piston: its mechanism, with the area of the bore.
        torque: by cycle angle, without the share; a `PressureOnPiston` unless only its harmonics
            are known.
        nominal_deg: crank angle, in [0, 720) or [0, 360), at which its crank pin stands along its
            axis when it fires.
        share: by which the gas force is multiplied; 0 is a misfire.
        like: row of the first cylinder with an equal mechanism and the same diagram: what they have
            but for `nominal_deg` and `share` is equal.
    """

    piston: Piston
    torque: GasTorque
    nominal_deg: float
    share: float
    like: int

    @property
    def fires(self) -> float:
        """Crank angle of its firing dead centre, rad: cycle angle = crank angle - `fires`."""
        return math.radians(self.nominal_deg) + self.piston.top


@dataclass(frozen=True, eq=False)
class EngineGas:
    """Gas of an engine.

    Attributes:
        cylinders: one for each row of `Engine.cylinders`.
        cycle_deg: 720, or 360 of a two-stroke engine.
        mechanical_efficiency: brake over indicated work; None: not known.
        compression_ratio: None where the file does not say.
        doubts: what is suspicious of the file, in words, each by its path.
    """

    cylinders: tuple[CylinderGas, ...]
    cycle_deg: int
    mechanical_efficiency: float | None = None
    compression_ratio: float | None = None
    doubts: tuple[str, ...] = ()

    @property
    def cycle(self) -> float:
        """Rad."""
        return math.radians(self.cycle_deg)

    @property
    def fires(self) -> Array:
        """`CylinderGas.fires` of each, rad, shape (cylinders,)."""
        return np.array([cylinder.fires for cylinder in self.cylinders])

    @property
    def shares(self) -> Array:
        """`CylinderGas.share` of each, shape (cylinders,)."""
        return np.array([cylinder.share for cylinder in self.cylinders])

    def group_equal(self) -> list[tuple[GasTorque, list[int]]]:
        """Each torque, with the rows of the equal cylinders that have it."""
        rows: dict[int, list[int]] = {}
        for row, cylinder in enumerate(self.cylinders):
            rows.setdefault(cylinder.like, []).append(row)
        return [(self.cylinders[first].torque, own) for first, own in rows.items()]

    def with_share(self, row: int, share: float) -> EngineGas:
        """The same with another share of the cylinder in one row."""
        changed = list(self.cylinders)
        changed[row] = changed[row]._replace(share=share)
        return replace(self, cylinders=tuple(changed))


def build_gas(parts: Assembly, cylinders: Cylinders | None = None) -> EngineGas:
    """The gas of an engine whose tables fit together otherwise.

    Args:
        cylinders: that have other mechanisms than its own, if it is theirs.

    Raises:
        InputError: every mistake of [gas], of what cylinders say of it, and of the files named
            there.
    """
    return _Builder(parts, parts.cylinders if cylinders is None else cylinders).build()


class _Source(NamedTuple):
    """Where a cylinder's gas comes from: its own diagram (path in the file and name), or [gas]."""

    path: str
    indicator: str | None


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
        self._read: dict[str, Columns] = {}

    def build(self) -> EngineGas:
        self.problems += self._check_tables()
        self._refuse()
        c, bore = self.cylinders, self._bore or 0.0
        found = pistons(c, math.pi / 4 * (bore / 1e3) ** 2)
        like = self._find_like()
        numbers = self.parts.numbers
        torques = {row: self._torque(numbers[row], found[row]) for row in dict.fromkeys(like)}
        self._refuse()
        nominal = self._find_nominal([piston.top for piston in found])
        return EngineGas(
            tuple(
                CylinderGas(found[row], torque, nominal[row], self._share(numbers[row]), first)
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
        if self._bore is None:
            yield Problem("piston.bore", "is missing; gas presses on its area, such as bore = 86")
        if self.strokes == 4 and self.parts.order is None and len(self.parts.numbers) > 1:
            yield Problem(
                "layout.firing_order",
                "is missing; a four-stroke cylinder fires in every second revolution, and only "
                "the firing order says in which, such as firing_order = [1, 3, 4, 2]",
            )
        own = [n for n, table in model.cylinder.items() if table.indicator is not None]
        if gas.indicator is None and not own:
            for key in DIAGRAM_KEYS:
                if key in gas.model_fields_set:
                    yield Problem(f"gas.{key}", "belongs to an indicator diagram; leave it out")
        if self.strokes == 2 and gas.zero == "gas-exchange":
            yield Problem(
                "gas.zero", 'a two-stroke cycle has no gas-exchange dead centre; give "firing"'
            )

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

    def _source(self, number: int) -> _Source:
        own = self.parts.model.cylinder.get(number)
        if own is not None and own.indicator is not None:
            return _Source(f"cylinder.{number}.indicator", own.indicator)
        return _Source("gas.indicator", self.gas.indicator)

    def _find_like(self) -> list[int]:
        """`CylinderGas.like` of each row."""
        first: dict[tuple[object, ...], int] = {}
        each = zip(self.cylinders.mechanisms, self.parts.numbers, strict=True)
        return [
            first.setdefault((*mechanism, self._source(number).indicator), row)
            for row, (mechanism, number) in enumerate(each)
        ]

    def _torque(self, number: int, piston: Piston) -> GasTorque | None:
        """That of a cylinder; None after a mistake."""
        source = self._source(number)
        try:
            return self._make(source, piston)
        except BalcliError as error:
            path = source.path if source.indicator is not None else "gas.harmonics"
            self.problems.append(Problem(path, str(error)))
            return None

    def _make(self, source: _Source, piston: Piston) -> GasTorque | None:
        gas = self.gas
        if source.indicator is not None:
            found = PressureOnPiston(piston, self._diagram(source), gas.crankcase * BAR)
            self._doubt_diagram(source, found)
            return found
        if gas.harmonics is not None:
            return self._harmonics(gas.harmonics, piston)
        pressure = self._cycle(piston)
        return None if pressure is None else PressureOnPiston(piston, pressure, gas.crankcase * BAR)

    def _columns(self, name: str, wanted: tuple[tuple[str, ...], ...]) -> Columns:
        if name not in self._read:
            path = locate_beside(self.parts.model.folder, name)
            self._read[name] = read_columns(path, wanted)
        return self._read[name]

    # -------------------------------------------------------------- diagrams
    def _diagram(self, source: _Source) -> diagrams.PressureDiagram:
        gas, name = self.gas, source.indicator or ""
        columns = self._columns(name, (("angle_deg",), tuple(PRESSURE_HEADS)))
        head = columns.heads[1]
        unit = PRESSURE_HEADS[head]
        is_gauge = gas.pressure == "gauge" or head in _GAUGE_HEADS
        gauge = diagrams.ATMOSPHERE if is_gauge else 0.0
        pressure = np.array(columns.column(1)) * unit + gauge
        angle = np.array(columns.column(0))
        wrong = list(diagrams.mistakes(angle, pressure, strokes=self.strokes))
        if wrong:
            line = "" if wrong[0].row is None else f"line {columns.lines[wrong[0].row]}: "
            below_zero = wrong[0].row is not None and pressure[wrong[0].row] < 0
            hint = ASK_GAUGE if below_zero and not gauge else ""
            raise BalcliError(f"{name}: {line}{wrong[0].message}{hint}")
        firing = 360.0 if gas.zero == "gas-exchange" else 0.0
        found = diagrams.pressure_diagram(
            angle, pressure, strokes=self.strokes, firing_deg=firing - gas.phase
        )
        if found.closing_step:
            last = pressure[-1] / BAR
            first = pressure[0] / BAR
            self.doubts.append(
                f"{source.path}: {name}: the last row closes the cycle with {last:.4g} bar, the "
                f"first has {first:.4g} bar; the first is taken"
            )
        return found

    def _doubt_diagram(self, source: _Source, gas: PressureOnPiston) -> None:
        angle, value = gas.pressure.highest()
        if abs(math.degrees(angle)) > NEAR_DEG:
            self.doubts.append(
                f"{source.path}: the highest pressure, {value / BAR:.4g} bar, stands at "
                f"{math.degrees(angle):.4g} deg from the firing dead centre, where within "
                f"{NEAR_DEG:g} is usual; are gas.zero and gas.phase right?"
            )
        if value > MAX_PRESSURE * BAR:
            self.doubts.append(
                f"{source.path}: the highest pressure is {value / BAR:.4g} bar, where at most "
                f"{MAX_PRESSURE:g} is usual; does the heading of its column name the right unit?"
            )
        lowest = gas.pressure.curve.extremes()[0].value / BAR
        if lowest < LOW_PRESSURE:
            self.doubts.append(
                f"{source.path}: the lowest pressure is {lowest:.4g} bar absolute, where at least "
                f"{LOW_PRESSURE:g} is usual{ASK_GAUGE}"
            )
        stated = self.gas.imep
        if stated is not None and source.path == "gas.indicator":
            found = gas.imep / BAR
            if abs(found - stated) > SAME_IMEP * abs(stated):
                self.doubts.append(
                    f"gas.imep is {stated:g} bar, and the diagram has {found:.4g} bar; a phase of "
                    "one degree makes about 7 %: is gas.phase right?"
                )

    # -------------------------------------------------------------- builders' tables
    def _harmonics(self, name: str, piston: Piston) -> GasTorque:
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
    def _cycle(self, piston: Piston) -> CylinderPressure | None:
        process, burn, goal = self._process(), self._burn(), find_goal(self.gas)
        wrong = list(cycle_mistakes(piston, process, burn, goal))
        if not wrong:
            try:
                return gas_cycle(piston, process, burn, goal)
            except GasError as error:
                wrong = [error]
        self.problems += map(self._locate, wrong)
        return None

    def _locate(self, error: GasError) -> Problem:
        """A mistake of a cycle by its path in the file."""
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
    """With other figures in place of some; a goal in place of another one."""
    if not varied:
        return gas
    update: dict[str, float | None] = {key: float(value) for key, value in varied.items()}
    if new := [key for key in GOALS if key in varied]:
        kept = ("max_pressure",) if gas.cycle == "dual" else ()
        update = dict.fromkeys((g for g in GOALS if g not in (*new, *kept)), None) | update
    return gas.model_copy(update=update)


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

"""Indicator diagrams: measured pressures over the crank angle, in files beside the engine file."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ..core.cylinder_pressure import PressureOnPiston
from ..core.phasors import Array
from ..core.pressure_diagram import (
    ATMOSPHERE,
    PressureDiagram,
    find_diagram_mistakes,
    pressure_diagram,
)
from ..enginefile.csv_columns import NumberColumns
from ..enginefile.gas_tables import Gas
from ..enginefile.suspicious import MAX_PRESSURE
from ..enginefile.units import BAR, INCH, POUND_FORCE
from ..errors import BalcliError

_PSI = POUND_FORCE / float(INCH) ** 2  # Pa
_GAUGE_HEADS = {"pressure_barg": BAR, "pressure_psig": _PSI}  # over the atmosphere
_PRESSURE_HEADS = {
    "pressure_bar": BAR,
    "pressure_MPa": 1e6,
    "pressure_kPa": 1e3,
    "pressure_Pa": 1.0,
    "pressure_psi": _PSI,
    **_GAUGE_HEADS,
}
HEADS = (("angle_deg",), tuple(_PRESSURE_HEADS))  # of its columns
LOW_PRESSURE = 0.1  # bar; a throttled engine draws in at 0.3
ASK_GAUGE = '; is it over the atmosphere? Then give pressure = "gauge"'
NEAR_DEG = 45.0  # from the firing dead centre: there the pressure of every engine is highest
SAME_IMEP = 0.03  # by which a diagram may miss the stated mean effective pressure


class GasSource(NamedTuple):
    """Where a cylinder's gas comes from: its own diagram (path in the file and name), or [gas]."""

    path: str
    indicator: str | None


def build_diagram(gas: Gas, name: str, columns: NumberColumns, strokes: int) -> PressureDiagram:
    """The pressure over a cycle by the columns of the file of this name.

    Raises:
        BalcliError: the first mistake in the file, by its line.
    """
    angle, pressure = np.array(columns.column(0)), _read_pressure(gas, columns)
    for wrong in find_diagram_mistakes(angle, pressure, strokes=strokes):
        line = "" if wrong.row is None else f"line {columns.lines[wrong.row]}: "
        below_zero = wrong.row is not None and pressure[wrong.row] < 0
        hint = ASK_GAUGE if below_zero and not _is_gauge(gas, columns) else ""
        raise BalcliError(f"{name}: {line}{wrong.message}{hint}")
    firing = 360.0 if gas.zero == "gas-exchange" else 0.0
    return pressure_diagram(angle, pressure, strokes=strokes, firing_deg=firing - gas.phase)


def _read_pressure(gas: Gas, columns: NumberColumns) -> Array:
    """Absolute, Pa, shape (rows,)."""
    unit = _PRESSURE_HEADS[columns.heads[1]]
    gauge = ATMOSPHERE if _is_gauge(gas, columns) else 0.0
    return np.array(columns.column(1)) * unit + gauge


def _is_gauge(gas: Gas, columns: NumberColumns) -> bool:
    return gas.pressure == "gauge" or columns.heads[1] in _GAUGE_HEADS


def list_doubts(
    gas: Gas, source: GasSource, columns: NumberColumns, found: PressureOnPiston
) -> Iterator[str]:
    """What is suspicious of a diagram, each with its path in the engine file."""
    pressure = _read_pressure(gas, columns) / BAR
    if isinstance(found.pressure, PressureDiagram) and found.pressure.closing_step:
        yield (
            f"{source.path}: {source.indicator}: the last row closes the cycle with "
            f"{pressure[-1]:.4g} bar, the first has {pressure[0]:.4g} bar; the first is taken"
        )
    angle, value = found.pressure.highest()
    if abs(math.degrees(angle)) > NEAR_DEG:
        yield (
            f"{source.path}: the highest pressure, {value / BAR:.4g} bar, stands at "
            f"{math.degrees(angle):.4g} deg from the firing dead centre, where within "
            f"{NEAR_DEG:g} is usual; are gas.zero and gas.phase right?"
        )
    if value > MAX_PRESSURE * BAR:
        yield (
            f"{source.path}: the highest pressure is {value / BAR:.4g} bar, where at most "
            f"{MAX_PRESSURE:g} is usual; does the heading of its column name the right unit?"
        )
    lowest = found.pressure.curve.extremes()[0].value / BAR
    if lowest < LOW_PRESSURE:
        yield (
            f"{source.path}: the lowest pressure is {lowest:.4g} bar absolute, where at least "
            f"{LOW_PRESSURE:g} is usual{ASK_GAUGE}"
        )
    stated = gas.imep
    if stated is not None and source.path == "gas.indicator":
        measured = found.imep / BAR
        if abs(measured - stated) > SAME_IMEP * abs(stated):
            yield (
                f"gas.imep is {stated:g} bar, and the diagram has {measured:.4g} bar; a phase of "
                "one degree makes 3 to 7 %: is gas.phase right?"
            )

"""Read indicator diagrams: measured cylinder pressures over the crank angle, in CSV files.

The pressure is linear between rows, and periodic. If a file has several cycles, one after the
other, their mean is used.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import ArrayLike

from ..core.cylinder_pressure import find_highest
from ..core.phasors import Array
from ..core.piecewise import PiecewiseCurve, polyline
from ..errors import BalcliError
from ..file.csv_columns import ANGLE_SYMBOLS, GAUGE_UNITS, Head, NumberColumns
from ..file.doubt import Doubt
from ..file.doubts import MAX_PRESSURE
from ..file.gas_tables import Gas
from ..file.units import ANGLE, BAR, PRESSURE

ATMOSPHERE = 101325.0  # absolute pressure minus gauge pressure, Pa
WIDEST_GAP = 30.0  # largest gap between two rows, deg
FLAT_GAP = 45.0  # largest gap during gas exchange, where the pressure hardly changes, deg
_FLAT = 0.01  # the pressure hardly changes: by less than this share of the highest pressure
_SAME = 1e-6  # deg; tolerance for two rows that are one period apart, the ends of the period
_OTHERS = ("MPa", "kPa", "Pa", "psi", *GAUGE_UNITS)
_SYMBOLS = r"(?:in[-\s_]?)?cyl(?:inder|\.)?[\s_]*press(?:ure)?|press|p(?:[\s_]*cyl(?:inder)?)?"
HEADS = (
    Head("angle_deg", ANGLE, symbols=ANGLE_SYMBOLS),
    Head("pressure_bar", PRESSURE, tuple(f"pressure_{unit}" for unit in _OTHERS), _SYMBOLS),
)
# Columns in place of the angle, for cards over the volume or the stroke; any unit
_CARDS = ("volume", "travel", "stroke")
LOW_PRESSURE = 0.1  # lowest usual pressure, bar; a throttled engine draws in at 0.3
ASK_GAUGE = '; is it a gauge pressure? Then give pressure = "gauge"'
NEAR_DEG = 45.0  # usual largest distance of the highest pressure from the firing dead centre, deg
SAME_IMEP = 0.03  # a larger relative difference from the stated imep gives a warning


def build_diagram(
    gas: Gas, path: str, name: str, columns: NumberColumns, strokes: int
) -> tuple[PiecewiseCurve, list[Doubt]]:
    """Return the absolute pressure (Pa) over the cycle angle, and warnings if cycles are averaged
    or the last row is not used.

    Args:
        gas: Table of the engine file that describes the diagram.
        path: Key of the engine file that names the diagram's file.
        name: Name of the diagram's file.
        columns: Columns of the diagram's file.
        strokes: 4 or 2.

    Raises:
        BalcliError: The first mistake in the diagram's file, with its line number.
    """
    period = 180.0 * strokes
    angle = np.array(columns.column(0))
    pressure = find_absolute(gas, name, columns)
    angle, pressure, count = _average_cycles(angle, pressure, period)
    for row, message in find_diagram_mistakes(angle, pressure, strokes=strokes):
        line = "" if row is None else f"line {columns.lines[row]}: "
        raise BalcliError(f"{name}: {line}{message}")
    firing = 360.0 if gas.zero == "gas-exchange" else 0.0
    curve = draw_diagram(angle, pressure, strokes=strokes, firing_deg=firing - gas.phase)
    doubts = []
    if count > 1:
        doubts.append(Doubt(path, f"{name}: has {count} cycles; their mean is used"))
    first, last = (float(pressure[k]) / (columns.scales[1] * BAR) for k in (0, -1))
    if first != last and _is_closed(angle, period):
        unit = _name_unit(columns)
        message = (
            f"{name}: the last row closes the cycle with {last:.4g} {unit}, but the first row has "
            f"{first:.4g} {unit}; the first is used"
        )
        doubts.append(Doubt(path, message))
    return curve, doubts


def choose_heads(heading: Sequence[str]) -> tuple[Head, ...]:
    """Return the heads of the columns of a diagram: those with the angle, or those of a card with
    volume, travel or stroke.

    Args:
        heading: Heads of the columns of the file.
    """
    words = re.split(r"[^a-z]+", " ".join(heading).lower())
    kind = next((kind for kind in _CARDS if kind in words), None)
    if kind is None or "angle" in words:
        return HEADS
    return Head(kind, any_unit=True), HEADS[1]


def find_absolute(gas: Gas, name: str, columns: NumberColumns) -> Array:
    """Return the absolute pressures of the rows of a diagram, Pa.

    Raises:
        BalcliError: A pressure is below zero.
    """
    gauge = gas.pressure == "gauge" or columns.units[1] in GAUGE_UNITS
    pressure = np.array(columns.column(1)) * BAR
    pressure += ATMOSPHERE if gauge else 0.0
    for below in np.flatnonzero(pressure < 0).tolist():
        fault = f"line {columns.lines[below]}: the pressure is {columns.as_written(below, 1)}"
        right = "that is below a vacuum" if gauge else f"give 0 or more{ASK_GAUGE}"
        right += "; for a double-acting cylinder give each end its own diagram ([gas.crank_end])"
        raise BalcliError(f"{name}: {fault}: {right}")
    return pressure


def _name_unit(columns: NumberColumns) -> str:
    """Return the unit of a diagram's pressures, without the g of gauge pressures."""
    return columns.units[1].removesuffix("g")


def _average_cycles(angle: Array, pressure: Array, period: float) -> tuple[Array, Array, int]:
    """Return angles (deg) and pressures of one cycle, and the number of cycles in the rows. Several
    cycles are averaged at the angles of the first cycle. The rows of a single cycle keep their
    pressures; angles that begin anew within the cycle are continued.
    """
    steps = np.diff(angle)
    starts = np.flatnonzero(steps < -period / 2)  # the angles of each cycle begin anew
    if len(angle) < 2 or not (np.delete(steps, starts) > 0).all():
        return angle, pressure, 1
    through = angle + period * np.searchsorted(starts, np.arange(len(angle)) - 0.5)
    steps = np.diff(through)
    span = through[-1] - through[0]
    usual = np.median(np.diff(angle))
    count = round((span + usual) / period)
    gap = abs(span - count * period)
    if count < 2 or gap > 2 * usual + _SAME or not (steps > -_SAME).all():
        return (angle if (steps <= -_SAME).any() else through), pressure, 1
    kept = np.append(True, steps > _SAME)  # the end of a cycle is the beginning of the next
    first = through < through[0] + period - _SAME
    every = through[first] + period * np.arange(count)[:, np.newaxis]
    mean = np.interp(every, through[kept], pressure[kept]).mean(axis=0)
    return through[first], mean, count


def _is_closed(angle: Array, period: float) -> bool:
    """Return whether a diagram has a row at both ends of the period. The last row is not used."""
    return len(angle) > 1 and abs(angle[-1] - angle[0] - period) < _SAME


def draw_diagram(
    angle_deg: ArrayLike, pressure: ArrayLike, *, strokes: int = 4, firing_deg: float = 0.0
) -> PiecewiseCurve:
    """Return the pressure over the cycle angle, from rows without mistakes
    (`find_diagram_mistakes`).

    Args:
        angle_deg: Rising angles, deg, shape (rows,).
        pressure: Absolute pressures, Pa, shape (rows,).
        strokes: 4 or 2; the period is 720 or 360 deg.
        firing_deg: Angle of the firing dead centre in the diagram: minus the phase, or 360 minus
            the phase if angles count from the gas-exchange dead centre.
    """
    angle = np.asarray(angle_deg, float)
    values = np.asarray(pressure, float)
    period = 180.0 * strokes
    kept = slice(-1 if _is_closed(angle, period) else None)
    corners = np.append(angle[kept], angle[0] + period) - firing_deg
    return polyline(np.radians(corners), np.append(values[kept], values[0]))


def find_diagram_mistakes(
    angle_deg: ArrayLike, pressure: ArrayLike, *, strokes: int = 4
) -> Iterator[tuple[int | None, str]]:
    """Yield each mistake in a diagram with its row (from 0; None: the whole diagram).

    Args:
        angle_deg: Cycle angles, deg, shape (rows,).
        pressure: Absolute pressures, Pa, shape (rows,).
        strokes: 2 or 4.
    """
    angle = np.asarray(angle_deg, float)
    values = np.asarray(pressure, float)
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
    widest = np.where(flat, FLAT_GAP, WIDEST_GAP)  # widest gap before each row
    close = f"give rows at most {WIDEST_GAP:g}° apart"
    for row in (np.flatnonzero(np.diff(angle) > widest[1:]) + 1).tolist():
        gap = angle[row] - angle[row - 1]
        yield row, f"is {gap:g}° after the row before it: {close}"
    if (gap := period - span) > widest[0]:
        yield None, f"covers {span:g}° of {period:g}°, a gap of {gap:g}° at its end: {close}"


def list_doubts(
    gas: Gas,
    path: str,
    columns: NumberColumns,
    pressure: PiecewiseCurve,
    imep: float,
    *,
    fires: bool = True,
) -> Iterator[Doubt]:
    """Yield warnings of unlikely pressures in a diagram.

    Args:
        gas: Table [gas] of the engine file.
        path: Key of the engine file that names the diagram's file.
        columns: Columns of the diagram's file.
        pressure: Pressure over the cycle angle, Pa.
        imep: Indicated mean effective pressure, Pa.
        fires: Whether the highest pressure is expected near the dead centre at angle 0.
    """
    unit = _name_unit(columns)
    scale = columns.scales[1] * BAR  # Pa
    top, value = find_highest(pressure)
    if fires and abs(math.degrees(top)) > NEAR_DEG:
        message = (
            f"the highest pressure, {value / scale:.4g} {unit}, is at {math.degrees(top):.4g} deg "
            f"from the firing dead centre, where within {NEAR_DEG:g} is usual; are zero and phase "
            "right?"
        )
        yield Doubt(path, message, ("gas.zero", "gas.phase"))
    if value > MAX_PRESSURE * BAR:
        message = (
            f"the highest pressure is {value / scale:.4g} {unit}, where at most "
            f"{MAX_PRESSURE * BAR / scale:.4g} is usual; does the heading of its column "
            "name the right unit?"
        )
        yield Doubt(path, message)
    lowest = pressure.extremes()[0].value / scale
    if lowest * scale < LOW_PRESSURE * BAR:
        message = (
            f"the lowest pressure is {lowest:.4g} {unit} absolute, where at least "
            f"{LOW_PRESSURE * BAR / scale:.4g} is usual{ASK_GAUGE}"
        )
        yield Doubt(path, message)
    stated = gas.imep if path == "gas.indicator" else None
    measured = imep / BAR
    if stated is not None and abs(measured - stated) > SAME_IMEP * abs(stated):
        message = (
            f"{stated:g} bar, but the diagram has {measured:.4g} bar; a phase error of one degree "
            "changes it by 3 to 7 %: is phase right?"
        )
        yield Doubt("gas.imep", message, ("gas.phase",))

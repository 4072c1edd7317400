"""Measured pressure: rows of angle and pressure, straight lines between them, periodic."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from .cylinder_pressure import CylinderPressure
from .phasors import Array
from .piecewise import PiecewiseCurve, polyline

ATMOSPHERE = 101325.0  # Pa, what gauge pressures lack
WIDEST_GAP = 30.0  # deg between two rows; beyond, straight lines say nothing about an engine
FLAT_GAP = 45.0  # deg; the same while the gas is exchanged, where the pressure hardly changes
_CLOSE = f"give rows at most {WIDEST_GAP:g}° apart"
_FLAT = 0.01  # of the highest pressure
_SAME = 1e-6  # deg; rows so near to one period apart are the two ends of it


class DiagramMistake(NamedTuple):
    """A mistake in a measured diagram: the row (from 0; None: the diagram) and what is wrong."""

    row: int | None
    message: str


@dataclass(frozen=True)
class PressureDiagram(CylinderPressure):
    """A measured diagram.

    Attributes:
        lines: the diagram as a polyline, Pa at cycle angles.
        closing_step: closing row less first row, Pa, of a diagram that has a row at both ends of
            the period; the first holds.
    """

    lines: PiecewiseCurve
    closing_step: float = 0.0

    @property
    def breaks(self) -> Array:
        return self.lines.breaks

    @property
    def curve(self) -> PiecewiseCurve:
        """The polyline itself."""
        return self.lines

    def at(self, angle: ArrayLike, *, before: bool = False) -> Array:
        return self.lines.at(angle, before=before)


def pressure_diagram(
    angle_deg: ArrayLike, pressure: ArrayLike, *, strokes: int = 4, firing_deg: float = 0.0
) -> PressureDiagram:
    """The diagram of rows without what `find_diagram_mistakes` finds.

    Args:
        angle_deg: rising angles, shape (rows,).
        pressure: absolute, Pa, shape (rows,).
        strokes: 4 or 2; the period is 720 or 360 deg.
        firing_deg: the angle at which the piston is at its firing dead centre: 0 less the phase, or
            360 less the phase where the diagram counts from the gas-exchange dead centre.
    """
    angle, values = np.asarray(angle_deg, float), np.asarray(pressure, float)
    period = 180.0 * strokes
    closed = abs(angle[-1] - angle[0] - period) < _SAME and len(angle) > 1
    step = float(values[-1] - values[0]) if closed else 0.0
    kept = slice(-1 if closed else None)
    corners = np.append(angle[kept], angle[0] + period) - firing_deg
    return PressureDiagram(
        polyline(np.radians(corners), np.append(values[kept], values[0])), closing_step=step
    )


def find_diagram_mistakes(
    angle_deg: ArrayLike, pressure: ArrayLike, *, strokes: int = 4
) -> Iterator[DiagramMistake]:
    """All that is wrong with the rows of a diagram; arguments as of `pressure_diagram`."""
    angle, values = np.asarray(angle_deg, float), np.asarray(pressure, float)
    period = 180.0 * strokes
    if len(angle) < 2:
        yield DiagramMistake(None, f"has {len(angle)} rows; a cycle of {period:g}° needs more")
        return
    for row in np.flatnonzero(values < 0).tolist():
        yield DiagramMistake(
            row, f"the absolute pressure is {values[row] / 1e5:g} bar: give 0 or more"
        )
    falling = (np.flatnonzero(np.diff(angle) <= 0) + 1).tolist()
    for row in falling:
        yield DiagramMistake(
            row, f"the angle {angle[row]:g}° does not exceed the {angle[row - 1]:g}° before it"
        )
    if len(falling):
        return
    span = angle[-1] - angle[0]
    if span > period + _SAME:
        yield DiagramMistake(
            None, f"covers {span:g}°; a cycle of {strokes} strokes has {period:g}°"
        )
        return
    widest = _widest_gaps(values)
    for row, gap in enumerate(np.diff(angle).tolist(), start=1):
        if gap > widest[row]:
            yield DiagramMistake(row, f"lies {gap:g}° after the row before it: {_CLOSE}")
    if period - span > widest[0]:
        yield DiagramMistake(
            None,
            f"covers {span:g}° of {period:g}°, a gap of {period - span:g}° at its end: {_CLOSE}",
        )


def _widest_gaps(values: Array) -> Array:
    """How far each row may lie behind the one before it (the first behind the last), deg."""
    step = np.abs(values - np.roll(values, 1))
    return np.where(step <= _FLAT * values.max(), FLAT_GAP, WIDEST_GAP)

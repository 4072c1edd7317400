"""Torque on the crank for a terminal: as `render.torque`, and its curve in Braille dots."""

from __future__ import annotations

import numpy as np

from ..core.phasors import Array
from ..core.piecewise import PiecewiseCurve
from ..torque.given_curve import CurveAnalysis
from . import torque
from .sheet import Sheet, Text, number
from .terminal_plot import set_dot
from .torque_document import Result, document, rows
from .units import ShownUnit, System

__all__ = ["document", "rows", "sheet"]
WIDE, HIGH = 64, 12  # characters, of 2 x 4 dots each


def sheet(result: Result, system: System) -> Sheet:
    """All that `render.torque` tells, and the picture last."""
    told = torque.sheet(result, system)
    given = isinstance(result, CurveAnalysis)
    curve = result.torque if isinstance(result, CurveAnalysis) else result.curves.total
    what = "Torque over the period" if given else "Gas and inertia torque over the cycle"
    lines = _draw(curve, system.moment)
    return told._replace(parts=(*told.parts, Text(f"{what}, - its mean", lines)))


def _draw(curve: PiecewiseCurve, unit: ShownUnit) -> tuple[str, ...]:
    """Lines with the largest and smallest value beside the first and the last."""
    angle = np.linspace(0, curve.period, 64 * WIDE, endpoint=False)
    values = curve.at(angle)
    least, most = (extreme.value for extreme in curve.extremes())
    unit = unit.fit(max(abs(least), abs(most)))
    height = 4 * HIGH - 1

    def row_of(value: Array | float) -> Array:
        share = (most - np.asarray(value)) / (most - least or 1.0)
        return np.rint(height * share).astype(int)

    grid = np.zeros((HIGH, WIDE), int)
    columns = (angle / curve.period * 2 * WIDE).astype(int)
    for row, column in sorted(set(zip(row_of(values).tolist(), columns.tolist(), strict=True))):
        set_dot(grid, row, column)
    for column in range(0, 2 * WIDE, 4):
        set_dot(grid, int(row_of(curve.mean)), column)
    ends = {0: number(unit.of(most), 4), HIGH - 1: number(unit.of(least), 4)}
    lines = [
        f"{ends.get(k, ''):>9} {''.join(chr(0x2800 + bits) for bits in row)}"
        for k, row in enumerate(grid.tolist())
    ]
    degrees = round(float(np.degrees(curve.period)))
    return (*lines, f"{unit.name:>9} 0{f'{degrees} deg':>{WIDE - 1}}")

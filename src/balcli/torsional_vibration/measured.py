"""Compare a measured curve of the free end, order by order, with the computed one.

A torsiograph at the free end gives the amplitude of each order at each speed. The root mean square
of the differences is the quantity `torsion.misfit`; `search` makes it small, and so fits a loss, a
damping or a stiffness to the measurement.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ..core.vibration import Real
from ..engine.engine import Engine
from ..errors import BalcliError, InputError, Problem
from ..file.csv_columns import Head, NumberColumns, read_columns
from ..file.fields import order_number
from ..file.model import EngineFile
from ..file.toml import locate_beside
from ..file.units import ANGLE, SPEED
from ..limits import HIGHEST_TORSION_ORDER
from .build import excite_engine
from .motion import compute_curves
from .system import Excitation, TorsionalSystem

_HEADS = (
    Head("speed_rpm", SPEED),
    Head("order"),
    Head("amplitude_deg", ANGLE),
)


class MeasuredPoints(NamedTuple):
    """A measured curve.

    Attributes:
        speeds_rpm: Speed of each point, shape (points,).
        orders: Order of each point, shape (points,).
        amplitudes_deg: Amplitude of the free end at each point, shape (points,).
        excitation: Torques of the engine's cylinders at the measured orders.
    """

    speeds_rpm: Real
    orders: Real
    amplitudes_deg: Real
    excitation: Excitation


class MeasuredRow(NamedTuple):
    """A measured amplitude of the free end, and the computed one.

    Attributes:
        speed_rpm: Speed.
        order: Order.
        measured_deg: Measured amplitude.
        computed_deg: Computed amplitude.
    """

    speed_rpm: float
    order: float
    measured_deg: float
    computed_deg: float


@dataclass(frozen=True, kw_only=True)
class MeasuredCurve:
    """A measured curve beside the computed one.

    Attributes:
        rms_deg: Root mean square of the differences of computed and measured amplitudes.
        rows: Points of the curve, in the order of the file.
    """

    rms_deg: float
    rows: tuple[MeasuredRow, ...]


def read_measured(model: EngineFile, engine: Engine, file: str = "") -> MeasuredPoints | None:
    """Return the curve in the file that `torsion.measured` names; None if there is none.

    Args:
        model: Engine file.
        engine: Engine of this file.
        file: Name of the engine file, for messages.

    Raises:
        InputError: The file cannot be read, or has mistakes.
    """
    name = None if model.torsion is None else model.torsion.measured
    if name is None:
        return None
    try:
        columns = read_columns(locate_beside(model.folder, name), _HEADS)
    except BalcliError as error:
        raise InputError([Problem("torsion.measured", str(error))], file) from None
    problems = list(_find_mistakes(columns, name))
    if problems:
        raise InputError(problems, file)
    orders = np.array(columns.column(1))
    return MeasuredPoints(
        speeds_rpm=np.array(columns.column(0)),
        orders=orders,
        amplitudes_deg=np.array(columns.column(2)),
        excitation=excite_engine(model, engine, np.unique(orders)),
    )


def _find_mistakes(columns: NumberColumns, name: str) -> Iterator[Problem]:
    """Yield the mistake of each row, and that of a file without rows."""
    if not columns.rows:
        message = f"{name}: has no rows; give speed, order and amplitude in each"
        yield Problem("torsion.measured", message)
    for row, line in enumerate(columns.lines):
        message = _judge_row(columns, row)
        if message:
            yield Problem("torsion.measured", f"{name}: line {line}: {message}")


def _judge_row(columns: NumberColumns, row: int) -> str:
    """Return the mistake of a row in words; empty if it has none."""
    speed, order, amplitude = (columns.as_written(row, column) for column in range(3))
    value = columns.rows[row][1]
    if columns.rows[row][0] <= 0:
        return f"the speed {speed} is not above 0"
    if value % 0.5 or not 0 < value <= HIGHEST_TORSION_ORDER:
        return f"{order} is no order; give a multiple of 1/2 up to {HIGHEST_TORSION_ORDER}"
    if columns.rows[row][2] < 0:
        return f"the amplitude {amplitude} is negative"
    return ""


def compare_measured(system: TorsionalSystem, points: MeasuredPoints) -> MeasuredCurve:
    """Return the measured amplitudes of the free end beside the computed ones.

    Args:
        system: System of the engine; its excitation is used at the measured orders only.
        points: Measured curve.

    Raises:
        BalcliError: An undamped mode is driven at its own frequency.
    """
    computed = _find_amplitudes(system, points)
    columns = zip(points.speeds_rpm, points.orders, points.amplitudes_deg, computed, strict=True)
    rows = []
    for speed, order, measured, own in columns:
        rows.append(MeasuredRow(float(speed), order_number(order), float(measured), float(own)))
    difference = computed - points.amplitudes_deg
    return MeasuredCurve(rms_deg=float(np.sqrt(np.mean(difference**2))), rows=tuple(rows))


def _find_amplitudes(system: TorsionalSystem, points: MeasuredPoints) -> Real:
    """Return the computed amplitude of the free end at each point, deg, shape (points,). It is 0
    for an order that nothing excites. Torques whose phase is not known are left out: the worst
    phase is no measurement.
    """
    amplitudes = np.zeros(len(points.orders))
    torques = () if system.excitation is None else system.excitation.further
    measured = [torque for torque in torques if torque.order in points.orders]
    excitation = points.excitation.with_torques(measured)
    orders = excitation.orders
    if not len(orders):
        return amplitudes
    rpm, column = np.unique(points.speeds_rpm, return_inverse=True)
    phasors = compute_curves(replace(system, excitation=excitation, torques=()), rpm).phasors
    of_free_end = np.degrees(np.abs(phasors[:, :, len(system.shafts)]))
    excited = np.isin(points.orders, orders)
    row = np.searchsorted(orders, points.orders[excited])
    amplitudes[excited] = of_free_end[row, column[excited]]
    return amplitudes

"""Analyze a given torque curve, such as the torque of a press, without an engine."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..core.phases import RPM
from ..core.piecewise import PiecewiseCurve, merged_breaks, polyline, resolved
from ..core.shaft_speed import surplus
from ..errors import ArgumentError, BalcliError
from ..file.csv_columns import ANGLE_SYMBOLS, Head, read_columns
from ..file.doubt import Doubt
from ..file.units import ANGLE, TORQUE
from ..forces.spectrum import check_orders
from ..limits import (
    FARTHEST_DEG,
    HIGHEST_GAS_ORDER_UNASKED,
    HIGHEST_HARMONIC,
    MOST_HARMONICS_UNASKED,
)
from ..show.figures import Harmonic, list_coefficients
from .flywheel import find_flywheel
from .records import (
    TorqueAnalysis,
    TorqueOrder,
    Torques,
    measure_curve,
    measure_energy,
    write_whole,
)

SAME_MEAN = 1e-6  # means closer than this share of the largest torque count as equal
_NOISE = 1e-14  # rounding error of a harmonic, as a share of the largest torque
_SAME = 1e-9  # periods (rad) or orders times turns that differ by less count as equal
ANGLE_HEAD = Head("angle_deg", ANGLE, symbols=ANGLE_SYMBOLS)
TORQUE_HEAD = Head("torque_Nm", TORQUE, symbols="moment|m|tq|t")
_WHOLE = 1e-4  # relative rounding of a period in a file, such as 102.86 deg for 720/7


def read_curve(path: Path) -> PiecewiseCurve:
    """Return the torque in a CSV file with columns angle_deg,torque_Nm (or other units). The torque
    is linear between rows; the period runs from the angle of the first row to that of the last.

    Raises:
        BalcliError: The file does not have these columns, or the angles fall or are too large.
    """
    return read_column(path, TORQUE_HEAD)


def read_column(path: Path, head: Head) -> PiecewiseCurve:
    """Return the curve of one column of a CSV file over the angle, as `read_curve`."""
    columns = read_columns(path, (ANGLE_HEAD, head))
    angle = np.array(columns.column(0))
    value = np.array(columns.column(1))
    if len(angle) < 2 or not angle[-1] > angle[0]:
        raise BalcliError(f"{path}: needs two rising angles; the last row is the end of the period")
    if not np.abs(angle).max() <= FARTHEST_DEG:
        raise BalcliError(f"{path}: has angles beyond {FARTHEST_DEG:g} deg")
    if len(falling := np.flatnonzero(np.diff(angle) < 0)):
        before, here = (columns.as_written(row, 0) for row in (falling[0], falling[0] + 1))
        text = f"the angle {here} is below the angle {before} of the row before"
        raise BalcliError(f"{path}: line {columns.lines[falling[0] + 1]}: {text}")
    return polyline(np.radians(angle), value)


def doubt_period(curve: PiecewiseCurve) -> Iterator[Doubt]:
    """Yield a warning if the period is neither a whole number of turns nor 720 degrees divided by a
    whole number. For example, a curve sampled from 0 to 359 degrees lacks its last row, 360.
    """
    turns = curve.period / (2 * np.pi)
    if min(abs(x - round(x)) / x for x in (turns, 2 / turns)) > _WHOLE:
        message = f"its period is {360 * turns:g} deg; is the last row, which closes it, missing?"
        yield Doubt("", message)


def analyze_curve(
    name: str,
    torque: PiecewiseCurve,
    load: PiecewiseCurve | None = None,
    *,
    speed_rpm: float | None = None,
    inertia: float | None = None,
    fluctuation: float | None = None,
    orders: list[float] | None = None,
) -> TorqueAnalysis:
    """Return the analysis of a torque curve and of the speed of its shaft.

    Args:
        name: Name of the result.
        torque: Torque, N m.
        load: Torque of the load, N m, over the same period; None: a constant load, equal to the
            mean torque.
        speed_rpm: Mean speed of the shaft, rpm; None: not known.
        inertia: Inertia of all that turns, kg m2; None: not known.
        fluctuation: Allowed fluctuation of speed, (highest - lowest)/mean; the result has the
            inertia that limits the fluctuation to this value.
        orders: Orders (cycles in 360 degrees) to show; default: the harmonics of the period up to
            the order HIGHEST_GAS_ORDER_UNASKED, at least two and at most MOST_HARMONICS_UNASKED of
            them.

    Raises:
        BalcliError: Torque and load have different periods, or a requested order is not a harmonic
            of the period.
    """
    net = torque if load is None else _subtract(torque, load)
    speed = None if speed_rpm is None else speed_rpm * RPM
    harmonics = list_harmonics(torque, orders)
    above = surplus(net)
    extremes = measure_curve(torque)
    shares = None
    if load is not None:
        least = SAME_MEAN * max(abs(e.value) for c in (torque, load) for e in c.extremes())
        mean = load.mean
        rest = torque.mean - load.mean
        shares = (mean if abs(mean) > least else 0.0, rest if abs(rest) > least else 0.0)
    return TorqueAnalysis(
        speed_rpm=speed_rpm,
        cycle_deg=write_whole(float(np.degrees(torque.period))),
        mean_torque_Nm=torque.mean,
        power_W=None if speed is None else torque.mean * speed,
        torque=extremes,
        orders=tuple(
            TorqueOrder(order=order, torques=Torques(torque_Nm=harmonic))
            for order, harmonic in harmonics
        ),
        energy=measure_energy(above, torque.period, torque.integral),
        flywheel=find_flywheel(net, above.energy, speed, inertia, None, fluctuation),
        name=name,
        curve=torque,
        load_Nm=shares,
    )


def list_harmonics(
    curve: PiecewiseCurve, orders: list[float] | None = None
) -> list[tuple[float | int, Harmonic]]:
    """Return orders of a curve and their harmonics.

    Args:
        curve: Curve over the angle.
        orders: Wanted orders; None: those that are shown by default.

    Raises:
        BalcliError: A requested order is not a harmonic of the period.
    """
    turns = curve.period / (2 * np.pi)
    numbers = _choose_harmonics(turns, orders)
    coefficients = curve.harmonics(numbers)
    noise = _NOISE * np.abs(curve.series).max()
    cos = np.where(np.abs(coefficients.real) > noise, coefficients.real, 0)
    sin = np.where(np.abs(coefficients.imag) > noise, coefficients.imag, 0)
    kept = cos + 1j * sin
    harmonics = list_coefficients(numbers / turns, kept, kept == 0)
    written = [write_whole(order) for order in numbers / turns]
    return list(zip(written, harmonics, strict=True))


def _choose_harmonics(turns: float, orders: list[float] | None) -> NDArray[np.intp]:
    """Return which harmonics of the period these orders are: 1 for one oscillation in a period, 2
    for two oscillations and so on. For None, return the harmonics of the orders that are shown by
    default. `turns` is the period in turns.
    """
    if orders is None:
        usual = max(int(HIGHEST_GAS_ORDER_UNASKED * turns + _SAME), 2)
        return np.arange(1, min(usual, MOST_HARMONICS_UNASKED) + 1)
    wanted = check_orders(orders) * turns
    every = np.rint(wanted).astype(int)
    if len(odd := np.flatnonzero(np.abs(wanted - every) > _SAME)):
        there = f"a period of {turns * 360:g} deg has only multiples of {1 / turns:g}"
        raise BalcliError(f"order {wanted[odd[0]] / turns:g}: {there}")
    if len(high := np.flatnonzero(every > HIGHEST_HARMONIC)):
        highest = math.floor(2 * HIGHEST_HARMONIC / turns) / 2  # rounded down to a multiple of 1/2
        order = every[high[0]] / turns
        raise BalcliError(f"order {order:g}: {turns:g} turns have only orders up to {highest:g}")
    return every


def _subtract(torque: PiecewiseCurve, load: PiecewiseCurve) -> PiecewiseCurve:
    if abs(torque.period - load.period) > _SAME:
        periods = f"{np.degrees(load.period):g} deg, the torque {np.degrees(torque.period):g} deg"
        raise ArgumentError(
            "{load}: has a period of {periods}; give both over the same angle", periods=periods
        )
    breaks = merged_breaks([(torque.breaks, 0.0), (load.breaks, 0.0)], torque.period)
    return resolved(lambda angle: torque.at(angle) - load.at(angle), breaks)

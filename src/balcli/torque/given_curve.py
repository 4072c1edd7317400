"""A torque that is given as a curve, of a press or from a book, without an engine."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..core.phasors import Array, Complex
from ..core.piecewise import PiecewiseCurve, merged_breaks, polyline, resolved
from ..core.speed_variation import Surplus, surplus
from ..enginefile.csv_columns import read_columns
from ..errors import BalcliError
from ..forces.orders import check_orders
from ..limits import (
    FARTHEST_DEG,
    HIGHEST_GAS_ORDER_UNASKED,
    HIGHEST_HARMONIC,
    MOST_HARMONICS_UNASKED,
)
from ..result import Result
from .flywheel import Flywheel, FlywheelQuestion, find_flywheel

_NOISE = 1e-14  # of the largest torque: rounding errors of a harmonic
_SAME = 1e-9  # of a turn, by which periods may differ
_WHOLE = 1e-4  # of itself, by which a period in a file may be rounded: 102.86 deg of 720/7


class DrivenShaft(NamedTuple):
    """What turns: mean speed, rad/s, and inertia, kg m2; None: not known."""

    mean_speed: float | None = None
    inertia: float | None = None


@dataclass(frozen=True, eq=False, repr=False)
class CurveAnalysis(Result):
    """What a given torque does.

    Attributes:
        name: what to call it.
        torque: N m over its period, rad.
        load: likewise; None: it takes the mean evenly.
        orders: cycles in 360 degrees, shape (orders,).
        harmonics: c_n of `Re sum c_n e^{i n theta}`, N m, shape (orders,).
        surplus: of the torque above the load; the work is the torque's own.
        shaft, flywheel: what turns, and how evenly.
    """

    name: str
    torque: PiecewiseCurve
    load: PiecewiseCurve | None
    orders: Array
    harmonics: Complex
    surplus: Surplus
    shaft: DrivenShaft
    flywheel: Flywheel | None

    @property
    def summary(self) -> str:
        """Of what."""
        return f"of {self.name}"


def read_curve(path: Path) -> PiecewiseCurve:
    """A torque from CSV headed angle_deg,torque_Nm: straight lines between rows, the last of which
    closes the period.

    Raises:
        BalcliError: it is no such file, or angles do not rise.
    """
    columns = read_columns(path, (("angle_deg",), ("torque_Nm",)))
    angle, torque = np.array(columns.column(0)), np.array(columns.column(1))
    if len(angle) < 2 or not angle[-1] > angle[0]:
        raise BalcliError(f"{path}: has no two angles; the last row has to close the period")
    if not np.abs(angle).max() <= FARTHEST_DEG:
        raise BalcliError(f"{path}: has angles beyond {FARTHEST_DEG:g} deg")
    if len(falling := np.flatnonzero(np.diff(angle) < 0)):
        row = falling[0] + 1
        raise BalcliError(
            f"{path}: line {columns.lines[row]}: the angle {angle[row]:g} deg is below the "
            f"{angle[row - 1]:g} deg before it"
        )
    return polyline(np.radians(angle), torque)


def doubt_period(curve: PiecewiseCurve) -> Iterator[str]:
    """A warning where a period is neither whole turns nor an even share of two, as of a curve
    sampled from 0 to 359 degrees.
    """
    turns = curve.period / (2 * np.pi)
    if min(abs(x - round(x)) / x for x in (turns, 2 / turns)) > _WHOLE:
        yield (
            f"its period is {360 * turns:g} deg, neither whole turns nor an even share of two; the "
            "last row closes the period: is it there?"
        )


def analyze_curve(
    name: str,
    torque: PiecewiseCurve,
    load: PiecewiseCurve | None = None,
    shaft: DrivenShaft | None = None,
    *,
    fluctuation: float | None = None,
    orders: list[float] | None = None,
) -> CurveAnalysis:
    """What a torque does to the speed of a shaft.

    Args:
        name: what to call it.
        torque, load: N m, over one and the same period.
        shaft: what turns.
        fluctuation: (highest - lowest)/mean speed, for which the inertia is wanted.
        orders: default: all that the period has, up to HIGHEST_GAS_ORDER_UNASKED, at least two and
            at most MOST_HARMONICS_UNASKED.

    Raises:
        BalcliError: other periods, orders that the period has not.
    """
    shaft = shaft or DrivenShaft()
    net = torque if load is None else _subtract(torque, load)
    turns = torque.period / (2 * np.pi)
    usual = max(int(HIGHEST_GAS_ORDER_UNASKED * turns + _SAME), 2)
    every = np.arange(1, min(usual, MOST_HARMONICS_UNASKED) + 1)
    if orders is not None:
        wanted = check_orders(orders) * turns
        every = np.rint(wanted).astype(int)
        if len(odd := np.flatnonzero(np.abs(wanted - every) > _SAME)):
            raise BalcliError(
                f"order {wanted[odd[0]] / turns:g}: a period of {turns * 360:g} deg has multiples "
                f"of {1 / turns:g}"
            )
        if len(high := np.flatnonzero(every > HIGHEST_HARMONIC)):
            highest = math.floor(2 * HIGHEST_HARMONIC / turns) / 2  # that may be asked for
            raise BalcliError(
                f"order {every[high[0]] / turns:g}: of a period of {turns:g} turns there are "
                f"orders to {highest:g}"
            )
    above = surplus(net)._replace(work=torque.integral)
    asked = FlywheelQuestion(net, above.energy, shaft.mean_speed, shaft.inertia, None, fluctuation)
    found = torque.harmonics(every)
    found = np.where(np.abs(found) > _NOISE * np.abs(torque.series).max(), found, 0)
    return CurveAnalysis(
        name, torque, load, every / turns, found, above, shaft, find_flywheel(asked)
    )


def _subtract(torque: PiecewiseCurve, load: PiecewiseCurve) -> PiecewiseCurve:
    if abs(torque.period - load.period) > _SAME:
        periods = f"{np.degrees(load.period):g} deg, the torque {np.degrees(torque.period):g}"
        raise BalcliError(f"--load: has a period of {periods}: give both over the same angle")
    breaks = merged_breaks([(torque.breaks, 0.0), (load.breaks, 0.0)], torque.period)
    return resolved(lambda angle: torque.at(angle) - load.at(angle), breaks)

"""Compute the fluctuation of a shaft's speed under a torque, and the inertia that limits it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from ..core.phases import RPM
from ..core.phasors import Complex
from ..core.piecewise import Function, PiecewiseCurve, resolved
from ..core.records import HIDDEN, Asked, change_attributes
from ..core.shaft_speed import (
    StallError,
    needed_inertia,
    small_fluctuation,
    speed_variation,
)
from ..core.speed_ripple import RippleLine
from ..errors import ArgumentError
from ..file.fields import order_number
from ..limits import FLUCTUATION, HIGHEST_RIPPLE_ORDER, MOST_RIPPLES, SMALLEST_FLUCTUATION

_WORTH = 1e-4  # orders of the speed below this share of the largest amplitude are not listed


_WITH_INERTIA = "inertia in [crank] or [flywheel] of the file, with which the crank does not stall"


@dataclass(frozen=True, kw_only=True, eq=False)
class Flywheel:
    """Inertia on the shaft and the resulting fluctuation of speed, as far as known.

    Attributes:
        inertia_kg_m2: Mean inertia of all moving parts; left out if the file gives no inertia.
        moving_parts_kg_m2: Part of `inertia_kg_m2` that belongs to pistons, rods and throw masses.
        fluctuation: Fluctuation of speed, (highest - lowest)/mean.
        fluctuation_small: Fluctuation by the approximation for small values, surplus/(I omega^2),
            with the mean inertia I and the mean speed omega.
        needed_kg_m2: Mean inertia of all moving parts that yields the requested fluctuation.
        speed_max_rpm: Highest speed.
        speed_min_rpm: Lowest speed.
        stall: Message with the angle at which the crank stalls; left out if it does not stall.
        speed_max_deg: Crank angle of the highest speed.
        speed_min_deg: Crank angle of the lowest speed.
        lines: Orders of the uneven speed, without those of negligible amplitude.
    """

    inertia_kg_m2: Asked[float] = Asked("inertia in [crank] or [flywheel] of the file")
    moving_parts_kg_m2: float = 0.0
    fluctuation: Asked[float] = Asked(_WITH_INERTIA)
    fluctuation_small: Asked[float] = Asked(_WITH_INERTIA)
    needed_kg_m2: Asked[float] = Asked("fluctuation=1 / 200")
    speed_max_rpm: Asked[float] = Asked(_WITH_INERTIA)
    speed_min_rpm: Asked[float] = Asked(_WITH_INERTIA)
    stall: str | None = None
    speed_max_deg: Annotated[float, HIDDEN] = 0.0
    speed_min_deg: Annotated[float, HIDDEN] = 0.0
    lines: Annotated[tuple[RippleLine, ...], HIDDEN] = ()


def find_flywheel(
    torque: PiecewiseCurve,
    surplus: float,
    mean_speed: float | None,
    constant: float | None,
    moving: Function | None = None,
    fluctuation: float | None = None,
) -> Flywheel | None:
    """Return the inertia and the fluctuation of speed; None if neither an inertia is known nor a
    fluctuation requested.

    Args:
        torque: Torque of the gas, or a given curve minus its load, N m.
        surplus: Largest surplus energy of the total torque, J.
        mean_speed: Mean speed, rad/s; None: not known.
        constant: Constant part of the inertia, kg m2; None: not known.
        moving: Function that returns the inertia of pistons, rods and throw masses, kg m2, at crank
            angles (rad); None: the shaft has no such parts.
        fluctuation: Largest allowed fluctuation; None: not requested.

    Raises:
        ArgumentError: A requested fluctuation is not between 1e-9 and 2, or a fluctuation is
            requested and the mean speed is not known.
    """
    if constant is None and fluctuation is None:
        return None
    course = resolved(moving or np.zeros_like, torque.breaks)  # faster to evaluate
    needed = None
    if fluctuation is not None:
        if not SMALLEST_FLUCTUATION <= fluctuation < 2:
            raise ArgumentError(
                "{fluctuation} {value:g}: give {wanted}", value=fluctuation, wanted=FLUCTUATION
            )
        if mean_speed is None:
            raise ArgumentError("{fluctuation} needs the mean speed; give it, such as {speed} 300")
        needed = course.mean + needed_inertia(torque, mean_speed, fluctuation, course.at)
    mean = (constant or 0.0) + course.mean
    flywheel = Flywheel(
        inertia_kg_m2=None if constant is None else mean,
        moving_parts_kg_m2=course.mean,
        needed_kg_m2=needed,
    )
    if constant is None or mean_speed is None:
        return flywheel
    try:
        speed = speed_variation(torque, lambda angle: constant + course.at(angle), mean_speed)
    except StallError as error:
        return change_attributes(flywheel, stall=str(error))
    return change_attributes(
        flywheel,
        fluctuation=speed.fluctuation,
        fluctuation_small=small_fluctuation(surplus, mean, mean_speed),
        speed_max_rpm=speed.highest.value / RPM,
        speed_min_rpm=speed.lowest.value / RPM,
        speed_max_deg=degrees_in_cycle(speed.highest.angle, torque.period),
        speed_min_deg=degrees_in_cycle(speed.lowest.angle, torque.period),
        lines=_find_lines(speed.speed, mean_speed),
    )


def _find_lines(speed: PiecewiseCurve, mean_speed: float) -> tuple[RippleLine, ...]:
    """Return the harmonics of the speed divided by the mean speed, up to the highest order and the
    largest number of orders that an engine file may contain.
    """
    turns = speed.period / (2 * np.pi)
    count = min(MOST_RIPPLES, int(HIGHEST_RIPPLE_ORDER * turns + 0.1))
    c: Complex = speed.harmonics(np.arange(1, count + 1)) / mean_speed
    size = np.abs(c)
    angle = -np.degrees(np.angle(c))
    worth = np.flatnonzero(size > _WORTH * size.max(initial=0)).tolist()
    orders = (order_number(round(2 * (k + 1) / turns) / 2) for k in worth)
    return tuple(map(RippleLine, orders, size[worth].tolist(), angle[worth].tolist()))


def degrees_in_cycle(angle: float, period: float) -> float:
    """Return a crank angle in degrees, reduced to [0, period); angle and period are in rad."""
    whole = float(np.degrees(period))
    turned = float(np.degrees(angle)) % whole
    return 0.0 if whole - turned < 1e-9 else turned

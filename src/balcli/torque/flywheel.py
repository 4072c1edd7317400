"""How uneven a torque makes the speed of a shaft, and the inertia that it takes to even it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..core.phasors import Complex
from ..core.piecewise import Extreme, Function, PiecewiseCurve, resolved
from ..core.speed_ripple import RippleLine
from ..core.speed_variation import StallError, needed_inertia, small_fluctuation, speed_variation
from ..errors import BalcliError
from ..limits import HIGHEST_RIPPLE_ORDER, MOST_RIPPLES

_WORTH = 1e-4  # share of the largest line of the speed below which one is left out


class Speed(NamedTuple):
    """The speed over a cycle, rad/s.

    Attributes:
        fluctuation: (highest - lowest)/mean.
        small: the same by the rule for small fluctuations, surplus/(I omega^2).
        lowest, highest: angle (rad) and speed.
        lines: of the uneven speed, those worth naming.
    """

    fluctuation: float
    small: float
    lowest: Extreme
    highest: Extreme
    lines: tuple[RippleLine, ...]


class Flywheel(NamedTuple):
    """Inertia on the shaft, kg m2.

    Attributes:
        mean: of all that turns and moves, mean over a cycle; None: constant inertia is not known.
        moving: that of the moving parts in it.
        speed: with this inertia; None: it is not known, or the mean speed is not, or it stalls.
        needed: mean of all that keeps the fluctuation asked for; None: none was asked for.
        stall: that it stalls, in words.
    """

    mean: float | None
    moving: float
    speed: Speed | None
    needed: float | None
    stall: str = ""


class FlywheelQuestion(NamedTuple):
    """What is asked of a shaft.

    Attributes:
        torque: of gas or a given curve, less an uneven load, N m.
        surplus: the largest of the total torque, J.
        mean_speed: rad/s; None: not known.
        constant: inertia, kg m2; None: not known.
        moving: inertia of moving parts, kg m2 at angles (rad); None: there are none.
        fluctuation: that is allowed; None: it is not asked for.
    """

    torque: PiecewiseCurve
    surplus: float
    mean_speed: float | None
    constant: float | None
    moving: Function | None
    fluctuation: float | None


def find_flywheel(question: FlywheelQuestion) -> Flywheel | None:
    """What inertia does for the speed; None where nothing of it is known or asked.

    Raises:
        BalcliError: a fluctuation is asked for without a mean speed.
    """
    q = question
    if q.constant is None and q.fluctuation is None:
        return None
    if q.fluctuation is not None and q.mean_speed is None:
        raise BalcliError("--fluctuation needs the mean speed; give it, such as --speed 300")
    moving = 0.0
    if q.moving is not None:
        course = resolved(q.moving, q.torque.breaks)
        moving, q = course.mean, q._replace(moving=course.at)  # quicker than the mechanism
    mean = None if q.constant is None else q.constant + moving
    needed = None
    if q.fluctuation is not None and q.mean_speed is not None:
        parts = 0.0 if q.moving is None else q.moving
        needed = moving + needed_inertia(q.torque, q.mean_speed, q.fluctuation, parts)
    if mean is None or q.mean_speed is None:
        return Flywheel(mean, moving, None, needed)
    try:
        return Flywheel(mean, moving, _find_speed(q, q.mean_speed, mean), needed)
    except StallError as error:
        return Flywheel(mean, moving, None, needed, f"{error}")


def _find_speed(q: FlywheelQuestion, mean_speed: float, mean_inertia: float) -> Speed:
    found = speed_variation(q.torque, _inertia(q.constant or 0.0, q.moving), mean_speed)
    return Speed(
        found.fluctuation,
        small_fluctuation(q.surplus, mean_inertia, mean_speed),
        found.lowest,
        found.highest,
        _find_lines(found.speed, mean_speed),
    )


def _inertia(constant: float, moving: Function | None) -> float | Function:
    if moving is None:
        return constant
    return lambda angle: constant + moving(angle)


def _find_lines(speed: PiecewiseCurve, mean_speed: float) -> tuple[RippleLine, ...]:
    """Lines whose sum is the speed, in shares of its mean: multiples of 1/2, or of 1, as far as an
    engine file may have them.
    """
    turns = speed.period / (2 * np.pi)
    count = min(MOST_RIPPLES, int(HIGHEST_RIPPLE_ORDER * turns + 0.1))
    c: Complex = speed.harmonics(np.arange(1, count + 1)) / mean_speed
    size = np.abs(c)
    worth = np.flatnonzero(size > _WORTH * size.max(initial=0))
    return tuple(
        RippleLine(_as_order((k + 1) / turns), float(size[k]), float(-np.degrees(np.angle(c[k]))))
        for k in worth.tolist()
    )


def _as_order(order: float) -> float:
    """To the multiple of 1/2 that a whole number of revolutions makes of it."""
    halves = round(2 * order)
    return halves // 2 if halves % 2 == 0 else halves / 2

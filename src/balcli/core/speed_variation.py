"""How a torque that varies makes the speed of a shaft vary, without a differential equation.

Energy: `1/2 I omega^2` grows by what the torque does above the load, W. So `omega^2 = (C + 2 W)/I`
at every angle, I the inertia with all that moves, and C follows from the mean speed over the angle
(as `speed_ripple` counts it). Angles of the shaft in radians; a period may be any number of turns.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from .phasors import Array
from .piecewise import Extreme, Function, PiecewiseCurve, find_zero, resolved
from .speeds import RPM


class StallError(ValueError):
    """The shaft cannot have the mean speed: at `angle` (rad) it would have to stand still."""

    def __init__(self, angle: float, least: float) -> None:
        self.angle, self.least = angle, least
        super().__init__(
            f"the shaft stalls at {math.degrees(angle):.1f}°: with this inertia it needs a mean "
            f"speed above {least / RPM:.4g} rpm"
        )


class Surplus(NamedTuple):
    """Surplus energy of a torque.

    Attributes:
        energy: The largest energy that the torque yields above the load without a break, J.
        start, end: Angles of the lowest and of the highest speed at constant inertia, rad, in a
            period from 0; each the first.
        work: Work of a whole period, J.
    """

    energy: float
    start: float
    end: float
    work: float


class SpeedVariation(NamedTuple):
    """The speed of a shaft over a period.

    Attributes:
        fluctuation: (highest - lowest speed)/mean speed.
        lowest, highest: Angle (rad) and speed (rad/s).
        speed: The whole curve, rad/s.
    """

    fluctuation: float
    lowest: Extreme
    highest: Extreme
    speed: PiecewiseCurve


def surplus(torque: PiecewiseCurve) -> Surplus:
    """Return the surplus energy of a torque (N m), from the extremes of its running integral; the
    load takes what remains of the mean, evenly.
    """
    lowest, highest = energy(torque).extremes()
    start, end = (angle % torque.period for angle in (lowest.angle, highest.angle))
    return Surplus(highest.value - lowest.value, start, end, torque.integral)


def energy(torque: PiecewiseCurve) -> PiecewiseCurve:
    """Return what the torque (N m) has done above its mean from the first breakpoint on, J."""
    return torque.antiderivative(torque.mean)


def small_fluctuation(surplus_energy: float, mean_inertia: float, mean_speed: float) -> float:
    """Return the coefficient of fluctuation of the textbooks, surplus/(I omega^2), for small
    ones.
    """
    return surplus_energy / (mean_inertia * mean_speed**2)


def speed_variation(
    torque: PiecewiseCurve, inertia: float | Function, mean_speed: float
) -> SpeedVariation:
    """Return the speed under a torque (N m), of which the load takes the mean evenly.

    Args:
        torque: Torque of the gas (and of an uneven load, with the sign changed), without the torque
            of inertia, which the inertia stands for.
        inertia: Moment of inertia, kg m2, a constant or at angles (rad).
        mean_speed: Mean over the angle, rad/s.

    Raises:
        StallError: There is no such motion.
    """
    parts, done, wanted = _as_function(inertia), energy(torque), mean_speed**2
    slowest, _ = done.extremes()
    panels = np.unique(np.append(done.breaks, slowest.angle))

    def find_speed(above: float) -> PiecewiseCurve:
        """Return the speed with `C + 2 W = above` at the angle where W is smallest."""

        def omega(angle: Array) -> Array:
            square = (above + 2 * (done.at(angle) - slowest.value)) / parts(angle)
            return np.sqrt(np.maximum(square, 0))

        return resolved(omega, panels)

    stalled = find_speed(0.0).mean ** 2
    if stalled >= wanted:
        raise StallError(slowest.angle, math.sqrt(stalled))
    guess = wanted * float(parts(np.array(slowest.angle)))
    above = find_zero(lambda c: find_speed(c).mean ** 2 - wanted, guess, stalled - wanted)
    speed = find_speed(above)
    low, high = speed.extremes()
    # the difference of both speeds, without cancellation where the inertia is constant
    angles = np.array([high.angle, low.angle])
    (w, w0), (i, i0) = done.at(angles) - slowest.value, parts(angles)
    squares = float((2 * (w * i0 - w0 * i) + above * (i0 - i)) / (i * i0))
    return SpeedVariation(squares / (high.value + low.value) / mean_speed, low, high, speed)


def needed_inertia(
    torque: PiecewiseCurve, mean_speed: float, fluctuation: float, moving: float | Function = 0.0
) -> float:
    """Return the constant inertia (kg m2) that keeps the exact fluctuation, together with the
    inertia of moving parts; it is negative where these alone do better. Where the shaft would stall
    before it fluctuates so much, it is the least inertia with which it does not.

    Found between none of it and a stall by false position, in the inverse of the mean inertia, to
    which the fluctuation is nearly proportional.
    """
    course = resolved(_as_function(moving), torque.breaks)
    mean, (least, most) = course.mean, course.extremes()
    energy_above = surplus(torque).energy
    if not energy_above and most.value == least.value:
        return -least.value

    def excess(inverse: float) -> float:
        own = 1 / inverse - mean
        if own + least.value <= 0:
            return math.inf
        try:
            found = speed_variation(torque, lambda angle: own + course.at(angle), mean_speed)
        except StallError:
            return math.inf
        return found.fluctuation - fluctuation

    guess = fluctuation * mean_speed**2 / max(energy_above, least.value * mean_speed**2)
    return 1 / find_zero(excess, guess, -fluctuation) - mean


def _as_function(inertia: float | Function) -> Function:
    if callable(inertia):
        return inertia
    return lambda angle: np.full(angle.shape, float(inertia))

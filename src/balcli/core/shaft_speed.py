"""Compute the speed of a shaft under a varying torque, and the flywheel that it needs.

The energy `1/2 I omega^2` grows by the work E of the torque less the load. So `omega^2 = (C + 2
E)/I` at every angle, and no differential equation has to be solved. I is the moment of inertia of
all moving parts, and the constant C follows from the mean speed over the angle. Angles of the shaft
are in radians; a period may have any number of turns.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from .phases import RPM
from .phasors import Array
from .piecewise import Extreme, Function, PiecewiseCurve, find_zero, resolved

# The least inertia without a stall is larger by this share of itself than that at which it stalls.
_NO_STALL = 1e-12
_CONSTANT = 1e-12  # an inertia that changes by a smaller share of itself is constant


class StallError(ValueError):
    """The shaft cannot have the mean speed, because it would stop."""


class Surplus(NamedTuple):
    """Surplus energy of a torque over a constant load.

    Attributes:
        energy: Highest minus lowest value of the running integral of (torque - load) over the
            angle, J.
        start: First angle at which this integral is lowest, rad, in [0, period). At constant
            inertia, the speed is lowest there.
        end: First angle at which this integral is highest, rad, in [0, period).
    """

    energy: float
    start: float
    end: float


class SpeedVariation(NamedTuple):
    """The speed of a shaft over a period.

    Attributes:
        fluctuation: (highest - lowest speed)/mean speed.
        lowest: Lowest speed, rad/s, and its angle, rad.
        highest: Highest speed, rad/s, and its angle, rad.
        speed: Speed over the angle, rad/s.
    """

    fluctuation: float
    lowest: Extreme
    highest: Extreme
    speed: PiecewiseCurve


def surplus(torque: PiecewiseCurve) -> Surplus:
    """Return the surplus energy of a torque (N m) over a constant load equal to its mean, from the
    extremes of the running integral.
    """
    lowest, highest = torque.antiderivative(torque.mean).extremes()
    start, end = (angle % torque.period for angle in (lowest.angle, highest.angle))
    return Surplus(highest.value - lowest.value, start, end)


def small_fluctuation(surplus_energy: float, mean_inertia: float, mean_speed: float) -> float:
    """Return the textbooks' coefficient of fluctuation, surplus/(I omega^2), which is accurate for
    small fluctuations.

    Args:
        surplus_energy: Largest surplus of energy over a cycle, J.
        mean_inertia: Mean moment of inertia, kg m2.
        mean_speed: Mean crank speed, rad/s.
    """
    return surplus_energy / (mean_inertia * mean_speed**2)


class _Energy(NamedTuple):
    """Work E of a torque, less that of a constant load equal to its mean, over the angle.

    Attributes:
        done: E, J.
        least: Least E, where a shaft of constant inertia is slowest.
    """

    done: PiecewiseCurve
    least: Extreme

    @classmethod
    def of(cls, torque: PiecewiseCurve) -> _Energy:
        """Return the energy of a torque, N m."""
        done = torque.antiderivative(torque.mean)
        return cls(done, done.extremes()[0])

    def rise(self, angle: Array) -> Array:
        """Return E less its least value."""
        return self.done.at(angle) - self.least.value

    def find_speed(self, above: float, inertia: Function) -> PiecewiseCurve:
        """Return the speed, rad/s, if `C + 2 E` is `above` at the angle of the least E."""

        def omega(angle: Array) -> Array:
            square = (above + 2 * self.rise(angle)) / inertia(angle)
            return np.sqrt(np.maximum(square, 0))

        return resolved(omega, np.unique(np.append(self.done.breaks, self.least.angle)))

    def find_stall_speed(self, inertia: Function) -> float:
        """Return the mean speed, rad/s, at which the shaft just does not stop."""
        return self.find_speed(0.0, inertia).mean


def speed_variation(torque: PiecewiseCurve, inertia: Function, mean_speed: float) -> SpeedVariation:
    """Return the speed under a torque (N m) and a constant load equal to its mean.

    Args:
        torque: Gas torque, less any varying part of the load. It does not include the inertia
            torque, which follows from `inertia`.
        inertia: Moment of inertia, kg m2, over the angle (rad).
        mean_speed: Mean speed over the angle, rad/s.

    Raises:
        StallError: The shaft would stop.
    """
    wanted = mean_speed**2
    energy = _Energy.of(torque)
    slowest = energy.least.angle
    stalled = energy.find_stall_speed(inertia) ** 2
    if stalled >= wanted:
        raise StallError(
            f"the shaft stalls at {math.degrees(slowest):.1f}°: with this inertia it needs a "
            f"mean speed above {math.sqrt(stalled) / RPM:.4g} rpm"
        )

    def excess(above: float) -> float:
        return energy.find_speed(above, inertia).mean ** 2 - wanted

    guess = wanted * float(inertia(np.array(slowest)))
    above = find_zero(excess, guess, stalled - wanted)
    speed = energy.find_speed(above, inertia)
    low, high = speed.extremes()
    # the difference of the squared speeds, without cancellation if the inertia is constant
    angles = np.array([high.angle, low.angle])
    w, w0 = energy.rise(angles)
    i, i0 = inertia(angles)
    squares = float((2 * (w * i0 - w0 * i) + above * (i0 - i)) / (i * i0))
    return SpeedVariation(squares / (high.value + low.value) / mean_speed, low, high, speed)


def needed_inertia(
    torque: PiecewiseCurve, mean_speed: float, fluctuation: float, moving: Function = np.zeros_like
) -> float:
    """Return the constant inertia (kg m2) that, together with moving parts, gives exactly the
    wanted fluctuation. It is negative if the speed fluctuates less with the moving parts alone. If
    the shaft would stall before its speed fluctuates so much, return the least inertia without a
    stall.

    The unknown of the search (false position) is the inverse of the mean inertia, to which the
    fluctuation is nearly proportional.

    Args:
        torque: Torque without inertia torque, as in `speed_variation`, N m.
        mean_speed: Mean crank speed, rad/s.
        fluctuation: Wanted coefficient of fluctuation.
        moving: Moment of inertia of the moving parts as a function of the crank angle, kg m2.
    """
    course = resolved(moving, torque.breaks)
    mean = course.mean
    least, most = course.extremes()
    energy = _Energy.of(torque)
    energy_above = surplus(torque).energy
    if not energy_above and most.value - least.value <= _CONSTANT * most.value:
        return -mean

    def add_own(inverse: float) -> Function | None:
        """Return the inertia of all parts; None: it would be negative."""
        own = 1 / inverse - mean
        return None if own + least.value <= 0 else lambda angle: own + course.at(angle)

    def excess(inverse: float) -> float:
        inertia = add_own(inverse)
        if inertia is None:
            return math.inf
        try:
            variation = speed_variation(torque, inertia, mean_speed)
        except StallError:
            return math.inf
        return variation.fluctuation - fluctuation

    def excess_of_stall(inverse: float) -> float:
        inertia = add_own(inverse)
        if inertia is None:
            return math.inf
        return energy.find_stall_speed(inertia) - mean_speed

    guess = fluctuation * mean_speed**2 / max(energy_above, least.value * mean_speed**2)
    if excess(guess) == math.inf:
        largest = find_zero(excess_of_stall, guess, -mean_speed) * (1 - _NO_STALL)
        if excess(largest) < 0:
            return 1 / largest - mean
    return 1 / find_zero(excess, guess, -fluctuation) - mean

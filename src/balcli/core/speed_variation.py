"""How a torque that varies makes the speed of a shaft vary, without a differential equation.

Energy: `1/2 I omega^2` grows by what the torque does above the load, W. So `omega^2 = (C + 2 W)/I`
at every angle, I the inertia with all that moves, and C follows from the mean speed over the angle
(as `speed_ripple` counts it). Angles of the shaft in radians; a period may be any number of turns.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from .phasors import Array
from .piecewise import Extreme, Function, PiecewiseCurve, quadrature, resolved, with_break
from .speeds import RPM

_ROUNDS, _REFINEMENTS = 100, 8
_ENOUGH = 1e-14  # relative, where a secant has arrived
_FINEST = 256  # times the panels of the torque: a speed that needs more varies a hundredfold


class StallError(ValueError):
    """The shaft cannot have the mean speed: at `angle` (rad) it would have to stand still."""

    def __init__(self, angle: float, least: float) -> None:
        self.angle, self.least = angle, least
        super().__init__(
            f"the shaft stalls at {math.degrees(angle):.1f}°: with this inertia it needs a mean "
            f"speed above {least / RPM:.4g} rpm"
        )


class Surplus(NamedTuple):
    """The largest energy (J) that the torque yields above the load without a break, from the angle
    of the lowest to that of the highest speed at constant inertia (rad, in a period from 0; each
    the first), and the work of a whole period (J).
    """

    energy: float
    start: float
    end: float
    work: float


class SpeedVariation(NamedTuple):
    """The speed of a shaft over a period.

    Attributes:
        fluctuation: (highest - lowest speed)/mean speed.
        lowest, highest: angle (rad) and speed (rad/s).
        speed: rad/s, the whole curve.
    """

    fluctuation: float
    lowest: Extreme
    highest: Extreme
    speed: PiecewiseCurve


def surplus(torque: PiecewiseCurve) -> Surplus:
    """The surplus energy of a torque (N m), from the extremes of its running integral; the load
    takes what remains of the mean, evenly.
    """
    lowest, highest = energy(torque).extremes()
    start, end = (angle % torque.period for angle in (lowest.angle, highest.angle))
    return Surplus(highest.value - lowest.value, start, end, torque.integral)


def energy(torque: PiecewiseCurve) -> PiecewiseCurve:
    """W: what the torque (N m) has done above its mean from the first breakpoint on, J."""
    return torque.plus(-torque.mean).antiderivative()


def small_fluctuation(surplus_energy: float, mean_inertia: float, mean_speed: float) -> float:
    """The coefficient of fluctuation of the textbooks, surplus/(I omega^2), for small ones."""
    return surplus_energy / (mean_inertia * mean_speed**2)


def speed_variation(
    torque: PiecewiseCurve, inertia: float | Function, mean_speed: float
) -> SpeedVariation:
    """The speed under a torque (N m), of which the load takes the mean evenly.

    Args:
        torque: that of the gas (and of an uneven load, with the sign changed), without the torque
            of inertia, which the inertia stands for.
        inertia: kg m2, a constant or at angles (rad).
        mean_speed: over the angle, rad/s.

    Raises:
        StallError: where there is no such motion.
    """
    shaft = _Shaft(energy(torque), _function(inertia))
    constant, speed = shaft.running(mean_speed)
    lowest, highest = speed.extremes()
    fluctuation = shaft.between(constant, highest, lowest) / mean_speed
    return SpeedVariation(fluctuation, lowest, highest, speed)


def needed_inertia(
    torque: PiecewiseCurve, mean_speed: float, fluctuation: float, moving: float | Function = 0.0
) -> float:
    """The constant inertia (kg m2) that keeps the exact fluctuation, together with the inertia of
    moving parts; negative where these alone do better. Where the shaft would stall before it
    fluctuates so much, it is the least inertia with which it does not.

    Found between none of it and a stall by false position, in the inverse of the mean inertia, to
    which the fluctuation is nearly proportional.
    """
    parts = _function(moving)
    course = resolved(parts, torque.breaks)
    mean, least = course.mean, course.extremes()[0].value

    if not surplus(torque).energy and course.extremes()[1].value == least:
        return -least

    def excess(inverse: float) -> float:
        own = 1 / inverse - mean
        if own + least <= 0:
            return math.inf
        try:
            found = speed_variation(torque, lambda angle: own + parts(angle), mean_speed)
        except StallError:
            return math.inf
        return found.fluctuation - fluctuation

    guess = fluctuation * mean_speed**2 / max(surplus(torque).energy, least * mean_speed**2)
    return 1 / _root(excess, guess, -fluctuation) - mean


def _root(rising: Callable[[float], float], guess: float, at_zero: float) -> float:
    """Where a rising function, which may become infinite, passes 0 from its value `at_zero`; below
    the jump, where it jumps past 0.
    """
    low, below, high = 0.0, at_zero, guess
    while (above := rising(high)) < 0:
        low, below, high = high, above, 2 * high
    tried, was_below = high, False
    for _ in range(_ROUNDS):
        share = 0.5 if above == math.inf else below / (below - above)
        last, tried = tried, low + (high - low) * share
        value = rising(tried)
        if value == 0 or abs(tried - last) <= _ENOUGH * tried:
            break
        if value < 0:
            low, below, above = tried, value, above / 2 if was_below else above
        else:
            high, above, below = tried, value, below if was_below else below / 2
        was_below = value < 0
    return low if above == math.inf else tried


def _function(inertia: float | Function) -> Function:
    """A constant as a function, too."""
    if callable(inertia):
        return inertia
    return lambda angle: np.full(angle.shape, float(inertia))


class _Shaft:
    """A shaft by its running energy W (J) and its inertia (kg m2) at angles."""

    def __init__(self, energy: PiecewiseCurve, inertia: Function) -> None:
        self.energy, self.inertia = energy, inertia
        self.slowest, self.fastest = energy.extremes()
        self.floor = -2 * self.slowest.value  # C with which the shaft would just stall

    def running(self, mean_speed: float) -> tuple[float, PiecewiseCurve]:
        """C and the speed over the angle, on panels that are halved until they show it."""
        panels = with_break(self.energy.breaks, self.slowest.angle)
        constant = math.inf
        for _ in range(_REFINEMENTS):
            last, constant = constant, self.constant_for(mean_speed, panels)
            speed = self.speed(constant, panels)
            settled = abs(constant - last) <= _ENOUGH * abs(constant)
            fine = len(speed.breaks) > _FINEST * len(self.energy.breaks)
            if settled or fine or len(speed.breaks) == len(panels):
                break
            panels = speed.breaks
        return constant, speed

    def speed(self, constant: float, panels: Array) -> PiecewiseCurve:
        """omega with this C."""

        def omega(angle: Array) -> Array:
            square = (constant + 2 * self.energy.at(angle)) / self.inertia(angle)
            return np.sqrt(np.maximum(square, 0))

        return resolved(omega, panels)

    def constant_for(self, mean_speed: float, panels: Array) -> float:
        """C for the mean speed on these panels, sought in its square, which is nearly linear in
        C.
        """
        wanted = mean_speed**2
        angle, weights = quadrature(panels)
        inertia, rise = self.inertia(angle), np.maximum(self.floor + 2 * self.energy.at(angle), 0)
        at_floor = float(np.sum(weights * rise / inertia))
        if at_floor >= wanted:  # the square of the mean is less than this mean of squares
            at_floor = self.speed(self.floor, panels).mean ** 2
        if at_floor >= wanted:
            raise StallError(self.slowest.angle, math.sqrt(at_floor))

        def excess(above: float) -> float:
            return float(np.sum(weights * np.sqrt((above + rise) / inertia))) ** 2 - wanted

        steady = float(np.sum(weights * (wanted * inertia - rise)))
        guess = max(steady, self.fastest.value - self.slowest.value)
        return self.floor + _root(excess, guess, at_floor - wanted)

    def between(self, constant: float, high: Extreme, low: Extreme) -> float:
        """Difference of two speeds at given angles, without cancellation where I is constant."""
        angles = np.array([high.angle, low.angle])
        (w, w0), (i, i0) = self.energy.at(angles), self.inertia(angles)
        squares = (2 * (w * i0 - w0 * i) + constant * (i0 - i)) / (i * i0)
        return float(squares / (high.value + low.value))

"""The largest of torsional vibration over a range of speeds, between the speeds asked for, too:
resonances are found however narrow they are.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.close_peaks import find_highest
from ..core.peaks import find_swing, sum_amplitudes
from ..core.speeds import RPM
from ..core.vibration import ROUNDING, Complex, Real
from .modes import find_poles
from .motion import (
    move,
    refuse_too_many,
    refuse_torsional_resonance,
    split_speeds,
    stress_by_torque,
)
from .system import TorsionalSystem

_ROUNDS = np.array([1 / 24, 1 / 6])  # parts of the speeds, those with large amplitudes first
_NEAR = 0.9  # of the largest at the speeds looked at: what a peak beside them may exceed
_WIDE = 3.0  # steps of the speeds: of a wider resonance one of them shows 95 %
_SIDES = np.array([[-1], [-0.5], [0.5], [1]])  # of a resonance, looked at, too, in widths
_HIGH = 0.5  # of the largest: a resonance as high may have a higher peak at its side


class LargestVibration(NamedTuple):
    """The largest between the first and last of the speeds, however narrow its resonance.

    Attributes:
        speeds_rpm: (shafts,), at which the torque of each shaft is largest.
        torque: (shafts,) half peak to peak there, N m.
        sums: (shafts,) sum of the amplitudes of all orders there, N m.
        stress: (shafts,) Pa, nan where a shaft has no diameter.
        amplitudes: (orders, shafts) torque by order there, N m.
        swing_rpm, free_end: where the first node swings most, and half of that swing, rad.
        swings: (orders,) amplitude of the first node by order there, rad.
        pendulum_rpm, pendulums: (pendulums,) where each swings most against its node, and half of
            that swing, rad.
        hottest_rpm, heat: (dampers,) where each damper turns most to heat, and how much, W.
    """

    speeds_rpm: Real
    torque: Real
    sums: Real
    stress: Real
    amplitudes: Real
    swing_rpm: float
    free_end: float
    swings: Real
    pendulum_rpm: Real
    pendulums: Real
    hottest_rpm: Real
    heat: Real


class _Curves(NamedTuple):
    """Torques of shafts over the cycle, at any speed.

    Attributes:
        columns: (curves,) which of `ChainMotion.curves`: the first are those of the shafts.
        weights: (curves,) by which each is multiplied.
        together: whether the highest of all is wanted, not that of each.
    """

    system: TorsionalSystem
    columns: Sequence[int]
    weights: Real
    together: bool = False

    @property
    def orders(self) -> Real:
        """(orders,) of what excites the system."""
        return self.system.require_excitation().orders

    def at(self, rpm: Real) -> Complex:
        """By order, (orders, speeds, curves)."""
        return move(self.system, rpm).curves[:, :, list(self.columns)] * self.weights

    def pick(self, rpm: Real, curve: NDArray[np.intp]) -> Complex:
        """By order, (orders, *speeds), one curve at each speed; `curve` broadcasts to these."""
        few = np.unique(rpm)  # many curves peak between the same two
        which, curve = np.searchsorted(few, rpm), np.broadcast_to(curve, rpm.shape)
        found = np.empty((len(self.orders), *rpm.shape), complex)
        for some in split_speeds(self.system, few):
            here = (which >= some.start) & (which < some.stop)
            found[:, here] = self.at(few[some])[:, which[here] - some.start, curve[here]]
        return found

    def swing(self, rpm: Real, curve: NDArray[np.intp]) -> Real:
        """Half of peak to peak (*speeds) of one curve at each speed."""
        return find_swing(self.orders, self.pick(rpm, curve)).half

    def level(self, largest: Real) -> Real:
        """What each has to exceed (curves,), where each so far is this large."""
        return np.full_like(largest, largest.max(initial=0)) if self.together else largest


def find_largest_vibration(
    system: TorsionalSystem, rpm: Real, swings: Real, heat: Real
) -> LargestVibration:
    """Of every shaft, the first node and every damper.

    Args:
        swings: half of peak to peak at these speeds (rpm), known already, of shafts, the first node
            and pendulums, (speeds, curves).
        heat: (speeds, dampers), likewise.
    """
    count = len(system.shafts)
    curves = _Curves(system, range(swings.shape[1]), np.ones(swings.shape[1]))
    at, height = _approach_largest(curves, rpm, swings)
    there = curves.pick(at[: count + 1], np.arange(count + 1))
    torque, swings_there = there[:, :count], np.abs(there[:, count])
    return LargestVibration(
        at[:count],
        height[:count],
        sum_amplitudes(torque),
        height[:count] * stress_by_torque(system),
        np.abs(torque),
        float(at[count]),
        float(height[count]),
        swings_there,
        at[count + 1 :],
        height[count + 1 :],
        *_approach_hottest(system, rpm, heat),
    )


def find_largest_torques(
    system: TorsionalSystem, speeds_rpm: Real, shafts: Sequence[int]
) -> tuple[Real, Real]:
    """At which speed, rpm, the vibratory torque of some shafts is largest, and half of peak to peak
    there, N m, (shafts,) each, between the first and last of speeds (speeds,), rising.

    Between the speeds, those about resonances are looked at, and every peak that may be the highest
    is approached.

    Raises:
        BalcliError: an undamped mode is driven at its own frequency.
    """
    return _search(_Curves(system, shafts, np.ones(len(shafts))), speeds_rpm)


def find_largest_of_all(
    system: TorsionalSystem, speeds_rpm: Real, shafts: Sequence[int], weights: Real
) -> float:
    """The highest that `find_largest_torques` finds of some shafts, each multiplied by its weight
    (shafts,); in less time.
    """
    _, largest = _search(_Curves(system, shafts, weights, together=True), speeds_rpm)
    return float(largest.max(initial=0))


def find_hottest(system: TorsionalSystem, speeds_rpm: Real) -> tuple[Real, Real]:
    """At which speed, rpm, every damper turns most to heat, and how much, W, (dampers,) each,
    between the first and last of speeds (speeds,), rising.
    """
    return _approach_hottest(system, speeds_rpm, _find_heat(system, speeds_rpm))


def find_resonant_speeds(
    system: TorsionalSystem, rpm: Real, widest: float = np.inf
) -> tuple[Real, Real]:
    """Speeds within a range at which an order meets a damped resonance, and how wide it is there,
    rpm, (resonances,) each; `widest`: as many steps of these speeds (rpm) as it may be wide.
    """
    if len(rpm) == 1:
        return np.zeros(0), np.zeros(0)
    orders = system.require_excitation().orders
    if system.pendulums:  # their inertia differs from order to order
        poles = [find_poles(system, float(order)) for order in orders]
    else:
        poles = [find_poles(system)] * len(orders)
    found = [np.zeros((2, 0))]
    for order, each in zip(orders, poles, strict=True):
        damped = each[(each.imag > 0) & (-each.real > ROUNDING * np.abs(each))]
        at, width = damped.imag / (RPM * order), -2 * damped.real / (RPM * order)
        steps = np.diff(rpm)[np.clip(np.searchsorted(rpm, at) - 1, 0, len(rpm) - 2)]
        there = (width < widest * steps) & (at > rpm[0]) & (at < rpm[-1])
        found.append(np.stack([at, width])[:, there])
    at, width = np.concatenate(found, axis=1)
    return at, width


# ------------------------------------------------------------------ the search
def _search(curves: _Curves, rpm: Real) -> tuple[Real, Real]:
    refuse_too_many(curves.system, len(rpm))
    refuse_torsional_resonance(curves.system, rpm)
    swings = _find_large_swings(curves, rpm, np.zeros(len(curves.columns)))
    return _approach_largest(curves, rpm, swings)


def _approach_largest(curves: _Curves, rpm: Real, swings: Real) -> tuple[Real, Real]:
    """Where each curve is largest, rpm, and how large, with the swings at these speeds (speeds,
    curves), of which small ones may be the sum of the amplitudes.

    Narrow resonances are looked at; at their sides, too, where they are high.
    """
    at, width = find_resonant_speeds(curves.system, rpm, _WIDE)
    tops = _find_large_swings(curves, at, swings.max(axis=0))
    largest = curves.level(np.concatenate([swings, tops]).max(axis=0))
    high = np.any(tops >= _HIGH * largest, axis=1)
    sides = _look_beside(at[high], width[high], rpm)
    beside = _find_large_swings(curves, sides, largest)
    speeds = np.concatenate([rpm, at, sides])
    rising = np.argsort(speeds, kind="stable")
    speeds, swings = speeds[rising], np.concatenate([swings, tops, beside])[rising]
    return find_highest(curves.swing, speeds, swings, curves.level(swings.max(axis=0)), _NEAR)


def _look_beside(at: Real, width: Real, rpm: Real) -> Real:
    """Speeds at both sides of resonances, as far as they lie between the first and last speed."""
    sides = (at + width * _SIDES).ravel()
    return sides[(sides > rpm[0]) & (sides < rpm[-1])]


def _find_large_swings(curves: _Curves, rpm: Real, largest: Real) -> Real:
    """Half of peak to peak of the curves at these speeds (speeds, curves), wherever it is near the
    largest, here or known of elsewhere (curves,); elsewhere the sum of the amplitudes.

    No curve swings further than that sum, so that most need not be added up.
    """
    swings, largest = np.zeros((len(rpm), len(largest))), curves.level(largest)
    for piece in split_speeds(curves.system, rpm):
        found, here = curves.at(rpm[piece]), swings[piece]
        here[:] = sum_amplitudes(found)
        falling = np.argsort(-here, axis=0)
        for some in np.split(falling, (len(falling) * _ROUNDS).astype(int)):
            near = np.take_along_axis(here, some, axis=0) >= _NEAR * largest
            speed, curve = np.nonzero(near)
            at = some[speed, curve]
            if len(at):
                here[at, curve] = found_here = find_swing(curves.orders, found[:, at, curve]).half
                np.maximum.at(largest, curve, found_here)
                largest = curves.level(largest)
    return swings


def _approach_hottest(system: TorsionalSystem, rpm: Real, heat: Real) -> tuple[Real, Real]:
    """Where each damper turns most to heat, rpm, and how much, W, (dampers,) each, with the heat at
    these speeds (speeds, dampers). Narrow resonances are looked at, and their sides.
    """
    if not heat.shape[1]:
        return np.zeros(0), np.zeros(0)
    at, width = find_resonant_speeds(system, rpm, _WIDE)
    more = np.concatenate([at, _look_beside(at, width, rpm)])
    speeds = np.concatenate([rpm, more])
    rising = np.argsort(speeds, kind="stable")
    speeds = speeds[rising]
    heat = np.concatenate([heat, _find_heat(system, more)])[rising]

    def judge(rpm: Real, damper: NDArray[np.intp]) -> Real:
        few = np.unique(rpm)
        return _find_heat(system, few)[np.searchsorted(few, rpm), damper]

    return find_highest(judge, speeds, heat, heat.max(axis=0), _NEAR)


def _find_heat(system: TorsionalSystem, rpm: Real) -> Real:
    """Power that dampers turn to heat (speeds, dampers), W."""
    pieces = split_speeds(system, rpm)
    parts = [move(system, rpm[some]).heat.sum(axis=0) for some in pieces]
    return np.concatenate([np.zeros((0, len(system.dampers))), *parts])

"""Compute what is judged at single speeds: half of peak to peak of torques and swings, with all
orders added up in time, and the heat of dampers.
"""

from __future__ import annotations

import numpy as np

from ..core.peaks import find_swing, sum_amplitudes
from ..core.vibration import Indices, Real
from .motion import compute_curves, compute_in_parts
from .poles import expand_in_poles
from .system import TorsionalSystem


class Columns:
    """Half of peak to peak of the torque of each shaft (N m), of the swing of the free end and of
    each pendulum (rad), and the heat of each damper (W), as functions of the speed.

    Args:
        system: System with an excitation.
    """

    def __init__(self, system: TorsionalSystem) -> None:
        curves = len(system.shafts) + 1 + len(system.pendulums)
        rubber = len(system.nodes) - 1 - system.last
        self.count = curves + len(system.rings) + rubber
        self._system = system
        self._orders = system.require_excitation().orders
        self._curves = curves
        self._sum = expand_in_poles(system)
        self._spanned = np.zeros(self.count, bool)
        if self._sum is not None:
            self._spanned[: len(self._sum.spanned)] = self._sum.spanned

    def bound(self, rpm: Real, which: Indices) -> Real:
        """Return upper bounds at speeds (speeds,), shape (speeds, len(which))."""
        if self._sum is not None and np.all(self._spanned[which]):
            return self._sum.sum_amplitudes(rpm, which)
        parts = compute_in_parts(self._system, rpm)
        bounds = [np.append(sum_amplitudes(curves), heat, axis=1) for curves, heat in parts]
        return np.concatenate(bounds)[:, which]

    def find(self, rpm: Real, which: Indices) -> Real:
        """Return values at speeds (places,), each of the column in `which`, by sums over poles
        where these exist. They may have less digits than those of `find_exactly`.
        """
        values = np.zeros(len(rpm))
        summed = self._spanned[which]
        if self._sum is not None and np.any(summed):
            phasors = self._sum.find_curves(rpm[summed], which[summed])
            values[summed] = find_swing(self._orders, phasors).half
        if not np.all(summed):
            values[~summed] = self.find_exactly(rpm[~summed], which[~summed])
        return values

    def find_exactly(self, rpm: Real, which: Indices) -> Real:
        """Return values at speeds (places,), each of the column in `which`."""
        values = np.zeros(len(rpm))
        if not len(rpm):
            return values
        speeds, place = np.unique(rpm, return_inverse=True)
        phasors, heat = compute_curves(self._system, speeds)
        swings = which < self._curves
        values[swings] = find_swing(self._orders, phasors[:, place[swings], which[swings]]).half
        values[~swings] = heat[place[~swings], which[~swings] - self._curves]
        return values

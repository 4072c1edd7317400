"""Compute what is judged at single speeds: half of peak to peak of torques and swings, with all
orders added up in time, and the heat of dampers.
"""

from __future__ import annotations

import numpy as np

from ..core.vibration import Complex, Indices, Real
from .motion import compute_curves, compute_in_parts, find_half_swing
from .poles import PoleSum, expand_in_poles
from .system import TorsionalSystem


class Columns:
    """Half of peak to peak of the torque of each shaft (N m), of the swing of the free end and of
    each pendulum (rad), and the heat of each damper (W), as functions of the speed.

    Args:
        system: System with an excitation.
    """

    def __init__(self, system: TorsionalSystem) -> None:
        curves = len(system.shafts) + 1 + len(system.pendulums)
        self.count = curves + len(system.rings) + system.rubber_rings
        self._system = system
        self._curves = curves
        self._sum = expand_in_poles(system)
        self._unphased: list[PoleSum] = []
        self._spanned = np.zeros(self.count, bool)
        if self._sum is not None:
            self._spanned[: len(self._sum.spanned)] = self._sum.spanned
            self._unphased = [self._sum.drive(own) for own in system.unphased]

    @property
    def poles(self) -> Complex | None:
        """Poles of the system, rad/s; None if they were not needed."""
        return None if self._sum is None else self._sum.poles

    def bound(self, rpm: Real, which: Indices) -> Real:
        """Return upper bounds at speeds (speeds,), shape (speeds, len(which))."""
        if self._sum is not None and np.all(self._spanned[which]):
            sums = self._sum.sum_amplitudes(rpm, which)
            for unphased in self._unphased:
                sums = sums + unphased.sum_amplitudes(rpm, which)
            return sums
        parts = compute_in_parts(self._system, rpm)
        bounds = [np.append(part.sums, part.heat, axis=1) for part in parts]
        return np.concatenate(bounds)[:, which]

    def find(self, rpm: Real, which: Indices) -> Real:
        """Return values at speeds (places,), each of the column in `which`, by sums over poles
        where these exist. They may have fewer digits than those of `find_exactly`.
        """
        values = np.zeros(len(rpm))
        summed = self._spanned[which]
        if self._sum is not None and np.any(summed):
            phasors = self._sum.find_curves(rpm[summed], which[summed])
            values[summed] = find_half_swing(self._sum.excitation.orders, phasors)
            for unphased in self._unphased:
                own = unphased.find_curves(rpm[summed], which[summed])
                values[summed] += np.abs(own[0])
        if not np.all(summed):
            values[~summed] = self.find_exactly(rpm[~summed], which[~summed])
        return values

    def find_exactly(self, rpm: Real, which: Indices) -> Real:
        """Return values at speeds (places,), each of the column in `which`."""
        values = np.zeros(len(rpm))
        if not len(rpm):
            return values
        speeds, place = np.unique(rpm, return_inverse=True)
        curves = compute_curves(self._system, speeds)
        swings = which < self._curves
        values[swings] = curves.select(place[swings], which[swings]).swings
        values[~swings] = curves.heat[place[~swings], which[~swings] - self._curves]
        return values

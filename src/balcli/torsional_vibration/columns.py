"""Compute what is judged at single speeds: half of peak to peak of torques and swings, with all
orders added up in time, and the heat of dampers.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..core.vibration import Complex, Indices, Real
from .motion import compute_curves, compute_in_parts, find_half_swing
from .poles import PoleSum, expand_in_poles, join_sums
from .system import TorsionalSystem


class Columns:
    """Half of peak to peak of the torque of each shaft (N m), of the swing of the free end and of
    each pendulum (rad), and the heat of each damper (W), as functions of the speed.

    Args:
        systems: Systems with an excitation; if they are more than one, variants of one system.
    """

    def __init__(self, systems: Sequence[TorsionalSystem]) -> None:
        first = systems[0]
        curves = len(first.shafts) + 1 + len(first.pendulums)
        self.count = curves + len(first.rings) + first.rubber_rings
        self._systems = systems
        self._curves = curves
        self._sum: PoleSum | None = None
        self._unphased: list[PoleSum] = []
        if len(systems) == 1 or not first.unphased:
            self._sum = join_sums([expand_in_poles(system) for system in systems])
        self._spanned = np.zeros(self.count, bool)
        if self._sum is not None:
            self._spanned[: len(self._sum.spanned)] = self._sum.spanned
            self._unphased = [self._sum.drive(own) for own in first.unphased]

    @property
    def are_sums(self) -> bool:
        """Whether torques of all systems are sums over poles, which are computed together."""
        return self._sum is not None

    def find_poles(self, system: int) -> Complex | None:
        """Return the poles of a system, rad/s; None if they were not needed."""
        return None if self._sum is None else self._sum.poles[system]

    def bound(self, rpm: Real, which: Indices, system: int = 0) -> Real:
        """Return upper bounds at speeds (speeds,) for a system, shape (speeds, len(which))."""
        if self._sum is not None and np.all(self._spanned[which]):
            sums = self._sum.sum_amplitudes(rpm, which, system)
            for unphased in self._unphased:
                sums = sums + unphased.sum_amplitudes(rpm, which)
            return sums
        parts = compute_in_parts(self._systems[system], rpm)
        bounds = [np.append(part.sums, part.heat, axis=1) for part in parts]
        return np.concatenate(bounds)[:, which]

    def find(self, rpm: Real, which: Indices, system: Indices | None = None) -> Real:
        """Return values at speeds (places,), each of the column in `which`, by sums over poles
        where these exist. They may have fewer digits than those of `find_exactly`.

        Args:
            rpm: Speeds, shape (places,).
            which: Index of the column of each place.
            system: Index of the system of each place; None: the first system.
        """
        if system is None:
            system = np.zeros(len(rpm), int)
        values = np.zeros(len(rpm))
        summed = self._spanned[which]
        if self._sum is not None and np.any(summed):
            places = rpm[summed], system[summed], which[summed]
            values[summed] = find_half_swing(self._sum.orders, self._sum.find_curves(*places))
            for unphased in self._unphased:
                values[summed] += np.abs(unphased.find_curves(*places)[0])
        for k in np.unique(system[~summed]).tolist():
            own = ~summed & (system == k)
            values[own] = self.find_exactly(rpm[own], which[own], k)
        return values

    def find_exactly(self, rpm: Real, which: Indices, system: int = 0) -> Real:
        """Return values of a system at speeds (places,), each of the column in `which`."""
        values = np.zeros(len(rpm))
        if not len(rpm):
            return values
        speeds, place = np.unique(rpm, return_inverse=True)
        curves = compute_curves(self._systems[system], speeds)
        swings = which < self._curves
        values[swings] = curves.select(place[swings], which[swings]).swings
        values[~swings] = curves.heat[place[~swings], which[~swings] - self._curves]
        return values

"""Compute what is judged at single speeds: half of peak to peak of torques and swings, with all
orders added up in time, and the heat of dampers.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..core.vibration import Complex, Indices, Real
from .motion import compute_curves, compute_in_parts, find_half_swing
from .poles import PoleSum, expand_in_poles
from .system import TorsionalSystem


class Columns:
    """Half of peak to peak of the torque of each shaft (N m), of the swing of the free end and of
    each pendulum (rad), and the heat of each damper (W), as functions of the speed.

    Args:
        systems: Systems with excitations of the same orders; if they are more than one, variants of
            one system.
    """

    def __init__(self, systems: Sequence[TorsionalSystem]) -> None:
        first = systems[0]
        self.count = len(first.shafts) + 1 + len(first.pendulums) + len(first.rings)
        self.count += first.rubber_rings
        self._systems = systems
        self._orders = first.require_excitation().orders
        self._swings = len(first.shafts) + 1 + len(first.pendulums)
        self._sums = [expand_in_poles(system) for system in systems]
        self._spanned = np.zeros((len(systems), self.count), bool)
        for own, summed in zip(self._spanned, self._sums, strict=True):
            if summed is not None:
                own[: len(summed.spanned)] = summed.spanned
        self._unphased: list[list[PoleSum]] = []
        for system, summed in zip(systems, self._sums, strict=True):
            unphased = [] if summed is None else [summed.drive(own) for own in system.unphased]
            self._unphased.append(unphased)

    def find_poles(self, system: int) -> Complex | None:
        """Return the finite poles of a system, rad/s; None if it has no sums over poles."""
        summed = self._sums[system]
        return None if summed is None else summed.poles

    def bound(self, rpm: Real, which: Indices, system: int = 0) -> Real:
        """Return upper bounds at speeds (speeds,) for a system, shape (speeds, len(which))."""
        summed = self._sums[system]
        if summed is not None and np.all(self._spanned[system, which]):
            bounds = summed.sum_amplitudes(rpm, which)
            for unphased in self._unphased[system]:
                bounds += unphased.sum_amplitudes(rpm, which)
            return bounds
        parts = compute_in_parts(self._systems[system], rpm)
        all_bounds = [np.append(part.sums, part.heat, axis=1) for part in parts]
        return np.concatenate(all_bounds)[:, which]

    def find(
        self,
        rpm: Real,
        which: Indices,
        system: Indices | None = None,
        least: Real | None = None,
    ) -> Real:
        """Return values at speeds (places,), each of the column in `which`, by sums over poles
        where these exist. They may have fewer digits than those of `find_exactly`.

        Args:
            rpm: Speeds, shape (places,).
            which: Index of the column of each place.
            system: Index of the system of each place; None: the first system.
            least: Value from which a column matters at each place. Where a value is smaller, an
                upper bound of it may be returned, which is below `least`, too; this saves time.
                None: all values matter.
        """
        if system is None:
            system = np.zeros(len(rpm), int)
        if least is None:
            least = np.zeros(len(rpm))
        values = np.zeros(len(rpm))
        spanned = self._spanned[system, which]
        if np.any(spanned):
            sums = rpm[spanned], which[spanned], system[spanned], least[spanned]
            values[spanned] = self._sum_poles(*sums)
        if not np.all(spanned):
            others = rpm[~spanned], which[~spanned], system[~spanned]
            values[~spanned] = self.find_exactly(*others)
        return values

    def _sum_poles(self, rpm: Real, which: Indices, system: Indices, least: Real) -> Real:
        """Return values as `find` does, of columns that are sums over poles."""
        curves = np.empty((len(self._orders), len(rpm)), complex)
        unphased = np.zeros(len(rpm))
        for k in np.unique(system).tolist():
            summed = self._sums[k]
            if summed is None:
                continue  # such a system has no column that is a sum
            own = np.flatnonzero(system == k)
            curves[:, own] = summed.find_curves(rpm[own], which[own])
            for alone in self._unphased[k]:
                unphased[own] += np.abs(alone.find_curves(rpm[own], which[own])[0])
        return find_half_swing(self._orders, curves, least - unphased) + unphased

    def find_exactly(self, rpm: Real, which: Indices, system: Indices) -> Real:
        """Return values at speeds (places,), each of the column and of the system whose indices are
        given.
        """
        values = np.zeros(len(rpm))
        curves = np.zeros((len(self._orders), len(rpm)), complex)
        for k in np.unique(system).tolist():
            own = np.flatnonzero(system == k)
            speeds, place = np.unique(rpm[own], return_inverse=True)
            found = compute_curves(self._systems[k], speeds)
            swings = which[own] < self._swings
            single = found.select(place[swings], which[own[swings]])
            curves[:, own[swings]] = single.phasors
            values[own[swings]] = single.unphased.sum(axis=0)
            heats = own[~swings]
            values[heats] = found.heat[place[~swings], which[heats] - self._swings]
        values += find_half_swing(self._orders, curves)
        return values

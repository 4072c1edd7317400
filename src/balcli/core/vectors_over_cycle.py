"""Compute orders and largest values over a cycle of forces in a plane that are smooth between
common breakpoints.

All forces are sampled at the Gauss-Legendre nodes of the same panels, on which each is a short
series (`core.piecewise`). A sum of forces is then a sum of samples, so that each force is computed
only once.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

import numpy as np
from numpy.polynomial.legendre import legvander

from .peaks import Peak
from .phasors import Array, Complex
from .piecewise import PiecewiseCurve, cut, gauss, quadrature, resolved, values_to_series

Vectors: TypeAlias = Callable[[Array], Complex]  # values at angles, shape (vectors, angles)

_TERMS = 16  # number of terms of a series: as many as `quadrature` has nodes
_TURN_ON_PANEL = 4.0  # rad; if e^{in angle} turns no farther on a panel, these terms suffice
_AT_ONCE = 1 << 20  # largest number of orders x angles, which bounds the memory


@dataclass(frozen=True, eq=False)
class Panels:
    """Panels of a cycle on which all forces are short series.

    Attributes:
        breaks: Rising breakpoints, rad; the last is one period after the first.
    """

    breaks: Array

    @cached_property
    def angles(self) -> Array:
        """Angles of the samples, rad, shape (samples,): the first node of every panel, the second,
        ...
        """
        return quadrature(self.breaks)[0].reshape(-1)

    def find_orders(self, samples: Complex, orders: Array) -> tuple[Complex, Complex]:
        """Return the vectors that turn with the crank and those that turn against it, each of shape
        (orders, forces).

        Args:
            samples: Samples of the forces, shape (forces, samples).
            orders: Orders, shape (orders,), up to the highest for which the panels were made. For
                orders that the period does not have, the vectors are 0.
        """
        weighed = (samples * quadrature(self.breaks)[1].reshape(-1)).T
        step = max(_AT_ONCE // len(self.angles), 1)
        forward, backward = [], []
        for k in range(0, len(orders), step):
            turned = np.exp(-1j * orders[k : k + step, None] * self.angles)
            forward.append(turned @ weighed)
            backward.append(np.conj(turned) @ weighed)
        ahead, against = np.concatenate(forward), np.concatenate(backward)
        against[orders == 0] = 0.0  # only the other vector holds the mean
        waves = orders * (self.breaks[-1] - self.breaks[0]) / (2 * np.pi)
        there = np.abs(waves - np.rint(waves)) < 0.1  # orders that the period has
        ahead[~there] = against[~there] = 0.0
        return ahead, against

    def find_largest(self, samples: Complex) -> Peak:
        """Return the largest size of a force and the first angle (rad) at which it is reached. At a
        jump both sides count.
        """
        series = self._find_series(samples)
        finer = 2 * _TERMS - 1  # terms of the square
        values = legvander(gauss(finer)[0], _TERMS - 1) @ series
        squares = values_to_series(finer) @ (values.real**2 + values.imag**2)
        highest = PiecewiseCurve(self.breaks, squares).extremes()[1]
        return Peak(float(np.sqrt(max(highest.value, 0.0))), highest.angle)

    def find_mean_size(self, samples: Complex) -> float:
        """Return the mean size of a force over the period. The size has a corner where the force is
        0.
        """
        series = self._find_series(samples)
        x, y = (PiecewiseCurve(self.breaks, part) for part in (series.real, series.imag))
        return resolved(lambda at: np.hypot(x.within(at), y.within(at)), self.breaks).mean

    def _find_series(self, samples: Complex) -> Complex:
        """Return the Legendre coefficients of a force on each panel, shape (terms, panels)."""
        return np.asarray(values_to_series(_TERMS) @ samples.reshape(_TERMS, -1))


def find_panels(forces: Vectors, breaks: Array, highest_order: float) -> Panels:
    """Return panels for forces that are smooth between breakpoints, fine enough for these orders.

    Args:
        forces: Function that returns the values of all forces at angles (rad).
        breaks: Rising breakpoints, rad; the last is one period after the first.
        highest_order: Highest order that is wanted.
    """

    def add_squares(angle: Array) -> Array:
        found = forces(angle.reshape(-1))
        return np.asarray((np.abs(found) ** 2).sum(axis=0)).reshape(angle.shape)

    found = resolved(add_squares, breaks).breaks
    return Panels(cut(found, _TURN_ON_PANEL / max(highest_order, 1.0)))

"""Gas torque from builders' tables: harmonics of the mean tangential pressure."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .cylinder_pressure import GasError, GasTorque
from .phasors import Array, Complex


@dataclass(frozen=True)
class TangentialTorque(GasTorque):
    """Torque given by its harmonics, from the firing dead centre.

    Attributes:
        halves: whole numbers h, twice the orders, rising, shape (orders,).
        coefficients: t_h, N m, of `Re sum t_h e^{i h c/2}`, shape (orders,).
        strokes: 4, or 2 with even h alone.
    """

    halves: NDArray[np.intp]
    coefficients: Complex
    strokes: int = 4

    @property
    def breaks(self) -> Array:
        return np.array([0.0, self.strokes * np.pi])

    @property
    def work(self) -> float:
        """Work of one cycle, J."""
        return float(self.harmonics([0])[0].real * self.strokes * np.pi)

    def at(self, angle: ArrayLike, *, before: bool = False) -> Array:
        turning = np.exp(0.5j * np.multiply.outer(np.asarray(angle, float), self.halves))
        return (turning @ self.coefficients).real

    def harmonics(self, halves: ArrayLike) -> Complex:
        """Those of the table; 0 for an order that it does not have."""
        wanted = np.asarray(halves)
        known = dict(zip(self.halves.tolist(), self.coefficients.tolist(), strict=True))
        return np.array([known.get(h, 0j) for h in wanted.tolist()])


def tangential_torque(
    orders: ArrayLike,
    cosines: ArrayLike,
    sines: ArrayLike,
    *,
    area: float,
    radius: float,
    strokes: int = 4,
) -> TangentialTorque:
    """The torque of a table of T/(A r), each of shape (orders,).

    Args:
        orders: cycles a revolution, multiples of 1/2 (four-stroke) or whole numbers.
        cosines, sines: Pa, of `a cos n c + b sin n c` from the firing dead centre.
        area, radius: of the bore (m2), of the crank (m).

    Raises:
        GasError: an order that the cycle does not have.
    """
    wanted, step = np.asarray(orders, float), 2 / strokes
    for order in wanted[(wanted < 0) | (wanted % step != 0)].tolist():
        raise GasError(
            "harmonics",
            f"has order {order:g}: a cycle of {strokes} strokes has multiples of {step:g}",
        )
    halves = (2 * wanted).astype(np.intp)
    coefficients = area * radius * (np.asarray(cosines, float) - 1j * np.asarray(sines, float))
    return TangentialTorque(halves, np.where(halves == 0, coefficients.real, coefficients), strokes)

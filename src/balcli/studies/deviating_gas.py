"""Torque of the gas in engines whose throw angles and rod lengths deviate.

A throw that stands ahead has its cylinders fire ahead: a phase. With another length of its rod, a
cylinder's torque is another function of the crank angle; its harmonics are smooth in the length,
and so are known to rounding from a few lengths across the tolerance.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..core.cylinders import Cylinders
from ..core.phasors import Array, Complex, Phasors, unit
from ..engine.build import assemble
from ..engine.build_gas import build_gas
from ..engine.gas import EngineGas
from ..enginefile.model import EngineFile
from ..errors import BalcliError
from ..forces.gas import find_courses

_LENGTHS = 9  # Chebyshev points across the tolerance


class DeviatingGas:
    """Gas of an engine file, of which rod lengths and throw angles may deviate.

    Args:
        model: with gas.
        tolerance: of rod lengths, relative.

    Raises:
        BalcliError: lengths of articulated rods.
    """

    def __init__(self, model: EngineFile, tolerance: float) -> None:
        parts = assemble(model)
        self._cylinders = parts.cylinders
        if tolerance and parts.cylinders.linkage is not None:
            raise BalcliError(
                "gas torque does not scatter with lengths of articulated rods; vary single ones "
                "with sweep"
            )
        middles = np.arange(_LENGTHS) + 0.5 if tolerance else np.array([_LENGTHS / 2])
        self._points = tolerance * np.cos(np.pi / _LENGTHS * middles)
        self._gases = [build_gas(parts, self._stretch(float(x))) for x in self._points]

    def _stretch(self, share: float) -> Cylinders:
        c = self._cylinders
        return replace(c, lam=c.lam / (1 + share), eps=c.eps / (1 + share))

    def find_torque(self, orders: Array, lengths: Array, ahead_deg: Array) -> Phasors:
        """Of all cylinders on the crank, N m, shape (orders, samples).

        Args:
            orders: (orders,).
            lengths: relative deviation of every rod, shape (cylinders or 1, samples or 1).
            ahead_deg: of every throw, deg, likewise.
        """
        at_points = [_find_torque_from_pins(gas, orders) for gas in self._gases]
        error = np.max([error for _, error in at_points], axis=0)
        courses = np.stack([torque for torque, _ in at_points])
        weights = self._weigh_points(lengths)
        total: Complex = np.zeros((len(orders), 1), complex)
        for row, cylinder in enumerate(self._nominal.cylinders):
            own = row if len(weights) > 1 else 0
            turned = row if len(ahead_deg) > 1 else 0
            at = cylinder.nominal_deg - ahead_deg[turned]
            torque = (weights[own] @ courses[:, :, row]).T
            total = total + torque * unit(-orders[:, None] * at)
        noise = np.broadcast_to(error.sum(axis=1)[:, None], total.shape)
        return Phasors.from_scalar(orders, total, noise)

    @property
    def _nominal(self) -> EngineGas:
        return self._gases[len(self._gases) // 2]

    def _weigh_points(self, lengths: Array) -> Array:
        """Weight of every length that is known in those asked for, shape (cylinders or 1, samples
        or 1, points): Lagrange's.
        """
        weights = np.ones((*lengths.shape, len(self._points)))
        for k, own in enumerate(self._points):
            for other in np.delete(self._points, k):
                weights[..., k] *= (lengths - other) / (own - other)
        return weights


def _find_torque_from_pins(gas: EngineGas, orders: Array) -> tuple[Complex, Array]:
    """Torque of each cylinder's gas after its crank pin has stood along its axis, N m, shape
    (orders, cylinders), and its error.
    """
    courses, error = find_courses(gas, orders)
    tops = np.array([cylinder.piston.top for cylinder in gas.cylinders])
    return courses * np.exp(-1j * np.multiply.outer(orders, tops)), error

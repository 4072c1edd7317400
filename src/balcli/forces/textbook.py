"""The units of textbooks: the forces of one cylinder, of which those of the engine are multiples.

`F1 = m_rec r omega^2` is the first-order force of cylinder 1's reciprocating mass, `F_n = A_n F1`
its n-th; moments are multiples of these times the distance of neighbouring throws.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..core.mechanisms import harmonics
from ..core.phasors import Array
from ..engine.build import Engine
from .kinds import Kind


class TextbookUnits(NamedTuple):
    """What the forces and moments of an engine are multiples of.

    Attributes:
        force: F1, N.
        arm: a, the distance of neighbouring throws, m; nan for one throw.
        ratios: |A_n| of each order, shape (orders,).
        equal: whether all cylinders are like cylinder 1.
    """

    force: float
    arm: float
    ratios: Array
    equal: bool

    def size(self, kind: Kind) -> float:
        """What a force (N) or a moment (N m; nan for one throw) is a multiple of."""
        return self.force if kind.dimension == "force" else self.force * self.arm

    def name(self, kind: Kind) -> str:
        """How this unit is written."""
        return "F1" if kind.dimension == "force" else "F1·a"


def find_textbook_units(engine: Engine, orders: Array) -> TextbookUnits:
    """The units of an engine without trailing axes, for these orders."""
    c, row = engine.cylinders, engine.numbers.index(1)

    def of_cylinder_1(values: Array) -> Array:
        return values[row : row + 1] if len(values) > 1 else values

    lam, eps = of_cylinder_1(c.lam), of_cylinder_1(c.eps)
    series = harmonics.find_harmonics(orders, lam, eps, {"piston"}).piston
    mass = float(of_cylinder_1(c.reciprocating)[0])
    gaps = len(engine.throws_m) - 1
    return TextbookUnits(
        force=float(mass * c.radius * engine.omega**2),
        arm=float(np.ptp(engine.throws_m) / gaps) if gaps else float("nan"),
        ratios=np.abs(series.c[:, 0]),
        equal=engine.equal,
    )

"""Why an order of the gas torque vanishes: sums of e^{-i n f} decided exactly.

Cylinders with one and the same torque over their cycle share its coefficients, so an order vanishes
if `sum share e^{-i n f}` does over each such family, f the crank angle at which a cylinder fires: a
fraction of two revolutions, n a multiple of 1/2.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator
from fractions import Fraction

import numpy as np

from ..core.phasors import Array
from ..core.roots_of_unity import rational, turns, vanishes
from ..engine.build import Engine
from ..engine.gas import CylinderGas, EngineGas
from .gas import take_gas
from .spectrum import compute_each_cylinder, compute_spectra

_LARGEST_DENOMINATOR = 1_000_000  # of the ratio of two shares
_ROUNDING = 16 * float(np.finfo(float).eps)  # by which such a ratio may be off


def measure_gas(engine: Engine, orders: Array) -> Iterator[tuple[bool, float | None]]:
    """For each order: whether symmetry alone makes it 0, and what is left in units of the largest
    that one cylinder makes; None where no cylinder has any.
    """
    gas = take_gas(engine)
    whole = compute_spectra(engine, orders, ["gas"])["gas"].major
    single = compute_each_cylinder(engine, orders, ["gas"])["gas"].major.max(axis=1)
    for k, order in enumerate(orders.tolist()):
        size = float(whole[k] / single[k]) if single[k] else None
        yield _vanishes(gas, order), size


def _vanishes(gas: EngineGas, order: float) -> bool:
    families: dict[int, list[CylinderGas]] = defaultdict(list)
    for cylinder in gas.cylinders:
        families[id(cylinder.torque)].append(cylinder)
    return all(_family_vanishes(family, round(2 * order)) for family in families.values())


def _family_vanishes(family: Iterable[CylinderGas], half: int) -> bool:
    """Whether `sum share e^{-i h f/2}` does, h twice the order."""
    fired = [cylinder for cylinder in family if cylinder.share]
    if not fired:
        return True
    most = max(cylinder.share for cylinder in fired)
    shares = [rational(c.share / most, _LARGEST_DENOMINATOR, _ROUNDING) for c in fired]
    angles = [turns(c.nominal_deg / 2) for c in fired]
    known = [(s, a) for s, a in zip(shares, angles, strict=True) if s is not None and a is not None]
    if len(known) < len(fired):
        return False
    return vanishes([s for s, _ in known], [Fraction(-half) * a % 1 for _, a in known])

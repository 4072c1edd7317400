"""Why an order of the gas torque vanishes: sums of e^{-i n f} decided exactly.

Cylinders with one and the same torque over their cycle share its coefficients, so an order vanishes
if `sum share e^{-i n f}` does over each such family, f the crank angle at which a cylinder fires: a
fraction of two revolutions, n a multiple of 1/2.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from fractions import Fraction

import numpy as np

from ..core.phasors import Array
from ..core.roots_of_unity import rational, turns
from ..engine.build import Engine
from ..engine.gas import CylinderGas, EngineGas
from .cancellation import WEIGHT_DENOMINATOR, Term, are_in_phase, sum_to_nothing, tell_cancellation
from .gas import take_gas
from .spectrum import compute_each_cylinder, compute_spectra

_ROUNDING = 16 * float(np.finfo(float).eps)  # by which such a ratio may be off


def measure_gas(engine: Engine, orders: Array) -> Iterator[tuple[bool, float | None, str]]:
    """For each order: whether symmetry alone makes it 0; what is left in units of the largest that
    one cylinder makes, None where no cylinder has any; and what cancels, or that nothing does, in
    words.
    """
    gas = take_gas(engine)
    whole = compute_spectra(engine, orders, ["gas"])["gas"].major
    single = compute_each_cylinder(engine, orders, ["gas"])["gas"].major.max(axis=1)
    for k, order in enumerate(orders.tolist()):
        size = float(whole[k] / single[k]) if single[k] else None
        families = [_list_terms(family, round(2 * order)) for family in _list_families(gas, engine)]
        known = [family for family in families if family]
        if len(known) < len(families):
            yield False, size, ""
        elif all(map(sum_to_nothing, known)):
            yield True, size, tell_cancellation(known)
        else:
            together = len(known) == 1 and are_in_phase(known[0])
            yield False, size, "all in phase" if together else ""


Numbered = tuple[int, CylinderGas]


def _list_families(gas: EngineGas, engine: Engine) -> list[list[Numbered]]:
    """Cylinders that fire, those of one torque together."""
    each = list(zip(engine.numbers, gas.cylinders, strict=True))
    families = [[each[row] for row in rows if each[row][1].share] for _, rows in gas.group_equal()]
    return [family for family in families if family]


def _list_terms(family: Iterable[Numbered], half: int) -> list[Term]:
    """Those of `sum share e^{-i h f/2}`, h twice the order; none if they are no fractions."""
    fired = sorted(family)
    most = max(cylinder.share for _, cylinder in fired)
    first = fired[0][1].nominal_deg
    terms = []
    for number, cylinder in fired:
        share = rational(cylinder.share / most, WEIGHT_DENOMINATOR, _ROUNDING)
        angle = turns((cylinder.nominal_deg - first) / 2)
        if share is None or angle is None:
            return []
        terms.append(Term(number, share, Fraction(half) * angle % 1))
    return terms

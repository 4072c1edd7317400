"""What a balance quality grade permits to be left beside each counterweight of a crankshaft."""

from __future__ import annotations

import math
from dataclasses import replace

from ..errors import BalcliError
from ..field_balancing.permitted import find_permitted_unbalance
from .balance import Balance, PermittedUnbalance


def permit_unbalance(result: Balance, grade: float | None, mass: float | None) -> Balance:
    """The balance with what the grade permits at the engine's speed; as it is without a grade.

    Args:
        grade: mm/s. mass: of the crankshaft as it is balanced, bobweights included, kg.

    Raises:
        BalcliError: one without the other, figures that are not positive, or no counterweights.
    """
    if grade is None and mass is None:
        return result
    if grade is None or mass is None:
        raise BalcliError(
            "--grade and --mass belong together: a grade such as 16 permits an unbalance by the "
            "mass of the crankshaft, in kg"
        )
    if not (0 < grade < math.inf and 0 < mass < math.inf):
        raise BalcliError(f"--grade {grade:g} --mass {mass:g}: both must be positive numbers")
    count = len(result.remedy.needs or result.remedy.counterweights)
    if not count:
        raise BalcliError(
            f"--grade: scheme {result.remedy.scheme} fits no counterweights to the crankshaft, so "
            "there is nothing to share the permitted unbalance; choose one that does, such as "
            "--scheme counterweights"
        )
    whole = find_permitted_unbalance(grade, mass, float(result.before.engine.speed_rpm))
    return replace(result, permitted=PermittedUnbalance(grade, mass, 1e-6 * whole / count))

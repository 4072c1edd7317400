"""Find the cylinder whose misfire loads the shafts most."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np

from ..core.vibration import Real
from ..engine.engine import CylinderNumber
from ..errors import NO_GAS, ArgumentError, BalcliError
from ..process import Tell, tell_nobody
from .build import NO_DAMPERS
from .load import Source
from .misfire import list_firing
from .response import find_largest
from .system import TorsionalSystem
from .verdicts import find_hardest

_EQUAL = 1e-9  # relative difference below which two cylinders load the shafts alike


@dataclass(frozen=True, kw_only=True)
class MisfireCase:
    """Largest load of any shaft if one cylinder does not fire.

    Attributes:
        cylinder: Number of the cylinder.
        share: Largest value divided by its limit; left out without a limit.
        stress_Pa: Largest stress; left out with a limit, and without a diameter.
        torque_Nm: Largest torque, half of peak to peak; left out with a limit or a stress.
        shaft: Shaft that has this value.
        speed_rpm: Speed of this value.
    """

    cylinder: CylinderNumber
    share: float | None = None
    stress_Pa: float | None = None
    torque_Nm: float | None = None
    shaft: str
    speed_rpm: float

    @property
    def size(self) -> float:
        """The figure by which cylinders are compared; all cases of a system have the same kind."""
        return self.share or self.stress_Pa or self.torque_Nm or 0.0


class WorstMisfire(NamedTuple):
    """Misfires of all cylinders, one at a time.

    Attributes:
        worst: Number of the cylinder whose misfire loads the shafts most; the lowest one of equals.
        cases: Largest load with each misfire.
    """

    worst: CylinderNumber
    cases: tuple[MisfireCase, ...]


def find_worst_misfire(source: Source, rpm: Real, tell: Tell = tell_nobody) -> WorstMisfire:
    """Return the misfires of all cylinders, one at a time.

    Args:
        source: Engine.
        rpm: Rising speeds, shape (speeds,).
        tell: Function that is called with the share of the work done so far.

    Raises:
        BalcliError: The engine has no gas or no shaft, or a response passes an undamped resonance.
    """
    if source.engine is None or source.engine.gas is None or source.without is None:
        name = source.system(NO_DAMPERS).file
        raise BalcliError(NO_GAS).within(name)
    if not source.system(NO_DAMPERS).shafts:
        raise ArgumentError("{misfire} worst: there is no shaft whose load could be compared")
    numbers = list_firing(source.engine)
    cases: list[MisfireCase] = []
    for number in numbers:
        system = source.without(number, source.misfire.compressing).system(NO_DAMPERS)
        cases.append(_find_case(system, number, rpm))
        tell(len(cases) / len(numbers))
    return WorstMisfire(choose_worst(cases), tuple(cases))


def choose_worst(cases: Sequence[MisfireCase]) -> CylinderNumber:
    """Return the cylinder of the largest load, the first one of equals; cases are of one kind."""
    largest = max(case.size for case in cases)
    return next(case.cylinder for case in cases if case.size >= largest * (1 - _EQUAL))


def _find_case(system: TorsionalSystem, number: CylinderNumber, rpm: Real) -> MisfireCase:
    """Return the largest load of a system in which a cylinder does not fire: the share of a limit,
    the stress of systems without limits, or else the torque.
    """
    make = partial(MisfireCase, cylinder=number)
    hardest = find_hardest(system, rpm)
    if hardest is not None:
        shaft = system.shafts[hardest.limit.column]
        return make(share=hardest.share, shaft=shaft, speed_rpm=hardest.speed_rpm)
    stressed = bool(np.any(system.stress_by_torque))
    weights = system.stress_by_torque if stressed else np.ones(len(system.shafts))
    speeds, values = find_largest(system, rpm, weights, together=True)
    of_shafts = values[: len(system.shafts)]
    k = int(of_shafts.argmax())
    value = float(of_shafts[k])
    make = partial(make, shaft=system.shafts[k], speed_rpm=float(speeds[k]))
    return make(stress_Pa=value) if stressed else make(torque_Nm=value)

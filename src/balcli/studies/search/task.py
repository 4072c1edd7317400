"""What a search by sums of orders is asked."""

from __future__ import annotations

from typing import NamedTuple

from ...core.telling import Tell
from ...enginefile.model import EngineFile
from ...forces.quantity import Quantity
from .objective import Objective


class Task(NamedTuple):
    """One search.

    Attributes:
        model: what is arranged.
        objective: what should be small, and what must stay below its limit.
        wanted: how many arrangements.
        even_firing: whether they have to fire evenly.
        locked: from where to where (deg) a bank angle leaves rods that cannot follow.
        tell: of what takes long.
    """

    model: EngineFile
    objective: Objective[Quantity]
    wanted: int
    even_firing: bool
    locked: tuple[tuple[float, float], ...]
    tell: Tell

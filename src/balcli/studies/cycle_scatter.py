"""How torque over the cycle, uneven speed and guide-force moments spread when masses, rod lengths
and throw angles vary within tolerances.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ..core.phasors import Array
from ..engine.build import Engine, build
from ..enginefile.model import EngineFile
from ..errors import BalcliError
from ..forces import guide_quantity
from ..limits import MOST_CYCLE_SAMPLES
from ..torque import quantity as cycle_quantity
from ..torque.course import find_constant_inertia
from ..torque.quantity import NO_INERTIA
from .deviations import DeviatingEngine, Tolerances
from .quantities import ChapterQuantity, group_by_chapter, refuse_unknown_of_chapters
from .quantity_names import CYCLE, GUIDE, Chapter
from .spread_one_by_one import spread_one_by_one
from .tolerances import Drawing, Scatter

_EVALUATE: dict[Chapter, Callable[[Engine, Sequence[Any]], list[float]]] = {
    CYCLE: cycle_quantity.evaluate_engine,
    GUIDE: guide_quantity.evaluate_engine,
}


def scatter_cycles(
    model: EngineFile,
    tolerances: Tolerances,
    quantities: Sequence[ChapterQuantity],
    drawing: Drawing,
) -> Scatter:
    """Spread of quantities over random engines, each computed by itself.

    Args:
        quantities: of the cycle (`torque.max`), or of guide-force moments (`guide.6.H`).

    Raises:
        BalcliError: quantities of what the file does not have; too many samples, no tolerance.
    """
    why = f"of {quantities[0].name}, where each engine is computed by itself, "
    drawing.refuse_beyond(MOST_CYCLE_SAMPLES, why)
    engines = DeviatingEngine(model, tolerances)
    refuse_unknown_of_chapters(model, quantities)
    of_speed = any(q.name == "fluctuation" for q in quantities)
    if of_speed and find_constant_inertia(build(model)) is None:
        raise BalcliError(NO_INERTIA)
    groups = group_by_chapter(quantities)

    def evaluate(deviations: Array) -> Array:
        engine = engines.deviate_one(deviations)
        found: dict[ChapterQuantity, float] = {}
        for chapter, members in groups.items():
            found |= dict(zip(members, _EVALUATE[chapter](engine, members), strict=True))
        return np.array([found[q] for q in quantities])

    count, spreads = spread_one_by_one(engines.sources, quantities, evaluate, drawing)
    return Scatter(model, count, drawing.shape, spreads, "engines, one by one")

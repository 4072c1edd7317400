"""How figures spread over random variants that are computed one by one."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..core.phasors import Array
from .quantities import ChapterQuantity
from .tolerances import PERCENTILES, Drawing, Spread, rank_shares

if TYPE_CHECKING:
    from .deviations import Source
    from .part_scatter import PartSource

RANDOM_SINGLES = 500  # samples, unless their number is given: each takes milliseconds
_ROUNDING = 1e-12  # of a figure: a smaller change of it is none
_LEAST = -0.99  # relative deviation: a normal one makes no mass and no spring negative


def spread_one_by_one(
    sources: Sequence[Source | PartSource],
    quantities: Sequence[ChapterQuantity],
    evaluate: Callable[[Array], Array],
    drawing: Drawing,
) -> tuple[int, tuple[Spread, ...]]:
    """How many samples were computed, and the spread of each quantity.

    Args:
        sources: what deviates, each by its own.
        evaluate: the quantities (quantities,) with these deviations (sources,).
    """
    tolerances = np.array([source.tolerance for source in sources])
    least = np.array([_LEAST if source.relative else -np.inf for source in sources])
    nominal = evaluate(np.zeros(len(sources)))
    changes = np.array(
        [_find_change(nominal, evaluate(row), evaluate(-row)) for row in np.diag(tolerances)]
    )
    rows = []
    for row in _draw(tolerances, least, drawing):
        rows.append(evaluate(row))
        if drawing.tell(len(rows)):
            break
    values = np.array(rows)
    spreads = tuple(
        _spread(q, float(nominal[k]), values[:, k], sources, changes[:, k])
        for k, q in enumerate(quantities)
    )
    return len(rows), spreads


def _find_change(nominal: Array, above: Array, below: Array) -> Array:
    """What a tolerance makes of each figure: half the way from one end of it to the other; the
    longer way where both lead to the same side, as where an amplitude was 0.
    """
    up, down = above - nominal, below - nominal
    longer = np.where(np.abs(up) >= np.abs(down), up, down)
    change = np.where(up * down > 0, longer, (up - down) / 2)
    return np.where(np.abs(change) <= _ROUNDING * np.abs(nominal), 0.0, change)


def _draw(tolerances: Array, least: Array, drawing: Drawing) -> Array:
    """(samples, sources) deviations."""
    random = np.random.default_rng(drawing.seed)
    size = drawing.samples, len(tolerances)
    if drawing.shape == "uniform":
        return tolerances * (2 * random.random(size) - 1)
    return np.maximum(tolerances / 3 * random.standard_normal(size), least)


def _spread(
    quantity: ChapterQuantity,
    nominal: float,
    values: Array,
    sources: Sequence[Source | PartSource],
    changes: Array,
) -> Spread:
    percentiles = np.percentile(values, list(PERCENTILES.values())).tolist()
    return Spread(
        quantity,
        nominal,
        mean=float(values.mean()),
        percentiles=dict(zip(PERCENTILES, percentiles, strict=True)),
        largest=float(values.max()),
        bound=nominal + float(np.abs(changes).sum()),
        shares=rank_shares(sources, changes),
    )

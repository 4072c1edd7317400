"""Engine -> Balance: what a scheme fits, and the analyses without and with it."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..engine.build import Engine
from ..sizing.sizing import Practical, Remedy, Tools, Wish, fitted, practical, remedy_for
from .analysis import QUANTITIES, Analysis, analyze

_UNEVEN = "sized for steady mean speed; before and after are those of the uneven one"


class PermittedUnbalance(NamedTuple):
    """By ISO 21940-11, SI.

    Attributes:
        grade: permitted speed of the centre of mass, mm/s. mass: of the crankshaft, kg.
        each: permitted unbalance at each counterweight, kg m; all share alike.
    """

    grade: float
    mass: float
    each: float


@dataclass(frozen=True)
class Balance:
    """A remedy, what the engine does without and with it (same orders), and the workshop's figures
    of its devices; what a grade permits, if one was asked for.
    """

    remedy: Remedy
    before: Analysis
    after: Analysis
    practical: tuple[Practical, ...]
    permitted: PermittedUnbalance | None = None


def balance(
    engine: Engine,
    scheme: str = "auto",
    wish: Wish | None = None,
    orders: Iterable[float] | None = None,
    tools: Tools | None = None,
) -> Balance:
    """What a scheme fits and what it leaves.

    Devices are sized for a steady speed; under uneven speed both analyses include it.

    Args:
        engine: without trailing axes.
        scheme: one of `sizing.SCHEMES`.
        wish: options of the scheme.
        orders: which to show; default: 1 and 2 and all that are not negligible before or after.
        tools: for the workshop's figures.

    Raises:
        BalcliError: an unknown scheme, or a wish that cannot be met, with the reason.
    """
    remedy = remedy_for(engine, scheme, wish)
    if engine.ripple:
        remedy = remedy._replace(details={**remedy.details, "speed": _UNEVEN})
    figures = practical(engine, remedy, tools or Tools())
    new = fitted(engine, remedy)
    shown = set(QUANTITIES) - {"sizing"}
    before, after = (analyze(e, orders, shown) for e in (engine, new))
    if orders is None and not np.array_equal(before.orders, after.orders):
        both = np.union1d(before.orders, after.orders)
        before, after = (analyze(e, both, shown) for e in (engine, new))
    return Balance(remedy, before, after, figures)

"""Evaluate guide-force moments for `sweep`, `search` and `scatter`: `guide.6.H`, `guide.4.5.X`."""

from collections.abc import Iterator, Sequence
from functools import partial

import numpy as np

from ..engine.build import build
from ..engine.engine import Engine
from ..engine.load import FiguresOfVariants
from ..errors import MOMENTS_UNKNOWN, BalcliError
from ..file.model import EngineFile
from ..limits import HIGHEST_ORDER
from .guide import GuideMoments, compute_guide_moments
from .quantity import TargetQuantity
from .spectrum import parse_order


def list_names(model: EngineFile) -> Iterator[str]:
    """Yield the names of an engine's guide-force quantities, with the letter N for the order."""
    if model.engine:
        return
    yield "guide.N.H"
    if _find(model).x is not None:
        yield "guide.N.X"


def refuse_unknown(model: EngineFile, quantities: Sequence[TargetQuantity]) -> None:
    """Raise an error for an impossible order, or for an X-type quantity if the engine has no X-type
    moment.

    Args:
        model: Engine file.
        quantities: Wanted quantities.

    Raises:
        BalcliError: A quantity is not known; the error names the first and the reason.
    """
    for q in quantities:
        if parse_order(q.target) is None:
            raise BalcliError(
                f"{q.name} is not a quantity: after guide comes an order up to {HIGHEST_ORDER}, as "
                "in guide.6.H"
            )
    of_x = [q for q in quantities if q.part == "X"]
    if of_x and _find(model).x is None:
        known = len(build(model).throws_m) < 2 or build(model).places_known
        why = "all cylinders have the same position" if known else MOMENTS_UNKNOWN
        if build(model).cylinders.harmonic:
            why = "rods in harmonic motion have no length, which the moment needs"
        raise BalcliError(f"{of_x[0].name}: {why}")


def _find(model: EngineFile) -> GuideMoments:
    return compute_guide_moments(build(model), np.array([1.0]))


def evaluate_engine(engine: Engine, quantities: Sequence[TargetQuantity]) -> list[float]:
    """Return the amplitude of each quantity of one engine, N m.

    Args:
        engine: One engine, not an array of variants.
        quantities: Wanted quantities, all of them known.
    """
    orders = np.array(sorted({float(q.target) for q in quantities}))
    guide = compute_guide_moments(engine, orders)
    moments = {"H": guide.h, "X": guide.x or guide.h}
    rows = [int(np.searchsorted(orders, float(q.target))) for q in quantities]
    return [float(moments[q.part].major[row]) for q, row in zip(quantities, rows, strict=True)]


Variants = partial(FiguresOfVariants, evaluate_engine)

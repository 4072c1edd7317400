"""Guide-force moments as single figures, for variants: `guide.6.H`, `guide.4.5.X`."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial

import numpy as np

from ..engine.build import Engine, build
from ..engine.positions import MOMENTS_UNKNOWN
from ..engine.variants import FiguresOfVariants
from ..enginefile.model import EngineFile
from ..errors import BalcliError
from ..limits import HIGHEST_ORDER
from .guide_moments import GuideMoments, compute_guide_moments
from .orders import parse_order
from .target_quantity import Subject, TargetQuantity, parse_target_quantity

_SUBJECTS = {"guide": Subject("6", {"H": "N·m", "X": "N·m"})}


def parse_quantity(text: str) -> TargetQuantity:
    """`guide.6.H` and its like.

    Raises:
        BalcliError: anything else, with what there is.
    """
    found = parse_target_quantity(text, _SUBJECTS)
    if parse_order(found.target) is None:
        raise BalcliError(
            f"{text} is no quantity: after guide comes an order up to {HIGHEST_ORDER}, as in "
            "guide.6.H"
        )
    return found


def list_names(model: EngineFile) -> Iterator[str]:
    """Those that an engine has, with N for the order."""
    yield "guide.N.H"
    if _find(model).x is not None:
        yield "guide.N.X"


def refuse_unknown(model: EngineFile, quantities: Sequence[TargetQuantity]) -> None:
    """Nothing, unless one is of the X-type, of an engine that has none.

    Raises:
        BalcliError: the quantity, and why.
    """
    of_x = [q for q in quantities if q.part == "X"]
    if of_x and _find(model).x is None:
        known = len(build(model).throws_m) < 2 or build(model).places_known
        why = "all cylinders stand at one place" if known else MOMENTS_UNKNOWN
        raise BalcliError(f"{of_x[0].name}: {why}")


def _find(model: EngineFile) -> GuideMoments:
    return compute_guide_moments(build(model), np.array([1.0]))


def evaluate_engine(engine: Engine, quantities: Sequence[TargetQuantity]) -> list[float]:
    """The amplitude of each quantity of one engine, which has what they are of."""
    orders = np.array(sorted({float(q.target) for q in quantities}))
    guide = compute_guide_moments(engine, orders)
    found = {"H": guide.h, "X": guide.x or guide.h}
    rows = [int(np.searchsorted(orders, float(q.target))) for q in quantities]
    return [float(found[q.part].major[row]) for q, row in zip(quantities, rows, strict=True)]


Variants = partial(FiguresOfVariants, evaluate_engine)

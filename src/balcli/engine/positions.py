"""Whether an engine file says where its throws stand along the crank."""

from __future__ import annotations

from collections.abc import Collection

from ..enginefile.model import EngineFile
from .layout import Plan

MOMENTS_UNKNOWN = (
    "moments are not known, because crank.spacing is missing: give it (or crank.positions); 0 says "
    "that all throws stand in one plane"
)


def are_places_known(model: EngineFile, plan: Plan, varied: Collection[str] = ()) -> bool:
    """Whether the file says where the throws stand along the crank (of one throw it need not).

    Args:
        varied: names of figures that vary, and so are said, too.
    """
    crank = model.crank
    said = crank.spacing is not None or crank.positions is not None or "crank.spacing" in varied
    own = any(cylinder.position is not None for cylinder in model.cylinder.values())
    return plan.throws == 1 or said or own

"""Evaluate quantities of an engine's cycle for `sweep`, `search` and `scatter`: `torque.mean`,
`torque.max`, `torque.min`, `fluctuation`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial

from ..engine.build import build
from ..engine.engine import Engine
from ..engine.load import FiguresOfVariants
from ..errors import BalcliError
from ..file.model import EngineFile
from ..forces.curves import find_constant_inertia, find_torque_curves
from ..forces.quantity import TargetQuantity
from .answer import torque

_NAMES = ("torque.mean", "torque.max", "torque.min", "fluctuation")
NO_INERTIA = "fluctuation: the file gives no inertia; give inertia in [crank] or [flywheel]"


def list_names(model: EngineFile) -> Iterator[str]:
    """Yield the names of the quantities of an engine with gas; `fluctuation` needs an inertia."""
    known = find_constant_inertia(build(model)) is not None
    yield from (name for name in _NAMES if known or name != "fluctuation")


def refuse_unknown(model: EngineFile, quantities: Sequence[TargetQuantity]) -> None:
    """Check that the engine has gas, which all these quantities need.

    Raises:
        BalcliError: The engine has no gas.
    """
    if not model.has_gas:
        raise BalcliError(f"{quantities[0].name}: the engine file has no [gas]")


def evaluate_engine(engine: Engine, quantities: Sequence[TargetQuantity]) -> list[float]:
    """Return the value of each quantity of one engine with gas.

    Raises:
        BalcliError: The fluctuation needs an inertia that the file does not give, or the crank
            stalls.
    """
    values = dict[str, float]()
    if any(q.name != "fluctuation" for q in quantities):
        curves = find_torque_curves(engine)
        lowest, highest = curves.total.extremes()
        values |= {"torque.mean": curves.gas.mean, "torque.max": highest.value}
        values["torque.min"] = lowest.value
    if any(q.name == "fluctuation" for q in quantities):
        computed = torque(engine, [1])
        if not hasattr(computed, "flywheel"):
            raise BalcliError(NO_INERTIA)
        if not hasattr(computed.flywheel, "fluctuation"):
            raise BalcliError(computed.flywheel.stall or NO_INERTIA)
        values["fluctuation"] = computed.flywheel.fluctuation
    return [values[q.name] for q in quantities]


Variants = partial(FiguresOfVariants, evaluate_engine)

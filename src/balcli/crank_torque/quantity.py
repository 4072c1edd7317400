"""Evaluate quantities of an engine's cycle for `sweep`, `search` and `scatter`: `torque.mean`,
`torque.max`, `torque.min`, `fluctuation`.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

import numpy as np

from ..core.phasors import Array
from ..engine.build import build
from ..engine.engine import Engine
from ..engine.load import FiguresOfVariants, build_jointly, find_joint_figures
from ..errors import BalcliError
from ..file.model import EngineFile
from ..forces.curves import find_constant_inertia, find_torque_curves
from ..forces.quantity import TargetQuantity
from .answer import torque

FLUCTUATION = "fluctuation"
_NAMES = ("torque.mean", "torque.max", "torque.min", FLUCTUATION)
NO_INERTIA = "fluctuation: the file gives no inertia; give inertia in [crank] or [flywheel]"


def list_names(model: EngineFile) -> Iterator[str]:
    """Yield the names of the quantities of an engine with gas; `fluctuation` needs an inertia."""
    known = find_constant_inertia(build(model)) is not None
    yield from (name for name in _NAMES if known or name != FLUCTUATION)


def refuse_unknown(model: EngineFile, quantities: Sequence[TargetQuantity]) -> None:
    """Check that the engine has gas, which all these quantities need.

    Raises:
        BalcliError: The engine has no gas.
    """
    if not model.has_gas:
        raise BalcliError(f"{quantities[0].name}: the engine file has no [gas]")


def _measure_torque(engine: Engine) -> dict[str, Array]:
    """Return the means and extremes of the torque by name. If variants differ in them, they have
    the trailing axis of the engine or of its gas.
    """
    curves = find_torque_curves(engine)
    lowest, highest = curves.total.find_range()
    return {"torque.mean": curves.gas.means, "torque.max": highest, "torque.min": lowest}


def evaluate_engine(engine: Engine, quantities: Sequence[TargetQuantity]) -> list[float]:
    """Return the value of each quantity of one engine with gas.

    Raises:
        BalcliError: The fluctuation needs an inertia that the file does not give, or the crank
            stalls.
    """
    values = dict[str, float]()
    if any(q.name != FLUCTUATION for q in quantities):
        values |= {name: float(value) for name, value in _measure_torque(engine).items()}
    if any(q.name == FLUCTUATION for q in quantities):
        computed = torque(engine, [1])
        if not hasattr(computed, "flywheel"):
            raise BalcliError(NO_INERTIA)
        if not hasattr(computed.flywheel, "fluctuation"):
            raise BalcliError(computed.flywheel.stall or NO_INERTIA)
        values[FLUCTUATION] = computed.flywheel.fluctuation
    return [values[q.name] for q in quantities]


class TorqueOfVariants(FiguresOfVariants[TargetQuantity]):
    """Evaluator of means and extremes of the torque for the variants of an engine with gas.

    Args:
        model: Engine file.
        quantities: Quantities to evaluate.
    """

    def __init__(self, model: EngineFile, quantities: Sequence[TargetQuantity]) -> None:
        super().__init__(evaluate_engine, model, quantities)

    def joins(self, path: str, others: Iterable[str]) -> bool:
        """Return whether variants that differ only in one figure are computed together; see
        `studies.quantities.JointVariants`.
        """
        return path in find_joint_figures(self._model, (path, *others)).all

    def evaluate_jointly(self, variants: Sequence[Mapping[str, float]]) -> dict[int, list[float]]:
        """Return the value of each quantity for the variants that can be computed together, by
        their places among all variants.

        Args:
            variants: Varied figures of each variant, by dotted name.
        """
        names = [q.name for q in self._quantities]
        rows = dict[int, list[float]]()
        for places, engine in build_jointly(self._model, variants):
            torques = _measure_torque(engine)
            shape = (len(places),)
            columns = np.stack([np.broadcast_to(torques[name], shape) for name in names])
            rows |= dict(zip(places, columns.T.tolist(), strict=True))
        return rows


def Variants(
    model: EngineFile, quantities: Sequence[TargetQuantity]
) -> FiguresOfVariants[TargetQuantity]:
    """Return an evaluator of quantities for the variants of an engine with gas.

    Args:
        model: Engine file.
        quantities: Quantities to evaluate.
    """
    if any(q.name == FLUCTUATION for q in quantities):
        return FiguresOfVariants(evaluate_engine, model, quantities)
    return TorqueOfVariants(model, quantities)

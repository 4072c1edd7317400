"""Evaluate quantities of an engine's cycle for `sweep`, `search` and `scatter`: `torque.mean`,
`torque.max`, `torque.min`, `fluctuation`.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import suppress

import numpy as np

from ..core.phasors import Array
from ..core.piecewise import resolved
from ..core.shaft_speed import StallError, speed_variation
from ..engine.build import build
from ..engine.engine import Engine
from ..engine.load import FiguresOfVariants, build_jointly, find_joint_figures
from ..errors import BalcliError
from ..file.model import EngineFile
from ..forces.curves import (
    find_gas_once,
    find_moving_inertia,
    find_torque_curves,
)
from ..forces.quantity import TargetQuantity

FLUCTUATION = "fluctuation"
_NAMES = ("torque.mean", "torque.max", "torque.min", FLUCTUATION)
NO_INERTIA = "fluctuation: the file gives no inertia; give inertia in [crank] or [flywheel]"


def list_names(model: EngineFile) -> Iterator[str]:
    """Yield the names of the quantities of an engine with gas; `fluctuation` needs an inertia."""
    known = build(model).find_constant_inertia() is not None
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
    lowest, highest = curves.total_once.find_range()
    return {"torque.mean": curves.gas_once.means, "torque.max": highest, "torque.min": lowest}


def _find_fluctuations(engine: Engine) -> Array:
    """Return the fluctuation of the speed, with the trailing axis of the gas.

    Raises:
        BalcliError: The file gives no inertia, or the crank stalls.
    """
    constant = engine.find_constant_inertia()
    if constant is None:
        raise BalcliError(NO_INERTIA)
    torque = find_gas_once(engine)
    course = resolved(find_moving_inertia(engine), torque.breaks)  # faster to evaluate

    def find_inertia(angle: Array) -> Array:
        return constant + course.at(angle)

    omega = float(engine.omega)
    try:
        each = [speed_variation(own, find_inertia, omega).fluctuation for own in torque.split()]
    except StallError as error:
        raise BalcliError(str(error)) from None
    return np.reshape(each, torque.figure)


def _measure(engine: Engine, names: Collection[str]) -> dict[str, Array]:
    """Return quantities by name; they have a trailing axis if variants differ in them.

    Raises:
        BalcliError: The fluctuation needs an inertia that the file does not give, or the crank
            stalls.
    """
    values = dict[str, Array]()
    if any(name != FLUCTUATION for name in names):
        values |= _measure_torque(engine)
    if FLUCTUATION in names:
        values[FLUCTUATION] = _find_fluctuations(engine)
    return values


def evaluate_engine(engine: Engine, quantities: Sequence[TargetQuantity]) -> list[float]:
    """Return the value of each quantity of one engine with gas.

    Raises:
        BalcliError: The fluctuation needs an inertia that the file does not give, or the crank
            stalls.
    """
    values = _measure(engine, [q.name for q in quantities])
    return [float(values[q.name]) for q in quantities]


class Variants(FiguresOfVariants[TargetQuantity]):
    """Evaluator of quantities for the variants of an engine with gas.

    Args:
        model: Engine file.
        quantities: Quantities to evaluate.
    """

    def __init__(self, model: EngineFile, quantities: Sequence[TargetQuantity]) -> None:
        super().__init__(evaluate_engine, model, quantities)
        self._names = [q.name for q in quantities]
        self._only_gas = FLUCTUATION in self._names

    def joins(self, different: Collection[str], varied: Collection[str]) -> bool:
        """Return whether variants that differ only in some figures are computed together; see
        `studies.quantities.JointVariants`.
        """
        figures = find_joint_figures(self._model, varied, only_gas=self._only_gas)
        return figures.all.issuperset(different)

    def evaluate_jointly(self, variants: Sequence[Mapping[str, float]]) -> dict[int, list[float]]:
        """Return the value of each quantity for the variants that can be computed together, by
        their places among all variants. A group of variants in which the crank of one stalls is
        left out.

        Args:
            variants: Varied figures of each variant, by dotted name.
        """
        rows = dict[int, list[float]]()
        for places, engine in build_jointly(self._model, variants, only_gas=self._only_gas):
            with suppress(BalcliError):
                values = _measure(engine, self._names)
                shape = (len(places),)
                columns = [np.broadcast_to(values[name], shape) for name in self._names]
                rows |= dict(zip(places, np.transpose(columns).tolist(), strict=True))
        return rows

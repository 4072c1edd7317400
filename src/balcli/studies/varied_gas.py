"""Torque of the gas of variants of an engine: computed when it is asked for, once for all variants
whose cylinders are alike.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np

from ..core.phasors import Array, Phasors
from ..engine.build import Engine, build
from ..engine.gas_figures import concerns_gas
from ..enginefile.model import EngineFile
from ..errors import InputError
from ..forces.gas import compute_gas_torque
from .parameters import tell_variant


def attach_gas_torque(engine: Engine, model: EngineFile, figures: Mapping[str, Array]) -> Engine:
    """Variants of an engine as of `build`, with the torque of their gas where the file has some.

    Args:
        figures: what varies, as `build` had it.
    """
    if model.gas is None:
        return engine
    rank = engine.cylinders.pin_deg.ndim - 1
    return replace(engine, gas_of_variants=_VariedGas(model, figures, rank))


class _VariedGas:
    """Torque of the gas by order, shape (orders, *trailing): of length 1 along axes on which no gas
    depends.
    """

    def __init__(self, model: EngineFile, figures: Mapping[str, Array], rank: int) -> None:
        self._model, self._engines = model, list[Engine]()
        self._figures = {path: value for path, value in figures.items() if concerns_gas(path)}
        self._shape = np.broadcast_shapes((1,) * rank, *map(np.shape, self._figures.values()))

    def __call__(self, orders: Array) -> Phasors:
        """Raises InputError: a cycle that cannot be, with its figures."""
        self._engines = self._engines or list(self._build())
        found = [compute_gas_torque(engine, orders) for engine in self._engines]
        shape = (len(orders), *self._shape)
        return Phasors(
            orders,
            np.stack([one.vectors for one in found], axis=2).reshape(2, *shape),
            np.stack([one.noise for one in found], axis=1).reshape(shape),
        )

    def _build(self) -> Iterator[Engine]:
        columns = [np.broadcast_to(each, self._shape).ravel() for each in self._figures.values()]
        for row in range(int(np.prod(self._shape))):
            own = {
                path: float(column[row])
                for path, column in zip(self._figures, columns, strict=True)
            }
            try:
                yield build(self._model, own)
            except InputError as error:
                raise InputError(error.problems, tell_variant(own)) from None

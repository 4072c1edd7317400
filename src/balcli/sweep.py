"""Grids of variants of an engine: numbers of the file over ranges, evaluated as arrays, in boxes of bounded size.

Every parameter has a trailing axis of its own, so that what does not depend on it is not computed again: on a grid of bank
angles and rod ratios, phases are computed once for each angle, coefficients once for each ratio, and only their products
for each variant. Rows run with the last parameter fastest.
"""
from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .engine import Engine, build
from .model import EngineFile
from .parameters import Parameter, varied
from .quantity import Quantity, evaluate

Array = NDArray[np.float64]
Box = tuple[slice, ...]
CHUNK = 16_384                  # variants at a time: their arrays stay in the processor's cache


@dataclass(frozen=True)
class Sweep:
    """What to compute: a file, the parameters that vary, and the quantities asked for."""

    file: EngineFile
    parameters: tuple[Parameter, ...]
    quantities: tuple[Quantity, ...]

    @property
    def columns(self) -> list[str]:
        return [*(p.path for p in self.parameters), *(q.name for q in self.quantities)]

    @property
    def shape(self) -> tuple[int, ...]:
        return tuple(map(len, self.parameters))

    @property
    def variants(self) -> int:
        return math.prod(self.shape)

    def engine(self, box: Box) -> Engine:
        """All variants in a box of the grid, as one engine with an axis for each parameter.

        Raises:
            InputError: one of them cannot be.
        """
        rank = len(self.parameters)
        axes = {p.path: p.values[cut].reshape(-1, *(1,) * (rank - 1 - k))
                for k, (p, cut) in enumerate(zip(self.parameters, box, strict=True))}
        arrays = {path: values.reshape((1,) * (rank - values.ndim) + values.shape) for path, values in axes.items()}
        return build(varied(self.file, arrays), rank)


def check(sweep: Sweep) -> None:
    """Whether all variants can be, seen at the corners of the grid: what can lock a mechanism grows towards one of them.

    Raises:
        InputError: one of them cannot be.
    """
    corners = tuple(Parameter(p.path, np.array([p.values.min(), p.values.max()])) for p in sweep.parameters)
    Sweep(sweep.file, corners, ()).engine((slice(None),) * len(corners))


def values(sweep: Sweep, box: Box) -> list[Array]:
    """Each quantity for all variants of a box, shape (variants in it,)."""
    shape = tuple(len(range(*cut.indices(n))) for cut, n in zip(box, sweep.shape, strict=True))
    return [np.broadcast_to(found, shape).ravel() for found in evaluate(sweep.engine(box), sweep.quantities)]


def boxes(shape: tuple[int, ...], most: int = CHUNK) -> Iterator[Box]:
    """The grid in boxes of at most `most` variants, in the order of rows: the last axes whole, one cut, the first one by one."""
    axis = len(shape) - 1
    while axis > 0 and math.prod(shape[axis:]) <= most:
        axis -= 1
    step = max(most // math.prod(shape[axis + 1:]), 1)
    for fixed in np.ndindex(shape[:axis]):
        for start in range(0, shape[axis], step):
            yield (*(slice(k, k + 1) for k in fixed), slice(start, min(start + step, shape[axis])),
                   *(slice(0, n) for n in shape[axis + 1:]))

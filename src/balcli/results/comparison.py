"""Engines side by side."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass
from math import nan

import numpy as np

from ..engine.build import Engine
from ..errors import BalcliError
from ..forces.kinds import Kind
from .analysis import QUANTITIES, Analysis, analyze


@dataclass(frozen=True)
class Line:
    """One figure of every engine: an amplitude (N, N m) by kind and order, or a peak (order
    None).
    """

    kind: Kind
    order: int | None
    values: tuple[float, ...]

    @property
    def ratios(self) -> tuple[float, ...]:
        """To the first engine's; nan where that has none."""
        first = self.values[0]
        return tuple(value / first if first else nan for value in self.values)


@dataclass(frozen=True)
class Comparison:
    """Names of engines, and one line a figure."""

    names: tuple[str, ...]
    lines: tuple[Line, ...]


def compare(
    engines: Sequence[Engine],
    names: Sequence[str],
    orders: Iterable[float] | None = None,
    only: Collection[str] | None = None,
) -> Comparison:
    """The free forces and moments of several engines: the largest of each order, and peaks.

    Args:
        orders: default: all that `analyze` shows for one of them.
        only: as in `analyze`; sizing is never computed.

    Raises:
        BalcliError: fewer than two engines.
    """
    if len(engines) < 2:
        raise BalcliError("there is one engine; name at least two to compare")
    wanted = set(only or QUANTITIES) - {"sizing"}
    shown = [analyze(engine, orders, wanted) for engine in engines]
    every = np.unique(np.concatenate([a.orders for a in shown]))
    same = shown if orders is not None else [analyze(engine, every, wanted) for engine in engines]
    return Comparison(tuple(names), (*_orders(same, every), *_peaks(same)))


def _orders(found: Sequence[Analysis], orders: np.ndarray) -> Iterable[Line]:
    for kind, _ in found[0].spectra.items():
        sizes = np.stack([a.spectra[kind.name].major for a in found], axis=1)
        for order, row in zip(orders, sizes, strict=True):
            if order <= 2 or row.any():
                yield Line(kind, int(order), tuple(row.tolist()))


def _peaks(found: Sequence[Analysis]) -> Iterable[Line]:
    for same in zip(*(a.peaks for a in found), strict=True):
        yield Line(same[0][0], None, tuple(peak.value for _, peak in same))

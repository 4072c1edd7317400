"""Engines side by side."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass
from math import nan

from ..core.phasors import Array
from ..engine.build import Engine
from ..errors import BalcliError
from ..forces.kinds import MOMENT, Kind
from ..forces.orders import merge_orders
from ..forces.spectrum import Spectra
from .analysis import QUANTITIES, Analysis, analyze


@dataclass(frozen=True)
class Line:
    """One figure of every engine, SI: the amplitude of an order, or the peak of the whole curve.

    Attributes:
        kind: of force or moment.
        order: None for the peak.
        values: one an engine; nan for moments that are not known.
    """

    kind: Kind
    order: float | None
    values: tuple[float, ...]

    @property
    def ratios(self) -> tuple[float, ...]:
        """To the first engine's value; nan where that is 0."""
        first = self.values[0]
        return tuple(value / first if first else nan for value in self.values)


@dataclass(frozen=True)
class Comparison:
    """Names of engines, and one line a figure."""

    names: tuple[str, ...]
    lines: tuple[Line, ...]


def compare_engines(
    engines: Sequence[Engine],
    names: Sequence[str],
    orders: Iterable[float] | None = None,
    only: Collection[str] | None = None,
) -> Comparison:
    """The free forces and moments of several engines: the largest of each order, and peaks.

    Args:
        engines: without trailing axes, at least two.
        names: what to call them.
        orders: default: all that `analyze` shows for one of them.
        only: as in `analyze`; sizing is never computed.

    Raises:
        BalcliError: fewer than two engines.
    """
    if len(engines) < 2:
        raise BalcliError("there is one engine; name at least two to compare")
    wanted = set(only or QUANTITIES) - {"sizing"}
    analyses = [analyze(engine, orders, wanted) for engine in engines]
    every = merge_orders(*(one.orders for one in analyses))
    if orders is None:
        analyses = [analyze(engine, every, wanted) for engine in engines]
    return Comparison(tuple(names), (*_compare_orders(analyses, every), *_compare_peaks(analyses)))


def _compare_orders(analyses: Sequence[Analysis], orders: Array) -> Iterator[Line]:
    for kind, _ in analyses[0].spectra.items():
        sizes = [_known(one)[kind.name].major for one in analyses]
        for order, *values in zip(orders, *sizes, strict=True):
            if order <= 2 or any(values):
                yield Line(kind, float(order), tuple(map(float, values)))


def _compare_peaks(analyses: Sequence[Analysis]) -> Iterator[Line]:
    for same in zip(*(one.peaks for one in analyses), strict=True):
        kind, _ = same[0]
        known = [one.moments_known or kind is not MOMENT for one in analyses]
        peaks = (peak.value for _, peak in same)
        yield Line(kind, None, tuple(v if k else nan for v, k in zip(peaks, known, strict=True)))


def _known(one: Analysis) -> Spectra:
    return one.spectra if one.moments_known else one.spectra.without_moment()

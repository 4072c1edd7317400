"""Engines side by side."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from math import nan
from typing import TYPE_CHECKING

from ..core.peaks import Peak
from ..core.phasors import Array
from ..engine.build import Engine
from ..errors import BalcliError
from ..forces.kinds import GAS, MOMENT, VECTORS, Kind
from ..forces.orders import merge_orders
from ..result import Result
from .analysis import QUANTITIES, Analysis, analyze

if TYPE_CHECKING:
    from ..forces.crankshaft import AlongCrank
    from ..forces.guide_moments import GuideMoments

SHEAR = Kind("shear", "shear force in the crankshaft", "Q", "shear_N", True, "force")
BENDING = Kind("bending", "bending moment in the crankshaft", "M_b", "bending_Nm", True, "moment")
BEARING = Kind("bearing", "load of a main bearing", "R", "bearing_N", True, "force")
WITH_GAS = (  # in the order of `in_bearings.LoadsWithGas`
    Kind("shaft_shear", "shear of the shaft with gas", "Q", "shaft_shear_N", True, "force"),
    Kind("shaft_bending", "bending of the shaft with gas", "M", "shaft_bending_Nm", True, "moment"),
    Kind("main", "load of a main bearing with gas", "R", "main_N", True, "force"),
    Kind("block_shear", "shear of the block with gas", "Q", "block_shear_N", True, "force"),
    Kind("block_bending", "bending of the block with gas", "M", "block_bending_Nm", True, "moment"),
)
GUIDE_H = Kind("guide_h", "H-type guide moment", "M_H", "guide_h_Nm", False, "moment")
GUIDE_X = Kind("guide_x", "X-type guide moment", "M_X", "guide_x_Nm", False, "moment")
LEFT = {
    kind: kind._replace(
        name=f"{kind.name} with devices",
        label=f"{kind.label} with the devices of auto",
        key=f"with_devices_{kind.key}",
    )
    for kind in VECTORS
}


@dataclass(frozen=True)
class Line:
    """One figure of every engine, SI: the amplitude of an order, or the peak of the whole curve.

    Attributes:
        kind: of force or moment.
        order: None for the peak.
        values: one an engine; nan for moments that are not known.
        single: what one cylinder of each engine makes, beside which a value may be negligible;
            empty or 0 where there is no such measure.
    """

    kind: Kind
    order: float | None
    values: tuple[float, ...]
    single: tuple[float, ...] = ()

    @property
    def ratios(self) -> tuple[float, ...]:
        """To the first engine's value; nan where that is 0."""
        first = self.values[0]
        return tuple(value / first if first else nan for value in self.values)


@dataclass(frozen=True, repr=False)
class Comparison(Result):
    """Engines side by side.

    Attributes:
        names: of the engines.
        engines: each at the speed at which it is compared.
        lines: one a figure.
        whole: whether people are shown orders that are negligible, too.
    """

    names: tuple[str, ...]
    engines: tuple[Engine, ...]
    lines: tuple[Line, ...]
    whole: bool = False

    @property
    def summary(self) -> str:
        """Which engines."""
        return f"of {', '.join(self.names)}"


def compare_engines(
    engines: Sequence[Engine],
    names: Sequence[str],
    orders: Iterable[float] | None = None,
    only: Collection[str] | None = None,
    whole: bool = False,
) -> Comparison:
    """The free forces and moments of several engines: the largest of each order, and peaks.

    Args:
        engines: without trailing axes, at least two.
        names: what to call them.
        orders: default: all that `analyze` shows for one of them.
        only: as in `analyze`; of sizing, the peaks that are left with the devices; default: all
            but sizing, inner and guide, and gas where all engines have some.
        whole: whether people are shown orders that are negligible, too; they are if orders are
            given.

    Raises:
        BalcliError: fewer than two engines.
    """
    if len(engines) < 2:
        raise BalcliError("compare needs at least two engine files")
    wanted = set(QUANTITIES) - {"sizing"} if only is None else set(only)
    if only is None and all(engine.gas is not None for engine in engines):
        wanted.add(GAS.name)
    analyses = analyze_alike(engines, orders, partial(analyze, only=wanted, beside=engines))
    lines = list_lines(analyses, every_order=orders is not None)
    return Comparison(tuple(names), tuple(engines), lines, whole or orders is not None)


def analyze_alike(
    engines: Iterable[Engine],
    orders: Iterable[float] | None,
    analyze_one: Callable[[Engine, Iterable[float] | None], Analysis],
) -> tuple[Analysis, ...]:
    """Analyses of several engines, or of one at several speeds, all by the same orders: those asked
    for, or each that one of them shows unasked.
    """
    analyses = tuple(analyze_one(engine, orders) for engine in engines)
    if orders is not None:
        return analyses
    every = merge_orders(*(orders for one in analyses for orders in _list_orders(one)))
    return tuple(analyze_one(one.engine, every) for one in analyses)


def list_lines(analyses: Sequence[Analysis], *, every_order: bool = False) -> tuple[Line, ...]:
    """Every figure of analyses by the same orders side by side.

    Args:
        every_order: also orders above 2 of which all of them are free.
    """
    return (
        *_compare_orders(analyses, every_order),
        *_compare_peaks(analyses),
        *_compare_inner(analyses),
        *_compare_guide(analyses),
        *_compare_sizing(analyses),
    )


def _list_orders(one: Analysis) -> Iterator[Array]:
    yield one.orders
    if one.inner is not None:
        yield one.inner.bending.phasors.orders
        if one.inner.with_gas is not None:
            yield one.inner.with_gas.bending.phasors.orders
    if one.guide is not None:
        yield one.guide.h.orders


def _compare_orders(analyses: Sequence[Analysis], every_order: bool) -> Iterator[Line]:
    known = [one.spectra.with_moment_if(one.moments_known) for one in analyses]
    for kind, _ in known[0].items():
        single = _of_one_cylinder(kind, analyses)
        sizes = [spectra[kind.name].major for spectra in known]
        for order, *values in zip(analyses[0].orders, *sizes, strict=True):
            if every_order or order <= 2 or any(values):
                yield Line(kind, float(order), tuple(map(float, values)), single)


def _compare_peaks(analyses: Sequence[Analysis]) -> Iterator[Line]:
    for same in zip(*(one.peaks for one in analyses), strict=True):
        kind, _ = same[0]
        single = _of_one_cylinder(kind, analyses)
        yield Line(kind, None, tuple(_known_values(kind, same, analyses)), single)


def _of_one_cylinder(kind: Kind, analyses: Sequence[Analysis]) -> tuple[float, ...]:
    return tuple(one.of_one_cylinder.get(kind.name, 0.0) for one in analyses)


def _known_values(
    kind: Kind, peaks: Iterable[tuple[Kind, Peak]], analyses: Sequence[Analysis]
) -> Iterator[float]:
    for (_, peak), one in zip(peaks, analyses, strict=True):
        yield peak.value if one.moments_known or kind is not MOMENT else nan


def _compare_inner(analyses: Sequence[Analysis]) -> Iterator[Line]:
    """The largest along the crank, by order and of all orders."""
    found = [one.inner for one in analyses if one.inner is not None]
    gas = [one.with_gas for one in found if one.with_gas is not None]
    lines: list[tuple[Kind, list[AlongCrank | None]]] = [
        (SHEAR, [one.shear for one in found]),
        (BENDING, [one.bending for one in found]),
        (BEARING, [one.bearings for one in found]),
    ]
    lines += [(kind, [loads[k] for loads in gas]) for k, kind in enumerate(WITH_GAS)]
    for kind, several in lines:
        there = [along for along in several if along is not None]
        if not there or len(there) < len(analyses):
            continue  # a crank with one throw has no bearings that are known
        sizes = [along.phasors.major.max(axis=1) for along in there]
        for order, *values in zip(there[0].phasors.orders, *sizes, strict=True):
            if order % 1 == 0 or any(values):
                yield Line(kind, float(order), tuple(map(float, values)))
        peaks = (max(peak.value for peak in along.peaks) for along in there)
        yield Line(kind, None, tuple(map(float, peaks)))


def _compare_guide(analyses: Sequence[Analysis]) -> Iterator[Line]:
    """With gas where all engines have some, else of inertia alone."""
    found = _list_guides(analyses)
    if len({guide.with_gas for guide in found}) > 1:
        engines = [one.engine for one in analyses]
        of_inertia = partial(analyze, orders=found[0].h.orders, only="guide", beside=engines)
        found = _list_guides([of_inertia(replace(engine, gas=None)) for engine in engines])
    alone = "" if all(guide.with_gas for guide in found) else " of inertia alone"
    for known, several in ((GUIDE_H, [g.h for g in found]), (GUIDE_X, [g.x for g in found])):
        kind = known._replace(label=f"{known.label}{alone}")
        there = [moment for moment in several if moment is not None]
        if there and len(there) == len(analyses):
            sizes = [moment.major for moment in there]
            for order, *values in zip(there[0].orders, *sizes, strict=True):
                yield Line(kind, float(order), tuple(map(float, values)))


def _list_guides(analyses: Sequence[Analysis]) -> list[GuideMoments]:
    return [one.guide for one in analyses if one.guide is not None]


def _compare_sizing(analyses: Sequence[Analysis]) -> Iterator[Line]:
    left = [one.sizing.after for one in analyses if one.sizing is not None]
    for same in zip(*(one.peaks for one in left), strict=True):
        kind, _ = same[0]
        yield Line(LEFT[kind], None, tuple(_known_values(kind, same, left)))

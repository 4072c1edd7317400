"""Engines side by side."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from math import nan
from typing import TYPE_CHECKING, Annotated, Literal

from ..core.phasors import Array
from ..documents.records import HIDDEN
from ..engine.build import Engine
from ..errors import BalcliError
from ..forces.kinds import EVERY_KIND, GAS, MOMENT, VECTORS, Kind
from ..forces.orders import merge_orders
from ..result import Result
from .analysis import QUANTITIES, Analysis, analyze

if TYPE_CHECKING:
    from ..forces.crankshaft import AlongCrank, InnerLoads
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
GUIDES = (GUIDE_H, GUIDE_X)
KINDS = tuple(EVERY_KIND.values())
LEFT = {
    kind: kind._replace(
        name=f"{kind.name} with devices",
        label=f"{kind.label} with the devices of auto",
        key=f"with_devices_{kind.key}",
    )
    for kind in VECTORS
}


@dataclass(frozen=True, kw_only=True)
class Line:
    """One figure of every engine, SI: the amplitude of an order, or the peak of the whole curve.

    Attributes:
        quantity: Name of the figure, which ends in its unit.
        order: Order; null for a peak.
        values: One an engine; null for moments that are not known.
        ratios: Ratios to the first engine's value; null where that is 0.
        kind: Kind of force or moment.
        single: What one cylinder of each engine makes, next to which a value may be negligible; 0
            where there is no such measure.
    """

    quantity: str
    order: float | None
    values: tuple[float, ...]
    ratios: tuple[float, ...]
    kind: Annotated[Kind, HIDDEN]
    single: Annotated[tuple[float, ...], HIDDEN]


@dataclass(frozen=True, kw_only=True, repr=False)
class Comparison(Result):
    """Engines side by side.

    Attributes:
        format: Name and version of the document.
        engines: Names of the engines.
        speeds_rpm: Speed at which each is compared.
        figures: Figures of all engines.
        compared: The engines.
        whole: Whether people are shown negligible orders as well.
    """

    format: Literal["balcli.compare/1"] = "balcli.compare/1"
    engines: tuple[str, ...]
    speeds_rpm: tuple[float, ...]
    figures: tuple[Line, ...]
    compared: Annotated[tuple[Engine, ...], HIDDEN]
    whole: Annotated[bool, HIDDEN]

    @property
    def summary(self) -> str:
        """The engines."""
        return f"of {', '.join(self.engines)}"


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
    return Comparison(
        engines=tuple(names),
        speeds_rpm=tuple(float(engine.speed_rpm) for engine in engines),
        figures=lines,
        compared=tuple(engines),
        whole=whole or orders is not None,
    )


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
    guides = _list_guides(analyses)
    tables = [
        {(kind, order): float(size) for kind, order, size in _list_sizes(one, guide)}
        for one, guide in zip(analyses, guides, strict=True)
    ]
    alone = "" if all(guide is None or guide.with_gas for guide in guides) else " of inertia alone"
    lines = []
    for kind, order in tables[0]:
        values = tuple(table.get((kind, order), nan) for table in tables)
        there = all((kind, order) in table for table in tables)  # one throw has no known bearings
        least = order is None or order <= 2 if kind in KINDS else order is None or order % 1 == 0
        if there and (least or any(values) or kind in GUIDES or (every_order and kind in KINDS)):
            shown = kind._replace(label=f"{kind.label}{alone}") if kind in GUIDES else kind
            lines.append(_make_line(shown, order, values, analyses))
    return tuple(lines)


def _make_line(
    kind: Kind, order: float | None, values: tuple[float, ...], analyses: Sequence[Analysis]
) -> Line:
    return Line(
        quantity=f"peak_{kind.key}" if order is None else kind.key,
        order=order,
        values=values,
        ratios=tuple(value / values[0] if values[0] else nan for value in values),
        kind=kind,
        single=tuple(one.of_one_cylinder.get(kind.name, 0.0) for one in analyses),
    )


def _list_orders(one: Analysis) -> Iterator[Array]:
    yield one.orders
    if one.inner is not None:
        yield one.inner.bending.phasors.orders
        if one.inner.with_gas is not None:
            yield one.inner.with_gas.bending.phasors.orders
    if one.guide is not None:
        yield one.guide.h.orders


def _list_sizes(
    one: Analysis, guide: GuideMoments | None
) -> Iterator[tuple[Kind, float | None, float]]:
    """Yield the figures of an analysis: kind, order (None for a peak), and size."""
    for kind, phasors in one.spectra.with_moment_if(one.moments_known).items():
        yield from _list_by_order(kind, one.orders, phasors.major)
    yield from _list_peaks(one)
    if one.inner is not None:
        loads = zip((SHEAR, BENDING, BEARING, *WITH_GAS), _list_loads(one.inner), strict=False)
        for kind, along in loads:
            if along is not None:
                sizes = along.phasors.major.max(axis=1)
                yield from _list_by_order(kind, along.phasors.orders, sizes)
                yield kind, None, max(peak.value for peak in along.peaks)
    if guide is not None:
        for kind, moment in zip(GUIDES, (guide.h, guide.x), strict=True):
            if moment is not None:
                yield from _list_by_order(kind, moment.orders, moment.major)
    if one.sizing is not None:
        for kind, _, peak in _list_peaks(one.sizing.after):
            yield LEFT[kind], None, peak


def _list_peaks(one: Analysis) -> Iterator[tuple[Kind, None, float]]:
    for kind, peak in one.peaks:
        yield kind, None, peak.value if one.moments_known or kind is not MOMENT else nan


def _list_by_order(
    kind: Kind, orders: Array, sizes: Array
) -> Iterator[tuple[Kind, float | None, float]]:
    for order, size in zip(orders.tolist(), sizes.tolist(), strict=True):
        yield kind, int(order) if order % 1 == 0 else order, size


def _list_loads(inner: InnerLoads) -> tuple[AlongCrank | None, ...]:
    """Return the largest loads along the crank, by order and of all orders."""
    return inner.shear, inner.bending, inner.bearings, *(inner.with_gas or ())


def _list_guides(analyses: Sequence[Analysis]) -> list[GuideMoments | None]:
    """Return guide moments with gas where all engines have some, else of inertia alone."""
    found = [one.guide for one in analyses]
    known = [guide for guide in found if guide is not None]
    if len({guide.with_gas for guide in known}) < 2:
        return found
    engines = [one.engine for one in analyses]
    of_inertia = partial(analyze, orders=known[0].h.orders, only="guide", beside=engines)
    return [of_inertia(replace(engine, gas=None)).guide for engine in engines]

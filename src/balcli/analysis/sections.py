"""Shear forces, bending moments and bearing loads along the crankshaft, in every format.

Guide-force moments by order: as a table, in JSON and as rows.

Strokes and dead centres of the pistons: as a table, in JSON and as rows.

Why each order is balanced or is not: as sentences and as rows.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..core.records import write_each
from ..show.figures import FigureRow, clean, order_rows, peak_rows
from ..show.sheet import (
    NOTHING,
    UNKNOWN,
    Facts,
    Grid,
    Text,
    degrees,
    number,
    order_name,
    size_cell,
    size_text,
)
from .order_tables import fit_largest
from .records import describe_guide, list_load_orders

if TYPE_CHECKING:
    from ..core.phasors import Array, Phasors
    from ..forces.crankshaft import AlongCrank, InnerLoads
    from ..forces.guide import GuideMoments
    from ..forces.symmetry import Symmetry
    from ..show.units import ShownUnit, System
    from .records import Stroke


_OPEN_END = (
    "Without bearings: the value at the last place is the free moment of all these loads about it, "
    "which the mounts carry."
)
_TOGETHER = (
    "Of inertia: gas presses on throw and head alike, so that it shears and bends crankshaft and "
    "block together nowhere."
)
_CUT = (
    "Main bearings half-way between throws and as far outside the end ones; the shaft counts as "
    "cut in each."
)
ORDERS_SHOWN, GAS_ORDERS_SHOWN = 6, 5  # in a table, which has a column an order


class _Load(NamedTuple):
    """A load along the crank: its name in CSV, its title, and whether gas has a part in it."""

    name: str
    along: AlongCrank
    unit: ShownUnit
    title: str
    with_gas: bool = False


def _list_loads(inner: InnerLoads, system: System) -> Iterator[_Load]:
    force, moment, gas = system.force, system.moment, inner.with_gas
    where = "crankshaft" if gas is None else "crankshaft and block together"
    yield _Load("shear", inner.shear, force, f"Shear force in the {where} behind each load")
    yield _Load("bending", inner.bending, moment, f"Bending moment in the {where}")
    if inner.bearings is not None:
        title = "Inertia loads of main bearings half-way between throws, shaft cut in each"
        yield _Load("bearing", inner.bearings, force, title)
    if gas is None:
        return
    for part, name, shear, bending in (
        ("crankshaft", "shaft", gas.shear, gas.bending),
        ("block", "block", gas.block_shear, gas.block_bending),
    ):
        yield _Load(f"{name}_shear", shear, force, f"Shear force in the {part} with gas", True)
        yield _Load(
            f"{name}_bending", bending, moment, f"Bending moment in the {part} with gas", True
        )
        if name == "shaft":
            yield _Load("main", gas.bearings, force, "Loads of main bearings with gas", True)


def sheet_parts(inner: InnerLoads, system: System) -> Iterator[Grid | Facts | Text]:
    """Yield a table of each quantity, a row for each place, and the largest bending moment; for an
    engine with gas also the loads of gas inside it.

    Args:
        inner: Loads along the crankshaft.
        system: System of units.
    """
    gas = inner.with_gas
    notes = {"bending": _OPEN_END if gas is None else f"{_TOGETHER} {_OPEN_END}", "main": _CUT}
    for load in _list_loads(inner, system):
        if load.name != "bearing" or gas is None:
            yield _grid(load, system.length, notes.get(load.name, ""))
    facts = [("largest inner moment", _largest_bending(inner.bending, system))]
    if gas is not None:
        facts.append(("in the crankshaft", _largest_bending(gas.bending, system)))
        facts.append(("in the block", _largest_bending(gas.block_bending, system)))
    yield Facts(tuple(facts))
    if inner.obstacle:
        yield Text("", (f"{_TOGETHER} Inside, it is not known: {inner.obstacle}.",))


def rows(inner: InnerLoads, system: System) -> Iterator[FigureRow]:
    """Yield the figures of every place. Places are numbered along the crank: `shear 1` has its
    position as a figure.

    Args:
        inner: Loads along the crankshaft.
        system: System of units.
    """
    length = system.length
    for name, along, unit, *_ in _list_loads(inner, system):
        for k, z in enumerate(along.z_m):
            here, place = write_each(list_load_orders(along.at(k))), f"{name} {k + 1}"
            yield FigureRow(0, place, None, "position", clean(length.of(z)), length.name)
            yield from peak_rows(place, along.peaks[k], unit)
            for entry in here:
                yield from order_rows(place, entry.pop("order"), entry, unit)


def _grid(load: _Load, length: ShownUnit, note: str) -> Grid:
    """Return one row a place: the peak over a revolution, and the largest of each of the first
    orders.
    """
    along = load.along
    orders = along.phasors.orders[: GAS_ORDERS_SHOWN if load.with_gas else ORDERS_SHOWN]
    unit = load.unit.fit(max(peak.value for peak in along.peaks))
    heads = (f"place, {length.name}", "largest", "deg", *(f"order {order_name(n)}" for n in orders))

    def cells(k: int) -> Iterator[str]:
        peak, sizes = along.peaks[k], along.at(k).major[: len(orders)]
        yield number(length.of(float(along.z_m[k])))
        yield number(unit.of(peak.value)) if peak.value else NOTHING
        yield degrees(float(np.degrees(peak.theta))) if peak.value else ""
        yield from (number(unit.of(float(size)), 4) for size in sizes)

    rows = tuple(tuple(cells(k)) for k in range(len(along.z_m)))
    return Grid(f"{load.title}, {unit.name}", heads, rows, note)


def _largest_bending(bending: AlongCrank, system: System) -> str:
    most = bending.largest
    moment = size_text(bending.peaks[most].value, system.moment, 5)
    place = number(system.length.of(float(bending.z_m[most])))
    return f"{moment} at {place} {system.length.name}"


_ALONE = "of inertia alone, without gas"


def lay_out_guide(guide: GuideMoments, system: System) -> Iterator[Grid]:
    """Yield one table, a row for each order.

    Args:
        guide: Guide-force moments.
        system: System of units.
    """
    both = (guide.h, guide.x)
    unit = fit_largest(system.moment, *filter(None, both))

    def cell(moment: Phasors | None, k: int) -> str:
        return UNKNOWN if moment is None else size_cell(float(moment.major[k]), unit, digits=None)

    yield Grid(
        f"Guide-force moments {'of inertia and gas' if guide.with_gas else _ALONE}, {unit.name}",
        ("order", "H-type", "X-type"),
        tuple((order_name(n), *(cell(m, k) for m in both)) for k, n in enumerate(guide.h.orders)),
        note=define_guide_moments(guide.height_m, system),
    )


def define_guide_moments(height_m: Array, system: System) -> str:
    """Return a note that defines the H- and X-type moments.

    Args:
        height_m: Height of the guides, m, shape (cylinders,).
        system: System of units.
    """
    return (
        "H-type: sum of the cylinders' force couples. X-type: sum of each couple times its "
        f"distance from the reference, divided by L = {_heights(height_m, system)} (crankshaft to "
        "the middle of the guide; unless given, the length of the rod)."
    )


def list_guide(guide: GuideMoments, system: System) -> Iterator[FigureRow]:
    """Yield the figures of every order, first of the H-type, then of the X-type.

    Args:
        guide: Guide-force moments.
        system: System of units.
    """
    for entry in write_each(describe_guide(guide).orders):
        for name, key in (("guide_h", "h_Nm"), ("guide_x", "x_Nm")):
            if key in entry:
                yield from order_rows(name, entry["order"], entry[key], system.moment)


def _heights(height_m: Array, system: System) -> str:
    """Return the height of all cylinders if it is the same, else the lowest and the highest."""
    found = (float(height_m.min()), float(height_m.max()))
    texts = dict.fromkeys(number(system.length.of(height)) for height in found)
    return f"{' to '.join(texts)} {system.length.name}"


def lay_out_strokes(travel: Sequence[Stroke], system: System) -> Iterator[Grid]:
    """Yield one table, a row for each cylinder.

    Args:
        travel: Strokes and dead centers of the cylinders.
        system: System of units.
    """
    length = system.length
    yield Grid(
        "Strokes and dead centres",
        ("cylinder", f"stroke, {length.name}", "top, deg", "bottom, deg"),
        tuple(
            (
                str(one.cylinder),
                number(length.of(one.stroke_m), 7),
                f"{one.top_deg:.3f}",
                f"{one.bottom_deg:.3f}",
            )
            for one in travel
        ),
        note="Dead centres: crank degrees after the pin lies along the cylinder's axis, and half "
        "a turn later.",
    )


def list_strokes(travel: Sequence[Stroke], system: System) -> Iterator[FigureRow]:
    """Yield three figures for each cylinder.

    Args:
        travel: Strokes and dead centers of the cylinders.
        system: System of units.
    """
    length = system.length
    for one in travel:
        about = one.cylinder, "travel", None
        yield FigureRow(*about, "stroke", length.of(one.stroke_m), length.name)
        yield FigureRow(*about, "top_deg", one.top_deg, "deg")
        yield FigureRow(*about, "bottom_deg", one.bottom_deg, "deg")


UNITS = (
    "Fn: largest force of order n of one cylinder's reciprocating masses; a: least axial distance "
    "of two throws; as built: with rotating masses and stagger."
)


def lay_out_symmetry(why: Symmetry) -> Iterator[Text]:
    """Yield one paragraph a reason and the orders that have it; then what its units mean."""
    units = (UNITS,) if any(reason.unit for reason in why.reasons) else ()
    yield Text("Why", (*why.sentences, *units))


def list_symmetry(why: Symmetry) -> Iterator[FigureRow]:
    """Yield the reasons for each order, and the amplitudes that remain: in units of one cylinder's,
    and in those of textbooks.
    """
    for reason in why.reasons:
        about = 0, reason.quantity, reason.order
        yield FigureRow(*about, "why", reason.verdict, "")
        yield FigureRow(*about, "why_size", clean(reason.size), "of one cylinder")
        if reason.reciprocating is not None:
            yield FigureRow(*about, "why_reciprocating", clean(reason.reciprocating), reason.unit)
            yield FigureRow(*about, "why_built", reason.built, reason.unit)
    if why.scope:
        yield FigureRow(0, "scope", None, "why", why.scope, "")
    if why.firing:
        yield FigureRow(0, "firing", None, "why", why.firing, "")

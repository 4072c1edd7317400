"""Shear forces, bending moments and bearing loads along the crankshaft, in every format.

Guide-force moments by order: as a table, in JSON and as rows.

Strokes and dead centres of the pistons: as a table, in JSON and as rows.

Why each order is balanced or is not: as sentences and as rows.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..show.figures import (
    FigureRow,
    clean,
    order_rows,
    peak_angle_deg,
    peak_rows,
    scalar_entries,
    vector_entries,
)
from ..show.sheet import (
    NOTHING,
    UNKNOWN,
    Facts,
    Grid,
    Text,
    degrees,
    number,
    order_name,
    order_number,
    size_cell,
    size_text,
)
from .order_tables import fit_largest

if TYPE_CHECKING:
    from ..core.cylinders import Travel
    from ..core.phasors import Array, Phasors
    from ..forces.crankshaft import AlongCrank, InnerLoads
    from ..forces.guide import GuideMoments
    from ..forces.symmetry import Symmetry
    from ..show.units import ShownUnit, System


_OPEN_END = (
    "Without bearings: what stands at the last place is the free moment of all these loads about "
    "it, which the mounts bear."
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
    """Yield a table of each quantity, a place a row, and the largest bending moment of all; of an
    engine with gas also what bears it inside.
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


def document(inner: InnerLoads) -> dict[str, Any]:
    """Return `inner` of `balcli.analysis/1`: an entry a section of the shaft, and one a bearing."""
    found = _bent_entries(inner.shear, inner.bending)
    if inner.bearings is not None:
        found["bearings"] = _entries(load_N=inner.bearings)
    if (gas := inner.with_gas) is not None:
        found["with_gas"] = {
            "crankshaft": _bent_entries(gas.shear, gas.bending),
            "bearings": _entries(load_N=gas.bearings),
            "block": _bent_entries(gas.block_shear, gas.block_bending),
        }
    if inner.obstacle:
        found["obstacle"] = inner.obstacle
    return found


def _bent_entries(shear: AlongCrank, bending: AlongCrank) -> dict[str, Any]:
    """Return shear force and bending moment at the same sections, and the largest moment."""
    most = bending.largest
    return {
        "largest_bending_Nm": clean(bending.peaks[most].value),
        "largest_at_mm": clean(bending.z_m[most] * 1e3),
        "sections": _entries(shear_N=shear, bending_Nm=bending),
    }


def _entries(**loads: AlongCrank) -> list[dict[str, Any]]:
    """Return an entry a place, with the loads there."""
    places = next(iter(loads.values())).z_m
    return [
        {"position_mm": clean(z * 1e3), **{key: _entry(load, k) for key, load in loads.items()}}
        for k, z in enumerate(places)
    ]


def rows(inner: InnerLoads, system: System) -> Iterator[FigureRow]:
    """Yield the figures of every place. Places are numbered along the crank: `shear 1` has its
    position as a figure.
    """
    length = system.length
    for name, along, unit, *_ in _list_loads(inner, system):
        for k, z in enumerate(along.z_m):
            here, place = along.at(k), f"{name} {k + 1}"
            yield FigureRow(0, place, None, "position", clean(length.of(z)), length.name)
            yield from peak_rows(place, along.peaks[k], unit)
            for n, entry in zip(here.orders, vector_entries(here), strict=True):
                yield from order_rows(place, n, entry, unit)


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


def _entry(along: AlongCrank, k: int) -> dict[str, Any]:
    """What JSON says of the k-th place."""
    peak, here = along.peaks[k], along.at(k)
    return {
        "peak": clean(peak.value),
        "peak_deg": peak_angle_deg(peak),
        "orders": [
            {"order": order_number(n)} | entry
            for n, entry in zip(here.orders, vector_entries(here), strict=True)
        ],
    }


_ALONE = "of inertia alone, without gas"


def lay_out_guide(guide: GuideMoments, system: System) -> Iterator[Grid]:
    """One table, an order a row."""
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
    """What H- and X-type are, with the height of the guides of shape (cylinders,), m."""
    return (
        "H-type: sum of the cylinders' force couples. X-type: sum of each couple times its "
        f"distance from the reference, divided by L = {_heights(height_m, system)} (crankshaft to "
        "the middle of the guide; unless given, the length of the rod)."
    )


def describe_guide(guide: GuideMoments) -> dict[str, Any]:
    """`guide` in `balcli.analysis/1`: an entry an order."""
    orders: list[dict[str, Any]] = [{"order": order_number(n)} for n in guide.h.orders]
    for key, moment in (("h_Nm", guide.h), ("x_Nm", guide.x)):
        if moment is not None:
            for order, entry in zip(orders, scalar_entries(moment), strict=True):
                order[key] = entry
    return {
        "includes": "inertia and gas" if guide.with_gas else "inertia, without gas",
        "height_m": [clean(height) for height in guide.height_m],
        "orders": orders,
    }


def list_guide(guide: GuideMoments, system: System) -> Iterator[FigureRow]:
    """The figures of every order, first of the H-type, then of the X-type."""
    columns = [("guide_h", scalar_entries(guide.h))]
    if guide.x is not None:
        columns.append(("guide_x", scalar_entries(guide.x)))
    for k, order in enumerate(guide.h.orders):
        for name, entries in columns:
            yield from order_rows(name, order, entries[k], system.moment)


def _heights(height_m: Array, system: System) -> str:
    """Of all cylinders if they are alike, else the shortest and the longest."""
    found = (float(height_m.min()), float(height_m.max()))
    texts = dict.fromkeys(number(system.length.of(height)) for height in found)
    return f"{' to '.join(texts)} {system.length.name}"


def lay_out_strokes(travel: Travel, numbers: Sequence[int], system: System) -> Iterator[Grid]:
    """Yield one table, a cylinder a row.

    Args:
        travel: Strokes and dead centres.
        numbers: Numbers of the cylinders, in the order of its arrays.
        system: Units.
    """
    yield Grid(
        "Strokes and dead centres",
        ("cylinder", f"stroke, {system.length.name}", "top, deg", "bottom, deg"),
        tuple(
            (str(n), number(system.length.of(stroke), 7), f"{top:.3f}", f"{bottom:.3f}")
            for n, stroke, top, bottom in _list_travel(travel, numbers)
        ),
        note="Dead centres: crank degrees after the pin lies along the cylinder's axis, and half "
        "a turn later.",
    )


def describe_strokes(travel: Travel, numbers: Sequence[int]) -> list[dict[str, Any]]:
    """Return `travel` of `balcli.analysis/1`: an entry a cylinder."""
    keys = ("cylinder", "stroke_m", "top_deg", "bottom_deg")
    return [dict(zip(keys, line, strict=True)) for line in _list_travel(travel, numbers)]


def list_strokes(travel: Travel, numbers: Sequence[int], system: System) -> Iterator[FigureRow]:
    """Yield three figures a cylinder."""
    length = system.length
    for n, stroke, top, bottom in _list_travel(travel, numbers):
        yield FigureRow(n, "travel", None, "stroke", length.of(stroke), length.name)
        yield FigureRow(n, "travel", None, "top_deg", top, "deg")
        yield FigureRow(n, "travel", None, "bottom_deg", bottom, "deg")


def _list_travel(travel: Travel, numbers: Sequence[int]) -> list[tuple[int, float, float, float]]:
    """Return number, stroke (m) and dead centres (deg) of the cylinders in rising order."""
    arrays = (travel.stroke, travel.top_deg, travel.bottom_deg)
    return sorted(zip(numbers, *((values + 0.0).tolist() for values in arrays), strict=True))


UNITS = (
    "Fn: largest force of order n of one cylinder's reciprocating masses; a: least axial distance "
    "of two throws; as built: with rotating masses and stagger."
)


def lay_out_symmetry(why: Symmetry) -> Iterator[Text]:
    """One paragraph a reason and the orders that have it; then what its units mean."""
    units = (UNITS,) if any(reason.unit for reason in why.reasons) else ()
    yield Text("Why", (*why.sentences, *units))


def list_symmetry(why: Symmetry) -> Iterator[FigureRow]:
    """What decides and why, and what is left: in units of one cylinder's, and in the textbook's."""
    for reason in why.reasons:
        about = 0, reason.quantity, reason.order
        yield FigureRow(*about, "why", reason.verdict, "")
        yield FigureRow(*about, "why_size", clean(reason.size), "of one cylinder")
        if reason.reciprocating is not None:
            yield FigureRow(*about, "why_reciprocating", clean(reason.reciprocating), reason.unit)
            yield FigureRow(*about, "why_built", clean(reason.built), reason.unit)
    if why.scope:
        yield FigureRow(0, "scope", None, "why", why.scope, "")
    if why.firing:
        yield FigureRow(0, "firing", None, "why", why.firing, "")

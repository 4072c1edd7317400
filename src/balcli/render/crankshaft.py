"""Shear forces, bending moments and bearing loads along the crankshaft, in every format."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from .figures import FigureRow, clean, order_rows, peak_angle_deg, peak_rows, vector_entries
from .sheet import NOTHING, Facts, Grid, Text, degrees, number, order_name, order_number, size_text

if TYPE_CHECKING:
    from ..forces.crankshaft import AlongCrank, InnerLoads
    from ..forces.in_bearings import LoadsWithGas
    from .units import ShownUnit, System

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


def sheet_parts(inner: InnerLoads, system: System) -> Iterator[Grid | Facts | Text]:
    """A table of each quantity, a place a row, and the largest bending moment of all; of an engine
    with gas also what bears it inside.
    """
    force, moment, length = system.force, system.moment, system.length
    where = "crankshaft" if inner.with_gas is None else "crankshaft and block together"
    yield _grid(inner.shear, f"Shear force in the {where} behind each load", force, length)
    bending = _grid(inner.bending, f"Bending moment in the {where}", moment, length)
    told = _OPEN_END if inner.with_gas is None else f"{_TOGETHER} {_OPEN_END}"
    yield bending._replace(note=told)
    if inner.with_gas is None and inner.bearings is not None:
        title = "Inertia loads of main bearings half-way between throws, shaft cut in each"
        yield _grid(inner.bearings, title, force, length)
    facts = [("largest inner moment", _largest_bending(inner.bending, system))]
    if (found := inner.with_gas) is not None:
        yield from _gas_grids(found, system)
        facts.append(("in the crankshaft", _largest_bending(found.bending, system)))
        facts.append(("in the block", _largest_bending(found.block_bending, system)))
    yield Facts(tuple(facts))
    if inner.obstacle:
        yield Text("", (f"{_TOGETHER} Inside, it is not known: {inner.obstacle}.",))


def _gas_grids(found: LoadsWithGas, system: System) -> Iterator[Grid]:
    titles = (
        "Shear force in the crankshaft with gas",
        "Bending moment in the crankshaft with gas",
        "Loads of main bearings with gas",
        "Shear force in the block with gas",
        "Bending moment in the block with gas",
    )
    for (name, along, unit), title in zip(_list_gas(found, system), titles, strict=True):
        grid = _grid(along, title, unit, system.length, GAS_ORDERS_SHOWN)
        yield grid._replace(note=_CUT) if name == "main" else grid


def _list_gas(found: LoadsWithGas, system: System) -> Iterator[tuple[str, AlongCrank, ShownUnit]]:
    """Yield each load with gas along the crank, with its name in CSV and its unit."""
    yield "shaft_shear", found.shear, system.force
    yield "shaft_bending", found.bending, system.moment
    yield "main", found.bearings, system.force
    yield "block_shear", found.block_shear, system.force
    yield "block_bending", found.block_bending, system.moment


def document(inner: InnerLoads) -> dict[str, Any]:
    """`inner` in `balcli.analysis/1`: an entry a section of the shaft, and one a bearing."""
    found = _bent_entries(inner.shear, inner.bending)
    if inner.bearings is not None:
        found["bearings"] = _bearing_entries(inner.bearings)
    if (gas := inner.with_gas) is not None:
        found["with_gas"] = {
            "crankshaft": _bent_entries(gas.shear, gas.bending),
            "bearings": _bearing_entries(gas.bearings),
            "block": _bent_entries(gas.block_shear, gas.block_bending),
        }
    if inner.obstacle:
        found["obstacle"] = inner.obstacle
    return found


def _bent_entries(shear: AlongCrank, bending: AlongCrank) -> dict[str, Any]:
    """Shear force and bending moment at the same sections, and the largest moment."""
    most = bending.largest
    return {
        "largest_bending_Nm": clean(bending.peaks[most].value),
        "largest_at_mm": clean(bending.z_m[most] * 1e3),
        "sections": [
            {
                "position_mm": clean(z * 1e3),
                "shear_N": _entry(shear, k),
                "bending_Nm": _entry(bending, k),
            }
            for k, z in enumerate(shear.z_m)
        ],
    }


def _bearing_entries(bearings: AlongCrank) -> list[dict[str, Any]]:
    return [
        {"position_mm": clean(z * 1e3), "load_N": _entry(bearings, k)}
        for k, z in enumerate(bearings.z_m)
    ]


def rows(inner: InnerLoads, system: System) -> Iterator[FigureRow]:
    """The figures of every place. Places are numbered along the crank: `shear 1` has its position
    as a figure.
    """
    yield from _rows_along("shear", inner.shear, system.force, system.length)
    yield from _rows_along("bending", inner.bending, system.moment, system.length)
    if inner.bearings is not None:
        yield from _rows_along("bearing", inner.bearings, system.force, system.length)
    if (gas := inner.with_gas) is not None:
        for name, along, unit in _list_gas(gas, system):
            yield from _rows_along(name, along, unit, system.length)


def _grid(
    along: AlongCrank,
    title: str,
    unit: ShownUnit,
    length: ShownUnit,
    most_orders: int = ORDERS_SHOWN,
) -> Grid:
    """One row a place: the peak over a revolution, and the largest of each of the first orders."""
    orders = along.phasors.orders[:most_orders]
    unit = unit.fit(max(peak.value for peak in along.peaks))
    heads = (f"place, {length.name}", "largest", "deg", *(f"order {order_name(n)}" for n in orders))

    def cells(k: int) -> tuple[str, ...]:
        peak, here = along.peaks[k], along.at(k)
        return (
            number(length.of(float(along.z_m[k]))),
            number(unit.of(peak.value)) if peak.value else NOTHING,
            degrees(float(np.degrees(peak.theta))) if peak.value else "",
            *(number(unit.of(float(largest)), 4) for largest in here.major[: len(orders)]),
        )

    return Grid(f"{title}, {unit.name}", heads, tuple(map(cells, range(len(along.z_m)))))


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


def _rows_along(
    name: str, along: AlongCrank, unit: ShownUnit, length: ShownUnit
) -> Iterator[FigureRow]:
    for k, z in enumerate(along.z_m):
        here, place = along.at(k), f"{name} {k + 1}"
        yield FigureRow(0, place, None, "position", clean(length.of(z)), length.name)
        yield from peak_rows(place, along.peaks[k], unit)
        for n, entry in zip(here.orders, vector_entries(here), strict=True):
            yield from order_rows(place, n, entry, unit)

"""Shear forces, bending moments and bearing loads along the crankshaft: as tables, in JSON and as
rows.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from .figures import FigureRow, clean, order_rows, peak_angle_deg, peak_rows, vector_entries
from .sheet import NOTHING, Facts, Grid, degrees, number, order_name, order_number, size_text

if TYPE_CHECKING:
    from ..forces.crankshaft import AlongCrank, InnerLoads
    from .units import System, Unit

_OPEN_END = (
    "Without bearings: what stands at the last place is the free moment of the whole engine, which "
    "the mounts bear."
)
ORDERS_SHOWN = 6  # in a table, which has a column an order


def sheet_parts(inner: InnerLoads, system: System) -> Iterator[Grid | Facts]:
    """A table of each quantity, a place a row, and the largest bending moment of all."""
    yield _grid(
        inner.shear, "Shear force in the crankshaft behind each load", system.force, system.length
    )
    bending = _grid(inner.bending, "Bending moment in the crankshaft", system.moment, system.length)
    yield bending._replace(note=_OPEN_END)
    if inner.bearings is not None:
        title = "Inertia loads of main bearings half-way between throws, shaft cut in each"
        yield _grid(inner.bearings, title, system.force, system.length)
    yield Facts((("largest inner moment", _largest_bending(inner, system)),))


def document(inner: InnerLoads) -> dict[str, Any]:
    """`inner` in `balcli.analysis/1`: an entry a section of the shaft, and one a bearing."""
    most = inner.bending.largest
    found = {
        "largest_bending_Nm": clean(inner.bending.peaks[most].value),
        "largest_at_mm": clean(inner.bending.z_m[most] * 1e3),
        "sections": [
            {
                "position_mm": clean(z * 1e3),
                "shear_N": _entry(inner.shear, k),
                "bending_Nm": _entry(inner.bending, k),
            }
            for k, z in enumerate(inner.shear.z_m)
        ],
    }
    if inner.bearings is not None:
        found["bearings"] = [
            {"position_mm": clean(z * 1e3), "load_N": _entry(inner.bearings, k)}
            for k, z in enumerate(inner.bearings.z_m)
        ]
    return found


def rows(inner: InnerLoads, system: System) -> Iterator[FigureRow]:
    """The figures of every place. Places are numbered along the crank: `shear 1` has its position
    as a figure.
    """
    yield from _rows_along("shear", inner.shear, system.force, system.length)
    yield from _rows_along("bending", inner.bending, system.moment, system.length)
    if inner.bearings is not None:
        yield from _rows_along("bearing", inner.bearings, system.force, system.length)


def _grid(along: AlongCrank, title: str, unit: Unit, length: Unit) -> Grid:
    """One row a place: the peak over a revolution, and the largest value of each of the first
    orders.
    """
    orders = along.phasors.orders[:ORDERS_SHOWN]
    unit = unit.fit(max(peak.value for peak in along.peaks))
    heads = (
        f"place, {length.name}",
        "largest",
        "deg",
        *(f"order {order_name(n)}" for n in orders),
    )

    def cells(k: int) -> tuple[str, ...]:
        peak, here = along.peaks[k], along.at(k)
        return (
            number(length.of(float(along.z_m[k]))),
            number(unit.of(peak.value)) if peak.value else NOTHING,
            degrees(float(np.degrees(peak.theta))) if peak.value else "",
            *(number(unit.of(float(largest)), 4) for largest in here.major[: len(orders)]),
        )

    return Grid(f"{title}, {unit.name}", heads, tuple(map(cells, range(len(along.z_m)))))


def _largest_bending(inner: InnerLoads, system: System) -> str:
    most = inner.bending.largest
    moment = size_text(inner.bending.peaks[most].value, system.moment, 5)
    place = number(system.length.of(float(inner.bending.z_m[most])))
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


def _rows_along(name: str, along: AlongCrank, unit: Unit, length: Unit) -> Iterator[FigureRow]:
    for k, z in enumerate(along.z_m):
        here, place = along.at(k), f"{name} {k + 1}"
        yield FigureRow(0, place, None, "position", clean(length.of(z)), length.name)
        yield from peak_rows(place, along.peaks[k], unit)
        for n, entry in zip(here.orders, vector_entries(here), strict=True):
            yield from order_rows(place, n, entry, unit)

"""Inner moments, guide-force moments, strokes and dead centres: as parts of a sheet, of the JSON
and as rows.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from .figures import Row, clean, order_number, order_rows, peak_rows, scalar, vector

if TYPE_CHECKING:
    from ..core.phasors import Phasors
    from ..core.strokes import Travel
    from ..forces.crankshaft import AlongCrank, InnerLoads
    from ..forces.guide_moments import GuideMoments
    from ..forces.symmetry import Symmetry
    from ..results.analysis import Analysis
    from .sheet import Facts, Grid
    from .units import System, Unit


# ------------------------------------------------------------------ JSON
def document(result: Analysis) -> dict[str, Any]:
    """The keys `inner`, `guide` and `travel`, as far as they are there."""
    found: dict[str, Any] = {}
    if result.inner is not None:
        found["inner"] = _inner(result.inner)
    if result.guide is not None:
        found["guide"] = {"includes": "inertia, without gas", "orders": _guide(result.guide)}
    if result.travel is not None:
        found["travel"] = [
            {
                "cylinder": n,
                "stroke_m": clean(result.travel.stroke[row]),
                "top_deg": clean(result.travel.top_deg[row]),
                "bottom_deg": clean(result.travel.bottom_deg[row]),
            }
            for n, row in _rows(result)
        ]
    return found


def _inner(inner: InnerLoads) -> dict[str, Any]:
    most = inner.bending.largest
    found = {
        "largest_bending_Nm": clean(inner.bending.peaks[most].value),
        "largest_at_mm": clean(inner.bending.z_m[most] * 1e3),
        "sections": [
            {
                "position_mm": clean(z * 1e3),
                "shear_N": _place(inner.shear, k),
                "bending_Nm": _place(inner.bending, k),
            }
            for k, z in enumerate(inner.shear.z_m)
        ],
    }
    if inner.bearings is not None:
        found["bearings"] = [
            {"position_mm": clean(z * 1e3), "load_N": _place(inner.bearings, k)}
            for k, z in enumerate(inner.bearings.z_m)
        ]
    return found


def _place(along: AlongCrank, k: int) -> dict[str, Any]:
    peak = along.peaks[k]
    here = along.at(k)
    return {
        "peak": clean(peak.value),
        "peak_deg": clean(np.degrees(peak.theta)) if peak.value else None,
        "orders": [
            {"order": order_number(n), **vector(here, row)} for row, n in enumerate(here.orders)
        ],
    }


def _guide(guide: GuideMoments) -> list[dict[str, Any]]:
    return [
        {
            "order": order_number(n),
            "h_Nm": scalar(guide.h, k),
            **({} if guide.x is None else {"x_Nm": scalar(guide.x, k)}),
        }
        for k, n in enumerate(guide.h.orders)
    ]


def _rows(result: Analysis) -> list[tuple[int, int]]:
    """Cylinder numbers in order, with their rows."""
    return sorted((number, row) for row, number in enumerate(result.engine.numbers))


# ------------------------------------------------------------------ rows
def rows(result: Analysis, system: System) -> Iterator[Row]:
    """The same one figure a row, and what `--why` says. Places along the crank are numbered: `shear
    1` has its position as a figure.
    """
    if result.travel is not None:
        yield from _travel_rows(result, result.travel, system.length)
    if result.inner is not None:
        yield from _along_rows("shear", result.inner.shear, system.force, system.length)
        yield from _along_rows("bending", result.inner.bending, system.moment, system.length)
        if result.inner.bearings is not None:
            yield from _along_rows("bearing", result.inner.bearings, system.force, system.length)
    if result.guide is not None:
        yield from _guide_rows(result.guide, system.moment)
    if result.why is not None:
        yield from _why_rows(result.why)


def _travel_rows(result: Analysis, travel: Travel, length: Unit) -> Iterator[Row]:
    for n, row in _rows(result):
        yield Row(n, "travel", None, "stroke", clean(length.of(travel.stroke[row])), length.name)
        yield Row(n, "travel", None, "top_deg", clean(travel.top_deg[row]), "deg")
        yield Row(n, "travel", None, "bottom_deg", clean(travel.bottom_deg[row]), "deg")


def _guide_rows(guide: GuideMoments, unit: Unit) -> Iterator[Row]:
    for k, entry in enumerate(_guide(guide)):
        for key, name in (("h_Nm", "guide_h"), ("x_Nm", "guide_x")):
            if key in entry:
                yield from order_rows(name, guide.h.orders[k], entry[key], unit)


def _why_rows(why: Symmetry) -> Iterator[Row]:
    for reason in why.reasons:
        yield Row(0, reason.quantity, reason.order, "why", reason.verdict, "")
        yield Row(
            0, reason.quantity, reason.order, "why_size", clean(reason.size), "of one cylinder"
        )
    if why.firing:
        yield Row(0, "firing", None, "why", why.firing, "")


def _along_rows(name: str, along: AlongCrank, unit: Unit, length: Unit) -> Iterator[Row]:
    for k, z in enumerate(along.z_m):
        here, place = along.at(k), f"{name} {k + 1}"
        yield Row(0, place, None, "position", clean(length.of(z)), length.name)
        yield from peak_rows(place, along.peaks[k], unit)
        for row, n in enumerate(here.orders):
            yield from order_rows(place, n, vector(here, row), unit)


# ------------------------------------------------------------------ a sheet
def parts(result: Analysis, system: System) -> Iterator[Grid | Facts]:
    """The same for people."""
    if result.travel is not None:
        yield _strokes(result, result.travel, system)
    if result.inner is not None:
        yield from _along_the_crank(result.inner, system)
    if result.guide is not None:
        yield _guide_forces(result.guide, system)


def _strokes(result: Analysis, travel: Travel, system: System) -> Grid:
    from .sheet import Grid, number

    def cells(n: int, row: int) -> tuple[str, ...]:
        dead = (f"{angles[row] + 0.0:.3f}" for angles in (travel.top_deg, travel.bottom_deg))
        return str(n), number(system.length.of(float(travel.stroke[row])), 7), *dead

    return Grid(
        "Strokes and dead centres",
        ("cylinder", f"stroke, {system.length.name}", "top, deg", "bottom, deg"),
        tuple(cells(n, row) for n, row in _rows(result)),
        note="Dead centres: crank degrees after the pin lies along the cylinder's axis, and half "
        "a turn later.",
    )


def _along_the_crank(inner: InnerLoads, system: System) -> Iterator[Grid | Facts]:
    from .sheet import Facts, number

    yield _places(
        inner.shear, system, system.force, "Shear force in the crankshaft behind each load"
    )
    yield _places(inner.bending, system, system.moment, "Bending moment in the crankshaft")
    if inner.bearings is not None:
        yield _places(
            inner.bearings,
            system,
            system.force,
            "Inertia loads of main bearings half-way between throws, shaft cut in each",
        )
    most = inner.bending.largest
    at = f"at {number(system.length.of(float(inner.bending.z_m[most])))} {system.length.name}"
    yield Facts(
        (
            (
                "largest inner moment",
                (
                    f"{number(system.moment.of(inner.bending.peaks[most].value))} "
                    f"{system.moment.name} {at}"
                ),
            ),
        )
    )


def _places(along: AlongCrank, system: System, unit: Unit, title: str) -> Grid:
    """One row a place: the peak over a revolution, and the largest value of each of the first
    orders.
    """
    from .sheet import Grid, degrees, number

    orders = along.phasors.orders[:6]

    def row(k: int) -> tuple[str, ...]:
        peak, here = along.peaks[k], along.at(k)
        at = degrees(float(np.degrees(peak.theta))) if peak.value else "–"
        sizes = (number(unit.of(float(here.major[j])), 4) for j in range(len(orders)))
        return (
            number(system.length.of(float(along.z_m[k]))),
            number(unit.of(peak.value)),
            at,
            *sizes,
        )

    heads = (
        f"place, {system.length.name}",
        "largest",
        "deg",
        *(f"order {order_number(n)}" for n in orders),
    )
    return Grid(f"{title}, {unit.name}", heads, tuple(row(k) for k in range(len(along.z_m))))


def _guide_forces(guide: GuideMoments, system: System) -> Grid:
    from .sheet import Grid, number

    def size(phasors: Phasors | None, k: int) -> str:
        return "–" if phasors is None else number(system.moment.of(float(phasors.major[k])))

    return Grid(
        f"Guide-force moments of inertia alone, without gas, {system.moment.name}",
        ("order", "H-type", "X-type"),
        tuple(
            (str(order_number(n)), size(guide.h, k), size(guide.x, k))
            for k, n in enumerate(guide.h.orders)
        ),
    )

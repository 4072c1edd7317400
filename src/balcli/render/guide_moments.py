"""Guide-force moments by order: as a table, in JSON and as rows."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from .figures import FigureRow, clean, order_rows, scalar_entries
from .order_tables import fit_largest
from .sheet import UNKNOWN, Grid, number, order_name, order_number, size_cell

if TYPE_CHECKING:
    from ..core.phasors import Array, Phasors
    from ..forces.guide_moments import GuideMoments
    from .units import System

_ALONE = "of inertia alone, without gas"


def sheet_parts(guide: GuideMoments, system: System) -> Iterator[Grid]:
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


def document(guide: GuideMoments) -> dict[str, Any]:
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


def rows(guide: GuideMoments, system: System) -> Iterator[FigureRow]:
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

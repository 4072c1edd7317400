"""Guide-force moments by order: as a table, in JSON and as rows."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from ..core.phasors import Phasors
from ..forces.guide_moments import GuideMoments
from .figures import Row, clean, order_number, order_rows, scalar
from .sheet import Grid, number
from .units import System, Unit


def sheet_parts(guide: GuideMoments, system: System) -> Iterator[Grid]:
    """One table, an order a row."""
    yield Grid(
        f"Guide-force moments of inertia alone, without gas, {system.moment.name}",
        ("order", "H-type", "X-type"),
        tuple(
            (
                str(order_number(n)),
                _largest(guide.h, k, system.moment),
                "–" if guide.x is None else _largest(guide.x, k, system.moment),
            )
            for k, n in enumerate(guide.h.orders)
        ),
        note=(
            "H-type: sum of the cylinders' force couples. X-type: sum of each couple times its "
            f"distance from the reference, divided by L = {_heights(guide, system)} (crankshaft to "
            "the middle of the guide; unless given, the length of the rod)."
        ),
    )


def document(guide: GuideMoments) -> dict[str, Any]:
    """`guide` in `balcli.analysis/1`: an entry an order."""
    orders = [
        {"order": order_number(n), "h_Nm": scalar(guide.h, k)}
        | ({} if guide.x is None else {"x_Nm": scalar(guide.x, k)})
        for k, n in enumerate(guide.h.orders)
    ]
    return {
        "includes": "inertia, without gas",
        "height_m": [clean(height) for height in guide.height_m],
        "orders": orders,
    }


def rows(guide: GuideMoments, system: System) -> Iterator[Row]:
    """The figures of every order, first of the H-type, then of the X-type."""
    for k, order in enumerate(guide.h.orders):
        yield from order_rows("guide_h", order, scalar(guide.h, k), system.moment)
        if guide.x is not None:
            yield from order_rows("guide_x", order, scalar(guide.x, k), system.moment)


def _heights(guide: GuideMoments, system: System) -> str:
    """Of all cylinders if they are alike, else the shortest and the longest."""
    found = (float(guide.height_m.min()), float(guide.height_m.max()))
    texts = dict.fromkeys(number(system.length.of(height)) for height in found)
    return f"{' to '.join(texts)} {system.length.name}"


def _largest(moment: Phasors, k: int, unit: Unit) -> str:
    return number(unit.of(float(moment.major[k])))

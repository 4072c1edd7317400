"""Strokes and dead centres of the pistons: as a table, in JSON and as rows."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

from .figures import FigureRow
from .sheet import Grid, number

if TYPE_CHECKING:
    from ..core.strokes import Travel
    from .units import System


def sheet_parts(travel: Travel, numbers: Sequence[int], system: System) -> Iterator[Grid]:
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


def document(travel: Travel, numbers: Sequence[int]) -> list[dict[str, Any]]:
    """Return `travel` of `balcli.analysis/1`: an entry a cylinder."""
    keys = ("cylinder", "stroke_m", "top_deg", "bottom_deg")
    return [dict(zip(keys, line, strict=True)) for line in _list_travel(travel, numbers)]


def rows(travel: Travel, numbers: Sequence[int], system: System) -> Iterator[FigureRow]:
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

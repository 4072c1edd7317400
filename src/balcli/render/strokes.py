"""Strokes and dead centres of the pistons: as a table, in JSON and as rows."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

from .figures import FigureRow, clean
from .sheet import Grid, number

if TYPE_CHECKING:
    from ..core.strokes import Travel
    from .units import System


def sheet_parts(travel: Travel, numbers: Sequence[int], system: System) -> Iterator[Grid]:
    """One table, a cylinder a row; `numbers`: of the cylinders, in the order of the arrays."""
    yield Grid(
        "Strokes and dead centres",
        ("cylinder", f"stroke, {system.length.name}", "top, deg", "bottom, deg"),
        tuple(_cells(travel, n, row, system) for n, row in _by_number(numbers)),
        note="Dead centres: crank degrees after the pin lies along the cylinder's axis, and half "
        "a turn later.",
    )


def document(travel: Travel, numbers: Sequence[int]) -> list[dict[str, Any]]:
    """`travel` in `balcli.analysis/1`: an entry a cylinder."""
    return [
        {
            "cylinder": n,
            "stroke_m": clean(travel.stroke[row]),
            "top_deg": clean(travel.top_deg[row]),
            "bottom_deg": clean(travel.bottom_deg[row]),
        }
        for n, row in _by_number(numbers)
    ]


def rows(travel: Travel, numbers: Sequence[int], system: System) -> Iterator[FigureRow]:
    """Three figures a cylinder."""
    length = system.length
    for n, row in _by_number(numbers):
        yield FigureRow(
            n, "travel", None, "stroke", clean(length.of(travel.stroke[row])), length.name
        )
        yield FigureRow(n, "travel", None, "top_deg", clean(travel.top_deg[row]), "deg")
        yield FigureRow(n, "travel", None, "bottom_deg", clean(travel.bottom_deg[row]), "deg")


def _by_number(numbers: Sequence[int]) -> list[tuple[int, int]]:
    """Cylinder numbers in rising order, each with its row in the arrays."""
    return sorted((number, row) for row, number in enumerate(numbers))


def _cells(travel: Travel, n: int, row: int, system: System) -> tuple[str, ...]:
    stroke = number(system.length.of(float(travel.stroke[row])), 7)
    top, bottom = (f"{angles[row] + 0.0:.3f}" for angles in (travel.top_deg, travel.bottom_deg))
    return str(n), stroke, top, bottom

"""Show a recorded curve by order as tables and CSV."""

from __future__ import annotations

from collections.abc import Iterator

from ..core.records import to_document
from ..limits import MOST_HARMONICS_UNASKED
from ..show.formats import Renderer, Rows
from ..show.sheet import Column, Facts, Grid, Sheet, degrees, number
from ..show.units import System
from .recorded_curve import RecordedCurve
from .records import write_whole
from .show import tenths

_DIGITS = 5  # as for torques


def rows(result: RecordedCurve, system: System) -> Rows:
    """Return CSV with a line for each order."""
    header = ("quantity", "order", "cos", "sin", "amplitude", "peak_deg")
    return Rows(header, _list_rows(result))


def _list_rows(result: RecordedCurve) -> Iterator[tuple[object, ...]]:
    for entry in to_document(result)["orders"]:
        figures = (entry["order"], entry["cos"], entry["sin"], entry["amplitude"])
        yield (result.quantity, *figures, entry["peak_deg"])


def sheet(result: RecordedCurve, system: System) -> Sheet:
    """Return the sheet: mean and extremes, and the curve by order."""
    facts = Facts(
        (
            ("period", f"{write_whole(result.cycle_deg)} deg"),
            ("mean", number(result.mean)),
            ("largest", f"{number(result.max)} at {tenths(result.max_deg)} deg"),
            ("smallest", f"{number(result.min)} at {tenths(result.min_deg)} deg"),
        )
    )
    orders = []
    for entry in result.orders:
        harmonic = entry.harmonic
        sizes = [number(v, _DIGITS) for v in (harmonic.amplitude, harmonic.cos, harmonic.sin)]
        at = degrees(harmonic.peak_deg) if harmonic.amplitude else ""
        orders.append([f"{entry.order:g}", *sizes, at])
    columns = [
        Column("order", words=True),
        Column("amplitude"),
        Column("cos"),
        Column("sin"),
        Column("peak, deg"),
    ]
    note = "--orders lists higher orders." if len(orders) == MOST_HARMONICS_UNASKED else ""
    grid = Grid.of_rows("By order", columns, orders, note)
    return Sheet(f"{result.name}: {result.quantity}", (facts, grid))


RENDERER = Renderer(sheet=sheet, rows=rows)

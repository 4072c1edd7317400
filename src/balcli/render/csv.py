"""Results as CSV: full precision, one header, one figure or variant a line."""
from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from io import StringIO
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ..analysis import Analysis
    from ..balancing import Balance
    from ..combined import Combined
    from .units import System


def write(header: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    """Rows under a header; None is an empty cell."""
    buffer = StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(header)
    writer.writerows([("" if cell is None else str(cell).lower() if isinstance(cell, bool) else cell) for cell in row] for row in rows)
    return buffer.getvalue()


def analyses(results: Sequence[Analysis], names: Sequence[str], system: System) -> str:
    """One figure a row, under the name of its engine; cylinder 0 is the whole engine, an empty order the whole curve."""
    from .figures import rows

    return write(("engine", "cylinder", "quantity", "order", "figure", "value", "unit"),
                 ((name, *row) for name, result in zip(names, results, strict=True) for row in rows(result, system)))


def sums(result: Combined, system: System) -> str:
    """One figure a row, of both engines together."""
    from .figures import rows

    return write(("quantity", "order", "figure", "value", "unit"), (row[1:] for row in rows(result, system)))


def balances(result: Balance, system: System) -> str:
    """One figure a row: those of the devices, then those of the engine without and with them."""
    from .figures import rows

    remedy = result.remedy
    figures: list[Sequence[Any]] = []
    for kind, tables in (("counterweight", remedy.counterweights), ("shaft", remedy.shafts), ("slider", remedy.sliders)):
        for number, device in enumerate(tables, 1):
            entries = [(name, getattr(device, name), unit) for name, unit in _DEVICE if hasattr(device, name)]
            entries += [(f"at_{axis}", place, "mm") for axis, place in zip("xy", getattr(device, "at", ()), strict=False)]
            figures += [(f"{kind} {number}", "", "", name, value, unit) for name, value, unit in entries]
    for state, analysis in (("before", result.before), ("after", result.after)):
        figures += [(state, row.quantity, row.order, row.figure, row.value, row.unit) for row in rows(analysis, system)]
    return write(("part", "quantity", "order", "figure", "value", "unit"), figures)


_DEVICE = (("ratio", ""), ("order", ""), ("unbalance", "g·mm"), ("angle", "deg"), ("direction", "deg"), ("position", "mm"))

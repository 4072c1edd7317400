"""What a person reads of a balance: devices, their practical figures, and what shakes before and
after.
"""

from __future__ import annotations

import numpy as np

from ..core.peaks import Peak
from ..forces.kinds import FORCE, MOMENT, ROLL
from ..results.balance import Balance
from .devices import device_grid, practical_grid
from .figures import order_number
from .scheme_details import details_parts
from .sheet import Facts, Grid, Sheet, Text, degrees, number
from .units import System, Unit


def sheet(result: Balance, system: System) -> Sheet:
    """Why and what, the workshop's figures, and both analyses side by side."""
    remedy = result.remedy
    order = "" if remedy.order is None else f", order {remedy.order}"
    parts: list[Grid | Facts | Text] = []
    if remedy.reasons and not remedy.devices and not remedy.beyond:
        parts.append(Text("What is changed, and why", remedy.reasons))
    elif remedy.reasons:
        parts.append(Text("What is fitted, and why", tuple(dict.fromkeys(remedy.reasons))))
        parts += [device_grid(remedy, system), practical_grid(result.practical, system)]
    else:
        why = () if remedy.note else ("Orders 1 and 2 are balanced.",)
        parts.append(Text("Nothing is fitted", why))
    if remedy.note:
        parts.append(Text("Note", (remedy.note,)))
    parts += details_parts(result, system)
    parts += [_orders(result, system), _peaks(result, system)]
    return Sheet(
        f"{result.before.engine.name or 'engine without a name'}: {remedy.scheme}{order}",
        tuple(parts),
    )


# ------------------------------------------------------------------ before and after
def _orders(result: Balance, system: System) -> Grid:
    columns = (FORCE, MOMENT, ROLL)

    def row(k: int) -> tuple[str, ...]:
        cells = [f"{order_number(result.before.orders[k])}"]
        for kind in columns:
            unit = system.unit(kind)
            for analysis in (result.before, result.after):
                phasors = analysis.spectra[kind.name]
                cells.append(
                    "balanced"
                    if phasors.balanced[k]
                    else number(unit.of(float(phasors.major[k])), 4)
                )
        return tuple(cells)

    heads = [
        head for kind in columns for head in (f"{kind.name}, {system.unit(kind).name}", "after")
    ]
    return Grid(
        "Largest value by order, before and after",
        ("order", *heads),
        tuple(map(row, range(len(result.before.orders)))),
    )


def _peaks(result: Balance, system: System) -> Grid:
    rows = []
    for (kind, before), (_, after) in zip(result.before.peaks, result.after.peaks, strict=True):
        unit = system.unit(kind)
        rows.append((f"{kind.name}, {unit.name}", *_peak(before, unit), *_peak(after, unit)))
    note = (
        "Sized for steady mean speed; both columns are those of the uneven speed."
        if result.before.engine.ripple
        else ""
    )
    return Grid(
        "Largest over a revolution, all orders",
        ("", "before", "at, deg", "after", "at, deg"),
        tuple(rows),
        note=note,
    )


def _peak(peak: Peak, unit: Unit) -> tuple[str, str]:
    if not peak.value:
        return "none", "–"
    return number(unit.of(peak.value)), degrees(float(np.degrees(peak.theta)))

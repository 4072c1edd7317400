"""Results of a Monte-Carlo run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ..documents.records import to_document
from ..studies.quantity_names import tell_speeds
from .csv import Rows
from .formats import Renderer
from .sheet import NAMELESS, Grid, Sheet, number
from .view import tell_assumed_speed

if TYPE_CHECKING:
    from ..studies.scatter import Scatter
    from .units import System

SHOWN = 6  # sources of each quantity in a table
BOUND = "bound: nominal and all changes added up, to first order: a variant may go a little beyond"
_NORMAL = (
    "; normal deviations exceed a tolerance, three times their standard deviation, in 1 of 370"
)


def document(result: Scatter) -> dict[str, Any]:
    """Return `balcli.scatter/1`."""
    return to_document(result)


def rows(result: Scatter, _system: System) -> Rows:
    """Return CSV: a quantity a line, in SI units."""
    lines: list[dict[str, Any]] = [
        {"quantity": name, **to_document(spread), "unit": result.units[name] or None}
        for name, spread in result.quantities.items()
    ]
    header = [key for key in lines[0] if key != "sensitivity"]
    return Rows(header, [[line[key] for key in header] for line in lines])


def sheet(result: Scatter, system: System) -> Sheet:
    """Return percentiles in SI units, and the tolerances that matter most."""
    table = rows(result, system)
    names = [", ".join(filter(None, (name, result.units[name]))) for name in result.quantities]
    bound = BOUND + (_NORMAL if result.distribution == "normal" else "")
    notes = (bound, tell_speeds(result.quantities), tell_assumed_speed(result.model))
    spread = Grid(
        f"Spread of {result.samples} {result.varied}",
        tuple(table.header[:-1]),
        tuple(
            (name, *map(number, line[1:-1])) for name, line in zip(names, table.lines, strict=True)
        ),
        note=". ".join(filter(None, notes)),
    )
    causes = [
        [f"{source}: {number(change, 3)}" for source, change in s.sensitivity.items()]
        for s in result.quantities.values()
    ]
    shares = Grid(
        "What each tolerance alone changes, most first",
        ("quantity", *(f"{k}." for k in range(1, SHOWN + 1))),
        tuple(
            (name, *(texts + [""] * SHOWN)[:SHOWN])
            for name, texts in zip(names, causes, strict=True)
        ),
        words=tuple(range(SHOWN + 1)),
    )
    return Sheet(result.model.name or NAMELESS, (spread, shares))


RENDERER = Renderer(sheet=sheet, document=document, rows=rows)

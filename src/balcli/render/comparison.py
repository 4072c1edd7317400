"""Engines side by side."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .csv import Rows
from .sheet import Grid, Sheet, number

if TYPE_CHECKING:
    from ..results.comparison import Comparison, Line
    from .units import System

_WORDS = {"torque": "inertia torque", "roll": "roll C − T", "couple": "couple C"}


def document(result: Comparison) -> dict[str, Any]:
    """`balcli.compare/1`: SI, ratios to the first engine (null where that has none)."""
    return {
        "format": "balcli.compare/1",
        "engines": list(result.names),
        "figures": [
            {
                "quantity": _key(line),
                "order": line.order,
                "values": list(line.values),
                "ratios": [r if r == r else None for r in line.ratios],
            }
            for line in result.lines
        ],
    }


def _key(line: Line) -> str:
    name = {"torque": "inertia_torque"}.get(line.quantity, line.quantity)
    return f"{'peak_' if line.order is None else ''}{name}_{'N' if name == 'force' else 'Nm'}"


def rows(result: Comparison, system: System) -> Rows:
    """CSV: a figure a line, a column an engine."""
    header = ("quantity", "order", "unit", *result.names)
    return Rows(header, [_csv_line(line, system) for line in result.lines])


def _csv_line(line: Line, system: System) -> tuple[Any, ...]:
    unit = system.force if line.quantity == "force" else system.moment
    name = line.quantity if line.order is not None else f"peak {line.quantity}"
    return name, line.order, unit.name, *map(unit.of, line.values)


def sheet(result: Comparison, system: System) -> Sheet:
    """Amplitudes, with ratios to the first engine's below their size."""
    heads = ("", result.names[0], *(head for name in result.names[1:] for head in (name, "ratio")))
    grids = []
    for quantity in dict.fromkeys(line.quantity for line in result.lines):
        unit = system.force if quantity == "force" else system.moment
        lines = [line for line in result.lines if line.quantity == quantity]
        title = f"{_WORDS.get(quantity, f'Free {quantity}')}, {unit.name}: largest by order"
        grids.append(
            Grid(title[0].upper() + title[1:], heads, tuple(_row(line, unit.of) for line in lines))
        )
    return Sheet("Engines side by side", tuple(grids))


def _row(line: Line, of: Any) -> tuple[str, ...]:
    first, *others = (number(of(value)) for value in line.values)
    ratios = [number(ratio, 4) for ratio in line.ratios[1:]]
    return (
        "peak" if line.order is None else f"order {line.order}",
        first,
        *(cell for pair in zip(others, ratios, strict=True) for cell in pair),
    )

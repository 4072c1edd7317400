"""Results of a search."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .csv import Rows
from .sheet import Grid, Sheet, number

if TYPE_CHECKING:
    from ..studies.search.search import Found, Search
    from .units import System


def document(result: Search) -> dict[str, Any]:
    """`balcli.search/1`."""
    return {
        "format": "balcli.search/1",
        "engine": {"name": result.file.name},
        "over": result.over,
        "results": [
            {**one.arrangement, "objective": one.objective, "quantities": dict(one.figures)}
            for one in result.results
        ],
    }


def rows(result: Search, _system: System) -> Rows:
    """CSV: an arrangement a line, figures in SI units."""
    first = result.results[0]
    return Rows(
        (*first.arrangement, "objective", *first.figures),
        [
            (*map(_setting, one.arrangement.values()), one.objective, *one.figures.values())
            for one in result.results
        ],
    )


def sheet(result: Search, _system: System) -> Sheet:
    """The best arrangements, a row each, in SI units and in the unit F1 (F1·a for moments) in which
    textbooks have forces and moments.
    """
    first = result.results[0]
    units = {q.name: q.unit for q in result.objective.quantities}
    heads = [
        *(name.replace("_", " ") for name in first.arrangement),
        "objective",
        *(f"{name}, {units[name]}" for name in first.figures),
        *(f"{name}, {unit}" for name, (_, unit) in _textbook(result, first).items()),
    ]
    grid = Grid(
        f"Best {result.over.replace('_', ' ')}",
        tuple(heads),
        tuple(_cells(result, one) for one in result.results),
        words=tuple(range(len(first.arrangement))),
    )
    return Sheet(result.file.name or "engine without a name", (grid,))


def _cells(result: Search, one: Found) -> tuple[str, ...]:
    return (
        *map(_setting, one.arrangement.values()),
        number(one.objective),
        *map(number, one.figures.values()),
        *(number(value, 4) for value, _ in _textbook(result, one).values()),
    )


def _textbook(result: Search, one: Found) -> dict[str, tuple[float, str]]:
    """Forces and moments in the textbook's units, where those tell more than the figures alone."""
    scale = result.scale
    known = {"force": (scale.force, "F1"), "moment": (scale.force * scale.arm, "F1·a")}
    kinds = {
        q.name: q.kind for q in result.objective.quantities if q.kind in known and q.part != "peak"
    }
    return {
        name: (one.figures[name] / known[kind][0], known[kind][1])
        for name, kind in kinds.items()
        if known[kind][0] == known[kind][0] and known[kind][0] > 0
    }


def _setting(value: Any) -> str:
    """A number, or several with hyphens between them."""
    return "-".join(f"{v:.6g}" for v in value) if isinstance(value, list) else f"{value:.9g}"

"""Results of a search."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ..forces.kinds import KINDS
from .csv import Rows
from .sheet import NAMELESS, Grid, Sheet, number

if TYPE_CHECKING:
    from ..studies.search.designs import Found
    from ..studies.search.search import Search
    from .units import System


def document(result: Search) -> dict[str, Any]:
    """`balcli.search/1`."""
    return {
        "format": "balcli.search/1",
        "engine": {"name": result.model.name},
        "over": result.over,
        "results": [
            {**one.design.given(), "objective": one.objective, "quantities": dict(one.figures)}
            for one in result.results
        ],
    }


def rows(result: Search, _system: System) -> Rows:
    """CSV: an arrangement a line, figures in SI units."""
    first = result.results[0]
    return Rows(
        (*first.design.given(), "objective", *first.figures),
        [
            (*map(_exactly, one.design.given().values()), one.objective, *one.figures.values())
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
        *(name.replace("_", " ") for name in first.design.given()),
        "objective",
        *(f"{name}, {units[name]}" for name in first.figures),
        *(f"{name}, {unit}" for name, (_, unit) in _textbook(result, first).items()),
    ]
    grid = Grid(
        f"Best {result.over.replace('_', ' ')}",
        tuple(heads),
        tuple(_cells(result, one) for one in result.results),
        words=tuple(range(len(first.design.given()))),
    )
    return Sheet(result.model.name or NAMELESS, (grid,))


def _cells(result: Search, one: Found) -> tuple[str, ...]:
    return (
        *map(_setting, one.design.given().values()),
        number(one.objective),
        *map(number, one.figures.values()),
        *(number(value, 4) for value, _ in _textbook(result, one).values()),
    )


def _textbook(result: Search, one: Found) -> dict[str, tuple[float, str]]:
    """Forces and moments in the textbook's units, where those tell more than the figures alone."""
    shown: dict[str, tuple[float, str]] = {}
    for q in result.objective.quantities:
        kind = KINDS[q.kind]
        size = result.scale.size(kind)
        if kind.vector and q.part != "peak" and size > 0:  # nan where there is one throw
            shown[q.name] = one.figures[q.name] / size, result.scale.name(kind)
    return shown


def _setting(value: Any) -> str:
    """A number, or several with hyphens between them."""
    return "-".join(f"{v:.6g}" for v in value) if isinstance(value, list) else f"{value:.9g}"


def _exactly(value: float | list[float] | list[int]) -> str:
    """The setting of one key in full precision."""
    numbers = value if isinstance(value, list) else [value]
    return "-".join(repr(number).removesuffix(".0") for number in numbers)

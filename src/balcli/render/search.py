"""Results of a search."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from ..studies.quantity_names import tell_speeds
from .csv import Columns, Rows
from .formats import Renderer
from .sheet import NAMELESS, Grid, Sheet, number
from .units import name_with_unit
from .view import tell_assumed_speed

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
            {**one.design, "objective": one.objective, "quantities": dict(one.figures)}
            for one in result.results
        ],
    }


def columns(result: Search) -> Columns:
    """An arrangement a row: angles as numbers, throws and firing orders with hyphens between."""
    first = result.results[0]
    found: dict[str, Any] = {}
    for key, value in first.design.items():
        settings = [one.design[key] for one in result.results]
        found[key] = list(map(_exactly, settings)) if isinstance(value, list) else settings
    found["objective"] = [one.objective for one in result.results]
    found |= {name: [one.figures[name] for one in result.results] for name in first.figures}
    units = {q.name: q.unit for q in result.objective.quantities}
    set_in = {key: unit for key in first.design if (unit := result.find_unit(key))}
    return Columns(found, units | set_in)


def rows(result: Search, _system: System) -> Rows:
    """Return CSV: an arrangement a line, figures in SI units."""
    found = columns(result).values
    return Rows([*found], [*zip(*found.values(), strict=True)])


def sheet(result: Search, _system: System) -> Sheet:
    """Return the best arrangements, a row each, with figures in SI units. One quantity alone is its
    own objective.
    """
    first = result.results[0]
    units = {q.name: q.unit for q in result.objective.quantities}
    heads = [
        *(name_with_unit(_in_words(key), result.find_unit(key)) for key in first.design),
        *(["objective"] if _is_sum(result) else []),
        *(name_with_unit(name, units[name]) for name in first.figures),
    ]
    grid = Grid(
        f"Best {_in_words(result.over)}",
        tuple(heads),
        tuple(_cells(result, one) for one in result.results),
        note=" ".join(_notes(result)),
        words=tuple(range(len(first.design))),
    )
    return Sheet(result.model.name or NAMELESS, (grid,))


def _in_words(over: str) -> str:
    """`bank_angle` is a bank angle; the dotted name of a number stays as one types it."""
    return over if "." in over else over.replace("_", " ")


def _notes(result: Search) -> Iterator[str]:
    if result.refused:
        yield f"Not every value of the range makes an engine; with {result.refused}."
    if result.constant:
        done = "maximised" if result.objective.maximise else "minimised"
        yield f"{result.over} changes nothing of what is {done}: it is the same at every value."
    for key in result.at_ends:
        yield (f"The best {key} is an end of the range that was searched: beyond it may be better.")
    assumed = tell_assumed_speed(result.model)
    if assumed and "operation.speed" not in result.over.split(", "):
        yield assumed
    if speeds := tell_speeds(q.name for q in result.objective.quantities):
        yield speeds
    added = list(dict.fromkeys(q.unit for q in result.objective.weights))
    if len(added) > 1:
        yield f"Objective: {' and '.join(added)} added as plain numbers; NAME=W weighs them."


def _cells(result: Search, one: Found) -> tuple[str, ...]:
    return (
        *map(_setting, one.design.values()),
        *([number(one.objective)] if _is_sum(result) else []),
        *map(number, one.figures.values()),
    )


def _is_sum(result: Search) -> bool:
    """Whether the objective is more than one of the figures."""
    weights = list(result.objective.weights.values())
    return weights != [1.0]


def _setting(value: Any) -> str:
    """A number, or several with hyphens between them."""
    return "-".join(f"{v:.6g}" for v in value) if isinstance(value, list) else f"{value:.9g}"


def _exactly(value: float | list[float] | list[int]) -> str:
    """The setting of one key in full precision."""
    numbers = value if isinstance(value, list) else [value]
    return "-".join(repr(number).removesuffix(".0") for number in numbers)


RENDERER = Renderer(sheet=sheet, document=document, rows=rows, columns=columns)

"""Show the results of `balcli bench` as tables and CSV."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from ..show.formats import Renderer, Rows
from ..show.sheet import Column, Grid, Sheet, capitalized, number
from .records import ROUNDING, list_unbeaten

if TYPE_CHECKING:
    from ..show.units import System
    from .records import Bench, Block, Measured, OrderError

TITLE = "Error against run time of one variant"
_MICRO = 1e6
_NO_DIGIT = 0.5  # relative errors of an order from here on: the method does not find this order


def rows(result: Bench, _system: System) -> Rows:
    """Return the rows of the CSV: a row for each error of each method, then the ratios."""
    header = ("task", "rod_ratio", "variants", "method", "order", "error", "seconds")
    quartiles = ("seconds_lower", "seconds_upper", "ratio")
    return Rows((*header, *quartiles), _list_rows(result))


def _list_rows(result: Bench) -> Iterator[tuple[object, ...]]:
    for row in result.rows:
        place = (row.task, row.rod_ratio, row.variants, row.method, row.order, row.error)
        yield (*place, row.seconds, row.seconds_lower, row.seconds_upper, None)
    for ratio in result.ratios:
        yield ("ratio", None, None, ratio.what, None, None, None, None, None, ratio.value)


def sheet(result: Bench, _system: System) -> Sheet:
    """Return a table for each task, and a table of the ratios."""
    grids = [_make_grid(block) for block in result.blocks]
    ratios = [
        Column("", [ratio.what for ratio in result.ratios], words=True),
        Column("ratio", [number(ratio.value, 3) for ratio in result.ratios]),
    ]
    grids.append(Grid("Ratios of run times", ratios))
    return Sheet(TITLE, tuple(grids))


def _make_grid(block: Block) -> Grid:
    heads = [Column("method", words=True), Column("µs"), Column("quartiles")]
    for order, _ in block.methods[0].errors:
        heads.append(Column("error" if order is None else f"order {order:g}"))
    rows = []
    for method in block.methods:
        time = _tell_time(method.seconds.median)
        errors = map(_tell_error, method.errors)
        rows.append((method.method, time, _tell_quartiles(method), *errors))
    return Grid.of_rows(name_block(block), heads, rows, tell_unbeaten(block))


def name_block(block: Block) -> str:
    """Return the title of a block."""
    title = capitalized(block.task)
    place = tell_place(block)
    return f"{title}, {place}" if place else title


def tell_place(block: Block) -> str:
    """Return λ and the number of variants; empty for a task of whole engines."""
    if block.rod_ratio is None:
        return ""
    several = "one variant" if block.variants == 1 else f"{block.variants} variants"
    return f"λ = {block.rod_ratio:g}, {several}"


def tell_unbeaten(block: Block) -> str:
    """Return a sentence that names the methods that no other method beats, with the error of the
    order that is the least exact.
    """
    methods = []
    for method in list_unbeaten(block.methods):
        methods.append(f"{method.method} ({_tell_worst(method)})")
    *front, last = methods
    names = f"{', '.join(front)} or {last}" if front else last
    return f"No other method is both as quick and as exact as {names}."


def _tell_worst(method: Measured) -> str:
    if any(map(_is_missed, method.errors)):
        return "not every order"
    if method.worst <= ROUNDING:
        return "rounding"
    return f"error up to {method.worst:.0e}"


def _tell_time(seconds: float) -> str:
    return number(seconds * _MICRO, 3)


def _tell_quartiles(row: Measured) -> str:
    return f"{_tell_time(row.seconds.lower)}–{_tell_time(row.seconds.upper)}"


def _tell_error(error: OrderError) -> str:
    if _is_missed(error):
        return "not found"
    return "rounding" if error.error <= ROUNDING else f"{error.error:.0e}"


def _is_missed(error: OrderError) -> bool:
    """Return whether a method does not find an order, whatever it returns."""
    return error.order is not None and error.error > _NO_DIGIT


RENDERER = Renderer(sheet=sheet, rows=rows)

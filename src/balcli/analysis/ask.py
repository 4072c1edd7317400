"""What `balcli analyze` does between its options and its output: files analyzed at one speed, over
several, or for the sheet of marine builders.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..engine.engine import Engine, refuse_geared
from ..forces.kinds import COUPLE, GAS, ROLL
from ..shell.inputs import exit_on_errors, name_engines, read_engine, silence_cylinders, try_each
from ..shell.output import show
from ..show.csv import Rows, name_cell
from ..show.formats import Format, Renderer, Units, write_named
from ..show.sheet import NamedResult, Sheet, View
from ..show.units import System
from . import show as chapter, speeds
from .answer import Analysis, analyze, list_usual_quantities

if TYPE_CHECKING:
    from .options import Request


def sheet(one: NamedResult[Analysis], system: System) -> Sheet:
    """Return the sheet of one analysis.

    Args:
        one: Analysis with the engine's name.
        system: System of units.
    """
    return chapter.sheet(one.result, system, one.view)


def rows(one: NamedResult[Analysis], system: System) -> Rows:
    """Return CSV: the rows of the analysis, each after the engine's name.

    Args:
        one: Analysis with the engine's name.
        system: System of units.
    """
    header, lines = chapter.rows(one.result, system, named=one.view.parts)
    return Rows(("engine", *header), ((name_cell(one.name), *line) for line in lines))


RENDERER = Renderer(sheet=sheet, document=write_named, rows=rows)


def answer(
    paths: Sequence[str], asked: Request, form: Format, output: Path | None, units: Units
) -> None:
    """Analyze files and print the results, by the engines' names; messages name bad files.

    Args:
        paths: Engine files.
        asked: What to compute and show.
        form: Format of the results.
        output: File to write; None: standard output.
        units: System of units.

    Raises:
        BalcliError: The output cannot be written.
        Exit: With status 2, if a file is bad.
    """
    view = View(asked.whole, asked.parts, asked.orders is not None)
    rpm = asked.speeds_rpm[0] if asked.speeds_rpm else None
    for_people = form in (Format.TABLE, Format.MARKDOWN)
    find, renderer = _choose_result(asked, for_people)

    def find_one(path: str) -> tuple[str, str, object]:
        engine = read_engine(path, rpm, asked.words).engine
        if "textbook" in asked.parts:
            refuse_geared(engine)
        return engine.name, path, find(silence_cylinders(engine, asked.misfires, path))

    found, errors = try_each(paths, find_one)
    if found and not (errors and output):  # a file gets all of them or is left as it was
        engines, good, results = zip(*found, strict=True)
        named = zip(name_engines(engines, good), results, strict=True)
        show([NamedResult(*one, view) for one in named], renderer, form, output, units)
    exit_on_errors(errors)


def _choose_result(
    asked: Request, for_people: bool
) -> tuple[Callable[[Engine], object], Renderer[NamedResult[Any]]]:
    """Return the result for an engine, and how it is shown."""
    if not (asked.marine or asked.over_speed):
        return lambda engine: _ask(asked, engine, for_people)(engine, asked.orders), RENDERER
    if asked.marine:
        sheets = partial(
            speeds.find_marine_sheet,
            speeds_rpm=asked.speeds_rpm,
            orders=asked.orders,
            guide_height_m=asked.height_m,
            every_order=asked.whole,
        )
        return sheets, speeds.MARINE

    def find_series(engine: Engine) -> object:
        ask = _ask(asked, engine, for_people)
        return speeds.analyze_speeds(engine, asked.speeds_rpm, asked.orders, ask)

    return find_series, speeds.RENDERER


def _ask(asked: Request, engine: Engine, for_people: bool) -> Callable[..., Analysis]:
    """Return `analyze` for an engine like this one, at any speed and by any orders."""
    if asked.quantities is None:
        wanted = list(list_usual_quantities(engine))
        if not asked.over_speed:  # they are the same at all speeds
            wanted.append("ladder")
            if asked.whole or not for_people:
                wanted.append("sizing")
        if asked.whole and for_people and not engine.placed:
            wanted.append("guide")
    else:
        wanted = list(asked.quantities)
        if "verdict" in asked.parts and for_people:
            wanted.append(COUPLE.name)
            wanted += [] if engine.gas is None else [ROLL.name, GAS.name]  # what rocks the engine
    return partial(
        analyze,
        only=wanted,
        by_cylinder=asked.by_cylinder,
        reasons=asked.why,
        guide_height_m=asked.height_m,
        small=asked.small,
    )

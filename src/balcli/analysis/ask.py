"""Answer a request of `balcli analyze`: analyze files at one speed, at several speeds, or for the
sheet that builders of marine engines use, and print the results.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..engine.engine import Engine, refuse_geared
from ..file.toml import name_file
from ..forces.kinds import COUPLE, GAS, ROLL
from ..shell.inputs import (
    exit_on_errors,
    name_engines,
    read_engine,
    silence_cylinders,
    try_each,
    warn_each,
)
from ..shell.output import show
from ..show.formats import Format, Renderer, Rows, Units, name_cell, write_named
from ..show.sheet import NamedResult, Sheet, View
from ..show.units import System
from . import show as chapter
from .answer import Analysis, analyze, list_usual_quantities

if TYPE_CHECKING:
    from .options import Request


def sheet(named: NamedResult[Analysis], system: System) -> Sheet:
    """Return the sheet of one analysis.

    Args:
        named: Analysis with the engine's name.
        system: System of units.
    """
    return chapter.sheet(named.result, system, named.view)


def rows(named: NamedResult[Analysis], system: System) -> Rows:
    """Return the rows of CSV: the rows of the analysis, each preceded by the engine's name.

    Args:
        named: Analysis with the engine's name.
        system: System of units.
    """
    header, lines = chapter.rows(named.result, system, named=named.view.parts)
    return Rows(("engine", *header), ((name_cell(named.name), *line) for line in lines))


RENDERER = Renderer(sheet=sheet, document=write_named, rows=rows)


def answer(
    paths: Sequence[str], asked: Request, form: Format, output: Path | None, units: Units
) -> None:
    """Analyze files and print the results with the engines' names; errors name the bad files.

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
    words = None if asked.quantities is None else asked.parts  # no warnings on other parts
    for_people = form in (Format.TABLE, Format.MARKDOWN)
    find, renderer = _choose_result(asked, for_people)

    def find_one(path: str) -> tuple[str, str, object]:
        speeds = asked.speeds_rpm or None
        lists_drifting = not asked.marine
        engine = read_engine(path, rpm, words, over=speeds, lists_drifting=lists_drifting).engine
        if "textbook" in asked.parts:
            refuse_geared(engine)
        result = find(silence_cylinders(engine, asked.misfires, path))
        if isinstance(result, Analysis) and hasattr(result, "parts"):
            warn_each(result.parts.doubts, name_file(path))
        return engine.name, path, result

    found, errors = try_each(paths, find_one)
    if found and not (errors and output):  # the output file gets all results or is not changed
        engines, good, results = zip(*found, strict=True)
        named = zip(name_engines(engines, good), results, strict=True)
        show([NamedResult(*one, view) for one in named], renderer, form, output, units)
    exit_on_errors(errors)


def _choose_result(
    asked: Request, for_people: bool
) -> tuple[Callable[[Engine], object], Renderer[NamedResult[Any]]]:
    """Return the function that computes the result for an engine, and its renderer."""
    if not (asked.marine or asked.over_speed):
        return lambda engine: _ask(asked, engine, for_people)(engine, asked.orders), RENDERER
    from . import speeds
    from .comparison import analyze_alike

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
        each = [engine.at_speed(speed) for speed in asked.speeds_rpm]
        found = analyze_alike(each, asked.orders, _ask(asked, engine, for_people))
        every = asked.orders is not None
        return speeds.SpeedSeries(engine=engine, analyses=found, every_order=every)

    return find_series, speeds.RENDERER


def _ask(asked: Request, engine: Engine, for_people: bool) -> Callable[..., Analysis]:
    """Return a function with the arguments engine and orders, which analyzes this engine with the
    requested options. If no quantities are requested, it computes the default ones of `engine`.
    """
    if asked.quantities is None:
        wanted = list(list_usual_quantities(engine))
        if not asked.over_speed:  # devices are the same at all speeds
            wanted.append("ladder")
            if asked.whole or not for_people:
                wanted.append("sizing")
        if asked.whole and for_people and not engine.placed:
            wanted.append("guide")
    else:
        wanted = list(asked.quantities)
        if "verdict" in asked.parts:
            wanted += [COUPLE.name, ROLL.name]
            if engine.gas is not None:
                wanted.append(GAS.name)
    return partial(
        analyze,
        only=wanted,
        by=asked.by,
        why=asked.why,
        guide_height=asked.height_m,
        small=asked.small,
    )

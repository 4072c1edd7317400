"""What `balcli analyze` does between its options and its output: files analysed at one speed, over
several, or for the sheet of marine builders.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, TypeVar

from ..engine.build import Engine
from ..forces.kinds import GAS, ROLL
from ..render import analyses
from ..render.formats import Format, Renderer, Units
from ..render.view import NamedResult, View
from ..results.analysis import Analysis, analyze, list_usual_quantities
from .inputs import exit_on_errors, name_engines, read_engine, silence_cylinders, try_each
from .output import show

if TYPE_CHECKING:
    from .analysis_options import Request

Found = TypeVar("Found")


class Target(NamedTuple):
    """How results are to be written, and where: `output.show`."""

    form: Format
    output: Path | None
    units: Units


def answer(paths: Sequence[str], asked: Request, target: Target) -> None:
    """Analyse files and show what was found; bad ones are named, and end with exit status 2.

    Raises:
        BalcliError: the output cannot be written.
        Exit: a file is bad.
    """
    if asked.marine:
        from ..render import marine
        from ..results.marine import MarineSheet, find_marine_sheet

        def find_sheet(engine: Engine) -> MarineSheet:
            return find_marine_sheet(
                engine, asked.speeds_rpm, asked.orders, asked.height_m, every_order=asked.whole
            )

        _show_each(paths, asked, target, find_sheet, marine)
    elif asked.over_speed:
        from ..render import speeds
        from ..results.speeds import SpeedSeries, analyze_speeds

        def find_series(engine: Engine) -> SpeedSeries:
            ask = _ask(asked, engine, target)
            return analyze_speeds(engine, asked.speeds_rpm, asked.orders, ask)

        _show_each(paths, asked, target, find_series, speeds)
    else:

        def find(engine: Engine) -> Analysis:
            return _ask(asked, engine, target)(engine, asked.orders)

        _show_each(paths, asked, target, find, analyses)


def _ask(
    asked: Request, engine: Engine, target: Target
) -> Callable[[Engine, Iterable[float] | None], Analysis]:
    """What is asked of an engine like this one, at whatever speed and by whatever orders."""
    for_people = target.form in (Format.TABLE, Format.MARKDOWN)
    if asked.quantities is None:
        wanted = list(list_usual_quantities(engine))
        if not asked.over_speed:  # it is the same at all speeds
            wanted.append("sizing")
        if asked.whole and for_people:
            wanted.append("guide")
    else:
        wanted = list(asked.quantities)
        if "verdict" in asked.parts and engine.gas is not None and for_people:
            wanted += [ROLL.name, GAS.name]  # which order rocks the engine
    return partial(
        analyze,
        only=wanted,
        by_cylinder=asked.by_cylinder,
        reasons=asked.why,
        guide_height_m=asked.height_m,
    )


def _show_each(
    paths: Sequence[str],
    asked: Request,
    target: Target,
    find: Callable[[Engine], Found],
    renderer: Renderer[NamedResult[Found]],
) -> None:
    """Find something of every file and show it by the engines' names.

    Raises:
        Exit: with status 2, after the messages, if a file is bad.
    """
    view = View(asked.whole, asked.parts, asked.orders is not None)
    rpm = asked.speeds_rpm[0] if asked.speeds_rpm else None

    def find_one(path: str) -> tuple[str, str, Found]:
        engine = read_engine(path, rpm, asked.words).engine
        return engine.name, path, find(silence_cylinders(engine, asked.misfires, path))

    found, errors = try_each(paths, find_one)
    if found and not (errors and target.output):  # a file gets all of them or is left as it was
        engines, good, results = zip(*found, strict=True)
        named = zip(name_engines(engines, good), results, strict=True)
        show([NamedResult(*one, view) for one in named], renderer, *target)
    exit_on_errors(errors)

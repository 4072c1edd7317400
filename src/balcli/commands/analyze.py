"""`balcli analyze`"""

from __future__ import annotations

from typing import Annotated

import typer

from ..render.formats import Units
from ..render.view import View
from .file_names import text_format
from .options import (
    EnginePaths,
    FormatOption,
    GuideHeight,
    OnlyParts,
    Orders,
    Output,
    Speed,
    UnitsOption,
    Whole,
    parse_guide_height,
    parse_orders,
    parse_parts,
    parse_speed,
)
from .output import draws_sketch, show
from .overwrite_guard import refuse_overwriting


def analyze(
    paths: EnginePaths,
    form: FormatOption = None,
    speed: Speed = None,
    orders: Orders = None,
    only: OnlyParts = None,
    whole: Whole = False,
    by: Annotated[
        str,
        typer.Option(
            "--by",
            metavar="cylinder",
            help="cylinder: also each cylinder's share.",
            show_default=False,
        ),
    ] = "",
    why: Annotated[
        bool, typer.Option("--why", help="Also say whether each order is balanced by symmetry.")
    ] = False,
    guide_height: GuideHeight = None,
    units: UnitsOption = Units.SI,
    plot: Annotated[
        bool,
        typer.Option(
            "--plot",
            help="Also draw, with characters: bars by order and the loci of force and moment.",
        ),
    ] = False,
    output: Output = None,
) -> None:
    """Free forces and moments of an engine, order by order, and what balances them."""
    refuse_overwriting(reads=paths, writes={"--output": output})
    form = text_format(output, form)
    from ..render import analyses
    from ..results.analysis import Analysis, list_quantities
    from ..results.analysis import analyze as analyze_engine
    from .inputs import distinct_names, exit_on_errors, read_engine, try_each

    rpm, each = parse_speed(speed), _is_by_cylinder(by)
    height_m = parse_guide_height(guide_height, units)
    asked, (chosen, parts) = parse_orders(orders), parse_parts(only)

    def analyze_file(path: str) -> tuple[str, Analysis]:
        engine = read_engine(path, rpm, None if chosen is None else parts).engine
        wanted = (*list_quantities(engine), "sizing") if chosen is None else chosen
        return path, analyze_engine(engine, asked, wanted, each, why, height_m)

    found, errors = try_each(paths, analyze_file)
    if found and not (errors and output):  # a file gets all of them or is left as it was
        good, results = zip(*found, strict=True)
        names = distinct_names([result.engine.name for result in results], good)
        drawn = draws_sketch(plot, form)
        view = View(whole, parts, every_order=asked is not None, pictures=drawn)
        named = [analyses.NamedAnalysis(*one, view) for one in zip(names, results, strict=True)]
        show(named, analyses, form, output, units)
    exit_on_errors(errors)


def _is_by_cylinder(by: str) -> bool:
    """Whether --by asks for each cylinder's share.

    Raises:
        BadParameter: it asks for something else.
    """
    if by not in ("", "cylinder"):
        raise typer.BadParameter(f'"{by}": only "cylinder" can be chosen', param_hint="--by")
    return bool(by)

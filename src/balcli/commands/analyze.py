"""`balcli analyze`"""

from __future__ import annotations

from typing import Annotated

import typer

from ..render.formats import Format, Units
from .file_names import text_format
from .options import (
    EnginePaths,
    FormatOption,
    GuideHeight,
    Only,
    Orders,
    Output,
    Speed,
    UnitsOption,
    parse_guide_height,
    parse_orders,
    parse_quantities,
    parse_speed,
)
from .output import is_seen, show
from .overwrite_guard import refuse_overwriting


def analyze(
    paths: EnginePaths,
    form: FormatOption = None,
    speed: Speed = None,
    orders: Orders = None,
    only: Only = None,
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
            "--plot", help="In a terminal: also bars by order and the loci of force and moment."
        ),
    ] = False,
    output: Output = None,
) -> None:
    """Free forces and moments by order, couple, torque and roll, peaks, and what balances them."""
    refuse_overwriting(reads=paths, writes={"--output": output})
    form = text_format(output, form)
    from ..render import analyses
    from ..results.analysis import Analysis
    from ..results.analysis import analyze as analyze_engine
    from .inputs import distinct_names, exit_on_errors, read_engine, try_each

    if by not in ("", "cylinder"):
        raise typer.BadParameter(f'"{by}": only "cylinder" can be chosen', param_hint="--by")
    asked, chosen, rpm = parse_orders(orders), parse_quantities(only), parse_speed(speed)
    height_m = parse_guide_height(guide_height, units)

    def analyze_file(path: str) -> tuple[str, Analysis]:
        engine = read_engine(path, rpm, chosen).engine
        return path, analyze_engine(engine, asked, chosen, bool(by), why, height_m)

    found, errors = try_each(paths, analyze_file)
    if found and not (errors and output):  # a file gets all of them or is left as it was
        good, results = zip(*found, strict=True)
        names = distinct_names([result.engine.name for result in results], good)
        drawn = [plot and form is Format.TABLE and is_seen(output)] * len(results)
        named = list(map(analyses.NamedAnalysis, names, results, drawn))
        show(named, analyses, form, output, units)
    exit_on_errors(errors)

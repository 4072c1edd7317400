"""`balcli analyze`"""

from __future__ import annotations

from typing import Annotated

import typer

from ..render.formats import Format, Units
from .options import (
    EngineFiles,
    FormatOption,
    Only,
    Orders,
    Output,
    Speed,
    UnitsOption,
    checked_speed,
    only_list,
    order_list,
)


def analyze(
    files: EngineFiles,
    format: FormatOption = Format.TABLE,  # noqa: A002 (the option's name)
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
    units: UnitsOption = Units.SI,
    plot: Annotated[
        bool,
        typer.Option(
            "--plot", help="In a terminal: also bars by order and the loci of force and moment."
        ),
    ] = False,
    output: Output = None,
) -> None:
    """Free forces and moments by order, couple, inertia torque and roll, peaks, and what would
    balance them.
    """
    from ..render.formats import analyses
    from ..results.analysis import analyze as analyzed
    from .inputs import distinct, each, engine_of, tell
    from .output import emit

    if by not in ("", "cylinder"):
        raise typer.BadParameter(f'"{by}": only "cylinder" can be chosen', param_hint="--by")
    asked, chosen, rpm = order_list(orders), only_list(only), checked_speed(speed)
    found, errors = each(
        files,
        lambda file: (
            file,
            analyzed(engine_of(file, rpm)[1], asked, chosen, by_cylinder=bool(by), reasons=why),
        ),
    )
    if found and not (errors and output):  # a file gets all of them or is left as it was
        good, results = zip(*found, strict=True)
        names = distinct([result.engine.name for result in results], good)
        emit(
            analyses(results, names, format, units, into_file=output is not None, plot=plot), output
        )
    tell(errors)

"""`balcli sum`"""

from __future__ import annotations

from typing import Annotated

import typer

from .options import (
    EngineFile,
    Format,
    FormatOption,
    Orders,
    Output,
    Speed,
    Units,
    UnitsOption,
    checked_speed,
    order_list,
)


def sum(  # noqa: A001 (the command's name)
    first: EngineFile,
    second: EngineFile,
    phase: Annotated[
        float, typer.Option(metavar="DEG", help="Crank angle by which the second engine leads.")
    ] = 0.0,
    at: Annotated[
        str, typer.Option(metavar="X,Y,Z", help="Place of its origin in the first one's axes, mm.")
    ] = "0,0,0",
    turn: Annotated[float, typer.Option(metavar="DEG", help="How far it is turned about z.")] = 0.0,
    reverse: Annotated[
        bool, typer.Option("--reverse", help="Its crank turns against the first one's.")
    ] = False,
    load: Annotated[
        str,
        typer.Option(
            "--load",
            metavar="first|second|both",
            help=(
                "With --reverse: the crank that has flywheel and load, and so bears the inertia "
                "torque of both engines; both: each bears its own."
            ),
        ),
    ] = "first",
    speed: Speed = None,
    orders: Orders = None,
    format: FormatOption = Format.TABLE,  # noqa: A002 (the option's name)
    units: UnitsOption = Units.SI,
    output: Output = None,
) -> None:
    """Two engines on one frame, geared one to one: H, U and opposed-piston engines."""
    from ..render.formats import sums
    from ..results.two_engines import combine_engines
    from .arrangement_options import arrangement
    from .inputs import engine_of, named
    from .output import emit

    rpm, asked, placed = (
        checked_speed(speed),
        order_list(orders),
        arrangement(phase, at, turn, reverse, load),
    )
    engines = [named(engine_of(file, rpm)[1], file) for file in (first, second)]
    result = combine_engines(engines[0], engines[1], placed, asked)
    emit(sums(result, format, units, into_file=output is not None), output)

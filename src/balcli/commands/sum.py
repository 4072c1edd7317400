"""`balcli sum`"""

from __future__ import annotations

from typing import Annotated

import typer

from ..render.formats import Units
from .amounts import read_angle, read_lengths
from .file_names import text_format
from .options import (
    EnginePath,
    FormatOption,
    Orders,
    Output,
    Speed,
    UnitsOption,
    parse_orders,
    parse_speed,
)
from .output import refuse_overwriting, show

Phase = Annotated[
    str, typer.Option(metavar="DEG", help="Crank angle by which the second engine leads.")
]
At = Annotated[str, typer.Option(metavar="X,Y,Z", help="Place of the second engine's origin, mm.")]
Turn = Annotated[str, typer.Option(metavar="DEG", help="How far it is turned about z.")]
Reverse = Annotated[bool, typer.Option("--reverse", help="Its crank turns the other way.")]
LoadOption = Annotated[
    str, typer.Option(metavar="first|second|both", help="With --reverse: the crank with the load.")
]


def sum(  # noqa: A001 (the command's name)
    first: EnginePath,
    second: EnginePath,
    phase: Phase = "0",
    at: At = "0,0,0",
    turn: Turn = "0",
    reverse: Reverse = False,
    load: LoadOption = "first",
    speed: Speed = None,
    orders: Orders = None,
    form: FormatOption = None,
    units: UnitsOption = Units.SI,
    output: Output = None,
) -> None:
    """Two engines on one frame, geared one to one: H, U and opposed-piston engines.

    \b
    Example:
      balcli sum i4.toml i4.toml --phase 90 --at 300,0,0
    """
    refuse_overwriting(reads=[first, second], writes={"--output": output})
    form = text_format(output, form)
    from ..render.two_engines import RENDERER
    from ..results.two_engines import Arrangement, combine_engines
    from .inputs import named_by_file, read_engine

    rpm, asked = parse_speed(speed), parse_orders(orders)
    x, y, z = read_lengths("--at", at, "three numbers, X,Y,Z in mm, such as 0,300,0", 3, units)
    lead, turned = read_angle("--phase", phase), read_angle("--turn", turn)
    arrangement = Arrangement(lead, (x, y, z), turned, reverse, load)
    engines = [named_by_file(read_engine(path, rpm).engine, path) for path in (first, second)]
    result = combine_engines(engines[0], engines[1], arrangement, asked)
    show([result], RENDERER, form, output, units)

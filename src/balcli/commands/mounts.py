"""`balcli mounts`"""

from __future__ import annotations

from typing import Annotated

import typer

from ..enginefile.toml_text import name_file
from ..render.formats import Units
from .file_names import text_format
from .options import (
    EnginePath,
    FormatOption,
    Output,
    Scheme,
    UnitsOption,
    parse_orders,
)
from .output import show
from .overwrite_guard import refuse_overwriting
from .speed_range import Speeds, parse_speeds

Orders = Annotated[
    str | None,
    typer.Option(
        "--orders",
        metavar="1-8|1,2,4",
        show_default=False,
        help="Orders that count; default: all that are not negligible.",
    ),
]


def mounts(
    path: EnginePath,
    speeds: Speeds = None,
    orders: Orders = None,
    scheme: Scheme = None,
    form: FormatOption = None,
    units: UnitsOption = Units.SI,
    output: Output = None,
) -> None:
    """What the frame feels of an engine on its mounts: natural modes, rest, forces of the mounts
    and motion of points over a range of speeds.

    The file has [body], [[mount]] and, if motion of points is wanted, [[point]]; `balcli new
    mounts` writes one to start from. Without an engine in it, modes and rest are told.
    """
    refuse_overwriting(reads=[path], writes={"--output": output})
    form = text_format(output, form)
    rpm, asked = parse_speeds(speeds), parse_orders(orders)
    from ..mounting.read import read_mounted
    from ..mounting.report import report_mounts
    from ..render import mounts as renderer

    model, engine = read_mounted(path)
    result = report_mounts(model, engine, rpm, asked, scheme, name_file(path))
    show([result], renderer, form, output, units)

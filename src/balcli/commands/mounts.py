"""`balcli mounts`"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..enginefile.toml_text import name_file
from ..errors import warn
from ..render.formats import Units
from ..render.units import SYSTEMS
from .file_names import picture_form, text_format
from .options import (
    EnginePaths,
    FormatOption,
    Output,
    Scheme,
    UnitsOption,
    parse_orders,
)
from .output import show, write_file
from .overwrite_guard import refuse_overwriting
from .progress import reporting
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
    paths: EnginePaths,
    speeds: Speeds = None,
    orders: Orders = None,
    scheme: Scheme = None,
    plot: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            show_default=False,
            help="Draw forces over speed, orders and modes, and the body moving in each mode; "
            ".svg, .png or .pdf.",
        ),
    ] = None,
    form: FormatOption = None,
    units: UnitsOption = Units.SI,
    output: Output = None,
) -> None:
    """What the frame feels of an engine on its mounts: natural modes, rest, forces of the mounts
    and motion of points over a range of speeds.

    The file has [body], [[mount]] and, if motion of points is wanted, [[point]]; `balcli new
    mounts` writes one to start from. Without an engine in it, modes and rest are told. Engines of
    further files are put on the same mounts and shown beside.
    """
    refuse_overwriting(reads=paths, writes={"--output": output, "--plot": plot})
    form = text_format(output, form)
    drawn = picture_form(plot, "--plot") if plot is not None else None
    rpm, asked = parse_speeds(speeds), parse_orders(orders)
    from ..mounting.read import read_mounted
    from ..mounting.report import report_mounts
    from ..render import mounts as renderer
    from .inputs import name_columns, read_engine

    model, engine, doubts = read_mounted(paths[0])
    for doubt in doubts:
        warn(f"{name_file(paths[0])}: {doubt}")
    others = [read_engine(path).engine for path in paths[1:]]
    names = name_columns([model.name or paths[0], *(other.name for other in others)], paths)
    beside = list(zip(names[1:], others, strict=True))
    with reporting("work") as tell:
        result = report_mounts(model, engine, rpm, asked, scheme, beside, name_file(paths[0]), tell)
    if plot is not None and drawn is not None:
        from ..render.plot.mounts import draw_mounts  # brings matplotlib

        write_file(draw_mounts(result, drawn, SYSTEMS[units]), plot)
    show([result], renderer, form, output, units)

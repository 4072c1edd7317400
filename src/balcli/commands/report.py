"""`balcli report`"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..forces.kinds import KINDS
from ..render.formats import Units
from ..render.units import SYSTEMS
from .file_names import format_of, parse_output
from .options import EnginePath, Orders, Scheme, Speed, UnitsOption, parse_orders, parse_speed
from .output import emit
from .overwrite_guard import refuse_overwriting

Page = Annotated[
    Path,
    typer.Option(
        "--output",
        "-o",
        metavar="FILE.html",
        callback=parse_output,
        help="Write the page here; - is standard output.",
        show_default=False,
    ),
]


def report(
    path: EnginePath,
    output: Page,
    scheme: Scheme = "auto",
    speed: Speed = None,
    orders: Orders = None,
    units: UnitsOption = Units.SI,
) -> None:
    """Write one self-contained page: the engine in motion, what it shakes, and a balance scheme
    before and after.
    """
    refuse_overwriting(reads=[path], writes={"--output": output})
    format_of(output, None, {".html": "html", ".htm": "html"}, "html")
    from ..render.html import page
    from ..results.analysis import analyze
    from ..results.balance import balance
    from .inputs import read_engine

    asked = parse_orders(orders)
    engine = read_engine(path, parse_speed(speed)).engine
    result = analyze(engine, asked, {*KINDS, "peak"})
    balanced = balance(engine, scheme or "auto", orders=asked)
    emit(page(result, balanced, SYSTEMS[units]), output)

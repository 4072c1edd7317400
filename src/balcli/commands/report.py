"""`balcli report`"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..render.formats import Units
from .options import EngineFile, Orders, Scheme, Speed, UnitsOption, checked_speed, order_list

Page = Annotated[
    Path,
    typer.Option(
        "--output", "-o", metavar="FILE.html", help="Write the page here.", show_default=False
    ),
]


def report(
    file: EngineFile,
    output: Page,
    scheme: Scheme = "auto",
    speed: Speed = None,
    orders: Orders = None,
    units: UnitsOption = Units.SI,
) -> None:
    """Write one self-contained page: the engine in motion, what it shakes, and a balance scheme
    before and after.
    """
    from ..forces.kinds import KINDS
    from ..render.html import page
    from ..render.units import SYSTEMS
    from ..results.analysis import analyze
    from ..results.balance import balance
    from .inputs import engine_of
    from .output import emit

    asked = order_list(orders)
    _, engine = engine_of(file, checked_speed(speed))
    result = analyze(engine, asked, {*KINDS, "peak"})
    emit(page(result, balance(engine, scheme or "auto", orders=asked), SYSTEMS[units]), output)

"""`balcli plot`"""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from ..render.formats import Units
from ..render.units import SYSTEMS
from .file_names import choose_target, picture_form
from .options import (
    EnginePath,
    Orders,
    Scheme,
    Speed,
    Target,
    UnitsOption,
    parse_orders,
    parse_speed,
)
from .output import write_file
from .overwrite_guard import refuse_overwriting


class What(StrEnum):
    """Which pictures are drawn on the page."""

    ALL = "all"
    POLAR = "polar"
    ORDERS = "orders"
    SPECTRUM = "spectrum"
    CURVES = "curves"
    FACTOR = "factor"
    BANK = "bank"
    INNER = "inner"
    PRESSURE = "pressure"
    P_V = "p-v"
    TORQUE = "torque"
    PIN = "pin"
    MAIN = "main"
    MODES = "modes"
    CAMPBELL = "campbell"
    RESPONSE = "response"
    WATERFALL = "waterfall"


_TORSION = (What.MODES, What.CAMPBELL, What.RESPONSE, What.WATERFALL)

Picture = Annotated[
    Path | None,
    typer.Option(
        "--output", "-o", metavar="OUT", help="Write here; .svg, .png or .pdf.", show_default=False
    ),
]
Page = Annotated[
    What,
    typer.Option(
        "--what",
        help="polar: loci; orders: the two vectors of each; spectrum: bars; curves: over the "
        "crank angle; "
        "factor: over the balance factor; bank: a vee over its bank angle; inner: along the "
        "crankshaft; with [gas]: pressure, p-v, torque (with its surplus areas), pin and main "
        "(polar diagrams of bearing loads); modes, campbell, response, waterfall: of its torsion.",
    ),
]


def plot(
    path: EnginePath,
    target: Target = None,
    output: Picture = None,
    what: Page = What.ALL,
    scheme: Scheme = None,
    speed: Speed = None,
    orders: Orders = None,
    speeds: Annotated[
        str | None,
        typer.Option(
            metavar="A:B:STEP",
            show_default=False,
            help="Of torsion, rpm; default: half to one and a half times the file's speed.",
        ),
    ] = None,
    units: UnitsOption = Units.SI,
) -> None:
    """Draw free forces and moments: loci over a revolution, order by order, and over the crank
    angle; or torsional vibration.
    """
    refuse_overwriting(reads=[path], writes={"OUT": target, "--output": output})
    output = choose_target(target, output, "X.svg")
    form = picture_form(output)
    if what in _TORSION:
        from .torsion_answer import draw_file

        write_file(draw_file(path, what, speeds, orders, form), output)
        return
    from ..render.plot.pages import Subject, draw_page
    from ..studies.pictures import compute_study
    from .inputs import read_engine

    asked = parse_orders(orders)
    shown = {What.INNER: ("inner",), What.BANK: ("force",)}.get(what)
    engine = read_engine(path, parse_speed(speed), shown).engine
    subject = Subject(system=SYSTEMS[units], **compute_study(engine, what, asked, scheme)._asdict())
    write_file(draw_page(subject, what, form), output)

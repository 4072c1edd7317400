"""`balcli plot`"""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from ..render.formats import Units
from ..render.units import SYSTEMS
from . import scheme_options
from .declare import optional
from .file_names import choose_target, picture_form
from .options import (
    EnginePath,
    Orders,
    Speed,
    Target,
    UnitsOption,
    parse_orders,
    parse_speed,
)
from .output import write_file
from .overwrite_guard import refuse_overwriting
from .scheme_options import choose_beside, parse_scheme_options


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
    optional("OUT", "Write here; .svg, .png or .pdf.", "--output", "-o"),
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
    scheme: scheme_options.Scheme = None,
    order: scheme_options.Order = None,
    at: scheme_options.At = None,
    position: scheme_options.Position = None,
    planes: scheme_options.Planes = None,
    factor: scheme_options.Factor = None,
    measured: scheme_options.Measured = None,
    roll: scheme_options.Roll = None,
    speed: Speed = None,
    orders: Orders = None,
    speeds: Annotated[
        str | None,
        optional(
            "A:B:STEP", "Of torsion, rpm; default: half to one and a half times the file's speed."
        ),
    ] = None,
    units: UnitsOption = Units.SI,
) -> None:
    """Draw free forces and moments: loci over a revolution, order by order, and over the crank
    angle; or torsional vibration.

    \b
    Example:
      balcli plot v8.toml v8.svg
    """
    refuse_overwriting(reads=[path], writes={"OUT": target, "--output": output})
    output = choose_target(target, output, "X.svg")
    form = picture_form(output)
    options = parse_scheme_options(order, at, position, planes, factor, measured, roll, units)
    if what is not What.FACTOR:
        scheme = choose_beside(scheme, options)
    from ..studies.pictures import compute_study, refuse_scheme

    if what in _TORSION:
        from .torsion_answer import draw_file

        refuse_scheme(scheme, what)
        write_file(draw_file(path, what, speeds, orders, form), output)
        return
    from ..render.plot.pages import Subject, draw_page
    from .inputs import read_engine

    asked = parse_orders(orders)
    shown = {What.INNER: ("inner",), What.BANK: ("force",)}.get(what)
    engine = read_engine(path, parse_speed(speed), shown).engine
    study = compute_study(engine, what, asked, scheme, options)
    subject = Subject(system=SYSTEMS[units], **study._asdict())
    write_file(draw_page(subject, what, form), output)

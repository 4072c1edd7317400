"""`balcli plot`"""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from ..render.formats import Units
from .options import EngineFile, Orders, Scheme, Speed, UnitsOption, checked_speed, order_list


class What(StrEnum):
    """Which page."""

    ALL = "all"
    POLAR = "polar"
    ORDERS = "orders"
    SPECTRUM = "spectrum"
    CURVES = "curves"
    FACTOR = "factor"
    BANK = "bank"
    INNER = "inner"


Picture = Annotated[
    Path,
    typer.Option(
        "--output", "-o", metavar="FILE", help="Write here; .svg, .png or .pdf.", show_default=False
    ),
]
Page = Annotated[
    What,
    typer.Option(
        "--what",
        help="polar: loci; orders: the two vectors of each; spectrum: bars; curves: over the "
        "crank angle; "
        "factor: over the balance factor; bank: a vee over its bank angle; inner: along the "
        "crankshaft.",
    ),
]


def plot(
    file: EngineFile,
    output: Picture,
    what: Page = What.ALL,
    scheme: Scheme = None,
    speed: Speed = None,
    orders: Orders = None,
    units: UnitsOption = Units.SI,
) -> None:
    """Draw free forces and moments: loci over a revolution, order by order, and over the crank
    angle.
    """
    from ..render.plot.pages import Subject, form_of, picture
    from ..render.units import SYSTEMS
    from ..studies.pictures import study
    from .inputs import engine_of
    from .output import write

    form, asked = form_of(output), order_list(orders)
    _, engine = engine_of(file, checked_speed(speed))
    subject = Subject(system=SYSTEMS[units], **study(engine, what, asked, scheme)._asdict())
    write(picture(subject, what, form), output)

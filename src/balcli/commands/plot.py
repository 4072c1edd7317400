"""`balcli plot`"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..render.formats import Units
from . import scheme_options
from .declare import optional
from .file_names import choose_target, picture_form
from .options import EnginePath, Orders, Speed, Target, UnitsOption
from .output import refuse_overwriting
from .plot_pages import What, complete_pages, name_files, parse_pages, write_pages
from .scheme_options import parse_scheme_options

Picture = Annotated[
    Path | None, optional("OUT", "Write here; .svg, .png or .pdf.", "--output", "-o")
]
Pages = Annotated[
    str,
    typer.Option(
        "--what",
        metavar="PAGE,...",
        autocompletion=complete_pages,
        help="polar: loci; orders: the two vectors of each; spectrum: bars; curves: over the "
        "crank angle; all: these on one page; "
        "factor: over the balance factor; bank: the force of a vee over its bank angle; inner: "
        "along the crankshaft; with [gas]: pressure, p-v, torque (with its surplus areas), pin and "
        "main (polar diagrams of bearing loads); modes, campbell, response, waterfall: of its "
        "torsion. Several: pages of one PDF, or a file each (v8-pin.svg).",
    ),
]


def plot(
    path: EnginePath,
    target: Target = None,
    output: Picture = None,
    what: Pages = What.ALL.value,
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
    form, pages = picture_form(output), parse_pages(what)
    files = name_files(path, pages, output, form)
    options = parse_scheme_options(order, at, position, planes, factor, measured, roll, units)
    from .plot_figures import Asked, make_figures

    asked = Asked(speed, orders, speeds, scheme, options, units)
    write_pages(make_figures(path, pages, asked, form), files, form)

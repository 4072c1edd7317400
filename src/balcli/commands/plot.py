"""`balcli plot`"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..render.formats import Units
from ..render.plot.names import OF_TORSION, PAGES, check_page
from . import scheme_options
from .declare import optional
from .file_names import choose_target, picture_form
from .options import EnginePath, Orders, Speed, Target, UnitsOption
from .output import refuse_overwriting
from .scheme_options import parse_scheme_options


def complete_pages(typed: str) -> list[str]:
    """Return page names after the last comma of what was typed."""
    before, comma, _ = typed.rpartition(",")
    return [f"{before}{comma}{page}" for page in PAGES]


Picture = Annotated[
    Path | None, optional("OUT", "Write here; .svg, .png or .pdf.", "--output", "-o")
]
Pages = Annotated[
    str,
    typer.Option(
        "--what",
        metavar="PAGE,...",
        autocompletion=complete_pages,
        help="overview: locus of the force, or of the moment where no force is left, and spectrum; "
        "polar: loci; orders: the two vectors of each; spectrum: bars; curves: over the "
        "crank angle; all: loci, bars and curves on one page; "
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
    what: Pages = "overview",
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
    """Draw free forces and moments: the locus over a revolution and the spectrum of orders, or
    other pages (--what).

    \b
    Example:
      balcli plot v8.toml v8.svg
    """
    refuse_overwriting(reads=[path], writes={"OUT": target, "--output": output})
    output = choose_target(target, output, "X.svg")
    form, pages = picture_form(output), parse_pages(what)
    files = [output]  # of one page, and of a PDF
    if len(pages) > 1 and form != "pdf":
        files = [output.with_stem(f"{output.stem}-{page}") for page in pages]
    readings = len({page in OF_TORSION for page in pages})
    writes = dict(zip(map("--what {}".format, pages), files, strict=False))
    refuse_overwriting(reads=[path] * readings, writes=writes)
    options = parse_scheme_options(order, at, position, planes, factor, measured, roll, units)
    from .plot_figures import Asked, make_figures, write_pages

    asked = Asked(speed, orders, speeds, scheme, options, units)
    write_pages(make_figures(path, pages, asked), files, form)


def parse_pages(text: str) -> tuple[str, ...]:
    """Return the pages of `--what`, each once; raise BalcliError if there is no such page."""
    words = dict.fromkeys(word.strip().lower() for word in text.split(",") if word.strip())
    return tuple(check_page(word) for word in words or ("",))

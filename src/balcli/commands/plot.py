"""`balcli plot`"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..enginefile.fields import nearest
from ..errors import BalcliError
from ..render.formats import Units
from ..render.plot.names import OF_TORSION, PAGES
from . import scheme_options
from .declare import optional
from .file_names import choose_target, picture_form
from .options import EnginePath, Orders, Speed, Target, UnitsOption
from .output import refuse_overwriting
from .scheme_options import parse_scheme_options

if TYPE_CHECKING:
    from ..render.plot.style import Form


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
    files = _name_files(path, pages, output, form)
    options = parse_scheme_options(order, at, position, planes, factor, measured, roll, units)
    from .plot_figures import Asked, make_figures, write_pages

    asked = Asked(speed, orders, speeds, scheme, options, units)
    write_pages(make_figures(path, pages, asked), files, form)


def parse_pages(text: str) -> tuple[str, ...]:
    """Return the pages of `--what`, each once.

    Raises:
        BalcliError: there is no such page.
    """
    words = tuple(dict.fromkeys(word.strip().lower() for word in text.split(",") if word.strip()))
    for word in words or ("",):
        if word not in PAGES:
            near = nearest(word, PAGES)
            hint = f"; did you mean {near}?" if near else ""
            raise BalcliError(f'--what "{word[:60]}": choose from {", ".join(PAGES)}{hint}')
    return words


def _name_files(path: str, pages: tuple[str, ...], output: Path, form: Form) -> list[Path]:
    """Return the file of each page: `output` for one page and for a PDF, else a file with the name
    of the page at its end (`v8-pin.svg`).

    Raises:
        BalcliError: one is the engine file, or standard input would have to be read twice.
    """
    one = len(pages) == 1 or form == "pdf"
    files = [output] if one else [output.with_stem(f"{output.stem}-{page}") for page in pages]
    readings = len({page in OF_TORSION for page in pages})
    writes = dict(zip(map("--what {}".format, pages), files, strict=False))
    refuse_overwriting(reads=[path] * readings, writes=writes)
    return files

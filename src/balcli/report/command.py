"""The commands `balcli report` and `balcli plot`."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

from ..errors import BalcliError, is_quiet, say, warn
from ..file.toml import name_file
from ..shell import scheme_options
from ..shell.file_names import choose_target, format_of, parse_output, picture_form
from ..shell.inputs import read_engine
from ..shell.options import (
    EnginePath,
    Orders,
    Small,
    Speed,
    Target,
    UnitsOption,
    parse_orders,
    parse_speed,
)
from ..shell.output import emit, refuse_overwriting
from ..shell.scheme_options import choose_beside, choose_scheme, parse_scheme_options
from ..shell.values import optional
from ..show.formats import Units
from ..show.units import SYSTEMS
from .names import DRAWING, OF_TORSION, PAGES, check_page

PAGE = "File to write; - is standard output. Default: the engine's name and .html."
PICTURE = (
    "File to write; .svg, .png or .pdf, and .dxf for the outlines of webs. Default: the engine's "
    "name and .svg."
)
OPEN = "Show the page in the browser."
SPEEDS = "Speeds for torsion, rpm; default: 0.5 to 1.5 times the file's speed."
WHAT = (
    "overview: locus of the force (of the moment if the force is balanced), and spectrum; "
    "polar: loci; orders: forward and backward vector of each order; spectrum: bars; "
    "curves: values over the crank angle; all: loci, bars and curves on one page; "
    "ladder: loci with the devices of each balancing step; factor: peaks over the balance factor; "
    "bank: force of a vee over its bank angle, or distances of both shafts from the crank axis "
    "(--scheme two-shaft); inner: loads along the crankshaft; stars: vectors of all cylinders and "
    "their polygons; piston: travel, velocity and acceleration (with [gas], also side thrust and "
    "rod force); journals: torque in the main journals; webs: outline of each kind of web with the "
    "nearest piston, as .dxf the outlines alone; with [gas]: pressure, p-v, torque (with "
    "surplus areas), pin and main (polar diagrams of bearing loads); with [torsion]: modes, "
    "campbell, response, waterfall. A PDF contains all pages; otherwise each of several pages "
    "becomes a file (v8-pin.svg)."
)


def report(
    path: EnginePath,
    target: Target = None,
    output: Annotated[Path | None, optional("OUT.html", PAGE, "--output", "-o")] = None,
    scheme: scheme_options.Scheme = None,
    order: scheme_options.Order = None,
    at: scheme_options.At = None,
    position: scheme_options.Position = None,
    planes: scheme_options.Planes = None,
    factor: scheme_options.Factor = None,
    measured: scheme_options.Measured = None,
    roll: scheme_options.Roll = None,
    small: Small = None,
    speed: Speed = None,
    orders: Orders = None,
    cylinder: Annotated[int | None, optional("N", "Also show the motion of piston N.")] = None,
    show: Annotated[bool, typer.Option("--open", help=OPEN)] = False,
    units: UnitsOption = Units.SI,
) -> None:
    """Write a self-contained HTML page: the engine in motion, and its free forces and moments
    without and with a balance scheme.

    \b
    Example:
      balcli report v8.toml --open
    """
    named = target or output
    chosen = choose_target(target, output, path, ".html")
    refuse_overwriting(
        reads=[path], writes={"OUT": target, "--output": output if named else chosen}
    )
    output = parse_output(chosen)
    if output is None and show:
        raise BalcliError("--open needs a file")
    format_of(output, None, {".html": "html", ".htm": "html"}, "html")
    from . import live, page as pages

    options = parse_scheme_options(
        order, at, position, planes, factor, measured, roll, units, small
    )
    scheme = choose_scheme(scheme, options)
    asked = parse_orders(orders)
    text, model, engine = read_engine(path, parse_speed(speed))
    answers = pages.find_answers(model, engine, asked, scheme, options, name_file(path))
    system = SYSTEMS[units]
    share = options.read_small()
    name = name_file(path)
    book = live.describe_one(model, engine, text.decode(), name, share)
    emit(pages.page(answers._replace(cylinder=cylinder), system, book, name, share), output)
    if named is None:
        _tell_written([chosen])
    if show:
        _open_page(chosen)


def _tell_written(files: Sequence[Path]) -> None:
    """Print the names of files that were written under names that the user did not choose."""
    if not is_quiet():
        say(f"written: {', '.join(map(str, files))}")


def _open_page(file: Path) -> None:
    """Show a page in the browser; warn if there is none."""
    import webbrowser

    try:
        shown = webbrowser.open(file.resolve().as_uri())
    except webbrowser.Error:
        shown = False
    if not shown:
        warn(f"no browser was found for {file}")


def complete_pages(typed: str) -> list[str]:
    """Return completions of the page name after the last comma of the typed text."""
    before, comma, _ = typed.rpartition(",")
    return [f"{before}{comma}{page}" for page in PAGES]


def plot(
    path: EnginePath,
    target: Target = None,
    output: Annotated[Path | None, optional("OUT", PICTURE, "--output", "-o")] = None,
    what: Annotated[
        str, typer.Option(metavar="PAGE,...", autocompletion=complete_pages, help=WHAT)
    ] = "overview",
    scheme: scheme_options.Scheme = None,
    order: scheme_options.Order = None,
    at: scheme_options.At = None,
    position: scheme_options.Position = None,
    planes: scheme_options.Planes = None,
    factor: scheme_options.Factor = None,
    measured: scheme_options.Measured = None,
    roll: scheme_options.Roll = None,
    small: Small = None,
    speed: Speed = None,
    orders: Orders = None,
    speeds: Annotated[str | None, optional("A:B:STEP", SPEEDS)] = None,
    cylinder: Annotated[
        int | None, optional("N", "Cylinder of the page piston; default: 1.")
    ] = None,
    units: UnitsOption = Units.SI,
) -> None:
    """Draw free forces and moments: the locus over a revolution and the spectrum of orders, or
    other pages (--what).

    \b
    Example:
      balcli plot v8.toml v8.svg
    """
    named = target or output
    chosen = choose_target(target, output, path, ".svg")
    refuse_overwriting(
        reads=[path], writes={"OUT": target, "--output": output if named else chosen}
    )
    output = chosen
    pages = parse_pages(what)
    options = parse_scheme_options(
        order, at, position, planes, factor, measured, roll, units, small
    )
    _warn_of_idle(pages, speed, speeds, cylinder)
    if output.suffix.lower() == DRAWING:
        from .drawings import write_outlines

        files = write_outlines(path, output, pages, choose_beside(scheme, options))
        if files != [output]:
            _tell_written(files)
        return
    form = picture_form(output)
    files = [output]  # one page, or a PDF
    if len(pages) > 1 and form != "pdf":
        files = [output.with_stem(f"{output.stem}-{page}") for page in pages]
    readings = len({page in OF_TORSION for page in pages})
    writes = dict(zip(map("--what {}".format, pages), files, strict=False))
    refuse_overwriting(reads=[path] * readings, writes=writes)
    from .plot import Asked, make_figures, write_pages

    asked = Asked(speed, orders, speeds, cylinder, scheme, options, units)
    write_pages(make_figures(path, pages, asked), files, form)
    if named is None:
        _tell_written(files)


def _warn_of_idle(
    pages: Sequence[str], speed: str | None, speeds: str | None, cylinder: int | None
) -> None:
    """Warn of options that change none of these pages."""
    if cylinder is not None and "piston" not in pages:
        warn("--cylinder has an effect only on the page piston")
    of_torsion = {*pages}.intersection(OF_TORSION)
    if speeds is not None and not of_torsion:
        warn("--speeds has an effect only on pages of torsion; for other pages use --speed")
    if speed is not None and of_torsion.issuperset(pages):
        warn("--speed has no effect on pages of torsion; give a range, --speeds A:B")


def parse_pages(text: str) -> tuple[str, ...]:
    """Return the pages of `--what` without repetition; raise BalcliError for an unknown page."""
    words = dict.fromkeys(word.strip().lower() for word in text.split(",") if word.strip())
    return tuple(check_page(word) for word in words or ("",))

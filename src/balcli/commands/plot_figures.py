"""Draw the pages of `balcli plot`, and write them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from ..errors import warn
from ..render.formats import Units
from ..render.plot.names import OF_GAS, OF_TORSION
from ..render.plot.pages import PageSubject, make_page
from ..render.plot.style import save_figure, save_pages
from ..render.units import SYSTEMS
from ..sizing.options import SchemeOptions
from ..studies.pictures import compute_study, refuse_scheme
from .inputs import read_engine, require_gas
from .options import parse_orders, parse_speed
from .output import write_file
from .scheme_options import choose_beside
from .torsion_answer import make_figures_of_torsion

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..render.plot.style import Form

_SHOWN = {"inner": "inner", "bank": "force"}  # the only results that these pages need


class Asked(NamedTuple):
    """Options as typed; options of a balance scheme as they were read."""

    speed: str | None
    orders: str | None
    speeds: str | None
    scheme: str | None
    options: SchemeOptions
    units: Units


def make_figures(path: str, pages: Sequence[str], asked: Asked) -> list[Figure]:
    """Return a figure for each page of an engine file, which is read once for pages of torsion and
    once for all others.

    Raises:
        BalcliError: an option does not suit a page, or the file lacks what a page shows.
    """
    found: dict[str, Figure] = {}
    of_torsion = [page for page in pages if page in OF_TORSION]
    others = [page for page in pages if page not in OF_TORSION]
    if of_torsion:
        refuse_scheme(choose_beside(asked.scheme, asked.options), of_torsion[0])
        drawn = make_figures_of_torsion(path, of_torsion, asked.speeds, asked.orders, asked.units)
        found |= zip(of_torsion, drawn, strict=True)
    elif asked.speeds is not None:
        warn("--speeds counts for pages of torsion alone; the speed of the others is --speed")
    if others:
        found |= zip(others, _make_pages(path, others, asked), strict=True)
    elif asked.speed is not None:
        warn("--speed counts for nothing here; pages of torsion take a range, --speeds A:B")
    return [found[page] for page in pages]


def _make_pages(path: str, pages: Sequence[str], asked: Asked) -> list[Figure]:
    beside = choose_beside(asked.scheme, asked.options) if {*pages} != {"factor"} else None
    orders = parse_orders(asked.orders)
    shown = tuple(_SHOWN[page] for page in pages) if {*pages} <= {*_SHOWN} else None
    engine = read_engine(path, parse_speed(asked.speed), shown).engine
    if any(page in OF_GAS for page in pages):
        require_gas(engine, path)
    figures = []
    for page in pages:
        scheme = asked.scheme if page == "factor" else beside
        study = compute_study(engine, page, orders, scheme, asked.options)
        figures.append(make_page(PageSubject(study, SYSTEMS[asked.units]), page))
    return figures


def write_pages(figures: Sequence[Figure], files: Sequence[Path], form: Form) -> None:
    """Write all pages into one PDF, or each page into its own file.

    Raises:
        BalcliError: A file cannot be written.
    """
    if len(files) < len(figures):
        contents = [save_pages(figures)]
    else:
        contents = [save_figure(figure, form) for figure in figures]
    for content, file in zip(contents, files, strict=True):
        write_file(content, file)

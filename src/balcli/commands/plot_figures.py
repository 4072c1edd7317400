"""What `balcli plot` draws, as figures."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

from ..errors import warn
from ..render.formats import Units
from ..render.plot.pages import PageSubject, make_page
from ..render.units import SYSTEMS
from ..sizing.options import SchemeOptions
from ..studies.pictures import compute_study, refuse_scheme
from .inputs import read_engine, require_gas
from .options import parse_orders, parse_speed
from .plot_pages import OF_GAS, OF_TORSION, What, choose_shown
from .scheme_options import choose_beside
from .torsion_answer import make_figures_of_torsion

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..render.plot.style import Form


class Asked(NamedTuple):
    """Options as typed; those of a balance scheme as they were read."""

    speed: str | None
    orders: str | None
    speeds: str | None
    scheme: str | None
    options: SchemeOptions
    units: Units


def make_figures(path: str, pages: Sequence[What], asked: Asked, form: Form) -> list[Figure]:
    """A figure for each page, of the file at a path, which is read once for pages of its torsion
    and once for all others.

    Raises:
        BalcliError: what a page refuses, or does not find in the file.
    """
    found: dict[What, Figure] = {}
    of_torsion = [page for page in pages if page in OF_TORSION]
    others = [page for page in pages if page not in OF_TORSION]
    if asked.speeds is not None and not of_torsion:
        warn("--speeds counts for pages of torsion alone; the speed of the others is --speed")
    if asked.speed is not None and not others:
        warn("--speed counts for nothing here; pages of torsion take a range, --speeds A:B")
    if of_torsion:
        for page in of_torsion:
            refuse_scheme(_choose_scheme(page, asked), page)
        drawn = make_figures_of_torsion(
            path, of_torsion, asked.speeds, asked.orders, form, asked.units
        )
        found |= zip(of_torsion, drawn, strict=True)
    if others:
        found |= zip(others, _make_pages(path, others, asked, form), strict=True)
    return [found[page] for page in pages]


def _make_pages(path: str, pages: Sequence[What], asked: Asked, form: Form) -> list[Figure]:
    schemes = [_choose_scheme(page, asked) for page in pages]
    orders = parse_orders(asked.orders)
    engine = read_engine(path, parse_speed(asked.speed), choose_shown(pages)).engine
    if any(page in OF_GAS for page in pages):
        require_gas(engine, path)
    figures = []
    for page, scheme in zip(pages, schemes, strict=True):
        study = compute_study(engine, page, orders, scheme, asked.options)
        subject = PageSubject(study, SYSTEMS[asked.units])
        figures.append(make_page(subject, page, form))
    return figures


def _choose_scheme(page: What, asked: Asked) -> str | None:
    """The balance scheme that a page compares with."""
    if page is What.FACTOR:
        return asked.scheme
    return choose_beside(asked.scheme, asked.options)

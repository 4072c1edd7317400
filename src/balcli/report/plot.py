"""Draw an engine or a result (`plot`), and draw and write the pages of `balcli plot`."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from types import NoneType
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from ..analysis.answer import Analysis
from ..balancing.answer import Balance
from ..crank_torque.records import TorqueAnalysis
from ..engine.engine import Engine, take_model
from ..errors import check_number, check_type, wrong_type
from ..field_balancing.answer import FieldBalance
from ..field_balancing.show import make_field
from ..file.toml import name_file
from ..forces.spectrum import check_orders
from ..limits import SMALL
from ..mounting.plot import make_mounts
from ..mounting.records import MountReport
from ..shell.arguments import check_count, check_speeds, check_torsion_orders
from ..shell.inputs import read_engine, require_gas
from ..shell.options import parse_orders, parse_speed
from ..shell.output import write_file
from ..shell.scheme_options import choose_beside
from ..show.formats import Units
from ..show.plot_style import save_figure, save_pages
from ..show.units import SI, SYSTEMS
from ..sizing.options import SchemeOptions, check_small
from ..studies.sweep import Swept
from ..studies.sweep_show import check_drawable, make_sweep
from ..torsional_vibration.answer import TorsionAnalysis, TorsionQuestion, answer_question
from ..torsional_vibration.load import make_source
from ..torsional_vibration.plot import make_figures_of_torsion, make_torsion
from ..torsional_vibration.quantity import choose_torsion_speeds
from .drawings import warn_of_webs
from .names import OF_GAS, OF_TORSION, PAGES, check_page
from .pages import PageSubject, make_page
from .study import Study, compute_study, refuse_scheme

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..show.plot_style import Form


Shown: TypeAlias = (
    Engine | Analysis | Balance | Swept | TorqueAnalysis | TorsionAnalysis | MountReport
) | FieldBalance
_DRAWN = "give an Engine, or a result of analyze, balance, sweep, torque, torsion, mounts or field"


def plot(  # noqa: PLR0911 (one return for each kind of result)
    shown: Shown,
    what: str | None = None,
    *,
    orders: Iterable[float] | None = None,
    scheme: str | None = None,
    speeds: ArrayLike | None = None,
    small: float = SMALL,
    cylinder: int = 1,
) -> Figure:
    """Draw an engine or a result as a figure of matplotlib; see also `balcli plot`.

    The global state of matplotlib is unchanged, and no display is needed. A notebook shows the
    figure if the call is the last line of a cell; `figure.savefig("a.svg")` writes the figure;
    `figure.axes` can be changed.

    Args:
        shown: Engine, or result of a function such as `analyze` or `sweep`.
        what: Page of an engine, its analysis or balance: "overview" (default; one locus and the
            spectrum), "polar" (loci of force and moment), "orders" (two vectors of each order),
            "spectrum", "curves", "all" (loci, spectra and curves), "inner" (loads along the
            crankshaft), "ladder" (loci for each balancing step), "bank" (force of a vee over its
            bank angle; with scheme "two-shaft", distances of the shafts from the crank axis),
            "factor" (peaks over the balance factor), "stars" (each cylinder's vectors), "piston",
            "journals", "webs" (outlines of webs, with the nearest piston); with gas "pressure",
            "p-v", "torque", "pin", "main"; with torsion "modes", "campbell", "response",
            "waterfall". A result of `torque` has the pages with gas, a result of `torsion` those
            with torsion and "all". Other results have one picture.
        orders: Orders of an engine to draw; default: all that are not negligible.
        scheme: Balance scheme; the page compares the engine without and with its devices.
        speeds: Speeds for the pages of torsion, rpm; default: 0.5 to 1.5 times the engine's.
        small: Share of one cylinder's first order below which the ladder of an engine ignores a
            force or moment.
        cylinder: Number of the cylinder whose piston is drawn.

    Raises:
        BalcliError: There is no such picture; the error lists the existing ones.
        TypeError: `shown` has no picture.

    Example:
        >>> plot(load("v8.toml"), "polar").savefig("v8.png")
    """
    check_type("what", what, (str, NoneType), 'give the name of a page, such as "polar"')
    check_count("cylinder", cylinder)
    options = SchemeOptions(small=check_small(check_number("small", small, "give a share")))
    if isinstance(shown, Analysis):
        orders = shown.orders if orders is None else orders
        shown = shown.engine
    match shown:
        case Engine():
            page = what or "overview"
            return _plot_engine(shown, page, orders, scheme, options, speeds, cylinder)
        case Balance():
            study = Study(shown.after, shown.before, shown.remedy)
            return make_page(PageSubject(study), check_page(what or "overview", PAGES[:6]))
        case TorqueAnalysis(engine=Engine() as engine):
            return _plot_engine(engine, check_page(what or "torque", OF_GAS))
        case TorsionAnalysis():
            return _plot_torsion(shown, what or "all")
    check_page(what or "all", ("all",))
    match shown:
        case Swept():
            check_drawable(shown.sweep)
            return make_sweep(shown.sweep, shown.values)
        case MountReport():
            return make_mounts(shown, SI)
        case FieldBalance():
            return make_field(shown)
    raise wrong_type("plot", shown, _DRAWN)


def _plot_engine(
    engine: Engine,
    what: str,
    orders: Iterable[float] | None = None,
    scheme: str | None = None,
    options: SchemeOptions | None = None,
    speeds: ArrayLike | None = None,
    cylinder: int = 1,
) -> Figure:
    if check_page(what) not in OF_TORSION:
        asked = None if orders is None else check_orders(orders).tolist()
        study = compute_study(engine, what, asked, scheme, options)
        return make_page(PageSubject(study, cylinder=cylinder), what)
    exciting = check_torsion_orders(orders)
    source = make_source(take_model(engine), engine, engine.name, exciting)
    rpm = check_speeds("plot", speeds)
    if rpm is None and what in ("response", "waterfall"):
        rpm = np.asarray(choose_torsion_speeds(engine), dtype=float)
    return _plot_torsion(answer_question(source, TorsionQuestion(rpm)), what)


def _plot_torsion(result: TorsionAnalysis, what: str) -> Figure:
    known = ("all", *(OF_TORSION if hasattr(result, "response") else OF_TORSION[:2]))
    return make_torsion(result, check_page(what, known))


# Result that a page needs, as `asked` of `read_engine` names it.
_SHOWN = {"inner": "inner", "bank": "force", "ladder": "ladder"}


class Asked(NamedTuple):
    """Texts of the options, and the parsed options of a balance scheme."""

    speed: str | None
    orders: str | None
    speeds: str | None
    cylinder: int | None
    scheme: str | None
    options: SchemeOptions
    units: Units


def make_figures(path: str, pages: Sequence[str], asked: Asked) -> list[Figure]:
    """Return a figure for each page of an engine file. The file is read once for pages of torsion
    and once for all others.

    Raises:
        BalcliError: An option does not suit a page, or the file lacks data for a page.
    """
    figures: dict[str, Figure] = {}
    of_torsion = [page for page in pages if page in OF_TORSION]
    others = [page for page in pages if page not in OF_TORSION]
    if of_torsion:
        refuse_scheme(choose_beside(asked.scheme, asked.options), of_torsion[0])
        drawn = make_figures_of_torsion(path, of_torsion, asked.speeds, asked.orders, asked.units)
        figures |= zip(of_torsion, drawn, strict=True)
    if others:
        figures |= zip(others, _make_pages(path, others, asked), strict=True)
    return [figures[page] for page in pages]


def _make_pages(path: str, pages: Sequence[str], asked: Asked) -> Iterator[Figure]:
    beside = choose_beside(asked.scheme, asked.options) if {*pages} != {"factor"} else None
    orders = parse_orders(asked.orders)
    shown = tuple(_SHOWN[page] for page in pages) if {*pages} <= {*_SHOWN} else None
    engine = read_engine(path, parse_speed(asked.speed), shown).engine
    if any(page in OF_GAS for page in pages):
        require_gas(engine, path)
    if "webs" in pages and engine.webs is not None:
        warn_of_webs(engine, name_file(path))
    for page in pages:
        scheme = asked.scheme if page == "factor" else beside
        study = compute_study(engine, page, orders, scheme, asked.options)
        subject = PageSubject(study, SYSTEMS[asked.units], asked.cylinder or 1)
        yield make_page(subject, page)


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

"""`balcli.plot`"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from types import NoneType
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from ..engine.build import Engine, take_model
from ..enginefile.fields import nearest
from ..errors import BalcliError, check_type, wrong_type
from ..field_balancing.balance import FieldBalance
from ..forces.orders import check_orders
from ..mounting.report import MountReport
from ..render.plot import torsion as torsion_pages
from ..render.plot.field_balancing import make_field
from ..render.plot.mounts import make_mounts
from ..render.plot.pages import PAGES, PageSubject, make_page
from ..render.plot.torsion import make_torsion
from ..render.sweep_plot import check_drawable, make_sweep
from ..render.units import SI
from ..results.analysis import Analysis
from ..results.balance import Balance
from ..studies.pictures import Study, compute_study
from ..studies.swept import Swept
from ..torque.analysis import TorqueAnalysis
from ..torsion.analysis import TorsionAnalysis, TorsionQuestion, answer_question
from ..torsion.load import make_source
from ..torsion.quantity import choose_torsion_speeds
from .arguments import check_speeds, check_torsion_orders, tell_arguments

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_TORSION = tuple(name for name in torsion_pages.PAGES if name != "all")
_DRAWN = (
    "give an Engine, or an answer of analyze, balance, sweep, analyze_torque, analyze_torsion, "
    "analyze_mounts or balance_rotor"
)


@tell_arguments(speeds="speeds_rpm")
def plot(
    shown: Engine
    | Analysis
    | Balance
    | Swept
    | TorqueAnalysis
    | TorsionAnalysis
    | MountReport
    | FieldBalance,
    what: str | None = None,
    *,
    orders: Iterable[float] | None = None,
    scheme: str | None = None,
    speeds_rpm: ArrayLike | None = None,
) -> Figure:
    """Draw an engine or an answer, as `balcli plot` does, as a figure of matplotlib.

    Nothing global is touched and no display is needed: a notebook shows the figure where it is the
    last line of a cell, `figure.savefig("a.svg")` writes it, `figure.axes` can be changed.

    Args:
        shown: an engine, or the answer of a function that has a picture.
        what: of an engine, its analysis or balance: "all" (default), "polar" (loci of force and
            moment), "orders" (the two vectors of each), "spectrum", "curves", "inner" (along the
            crankshaft), "bank" (a vee over its bank angle), "factor" (over the balance factor);
            with gas "pressure", "p-v", "torque", "pin", "main"; of torsion "all", "modes",
            "campbell", "response", "waterfall". Other answers have one picture.
        orders: of an engine, which are drawn; default: all that are not negligible.
        scheme: of an engine, a balance scheme to compare with.
        speeds_rpm: of an engine and its torsion; default: half to one and a half times its speed.

    Raises:
        BalcliError: there is no such picture of it, with those that there are.
        TypeError: what has no picture.

    Example:
        >>> plot(load("v8.toml"), "polar").savefig("v8.png")
    """
    check_type("what", what, (str, NoneType), 'give the name of a page, such as "polar"')
    match shown:
        case Engine():
            return _plot_engine(shown, what or "all", orders, scheme, speeds_rpm)
        case Analysis():
            asked = shown.orders if orders is None else orders
            return _plot_engine(shown.engine, what or "all", asked, scheme, speeds_rpm)
        case Balance():
            page = _choose(what or "all", ("all", "polar", "orders", "spectrum", "curves"))
            study = Study(shown.after, shown.before, shown.remedy)
            return make_page(PageSubject(study), page, "png")
        case TorqueAnalysis():
            page = _choose(what or "torque", ("torque", "pressure", "p-v", "pin", "main"))
            return _plot_engine(shown.engine, page, None, None, None)
        case TorsionAnalysis():
            return _plot_torsion(shown, what or "all")
    _choose(what or "all", ("all",))
    match shown:
        case Swept():
            check_drawable(shown.sweep)
            return make_sweep(shown.sweep, shown.values, "png")
        case MountReport():
            return make_mounts(shown, "png", SI)
        case FieldBalance():
            return make_field(shown, "png")
    raise wrong_type("plot", shown, _DRAWN)


def _choose(what: str, known: Sequence[str]) -> str:
    """The page of this name.

    Raises:
        BalcliError: there is none, with those that there are.
    """
    if what not in known:
        near = nearest(str(what), known)
        hint = f"; did you mean {near}?" if near else ""
        raise BalcliError(f"plot: there is no {what!r} of it; choose from {', '.join(known)}{hint}")
    return what


def _plot_engine(
    engine: Engine,
    what: str,
    orders: Iterable[float] | None,
    scheme: str | None,
    speeds_rpm: ArrayLike | None,
) -> Figure:
    _choose(what, (*PAGES, *_TORSION))
    if what not in _TORSION:
        asked = None if orders is None else check_orders(orders).tolist()
        study = compute_study(engine, what, asked, scheme)
        return make_page(PageSubject(study), what, "png")
    exciting = check_torsion_orders(orders)
    source = make_source(take_model(engine), engine, engine.name, exciting)
    speeds = check_speeds("plot", speeds_rpm)
    if speeds is None and what in ("response", "waterfall"):
        speeds = np.asarray(choose_torsion_speeds(engine), dtype=float)
    return _plot_torsion(answer_question(source, TorsionQuestion(speeds, exciting)), what)


def _plot_torsion(result: TorsionAnalysis, what: str) -> Figure:
    known = torsion_pages.PAGES if result.response is not None else ("all", "modes", "campbell")
    return make_torsion(result, _choose(what, known), "png")

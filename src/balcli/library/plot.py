"""`balcli.plot`"""

from __future__ import annotations

from collections.abc import Iterable
from types import NoneType
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from ..engine.build import Engine, take_model
from ..errors import check_type, wrong_type
from ..field_balancing.balance import FieldBalance
from ..forces.orders import check_orders
from ..mounting.records import MountReport
from ..render.plot.field_balancing import make_field
from ..render.plot.mounts import make_mounts
from ..render.plot.names import OF_GAS, OF_TORSION, PAGES, check_page
from ..render.plot.pages import PageSubject, make_page
from ..render.plot.torsion import make_torsion
from ..render.sweep_plot import check_drawable, make_sweep
from ..render.units import SI
from ..results.analysis import Analysis
from ..results.balance import Balance
from ..studies.pictures import Study, compute_study
from ..studies.sweep import Swept
from ..torque.answer import TorqueAnalysis
from ..torsion.analysis import TorsionAnalysis, TorsionQuestion, answer_question
from ..torsion.load import make_source
from ..torsion.quantity import choose_torsion_speeds
from .arguments import check_speeds, check_torsion_orders, tell_arguments

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Shown: TypeAlias = (
    Engine | Analysis | Balance | Swept | TorqueAnalysis | TorsionAnalysis | MountReport
) | FieldBalance
_DRAWN = (
    "give an Engine, or an answer of analyze, balance, sweep, analyze_torque, analyze_torsion, "
    "analyze_mounts or balance_rotor"
)


@tell_arguments(speeds="speeds_rpm")
def plot(
    shown: Shown,
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
        what: page of an engine, its analysis or balance: "overview" (default: one locus, and the
            spectrum), "polar" (loci of force and moment), "orders" (the two vectors of each),
            "spectrum", "curves", "all" (these except orders), "inner" (along the crankshaft),
            "bank" (a vee over its bank angle), "factor" (over the balance factor); with gas
            "pressure", "p-v", "torque", "pin", "main"; of torsion "all", "modes", "campbell",
            "response", "waterfall". Other answers have one picture.
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
            return _plot_engine(shown, what or "overview", orders, scheme, speeds_rpm)
        case Analysis():
            asked = shown.orders if orders is None else orders
            return _plot_engine(shown.engine, what or "overview", asked, scheme, speeds_rpm)
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
    speeds_rpm: ArrayLike | None = None,
) -> Figure:
    if check_page(what) not in OF_TORSION:
        asked = None if orders is None else check_orders(orders).tolist()
        return make_page(PageSubject(compute_study(engine, what, asked, scheme)), what)
    exciting = check_torsion_orders(orders)
    source = make_source(take_model(engine), engine, engine.name, exciting)
    speeds = check_speeds("plot", speeds_rpm)
    if speeds is None and what in ("response", "waterfall"):
        speeds = np.asarray(choose_torsion_speeds(engine), dtype=float)
    return _plot_torsion(answer_question(source, TorsionQuestion(speeds, exciting)), what)


def _plot_torsion(result: TorsionAnalysis, what: str) -> Figure:
    known = ("all", *(OF_TORSION if result.response is not None else OF_TORSION[:2]))
    return make_torsion(result, check_page(what, known))

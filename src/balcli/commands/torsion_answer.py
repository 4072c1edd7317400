"""What `balcli torsion` does between its options and its output."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ..enginefile.toml_text import name_file
from ..errors import BalcliError, warn
from ..render.formats import Units
from ..render.plot.torsion import make_torsion
from ..render.units import SYSTEMS
from ..torsion.analysis import TorsionAnalysis, TorsionQuestion, answer_question
from ..torsion.load import ChainSource, Source, load_source
from ..torsion.quantity import choose_torsion_speeds
from ..torsion.write_damper import insert_damper
from .inputs import warn_each
from .progress import reporting
from .speed_range import parse_speeds
from .torsion_options import parse_half_orders

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def require_options(
    asked: TorsionQuestion, write: Path | None, plot: Path | None, what: str
) -> None:
    """Refuse options without those that they belong to.

    Raises:
        BalcliError: with the option that is missing.
    """
    if asked.damper is not None and asked.speeds_rpm is None:
        raise BalcliError(
            "--damper: give the range in which it is to help, such as --speeds 1000:2500"
        )
    if write is not None and asked.damper is None:
        raise BalcliError(
            "--write: writes a damper into the file; say which, such as --damper viscous"
        )
    if plot is None and what != "all":
        raise BalcliError(f"--what {what}: give --plot and a file for the picture")
    if _lacks_range(asked, what):
        raise _range_missing(what)


def _lacks_range(asked: TorsionQuestion, what: str) -> bool:
    """Whether a picture is over speed, and no range of speeds was given."""
    return asked.speeds_rpm is None and what in ("response", "waterfall")


def _range_missing(what: str) -> BalcliError:
    return BalcliError(f"--what {what}: give the range, such as --speeds 1000:2500")


def find_answer(
    path: str, asked: TorsionQuestion, misfires: Sequence[int], progress: bool
) -> tuple[Source, TorsionAnalysis]:
    """The file and what was asked about it."""
    source = load_source(path, asked.orders, misfires)
    warn_each(source.doubts, name_file(path))
    with reporting("work", at_once=progress) as tell:
        found = answer_question(source, asked, tell)
    for doubt in found.damper.doubts if found.damper is not None else ():
        warn(f"--damper: {doubt}")
    warn_each(found.doubts, name_file(path))
    return source, found


def write_damper(source: Source, result: TorsionAnalysis) -> str:
    """The text of the file with the damper that was sized."""
    if result.damper is None:
        raise BalcliError("--write: there is no damper to write")
    return insert_damper(source.text, result.damper.node, result.damper.damper)


def make_figures_of_torsion(
    path: str,
    pages: Sequence[str],
    speeds: str | None,
    orders: str | None,
    units: Units,
) -> list[Figure]:
    """Figures of the chain or engine at a path, one a page.

    Args:
        speeds: range, as typed; None: that of an engine's own speed.
    """
    asked = TorsionQuestion(parse_speeds(speeds), parse_half_orders(orders))
    source = load_source(path, asked.orders)
    without = [page for page in pages if _lacks_range(asked, page)]
    if without:
        if isinstance(source, ChainSource):
            raise _range_missing(without[0])
        asked = asked._replace(speeds_rpm=choose_torsion_speeds(source.engine))
    found = answer_question(source, asked)
    return [draw(found, page, units) for page in pages]


def draw(result: TorsionAnalysis, what: str, units: Units) -> Figure:
    """A page of pictures.

    Raises:
        BalcliError: there is no shaft whose torque could be drawn.
    """
    if what == "waterfall" and not result.system.shafts:
        raise BalcliError("--what waterfall: there is no shaft whose torque could be drawn")
    return make_torsion(result, what, SYSTEMS[units])

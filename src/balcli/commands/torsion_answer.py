"""The request of `balcli torsion`, and its answer."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..core.vibration import Real
from ..enginefile.toml_text import name_file
from ..enginefile.units import Dimension, Powers, convert
from ..errors import BalcliError, warn
from ..limits import HIGHEST_TORSION_ORDER
from ..render.formats import Units
from ..render.plot.torsion import make_torsion
from ..render.units import SYSTEMS
from ..torsion.analysis import HolzerAsked, TorsionAnalysis, TorsionQuestion, answer_question
from ..torsion.damper_sizing import DamperAsked
from ..torsion.load import ChainSource, Source, load_source
from ..torsion.quantity import choose_torsion_speeds
from ..torsion.write_damper import insert_damper
from .amounts import read_inertia
from .inputs import warn_each
from .options import read_orders
from .progress import reporting
from .speed_range import parse_speeds

if TYPE_CHECKING:
    from matplotlib.figure import Figure


_FREQUENCY = Dimension("rad/s", "a frequency", Powers(time=-1, angle=1), ("20 rad/s",))
_HERTZ = re.compile(r"\s*([0-9.eE+-]+)\s*Hz\s*")


def parse_half_orders(text: str | None) -> Real | None:
    """Orders of `0.5-8` (in steps of a half), `1-8` (whole ones), `1,2.5,4`.

    Raises:
        BalcliError: anything else, with the text.
    """
    if text is None:
        return None
    right = "give multiples of 0.5 such as 0.5-8 (halves too), 1-8 (whole ones) or 1,2.5,4"
    bounds = f"must rise, from above 0 to {HIGHEST_TORSION_ORDER} at most"
    found = read_orders(text, right, bounds, 0.5, HIGHEST_TORSION_ORDER)
    return np.array(sorted(set(found)), float)


def _parse_trial(text: str) -> HolzerAsked:
    """The number of a mode, or a trial frequency such as `20 rad/s`, `12 Hz` or `900 rpm`.

    Raises:
        BalcliError: anything else, with the text.
    """
    if re.fullmatch(r"[1-9]\d{0,5}", text.strip()):
        return HolzerAsked(int(text))
    right = 'give the number of a mode, or a frequency such as "20 rad/s", "12 Hz" or "900 rpm"'
    try:
        hertz = _HERTZ.fullmatch(text)
        turns = float(hertz[1]) * 2 * np.pi if hertz else convert(text, _FREQUENCY)
    except ValueError:
        raise BalcliError(f'--holzer "{text[:60]}": {right}') from None
    if not 0 < turns < 1e12:
        raise BalcliError(f'--holzer "{text[:60]}": {right}')
    return HolzerAsked(None, turns)


def parse_question(
    speeds: str | None,
    orders: str | None,
    holzer: list[str] | None,
    damper: str | None,
    damper_at: str | None,
    damper_inertia: str | None,
    units: Units = Units.SI,
) -> TorsionQuestion:
    """What the options of these names ask.

    Raises:
        BalcliError: one of them cannot be read, or says more of a damper that is not asked for.
    """
    asked = None
    if damper is not None:
        said = damper_inertia
        inertia = None if said is None else read_inertia("--damper-inertia", said, units)
        asked = DamperAsked(damper, damper_at, inertia)
    elif damper_at is not None or damper_inertia is not None:
        option = "--damper-inertia" if damper_at is None else "--damper-at"
        raise BalcliError(f"{option}: say which damper, such as --damper viscous")
    trials = tuple(map(_parse_trial, holzer or ()))
    return TorsionQuestion(parse_speeds(speeds), parse_half_orders(orders), trials, asked)


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

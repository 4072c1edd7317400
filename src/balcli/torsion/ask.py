"""Translate the options of `balcli torsion` into a request, and draw the pictures of a file."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..core.phases import RPM
from ..core.vibration import Real
from ..errors import BalcliError
from ..file.units import SPEED, convert
from ..limits import HIGHEST_TORSION_ORDER
from ..shell.options import read_orders
from ..shell.values import parse_speeds, read_inertia
from ..show.formats import Units
from ..show.units import SYSTEMS
from .answer import HolzerAsked, TorsionQuestion, answer_question
from .dampers import DamperAsked
from .load import load_source
from .plot import make_torsion
from .quantity import choose_torsion_speeds

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def parse_half_orders(text: str | None) -> Real | None:
    """Return the orders in a text: `0.5-8` in steps of a half, `1-8` in whole steps, or `1,2.5,4`.

    Raises:
        BalcliError: The text has another form.
    """
    if text is None:
        return None
    right = "give multiples of 0.5 such as 0.5-8 (with halves), 1-8 (whole ones) or 1,2.5,4"
    bounds = f"must rise, from above 0 to {HIGHEST_TORSION_ORDER} at most"
    found = read_orders(text, right, bounds, 0.5, HIGHEST_TORSION_ORDER)
    return np.array(sorted(set(found)), float)


def _parse_trial(text: str) -> HolzerAsked:
    """Return the number of a mode, or a trial frequency such as `20 rad/s`, `12 Hz` or `900 rpm`.

    Raises:
        BalcliError: The text has another form.
    """
    if re.fullmatch(r"[1-9]\d{0,5}", text.strip()):
        return HolzerAsked(int(text))
    right = 'give the number of a mode, or a frequency such as "20 rad/s", "12 Hz" or "900 rpm"'
    try:
        omega = convert(text, SPEED) * RPM
    except ValueError:
        omega = 0.0
    if not 0 < omega < 1e12:
        raise BalcliError(f'--holzer "{text[:60]}": {right}')
    return HolzerAsked(None, omega)


def parse_question(
    speeds: str | None,
    holzer: Sequence[str] = (),
    damper: str | None = None,
    damper_at: str | None = None,
    damper_inertia: str | None = None,
    units: Units = Units.SI,
) -> TorsionQuestion:
    """Return the request in these options.

    Raises:
        BalcliError: An option cannot be read.
    """
    heavy = damper_inertia
    inertia = None if heavy is None else read_inertia("--damper-inertia", heavy, units)
    trials = [_parse_trial(each) for each in holzer]
    sized = DamperAsked(damper, damper_at, inertia)
    return TorsionQuestion(parse_speeds(speeds), trials, sized)


def require_speeds(asked: TorsionQuestion, what: str) -> None:
    """Check that a picture over speed has a range of speeds.

    Raises:
        BalcliError: No range was given.
    """
    if asked.speeds_rpm is None and what in ("response", "waterfall"):
        raise BalcliError(f"--what {what}: give the range, such as --speeds 1000:2500")


def make_figures_of_torsion(
    path: str, pages: Sequence[str], speeds: str | None, orders: str | None, units: Units
) -> list[Figure]:
    """Return one figure for each page, of the chain or engine at a path.

    Args:
        path: File; - for standard input.
        pages: Names of the pictures.
        speeds: Range of speeds, as typed; None: the default range about an engine's own speed.
        orders: Orders of the excitation, as typed.
        units: System of units.
    """
    asked = parse_question(speeds)
    source = load_source(path, parse_half_orders(orders))
    missing = asked.speeds_rpm is None and {"response", "waterfall"} & {*pages}
    if missing and source.engine is not None:
        asked = asked._replace(speeds_rpm=choose_torsion_speeds(source.engine))
    for page in pages:
        require_speeds(asked, page)
    found = answer_question(source, asked)
    return [make_torsion(found, page, SYSTEMS[units]) for page in pages]

"""What the options of `balcli torsion` say."""

from __future__ import annotations

import re

import numpy as np

from ..core.vibration import Real
from ..enginefile.units import Dimension, Powers, convert
from ..errors import BalcliError
from ..limits import HIGHEST_TORSION_ORDER
from ..render.formats import Units
from ..torsion.analysis import HolzerAsked, TorsionQuestion
from ..torsion.damper_proposal import DamperAsked
from .amounts import read_inertia
from .options import read_orders
from .speed_range import parse_speeds

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

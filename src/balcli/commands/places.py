"""Where the second engine of `balcli sum` stands."""
from __future__ import annotations

import math
from typing import TYPE_CHECKING

from ..errors import BalcliError

if TYPE_CHECKING:
    from ..combined import Arrangement

MOST = 1e6                      # degrees; mm times 1000


def arrangement(phase: float, at: str, turn: float, reverse: bool) -> Arrangement:
    """From the options' text and numbers.

    Raises:
        BalcliError: a place that is not three numbers, or anything infinite.
    """
    from ..combined import Arrangement

    for option, value in (("--phase", phase), ("--turn", turn)):
        if not abs(value) <= MOST:
            raise BalcliError(f"{option} {value:g}: give an angle in degrees, up to {MOST:g}")
    return Arrangement(phase, _place(at), turn, reverse)


def _place(text: str) -> tuple[float, float, float]:
    try:
        x, y, z = (float(part) / 1e3 for part in text.split(","))
    except ValueError:
        raise BalcliError(f'--at "{text[:60]}": give three numbers, X,Y,Z in mm, such as 0,300,0') from None
    if not all(math.isfinite(v) and abs(v) <= MOST for v in (x, y, z)):
        raise BalcliError(f'--at "{text[:60]}": the places must be finite, up to {MOST:g} m')
    return x, y, z

"""Where the second engine of `balcli sum` stands."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..errors import BalcliError
from ..limits import FARTHEST_DEG, FARTHEST_M
from .options import numbers

if TYPE_CHECKING:
    from ..results.two_engines import Arrangement


def arrangement(phase: float, at: str, turn: float, reverse: bool) -> Arrangement:
    """From the options' text and numbers.

    Raises:
        BalcliError: a place that is not three numbers, or anything infinite.
    """
    from ..results.two_engines import Arrangement

    for option, value in (("--phase", phase), ("--turn", turn)):
        if not abs(value) <= FARTHEST_DEG:
            raise BalcliError(
                f"{option} {value:g}: give an angle in degrees, up to {FARTHEST_DEG:g}"
            )
    return Arrangement(phase, _place(at), turn, reverse)


def _place(text: str) -> tuple[float, float, float]:
    x, y, z = (
        v / 1e3 for v in numbers("--at", text, "three numbers, X,Y,Z in mm, such as 0,300,0", 3)
    )
    if max(map(abs, (x, y, z))) > FARTHEST_M:
        raise BalcliError(f'--at "{text[:60]}": the places may be up to {FARTHEST_M:g} m')
    return x, y, z

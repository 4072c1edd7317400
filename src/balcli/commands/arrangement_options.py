"""Where the second engine of `balcli sum` stands."""

from __future__ import annotations

from typing import TYPE_CHECKING, get_args

from ..errors import BalcliError
from ..limits import FARTHEST_DEG, FARTHEST_M
from .options import numbers

if TYPE_CHECKING:
    from ..results.two_engines import Arrangement, Load


def arrangement(phase: float, at: str, turn: float, reverse: bool, load: str) -> Arrangement:
    """From the options' text and numbers.

    Raises:
        BalcliError: a place that is not three numbers, anything infinite, an unknown load, or one
            that makes no difference.
    """
    from ..results.two_engines import Arrangement

    for option, value in (("--phase", phase), ("--turn", turn)):
        if not abs(value) <= FARTHEST_DEG:
            raise BalcliError(
                f"{option} {value:g}: give an angle in degrees, up to {FARTHEST_DEG:g}"
            )
    return Arrangement(phase, _place(at), turn, reverse, _load(load, reverse))


def _load(text: str, reverse: bool) -> Load:
    from ..results.two_engines import Load

    found: Load | None = next((name for name in get_args(Load) if name == text), None)
    if found is None:
        raise BalcliError(f'--load "{text[:60]}": choose from {", ".join(get_args(Load))}')
    if found != "first" and not reverse:
        raise BalcliError(
            f"--load {found}: cranks that turn alike roll the frame alike, whichever drives the "
            "load; it matters with --reverse"
        )
    return found


def _place(text: str) -> tuple[float, float, float]:
    x, y, z = (
        v / 1e3 for v in numbers("--at", text, "three numbers, X,Y,Z in mm, such as 0,300,0", 3)
    )
    if max(map(abs, (x, y, z))) > FARTHEST_M:
        raise BalcliError(f'--at "{text[:60]}": the places may be up to {FARTHEST_M:g} m')
    return x, y, z

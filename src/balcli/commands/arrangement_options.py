"""Where the second engine of `balcli sum` stands."""

from __future__ import annotations

from typing import get_args

from ..errors import BalcliError
from ..limits import FARTHEST_DEG, FARTHEST_M
from ..render.formats import Units
from ..results.two_engines import Arrangement, Load
from .amounts import read_angle, read_lengths


def parse_arrangement(
    phase: str, at: str, turn: str, reverse: bool, load: str, units: Units
) -> Arrangement:
    """From the options' texts.

    Args:
        phase: crank angle by which the second engine leads.
        at: place of its origin in the first engine's axes: three lengths.
        turn: how far it is turned about z.
        reverse: whether its crank turns against the first one's.
        load: first, second or both: which crank has flywheel and load.

    Raises:
        BalcliError: a place that is not three lengths, anything infinite, an unknown load, or one
            that makes no difference.
    """
    return Arrangement(
        _parse_angle("--phase", phase),
        _parse_place(at, units),
        _parse_angle("--turn", turn),
        reverse,
        _parse_load(load, reverse),
    )


def _parse_angle(option: str, text: str) -> float:
    value = read_angle(option, text)
    if not abs(value) <= FARTHEST_DEG:
        raise BalcliError(f"{option} {value:g}: give an angle in degrees, up to {FARTHEST_DEG:g}")
    return value


def _parse_load(text: str, reverse: bool) -> Load:
    found: Load | None = next((name for name in get_args(Load) if name == text), None)
    if found is None:
        raise BalcliError(f'--load "{text[:60]}": choose from {", ".join(get_args(Load))}')
    if found != "first" and not reverse:
        raise BalcliError(
            f"--load {found}: cranks that turn alike roll the frame alike, whichever drives the "
            "load; it matters with --reverse"
        )
    return found


def _parse_place(text: str, units: Units) -> tuple[float, float, float]:
    """x, y and z in m."""
    wanted = "three numbers, X,Y,Z in mm, such as 0,300,0"
    x, y, z = read_lengths("--at", text, wanted, 3, units)
    if max(map(abs, (x, y, z))) > FARTHEST_M:
        raise BalcliError(f'--at "{text[:60]}": the places may be up to {FARTHEST_M:g} m')
    return x, y, z

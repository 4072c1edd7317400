"""Where the second engine of `balcli sum` stands."""

from __future__ import annotations

from typing import cast

from ..render.formats import Units
from ..results.two_engines import Arrangement, Load, check_arrangement
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
        load: which crank has flywheel and load.

    Raises:
        BalcliError: an angle that is none, a place that is not three lengths; what cannot be, or
            makes no difference.
    """
    x, y, z = read_lengths("--at", at, "three numbers, X,Y,Z in mm, such as 0,300,0", 3, units)
    angles = read_angle("--phase", phase), read_angle("--turn", turn)
    how = Arrangement(angles[0], (x, y, z), angles[1], reverse, cast("Load", load))
    check_arrangement(how)
    return how

"""Pistons of plain slider-cranks by their lengths, for tests of gas."""

import numpy as np

from balcli.core.cylinder_pressure import GasPiston, pistons
from balcli.core.cylinders import Cylinders


def slider_crank_piston(radius: float, rod: float, bore: float, offset: float = 0.0) -> GasPiston:
    """The piston on a crank and a rod of these lengths, m, its axis this far off the shaft's."""
    nothing = np.zeros(1)
    single = Cylinders(
        axis_deg=nothing,
        pin_deg=nothing,
        starts=np.array([0]),
        first=0,
        z=nothing,
        radius=np.array([radius]),
        offset=np.array([offset]),
        lam=np.array([radius / rod]),
        eps=np.array([offset / rod]),
        reciprocating=nothing,
        rotating=nothing,
        couple=nothing,
    )
    (piston,) = pistons(single, np.pi / 4 * bore**2)
    return piston

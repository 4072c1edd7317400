"""Pistons of plain slider-cranks by their lengths, for tests of gas."""

import numpy as np

from balcli.core.cylinder_pressure import GasPiston, pistons
from balcli.core.cylinders import Cylinders


def slider_crank_piston(radius: float, rod: float, bore: float, offset: float = 0.0) -> GasPiston:
    """The piston on a crank and a rod of these lengths, m, its axis this far off the shaft's."""
    nothing = ("axis_deg", "pin_deg", "z", "reciprocating", "rotating", "couple")
    lengths = {"radius": radius, "offset": offset, "lam": radius / rod, "eps": offset / rod}
    arrays = {name: np.array([value]) for name, value in (dict.fromkeys(nothing, 0.0) | lengths).items()}
    single = Cylinders(starts=np.array([0]), first=0, **arrays)
    (piston,) = pistons(single, np.pi / 4 * bore**2)
    return piston

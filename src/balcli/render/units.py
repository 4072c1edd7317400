"""Units on the way out."""

from __future__ import annotations

from typing import NamedTuple

from ..enginefile import units
from ..forces.kinds import Kind

POUND, INCH = float(units.POUND), float(units.INCH)  # kg, m
POUND_FORCE = POUND * units.STANDARD_GRAVITY  # N


class Unit(NamedTuple):
    """A name, and how many SI units it is."""

    name: str
    size: float

    def of(self, value: float) -> float:
        """A value in SI units in this unit."""
        return value / self.size


class System(NamedTuple):
    """The units in which people read a result."""

    force: Unit
    moment: Unit
    unbalance: Unit
    mass: Unit
    length: Unit
    volume: Unit

    def unit(self, kind: Kind) -> Unit:
        """The unit of a kind of force or moment."""
        return self.force if kind.dimension == "force" else self.moment


SI = System(
    Unit("N", 1),
    Unit("N·m", 1),
    Unit("g·mm", 1e-6),
    Unit("kg", 1),
    Unit("mm", 1e-3),
    Unit("cm³", 1e-6),
)
IMPERIAL = System(
    Unit("lbf", POUND_FORCE),
    Unit("lbf·ft", POUND_FORCE * 12 * INCH),
    Unit("oz·in", POUND / 16 * INCH),
    Unit("lb", POUND),
    Unit("in", INCH),
    Unit("in³", INCH**3),
)
SYSTEMS = {"si": SI, "imperial": IMPERIAL}

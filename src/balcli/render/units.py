"""Units on the way out."""

from __future__ import annotations

import math
from typing import NamedTuple

from ..enginefile import units
from ..forces.kinds import Kind

POUND, INCH = float(units.POUND), float(units.INCH)  # kg, m


class Unit(NamedTuple):
    """A unit of what people read.

    Attributes:
        name: as it is written.
        size: how many SI units it is.
        larger: the unit in which people read large values.
        most: value in this unit from which on they do; 0: always, and this one is for programs.
    """

    name: str
    size: float
    larger: Unit | None = None
    most: float = math.inf

    def of(self, value: float) -> float:
        """A value in SI units in this unit."""
        return value / self.size

    def fit(self, largest: float) -> Unit:
        """The unit for values up to this one (SI; nan: not known): this one, or a larger."""
        if self.larger is not None and abs(largest) >= self.most * self.size:
            return self.larger.fit(largest)
        return self


class System(NamedTuple):
    """The units in which people read a result."""

    force: Unit
    moment: Unit
    unbalance: Unit
    mass: Unit
    length: Unit
    volume: Unit
    pressure: Unit
    stress: Unit
    energy: Unit
    power: Unit
    inertia: Unit

    def unit(self, kind: Kind) -> Unit:
        """The unit of a kind of force or moment."""
        return self.force if kind.dimension == "force" else self.moment

    def instead_of(self, name: str) -> Unit:
        """The unit that stands for the SI unit of this name; for rpm or degrees they themselves."""
        pairs = zip(SI, self, strict=True)
        return next((ours for si, ours in pairs if si.name == name), Unit(name, 1))


SI = System(
    Unit("N", 1, Unit("kN", 1e3), 5000),
    Unit("N·m", 1, Unit("kN·m", 1e3), 5000),
    Unit("g·mm", 1e-6, Unit("kg·m", 1), 1e6),
    Unit("kg", 1),
    Unit("mm", 1e-3),
    Unit("cm³", 1e-6, Unit("litres", 1e-3), 10_000),
    pressure=Unit("Pa", 1, Unit("bar", 1e5), 0),
    stress=Unit("Pa", 1, Unit("N/mm²", 1e6), 0),
    energy=Unit("J", 1, Unit("kJ", 1e3, Unit("MJ", 1e6), 5000), 5000),
    power=Unit("W", 1, Unit("kW", 1e3), 0),
    inertia=Unit("kg·m²", 1),
)
_LBF_FT = units.POUND_FORCE * 12 * INCH
_PSI = Unit("psi", units.POUND_FORCE / INCH**2)
IMPERIAL = System(
    Unit("lbf", units.POUND_FORCE),
    Unit("lbf·ft", _LBF_FT),
    Unit("oz·in", POUND / 16 * INCH),
    Unit("lb", POUND),
    Unit("in", INCH),
    Unit("in³", INCH**3),
    pressure=_PSI,
    stress=_PSI,
    energy=Unit("lbf·ft", _LBF_FT),
    power=Unit("hp", 550 * _LBF_FT),
    inertia=Unit("lb·in²", POUND * INCH**2),
)
HEAT_FLOW = Unit("W", 1, Unit("kW", 1e3, Unit("MW", 1e6), 5000), 5000)
SYSTEMS = {"si": SI, "imperial": IMPERIAL}


def unit_of_name(name: str) -> Unit:
    """The unit of this name, which gives way to a larger one if it is that of force or moment."""
    return next((unit for unit in (SI.force, SI.moment) if unit.name == name), Unit(name, 1))


def name_with_unit(name: str, unit: str) -> str:
    """`operation.speed, rpm`: a column or an axis with its unit, if it has one."""
    return f"{name}, {unit}" if unit else name

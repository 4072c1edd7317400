"""Define the units of shown results: SI and imperial, with larger units for large values."""

import math
from collections.abc import Iterable
from typing import NamedTuple

from ..file import units
from ..forces.kinds import Kind

POUND = float(units.POUND)
INCH = float(units.INCH)  # kg, m


class ShownUnit(NamedTuple):
    """A unit in tables, pictures or CSV.

    Attributes:
        name: Name as it is written.
        size: Size in SI units.
        larger: Unit for large values.
        most: Value in this unit from which `larger` is used; 0: always, so that tables do not
            show this unit.
    """

    name: str
    size: float
    larger: "ShownUnit | None" = None
    most: float = math.inf

    def of(self, value: float) -> float:
        """Convert a value from the SI unit to this unit."""
        return value / self.size

    def fit(self, largest: float) -> "ShownUnit":
        """Return this or a larger unit to fit values up to `largest` (SI; nan if unknown)."""
        if self.larger is not None and abs(largest) >= self.most * self.size:
            return self.larger.fit(largest)
        return self

    def fit_values(self, values: Iterable[float | None]) -> "ShownUnit":
        """Return this or a larger unit to fit the largest of some values, SI. Values that are
        None or not finite do not count.
        """
        largest = 0.0
        for value in values:
            if value is not None and math.isfinite(value):
                largest = max(largest, abs(value))
        return self.fit(largest)


class System(NamedTuple):
    """The units of a result in tables and pictures. `heat` is the unit of the heat flow in dampers,
    `scales` that of small masses, as the scales of a balancing shop show them.
    """

    force: ShownUnit
    moment: ShownUnit
    unbalance: ShownUnit
    mass: ShownUnit
    length: ShownUnit
    volume: ShownUnit
    pressure: ShownUnit
    stress: ShownUnit
    energy: ShownUnit
    power: ShownUnit
    inertia: ShownUnit
    heat: ShownUnit
    scales: ShownUnit
    velocity: ShownUnit

    @property
    def torsional_stiffness(self) -> ShownUnit:
        """Unit of moment over angle."""
        return ShownUnit(f"{self.moment.name}/rad", self.moment.size)

    @property
    def torsional_damping(self) -> ShownUnit:
        """Unit of moment over angular velocity."""
        return ShownUnit(f"{self.moment.name}·s/rad", self.moment.size)

    @property
    def of_parts(self) -> dict[str, ShownUnit]:
        """Units of masses, moments of inertia and lengths of machine parts, by the SI unit."""
        mass = self.mass
        inertia = self.inertia
        if self is SI:
            mass = ShownUnit("g", 1e-3)
            inertia = ShownUnit("kg·mm²", 1e-6)
        return {"kg": mass, "kg·m²": inertia, "m": self.length}

    @property
    def end_volume(self) -> ShownUnit:
        """Unit of the swept volume of a compressor end."""
        return ShownUnit("litre", 1e-3) if self is SI else self.volume

    @property
    def flow(self) -> ShownUnit:
        """Unit of the capacity of a compressor."""
        return (
            ShownUnit("m³/h", 1 / 3600) if self is SI else ShownUnit("cfm", (12 * INCH) ** 3 / 60)
        )

    def unit(self, kind: Kind) -> ShownUnit:
        """Return the unit of a kind of force or moment."""
        return self.force if kind.dimension == "force" else self.moment

    def instead_of(self, name: str) -> ShownUnit:
        """Return this system's unit in place of the SI unit with this name; other units (rpm, deg)
        are kept.
        """
        for of_si, ours in zip(SI, self, strict=True):
            if of_si.name == name:
                return ours
        return ShownUnit(name, 1)


SI = System(
    ShownUnit("N", 1, ShownUnit("kN", 1e3), 5000),
    ShownUnit("N·m", 1, ShownUnit("kN·m", 1e3), 5000),
    ShownUnit("g·mm", 1e-6, ShownUnit("kg·m", 1), 1e6),
    ShownUnit("kg", 1),
    ShownUnit("mm", 1e-3),
    ShownUnit("cm³", 1e-6, ShownUnit("litres", 1e-3), 10_000),
    pressure=ShownUnit("Pa", 1, ShownUnit("bar", 1e5), 0),
    stress=ShownUnit("Pa", 1, ShownUnit("N/mm²", 1e6), 0),
    energy=ShownUnit("J", 1, ShownUnit("kJ", 1e3, ShownUnit("MJ", 1e6), 5000), 5000),
    power=ShownUnit("W", 1, ShownUnit("kW", 1e3), 0),
    inertia=ShownUnit("kg·m²", 1),
    heat=ShownUnit("W", 1, ShownUnit("kW", 1e3, ShownUnit("MW", 1e6), 5000), 5000),
    scales=ShownUnit("g", 1e-3),
    velocity=ShownUnit("km/h", 1 / 3.6),
)
_LBF_FT = units.POUND_FORCE * 12 * INCH
_PSI = ShownUnit("psi", units.POUND_FORCE / INCH**2)
_HP = ShownUnit("hp", 550 * _LBF_FT)
IMPERIAL = System(
    ShownUnit("lbf", units.POUND_FORCE),
    ShownUnit("lbf·ft", _LBF_FT),
    ShownUnit("oz·in", POUND / 16 * INCH),
    ShownUnit("lb", POUND),
    ShownUnit("in", INCH),
    ShownUnit("in³", INCH**3),
    pressure=_PSI,
    stress=_PSI,
    energy=ShownUnit("lbf·ft", _LBF_FT),
    power=_HP,
    inertia=ShownUnit("lb·in²", POUND * INCH**2),
    heat=_HP,
    scales=ShownUnit("oz", POUND / 16),
    velocity=ShownUnit("mph", 5280 * 12 * INCH / 3600),
)
SYSTEMS = {"si": SI, "imperial": IMPERIAL}


def unit_of_name(name: str) -> ShownUnit:
    """Return the unit with this name. Units of force, moment and stress have larger units for large
    values.
    """
    for unit in (SI.force, SI.moment, SI.stress):
        if unit.name == name:
            return unit
    return ShownUnit(name, 1)


def name_with_unit(name: str, unit: str) -> str:
    """Return the name of a column or axis with its unit, such as `operation.speed, rpm`.

    Args:
        name: Name.
        unit: Unit; may be empty.
    """
    return f"{name}, {unit}" if unit else name

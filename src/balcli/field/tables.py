"""Tables of a file of runs, with readings as amplitude @ phase and weights as amount @ angle.

Readings may have any unit; the unit of weights is `weight_unit`. Lengths are in mm, speeds in rpm,
the mass of the rotor in kg, angles in degrees.
"""

from __future__ import annotations

import cmath
import math
import re
from contextlib import suppress
from typing import TYPE_CHECKING, Annotated, Literal, TypeVar

from pydantic import Field

from ..core.records import Node
from ..file.fields import Label, Number, OneOf, shorten
from ..file.table import FileTable, Name, Size, Speed, Switch
from ..file.units import ANGLE, BARE_FIGURE, MASS, PLAIN, UNBALANCE, Dimension, Unit, read_unit
from ..limits import LONGEST_FIGURE, MOST_BALANCING_PLANES, MOST_PLACES, MOST_RUNS, MOST_SENSORS

if TYPE_CHECKING:
    from ..core.phasors import Complex

_GRADE = re.compile(rf"\s*[Gg]\s*({BARE_FIGURE})\s*", re.ASCII)
_POLAR = re.compile(rf"\s*({BARE_FIGURE})\s*@\s*({BARE_FIGURE})\s*(?:deg|°)?\s*", re.ASCII)
_FARTHEST_DEG = 1e6
FREE = "free"  # value of `places` for a plane that takes weights at any angle
_AMOUNTS = Dimension("g", "a unit of mass or of unbalance", ("g", "oz", "g mm"))


class Grade(Number):
    """A balance quality grade of ISO 21940-11: `6.3` or `"G6.3"`."""

    def __init__(self) -> None:
        super().__init__(PLAIN, above=0, most=1e5)

    def read(self, value: object) -> float:
        short = isinstance(value, str) and len(value) <= LONGEST_FIGURE
        match = _GRADE.fullmatch(value) if isinstance(value, str) and short else None
        return super().read(float(match[1]) if match else value)

    def json(self) -> Node:
        return super().json() | {"type": ["number", "string"], "pattern": rf"^{_GRADE.pattern}$"}


class Polar(Number):
    """A complex number written as amplitude and angle in degrees: `"170 @ 112"`.

    Args:
        example: Valid value, for messages.
        zero: Whether the amplitude may be 0.
    """

    def __init__(self, example: str, *, zero: bool) -> None:
        super().__init__(PLAIN)
        self.example, self.zero = example, zero

    def read(self, value: object) -> complex:  # type: ignore[override]
        text = value if isinstance(value, str) and len(value) <= LONGEST_FIGURE else ""
        match = _POLAR.fullmatch(text)
        if match is None:
            raise ValueError(
                f"{shorten(value)} is not an amplitude @ angle in degrees; write it like "
                f'"{self.example}", without a unit'
            )
        amplitude, angle = map(float, match.groups())
        if amplitude == 0 and not self.zero:
            raise ValueError(
                f"{shorten(value)} is a weight of 0, which has no effect; give the weight that was "
                "on, or leave the plane out"
            )
        if not (amplitude == 0 or 1e-12 <= amplitude <= 1e12) or abs(angle) > _FARTHEST_DEG:
            raise ValueError(
                f"{shorten(value)} is too large or small; amplitudes are 0 or 1e-12 to 1e+12, "
                f"angles up to {_FARTHEST_DEG:g} degrees; turn the angle by 180 in place of a minus"
            )
        return make_polar(amplitude, angle)

    def json(self) -> Node:
        return {"type": "string", "pattern": rf"^{_POLAR.pattern}$"}


def make_polar(amplitude: float, angle_deg: float) -> complex:
    """Return the complex number. It is exact at multiples of 90 degrees, frequent angles of trial
    weights.
    """
    quarter, rest = divmod(angle_deg, 90)
    turned = cmath.rect(amplitude, math.radians(rest)) if rest else complex(amplitude)
    return turned * (1, 1j, -1, -1j)[int(quarter) % 4]


class AmountUnit(Label):
    """A unit of mass, or of mass times radius."""

    def read(self, value: object) -> str:
        name = super().read(value)
        with suppress(ValueError):
            if read_amount_unit(name).powers in (MASS.powers, UNBALANCE.powers):
                return name
        raise ValueError(
            f"{shorten(value)} is no unit of weights; write g, kg, oz or lb, or of unbalances "
            "g mm or oz in"
        )


class PlaceAngles(Number):
    """Angles at which a plane takes weights, deg: a list, a number of equally spaced places, or
    "free" for any angle (an empty tuple).
    """

    def __init__(self) -> None:
        super().__init__(ANGLE, most=_FARTHEST_DEG)

    def read(self, value: object) -> tuple[float, ...]:  # type: ignore[override]
        if value == FREE:
            return ()
        if isinstance(value, int) and not isinstance(value, bool) and 1 <= value <= MOST_PLACES:
            return tuple(360 * k / value for k in range(value))
        if isinstance(value, list) and 1 <= len(value) <= MOST_PLACES:
            return tuple(super(PlaceAngles, self).read(angle) for angle in value)
        raise ValueError(
            f"{shorten(value)} is no list of places; give the number of equally spaced places (up "
            f'to {MOST_PLACES}), a list of their angles, or "{FREE}" for any angle'
        )

    def json(self) -> Node:
        count = {"type": "integer", "minimum": 1, "maximum": MOST_PLACES}
        angles = {"type": "array", "items": super().json(), "minItems": 1, "maxItems": MOST_PLACES}
        return {"anyOf": [count, angles, {"const": FREE}]}


def read_amount_unit(name: str) -> Unit:
    """Return the unit of a weight; ValueError if it is unknown."""
    return read_unit(name, _AMOUNTS)


T = TypeVar("T")
Weights = TypeVar("Weights", complex, "Complex")
ByPlane = Annotated[tuple[T, ...], Field(min_length=1, max_length=MOST_BALANCING_PLANES)]
BySensor = Annotated[tuple[T, ...], Field(min_length=1, max_length=MOST_SENSORS)]
Reading = Annotated[complex, Polar("170 @ 112", zero=True)]
Weight = Annotated[complex, Polar("1.15 @ 0", zero=False)]
Coefficient = Annotated[complex, Polar("0.0155 @ 113", zero=True)]
Amount = Annotated[float, Number(PLAIN, above=0, most=1e9)]
Factor = Annotated[float, Number(PLAIN, least=1e-6, most=1e6)]
Places = Annotated[tuple[float, ...], PlaceAngles()]
Sense = Literal["with", "against"]
_PHASES = "lag: phases count against rotation, as most instruments do; lead: with it"
_ANGLES = "with: their angles go the way the rotor turns; against: the other way"


class Run(FileTable):
    """One run of the machine."""

    name: Name | None = None
    """Name of the run. Example: 'trial front'"""
    readings: BySensor[Reading]
    """Amplitude @ phase in degrees of every sensor, in the same order in every run. Example:
    ['170 @ 112', '53 @ 78']"""
    weights: dict[str, Weight] = Field(default_factory=dict)
    """Weights put on for this run: amount @ angle in degrees, by plane; none: the rotor as found.
    Example: { front = '1.15 @ 0' }"""
    keep_trial: Switch = False
    """Whether these weights stay on in the later runs at this speed. Example: true"""
    speed: Speed | None = None
    """Speed of this run; each speed is a series of its own. Example: 1500"""


class RunsFile(FileTable):
    """Readings of a rotor with and without trial weights."""

    name: Name | None = None
    """Name of the rotor. Example: 'fan 3'"""
    planes: ByPlane[Name]
    """Names of the planes that take weights. Example: ['front', 'rear']"""
    sensors: BySensor[Name] | None = None
    """Names of the sensors. Example: ['front x', 'rear x']"""
    rotation: Annotated[str, OneOf("lag", "lead", meaning=_PHASES)] = "lag"
    """Phases of readings count against rotation (lag) or with it (lead). Example: 'lag'"""
    weights: Annotated[Sense, OneOf("with", "against", meaning=_ANGLES)] | None = None
    """Angles of weights count with or against rotation; left out: the same way as the phases of
    readings. Example: 'with'"""
    unit: Name | None = None
    """Unit of the readings, for printing. Example: 'um'"""
    weight_unit: Annotated[str, AmountUnit()] = "g"
    """Unit of the weights: of mass, or of mass times radius. Example: 'g'"""
    reading_weights: BySensor[Factor] | None = None
    """Weight of each sensor in the fit; left out: equal weights. Example: [1, 2]"""
    influence: BySensor[ByPlane[Coefficient]] | None = None
    """Known influence coefficients: a row for each reading (of each speed), with the change of the
    reading per unit of weight for each plane. Example: [['0.0155 @ 113', '0.009 @ 10']]"""
    radius: ByPlane[Size] | None = None
    """Radius of the weights, or of the rim, by plane. Example: [200, 200]"""
    most: ByPlane[Amount] | None = None
    """Largest weight of a plane, or at one of its places, by plane. Example: [40, 40]"""
    places: ByPlane[Places] | None = None
    """Places that take weights, by plane: a number of places, evenly spaced from 0 on; a list of
    angles; or "free" for any angle. Example: [12, [0, 30, 60]]"""
    drill: ByPlane[Size] | None = None
    """Diameter of radial holes that remove steel from the rim, opposite to the weight, by plane.
    Example: [12, 12]"""
    deepest: ByPlane[Size] | None = None
    """Deepest hole, by plane. Example: [25, 25]"""
    grade: Annotated[float, Grade()] | None = None
    """Balance quality grade G of ISO 21940-11, mm/s. Example: 6.3"""
    mass: Annotated[float, Number(MASS, above=0, most=1e9)] | None = None
    """Mass of the rotor. Example: 120"""
    speed: Speed | None = None
    """Service speed, for which the permitted unbalance is computed. Example: 3000"""
    shares: ByPlane[Factor] | None = None
    """Shares of the permitted unbalance, by plane; left out: equal ones. Example: [0.4, 0.6]"""
    run: Annotated[tuple[Run, ...], Field(min_length=1, max_length=MOST_RUNS)]
    """The runs, in their order."""

    @property
    def weighs_masses(self) -> bool:
        """Whether weights are masses; otherwise they are unbalances."""
        return read_amount_unit(self.weight_unit).powers == MASS.powers

    @property
    def senses(self) -> tuple[Sense, Sense]:
        """Senses, relative to rotation, of phases of readings and of angles of weights."""
        phases: Sense = "against" if self.rotation == "lag" else "with"
        return phases, self.weights or phases

    def turn(self, weights: Weights) -> Weights:
        """Return weights converted from the sense of the file to that of the readings, or back."""
        phases, angles = self.senses
        return weights if phases == angles else weights.conjugate()

    def name_run(self, k: int) -> str:
        """Return the name of the run with the index k, or its number."""
        return self.run[k].name or f"run {k + 1}"

    def find_unbalance_per_weight(self, k: int) -> float | None:
        """Return the unbalance of one unit of weight in plane k, kg m; None if the radius is
        unknown.
        """
        scale = float(read_amount_unit(self.weight_unit).scale)
        if not self.weighs_masses:
            return scale
        return scale * self.radius[k] / 1e3 if self.radius else None

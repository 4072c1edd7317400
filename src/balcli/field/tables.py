"""Tables of a file of runs: readings as amplitude and phase, weights as amount and angle.

Readings keep the unit in which they were read, weights the unit of the file (`weight_unit`).
Lengths are in mm, speeds in rpm, the mass of the rotor in kg, angles in degrees.
"""

from __future__ import annotations

import cmath
import math
import re
from contextlib import suppress
from typing import TYPE_CHECKING, Annotated, Any, Literal, TypeVar

from pydantic import Field

from ..core.records import Node
from ..file.fields import Flag, Label, Number, OneOf, shorten
from ..file.table import FileTable, Name, Size, Speed
from ..file.units import ANGLE, BARE_FIGURE, MASS, PLAIN, UNBALANCE, Dimension, Unit, read_unit
from ..limits import LONGEST_FIGURE, MOST_BALANCING_PLANES, MOST_PLACES, MOST_RUNS, MOST_SENSORS

if TYPE_CHECKING:
    from ..core.phasors import Complex

_GRADE = re.compile(rf"\s*[Gg]\s*({BARE_FIGURE})\s*", re.ASCII)
_POLAR = re.compile(rf"\s*({BARE_FIGURE})\s*@\s*({BARE_FIGURE})\s*(?:deg|°)?\s*", re.ASCII)
_FARTHEST_DEG = 1e6
FREE = "free"  # places of a plane that takes weights at any angle
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
        example: A right value, for messages.
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
                f"{shorten(value)} is no amplitude @ angle in degrees; write it like "
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
    """Return the complex number, exact on the axes, where trial weights are often put."""
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
    """Angles at which a plane takes weights, deg: a list, or how many there are all round, or
    "free": at any angle, which is an empty list.
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


def _key(example: object, description: str, default: object = None) -> Any:
    """Return the declaration of a key that may be left out."""
    return Field(default, examples=[example], description=description)


class Run(FileTable):
    """One run of the machine."""

    name: Name | None = _key("trial front", "what to call it")
    readings: BySensor[Reading] = Field(
        examples=[["170 @ 112", "53 @ 78"]],
        description="amplitude @ phase in degrees of every sensor, in the same order in every run",
    )
    weights: dict[str, Weight] = Field(
        default_factory=dict,
        examples=[{"front": "1.15 @ 0"}],
        description="weights put on for this run: amount @ angle in degrees, by plane; none: the "
        "rotor as found",
    )
    keep_trial: Annotated[bool, Flag()] = _key(
        True, "true: these weights stay on in the later runs at this speed", False
    )
    speed: Speed | None = _key(1500, "speed of this run; each speed is a series of its own")


class RunsFile(FileTable):
    """Readings of a rotor with and without trial weights."""

    name: Name | None = _key("fan 3", "what to call the rotor")
    planes: ByPlane[Name] = Field(
        examples=[["front", "rear"]], description="names of the planes that take weights"
    )
    sensors: BySensor[Name] | None = _key(["front x", "rear x"], "names of the sensors")
    rotation: Annotated[str, OneOf("lag", "lead", meaning=_PHASES)] = _key(
        "lag", "phases of readings count against rotation (lag) or with it (lead)", "lag"
    )
    weights: Annotated[Sense, OneOf("with", "against", meaning=_ANGLES)] | None = _key(
        "with",
        "angles of weights count with or against rotation; left out: the same way as the phases of "
        "readings",
    )
    unit: Name | None = _key("um", "unit of the readings, to show")
    weight_unit: Annotated[str, AmountUnit()] = _key(
        "g", "unit of the weights: of mass, or of mass times radius", "g"
    )
    reading_weights: BySensor[Factor] | None = _key(
        [1, 2], "how much each sensor counts; left out: alike"
    )
    influence: BySensor[ByPlane[Coefficient]] | None = _key(
        [["0.0155 @ 113", "0.009 @ 10"]],
        "influence coefficients, known from before: a row for each reading (of each speed), "
        "reading per unit of weight for each plane",
    )
    radius: ByPlane[Size] | None = _key(
        [200, 200], "radius of the weights, or of the rim, by plane"
    )
    most: ByPlane[Amount] | None = _key(
        [40, 40], "largest weight of a plane, or at one of its places, by plane"
    )
    places: ByPlane[Places] | None = _key(
        [12, [0, 30, 60]],
        "where a plane takes weights, by plane: a number of places, evenly spaced from 0 on, a "
        'list of angles, or "free": at any angle',
    )
    drill: ByPlane[Size] | None = _key(
        [12, 12],
        "diameter of radial holes that remove steel from the rim, opposite to the weight, by plane",
    )
    deepest: ByPlane[Size] | None = _key([25, 25], "deepest hole, by plane")
    grade: Annotated[float, Grade()] | None = _key(
        6.3, "balance quality grade G of ISO 21940-11, mm/s"
    )
    mass: Annotated[float, Number(MASS, above=0, most=1e9)] | None = _key(120, "mass of the rotor")
    speed: Speed | None = _key(3000, "service speed, for which the grade permits an unbalance")
    shares: ByPlane[Factor] | None = _key(
        [0.4, 0.6], "shares of the permitted unbalance, by plane; left out: equal ones"
    )
    run: tuple[Run, ...] = Field(
        min_length=1, max_length=MOST_RUNS, examples=[], description="the runs, in their order"
    )

    @property
    def weighs_masses(self) -> bool:
        """Whether weights are masses; otherwise they are unbalances."""
        return read_amount_unit(self.weight_unit).powers == MASS.powers

    @property
    def senses(self) -> tuple[Sense, Sense]:
        """Senses in which phases of readings and angles of weights count rotation."""
        phases: Sense = "against" if self.rotation == "lag" else "with"
        return phases, self.weights or phases

    def turn(self, weights: Weights) -> Weights:
        """Return weights in the sense of the readings, or back in the sense of the file."""
        phases, angles = self.senses
        return weights if phases == angles else weights.conjugate()

    def name_run(self, k: int) -> str:
        """Return the name of the k-th run (from 0), or its number."""
        return self.run[k].name or f"run {k + 1}"

    def find_unbalance_per_weight(self, k: int) -> float | None:
        """Return the unbalance of one unit of weight in the k-th plane, kg m; None: no radius."""
        scale = float(read_amount_unit(self.weight_unit).scale)
        if not self.weighs_masses:
            return scale
        return scale * self.radius[k] / 1e3 if self.radius else None

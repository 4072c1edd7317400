"""What a file of runs may say: readings as amplitude and phase, weights as amount and angle.

Readings stay in whatever unit they were read in, weights in the file's own (`weight_unit`); lengths
are mm, speeds rpm, the mass of the rotor kg, angles degrees.
"""

import cmath
import math
import re
from typing import Annotated, Any

from pydantic import Field

from ..enginefile.fields import Flag, Label, Number, OneOf, shorten
from ..enginefile.model import FileTable, Name, Size, Speed
from ..enginefile.units import (
    ANGLE,
    BARE_FIGURE,
    MASS,
    PLAIN,
    UNBALANCE,
    Dimension,
    Unit,
    read_unit,
)
from ..limits import LONGEST_FIGURE, MOST_BALANCING_PLANES, MOST_PLACES, MOST_RUNS, MOST_SENSORS

_GRADE = re.compile(rf"\s*[Gg]\s*({BARE_FIGURE})\s*", re.ASCII)
_AT = rf"\s*@\s*({BARE_FIGURE})\s*(?:deg|°)?\s*"
_POLAR = re.compile(rf"\s*({BARE_FIGURE}){_AT}", re.ASCII)
_WITH_UNIT = re.compile(rf"\s*({BARE_FIGURE})\s*([^\s\d.,@+-][^@]*?){_AT}", re.ASCII)
_LARGEST, _SMALLEST = 1e12, 1e-12
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

    def json(self) -> dict[str, Any]:
        return super().json() | {"type": ["number", "string"], "pattern": rf"^{_GRADE.pattern}$"}


class Polar(Number):
    """A complex number written as amplitude and angle in degrees: `"170 @ 112"`.

    Args:
        example: for messages. zero: whether the amplitude may be 0.
        unit: key of the file that names the unit of all such values, if there is one.
    """

    def __init__(self, example: str, *, zero: bool, unit: str = "") -> None:
        super().__init__(PLAIN)
        self.example, self.zero, self.unit = example, zero, unit

    def read(self, value: object) -> complex:  # type: ignore[override]
        text = value if isinstance(value, str) and len(value) <= LONGEST_FIGURE else ""
        match = _POLAR.fullmatch(text)
        if match is None:
            raise ValueError(f"{shorten(value)} {self._describe_misfit(text)}")
        amplitude, angle = map(float, match.groups())
        if amplitude < 0:
            raise ValueError(
                f"{shorten(value)} has a negative amplitude; leave the minus out and turn the "
                "angle by 180 degrees"
            )
        if amplitude == 0 and not self.zero:
            raise ValueError(
                f"{shorten(value)} is a weight of 0, which tells nothing; give the weight that was "
                "on, or leave the plane out"
            )
        if amplitude > _LARGEST or abs(angle) > _FARTHEST_DEG:
            raise ValueError(
                f"{shorten(value)} is too large; amplitudes go up to {_LARGEST:g}, angles to "
                f"{_FARTHEST_DEG:g} degrees"
            )
        if 0 < amplitude < _SMALLEST:
            raise ValueError(
                f"{shorten(value)} is too small; amplitudes are 0, or {_SMALLEST:g} and more"
            )
        return make_polar(amplitude, angle)

    def _describe_misfit(self, text: str) -> str:
        """What is wrong with a text that is not amplitude and angle."""
        if self.unit and (found := _WITH_UNIT.fullmatch(text)):
            figure, unit, angle = found.groups()
            return (
                f'names a unit, which stands once at the head of the file: write "{figure} @ '
                f'{angle}", and {self.unit} = {shorten(unit)} there'
            )
        comma = re.search(r"\d,\d", text)
        hint = "; decimals take a point, thousands no comma" if comma else ""
        return f'is no amplitude @ angle in degrees; write it like "{self.example}"{hint}'

    def json(self) -> dict[str, Any]:
        return {"type": "string", "pattern": rf"^{_POLAR.pattern}$"}


def make_polar(amplitude: float, angle_deg: float) -> complex:
    """The complex number; exact on the axes, where shops like to put their trial weights."""
    quarter, rest = divmod(angle_deg, 90)
    turned = cmath.rect(amplitude, math.radians(rest)) if rest else complex(amplitude)
    return turned * (1, 1j, -1, -1j)[int(quarter) % 4]


class AmountUnit(Label):
    """A unit of mass, or of mass times radius."""

    def read(self, value: object) -> str:
        name = super().read(value)
        try:
            unit = read_amount_unit(name)
        except ValueError:
            unit = None
        if unit is None or unit.powers not in (MASS.powers, UNBALANCE.powers):
            raise ValueError(
                f"{shorten(value)} is no unit of weights; write g, kg, oz or lb, or of unbalances "
                "g mm or oz in"
            )
        return name


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
            f"{shorten(value)} does not say where weights can go; give the number of places all "
            f'round (up to {MOST_PLACES}), a list of their angles, or "{FREE}" for any angle'
        )

    def json(self) -> dict[str, Any]:
        count = {"type": "integer", "minimum": 1, "maximum": MOST_PLACES}
        angles = {"type": "array", "items": super().json(), "minItems": 1, "maxItems": MOST_PLACES}
        return {"anyOf": [count, angles, {"const": FREE}]}


def read_amount_unit(name: str) -> Unit:
    """The unit of a weight; ValueError if it is unknown."""
    return read_unit(name, _AMOUNTS)


Reading = Annotated[complex, Polar("170 @ 112", zero=True, unit="unit")]
Weight = Annotated[complex, Polar("1.15 @ 0", zero=False, unit="weight_unit")]
Coefficient = Annotated[complex, Polar("0.0155 @ 113", zero=True)]
Amount = Annotated[float, Number(PLAIN, above=0, most=1e9)]
Factor = Annotated[float, Number(PLAIN, least=1e-6, most=1e6)]
Readings = Annotated[tuple[Reading, ...], Field(min_length=1, max_length=MOST_SENSORS)]
Coefficients = Annotated[
    tuple[Coefficient, ...], Field(min_length=1, max_length=MOST_BALANCING_PLANES)
]
PlacesOfPlane = Annotated[tuple[float, ...], PlaceAngles()]
_PLANES = Field(min_length=1, max_length=MOST_BALANCING_PLANES)


class Run(FileTable):
    """One run of the machine."""

    name: Name | None = Field(None, examples=["trial front"], description="what to call it")
    readings: Readings = Field(
        examples=[["170 @ 112", "53 @ 78"]],
        description="amplitude @ phase in degrees of every sensor, in the same order in every run",
    )
    weights: dict[str, Weight] = Field(
        default_factory=dict,
        examples=[{"front": "1.15 @ 0"}],
        description="weights put on for this run: amount @ angle in degrees, by plane; none: the "
        "rotor as found",
    )
    keep_trial: Annotated[bool, Flag()] = Field(
        False,
        examples=[True],
        description="true: these weights stay on in the later runs at this speed",
    )
    speed: Speed | None = Field(
        None, examples=[1500], description="speed of this run; each speed is a series of its own"
    )


class RunsFile(FileTable):
    """Readings of a rotor with and without trial weights."""

    name: Name | None = Field(None, examples=["fan 3"], description="what to call the rotor")
    planes: Annotated[tuple[Name, ...], _PLANES] = Field(
        examples=[["front", "rear"]], description="names of the planes that take weights"
    )
    sensors: Annotated[tuple[Name, ...], Field(min_length=1, max_length=MOST_SENSORS)] | None = (
        Field(None, examples=[["front x", "rear x"]], description="names of the sensors")
    )
    rotation: Annotated[
        str,
        OneOf(
            "lag",
            "lead",
            meaning="lag: phases count against rotation, as most instruments do; lead: with it",
        ),
    ] = Field(
        "lag",
        examples=["lag"],
        description="phases of readings count against rotation (lag) or with it (lead)",
    )
    weights: (
        Annotated[
            str,
            OneOf(
                "with",
                "against",
                meaning="with: their angles go the way the rotor turns; against: the other way",
            ),
        ]
        | None
    ) = Field(
        None,
        examples=["with"],
        description="angles of weights count with or against rotation; left out: the same way as "
        "the phases of readings",
    )
    unit: Name | None = Field(None, examples=["um"], description="unit of the readings, to show")
    weight_unit: Annotated[str, AmountUnit()] = Field(
        "g", examples=["g"], description="unit of the weights: of mass, or of mass times radius"
    )
    reading_weights: (
        Annotated[tuple[Factor, ...], Field(min_length=1, max_length=MOST_SENSORS)] | None
    ) = Field(None, examples=[[1, 2]], description="how much each sensor counts; left out: alike")
    influence: (
        Annotated[tuple[Coefficients, ...], Field(min_length=1, max_length=MOST_SENSORS)] | None
    ) = Field(
        None,
        examples=[[["0.0155 @ 113", "0.009 @ 10"]]],
        description="influence coefficients, known from before: a row for each reading (of each "
        "speed), reading per unit of weight for each plane",
    )
    radius: Annotated[tuple[Size, ...], _PLANES] | None = Field(
        None, examples=[[200, 200]], description="radius of the weights, or of the rim, by plane"
    )
    most: Annotated[tuple[Amount, ...], _PLANES] | None = Field(
        None,
        examples=[[40, 40]],
        description="largest weight of a plane, or at one of its places, by plane",
    )
    places: Annotated[tuple[PlacesOfPlane, ...], _PLANES] | None = Field(
        None,
        examples=[[12, [0, 30, 60]]],
        description="where a plane takes weights, by plane: a number of places, evenly spaced from "
        '0 on, a list of angles, or "free": at any angle',
    )
    drill: Annotated[tuple[Size, ...], _PLANES] | None = Field(
        None,
        examples=[[12, 12]],
        description="diameter of radial holes that remove steel from the rim, opposite to the "
        "weight, by plane",
    )
    deepest: Annotated[tuple[Size, ...], _PLANES] | None = Field(
        None, examples=[[25, 25]], description="deepest hole, by plane"
    )
    grade: Annotated[float, Grade()] | None = Field(
        None, examples=[6.3], description="balance quality grade G of ISO 21940-11, mm/s"
    )
    mass: Annotated[float, Number(MASS, above=0, most=1e9)] | None = Field(
        None, examples=[120], description="mass of the rotor"
    )
    speed: Speed | None = Field(
        None, examples=[3000], description="service speed, for which the grade permits an unbalance"
    )
    shares: Annotated[tuple[Factor, ...], _PLANES] | None = Field(
        None,
        examples=[[0.4, 0.6]],
        description="shares of the permitted unbalance, by plane; left out: equal ones",
    )
    run: tuple[Run, ...] = Field(
        min_length=1, max_length=MOST_RUNS, examples=[], description="the runs, in their order"
    )

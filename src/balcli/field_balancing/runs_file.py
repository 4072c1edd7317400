"""Define and check the tables of a file of runs. Readings are amplitude @ phase, weights amount @
angle. The check reports all wrong values, each with its path; if there are none, it reports all
contradictions between values.

Readings may have any unit; the unit of weights is `weight_unit`. Lengths are in mm, speeds in rpm,
the mass of the rotor in kg, angles in degrees.
"""

from __future__ import annotations

import cmath
import math
import re
from collections.abc import Iterator, Mapping
from contextlib import suppress
from typing import TYPE_CHECKING, Annotated, Literal, TypeVar

from pydantic import Field
from pydantic_core import ErrorDetails

from ..core.records import Node
from ..errors import Problem
from ..file.fields import (
    Label,
    Number,
    OneOf,
    counted,
    join_words,
    printable,
    shorten,
    suggest_nearest,
)
from ..file.messages import RUNS, describe_finding, refuse_other_kind
from ..file.read import TableReader
from ..file.table import FileTable, Name, Size, Speed, Switch
from ..file.toml import parse_toml
from ..file.units import ANGLE, BARE_FIGURE, MASS, PLAIN, UNBALANCE, Dimension, Unit, read_unit
from ..limits import LONGEST_FIGURE, MOST_BALANCING_PLANES, MOST_PLACES, MOST_RUNS, MOST_SENSORS

if TYPE_CHECKING:
    from ..core.phasors import Complex


_GRADE = re.compile(rf"\s*[Gg]\s*({BARE_FIGURE})\s*", re.ASCII)
_POLAR = re.compile(rf"\s*({BARE_FIGURE})\s*@\s*({BARE_FIGURE})\s*(?:deg|°)?\s*", re.ASCII)
_LONE_FIGURE = re.compile(rf"\s*{BARE_FIGURE}\s*", re.ASCII)
_AT_RADIUS = re.compile(rf"\bat\s+({BARE_FIGURE})\s*([a-z]*)", re.ASCII)  # "10 g at 150 mm @ 0"
_FARTHEST_DEG = 1e6
_MOST_PLANES_WITHOUT_PHASE = 2
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
        self.example = example
        self.zero = zero

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
                f"angles up to {_FARTHEST_DEG:g} degrees; for a minus sign, add 180 to the angle"
            )
        return make_polar(amplitude, angle)

    def json(self) -> Node:
        return {"type": "string", "pattern": rf"^{_POLAR.pattern}$"}


class Amplitude(Number):
    """A reading: amplitude @ phase, or a bare number for an amplitude without phase."""

    def __init__(self) -> None:
        super().__init__(PLAIN, least=0, most=1e12)
        self.polar = Polar("170 @ 112", zero=True)

    def read(self, value: object) -> complex | float:  # type: ignore[override]
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            return super().read(value)
        if isinstance(value, str) and _LONE_FIGURE.fullmatch(value[:LONGEST_FIGURE]):
            figure = value.strip()
            raise ValueError(
                f'{shorten(value)} is a text without phase; write "{figure} @ 112" with its phase, '
                f"or the bare number {figure} if the instrument shows none"
            )
        return self.polar.read(value)

    def json(self) -> Node:
        return {"anyOf": [self.polar.json(), {"type": "number", "minimum": 0, "maximum": 1e12}]}


def make_polar(amplitude: float, angle_deg: float) -> complex:
    """Return the complex number of an amplitude and an angle. It is exact at multiples of 90
    degrees, which are frequent angles of trial weights.
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
            f"{shorten(value)} is no unit of weights; write g, kg, oz or lb, or for unbalances "
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
Reading = Annotated[complex | float, Amplitude()]
Weight = Annotated[complex, Polar("1.15 @ 0", zero=False)]
Coefficient = Annotated[complex, Polar("0.0155 @ 113", zero=True)]
Amount = Annotated[float, Number(PLAIN, above=0, most=1e9)]
Factor = Annotated[float, Number(PLAIN, least=1e-6, most=1e6)]
Places = Annotated[tuple[float, ...], PlaceAngles()]
Sense = Literal["with", "against"]
_PHASES = "lag: phases count against rotation, as in most instruments; lead: with rotation"
_ANGLES = "with: angles of weights increase the way the rotor turns; against: the other way"


class Run(FileTable):
    """One run of the machine with its readings."""

    name: Name | None = None
    """Name of the run. Example: 'trial front'"""
    readings: BySensor[Reading]
    """Amplitude @ phase in degrees of every sensor, in the same order in every run; if the
    instrument shows no phase, amplitudes as bare numbers in all runs. Example:
    ['170 @ 112', '53 @ 78']"""
    weights: dict[str, Weight] = Field(default_factory=dict)
    """Weights put on for this run: amount @ angle in degrees, by plane; left out: no weights.
    Example: { front = '1.15 @ 0' }"""
    radius: dict[str, Size] = Field(default_factory=dict)
    """Radius of the weights of this run, by plane; left out: the radius of the plane.
    Example: { front = 150 }"""
    keep_trial: Switch = False
    """Whether these weights stay on in the later runs at this speed. Example: true"""
    speed: Speed | None = None
    """Speed of this run; each speed has influence coefficients of its own. Example: 1500"""


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
    """Factor of the readings of each sensor when they are minimised; left out: 1.
    Example: [1, 2]"""
    influence: BySensor[ByPlane[Coefficient]] | None = None
    """Known influence coefficients: a row for each reading (at each speed), with the change of the
    reading per unit of weight for each plane. Example: [['0.0155 @ 113', '0.009 @ 10']]"""
    radius: ByPlane[Size] | None = None
    """Radius of the weights, or of the drilled rim, by plane. Example: [200, 200]"""
    most: ByPlane[Amount] | None = None
    """Largest weight, by plane; with places or holes, largest weight at each of them.
    Example: [40, 40]"""
    places: ByPlane[Places] | None = None
    """Places that take weights, by plane: a number of places, evenly spaced from 0 on; a list of
    angles; or "free" for any angle. Example: [12, [0, 30, 60]]"""
    drill: ByPlane[Size] | None = None
    """Diameter of radial holes that remove steel from the rim, opposite to the weight, by plane.
    Example: [12, 12]"""
    deepest: ByPlane[Size] | None = None
    """Largest depth of a hole, by plane. Example: [25, 25]"""
    grade: Annotated[float, Grade()] | None = None
    """Balance quality grade G of ISO 21940-11, mm/s. Example: 6.3"""
    mass: Annotated[float, Number(MASS, above=0, most=1e9)] | None = None
    """Mass of the rotor. Example: 120"""
    speed: Speed | None = None
    """Service speed, for which the permitted unbalance is computed. Example: 3000"""
    shares: ByPlane[Factor] | None = None
    """Shares of the permitted unbalance, by plane; left out: equal shares. Example: [0.4, 0.6]"""
    run: Annotated[tuple[Run, ...], Field(min_length=1, max_length=MOST_RUNS)]
    """The runs, in their order."""

    @property
    def weighs_masses(self) -> bool:
        """Whether weights are masses; otherwise they are unbalances."""
        return read_amount_unit(self.weight_unit).powers == MASS.powers

    @property
    def has_only_amplitudes(self) -> bool:
        """Whether readings have no phase."""
        return not isinstance(self.run[0].readings[0], complex)

    @property
    def senses(self) -> tuple[Sense, Sense]:
        """Directions of phases of readings and of angles of weights: with or against rotation.
        Without phases, both are the direction of the weights.
        """
        if self.has_only_amplitudes:
            marked = self.weights or "with"
            return marked, marked
        phases: Sense = "against" if self.rotation == "lag" else "with"
        return phases, self.weights or phases

    def turn(self, weights: Weights) -> Weights:
        """Return weights with angles converted from the direction of the file's weights to that of
        the phases of readings, or back.
        """
        phases, angles = self.senses
        return weights if phases == angles else weights.conjugate()

    def list_weights(self, run: Run) -> list[complex]:
        """Return the weights that a run puts on, by plane, as amounts at the radius of the plane: a
        weight w at another radius r counts as w r / R.
        """
        counted_weights = []
        for k, plane in enumerate(self.planes):
            weight = run.weights.get(plane, 0j)
            if self.radius is not None and plane in run.radius:
                weight = weight * (run.radius[plane] / self.radius[k])
            counted_weights.append(weight)
        return counted_weights

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


BY_PLANE = ("radius", "most", "places", "drill", "deepest", "shares")


_NEEDED = {
    "planes": 'name the planes that take weights, such as planes = ["front", "rear"]',
    "run": "write [[run]] for every run, the rotor as found first",
}
RUNS_FILE = (
    "not a file of runs, which is TOML text with tables such as [[run]]: `balcli new field` writes "
    "one"
)


def parse_runs(text: str | bytes, file: str = "") -> RunsFile:
    """Return the runs that a TOML text describes; `file` is its name in messages. Raises InputError
    with every mistake.
    """
    return check_runs(parse_toml(text, file, RUNS_FILE), file)


def check_runs(data: Mapping[str, object], file: str = "") -> RunsFile:
    """Return the runs that the tables of a parsed TOML text describe; see `parse_runs`."""
    refuse_other_kind(data, file, RUNS)
    reader = TableReader(RUNS.name, _describe)
    stand_in = [Run.model_construct(readings=(0j,))]  # runs are read one by one
    head = reader.read_table("", {**data, "run": stand_in}, RunsFile)
    if not (tables := data.get("run", [])) and isinstance(tables, list):
        reader.problems.append(Problem.of_missing("run", _NEEDED["run"]))
    runs = reader.read_list("run", tables, Run, MOST_RUNS)
    if head is not None and not reader.problems:
        head = head.model_copy(update={"run": runs})
        reader.problems += _find_misfits(head)
    if head is None or reader.problems:
        raise reader.refusal(file)
    return head


def _describe(path: str, finding: ErrorDetails, table: type[FileTable]) -> Problem:
    last = str(finding["loc"][-1])
    if finding["type"] == "missing" and last in _NEEDED:
        return Problem.of_missing(last, _NEEDED[last])
    if finding["type"] == "tuple_type" and last in BY_PLANE:
        value = shorten(finding["input"])
        text = f"{value} is one value; give one for each plane, such as {last} = [{value}, {value}]"
        return Problem(last, text)
    if finding["type"] == "tuple_type" and last == "readings":
        value = shorten(finding["input"])
        text = f"{value} is one value; write it as a list: readings = [{value}]"
        return Problem(f"{path}.{last}", text)
    problem = describe_finding(path, finding, table)
    radius = _find_radius(finding["input"]) if finding["loc"][0] == "weights" else ""
    if not radius:
        return problem
    key = f"radius = {{ {last} = {radius} }} in this run"
    return Problem(problem.path, f"{problem.message}; the radius has a key of its own: {key}")


def _find_radius(weight: object) -> str:
    """Return the radius in a weight such as "10 g at 150 mm @ 0", as a file has it; empty if there
    is none.
    """
    match = _AT_RADIUS.search(weight) if isinstance(weight, str) else None
    if match is None:
        return ""
    size, unit = match.groups()
    return size if unit in ("", "mm") else f'"{size} {unit}"'


def _find_misfits(file: RunsFile) -> Iterator[Problem]:
    """Yield contradictions between keys and between runs."""
    for key in ("planes", "sensors"):
        names = getattr(file, key) or ()
        if twice := sorted({name for name in names if names.count(name) > 1}):
            yield Problem(key, f"names {shorten(twice[0])} twice; each needs a name of its own")
    planes = counted(len(file.planes), "plane")
    counts = [(key, getattr(file, key), "value", len(file.planes), planes) for key in BY_PLANE]
    for k, row in enumerate(file.influence or (), 1):
        counts.append((f"influence.{k}", row, "coefficient", len(file.planes), planes))
    sensors = len(file.sensors or file.run[0].readings)
    readings = counted(sensors, "reading")
    in_a_run = f"{readings} in a run"
    counts.append(("reading_weights", file.reading_weights, "value", sensors, in_a_run))
    speeds = {run.speed for run in file.run}
    if None not in speeds or len(speeds) == 1:  # otherwise the number of speeds is unknown
        at = f" at {counted(len(speeds), 'speed')}" if len(speeds) > 1 else ""
        wanted = sensors * len(speeds)
        counts.append(("influence", file.influence, "row", wanted, f"{readings}{at}"))
    for path, values, noun, wanted, of in counts:
        if values is not None and len(values) != wanted:
            text = f"has {counted(len(values), noun)}, but there are {of}; give one for each"
            yield Problem(path, text)
    yield from _check_holes(file)
    if file.has_only_amplitudes:
        yield from _check_amplitudes(file)
    for k, run in enumerate(file.run, 1):
        yield from _check_run(file, k, run, sensors)


def _check_holes(file: RunsFile) -> Iterator[Problem]:
    if file.drill is not None and file.radius is None:
        yield Problem.of_missing("radius", "a drill needs the radius of the rim, in every plane")
    if file.deepest is not None and file.drill is None:
        yield Problem.of_missing("drill", "deepest is for holes, which need a diameter")
    for key, most, fault in (
        ("drill", 2.0, "is wider than its rim of radius {:g} mm"),
        ("deepest", 1.0, "passes the axis, which is {:g} mm below the rim"),
    ):
        pairs = zip(getattr(file, key) or (), file.radius or (), strict=False)
        for k, (size, rim) in enumerate(pairs, 1):
            if size > most * rim:
                yield Problem(key, f"hole {k} of {size:g} mm {fault.format(rim)}")


def _check_phases(file: RunsFile, k: int, run: Run) -> Iterator[Problem]:
    """Yield the first reading of the k-th run that has no phase while others have one, or the other
    way round.
    """
    fault = "has no phase, but the first reading of the file has one"
    if file.has_only_amplitudes:
        fault = "has a phase, but the first reading of the file has none"
    for j, reading in enumerate(run.readings, 1):
        if isinstance(reading, complex) == file.has_only_amplitudes:
            text = 'write all readings with phase, as in "170 @ 112", or all without, as in 170'
            yield Problem(f"run.{k}.readings.{j}", f"{fault}; {text}")
            return


def _check_amplitudes(file: RunsFile) -> Iterator[Problem]:
    """Yield the keys that readings without phase do not allow."""
    if "rotation" in file.model_fields_set:
        yield Problem("rotation", "is for phases, but readings have none; leave it out")
    if file.influence is not None:
        hint = "leave them out, and give trial runs"
        yield Problem("influence", f"coefficients need readings with phases; {hint}")
    if len(file.planes) > _MOST_PLANES_WITHOUT_PHASE:
        yield Problem(
            "planes",
            f"has {counted(len(file.planes), 'plane')}; readings without phase balance one or two",
        )
    speeds = dict.fromkeys(run.speed for run in file.run)
    if len(speeds) > 1 and None not in speeds:
        listed = join_words([f"{speed:g} rpm" for speed in speeds])
        yield Problem("run", f"has {listed}; readings without phase are balanced at one speed")


def _check_run(file: RunsFile, k: int, run: Run, sensors: int) -> Iterator[Problem]:
    """Yield contradictions in the k-th run (from 1); a run has as many readings as `sensors`."""
    if len(run.readings) != sensors:
        whose = "sensors names" if file.sensors else "run.1 has"
        yield Problem(
            f"run.{k}.readings",
            f"has {counted(len(run.readings), 'reading')}, but {whose} {sensors}; give one for "
            "each sensor, in the same order in every run",
        )
    yield from _check_phases(file, k, run)
    with_speed = [n for n, other in enumerate(file.run, 1) if other.speed is not None]
    if with_speed and run.speed is None:
        hint = f"run.{with_speed[0]} gives its speed, so every run must"
        yield Problem.of_missing(f"run.{k}.speed", hint)
    for key in ("weights", "radius"):
        for name in [name for name in getattr(run, key) if name not in file.planes]:
            hint = suggest_nearest(name, file.planes, f"there are {', '.join(file.planes)}")
            yield Problem(f"run.{k}.{key}.{printable(name)}", f"is not a plane; {hint[:200]}")
    if run.radius and not file.weighs_masses:
        yield Problem(
            f"run.{k}.radius",
            f"has no meaning for unbalances (weight_unit is {file.weight_unit}); leave it out, or "
            "give weights as masses",
        )
    elif run.radius and file.radius is None:
        sizes = join_words([f"{size:g} mm" for size in run.radius.values()])
        yield Problem(
            f"run.{k}.radius",
            f"is {sizes}, but the radius of the corrections is unknown; give it in every plane, "
            f"such as radius = {[200] * len(file.planes)} above the runs",
        )

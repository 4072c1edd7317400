"""What a file of runs may say: readings as amplitude and phase, weights as amount and angle.

Readings keep the unit in which they were read, weights the unit of the file (`weight_unit`).
Lengths are in mm, speeds in rpm, the mass of the rotor in kg, angles in degrees.

A file of runs -> model: every mistake at once, by its path and with what would be right.
"""

from __future__ import annotations

import cmath
import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence, Sized
from contextlib import suppress
from pathlib import Path
from typing import Annotated, Any, Literal, TypeVar

from pydantic import Field
from pydantic_core import ErrorDetails

from ..errors import Problem
from ..file.fields import Flag, Label, Number, OneOf, counted, printable, shorten, suggest_nearest
from ..file.messages import RUNS, describe_finding, join_path, refuse_other_kind
from ..file.read import TableReader
from ..file.table import FileTable, Name, Size, Speed
from ..file.toml import name_file, parse_toml, read_bytes
from ..file.units import ANGLE, BARE_FIGURE, MASS, PLAIN, UNBALANCE, Dimension, Unit, read_unit
from ..limits import LONGEST_FIGURE, MOST_BALANCING_PLANES, MOST_PLACES, MOST_RUNS, MOST_SENSORS

_GRADE = re.compile(rf"\s*[Gg]\s*({BARE_FIGURE})\s*", re.ASCII)
_AT = rf"\s*@\s*({BARE_FIGURE})\s*(?:deg|°)?\s*"
_POLAR = re.compile(rf"\s*({BARE_FIGURE}){_AT}", re.ASCII)
_WITH_UNIT = re.compile(rf"\s*({BARE_FIGURE})\s*([^\s\d.,@+-][^@]*?){_AT}", re.ASCII)
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
        wrong = ""
        if amplitude < 0:
            wrong = "has a negative amplitude; leave the minus out, turn the angle by 180 degrees"
        elif amplitude == 0 and not self.zero:
            wrong = (
                "is a weight of 0, which has no effect; give the weight that was on, or leave the "
                "plane out"
            )
        elif not (amplitude == 0 or 1e-12 <= amplitude <= 1e12) or abs(angle) > _FARTHEST_DEG:
            wrong = (
                "is too large or small; amplitudes are 0 or 1e-12 to 1e+12, angles up to "
                f"{_FARTHEST_DEG:g} degrees"
            )
        if wrong:
            raise ValueError(f"{shorten(value)} {wrong}")
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


T = TypeVar("T")
ByPlane = Annotated[tuple[T, ...], Field(min_length=1, max_length=MOST_BALANCING_PLANES)]
BySensor = Annotated[tuple[T, ...], Field(min_length=1, max_length=MOST_SENSORS)]
Reading = Annotated[complex, Polar("170 @ 112", zero=True, unit="unit")]
Weight = Annotated[complex, Polar("1.15 @ 0", zero=False, unit="weight_unit")]
Coefficient = Annotated[complex, Polar("0.0155 @ 113", zero=True)]
Amount = Annotated[float, Number(PLAIN, above=0, most=1e9)]
Factor = Annotated[float, Number(PLAIN, least=1e-6, most=1e6)]
Places = Annotated[tuple[float, ...], PlaceAngles()]
Sense = Literal["with", "against"]
_PHASES = "lag: phases count against rotation, as most instruments do; lead: with it"
_ANGLES = "with: their angles go the way the rotor turns; against: the other way"


def _key(example: object, description: str, default: Any = None) -> Any:
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

    def turn(self, weights: Any) -> Any:
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


BY_PLANE = ("radius", "most", "places", "drill", "deepest", "shares")
_NEEDED = {
    "planes": 'name the planes that take weights, such as planes = ["front", "rear"]',
    "run": "write [[run]] for every run, the rotor as found first",
}


def read_runs(source: str | Path) -> RunsFile:
    """The runs in a file, or on standard input for "-".

    Raises BalcliError if there is nothing to read, InputError with every mistake of the text.
    """
    return parse_runs(read_bytes(source), name_file(source))


def parse_runs(text: str | bytes, file: str = "") -> RunsFile:
    """The runs that a TOML text describes; `file` is its name in messages. Raises InputError with
    every mistake.
    """
    return check_runs(parse_toml(text, file), file)


def check_runs(data: Mapping[str, Any], file: str = "") -> RunsFile:
    """The runs that tables describe, as TOML is read; otherwise as `parse_runs`."""
    refuse_other_kind(data, file, RUNS)
    reader = TableReader(RUNS.name, _describe)
    stand_in = {"run": [Run.model_construct(readings=(0j,))]}  # runs are read one by one
    model = reader.read_table("", {**data, **stand_in}, RunsFile)
    runs: tuple[Run | None, ...] = ()
    if "run" not in data:
        reader.problems.append(Problem.of_missing("run", _NEEDED["run"]))
    elif data["run"] == []:
        reader.problems.append(Problem("run", f"is an empty list; {_NEEDED['run']}"))
    else:
        runs = reader.read_list("run", data["run"], Run, MOST_RUNS) or ()
    if not reader.problems and model is not None:
        model = model.model_copy(update={"run": runs})
    head, broken = model, set[str]()
    if model is None:
        refused = reader.refused[""]
        if isinstance(refused.draft, RunsFile) and "planes" not in refused.broken:
            head, broken = refused.draft, refused.broken  # as far as it can be read
    if head is not None:
        misfits = _find_misfits(head, runs, data.get("run"))
        reader.problems += (misfit for misfit in misfits if broken.isdisjoint(misfit.missing))
    if reader.problems or model is None:
        raise reader.refusal(file)
    return model


def _describe(path: str, finding: ErrorDetails, table: type[FileTable]) -> Problem:
    last = str(finding["loc"][-1])
    if finding["type"] == "missing" and last in _NEEDED:
        return Problem.of_missing(last, _NEEDED[last])
    if finding["type"] == "tuple_type" and last in BY_PLANE:
        value = shorten(finding["input"])
        text = f"{value} is one value; give one for each plane, such as {last} = [{value}, {value}]"
        return Problem(last, text)
    if finding["type"] == "dict_type":
        text = f'{shorten(finding["input"])} is not a table; write it like {{ front = "1.15 @ 0" }}'
        return Problem(join_path(path, finding["loc"]), text)
    return describe_finding(path, finding, table)


# ------------------------------------------------------------------ what does not fit together
def _find_misfits(file: RunsFile, runs: Sequence[Run | None], tables: Any) -> Iterator[Problem]:
    """Yield what does not fit together, as far as the file can be read.

    Args:
        file: everything but the runs.
        runs: the runs; None for each that has mistakes.
        tables: the runs as TOML is read.
    """
    yield from _check_lists(file)
    yield from _check_grade(file)
    yield from _check_holes(file)
    readable = {k: run for k, run in enumerate(runs, 1) if run is not None}
    if readable:
        yield from _check_runs(file, readable, len(readable) == len(runs))
    for k, run in enumerate(runs, 1):  # a run that has mistakes may name wrong planes as well
        if run is None and isinstance(tables[k - 1], Mapping):
            weights = tables[k - 1].get("weights")
            yield from _check_planes(file, k, weights if isinstance(weights, Mapping) else ())


def _check_count(path: str, values: Sized | None, what: str, wanted: int, of: str) -> list[Problem]:
    """Return a problem if there is not one value for each plane or reading."""
    if values is None or len(values) == wanted:
        return []
    text = f"has {counted(len(values), what)}, but there are {of}; give one for each"
    return [Problem(path, text)]


def _check_lists(file: RunsFile) -> Iterator[Problem]:
    for key in ("planes", "sensors"):
        names = getattr(file, key) or ()
        if twice := sorted({name for name in names if names.count(name) > 1}):
            yield Problem(key, f"names {shorten(twice[0])} twice; each needs a name of its own")
    planes = len(file.planes)
    for key in BY_PLANE:
        yield from _check_count(key, getattr(file, key), "value", planes, counted(planes, "plane"))
    for k, row in enumerate(file.influence or (), 1):
        path = f"influence.{k}"
        yield from _check_count(path, row, "coefficient", planes, counted(planes, "plane"))


def _check_grade(file: RunsFile) -> Iterator[Problem]:
    if file.shares is not None and file.grade is None:
        yield Problem.of_missing("grade", "shares are of what it permits, such as grade = 6.3")
    if file.grade is None:
        return
    for key, example in (("mass", "120"), ("speed", "3000")):
        if getattr(file, key) is None:
            hint = f"a grade permits an unbalance by it, such as {key} = {example}"
            yield Problem.of_missing(key, hint)
    if file.radius is None and file.weighs_masses:
        yield Problem.of_missing(
            "radius",
            "a grade permits an unbalance, which is weight times radius: give the radius of every "
            "plane, such as radius = [200, 200], or the weights as unbalances, with "
            'weight_unit = "g mm"',
        )


def _check_holes(file: RunsFile) -> Iterator[Problem]:
    if file.drill is not None and file.radius is None:
        yield Problem.of_missing("radius", "a drill needs the radius of the rim, in every plane")
    if file.deepest is not None and file.drill is None:
        yield Problem.of_missing("drill", "deepest belongs to holes, which have a diameter")
    for k, rim in enumerate(file.radius or ()):
        if (drill := _find_kth(file.drill, k)) > 2 * rim:
            text = f"hole {k + 1} of {drill:g} mm is wider than its rim of radius {rim:g} mm"
            yield Problem("drill", text)
        if (depth := _find_kth(file.deepest, k)) > rim:
            text = f"hole {k + 1} of {depth:g} mm passes the axis, {rim:g} mm below the rim"
            yield Problem("deepest", text)


def _find_kth(values: Sequence[float] | None, k: int) -> float:
    return values[k] if values and k < len(values) else 0.0


def _check_runs(file: RunsFile, runs: Mapping[int, Run], whole: bool) -> Iterator[Problem]:
    """Yield what does not fit in runs, which come by their numbers; `whole`: these are all."""
    first, pattern = next(iter(runs.items()))
    sensors = len(file.sensors or pattern.readings)
    whose = "sensors names" if file.sensors else f"run.{first} has"
    with_speed = [k for k, run in runs.items() if run.speed is not None]
    for k, run in runs.items():
        if len(run.readings) != sensors:
            yield Problem(
                f"run.{k}.readings",
                f"has {counted(len(run.readings), 'reading')}, but {whose} {sensors}; give one for "
                "each sensor, in the same order in every run",
            )
        yield from _check_planes(file, k, run.weights)
        if with_speed and run.speed is None:
            hint = f"run.{with_speed[0]} gives its speed, so every run must"
            yield Problem.of_missing(f"run.{k}.speed", hint)
    readings = counted(sensors, "reading")
    key = "reading_weights"
    yield from _check_count(key, file.reading_weights, "value", sensors, f"{readings} in a run")
    if whole and len(with_speed) in (0, len(runs)):  # otherwise the speeds are not known
        speeds = len({run.speed for run in runs.values()})
        at = f" at {counted(speeds, 'speed')}" if speeds > 1 else ""
        yield from _check_count(
            "influence", file.influence, "row", sensors * speeds, f"{readings}{at}"
        )


def _check_planes(file: RunsFile, k: int, names: Iterable[object]) -> Iterator[Problem]:
    """Yield names under `weights` of the k-th run that are no planes."""
    for name in names:
        if isinstance(name, str) and name not in file.planes:
            hint = suggest_nearest(name, file.planes, f"there are {', '.join(file.planes)}")
            yield Problem(f"run.{k}.weights.{printable(name)}", f"is no plane; {hint[:200]}")

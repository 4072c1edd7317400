"""Find the numbers of an engine file by dotted names (`rod.ratio`, `crank.throws.2`,
`shaft.1.unbalance`), and read the values that a user gives for them.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..engine.layout import plan_cylinders
from ..errors import BalcliError, refuse_more, wrong_type
from ..file.fields import Number, nearest, shorten
from ..file.messages import BESIDE_ENGINES, DEVICES, SYNONYMS
from ..file.model import EngineFile, Frame, Gear, Override, Piston, Shaft
from ..file.table import FileTable, find_number
from ..file.units import BARE_FIGURE, FORTRAN, convert_exactly, refuse_thousands
from ..limits import LONGEST_FIGURE, MOST_PARAMETER_VALUES, MOST_PARAMETERS
from ..show.sheet import count_name


@dataclass(frozen=True)
class Parameter:
    """A number of the file and its values, shape (values,), in the unit of the file."""

    path: str
    values: NDArray[np.float64]
    unit: str = ""

    def __len__(self) -> int:
        return len(self.values)


def tell_variant(figures: Mapping[str, float]) -> str:
    """Return a variant's figures as text for messages: `rod.length = 150, piston.mass = 0.5`."""
    if len(figures) > MOST_PARAMETERS:
        return "a variant"
    return ", ".join(f"{path} = {value:g}" for path, value in figures.items())


# ------------------------------------------------------------------ numbers of a file
class Place(NamedTuple):
    """The place of a number in an engine file.

    Attributes:
        reader: Reader of the figure, which knows its unit and bounds.
        table: Type of the table that contains it.
        key: Key in this table.
        value: Value in the file; None: not given.
    """

    reader: Number
    table: type[FileTable]
    key: str
    value: object


# Keys without effect on any quantity: directions, and keys that only `--only parts` uses.
_SHOWN_ALONE = {
    (Frame, "up"),
    (Frame, "crankcase"),
    (Piston, "skirt"),
    (Shaft, "bearings"),
    (Shaft, "drag"),
}
_SHOWN_ALONE |= {(Gear, key) for key in Gear.model_fields}


def find_numbers(model: EngineFile) -> dict[str, Number]:
    """Return the reader of each number that the engine file has or might have, by dotted name."""
    return {path: place.reader for path, place in find_places(model).items()}


def find_places(model: EngineFile) -> dict[str, Place]:
    """Return the place of each number that the engine file has or might have, by dotted name;
    members of lists count from 1.
    """
    if model.engine:
        return _find_places_of_several(model)
    plan = plan_cylinders(model)
    tables = dict(model.tables())
    for number in plan.numbers:
        tables.setdefault(f"cylinder.{number}", Override.model_construct())
    numbers: dict[str, Place] = {}
    for path, table in tables.items():
        numbers |= _numbers_of(path, table)
    idle = {*_list_idle_paths(model, numbers)}
    if plan.banks != 2:  # an angle would turn the engine into a vee
        idle.add("layout.bank_angle")
    if not plan.in_rows:  # a row angle would renumber the cylinders
        idle.add("layout.row_angle")
    drifting = [path for path, table in tables.items() if isinstance(table, Shaft) and table.drifts]
    varied = {}
    for path, place in numbers.items():
        if path.rpartition(".")[0] in drifting:  # no quantity depends on it
            continue
        alone = (place.table, place.key) in _SHOWN_ALONE
        if not (path in idle or alone or re.match(_FIXED, path)):
            varied[path] = place
    return varied


def _find_places_of_several(model: EngineFile) -> dict[str, Place]:
    """Return the numbers that have an effect, of a file with [[engine]] and its engines' files."""
    numbers: dict[str, Place] = {}
    for path, table in model.tables():
        if path.partition(".")[0] in BESIDE_ENGINES:
            numbers |= _numbers_of(path, table)
    for path in ("frame.up", "frame.crankcase", "engine.1.phase"):  # phases: relative to engine 1
        numbers.pop(path, None)
    of_whole = set(BESIDE_ENGINES).difference(DEVICES, ("flywheel",))
    for k, crank in enumerate(model.cranks, 1):
        own = find_places(crank)
        for path, place in own.items():
            if path.partition(".")[0] not in {*of_whole, *_IDLE_TABLES}:
                numbers[f"engine.{k}.{path}"] = place
    return numbers


_IDLE_TABLES = ("torsion", "locomotive", "axle")  # tables without effect in geared engines
# Numbers that cannot vary: firing intervals, which add up to a cycle, and numbers that only
# `locomotive` reads.
_FIXED = r"layout\.firing_intervals\.|locomotive\.(?!coupling)|axle\..*\.(part|wheel_load)$"


def _list_idle_paths(model: EngineFile, numbers: Iterable[str]) -> list[str]:
    """Return the numbers of the gas that have no effect: `gas` and `heat` of cylinders if there
    is no [gas], keys for another kind of cycle, and keys that every cylinder overrides.
    """
    own = [path for path in numbers if path.startswith("cylinder.")]
    if model.gas is None:
        return [path for path in own if path.endswith((".gas", ".heat"))]
    cylinders = {*plan_cylinders(model).numbers}
    with_diagram = {n for n, table in model.cylinder.items() if table.indicator is not None}
    if model.gas.has("indicator"):
        with_diagram = cylinders
    with_heat = {n for n, table in model.cylinder.items() if table.heat is not None}
    computed = model.gas.cycle is not None and not cylinders <= with_diagram
    idle = model.gas.list_idle_keys(model.layout.strokes, bool(with_diagram), computed)
    if cylinders <= with_diagram | with_heat:
        idle.update(model.gas.goals)
    heats = {f"cylinder.{n}.heat" for n in (with_diagram if computed else cylinders)}
    return [path for path in numbers if path in heats or path.removeprefix("gas.") in idle]


def _numbers_of(start: str, table: FileTable) -> Iterator[tuple[str, Place]]:
    """Yield the numbers of a table, with the existing members of its lists and inner tables."""
    kind = type(table)
    for key, value in table:
        path = f"{start}.{key}"
        reader = find_number(kind, key)
        field = kind.model_fields[key]
        if isinstance(value, FileTable):
            yield from _numbers_of(path, value)
        elif isinstance(value, tuple):
            for k, item in enumerate(value, 1):
                if isinstance(item, FileTable):
                    yield from _numbers_of(f"{path}.{k}", item)
                elif isinstance(item, tuple) and reader is not None:
                    names = ((f"{path}.{k}.{j}", one) for j, one in enumerate(item, 1))
                    yield from ((name, Place(reader, kind, key, one)) for name, one in names)
                elif reader is not None:
                    alike = any(getattr(mark, "copies", 0) > 1 for mark in field.metadata)
                    if k == 1 and alike and len(set(value)) == 1:
                        yield path, Place(reader, kind, key, item)  # one name for all members
                    yield f"{path}.{k}", Place(reader, kind, key, item)
        elif reader is not None and (value is not None or "tuple" not in str(field.annotation)):
            yield path, Place(reader, kind, key, value)


# ------------------------------------------------------------------ names and values from users
def parse_parameter(text: str, model: EngineFile) -> Parameter:
    """Return the parameter for a text `path=from:to:step` (`to` is included if a step meets it) or
    `path=a,b,c`; figures may have units.

    Raises:
        BalcliError: The file has no such number (the message suggests the nearest name), there are
            no values, or values are out of bounds.
    """
    path, equals, wanted = (part.strip() for part in text.partition("="))
    if not equals or not path:
        raise BalcliError(
            f'"{text}": give a number of the engine file and its values, such as '
            "rod.ratio=0.24:0.32:0.01"
        )
    return choose_values(path, wanted, model)


def choose_values(path: str, values: ArrayLike, model: EngineFile) -> Parameter:
    """Return the parameter for a number of the file and its values.

    Values are one number, or a list or array of numbers, in the unit of the file; texts with units;
    or one text as in `parse_parameter`, such as "0.24:0.32:0.01".

    Raises:
        BalcliError: The name or a value is wrong; see `parse_parameter`.
        TypeError: The values have a wrong type.
    """
    numbers = find_numbers(model)
    where = shorten(f"{path}={values}") if isinstance(values, str) else path
    path = resolve_name(path, numbers)
    if path not in numbers:
        raise BalcliError(_describe_unknown(path, numbers, model))
    number = numbers[path]
    try:
        if isinstance(values, str):
            array = _read_values(values, number)
        else:
            array = _read_array(path, values, number)
        where = path
        for extreme in (array.min(), array.max()):
            number.read(float(extreme))
    except OverflowError:
        raise BalcliError(f"{where}: has too large a number") from None
    except ValueError as error:
        raise BalcliError(f"{where}: {error}") from None
    return Parameter(path, array, number.dimension.unit)


def _read_array(path: str, values: ArrayLike, number: Number) -> NDArray[np.float64]:
    """Return one number, or a list or array of numbers, as an array; members may be texts with
    units.
    """
    refuse_more(path, values, MOST_PARAMETER_VALUES)
    if isinstance(values, range):
        values = np.fromiter(values, float, len(values))  # a list takes much more memory
    try:
        array = np.atleast_1d(np.asarray(values, dtype=float))
    except (TypeError, ValueError, OverflowError):
        if not isinstance(values, (list, tuple)):
            wanted = "give numbers, such as [0.24, 0.28], or a range 0.24:0.32:0.01"
            raise wrong_type(path, values, wanted) from None
        array = np.array([number.read(value) for value in values])
    if array.ndim != 1 or not 0 < array.size <= MOST_PARAMETER_VALUES:
        raise ValueError(
            f"values of shape {array.shape}; give a list or an array of one axis with 1 to "
            f"{MOST_PARAMETER_VALUES} values"
        )
    return array


def resolve_name(name: str, numbers: Mapping[str, Number]) -> str:
    """Return the dotted name for a short name: `crank.stroke` for `stroke`, `operation.speed` for
    `rpm` or `speed`. Ambiguous and unknown names are returned unchanged.
    """
    if name in numbers:
        return name
    for called in ((name,), SYNONYMS.get(name.lower(), ())):
        meant = [path for path in numbers if path.rpartition(".")[2] in called]
        general = [path for path in meant if not path.startswith("cylinder.")]
        if meant := general or meant:
            return meant[0] if len(meant) == 1 else name
    return name


def _describe_unknown(path: str, numbers: Mapping[str, Number], model: EngineFile) -> str:
    """Return the message for an unknown name. It suggests `rod.length` for rod_length, the numbers
    of a table for the table's name, or the nearest name.
    """
    if path.startswith("layout.firing_intervals."):
        return f"{path}: firing intervals add up to a cycle, so that a single one cannot vary"
    if _list_idle_paths(model, [path]) and model.gas is not None:
        return f"{path} has no effect on the gas of this file"
    if members := [name for name in numbers if re.fullmatch(rf"{re.escape(path)}\.\d+", name)]:
        return f"{path} is a list of {len(members)}; vary {members[0]} to {members[-1]}"
    dotted = path.replace("_", ".", 1)
    meant = [name for name in numbers if name == dotted or name.startswith(f"{path}.")]
    meant = meant or [name for name in numbers if f".{path}_" in f"{name}_"]
    near = " or ".join(meant[:6]) or nearest(path, numbers)
    hint = f"did you mean {near}?" if near else "balcli numbers lists them"
    return f"{path}: unknown parameter; {hint}"


def _read_values(text: str, number: Number) -> NDArray[np.float64]:
    if ":" not in text:
        figures = [_read_exactly(part, number) for part in text.split(",") if part.strip()]
        if not figures:
            raise ValueError("has no values; give some, such as 0.24,0.28 or 0.24:0.32:0.01")
        return np.array([float(f) for f in figures])
    parts = text.split(":")
    if len(parts) != 3:
        raise ValueError("a range is from:to:step, such as 0.24:0.32:0.01")
    first, last, step = (_read_exactly(part, number) for part in parts)
    if step == 0:
        raise ValueError("the step is 0; give the distance of neighbouring values")
    count = math.floor((last - first) / step) + 1
    if not 0 < count <= MOST_PARAMETER_VALUES:
        raise ValueError(
            f"has {count_name(max(count, 0))} values; give a step with 1 to "
            f"{count_name(MOST_PARAMETER_VALUES)} values from the first to the last"
        )
    return ladder(first, step, count)


def ladder(first: Fraction, step: Fraction, count: int) -> NDArray[np.float64]:
    """Return `first + k * step` for k = 0 .. count - 1, each correctly rounded."""
    scale = math.lcm(first.denominator, step.denominator)
    start = int(first * scale)
    rise = int(step * scale)
    return np.fromiter(((start + rise * k) / scale for k in range(count)), float, count)


def _read_exactly(text: str, number: Number) -> Fraction:
    """Return a figure as an exact fraction in the unit of `number`. With rounded figures, a range
    might miss its last value.
    """
    figure = re.sub(FORTRAN, r"e\1", text.strip())
    try:
        if len(figure) <= LONGEST_FIGURE and re.fullmatch(BARE_FIGURE, figure, re.ASCII):
            refuse_thousands(figure, bare := Fraction(figure), number.dimension)
            return bare
        return convert_exactly(figure, number.dimension)
    except ValueError as error:
        raise ValueError(f"{shorten(figure)} {error}") from None

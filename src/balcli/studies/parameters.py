"""Numbers of an engine file by dotted names (`rod.ratio`, `crank.throws.2`, `shaft.1.unbalance`):
found, checked, replaced.

The model is frozen; `varied` makes a copy in which numbers are replaced by arrays, each along an
axis of its own.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from typing import TYPE_CHECKING, Any, get_args

import numpy as np
from numpy.typing import NDArray

from ..enginefile.fields import Number, nearest
from ..enginefile.messages import DEVICES, TABLES
from ..enginefile.model import EngineFile, Override, Table
from ..enginefile.units import convert
from ..errors import BalcliError
from ..limits import MOST_PARAMETER_VALUES

if TYPE_CHECKING:
    from ..engine.layout import Plan

_EXACT = 2**53  # whole numbers below it are exact as floating-point numbers
_FIGURE = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d{1,3})?")


@dataclass(frozen=True)
class Parameter:
    """A number of the file, and the values that it takes, shape (values,)."""

    path: str
    values: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.values)


# ------------------------------------------------------------------ which numbers there are
def numeric(file: EngineFile) -> dict[str, Number]:
    """All numbers that an engine file has or might have, by dotted name; members of lists count
    from 1.
    """
    found: dict[str, Number] = {}
    for key, table in TABLES.items():
        if key != "bobweight" and getattr(file, key) is not None:  # bobweights move nothing
            found |= _numbers(key, table, getattr(file, key))
    for key, table in DEVICES.items():
        for k, device in enumerate(getattr(file, key), 1):
            found |= _numbers(f"{key}.{k}", table, device)
    layout = _plan(file)
    for number in {*file.cylinder, *layout.numbers}:
        found |= _numbers(f"cylinder.{number}", Override, file.cylinder.get(number))
    if len(layout.banks) != 2:  # it would make a vee of the engine, with other cylinders
        found.pop("layout.bank_angle", None)
    return found


def _numbers(path: str, table: type[Table], value: Any) -> Iterator[tuple[str, Number]]:
    """Names below `path`; lists and inner tables only as far as the file has them."""
    for key, field in table.model_fields.items():
        inside = getattr(value, key, None)
        if isinstance(inside, Table):
            yield from _numbers(f"{path}.{key}", type(inside), inside)
        elif isinstance(inside, tuple) and inside and isinstance(inside[0], Table):
            for k, item in enumerate(inside, 1):
                yield from _numbers(f"{path}.{key}.{k}", type(item), item)
        elif (number := _number(table, key)) is not None:
            if isinstance(inside, tuple):
                yield from ((f"{path}.{key}.{k}", number) for k in range(1, len(inside) + 1))
            elif "tuple" not in str(field.annotation):
                yield f"{path}.{key}", number


@cache
def _number(table: type[Table], key: str) -> Number | None:
    """How a field is read, if it is a number or a list of them (whole numbers change what the
    engine is made of).
    """
    field = table.model_fields[key]
    return next(
        (n for n in (*field.metadata, *_marks(field.annotation)) if isinstance(n, Number)), None
    )


def _marks(annotation: Any) -> Iterator[Any]:
    for part in get_args(annotation):
        if isinstance(part, type) and issubclass(part, Table):
            continue
        yield part
        yield from _marks(part)


def _plan(file: EngineFile) -> Plan:
    from ..engine.layout import plan

    return plan(file.crank, file.layout)


# ------------------------------------------------------------------ what a user asks for
def parse(text: str, file: EngineFile) -> Parameter:
    """`path=from:to:step` (ends included) or `path=a,b,c`; figures may bear units.

    Raises:
        BalcliError: no such number in the file (with the nearest name), no values, or values out of
        its bounds.
    """
    path, equals, wanted = (part.strip() for part in text.partition("="))
    known = numeric(file)
    if not equals or not path:
        raise BalcliError(
            f'"{text}": give a number of the engine file and its values, such as '
            "rod.ratio=0.24:0.32:0.01"
        )
    if path not in known:
        raise BalcliError(_unknown(path, known))
    try:
        values = _values(wanted, known[path])
    except (ValueError, OverflowError) as error:
        raise BalcliError(f'"{text}": {error}') from None
    return Parameter(path, checked(path, known[path], values))


def _unknown(path: str, known: Mapping[str, Number]) -> str:
    near = nearest(path, known)
    table = [name for name in known if name.split(".")[0] == path.split(".")[0]] or list(known)
    hint = (
        f"did you mean {near}?"
        if near
        else f"there are {', '.join(table[:6])}{' ...' if len(table) > 6 else ''}"
    )
    return f"{path} is no number of this engine file; {hint}"


def checked(path: str, number: Number, values: NDArray[np.float64]) -> NDArray[np.float64]:
    """The values, if the field allows them all.

    Raises:
        BalcliError: the first extreme that it does not.
    """
    for extreme in (values.min(), values.max()):
        try:
            number.read(float(extreme))
        except ValueError as error:
            raise BalcliError(f"{path}: {error}") from None
    return values


def _values(text: str, number: Number) -> NDArray[np.float64]:
    if ":" not in text:
        figures = [_exact(part, number) for part in text.split(",") if part.strip()]
        if not figures:
            raise ValueError("has no values; give some, such as 0.24,0.28 or 0.24:0.32:0.01")
        return np.array([float(f) for f in figures])
    parts = text.split(":")
    if len(parts) != 3:
        raise ValueError("a range is from:to:step, such as 0.24:0.32:0.01")
    first, last, step = (_exact(part, number) for part in parts)
    if step == 0:
        raise ValueError("the step is 0; give the distance of neighbouring values")
    count = math.floor((last - first) / step) + 1
    if not 0 < count <= MOST_PARAMETER_VALUES:
        raise ValueError(
            f"has {max(count, 0)} values; give a step that leads from the first to the last in at "
            f"most {MOST_PARAMETER_VALUES:g} steps"
        )
    return ladder(first, step, count)


def ladder(first: Fraction, step: Fraction, count: int) -> NDArray[np.float64]:
    """first + k step for k = 0 .. count-1, each correctly rounded."""
    scale = math.lcm(first.denominator, step.denominator)
    start, rise = int(first * scale), int(step * scale)
    if max(abs(start), abs(start + rise * count), scale) < _EXACT:
        return (start + rise * np.arange(count)) / scale
    return np.array([(start + rise * k) / scale for k in range(count)])


def _exact(text: str, number: Number) -> Fraction:
    """The figure in the bare unit of its field."""
    if _FIGURE.fullmatch(text.strip()):
        return Fraction(text.strip())
    try:
        return Fraction(convert(text, number.dimension))
    except ValueError as error:
        raise ValueError(f'"{text.strip()}" {error}') from None


# ------------------------------------------------------------------ replaced
def varied(file: EngineFile, numbers: Mapping[str, Any]) -> EngineFile:
    """The file with numbers replaced, by arrays too; what says the same otherwise (rod.length
    beside rod.ratio) gives way.

    A firing order beside given throws is left out: it would have to fit every variant, and adds
    nothing.

    Raises:
        BalcliError: a number of which the file gives only the alternative (a mass for which it has
        an unbalance).
    """
    if file.crank.throws is not None:
        file = file.model_copy(
            update={
                "layout": file.layout.model_copy(
                    update={"firing_order": None, "firing_intervals": None}
                )
            }
        )
    for path, value in numbers.items():
        file = _replaced(file, path.split("."), value, path)
    return file


def _replaced(node: Any, keys: Sequence[str], value: Any, path: str) -> Any:
    """A copy of a table, list or mapping with one number in it replaced."""
    if not keys:
        return value
    key, *rest = keys
    if isinstance(node, tuple):
        row = int(key) - 1
        return (*node[:row], _replaced(node[row], rest, value, path), *node[row + 1 :])
    if isinstance(node, dict):
        return node | {
            int(key): _replaced(node.get(int(key), Override.model_construct()), rest, value, path)
        }
    gone = {} if rest else _giving_way(node, key, path)
    return node.model_copy(update={key: _replaced(getattr(node, key), rest, value, path), **gone})


def _giving_way(table: Table, key: str, path: str) -> dict[str, None]:
    """What else in the table says the same as `key`."""
    others: dict[str, None] = {}
    for choice in table.choices:
        own = next((group for group in choice.groups if key in group), ())
        rest = [
            k
            for group in choice.groups
            if own and group != own
            for k in group
            if getattr(table, k) is not None
        ]
        if rest and any(getattr(table, k) is None for k in own if k != key):
            raise BalcliError(
                f"{path}: the file gives {' and '.join(rest)} instead; vary that, or give "
                f"{' and '.join(own)} in the file"
            )
        others |= dict.fromkeys(rest)
    return others

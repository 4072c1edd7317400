"""Records: a figure of a result is declared once, as an attribute of a record.

A record is a frozen dataclass, or a NamedTuple, which is quicker to import; quicker still without
`from __future__ import annotations`, which turns annotations into text that NamedTuple compiles. A
result is a tree of records. JSON and its schema derive from the attributes. CSV has a row for each
figure of the JSON document, unless the result defines rows of its own. A DataFrame has the same
rows as CSV, unless the renderer of the result (`show.result`) makes columns. The name of an
attribute is its key in JSON and its path in CSV (`worst.speed_rpm`); the end of the name is its
unit. The annotation is its type. Its line in the docstring's `Attributes:` is its description in
the JSON Schema.

    to_document(record)       the JSON object
    list_figures(document)    the numbers and words outside lists, for the lines of CSV
    describe_record(kind)     the JSON Schema

Rules:

* An attribute with the default None is optional: if it is None, its key is omitted. An attribute
  `Asked` is optional, too; reading it raises an error if it was not computed.
* A real number that is not finite becomes null; a negative zero becomes 0.
* A complex number, which has to be finite, becomes a list of its real and imaginary part; CSV
  omits lists.
* Marks in `Annotated`: `Polar` writes a complex number as magnitude and angle, `Reached` a peak as
  its value and its crank angle, `WrittenAs` a value as the record that a function makes of it.
  `Axes(2)` declares an array of two axes (without the mark: one). `INLINE` lifts the keys of a
  record, a dict or a `Polar` into the parent object. `Keys` declares the keys of such a dict.
  `HIDDEN` keeps an attribute out of documents.

Example::

    @dataclass(frozen=True, kw_only=True)
    class Weight:
        '''A weight in a plane.

        Attributes:
            force: Centrifugal force.
            radius_mm: Radius of the weight; left out where the file has none.
        '''

        force: Annotated[complex, Polar("force_N", "angle_deg"), INLINE]
        radius_mm: float | None = None

    to_document(Weight(force=3j))      # {"force_N": 3.0, "angle_deg": 90.0}
"""

import math
import re
from collections.abc import Callable, Collection, Iterator, Mapping
from copy import copy
from dataclasses import fields, is_dataclass
from functools import cache
from inspect import cleandoc
from types import NoneType, UnionType
from typing import (
    Annotated,
    Any,
    Generic,
    Literal,
    NamedTuple,
    TypeVar,
    Union,
    get_args,
    get_origin,
    get_type_hints,
    overload,
)

from ..errors import NotComputedError

Node = dict[str, Any]  # an object of JSON

# Units by the ending of a name. Longer endings come before shorter ones that they contain.
UNITS = {
    "Nms_per_rad": "N·m·s/rad",
    "Nm_per_rad": "N·m/rad",
    "Nm_per_kW": "N·m/kW",
    "N_per_m": "N/m",
    "m_per_s2": "m/s²",
    "m_per_s": "m/s",
    "kg_m2": "kg·m²",
    "kg_m": "kg·m",
    "g_mm": "g·mm",
    "percent": "%",
    "km_h": "km/h",
    "Nm": "N·m",
    "m3": "m³",
    **{unit: unit for unit in ("rpm", "deg", "mm", "Hz", "Pa", "kg", "N", "J", "W", "m")},
}
IN_CSV = str.maketrans("·²³", " 23")  # units in plain characters


class Polar(NamedTuple):
    """Mark of a complex number that is written as magnitude and angle, under these keys.

    The angle is in degrees, 0 <= angle < 360, and null where the magnitude is 0.
    """

    magnitude: str
    angle: str

    def split(self, value: complex) -> Node:
        """Return the JSON object of a value."""
        angle = angle_deg(value) if value else None
        return {self.magnitude: float(abs(value)), self.angle: angle}


class Reached(NamedTuple):
    """Mark of a peak (`core.peaks.Peak`) that is written as its value and first crank angle, under
    these keys.

    The angle is in degrees, and null where the value is 0.
    """

    value: str
    angle: str

    def split(self, peak: Any) -> Node:
        """Return the JSON object of a peak."""
        at = math.degrees(peak.theta) if peak.value else None
        return {self.value: write_each(peak.value), self.angle: at}


class WrittenAs(NamedTuple):
    """Mark of a value that documents show in another form (`make` returns a record, or list of
    records) or under another key. The schema describes the return type of `make`.
    """

    make: Callable[..., object] | None = None  # None: the value is written as it is
    key: str = ""  # key in JSON; empty: the name of the attribute


class Axes(NamedTuple):
    """Mark of an array: its number of axes."""

    number: int


T = TypeVar("T")


class Asked(Generic[T]):
    """An attribute of a record that exists only on request. If it was not computed, reading it
    raises NotComputedError, `hasattr` is false, and documents omit its key. Type checkers see the
    attribute as present.

    Args:
        how: How to ask for it, for the message: `only=["peak"]`.

    Example::

        @dataclass(frozen=True, eq=False)
        class Report:
            peak: Asked[float] = Asked('only=["peak"]')
    """

    def __init__(self, how: str) -> None:
        self.how = how

    def __set_name__(self, record: type, name: str) -> None:
        self.name = name

    @overload
    def __get__(self, record: None, kind: type) -> None: ...

    @overload
    def __get__(self, record: object, kind: type) -> T: ...

    def __get__(self, record: object | None, kind: type) -> T | None:
        if record is None:  # the class is asked: this is the default of the attribute
            return None
        value: T | None = record.__dict__[self.name]
        if value is None:
            raise NotComputedError(f"{self.name} was not computed; ask for it with {self.how}")
        return value

    def __set__(self, record: object, value: T | None) -> None:
        record.__dict__[self.name] = value


class Key(NamedTuple):
    """A key of a dict: type and description of its value."""

    kind: type
    description: str


class Keys(NamedTuple):
    """Mark of an `INLINE` dict: the keys that it may have, in the order of the schema."""

    known: Mapping[str, Key]


INLINE = "inline"
HIDDEN = "hidden"


def angle_deg(value: complex) -> float:
    """Return the angle of a complex number, deg, 0 <= angle < 360."""
    angle = math.degrees(math.atan2(value.imag, value.real)) % 360
    return 0.0 if angle == 360 else angle


class _Attribute(NamedTuple):
    name: str
    key: str  # in JSON
    kind: object  # annotation without marks
    optional: bool
    inline: bool
    axes: int
    split: Polar | Reached | None
    make: Callable[..., object] | None
    keys: Mapping[str, Key]


@cache
def _list_attributes(record: type) -> tuple[_Attribute, ...]:
    """Return the attributes that documents show, in the order of declaration."""
    hints = get_type_hints(record, include_extras=True)
    found = ((*each, hints[each[0]], _find_marks(hints[each[0]])) for each in _list_names(record))
    return tuple(_read_marks(*each) for each in found if HIDDEN not in each[3])


def _list_names(record: Any) -> list[tuple[str, bool]]:
    """Return the names of all attributes, and whether each is optional."""
    if is_dataclass(record):
        return [(each.name, each.default is None) for each in fields(record)]
    return [(name, record._field_defaults.get(name, "") is None) for name in record._fields]


def _read_marks(name: str, optional: bool, kind: object, marks: tuple[object, ...]) -> _Attribute:
    split = next((mark for mark in marks if isinstance(mark, (Polar, Reached))), None)
    axes = next((mark.number for mark in marks if isinstance(mark, Axes)), 1)
    make, key = next((mark for mark in marks if isinstance(mark, WrittenAs)), (None, ""))
    keys: Mapping[str, Key] = next((mark.known for mark in marks if isinstance(mark, Keys)), {})
    return _Attribute(name, key or name, kind, optional, INLINE in marks, axes, split, make, keys)


def _find_marks(annotation: object) -> tuple[object, ...]:
    """Return the marks that `Annotated` adds to a type and to the types within it."""
    inner = (mark for part in get_args(annotation) for mark in _find_marks(part))
    return (*getattr(annotation, "__metadata__", ()), *inner)


def change_attributes(record: T, **changes: object) -> T:
    """Return a copy of a record with other values of some attributes. `dataclasses.replace` would
    read attributes that were not computed.
    """
    changed = copy(record)
    for name, value in changes.items():
        object.__setattr__(changed, name, value)  # the record is frozen
    return changed


# ------------------------------------------------------------------ JSON
def to_document(record: Any) -> Node:
    """Return the JSON object of a record.

    Args:
        record: Record whose attributes are numbers, words, arrays, records, or
            lists and dicts of these.
    """
    document: Node = {}
    for attribute in _list_attributes(record.__class__):
        value = getattr(record, attribute.name, None)
        if value is None and attribute.optional:
            continue
        if attribute.make is not None:
            value = attribute.make(value)
        written = write_each(value, attribute.split)
        document |= written if attribute.inline else {attribute.key: written}
    return document


def write_each(value: Any, split: Polar | Reached | None = None) -> Any:
    """Return a number, word or record, or a list or dict of these, in its JSON form.

    Args:
        value: Value to write.
        split: Mark that splits one value into several keys; None if there is no such mark.
    """
    if hasattr(value, "tolist"):  # an array or number of numpy (not imported here)
        value = value.tolist()
    if isinstance(value, float):
        return value + 0.0 if math.isfinite(value) else None
    if value is None or (split is None and isinstance(value, (int, str))):
        return value
    if isinstance(value, (list, tuple)) and not hasattr(value, "_fields"):
        return [write_each(item, split) for item in value]
    if isinstance(value, Mapping):
        return {key: write_each(item, split) for key, item in value.items()}
    return split.split(value) if split is not None else _write_whole(value)


def _write_whole(value: Any) -> Any:
    """Return a complex number as a list of its two parts, and a record as a document."""
    if isinstance(value, complex):
        return [value.real + 0.0, value.imag + 0.0]
    return to_document(value)


# ------------------------------------------------------------------ CSV
class Figure(NamedTuple):
    """A number or word of a document, with its path (`worst.speed_rpm`) and its unit."""

    name: str
    value: float | bool | str | None
    unit: str


def list_figures(document: Node, without: Collection[str] = (), path: str = "") -> Iterator[Figure]:
    """Yield one figure for every number and word of a document; lists of numbers are omitted.

    Args:
        document: Result of `to_document`, or an object in it.
        without: Keys to omit, such as keys that have columns of their own.
        path: Beginning of all names.
    """
    for key, value in document.items():
        if key in without:
            continue
        if isinstance(value, dict):
            yield from list_figures(value, (), f"{path}{key}.")
        elif isinstance(value, list):
            for k, item in enumerate(value, 1):
                if isinstance(item, dict):
                    yield from list_figures(item, (), f"{path}{key}.{k}.")
        else:
            yield Figure(f"{path}{key}", value, find_unit(key).translate(IN_CSV))


def list_series(document: Node, place: int) -> Iterator[Figure]:
    """Yield one figure for every list of numbers in a document.

    Args:
        document: JSON object with lists of numbers.
        place: Index in each list, from 0.
    """
    for key, value in document.items():
        if isinstance(value, list) and value and not isinstance(value[0], (dict, list)):
            yield Figure(key, value[place], find_unit(key).translate(IN_CSV))


@cache  # a record has few different keys, many times
def find_unit(key: str) -> str:
    """Return the unit with which a key ends; empty if there is none."""
    return next((UNITS[end] for end in UNITS if key == end or key.endswith(f"_{end}")), "")


def remove_unit(key: str) -> str:
    """Return a key without its final unit: `inertia` for `inertia_kg_m2`."""
    return next((key.removesuffix(f"_{end}") for end in UNITS if key.endswith(f"_{end}")), key)


# ------------------------------------------------------------------ JSON Schema
_SIMPLE: dict[object, str] = {bool: "boolean", int: "integer", str: "string", NoneType: "null"}
_NUMBER = {"type": ["number", "null"]}
_ATTRIBUTE = re.compile(r"^ {4}(\w+): (.*(?:\n {8}.*)*)", re.MULTILINE)


def describe_record(record: type) -> Node:
    """Return the JSON Schema of the documents that `to_document` makes of a class of records."""
    definitions: Node = {}
    node = _describe_class(record, definitions)
    return {**node, "$defs": definitions} if definitions else node


def _describe_class(record: type, definitions: Node) -> Node:
    summary, _, rest = cleandoc(record.__doc__ or "").partition("\n\n")
    texts = dict(_ATTRIBUTE.findall(rest.partition("Attributes:\n")[2]))
    properties: Node = {}
    further: Node = {}
    required: list[str] = []
    for attribute in _list_attributes(record):
        for name, (kind_of_key, meaning) in attribute.keys.items():
            node = _describe(kind_of_key, attribute, definitions)
            properties[name] = {"description": _with_unit(meaning, name)} | node
        if attribute.keys:
            continue
        kind = attribute.kind
        if attribute.make is not None:
            kind = get_type_hints(attribute.make)["return"]
        node = _describe(kind, attribute, definitions)
        if attribute.inline and "$ref" in node:
            node = definitions[node["$ref"].rpartition("/")[2]]
        elif attribute.inline and "properties" not in node:  # a dict of any keys
            further |= node
            continue
        parts = node["properties"] if attribute.inline else {attribute.key: node}
        for key, part in parts.items():
            text = "" if attribute.inline else " ".join(texts.get(attribute.name, "").split())
            text = _with_unit(text, key)
            properties[key] = {"description": text} | part if text else part
        if not attribute.optional:
            required += node.get("required", ()) if attribute.inline else (attribute.key,)
    return further | {
        "type": "object",
        "description": " ".join(summary.split()),
        "properties": properties,
        "required": required,
    }


def _with_unit(text: str, key: str) -> str:
    """Return a description, followed by the unit with which its key ends."""
    unit = find_unit(key)
    return " ".join(filter(None, (text, unit and f"[{unit}]")))


def _describe(kind: object, attribute: _Attribute, definitions: Node) -> Node:
    """Return the schema of a type within the annotation of an attribute."""
    origin = get_origin(kind)
    arguments = get_args(kind)
    if origin in (Annotated, Asked):
        return _describe(arguments[0], attribute, definitions)
    if origin in (Union, UnionType):
        kinds = [one for one in arguments if not (one is NoneType and attribute.optional)]
        nodes = [_describe(one, attribute, definitions) for one in kinds]
        return nodes[0] if len(nodes) == 1 else {"anyOf": nodes}
    if origin is Literal:
        if len(arguments) == 1:
            return {"type": "string", "const": arguments[0]}
        return {"type": "string", "enum": [*arguments]}
    if origin is not None:
        return _describe_many(origin, arguments, attribute, definitions)
    return _describe_plain(kind, attribute, definitions)


def _describe_plain(kind: object, attribute: _Attribute, definitions: Node) -> Node:
    """Return the schema of a number, word or record."""
    if attribute.split is not None and kind is not NoneType:
        properties = dict.fromkeys(attribute.split, _NUMBER)
        return {"type": "object", "properties": properties, "required": [*properties]}
    if isinstance(kind, type) and (is_dataclass(kind) or hasattr(kind, "_fields")):
        name = kind.__name__
        if name not in definitions:
            definitions[name] = {}  # placeholder while its attributes are described
            definitions[name] = _describe_class(kind, definitions)
        return {"$ref": f"#/$defs/{name}"}
    if kind is Any:
        return {}
    if kind is complex:
        return {"type": "array", "items": _NUMBER}
    return {"type": _SIMPLE[kind]} if kind in _SIMPLE else _NUMBER


def _describe_many(
    origin: type, arguments: tuple[object, ...], attribute: _Attribute, definitions: Node
) -> Node:
    """Return the schema of an array, dict, tuple or list."""
    import numpy as np  # imported here, because schemas are rarely written

    if issubclass(origin, np.ndarray):
        node = _describe(float, attribute, definitions)
        for _ in range(attribute.axes):
            node = {"type": "array", "items": node}
        return node
    if issubclass(origin, Mapping):
        values = _describe(arguments[1], attribute, definitions)
        return {"type": "object", "additionalProperties": values}
    return {"type": "array", "items": _describe(arguments[0], attribute, definitions)}

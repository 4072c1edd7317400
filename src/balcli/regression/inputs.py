"""List the inputs of an engine (the values that its file gives), and compare them with those of a
record. They name the cause of changed figures: `crank.stroke: 86 -> 88 mm`.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from ..core.records import Node
from ..file.fields import RIGID, WrittenFigure
from ..file.lines import LineFinder
from ..file.messages import TEXTS
from ..file.model import EngineFile
from ..file.table import FileTable, find_number
from ..file.toml import locate_beside, read_bytes
from ..studies.parameters import find_numbers
from .records import ChangedInput

_DIGEST = 16  # number of hexadecimal digits of a digest in a record
_FILE_KEYS = ("indicator", "harmonics")  # keys that name a file with measured or printed figures
# Tables without effect on figures, and tables of geared engines that their common file replaces.
_WITHOUT_EFFECT = ("check",)
_OF_WHOLE = ("operation", *_WITHOUT_EFFECT)


class _Input(NamedTuple):
    """A value that an engine file gives.

    Attributes:
        key: Dotted name, in which members of lists count from 1.
        value: Value in the unit of the file, as JSON has it; for the name of a file, an object with
            the name and a digest of its content.
        unit: Unit; empty for plain numbers and texts.
    """

    key: str
    value: Any
    unit: str


def list_inputs(model: EngineFile) -> Node:
    """Return the inputs of an engine file by their keys, with those of the engines in [[engine]].
    Name and source of the engine are no inputs, because no figure depends on them.
    """
    return {given.key: given.value for given in _walk(model)}


def find_changed(
    model: EngineFile, recorded: Mapping[str, Any], lines: LineFinder
) -> tuple[ChangedInput, ...]:
    """Return the inputs that differ from recorded ones, in the order of the engine file; keys that
    the file no longer has come last. Of lists of equal length, only the changed members are named.

    Args:
        model: Engine file.
        recorded: Inputs of a record, by their keys.
        lines: Finder of the lines in the engine file.
    """
    present = {given.key: given for given in _walk(model)}
    changed = []
    for key in dict.fromkeys((*present, *recorded)):
        if key in present:
            _, now, unit = present[key]
        else:
            now = None
            unit = _find_unit(model, key)
        for place, before, after in _compare(key, recorded.get(key), now):
            changed.append(ChangedInput(place, before, after, unit, lines.find(place)))
    return tuple(changed)


def _compare(key: str, before: Any, after: Any) -> Iterator[tuple[str, Any, Any]]:
    """Yield key, recorded and present value of an input that changed, or of its changed members."""
    if before == after:
        return
    are_lists = isinstance(before, list) and isinstance(after, list)
    if not are_lists or len(before) != len(after):
        yield key, before, after
        return
    for number, (old, new) in enumerate(zip(before, after, strict=True), 1):
        yield from _compare(f"{key}.{number}", old, new)


def _find_unit(model: EngineFile, key: str) -> str:
    """Return the unit of a number that an engine file leaves out; empty if it is not known."""
    reader = find_numbers(model).get(key)
    return "" if reader is None else reader.dimension.unit


def _walk(model: EngineFile) -> Iterator[_Input]:
    """Yield the inputs of an engine file, then those of each file that its [[engine]] name."""
    yield from _walk_file(model, _WITHOUT_EFFECT)
    files = {table.file: crank for table, crank in zip(model.engine, model.cranks, strict=False)}
    for name, crank in files.items():
        for given in _walk_file(crank, _OF_WHOLE):
            yield given._replace(key=f"{name}: {given.key}")


def _walk_file(model: EngineFile, without: tuple[str, ...]) -> Iterator[_Input]:
    for key in type(model).model_fields:
        if key in model.model_fields_set and key not in (*TEXTS, *without):
            yield from _walk_value(model, key, getattr(model, key))


def _walk_value(model: EngineFile, path: str, value: object) -> Iterator[_Input]:
    """Yield the inputs of a table, or of the tables in a list or dict."""
    if isinstance(value, FileTable):
        yield from _walk_table(model, path, value)
    elif isinstance(value, Mapping):
        for name, part in value.items():
            yield from _walk_value(model, f"{path}.{name}", part)
    elif isinstance(value, tuple):
        for number, part in enumerate(value, 1):
            yield from _walk_value(model, f"{path}.{number}", part)


def _walk_table(model: EngineFile, path: str, table: FileTable) -> Iterator[_Input]:
    for name, field in type(table).model_fields.items():
        value = getattr(table, name)
        if name not in table.given or value is None:
            continue
        key = f"{path}.{field.alias or name}"
        if _has_tables(value):
            yield from _walk_value(model, key, value)
        elif name in _FILE_KEYS:
            yield _Input(key, _describe_file(model, str(value)), "")
        else:
            reader = find_number(type(table), name)
            unit = "" if reader is None else reader.dimension.unit
            yield _Input(key, _to_json(value), unit)


def _has_tables(value: object) -> bool:
    """Return whether a value is a table, or a list of tables."""
    if isinstance(value, tuple):
        return any(isinstance(part, FileTable) for part in value)
    return isinstance(value, FileTable)


def _describe_file(model: EngineFile, name: str) -> Node:
    """Return the name of a file and a digest of its content, in which line ends do not count: git
    may change them.
    """
    content = read_bytes(locate_beside(model.folder, name)).replace(b"\r\n", b"\n")
    return {"file": name, "sha256": hashlib.sha256(content).hexdigest()[:_DIGEST]}


def _to_json(value: object) -> Any:
    """Return a value as JSON has it. Words in place of numbers, such as "fit" and "rigid", remain
    words.
    """
    if isinstance(value, tuple):
        return [_to_json(part) for part in value]
    if value == math.inf:
        return RIGID
    if isinstance(value, WrittenFigure):
        return float(value) if math.isfinite(value) else value.text
    return value

"""Convert the tables of a Python user, or an engine file, to dicts, lists, numbers and texts.
Change these tables.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from ..core.records import Node
from ..errors import InputError, Problem, wrong_type
from ..limits import MOST_KEY_VALUES
from .fields import RIGID
from .firing_order import NamedOrder
from .model import EngineFile
from .table import FileTable, label_table
from .toml import name_file, parse_toml, read_bytes


def normalize_tables(tables: Mapping[Any, object]) -> Node:
    """Return tables from Python in the form that TOML has: keys become text, arrays and tuples
    become lists, numpy's numbers become Python's; None is omitted.

    Raises:
        InputError: A key is not a text or number, or a table contains itself.
    """
    try:
        return _plain_table(tables)
    except TypeError as error:
        raise InputError([Problem("", str(error))]) from None
    except RecursionError:
        message = "tables are nested too deeply; an engine file needs no more than four levels"
        raise InputError([Problem("", message)]) from None


def take_tables(function: str, source: object, wanted: str) -> tuple[Mapping[str, object], str]:
    """Return the tables of a source, and the name of its file (empty if the source is no file). A
    source is a path ("-": standard input), the text of a file (several lines), or a dict.

    Args:
        function: Function to which the source was given, for messages.
        source: Path, text or dict.
        wanted: Valid sources in words, for messages.

    Raises:
        BalcliError: The file cannot be read.
        InputError: The text is not TOML.
        TypeError: The source has another type.
    """
    if isinstance(source, Mapping):
        return normalize_tables(source), ""
    if isinstance(source, str) and "\n" in source:
        return parse_toml(source, ""), ""
    if isinstance(source, (str, Path)):
        name = name_file(source)
        return parse_toml(read_bytes(source), name), name
    raise wrong_type(function, source, wanted)


def _key(key: object) -> str:
    if isinstance(key, (str, int, np.integer)) and not isinstance(key, bool):
        return str(key)
    message = f"the key {str(key)[:60]} ({type(key).__name__}) is not a text"
    raise TypeError(f'{message}; write it as in a file, such as "stroke"')


_PLAIN = {str, float, int, bool}  # types of values that stay as they are


def _plain_table(table: Mapping[Any, object]) -> Node:
    """Return a table without keys whose value is None."""
    return {_key(key): _plain(value) for key, value in table.items() if value is not None}


def _plain(value: object) -> object:
    if type(value) in _PLAIN:
        return value
    if isinstance(value, Mapping):
        return _plain_table(value)
    if isinstance(value, np.generic) or (isinstance(value, np.ndarray) and value.ndim == 0):
        return value.tolist()
    if isinstance(value, (list, tuple, range, Iterator, np.ndarray)):
        return [_plain(inner) for inner in islice(value, MOST_KEY_VALUES + 1)]
    return value


def list_tables(value: object) -> Any:
    """Return a file, a table or a value as dicts, lists, numbers and texts, in the file's units."""
    if type(value) in _PLAIN:
        return RIGID if value == math.inf else value
    if isinstance(value, FileTable):
        return _list_fields(value)
    if isinstance(value, Mapping):
        return {str(key): list_tables(inner) for key, inner in value.items()}
    if isinstance(value, NamedOrder):
        return value.text
    if isinstance(value, tuple):
        return [list_tables(inner) for inner in value]
    return RIGID if value == math.inf else value


def _list_fields(table: FileTable, only: Collection[str] | None = None) -> Node:
    """Return the keys that a table gives, named as in a file; of these, `only` those with these
    names.
    """
    listed = {}
    for name, field in type(table).model_fields.items():
        key = field.alias or name
        if name not in table.model_fields_set or (only is not None and key not in only):
            continue
        value = getattr(table, name)
        if value is not None and value != ():
            listed[key] = list_tables(value)
    return listed


def change_tables(
    model: EngineFile, changes: Mapping[str, object], only: Collection[str] | None = None
) -> Node:
    """Return the tables of a file with other values of some keys.

    Args:
        model: Engine file.
        changes: Values by dotted names (`rod.length`, `crank.throws.2`, `mount.left.stiffness.1`);
            None removes a key. Equivalent keys (`rod.ratio` for `rod.length`) are removed, unless
            they are changed as well.
        only: Keys of the file whose tables are returned, those of all changes among them; None: all
            keys.

    Raises:
        InputError: A name refers to a member that a list of the file does not have.
    """
    tables = _list_fields(model, only)
    for path, value in changes.items():
        *parents, last = path.split(".")
        if path == "locomotive.speed":
            tables.get("operation", {}).pop("speed", None)
        place, given = _descend(tables, model, parents, path)
        if isinstance(place, list):
            place[_find_member(place, given, last, path)] = value
            continue
        start = path.removesuffix(last)
        for rival in given.rivals(last) if isinstance(given, FileTable) else ():
            if start + rival not in changes:
                place.pop(rival, None)
        place[last] = value
    return tables


def _descend(place: Any, given: Any, keys: Sequence[str], path: str) -> tuple[Any, Any]:
    """Return the table or list at these keys twice: from the written tables, and from the model
    (None if the model lacks it).
    """
    for key in keys:
        if isinstance(place, list):
            k = _find_member(place, given, key, path)
            place = place[k]
            given = given[k]
        else:
            given = _find_given(given, key)
            place = place.setdefault(key, list_tables(given) if isinstance(given, tuple) else {})
        if not isinstance(place, (dict, list)):
            raise InputError([Problem(path, f"{key} is a single value without parts")])
    return place, given


def _find_given(given: Any, key: str) -> Any:
    """Return what the model has at a key; None if it has nothing there."""
    if isinstance(given, dict) and given:
        by_name = {str(name): value for name, value in given.items()}
        return by_name.get(key)
    return getattr(given, key, None)


def _find_member(place: Sequence[Any], given: Any, key: str, path: str) -> int:
    """Return the index of the member of a list with this number (from 1) or name."""
    labels = []
    for k, member in enumerate(given, 1):
        labels.append(label_table(member, k) if isinstance(member, FileTable) else str(k))
    if key in labels:
        return labels.index(key)
    if key.isdecimal() and 0 < int(key) <= len(place):
        return int(key) - 1
    members = ", ".join(labels[:8]) or "none"
    raise InputError([Problem(path, f"there is no {key}; the file has {members}")])

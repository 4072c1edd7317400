"""Text of an engine file -> its tables, and every mistake that the text has, each by its path.

What the tables say against each other is not looked at here: that takes an engine (`engine.rules`).
"""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from ..errors import CONTROL_CHARACTERS, InputError, Problem
from ..limits import LONGEST_NAME
from .fields import printable, shorten
from .file_kinds import ENGINE, refuse_other_kind
from .messages import (
    CHAPTER_LISTS,
    CHAPTERS,
    DEVICES,
    KNOWN,
    TABLES,
    TEXTS,
    import_table,
    join_path,
)
from .model import ONE_BY_ONE, EngineFile, Override
from .plain_tables import change_tables
from .table_reader import TableReader
from .toml_text import parse_toml
from .unknown_keys import INSTEAD, suggest, suggest_place

REQUIRED = {"crank": "stroke = 90", "rod": "length = 160", "piston": "mass = 0.5"}


class Draft(NamedTuple):
    """The readable part of an engine file.

    Attributes:
        model: the file. Where there are mistakes, tables that could not be read are left out of it:
            their defaults stand there, or nothing where there is none.
        legible: keys of the file that can be relied on: what they say, or do not say, was read,
            and none that was probably meant is misspelt; those of [crank] and [layout] one by one,
            too, as crank.throws.
        problems: mistakes of the text.
    """

    model: EngineFile
    legible: frozenset[str]
    problems: tuple[Problem, ...]


def read_tables(text: str | bytes, name: str = "", *, bare: bool = False) -> Draft:
    """Return the readable part of a TOML text.

    Args:
        text: of the file.
        name: of the file, for messages.
        bare: whether a body on its mounts will do, without crank, rods and pistons: the model then
            has none.

    Raises:
        InputError: it is no TOML, or of another kind.
    """
    return check_tables(parse_toml(text, name), Path(name).parent, name, bare=bare)


def check_tables(
    data: Mapping[str, Any], folder: Path, name: str = "", *, bare: bool = False
) -> Draft:
    """Return the readable part of the tables of a file; pydantic compiles only tables that are
    there.

    Args:
        data: as TOML is read.
        folder: in which the files are that they name.
        name: of their own file, for messages.
        bare: as of `read_tables`.

    Raises:
        InputError: they are of another kind of file.
    """
    refuse_other_kind(data, name, ENGINE)
    body_alone = "body" in data and not any(key in data for key in REQUIRED)
    if body_alone and not bare:
        message = "has a body on mounts and no engine, which balcli mounts reads; an engine has "
        raise InputError([Problem("", f"{message}[crank], [rod] and [piston]")], name)
    reader = TableReader(ENGINE.name, is_engine=True)
    _refuse_strangers(reader, data)
    for key, example in REQUIRED.items():
        if key not in data and not body_alone:
            hint = f'an engine needs it, such as "[{key}]" and "{example}" below it'
            reader.problems.append(Problem.of_missing(key, hint))
    parts: dict[str, Any] = {
        key: _read_text(reader, key, data[key]) for key in TEXTS if key in data
    }
    for key in filter(data.__contains__, (*TABLES, *CHAPTERS)):
        parts[key] = reader.read_table(key, data[key], import_table(key))
    for key in filter(data.__contains__, (*DEVICES, *CHAPTER_LISTS)):
        parts[key] = reader.read_list(key, data[key], import_table(key))
    if "cylinder" in data:
        parts["cylinder"] = _read_cylinders(reader, data["cylinder"])
    return _draft(reader, parts, folder)


def change_figures(
    model: EngineFile, values: Mapping[str, float], tables: Collection[str]
) -> EngineFile:
    """Return the file with other figures in some of its tables.

    Args:
        model: the file.
        values: by dotted names (`mount.left.stiffness.2`, `torsion.rear.1.inertia`).
        tables: kinds of tables that change (`mount`); figures of all others are left alone.

    Raises:
        InputError: what a table then says against itself, such as a bore wider than its shaft.
    """
    own = {path: value for path, value in values.items() if path.partition(".")[0] in tables}
    data = change_tables(model, own)
    reader = TableReader(ENGINE.name, is_engine=True)
    changed: dict[str, Any] = {}
    for key in {path.partition(".")[0] for path in own}:
        read = reader.read_list if isinstance(data[key], list) else reader.read_table
        changed[key] = read(key, data[key], import_table(key))
    if reader.problems:
        raise reader.refusal("")
    return model.model_copy(update=changed)


def _refuse_strangers(reader: TableReader, data: Mapping[str, Any]) -> None:
    """Refuse keys of the file itself that no engine file has. Of a table such as `[engine]`, which
    is like none that there is, each of its keys: they have their places elsewhere.
    """
    for key in data:
        if key in KNOWN:
            continue
        inside = data[key]
        if not isinstance(inside, Mapping) or not inside or suggest(key, KNOWN)[1]:
            reader.refuse_key("", key, KNOWN, inside)
        else:
            for inner, value in inside.items():
                reader.refuse_key(printable(key), inner, None, value)


def _draft(reader: TableReader, parts: dict[str, Any], folder: Path) -> Draft:
    """Return what was read, from the parts of the file by their keys."""
    broken = {key for key in REQUIRED if key not in parts}
    broken |= {key for key, part in parts.items() if part is None}
    broken |= {key for key in (*DEVICES, *CHAPTER_LISTS) if None in (parts.get(key) or ())}
    read = {key: part for key, part in parts.items() if key not in broken}
    cylinders: dict[int, Override | None] = parts.get("cylinder", {})
    if None in cylinders.values():
        broken.add("cylinder")
        read["cylinder"] = {n: own for n, own in cylinders.items() if own is not None}
    misspelt = {problem.meant for problem in reader.problems if problem.meant}
    broken |= misspelt & (set(KNOWN) - parts.keys())
    legible: set[str] = set()
    for path, table in ONE_BY_ONE.items():
        lost = set(table.model_fields) if path in broken else set()
        refused = reader.refused.get(path)
        if refused and refused.draft is not None and refused.is_consistent:
            read[path], lost = refused.draft, refused.broken
        paths = {f"{path}.{key}" for key in table.model_fields.keys() - lost} - misspelt
        if len(paths) < len(table.model_fields):
            broken.add(path)
        legible |= paths
    legible |= set(KNOWN) - broken
    model = EngineFile.model_construct(set(read), **read)
    model._folder = folder
    return Draft(model, frozenset(legible), tuple(reader.problems))


def _read_text(reader: TableReader, key: str, value: object) -> str | None:
    if not isinstance(value, str):
        reader.add(key, f"{shorten(value)} is not text; write it in quotes")
        return None
    characters = CONTROL_CHARACTERS if key == "source" else rf"{CONTROL_CHARACTERS}|[\t\n]"
    strange = None if value.isprintable() else re.search(characters, value)
    if strange:
        reader.add(
            key,
            f"has the control character U+{ord(strange[0]):04X}, which could command a terminal or "
            "disguise what it shows; leave it out",
        )
    elif key == "name" and len(value) > LONGEST_NAME:
        reader.add(
            key,
            f"has {len(value)} characters; it stands in every line of a CSV, at most "
            f"{LONGEST_NAME} are taken",
        )
    return value


def _read_cylinders(reader: TableReader, value: object) -> dict[int, Override | None]:
    if isinstance(value, list):
        reader.add("cylinder", "has a table for each that differs, such as [cylinder.3]")
        return {}
    cylinders: dict[int, Override | None] = {}
    for key, part in value.items() if isinstance(value, Mapping) else [("", value)]:
        if re.fullmatch(r"[1-9][0-9]{0,4}", key):
            cylinders[int(key)] = reader.read_table(f"cylinder.{key}", part, Override)
        else:
            hint = INSTEAD.get(key or "count") or suggest_place(key)
            hint = hint or "write [cylinder.3] for what differs in cylinder 3"
            reader.add(join_path("cylinder", [key]), f"does not name a cylinder; {hint}")
    return cylinders

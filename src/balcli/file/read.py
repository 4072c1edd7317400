"""Read the tables of an engine file one by one. Every mistake is collected with its path and a
remedy.

Contradictions between tables are not found here, because that needs the engine (`engine.parse`).
"""

import re
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple, TypeVar

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from ..errors import CONTROL_CHARACTERS, InputError, Problem
from ..limits import LONGEST_NAME, MOST_LIST_VALUES, MOST_MISTAKES_SHOWN, MOST_PARTS
from ..names import CHAPTER_LISTS
from .fields import printable, shorten
from .messages import (
    BESIDE_ENGINES,
    DEVICES,
    ENGINE,
    INSTEAD,
    KNOWN,
    TEXTS,
    describe_finding,
    find_inner_table,
    format_heading,
    import_table,
    join_path,
    refuse_other_kind,
    suggest,
    suggest_place,
)
from .model import EngineFile, Override
from .plain_tables import change_tables
from .table import FileTable
from .toml import parse_toml

T = TypeVar("T", bound=FileTable)


def refuse(problems: Iterable[Problem], name: str) -> InputError:
    """Return one error that lists the first mistakes and the number of the others. A key that is
    missing only because it is probably misspelt is not listed as missing.

    Args:
        problems: All mistakes of a file.
        name: Name of the file.
    """
    problems = sorted(problems, key=lambda problem: problem.meant is None)
    meant = {problem.meant for problem in problems}
    listed = [problem for problem in problems if meant.isdisjoint(problem.missing)]
    more = max(len(listed) - MOST_MISTAKES_SHOWN, 0)
    return InputError(listed[:MOST_MISTAKES_SHOWN], name, more)


@dataclass(eq=False, repr=False)
class TableReader:
    """Reader of tables that collects their mistakes.

    Attributes:
        file_kind: Kind of the file, in words: "a chain file".
        describe: Function that returns the message for a finding of pydantic; its arguments are the
            table's path, the finding and the table's class.
        is_engine: Whether the file is an engine file, for which messages have more hints.
        problems: Mistakes found so far.
    """

    file_kind: str
    describe: Callable[[str, ErrorDetails, type[FileTable]], Problem] = describe_finding
    is_engine: bool = False
    problems: list[Problem] = field(default_factory=list, init=False)
    _unknown: int = field(default=0, init=False)  # number of unknown keys

    def read_list(
        self, key: str, value: object, table: type[T], most: int = MOST_PARTS
    ) -> tuple[T, ...] | None:
        """Return the tables of a list; None if a table has mistakes, or if the value is not a list
        or the list is too long.

        Args:
            key: Key of the list.
            value: Value in the TOML.
            table: Class of the tables.
            most: Largest number of tables.
        """
        if not isinstance(value, list):
            wanted = f"write [[{key}]] in double brackets, once for each {key}"
            self.add(key, f"may be given several times; {wanted}")
            return None
        if len(value) > most:
            self.add(key, f"is given {len(value)} times; at most {most} are read")
            return None
        tables = []
        for k, item in enumerate(value, 1):
            read = self.read_table(f"{key}.{k}", item, table)
            if read is not None:
                tables.append(read)
        if len(tables) < len(value):
            return None
        return tuple(tables)

    def read_table(self, path: str, value: object, table: type[T]) -> T | None:
        """Return a table; None if it has mistakes. Contradictions between its keys are reported
        only if the table has no unknown keys.

        Args:
            path: Path of the table; empty: the file itself.
            value: Value in the TOML.
            table: Class of the table.
        """
        if isinstance(value, list) and value and all(isinstance(one, Mapping) for one in value):
            self.add(path, f"may be given only once, in single brackets: [{path}]")
            return None
        if not isinstance(value, Mapping):
            hint = f"write {format_heading(path)} and its keys below it"
            self.add(path, f"{shorten(value)} is given in place of a table; {hint}")
            return None
        keys = table.keys()
        usable = {key: part for key, part in value.items() if key in keys}
        for key in value:
            if key not in keys:
                self.refuse_key(path, key, keys, value[key])
        try:
            read = table.model_validate(usable)
        except ValidationError as error:
            self._translate(path, table, error, whole=len(usable) == len(value))
            return None
        return read if len(usable) == len(value) else None

    def refuse_key(self, path: str, key: str, own: Collection[str] | None, value: object) -> None:
        """Collect the mistake of a key that a table does not have.

        Args:
            path: Path of the table; empty: the file itself.
            key: Key as it is written.
            own: Keys of the table; None: no engine file has this table.
            value: Value of the key.
        """
        place = join_path(path, [key])
        self._unknown += 1
        if self._unknown > MOST_MISTAKES_SHOWN:  # further unknown keys are only counted
            self.problems.append(Problem(place, "unknown key", meant=""))
            return
        hint, near = suggest(key, own or (), is_engine=self.is_engine)
        heading = f"[{path}]" if own is None else format_heading(path)
        table = printable(heading)
        meant = join_path(path, [near]) if near else ""
        message = f"unknown key in {table if path else self.file_kind}"
        is_table = isinstance(value, Mapping) and key in KNOWN and key not in TEXTS
        if self.is_engine and path and is_table:
            message = f"{key} is a table of its own, not one within {table}"
            meant = key
            hint = f"write {format_heading(key)} and its keys below it"
        elif own is None:
            message = f"there is no table {table}"
        self.problems.append(Problem(place, f"{message}; {hint}" if hint else message, (), meant))

    def refusal(self, name: str) -> InputError:
        """Return the error that lists the mistakes; `name` is the name of the file, or empty."""
        return refuse(self.problems, name or self.file_kind.removeprefix("a "))

    def add(self, path: str, message: str) -> None:
        """Add a mistake.

        Args:
            path: Path of the key or table.
            message: The mistake, then the remedy.
        """
        self.problems.append(Problem(path, message))

    def _translate(
        self, path: str, table: type[FileTable], error: ValidationError, *, whole: bool
    ) -> None:
        """Collect pydantic's findings in a table; `whole`: whether it has no unknown keys."""
        for finding in error.errors(include_url=False)[:MOST_LIST_VALUES]:
            if not finding["loc"]:
                contradictions = finding["ctx"]["error"].args if whole else ()
                self.problems += (Problem(path, message) for message in contradictions)
            elif finding["type"] == "extra_forbidden":  # an unknown key in an inner table
                *parents, last = finding["loc"]
                inner = find_inner_table(table, finding["loc"]).keys()
                self.refuse_key(join_path(path, parents), str(last), inner, finding["input"])
            elif not _only_lost_members(finding):
                self.problems.append(self.describe(path, finding, table))


def _only_lost_members(finding: ErrorDetails) -> bool:
    """Return whether a list is too short only because pydantic left out members with mistakes."""
    if finding["type"] != "too_short":
        return False
    return len(finding["input"]) >= finding["ctx"]["min_length"]


REQUIRED = {"crank": "stroke = 90", "rod": "length = 160", "piston": "mass = 0.5"}


class Draft(NamedTuple):
    """What could be read of an engine file.

    Attributes:
        model: Engine file; a table with mistakes has its default values, or is missing.
        readable: Names of the tables and top-level keys without mistakes, and of those that the
            file does not have.
        problems: Mistakes of the file.
    """

    model: EngineFile
    readable: frozenset[str]
    problems: tuple[Problem, ...]


def read_tables(text: str | bytes, name: str = "", *, bare: bool = False) -> Draft:
    """Return what can be read of an engine file, from its text.

    Args:
        text: Text of the file (TOML).
        name: Name of the file, for messages.
        bare: Whether a file with only a body on mounts is allowed; the model then has no crank,
            rods and pistons.

    Raises:
        InputError: The text is not TOML, or it is a file of another kind.
    """
    return check_tables(parse_toml(text, name), Path(name).parent, name, bare=bare)


def check_tables(
    data: Mapping[str, object], folder: Path, name: str = "", *, bare: bool = False
) -> Draft:
    """Return what can be read of an engine file, from its tables. pydantic compiles only tables
    that are present.

    Args:
        data: Tables as TOML has them.
        folder: Folder of the files that the tables name.
        name: Name of the engine file, for messages.
        bare: As for `read_tables`.

    Raises:
        InputError: The file is of another kind.
    """
    refuse_other_kind(data, name, ENGINE)
    inner = data.get("engine")
    slip = isinstance(inner, Mapping) and "file" not in inner  # [engine], not a table [[engine]]
    geared = bool(inner) and not slip
    body_alone = "body" in data and not geared and not any(key in data for key in REQUIRED)
    if body_alone and not bare:
        message = "has a body on mounts and no engine: balcli mounts reads it; an engine needs "
        raise InputError([Problem("", f"{message}[crank], [rod] and [piston]")], name)
    reader = TableReader(ENGINE.name, is_engine=True)
    expected = [key for key in KNOWN if key != "engine" or not slip]
    for key, value in data.items():
        if key not in expected:
            _refuse_unknown(reader, key, value, expected)
    for key, example in REQUIRED.items():
        if key not in data and not (body_alone or geared):
            hint = f'an engine needs it, such as "[{key}]" and "{example}" below it'
            reader.problems.append(Problem.of_missing(key, hint))
    foreign = set(KNOWN).difference(BESIDE_ENGINES) if geared else ()
    parts = {}
    for key in data:
        if key in foreign:
            reader.add(key, "a file with [[engine]] takes this from its engine files")
    for key in expected:
        if key in data and key not in foreign:
            parts[key] = _read_part(reader, key, data[key])
    broken = {key for key in REQUIRED if key not in parts}
    broken |= {problem.meant for problem in reader.problems if problem.meant}
    broken |= {key for key, part in parts.items() if part is None}
    read = {key: part for key, part in parts.items() if key not in broken}
    model = EngineFile.model_construct(set(read), **read)
    model._folder = folder
    model = _settle_speed(model)
    return Draft(model, frozenset(KNOWN) - broken, tuple(reader.problems))


def _refuse_unknown(
    reader: TableReader, key: str, value: object, expected: Collection[str]
) -> None:
    """Collect the mistake of a key that no engine file has at its top, or the mistakes of all keys
    of such a table unless the name of the table is misspelt.
    """
    if not isinstance(value, Mapping) or not value or suggest(key, expected)[1]:
        reader.refuse_key("", key, expected, value)
        return
    for inner, part in value.items():
        reader.refuse_key(printable(key), inner, None, part)


def _settle_speed(model: EngineFile) -> EngineFile:
    """Return the file of a locomotive with its speed on the track converted to `operation.speed`;
    return the file unchanged if it gives no speed on the track.
    """
    table = model.locomotive
    if table is None or None in (table.speed, table.wheel_diameter) or model.operation.has("speed"):
        return model
    rpm = table.find_rpm(table.speed or 0.0)
    return model.with_table("locomotive", speed=None).with_table("operation", speed=rpm)


def _read_part(reader: TableReader, key: str, value: object) -> object:
    """Return the value of a top-level key; None if the value has mistakes."""
    if key in TEXTS:
        return _read_text(reader, key, value)
    if key == "cylinder":
        return _read_cylinders(reader, value)
    several = key in DEVICES or key in CHAPTER_LISTS
    return (reader.read_list if several else reader.read_table)(key, value, import_table(key))


def change_figures(
    model: EngineFile, values: Mapping[str, float], tables: Collection[str]
) -> EngineFile:
    """Return the file with other figures in tables of some kinds.

    Args:
        model: Engine file.
        values: Figures by dotted names (`mount.left.stiffness.2`, `torsion.rear.1.inertia`).
        tables: Kinds of tables that change (`mount`); figures of other tables are ignored.

    Raises:
        InputError: A changed table has a contradiction, such as a bore wider than its shaft.
    """
    own = {}
    kinds = set()
    for path, value in values.items():
        kind = path.partition(".")[0]
        if kind in tables:
            own[path] = value
            kinds.add(kind)
    data = change_tables(model, own, kinds)
    reader = TableReader(ENGINE.name, is_engine=True)
    changed = {kind: _read_part(reader, kind, data[kind]) for kind in kinds}
    if reader.problems:
        raise reader.refusal("")
    return model.model_copy(update=changed)


def _read_text(reader: TableReader, key: str, value: object) -> str | None:
    if not isinstance(value, str):
        reader.add(key, f"{shorten(value)} is not text; write it in quotes")
        return None
    characters = CONTROL_CHARACTERS if key == "source" else rf"{CONTROL_CHARACTERS}|[\t\n]"
    strange = None if value.isprintable() else re.search(characters, value)
    if strange:
        reader.add(key, f"has the control character U+{ord(strange[0]):04X}; leave it out")
    elif key == "name" and len(value) > LONGEST_NAME:
        reader.add(key, f"has {len(value)} characters; at most {LONGEST_NAME} are allowed")
    return value


def _read_cylinders(reader: TableReader, value: object) -> dict[int, Override | None] | None:
    if isinstance(value, list):
        reader.add("cylinder", "write a table for each cylinder that differs, such as [cylinder.3]")
        return {}
    cylinders: dict[int, Override | None] = {}
    for key, part in value.items() if isinstance(value, Mapping) else [("", value)]:
        if re.fullmatch(r"[1-9][0-9]{0,4}", key):
            cylinders[int(key)] = reader.read_table(f"cylinder.{key}", part, Override)
        else:
            hint = INSTEAD.get(key or "count") or suggest_place(key)
            hint = hint or "write [cylinder.3] for the keys that differ in cylinder 3"
            reader.add(join_path("cylinder", [key]), f"does not name a cylinder; {hint}")
    return None if None in cylinders.values() else cylinders

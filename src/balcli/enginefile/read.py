"""Text of an engine file -> its tables, and every mistake that the text has, each by its path.

What the tables say against each other is not looked at here: that takes an engine (`engine.rules`).
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

from pydantic import ValidationError

from ..errors import DISGUISES, InputError, Problem
from ..limits import LONGEST_NAME, MOST_KEY_VALUES, MOST_MISTAKES_SHOWN, MOST_PARTS
from .conflicts import examine_refused
from .fields import printable, shorten
from .file_kinds import ENGINE, refuse_other_kind
from .messages import (
    CHAPTER_LISTS,
    CHAPTERS,
    DEVICES,
    KNOWN,
    TABLES,
    TEXTS,
    describe_finding,
    find_inner_table,
    import_table,
    join_path,
)
from .model import ONE_BY_ONE, EngineFile, FileTable, Override
from .toml_text import parse_toml
from .unknown_keys import (
    INSTEAD,
    UnknownKey,
    describe_unknown_key,
    find_unknown_keys,
    suggest_place,
)

REQUIRED = {"crank": "stroke = 90", "rod": "length = 160", "piston": "mass = 0.5"}
CONTROL_CHARACTERS = {  # compiled when a text is met that is not all printable
    "name": rf"[\x00-\x1f\x7f-\x9f{DISGUISES}]",
    "source": rf"[\x00-\x08\x0b-\x1f\x7f-\x9f{DISGUISES}]",  # may have lines
}
T = TypeVar("T", bound=FileTable)


class Draft(NamedTuple):
    """What could be read of an engine file.

    Attributes:
        model: the file. Where there are mistakes, tables that could not be read are left out of it:
            their defaults stand there, or nothing where there is none.
        legible: keys of the file that can be relied on: what they say, or do not say, was read,
            and none that was probably meant is misspelt; those of [crank] and [layout] one by one,
            too, as crank.throws.
        problems: mistakes of the text.
        unknown: keys that an engine file does not have.
    """

    model: EngineFile
    legible: frozenset[str]
    problems: tuple[Problem, ...]
    unknown: tuple[UnknownKey, ...]

    @property
    def has_mistakes(self) -> bool:
        return bool(self.problems or self.unknown)

    def refusal(self, contradictions: Iterable[Problem], name: str) -> InputError:
        """All mistakes as one error: unknown keys, those of the text, and what the tables say
        against each other.

        The first are listed, of the others there is the number. A key that is missing is not told
        where it is there, misspelt.
        """
        described = [describe_unknown_key(key) for key in self.unknown[:MOST_MISTAKES_SHOWN]]
        meant = {path for _, path in described if path}
        others = [
            problem
            for problem in (*self.problems, *contradictions)
            if meant.isdisjoint(problem.missing)
        ]
        listed = [*(problem for problem, _ in described), *others][:MOST_MISTAKES_SHOWN]
        more = len(self.unknown) + len(others) - MOST_MISTAKES_SHOWN
        return InputError(listed, name, max(more, 0))


def read_tables(text: str | bytes, name: str = "", *, bare: bool = False) -> Draft:
    """What a TOML text says of an engine; `name` is that of its file, for messages.

    Args:
        bare: whether a body on its mounts will do, without crank, rods and pistons: the model then
            has none.

    Raises:
        InputError: it is no TOML, or of another kind.
    """
    return check_tables(parse_toml(text, name), Path(name).parent, name, bare=bare)


def check_tables(
    data: Mapping[str, Any], folder: Path, name: str = "", *, bare: bool = False
) -> Draft:
    """What tables say of an engine. Those that are not there are not even compiled by pydantic.

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
    reader = _Reader()
    reader.unknown += find_unknown_keys(data)
    for key, example in REQUIRED.items():
        if key not in data and not body_alone:
            hint = f'an engine needs it, such as "[{key}]" and "{example}" below it'
            reader.problems.append(Problem.of_missing(key, hint))
    parts: dict[str, Any] = {key: reader.read_text(key, data[key]) for key in TEXTS if key in data}
    for key in filter(data.__contains__, (*TABLES, *CHAPTERS)):
        parts[key] = reader.read_table(key, data[key], import_table(key))
    for key in filter(data.__contains__, (*DEVICES, *CHAPTER_LISTS)):
        parts[key] = reader.read_devices(key, data[key], import_table(key))
    if "cylinder" in data:
        parts["cylinder"] = reader.read_cylinders(data["cylinder"])
    return reader.draft(parts, folder)


class _Reader:
    """Reads the tables of a file one by one and collects the mistakes; None: could not be read."""

    def __init__(self) -> None:
        self.problems: list[Problem] = []
        self.unknown: list[UnknownKey] = []
        self.partial: dict[str, _Partial] = {}  # tables of `ONE_BY_ONE` with broken keys

    def add(self, path: str, message: str) -> None:
        self.problems.append(Problem(path, message))

    def draft(self, parts: Mapping[str, Any], folder: Path) -> Draft:
        """What was read, from the parts of the file by their keys; the file stands in `folder`."""
        cylinders: dict[int, Override | None] = parts.get("cylinder", {})
        broken = {key for key in REQUIRED if key not in parts}
        broken |= {key for key, part in parts.items() if part is None}
        broken |= {key for key in (*DEVICES, *CHAPTER_LISTS) if None in (parts.get(key) or ())}
        read = {key: part for key, part in parts.items() if key not in broken}
        if None in cylinders.values():
            broken.add("cylinder")
            read["cylinder"] = {n: own for n, own in cylinders.items() if own is not None}
        told = self.unknown[:MOST_MISTAKES_SHOWN]  # the rest is told as a number
        misspelt = {path for _, path in map(describe_unknown_key, told)}
        broken |= misspelt & (set(KNOWN) - parts.keys())
        legible: set[str] = set()
        for path, table in ONE_BY_ONE.items():
            lost = set(table.model_fields) if path in broken else set()
            if path in self.partial:
                read[path], lost = self.partial[path]
            paths = {f"{path}.{key}" for key in table.model_fields.keys() - lost} - misspelt
            if len(paths) < len(table.model_fields):
                broken.add(path)
            legible |= paths
        legible |= set(KNOWN) - broken
        model = EngineFile.model_construct(set(read), **read)
        model._folder = folder
        return Draft(model, frozenset(legible), tuple(self.problems), tuple(self.unknown))

    def read_text(self, key: str, value: object) -> str | None:
        if not isinstance(value, str):
            self.add(key, f"{shorten(value)} is not text; write it in quotes")
            return None
        strange = None if value.isprintable() else re.search(CONTROL_CHARACTERS[key], value)
        if strange:
            code = f"U+{ord(strange[0]):04X}"
            self.add(
                key,
                f"has the control character {code}, which could command a terminal or disguise "
                "what it shows; leave it out",
            )
        elif key == "name" and len(value) > LONGEST_NAME:
            self.add(
                key,
                f"has {len(value)} characters; it stands in every line of a CSV, at most "
                f"{LONGEST_NAME} are taken",
            )
        return value

    def read_table(self, path: str, value: object, table: type[T]) -> T | None:
        if isinstance(value, list) and value and all(isinstance(one, Mapping) for one in value):
            self.add(path, f"stands once, in single brackets: [{path}]")
            return None
        if not isinstance(value, Mapping):
            self.add(
                path,
                f"{shorten(value)} stands where a table belongs; write [{path}] and its keys "
                "below it",
            )
            return None
        fields = table.model_fields
        self.unknown += [
            UnknownKey(path, key, table, isinstance(part, Mapping))
            for key, part in value.items()
            if key not in fields
        ]
        known = {key: part for key, part in value.items() if key in fields}
        if self._refuse_huge(path, known):
            return None
        try:
            return table.model_validate(known)
        except ValidationError as error:
            self._translate(path, error, known, table)
            return None

    def read_devices(self, key: str, value: object, table: type[T]) -> tuple[T | None, ...] | None:
        if not isinstance(value, list):
            self.add(
                key, f"is one of several; write [[{key}]] in double brackets, once for each {key}"
            )
            return None
        if len(value) > MOST_PARTS:
            self.add(key, f"stands {len(value)} times; no engine has more than {MOST_PARTS}")
            return None
        return tuple(
            self.read_table(f"{key}.{number}", item, table) for number, item in enumerate(value, 1)
        )

    def read_cylinders(self, value: object) -> dict[int, Override | None]:
        if isinstance(value, list):
            self.add("cylinder", "has a table for each that differs, such as [cylinder.3]")
            return {}
        if not isinstance(value, Mapping):
            value = {"": value}
        cylinders: dict[int, Override | None] = {}
        for key, part in value.items():
            if re.fullmatch(r"[1-9][0-9]{0,4}", key):
                cylinders[int(key)] = self.read_table(f"cylinder.{key}", part, Override)
            else:
                instead = INSTEAD.get(key or "count") or suggest_place(key)
                hint = instead or "write [cylinder.3] for what differs in cylinder 3"
                path = f"cylinder.{printable(key)}".rstrip(".")
                self.add(path, f"does not name a cylinder; {hint}")
        return cylinders

    def _refuse_huge(self, path: str, known: Mapping[str, object]) -> bool:
        """Whether a key holds more values than pydantic should look at one by one."""
        counts = {key: _count_values(part) for key, part in known.items()}
        huge = {key: count for key, count in counts.items() if count > MOST_KEY_VALUES}
        for key, count in huge.items():
            self.add(
                f"{path}.{key}",
                f"holds {count} values; no engine needs more than {MOST_KEY_VALUES}",
            )
        return bool(huge)

    def _translate(
        self, path: str, error: ValidationError, value: Mapping[str, Any], table: type[FileTable]
    ) -> None:
        """Collect what the keys say against each other, as far as they can be read, and pydantic's
        findings in them.
        """
        refused = examine_refused(path, table, value, error)
        self.problems += refused.conflicts
        if path in ONE_BY_ONE and refused.draft is not None and not refused.conflicts:
            self.partial[path] = _Partial(refused.draft, refused.broken)
        for finding in refused.findings:
            if finding["type"] == "extra_forbidden":  # in a table within the table
                *parents, last = finding["loc"]
                inner = find_inner_table(table, finding["loc"])
                holds_table = isinstance(finding["input"], Mapping)
                place = join_path(path, parents)
                self.unknown.append(UnknownKey(place, str(last), inner, holds_table))
            else:
                self.problems.append(describe_finding(path, finding, table))


class _Partial(NamedTuple):
    """A table read without its broken keys: those that have to be there are their examples."""

    draft: FileTable
    broken: set[str]


def _count_values(value: object) -> int:
    """How many values a value holds, itself included."""
    if isinstance(value, Mapping):
        return 1 + sum(map(_count_values, value.values()))
    return 1 + sum(map(_count_values, value)) if isinstance(value, list) else 1

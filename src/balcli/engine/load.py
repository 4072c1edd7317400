"""Engine file -> model: every mistake at once, each by its path in the file and with what would be
right.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeVar

from pydantic import ValidationError

from ..enginefile.fields import printable, shorten
from ..enginefile.messages import (
    DEVICES,
    INNER,
    KNOWN,
    TABLES,
    TEXTS,
    miscounted,
    path_of,
    plain,
    unknown_key,
)
from ..enginefile.model import (
    Crank,
    EngineFile,
    Override,
    Piston,
    Rod,
    Table,
    mistakes_of_choice,
)
from ..enginefile.toml_text import name_of as name_of
from ..enginefile.toml_text import parse_toml
from ..enginefile.toml_text import text_of as text_of
from ..errors import DISGUISES, InputError, Problem
from ..limits import (
    LONGEST_NAME,
    MOST_KEY_VALUES,
    MOST_MISTAKES_SHOWN,
    MOST_PARTS,
)
from .build import Engine, build

CONTROL = {
    "name": re.compile(rf"[\x00-\x1f\x7f-\x9f{DISGUISES}]"),
    "source": re.compile(rf"[\x00-\x08\x0b-\x1f\x7f-\x9f{DISGUISES}]"),
}
REQUIRED = {"crank": "stroke = 90", "rod": "length = 160", "piston": "mass = 0.5"}

T = TypeVar("T", bound=Table)


def load(source: str | Path) -> Engine:
    """The engine that a file describes, ready to analyse; "-" reads standard input.

    Raises BalcliError if there is nothing to read, InputError with every mistake of the file.
    """
    return built(read(source), name_of(source))


def built(model: EngineFile, file: str) -> Engine:
    """The engine of a model. Raises InputError with what does not fit together in the file of that
    name ("-": standard input).
    """
    try:
        return build(model)
    except InputError as error:
        raise InputError(error.problems, name_of(file)) from None


def read(source: str | Path) -> EngineFile:
    """The engine file at a path, or from standard input for "-".

    Raises BalcliError if there is nothing to read, InputError with every mistake that the text has.
    """
    return parse(text_of(source), name_of(source))


def parse(text: str | bytes, file: str = "") -> EngineFile:
    """The engine that a TOML text describes; `file` is its name in messages. Raises InputError with
    every mistake.
    """
    reader = _Reader()
    engine = reader.engine(parse_toml(text, file))
    if engine is None:
        raise reader.error(file)
    return engine


def _count(value: object) -> int:
    """How many values a value holds, itself included."""
    parts = (
        value.values() if isinstance(value, Mapping) else value if isinstance(value, list) else ()
    )
    return 1 + sum(map(_count, parts))


def misfits(parts: Mapping[str, Any]) -> tuple[Problem, ...]:
    """What the tables that could be read say against each other; those that could not are taken as
    harmless.
    """
    whole = {
        key: part
        for key, part in parts.items()
        if part is not None and key not in TEXTS and key not in DEVICES
    }
    cylinders, legible = (
        whole.get("cylinder", {}),
        "crank" in whole and parts.get("layout", True) is not None,
    )
    if None in cylinders.values() or not legible:
        plain = (
            legible and "articulation" not in whole
        )  # else it is not known which rods these cylinders have
        known = ("crank", "rod", "piston", "operation", *(["layout"] if legible else []))
        whole = {key: part for key, part in whole.items() if key in known}
        whole["cylinder"] = {
            number: own for number, own in cylinders.items() if plain and own is not None
        }
    if not legible:
        whole = _with_one_throw(whole)
    harmless = {
        "rod": Rod.model_construct(length=1e3 * whole["crank"].stroke),
        "piston": Piston.model_construct(mass=0.0),
    }
    try:
        build(EngineFile.model_construct(**harmless | whole))
    except InputError as error:
        return error.problems
    return ()


def _with_one_throw(whole: Mapping[str, Any]) -> dict[str, Any]:
    """The same with a crank of one throw, as it is not known how many there are; without a crank, a
    rod's ratio says no length.
    """
    if "crank" in whole:
        return {
            **whole,
            "crank": Crank.model_construct(stroke=whole["crank"].stroke, throws=(0.0,)),
        }
    if "rod" in whole and whole["rod"].length:
        return {
            **whole,
            "crank": Crank.model_construct(stroke=whole["rod"].length / 2, throws=(0.0,)),
        }
    return {
        **{key: part for key, part in whole.items() if key != "rod"},
        "crank": Crank.model_construct(stroke=1.0, throws=(0.0,)),
    }


class _Reader:
    """Reads table after table and collects the mistakes."""

    def __init__(self) -> None:
        self._found: list[Problem] = []
        self._unknown: list[
            tuple[str, str, type[Table] | None]
        ] = []  # path of the table, key, table

    def engine(self, data: Mapping[str, Any]) -> EngineFile | None:
        """The model, or None if there are mistakes. Tables that the file does not have are not even
        compiled.
        """
        self._unknown += [("", key, None) for key in data if key not in KNOWN]
        for key, example in REQUIRED.items():
            if key not in data:
                self._add(
                    key,
                    f'is missing; an engine needs it, such as "[{key}]" and "{example}" below it',
                )
        parts: dict[str, Any] = {key: self._text(key, data[key]) for key in TEXTS if key in data}
        parts |= {
            key: self._table(key, data[key], table) for key, table in TABLES.items() if key in data
        }
        parts |= {
            key: self._devices(key, data[key], table)
            for key, table in DEVICES.items()
            if key in data
        }
        if "cylinder" in data:
            parts["cylinder"] = self._cylinders(data["cylinder"])
        if self._found or self._unknown:
            self._found += misfits(parts)
            return None
        return EngineFile.model_construct(set(parts), **parts)

    def error(self, file: str) -> InputError:
        """The first mistakes, misspelt keys before the others, and how many more there are."""
        shown = [unknown_key(*unknown) for unknown in self._unknown[:MOST_MISTAKES_SHOWN]]
        meant = {path for _, path in shown if path}
        rest = [
            p for p in self._found if not (p.path in meant and p.message.startswith("is missing"))
        ]
        problems = [problem for problem, _ in shown] + rest
        more = len(self._unknown) + len(rest) - MOST_MISTAKES_SHOWN
        return InputError(problems[:MOST_MISTAKES_SHOWN], file, max(more, 0))

    def _add(self, path: str, message: str) -> None:
        self._found.append(Problem(path, message))

    def _text(self, key: str, value: object) -> object:
        if not isinstance(value, str):
            self._add(key, f"{shorten(value)} is not text; write it in quotes")
        elif strange := CONTROL[key].search(value):
            self._add(
                key,
                f"has the control character U+{ord(strange[0]):04X}, which could command a "
                "terminal or disguise what it shows; leave it out",
            )
        elif key == "name" and len(value) > LONGEST_NAME:
            self._add(
                key,
                f"has {len(value)} characters; it stands in every line of a CSV, at most "
                f"{LONGEST_NAME} are taken",
            )
        return value

    def _table(self, path: str, value: object, table: type[T]) -> T | None:
        if not isinstance(value, Mapping):
            self._add(
                path,
                f"{shorten(value)} stands where a table belongs; write [{path}] and its keys "
                "below it",
            )
            return None
        self._unknown += [(path, key, table) for key in value if key not in table.model_fields]
        known = {key: part for key, part in value.items() if key in table.model_fields}
        huge = {
            key: count for key, part in known.items() if (count := _count(part)) > MOST_KEY_VALUES
        }
        for key, count in huge.items():
            self._add(
                f"{path}.{key}",
                f"holds {count} values; no engine needs more than {MOST_KEY_VALUES}",
            )
        if huge:
            return None
        try:
            return table.model_validate(known)
        except ValidationError as error:
            self._translate(path, error, known, table)
            return None

    def _devices(self, key: str, value: object, table: type[T]) -> tuple[T | None, ...]:
        if not isinstance(value, list):
            self._add(
                key, f"is one of several; write [[{key}]] in double brackets, once for each {key}"
            )
            return ()
        if len(value) > MOST_PARTS:
            self._add(key, f"stands {len(value)} times; no engine has more than {MOST_PARTS}")
            return ()
        return tuple(
            self._table(f"{key}.{number}", item, table) for number, item in enumerate(value, 1)
        )

    def _cylinders(self, value: object) -> dict[int, Override | None]:
        if not isinstance(value, Mapping):
            value = {"": value}
        found = {}
        for key, part in value.items():
            if re.fullmatch(r"[1-9][0-9]{0,4}", key):
                found[int(key)] = self._table(f"cylinder.{key}", part, Override)
            else:
                self._add(
                    f"cylinder.{printable(key)}".rstrip("."),
                    "does not name a cylinder; write [cylinder.3] for what differs in cylinder 3",
                )
        return found

    def _translate(
        self, path: str, error: ValidationError, value: Mapping[str, Any], table: type[Table]
    ) -> None:
        """pydantic's findings, and the keys that exclude each other, which it looks at only where
        all else is right.
        """
        findings = error.errors(include_url=False)
        if any(finding["loc"] for finding in findings):
            for mistake in mistakes_of_choice(table, value):
                self._add(path, mistake)
        for finding in findings:
            if finding["type"] == "extra_forbidden":  # in a table within the table
                *parents, last = finding["loc"]
                self._unknown.append((path_of(path, parents), str(last), INNER[str(parents[0])]))
            elif not miscounted(finding):
                self._found.append(plain(path, finding, table))

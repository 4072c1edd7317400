"""Engine file -> model: every mistake at once, each by its path in the file and in words that name what would be right."""
from __future__ import annotations

import re
import sys
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, TypeVar

from pydantic import ValidationError

from . import model
from .errors import BalcliError, InputError, Problem
from .fields import shorten
from .model import EngineFile, Table, mistakes_of_choice

LARGEST = 16_000_000             # bytes of an engine file
MOST_SHOWN = 20                  # mistakes of one file
DEEPEST = 32                     # parts of a dotted key; tomllib's memory grows with their square

TABLES: dict[str, type[Table]] = {
    "crank": model.Crank, "rod": model.Rod, "piston": model.Piston, "layout": model.Layout, "bobweight": model.Bobweight,
    "operation": model.Operation, "frame": model.Frame, "articulation": model.Articulation}
DEVICES: dict[str, type[Table]] = {"counterweight": model.Counterweight, "shaft": model.Shaft, "slider": model.Slider}
TEXTS = ("name", "source")
REQUIRED = {"crank": "stroke = 90", "rod": "length = 160", "piston": "mass = 0.5"}
KNOWN = (*TEXTS, *TABLES, "cylinder", *DEVICES)

T = TypeVar("T", bound=Table)
_DEEP_KEY = re.compile(r"""(?<![\w"'-])(?:(?:[\w-]++|"[^"\n]*+"|'[^'\n]*+')[ \t]*+\.[ \t]*+){%d}""" % DEEPEST)


def read(source: str | Path) -> EngineFile:
    """The engine file at a path, or from standard input for "-". BalcliError if it cannot be read, InputError for its mistakes."""
    if str(source) == "-":
        return parse(sys.stdin.buffer.read(LARGEST + 1), "standard input")
    try:
        with Path(source).open("rb") as stream:
            return parse(stream.read(LARGEST + 1), str(source))
    except IsADirectoryError:
        raise BalcliError(f"{source}: is a folder; name an engine file in it") from None
    except FileNotFoundError:
        raise BalcliError(f"{source}: no such file") from None
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise BalcliError(f"{shorten(str(source))}: cannot be read ({reason})") from None


def parse(text: str | bytes, file: str = "") -> EngineFile:
    """The engine that a TOML text describes; `file` is its name in messages. InputError with every mistake."""
    data = _toml(text, file)
    found = _Reader()
    engine = found.engine(data)
    if engine is None:
        raise InputError(found.problems(), file)
    return engine


# ------------------------------------------------------------------ text -> tables
def _toml(text: str | bytes, file: str) -> dict[str, Any]:
    try:
        return _decode(text)
    except tomllib.TOMLDecodeError as error:
        message = f"is not valid TOML: {str(error)[:300]}"
    except RecursionError:
        message = "lists or tables are nested too deeply; an engine file needs no more than four levels"
    except UnicodeDecodeError as error:
        message = f"is not UTF-8 text (byte {error.start + 1}); save it as UTF-8"
    except ValueError as error:
        message = f"a number cannot be read: {str(error).split(';')[0][:300]}"
    raise InputError([Problem("", message)], file)


def _decode(text: str | bytes) -> dict[str, Any]:
    if len(text) > LARGEST:
        raise tomllib.TOMLDecodeError(f"more than {LARGEST // 1_000_000} MB, which no engine file needs")
    if isinstance(text, bytes):
        text = text.decode("utf-8-sig")
    deep = _DEEP_KEY.search(text)
    if deep:
        raise RecursionError
    return tomllib.loads(text)


# ------------------------------------------------------------------ tables -> model
class _Reader:
    """Reads table after table and collects the mistakes."""

    def __init__(self) -> None:
        self._found: list[Problem] = []
        self._unknown: list[tuple[str, str, type[Table] | None]] = []     # table's path, key, table

    def problems(self) -> list[Problem]:
        """The first mistakes, misspelt keys first, and how many more there are."""
        shown = [_unknown_key(*unknown) for unknown in self._unknown[:MOST_SHOWN]]
        meant = {p.path.rpartition(".")[0] + "." + near for p, near in shown if near}
        rest = [p for p in self._found if not (p.path in meant and p.message.startswith("is missing"))]
        problems = [p for p, _ in shown] + rest
        count = len(self._unknown) + len(rest)
        if count > MOST_SHOWN:
            problems[MOST_SHOWN:] = [Problem("", f"and {count - MOST_SHOWN} more mistakes")]
        return problems

    def engine(self, data: dict[str, Any]) -> EngineFile | None:
        """The model, or None if there are mistakes."""
        self._unknown += [("", key, None) for key in data if key not in KNOWN]
        parts: dict[str, Any] = {key: self._text(key, data[key]) for key in TEXTS if key in data}
        for key, example in REQUIRED.items():
            if key not in data:
                self._add(key, f"is missing; an engine needs it, for example\n[{key}]\n{example}".replace("\n", " "))
        parts |= {key: self._table(key, data[key], table) for key, table in TABLES.items() if key in data}
        parts |= {key: self._devices(key, data[key], table) for key, table in DEVICES.items() if key in data}
        if "cylinder" in data:
            parts["cylinder"] = self._cylinders(data["cylinder"])
        return None if self._found or self._unknown else EngineFile.model_construct(set(parts), **parts)

    def _add(self, path: str, message: str) -> None:
        self._found.append(Problem(path, message))

    def _text(self, key: str, value: object) -> str:
        if not isinstance(value, str):
            self._add(key, f'{shorten(value)} is not text in quotes, such as {key} = "in-line four"')
        return str(value)[:0] if not isinstance(value, str) else value

    def _table(self, path: str, value: object, table: type[T]) -> T | None:
        if not isinstance(value, Mapping):
            self._add(path, f"{shorten(value)} stands where a table belongs: write [{path}] and its keys below it")
            return None
        try:
            return table.model_validate(value)
        except ValidationError as error:
            self._translate(path, error, value, table)
            return None

    def _devices(self, key: str, value: object, table: type[T]) -> tuple[T | None, ...]:
        if not isinstance(value, list):
            self._add(key, f"stands as a single table or value; write [[{key}]] with double brackets, once for each {key}")
            return ()
        return tuple(self._table(f"{key}.{number}", item, table) for number, item in enumerate(value, 1))

    def _cylinders(self, value: object) -> dict[int, model.Override | None]:
        if not isinstance(value, Mapping):
            self._add("cylinder", f"{shorten(value)} stands where tables belong: write [cylinder.3] for what differs in cylinder 3")
            return {}
        wrong = [key for key in value if not re.fullmatch(r"[1-9][0-9]{0,4}", key)]
        for key in wrong:
            self._add(f"cylinder.{key[:60]}", "is not the number of a cylinder; write [cylinder.3] for what differs in cylinder 3")
        return {int(key): self._table(f"cylinder.{key}", part, model.Override) for key, part in value.items() if key not in wrong}

    def _translate(self, path: str, error: ValidationError, value: Mapping[str, Any], table: type[Table]) -> None:
        """pydantic's findings in our words, and the keys that exclude each other, which it looks at only where all else is right."""
        details = error.errors(include_url=False)
        if not any(detail["type"] == "value_error" and not detail["loc"] for detail in details):
            for mistake in mistakes_of_choice(table, value):
                self._add(path, mistake)
        for detail in details:
            *parents, last = detail["loc"] or ("",)
            if detail["type"] == "extra_forbidden":
                self._unknown.append((_path(path, parents), str(last), _table_at(table, parents)))
            else:
                self._add(*_plain(path, detail["loc"], detail))


def _path(start: str, loc: Any) -> str:
    """`operation`, ("speed_ripple", 0, "order") -> `operation.speed_ripple.1.order`: people count from 1."""
    return ".".join([start, *(str(part + 1) if isinstance(part, int) else str(part)[:60] for part in loc)])


def _plain(path: str, loc: tuple[Any, ...], detail: Any) -> tuple[str, str]:
    """Path and message of one finding: a member of a list is named in words (`the 2nd value`)."""
    value, kind, context = detail["input"], detail["type"], detail.get("ctx", {})
    if kind == "value_error":
        message = str(context["error"])
    elif kind in ("too_short", "too_long"):
        message = _wrong_length(value, context)
    else:
        message = WORDS.get(kind, "{value} does not fit here").format(value=shorten(value))
    if kind == "missing":
        return _path(path, loc), message
    if loc and isinstance(loc[-1], int):
        return _path(path, loc[:-1]), f"the {_ordinal(loc[-1] + 1)} value {message}"
    return _path(path, loc), message


WORDS = {
    "missing": "is missing",
    "tuple_type": "{value} is not a list; write it in square brackets, such as [0, 180]",
    "model_type": "{value} is not a table; write it in braces with its keys, such as {{ key = 1 }}",
    "model_attributes_type": "{value} is not a table; write it in braces with its keys, such as {{ key = 1 }}",
}


def _wrong_length(value: Any, context: Mapping[str, Any]) -> str:
    least, most = context.get("min_length"), context.get("max_length")
    if least == 1:
        return "is an empty list; give at least one value, or leave the key out"
    if least is None and most is not None and most > 3:
        return f"has more than {most} values"
    return f"{shorten(value)} has {len(value)} values, but {least or most} are wanted"


def _ordinal(number: int) -> str:
    suffix = "th" if number % 100 in (11, 12, 13) else {1: "st", 2: "nd", 3: "rd"}.get(number % 10, "th")
    return f"{number}{suffix}"


# ------------------------------------------------------------------ unknown keys
def _table_at(table: type[Table], parents: list[Any]) -> type[Table] | None:
    """The table inside a table in which an unknown key stands."""
    inner = {"pendulum": model.Pendulum, "rod_pendulum": model.Pendulum, "speed_ripple": model.Ripple, "rod": model.ArticulatedRod}
    return inner.get(str(parents[0])) if parents else table


def _unknown_key(path: str, key: str, table: type[Table] | None) -> tuple[Problem, str]:
    """The problem of an unknown key, and the key that was probably meant ("" if none is near)."""
    own = list(table.model_fields) if table else list(KNOWN)
    place = f"[{path.partition('.')[0]}]" if path else "an engine file"
    full = f"{path}.{key[:60]}" if path else key[:60]
    near = _nearest(key, own)
    if near:
        return Problem(full, f"is no key of {place}; did you mean {near}?" if path else f"is unknown; did you mean {near}?"), near
    home = next(_homes(key), "")
    if home:
        return Problem(full, f"is no key of {place}; {home}"), ""
    return Problem(full, f"is no key of {place}, which has {', '.join(own)}"), ""


def _nearest(key: str, known: list[str]) -> str:
    from difflib import get_close_matches

    near = get_close_matches(key.lower(), known, 1) if len(key) < 100 else []
    return near[0] if near else ""


def _homes(key: str) -> Iterator[str]:
    """The table of the file to which a key belongs, exactly or nearly."""
    tables = TABLES | {f"{name}]": table for name, table in DEVICES.items()}
    for exact in (True, False):
        for name, table in tables.items():
            near = key if key in table.model_fields else "" if exact else _nearest(key, list(table.model_fields))
            if near:
                bracket = "[" if name.endswith("]") else ""
                yield f"{near} belongs to [{bracket}{name}]"

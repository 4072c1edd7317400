"""Engine files as commands read them: good ones are computed, and bad ones are named."""

from __future__ import annotations

import os
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, TypeVar

import typer

from ..errors import (
    MOMENTS_UNKNOWN,
    NO_GAS,
    BalcliError,
    Exit,
    OtherKindError,
    is_verbose,
    legible,
    note,
    say,
    warn,
)
from ..file.toml import find_near_file, name_file, read_bytes
from .options import WORDS_OF_ONLY
from .values import parse_cylinder

if TYPE_CHECKING:
    from ..engine.engine import Engine
    from ..file.model import EngineFile


# What can be asked for and includes moments, among other things.
ABOUT_MOMENTS = frozenset({"peak", "sizing", "ladder", "guide", "pru", "xy", "textbook", "verdict"})

P = TypeVar("P")
T = TypeVar("T")


class LoadedEngine(NamedTuple):
    """An engine file that has been read: its text, its model, and the engine."""

    text: bytes
    model: EngineFile
    engine: Engine


def read_engine(
    path: str,
    speed_rpm: float | None = None,
    asked: Collection[str] | None = None,
    prepare: Callable[[EngineFile], EngineFile] = lambda model: model,
) -> LoadedEngine:
    """Read one file (`-`: standard input), with warnings about suspicious values on standard error.

    Args:
        speed_rpm: crank speed of the engine instead of the file's.
        asked: names of requested quantities and tables; None: all that the command shows. Without
            moments among them, no warning of unknown moments is printed.
        prepare: Changes the file before the engine is built.

    Raises:
        BalcliError: all mistakes of the file; a moment or gas that was asked for and is not known.
    """
    if path in WORDS_OF_ONLY and not os.path.exists(path):
        raise BalcliError(f"{path}: no such file; was --only force,{path} meant?")
    from ..engine import load, parse

    text = read_bytes(path)
    model = parse.parse(text, name_file(path))
    engine = load.build_named(prepare(model), path)
    if is_verbose():
        note(f"{name_file(path)}: read, {len(text)} bytes")
        for assumed in engine.inferred:
            note(f"{name_file(path)}: not in the file: {assumed}")
    if not engine.places_known:
        _tell_unknown(name_file(path), asked)
    if "gas" in (asked or ()):
        require_gas(engine, path)
    if speed_rpm is not None:
        turned = engine.model and engine.model.with_table("operation", speed=speed_rpm)
        engine = replace(engine, speed_rpm=speed_rpm, model=turned)
    warn_each(engine.unlikely, name_file(path))
    if speed_rpm is not None:
        engine = replace(engine, model=None)
    return LoadedEngine(text, model, engine)


def _tell_unknown(name: str, asked: Collection[str] | None) -> None:
    """Warn that moments are not known if some were requested; an error if one was requested by
    name.
    """
    words = ABOUT_MOMENTS if asked is None else asked
    if by_name := [quantity for quantity in ("moment", "inner") if quantity in words]:
        raise BalcliError(f"{name}: {by_name[0]}: {MOMENTS_UNKNOWN}")
    if ABOUT_MOMENTS.intersection(words):
        warn_of_unknown_moments(name)


def warn_of_unknown_moments(name: str) -> None:
    """Print on standard error that the moments of this file are not known, and why."""
    warn(f"{name}: {MOMENTS_UNKNOWN}")


def warn_each(doubts: Iterable[str], name: str) -> None:
    """Print the doubts about a file on standard error.

    Args:
        doubts: Doubts in words.
        name: Name of the file.
    """
    for doubt in doubts:
        warn(f"{name}: {doubt}")


def try_each(
    paths: Iterable[P], work: Callable[[P], T], found: Collection[P] = ()
) -> tuple[list[T], list[str]]:
    """Return the results of all good files, in order, and the messages of the bad ones.

    Args:
        paths: Files to work on.
        work: Function of one file.
        found: Files that were found in a folder: those of another kind are passed over, with a
            note.
    """
    results, errors = [], []
    for path in paths:
        try:
            results.append(work(path))
        except BalcliError as error:
            if path in found and isinstance(error, OtherKindError):
                note(f"{path}: passed over, a file of another kind")
            else:
                errors.append(str(error))
    return results, errors


def exit_on_errors(errors: Sequence[str]) -> None:
    """End with exit status 2 after these messages on standard error, if there are any."""
    for text in errors:
        say(f"balcli: {text}")
    if errors:
        raise typer.Exit(Exit.BAD_INPUT)


def find_engine_files(paths: Sequence[Path]) -> list[Path]:
    """Return engine files as named, and all that are in a folder or in folders within it; those
    whose name begins with a dot, and files of settings, are passed over.

    Raises:
        BalcliError: a path that is not there, a folder without engine files.
    """
    files: list[Path] = []
    for path in paths:
        # Unlike Path.is_dir, this is false where one may not look, or the name is too long.
        folder = os.path.isdir(path)
        found = sorted(filter(_is_engine, _walk(path))) if folder else [path]
        if not found or not os.path.exists(path):
            reason = "has no engine files (*.toml)"
            if not folder:
                reason = f"no such file or folder{find_near_file(path)}"
            raise BalcliError(f"{path}: {reason}")
        files += found
    return files


def find_expected(paths: Sequence[Path]) -> list[Path]:
    """Return the files of records of `check` in those paths that are folders, and in their
    subfolders.
    """
    files = chain.from_iterable(_walk(path) for path in paths if os.path.isdir(path))
    return sorted({f for f in files if f.parent.name == "expected" and f.suffix == ".json"})


def _walk(folder: Path) -> Iterator[Path]:
    """Yield all files in a folder and those within it that are not hidden."""
    for path in folder.rglob("*"):
        if not any(part.startswith(".") for part in path.relative_to(folder).parts[:-1]):
            yield path


def _is_engine(path: Path) -> bool:
    return path.suffix == ".toml" and path.name != "pyproject.toml" and path.is_file()


def require_gas(engine: Engine, path: str) -> None:
    """Raise an error for an engine without gas.

    Args:
        engine: Engine to check.
        path: Its file, for messages.

    Raises:
        BalcliError: It has none; the error names the missing table.
    """
    if engine.gas is None:
        raise BalcliError(f"{name_file(path)}: {NO_GAS}")


def silence_cylinders(engine: Engine, numbers: Collection[str], path: str) -> Engine:
    """Return the engine without the gas of some cylinders.

    Args:
        engine: Engine with gas.
        numbers: Numbers of the cylinders, as typed.
        path: File of the engine, for messages.

    Raises:
        BalcliError: It has no gas, or no such cylinder.
    """
    if not numbers:
        return engine
    require_gas(engine, path)
    from ..forces.curves import silence  # for those who ask

    for number in numbers:
        engine = silence(engine, parse_cylinder(number))
    return engine


def named_by_file(engine: Engine, path: str) -> Engine:
    """Return the engine, named by its file if it has no name.

    Args:
        engine: Engine.
        path: Its file.
    """
    return engine if engine.name else replace(engine, name=legible(Path(name_file(path)).stem))


def name_engines(names: Sequence[str], paths: Sequence[str]) -> list[str]:
    """Return names that distinguish engines: the name of each, or its file if it has no name or
    shares it with another.

    Args:
        names: Names of the engines; may be empty.
        paths: Their files.
    """
    return [
        name if name and names.count(name) == 1 else legible(name_file(path))
        for name, path in zip(names, paths, strict=True)
    ]

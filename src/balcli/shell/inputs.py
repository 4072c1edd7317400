"""Find and read the engine files of a command, with warnings of suspicious values."""

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
    name_option,
    note,
    say_error,
    warn,
)
from ..file.toml import find_near_file, name_file, read_bytes
from ..show.sheet import tell_assumed
from .options import WORDS_OF_ONLY
from .values import parse_cylinder

if TYPE_CHECKING:
    from ..engine.engine import Engine
    from ..file.doubt import Doubt
    from ..file.model import EngineFile


# Words of --only whose results include moments.
ABOUT_MOMENTS = frozenset({"peak", "sizing", "ladder", "guide", "pru", "xy", "textbook", "verdict"})

P = TypeVar("P")
T = TypeVar("T")


class LoadedEngine(NamedTuple):
    """Text, model and engine of an engine file."""

    text: bytes
    model: EngineFile
    engine: Engine


def read_engine(
    path: str,
    speed_rpm: float | None = None,
    asked: Collection[str] | None = None,
    prepare: Callable[[EngineFile], EngineFile] = lambda model: model,
    over: Sequence[float] | None = None,
    lists_drifting: bool = False,
) -> LoadedEngine:
    """Read one file (`-`: standard input), with warnings about suspicious values on standard error.

    Args:
        path: Path of the file.
        speed_rpm: Crank speed of the engine instead of the file's.
        asked: Names of requested quantities and tables; None: all that the command shows. If
            none of these results includes moments, unknown moments cause no warning.
        prepare: Function that changes the file before the engine is built.
        over: Speeds for which results are computed, rpm; None: the engine's own speed.
        lists_drifting: Whether the command lists shafts without a fixed phase to the crank, so that
            no warning is needed.

    Raises:
        BalcliError: The file has mistakes (the error lists all), or a moment or gas was requested
            and is not known.
    """
    if path in WORDS_OF_ONLY and not os.path.exists(path):
        raise BalcliError(f"{path}: no such file; was --only force,{path} meant?")
    from ..engine import load, parse
    from ..file.doubts import doubt_drifting

    text = read_bytes(path)
    model = parse.parse(text, name_file(path))
    engine = load.build_named(prepare(model), path)
    if is_verbose():
        note(f"{name_file(path)}: read, {len(text)} bytes")
        for value in engine.inferred:
            note(f"{name_file(path)}: not in the file: {tell_assumed([value])}")
    if not engine.places_known:
        _tell_unknown(name_file(path), asked)
    if "gas" in (asked or ()):
        require_gas(engine, path)
    if speed_rpm is not None:
        turned = engine.model and engine.model.with_table("operation", speed=speed_rpm)
        engine = replace(engine.at_speed(speed_rpm), model=turned)
    speeds = [float(engine.speed_rpm)] if over is None else over
    unlikely = engine.unlikely
    if lists_drifting:
        listed = {each.message for file in (model, *model.cranks) for each in doubt_drifting(file)}
        unlikely = tuple(doubt for doubt in unlikely if doubt.message not in listed)
    warn_each((*unlikely, *engine.doubt_speeds(speeds)), name_file(path))
    return LoadedEngine(text, model, engine)


def _tell_unknown(name: str, asked: Collection[str] | None) -> None:
    """Raise an error if unknown moments are requested by name; warn that they are unknown if other
    results that include moments are requested.
    """
    words = ABOUT_MOMENTS if asked is None else asked
    if by_name := [quantity for quantity in ("moment", "inner") if quantity in words]:
        raise BalcliError(f"{name}: {by_name[0]}: {MOMENTS_UNKNOWN}")
    if ABOUT_MOMENTS.intersection(words):
        warn(f"{name}: {MOMENTS_UNKNOWN}")


def warn_each(doubts: Iterable[Doubt], name: str) -> None:
    """Print warnings about a file on standard error.

    Args:
        doubts: Warnings.
        name: Name of the file.
    """
    for doubt in doubts:
        warn(f"{name}: {doubt.tell(name_option)}")


def try_each(
    paths: Iterable[P], work: Callable[[P], T], in_folder: Collection[P] = ()
) -> tuple[list[T], list[str]]:
    """Return the results of all valid files, in order, and the error messages of the others.

    Args:
        paths: Files to work on.
        work: Function that returns the result of a file.
        in_folder: Those of the files that were found in a folder, not named by the user. If such a
            file is of another kind, it is skipped with a note.
    """
    results = []
    errors = []
    for path in paths:
        try:
            results.append(work(path))
        except BalcliError as error:
            if path in in_folder and isinstance(error, OtherKindError):
                note(f"{path}: skipped, a file of another kind")
            else:
                errors.append(error.tell(name_option))
    return results, errors


def exit_on_errors(errors: Sequence[str]) -> None:
    """If there are messages, print them on standard error and end with exit status 2."""
    for text in errors:
        say_error(text)
    if errors:
        raise typer.Exit(Exit.BAD_INPUT)


def find_engine_files(paths: Sequence[Path]) -> list[Path]:
    """Return the named files, and all engine files in named folders and their subfolders. Files in
    hidden folders and pyproject.toml are skipped.

    Raises:
        BalcliError: A path does not exist, or a folder has no engine files.
    """
    files: list[Path] = []
    for path in paths:
        # Unlike Path.is_dir, this is false for forbidden paths and for names that are too long.
        folder = os.path.isdir(path)
        in_folder = sorted(filter(_is_engine, _walk(path))) if folder else [path]
        if not in_folder:
            raise BalcliError(f"{path}: has no engine files (*.toml)")
        if not os.path.exists(path):
            raise BalcliError(f"{path}: no such file or folder{find_near_file(path)}")
        files += in_folder
    return files


def find_expected(paths: Sequence[Path]) -> list[Path]:
    """Return the files with expected results of `check` in those paths that are folders, and in
    their subfolders.
    """
    files = chain.from_iterable(_walk(path) for path in paths if os.path.isdir(path))
    return sorted({f for f in files if f.parent.name == "expected" and f.suffix == ".json"})


def _walk(folder: Path) -> Iterator[Path]:
    """Yield all files in a folder and its subfolders, except files in hidden folders."""
    for path in folder.rglob("*"):
        if not any(part.startswith(".") for part in path.relative_to(folder).parts[:-1]):
            yield path


def _is_engine(path: Path) -> bool:
    return path.suffix == ".toml" and path.name != "pyproject.toml" and path.is_file()


def require_gas(engine: Engine, path: str) -> None:
    """Check that an engine has gas.

    Args:
        engine: Engine to check.
        path: File of the engine, for messages.

    Raises:
        BalcliError: The engine has no gas; the error names the missing table.
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
        BalcliError: The engine has no gas or no such cylinder.
    """
    if not numbers:
        return engine
    require_gas(engine, path)
    from ..forces.curves import silence  # rarely needed

    for number in numbers:
        engine = silence(engine, parse_cylinder(number))
    return engine


def named_by_file(engine: Engine, path: str) -> Engine:
    """Return the engine; if it has no name, its file's name is used.

    Args:
        engine: Engine.
        path: File of the engine.
    """
    return engine if engine.name else replace(engine, name=legible(Path(name_file(path)).stem))


def name_engines(names: Sequence[str], paths: Sequence[str]) -> list[str]:
    """Return distinct names of engines: the name of each engine, or the name of its file if the
    engine has no name or another engine has the same name.

    Args:
        names: Names of the engines; may be empty.
        paths: Files of the engines.
    """
    distinct = []
    for name, path in zip(names, paths, strict=True):
        is_own = name and names.count(name) == 1
        distinct.append(name if is_own else legible(name_file(path)))
    return distinct

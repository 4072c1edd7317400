"""Several engine files: what is good is reported, what is bad is named."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TypeVar

import typer

from ..engine.build import Engine
from ..engine.load import build_named, parse
from ..enginefile.model import EngineFile
from ..enginefile.read import name_file, read_bytes
from ..enginefile.suspicious import suspicious
from ..errors import BalcliError, Exit, legible, say

F = TypeVar("F")
T = TypeVar("T")


def engine_of(file: str, speed_rpm: float | None = None) -> tuple[EngineFile, Engine]:
    """Model and engine of one file, with warnings about suspicious values on standard error.

    Raises:
        BalcliError: all mistakes of the file.
    """
    return _built(parse(read_bytes(file), name_file(file)), file, speed_rpm)


def engine_and_text(file: str, speed_rpm: float | None = None) -> tuple[bytes, Engine]:
    """The text of one file, too, for what is written from it."""
    text = read_bytes(file)
    return text, _built(parse(text, name_file(file)), file, speed_rpm)[1]


def _built(model: EngineFile, file: str, speed_rpm: float | None) -> tuple[EngineFile, Engine]:
    engine = build_named(model, file)
    for warning in suspicious(model):
        say(f"warning: {name_file(file)}: {warning}")
    return model, engine if speed_rpm is None else replace(engine, speed_rpm=speed_rpm)


def each(files: Sequence[F], work: Callable[[F], T]) -> tuple[list[T], list[str]]:
    """Results of all good files, in order, and the messages of the bad ones."""
    results, errors = [], []
    for file in files:
        try:
            results.append(work(file))
        except BalcliError as error:
            errors.append(str(error))
    return results, errors


def tell(errors: Sequence[str]) -> None:
    """Messages on standard error and exit status 2, if there are any."""
    for text in errors:
        say(f"balcli: {text}")
    if errors:
        raise typer.Exit(Exit.BAD_INPUT)


def engine_files(paths: Sequence[Path]) -> list[Path]:
    """Engine files as named, and all that are in a folder.

    Raises:
        BalcliError: a path that is not there, a folder without engine files.
    """
    files: list[Path] = []
    for path in paths:
        folder = os.path.isdir(
            path
        )  # unlike Path.is_dir false where one may not look, or the name is too long
        found = sorted(path.glob("*.toml")) if folder else [path]
        if not found or not os.path.exists(path):
            raise BalcliError(
                f"{path}: {'has no engine files (*.toml)' if folder else 'no such file or folder'}"
            )
        files += found
    return files


def named(engine: Engine, file: str) -> Engine:
    """The engine, called by its file where it has no name."""
    return engine if engine.name else replace(engine, name=legible(Path(name_file(file)).stem))


def distinct(names: Sequence[str], files: Sequence[str]) -> list[str]:
    """What to call several engines side by side: by name, or by file where a name is missing or
    stands for several.
    """
    return [
        name if name and names.count(name) == 1 else legible(name_file(file))
        for name, file in zip(names, files, strict=True)
    ]

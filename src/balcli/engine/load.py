"""Engine file -> engine: read, checked against the rules, built; every mistake at once, each by its
path in the file and with what would be right.
"""

from __future__ import annotations

from pathlib import Path

from ..enginefile.model import EngineFile
from ..enginefile.read import read_tables
from ..enginefile.toml_text import name_file, read_bytes
from ..errors import InputError
from .assembly import Assembly
from .build import Engine, build
from .rules import find_contradictions


def load(source: str | Path) -> Engine:
    """The engine that a file describes, ready to analyse; "-" reads standard input.

    Raises:
        BalcliError: there is nothing to read.
        InputError: every mistake of the file.
    """
    return build_named(read(source), source)


def build_named(model: EngineFile, path: str | Path) -> Engine:
    """The engine of a model from the file at a path ("-": standard input).

    Raises:
        InputError: what does not fit together in this file.
    """
    try:
        return build(model)
    except InputError as error:
        raise InputError(error.problems, name_file(path)) from None


def read(path: str | Path) -> EngineFile:
    """The model of the engine file at a path, or from standard input for "-".

    Raises:
        BalcliError: there is nothing to read.
        InputError: every mistake that the text has.
    """
    return parse(read_bytes(path), name_file(path))


def parse(text: str | bytes, name: str = "") -> EngineFile:
    """The model of an engine that a TOML text describes; `name` is that of its file, for messages.

    Raises:
        InputError: every mistake that the text has; and then also what does not fit together in the
            tables that could be read.
    """
    draft = read_tables(text, name)
    if not draft.has_mistakes:
        return draft.model
    raise draft.refusal(find_contradictions(Assembly(draft.model, legible=draft.legible)), name)

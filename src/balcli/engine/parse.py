"""Turn text or tables of an engine file into its checked model.

All mistakes are reported at once, each with its path in the file and a remedy. The rules of
`engine.build` are checked as well, unless a table that these rules need has mistakes.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from ..errors import InputError, Problem
from ..file.model import EngineFile
from ..file.plain_tables import normalize_tables
from ..file.read import Draft, check_tables, read_tables, refuse
from ..file.toml import name_file, read_bytes
from .build import list_contradictions
from .firing.rules import infer_numbering
from .placed import read_engines


def read(path: str | Path) -> EngineFile:
    """Return the model of the engine file at a path, or from standard input for "-".

    Raises:
        BalcliError: The file cannot be read.
        InputError: The text has mistakes; the error lists all of them.
    """
    return parse(read_bytes(path), name_file(path))


def parse(text: str | bytes, name: str = "") -> EngineFile:
    """Return the model of an engine that a text describes.

    Args:
        text: Text of the file (TOML).
        name: Name of the file, for messages.

    Raises:
        InputError: The text has mistakes. The error lists all of them, and also the contradictions
            between tables that have no mistakes themselves.
    """
    return _refuse_mistakes(read_tables(text, name), name)


def parse_dict(tables: Mapping[str, object], folder: Path = Path(), name: str = "") -> EngineFile:
    """Return the model of an engine that the tables of a dict describe.

    Args:
        tables: Tables as in an engine file.
        folder: Folder of the files that the tables name; default: the working directory.
        name: Name of the file that has the tables, for messages.

    Raises:
        InputError: As for `parse`.
    """
    return _refuse_mistakes(check_tables(normalize_tables(tables), folder, name), name)


def _refuse_mistakes(draft: Draft, name: str = "") -> EngineFile:
    draft = join_engines(draft)
    if not draft.problems:
        return draft.model if draft.model.engine else infer_numbering(draft.model)
    problems = [*draft.problems, *list_contradictions(draft)]
    raise refuse(problems, name)


def join_engines(draft: Draft) -> Draft:
    """Return the readable part of a file, joined with the files that its [[engine]] tables name."""
    if not draft.model.engine:
        return draft
    return read_engines(draft, _parse_one)


def _parse_one(text: bytes, name: str) -> EngineFile:
    draft = read_tables(text, name)
    if draft.model.engine:
        message = "has [[engine]] itself; name files of single engines"
        raise InputError([Problem("", message)], name)
    return _refuse_mistakes(draft, name)

"""Text or tables of an engine file -> its checked model: every mistake at once, each by its path in
the file and with what would be right.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..enginefile.model import EngineFile
from ..enginefile.plain_tables import normalize_tables
from ..enginefile.read import Draft, check_tables, read_tables
from ..enginefile.table_reader import refuse
from ..enginefile.toml_text import name_file, read_bytes
from .assembly import Assembly
from .numbering import infer_numbering
from .rules import find_contradictions


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
    return _refuse_mistakes(read_tables(text, name), name)


def parse_tables(tables: Mapping[str, Any], name: str) -> EngineFile:
    """Return the model of an engine that normalized tables describe.

    Args:
        tables: As of `normalize_tables`.
        name: Name of the file, beside which those stand that it names, or empty.

    Raises:
        InputError: As of `parse`.
    """
    return _refuse_mistakes(check_tables(tables, Path(name).parent, name), name)


def parse_dict(tables: Mapping[str, Any], folder: Path | None = None) -> EngineFile:
    """The model of an engine that the tables of a dict describe.

    Args:
        tables: as a file has them.
        folder: in which the files are that they name; default: the working directory.

    Raises:
        InputError: as of `parse`.
    """
    return _refuse_mistakes(check_tables(normalize_tables(tables), folder or Path()))


def _refuse_mistakes(draft: Draft, name: str = "") -> EngineFile:
    if not draft.problems:
        return infer_numbering(draft.model)
    contradictions = find_contradictions(Assembly(draft.model, legible=draft.legible))
    raise refuse([*draft.problems, *contradictions], name)

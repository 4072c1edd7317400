"""The tables of a file that is of no engine (runs of a rotor, a chain of inertias), read one by
one: every mistake by its path, with what would be right.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TypeVar

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from ..errors import InputError, Problem
from ..limits import MOST_MISTAKES_SHOWN
from .conflicts import RefusedTable, examine_refused
from .fields import nearest, shorten
from .messages import join_path
from .model import FileTable

T = TypeVar("T", bound=FileTable)
_NEAR = 0.65  # of a key and one that is meant: "damper" is no "name"


class TableReader:
    """Reads tables and collects the mistakes.

    Args:
        file_kind: what the file is, in words: "a chain file".
        describe: one of pydantic's findings in a table with this path, in words.

    Attributes:
        problems: the mistakes so far.
        refused: tables with mistakes in them, by their paths.
    """

    def __init__(
        self, file_kind: str, describe: Callable[[str, ErrorDetails, type[FileTable]], Problem]
    ) -> None:
        self._file_kind, self._describe = file_kind, describe
        self.problems: list[Problem] = []
        self.refused: dict[str, RefusedTable] = {}
        self._meant: set[str] = set()  # paths of keys that are there, misspelt

    def read_list(self, key: str, value: object, table: type[T], most: int) -> tuple[T | None, ...]:
        """The tables under a key, of which there may be so many; None for those with mistakes."""
        if not isinstance(value, list):
            wanted = f"write [[{key}]] in double brackets, once for each {key}"
            self._add(key, f"is one of several; {wanted}")
            return ()
        if len(value) > most:
            self._add(key, f"stands {len(value)} times; at most {most} are taken")
            return ()
        return tuple(self.read_table(f"{key}.{k}", item, table) for k, item in enumerate(value, 1))

    def read_table(self, path: str, value: object, table: type[T]) -> T | None:
        """The table with this path (empty: the file itself); None if it has mistakes."""
        if not isinstance(value, Mapping):
            self._add(path, f"{shorten(value)} is not a table; write {_heading(path)} above it")
            return None
        keys = table.keys()
        unknown = [key for key in value if key not in keys]
        for key in unknown:
            self._refuse_key(path, key, table)
        known = {key: value[key] for key in value if key in keys}
        try:
            return table.model_validate(known)
        except ValidationError as error:
            refused = self.refused[path] = examine_refused(path, table, known, error)
        described = [self._describe(path, finding, table) for finding in refused.findings]
        for problem in (*refused.conflicts, *described):
            missing = tuple(each.lstrip(".") for each in problem.missing)
            self.problems.append(Problem(problem.path.lstrip("."), problem.message, missing))
        return None

    def refusal(self, name: str) -> InputError:
        """The error that lists the mistakes of the file with this name, or of one without. A key
        that is missing is not told where it is there, misspelt.
        """
        problems = [one for one in self.problems if self._meant.isdisjoint(one.missing)]
        more = max(len(problems) - MOST_MISTAKES_SHOWN, 0)
        named = name or self._file_kind.removeprefix("a ")
        return InputError(problems[:MOST_MISTAKES_SHOWN], named, more)

    def _refuse_key(self, path: str, key: str, table: type[FileTable]) -> None:
        place = f"in {_heading(path)}" if path else f"in {self._file_kind}"
        near = nearest(key, table.keys(), _NEAR)
        if near:
            self._meant.add(join_path(path, [near]).lstrip("."))
        hint = f"did you mean {near}?" if near else f"it has {', '.join(table.keys())}"
        self._add(join_path(path, [key]), f"unknown key {place}; {hint}")

    def _add(self, path: str, message: str) -> None:
        self.problems.append(Problem(path.lstrip("."), message))


def _heading(path: str) -> str:
    return f"[[{path.partition('.')[0]}]]"

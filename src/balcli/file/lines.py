"""Find the line of a key in the text of a TOML file.

A valid file stays valid if it is cut after a whole statement: a heading, or a key with its value.
The line of a key is found by cutting: the statement with the key is the first one without which the
text above it lacks the key. So only tomllib has to know the syntax of TOML.
"""

from __future__ import annotations

import tomllib
from bisect import bisect_left
from collections.abc import Mapping, Sequence
from contextlib import suppress
from typing import Any

from ..core.records import Node

_MOST_LINES = 1000  # lines of a file in which keys are found; an engine file has up to 300
_LONGEST_PATH = 300  # characters of a path: a key and the name of a quantity
_LONGEST_STATEMENT = 200  # lines of a value, such as a list of positions


class _TooLongError(Exception):
    """A statement has too many lines."""


class LineFinder:
    """Finder of the lines of keys in one file. A file that is no valid TOML has no keys.

    Args:
        text: Text of the file.
    """

    def __init__(self, text: bytes) -> None:
        decoded = text.decode("utf-8-sig", errors="replace")
        self._lines = decoded.replace("\r\n", "\n").split("\n")
        if len(self._lines) > _MOST_LINES:
            self._lines = []

    def find(self, path: str) -> int | None:
        """Return the line, from 1, of a key or table. For a key that the file lacks, return the
        line of the table that should have it; None if there is no such table.

        Args:
            path: Dotted name as in messages about mistakes: `shaft.2.ratio`, `crank.throws.1`.
        """
        if len(path) > _LONGEST_PATH:
            return None
        with suppress(_TooLongError):
            return self._find(path.split("."))
        return None

    def _find(self, keys: Sequence[str]) -> int | None:
        depth = _count_keys(self._read(len(self._lines)), keys)
        if depth == 0:
            return None

        def has_key(count: int) -> bool:
            return _count_keys(self._read(count), keys) == depth

        end = bisect_left(range(len(self._lines)), True, key=has_key)
        return self._count_whole(end - 1) + 1

    def _read(self, count: int) -> Node:
        """Return the content of the first lines of the file, without an unfinished statement."""
        return self._parse(self._count_whole(count)) or {}

    def _count_whole(self, count: int) -> int:
        """Return how many of the first lines belong to whole statements."""
        for whole in range(count, max(count - _LONGEST_STATEMENT, -1), -1):
            if self._parse(whole) is not None:
                return whole
        raise _TooLongError

    def _parse(self, count: int) -> Node | None:
        """Return the content of the first lines of the file; None if they are no valid TOML."""
        try:
            return tomllib.loads("\n".join(self._lines[:count]))
        except (ValueError, RecursionError):
            return None


def _count_keys(tables: Node, keys: Sequence[str]) -> int:
    """Return how many of the keys, which lead from table to table, the tables have."""
    place: Any = tables
    count = 0
    while count < len(keys):
        used, place = _descend(place, keys[count:])
        if used == 0:
            break
        count += used
    return count


def _descend(place: Any, keys: Sequence[str]) -> tuple[int, Any]:
    """Return what a table or list has under the first keys, and how many keys lead to it; 0 if
    there is nothing. One key of the file may have dots: "moment.1.major".
    """
    if isinstance(place, Mapping):
        for used in range(len(keys), 0, -1):
            key = ".".join(keys[:used])
            if key in place:
                return used, place[key]
    if isinstance(place, list) and keys[0].isdecimal() and 0 < int(keys[0]) <= len(place):
        return 1, place[int(keys[0]) - 1]
    return 0, None

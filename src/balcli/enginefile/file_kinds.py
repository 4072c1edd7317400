"""The three kinds of files, told apart by the keys at their head."""

from __future__ import annotations

from collections.abc import Container
from typing import NamedTuple

from ..errors import InputError, Problem
from .messages import KNOWN

SHARED = {"name", "source", "shaft"}  # keys of an engine file that others have, or might have


class OtherKindError(InputError):
    """A file of one kind where another is wanted."""


class FileKind(NamedTuple):
    """A kind of file.

    Attributes:
        name: of the kind, in words.
        reader: the command that reads it, in words.
        keys: that only this kind has.
    """

    name: str
    reader: str
    keys: frozenset[str]


ENGINE = FileKind("an engine file", "balcli analyze and others read", frozenset(KNOWN) - SHARED)
RUNS = FileKind("a file of runs", "balcli field reads", frozenset({"planes", "run"}))
CHAIN = FileKind("a chain file", "balcli torsion reads", frozenset({"node", "excitation"}))


def refuse_other_kind(head: Container[str], file: str, *wanted: FileKind) -> None:
    """Raise an error if the keys at the head of a file are those of one other kind, and none of a
    kind that is wanted: a list of all its mistakes would not help.

    Raises:
        OtherKindError: with what it is, and who reads it.
    """
    found = [kind for kind in (ENGINE, RUNS, CHAIN) if any(key in head for key in kind.keys)]
    if len(found) == 1 and found[0] not in wanted:
        names = " or ".join(kind.name for kind in wanted)
        message = f"is {found[0].name}, which {found[0].reader}; give {names}"
        raise OtherKindError([Problem("", message)], file)

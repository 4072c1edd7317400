"""Which of three kinds a file is, by what stands at its head."""

from __future__ import annotations

from collections.abc import Container
from typing import NamedTuple

from ..errors import InputError, Problem
from .messages import KNOWN

SHARED = {"name", "source", "shaft"}  # keys of an engine file that others have, or might have


class OtherKindError(InputError):
    """A file of one kind where another is wanted."""


class FileKind(NamedTuple):
    """What a file is in words, who reads it, and the keys of which it alone has any."""

    name: str
    reader: str
    keys: frozenset[str]


ENGINE = FileKind("an engine file", "balcli analyze and others read", frozenset(KNOWN) - SHARED)
RUNS = FileKind("a file of runs", "balcli field reads", frozenset({"planes", "run"}))
CHAIN = FileKind("a chain file", "balcli torsion reads", frozenset({"node", "excitation"}))


def refuse_other_kind(head: Container[str], file: str, *wanted: FileKind) -> None:
    """Nothing, unless the keys at the head of a file are those of one other kind, and none of a
    kind that is wanted: then its mistakes, key by key, would say nothing.

    Raises:
        OtherKindError: with what it is, and who reads it.
    """
    found = [kind for kind in (ENGINE, RUNS, CHAIN) if any(key in head for key in kind.keys)]
    if len(found) == 1 and found[0] not in wanted:
        names = " or ".join(kind.name for kind in wanted)
        message = f"is {found[0].name}, which {found[0].reader}; give {names}"
        raise OtherKindError([Problem("", message)], file)

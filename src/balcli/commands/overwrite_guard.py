"""What a command reads stays as it is: no result may go onto an engine file, or onto another
result.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping
from functools import wraps
from pathlib import Path
from typing import Any

from ..errors import BalcliError

READ = ("file", "files", "first", "second")  # parameters of commands
WRITTEN = ("output", "write", "plot")


def guarded(command: Callable[..., None]) -> Callable[..., None]:
    """The command, which first refuses such paths. Raises BalcliError with the option and its
    path.
    """

    @wraps(command)
    def checked(**chosen: Any) -> None:
        _refuse(chosen)
        command(**chosen)

    return checked


def _refuse(chosen: Mapping[str, Any]) -> None:
    read, written = list(_paths(chosen, READ)), list(_paths(chosen, WRITTEN))
    for k, (option, target) in enumerate(written):
        if any(_same(target, source) for _, source in read):
            raise BalcliError(
                f"--{option} {target}: this is the engine file itself, which stays as it is; "
                "choose another name"
            )
        if any(_same(target, other) for _, other in written[:k]):
            raise BalcliError(
                f"--{option} {target}: another result goes there, too; choose another name"
            )


def _paths(chosen: Mapping[str, Any], names: tuple[str, ...]) -> Iterator[tuple[str, str]]:
    for name in names:
        value = chosen.get(name)
        values = value if isinstance(value, (list, tuple)) else [value]
        yield from (
            (name, str(path))
            for path in values
            if isinstance(path, (str, Path)) and str(path) != "-"
        )


def _same(one: str, other: str) -> bool:
    """Whether two paths are one file, there or not; a device may be named as often as one likes."""
    if not os.path.exists(one):
        return os.path.realpath(one) == os.path.realpath(other)
    return os.path.isfile(one) and os.path.exists(other) and os.path.samefile(one, other)

"""What a command reads stays as it is: no result may go onto an engine file, onto one that it names
or onto another result, and all results have a folder before one is written.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from ..errors import BalcliError, tell_unwritable
from .file_names import Place

STANDARD_INPUT = "-"
_OF_RESULTS = ("OUT", "--output")  # where - is standard output


def refuse_overwriting(*, reads: Sequence[str], writes: Mapping[str, Path | Place | None]) -> None:
    """Refuse to write onto a file that is read, two results into one file, or one where there is no
    folder; to read standard input twice, and to write a second result onto standard output.

    Args:
        reads: paths of the engine files; `-` is standard input.
        writes: by option (`--output`), where its result goes; None: nowhere.

    Raises:
        BalcliError: with the option and its path.
    """
    if list(reads).count(STANDARD_INPUT) > 1:
        raise BalcliError("standard input (-) is named twice, and can be read only once")
    sources = [path for path in reads if path != STANDARD_INPUT]
    targets = [
        (option, str(place.path if isinstance(place, Place) else place))
        for option, place in writes.items()
        if place is not None
    ]
    for option, target in targets:
        if target == "-" and option not in _OF_RESULTS:
            raise BalcliError(f"{option} -: name a file; standard output is for results alone")
    there = any(os.path.isfile(target) for _, target in targets)
    named = _list_named(sources) if there else []
    for k, (option, target) in enumerate(targets):
        if any(_same_file(target, source) for source in (*sources, *named)):
            raise BalcliError(
                f"{option} {target}: this is a file that is read, which stays as it is; "
                "choose another name"
            )
        if any(_same_file(target, other) for _, other in targets[:k]):
            raise BalcliError(
                f"{option} {target}: another result goes there, too; choose another name"
            )
        try:
            os.stat(os.path.join(os.path.dirname(target) or ".", ""))
        except OSError as error:
            raise tell_unwritable(target, error) from None


def _list_named(sources: Iterable[str]) -> list[str]:
    """Paths of the files that engine files name."""
    from .named_files import list_named_files  # for an output that is there already alone

    return [str(file) for source in sources for file in list_named_files(source)]


def _same_file(one: str, other: str) -> bool:
    """Whether two paths are one file, there or not; a device may be named as often as one likes."""
    if not os.path.exists(one):
        return os.path.realpath(one) == os.path.realpath(other)
    return os.path.isfile(one) and os.path.exists(other) and os.path.samefile(one, other)

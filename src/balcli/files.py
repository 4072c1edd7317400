"""Files and folders that are written beside their place and moved there when they are whole."""

from __future__ import annotations

import errno
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import chain, count
from pathlib import Path

from .errors import BalcliError, note, tell_unwritable
from .process import discard, unfinished


@contextmanager
def replacing(target: Path) -> Iterator[Path]:
    """A new file beside the target, which replaces it when all has gone well and is gone otherwise.

    Through a symbolic link, what it points to is replaced. What is no ordinary file (/dev/null, a
    pipe) is itself written to.

    Raises:
        BalcliError: if it cannot be written; an older one is left as it was.
    """
    try:
        if target.is_dir():
            raise BalcliError(f"{target}: is a folder, so no file can be written there")
        if target.exists() and not target.is_file():
            yield target
            return
        real = Path(os.path.realpath(target))
        if real.is_symlink():
            raise OSError(errno.ELOOP, "a symbolic link that leads to itself")
        with making_beside(real, _make_file) as place:
            yield place
            if not place.exists():  # it is only a part, and has been moved elsewhere
                return
            if real.exists():
                place.chmod(real.stat().st_mode & 0o777)
            size = place.stat().st_size
            place.replace(real)
            note(f"{target}: written, {size} bytes")
    except OSError as error:
        raise tell_unwritable(target, error) from None


@contextmanager
def making_beside(target: Path, make: Callable[[Path, Path], None]) -> Iterator[Path]:
    """A file or folder beside the target; it is gone afterwards unless it has been moved, also
    where a signal ends the process.

    Args:
        target: whose place it may take.
        make: makes it: is given its path, and the target's.
    """
    place = name_hidden(target)
    unfinished.add(str(place))
    try:
        make(place, target)
        yield place
    finally:
        discard(str(place))
        unfinished.discard(str(place))


def _make_file(place: Path, target: Path) -> None:
    """An empty one, as secret as the target is."""
    mode = 0o600 if target.exists() else 0o666
    os.close(os.open(place, os.O_CREAT | os.O_EXCL | os.O_WRONLY, mode))


def make_folder(place: Path, _: Path) -> None:
    """For `making_beside`: an empty one."""
    place.mkdir()


def name_hidden(target: Path) -> Path:
    """A name beside the target that nobody has."""
    return target.parent / f".{target.name[:40]}.{os.urandom(6).hex()}"


def follow_link(target: Path) -> Path:
    """What a symbolic link leads to; any other path as it is."""
    return Path(os.path.realpath(target)) if target.is_symlink() else target


def name_part(target: Path, may_replace: Callable[[Path], bool]) -> Path:
    """Where what there is of a target goes: `name.part` beside it, or `name.part2`, `name.part3`...
    if something else stands there.

    Args:
        target: of which there is only a part.
        may_replace: whether what is at a path may be lost; not asked where nothing is.
    """
    for ending in chain([""], count(2)):
        part = target.with_name(f"{target.name}.part{ending}")
        if not os.path.lexists(part) or may_replace(part):
            break
    return part

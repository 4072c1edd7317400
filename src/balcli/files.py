"""Atomic writes: a temporary file or folder next to the target replaces it when it is whole."""

from __future__ import annotations

import errno
import os
import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import chain, count
from pathlib import Path

from .errors import BalcliError, note, tell_unwritable


@contextmanager
def replacing(target: Path) -> Iterator[Path]:
    """Yield a temporary file, which replaces the target afterwards unless there was an error.

    A symbolic link stays, and the file it points to is replaced. A device or pipe is written to
    directly. An existing target keeps its mode.

    Raises:
        BalcliError: the target cannot be written; an older one is left as it was.
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
            if not place.exists():  # an incomplete sweep has been moved to its `.part`
                return
            if real.exists():
                place.chmod(real.stat().st_mode & 0o777)
            with place.open("rb+") as stream:
                os.fsync(stream.fileno())
                size = stream.seek(0, os.SEEK_END)
            place.replace(real)
            note(f"{target}: written, {size} bytes")
    except OSError as error:
        raise tell_unwritable(target, error) from None


@contextmanager
def making_beside(target: Path, make: Callable[[Path, Path], None]) -> Iterator[Path]:
    """Yield a temporary file or folder next to the target; what has not been moved is removed.

    Args:
        target: the path whose place it may take.
        make: creates it; its arguments are the temporary path and the target.
    """
    place = name_hidden(target)
    try:
        make(place, target)
        yield place
    finally:
        discard(place)


def _make_file(place: Path, target: Path) -> None:
    """Create an empty file, private if there is a target, whose mode it gets later."""
    mode = 0o600 if target.exists() else 0o666
    os.close(os.open(place, os.O_CREAT | os.O_EXCL | os.O_WRONLY, mode))


def make_folder(place: Path, _: Path) -> None:
    """Create an empty folder; for `making_beside`."""
    place.mkdir()


def discard(place: Path) -> None:
    """Delete a temporary file, or a folder with its files, if it is still there."""
    if place.is_dir():
        shutil.rmtree(place, ignore_errors=True)
    else:
        place.unlink(missing_ok=True)


def name_hidden(target: Path) -> Path:
    """Return an unused hidden name next to the target."""
    return target.parent / f".{target.name[:40]}.{os.urandom(6).hex()}"


def follow_link(target: Path) -> Path:
    """Return the path that a symbolic link leads to; any other path as it is."""
    return Path(os.path.realpath(target)) if target.is_symlink() else target


def name_part(target: Path, may_replace: Callable[[Path], bool]) -> Path:
    """Return the path for an incomplete result: `name.part` next to the target, or `name.part2`,
    `name.part3` ... if that is taken.

    Args:
        target: the path of the whole result.
        may_replace: whether an existing path may be overwritten.
    """
    for ending in chain([""], count(2)):
        part = target.with_name(f"{target.name}.part{ending}")
        if not os.path.lexists(part) or may_replace(part):
            break
    return part

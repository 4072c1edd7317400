"""Atomic writes: a temporary file next to the target replaces it when it is whole."""

from __future__ import annotations

import errno
import os
from collections.abc import Iterator
from contextlib import contextmanager
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
        place = name_hidden(real)
        try:
            _make_file(place, real)
            yield place
            if real.exists():
                place.chmod(real.stat().st_mode & 0o777)
            with place.open("rb+") as stream:
                os.fsync(stream.fileno())
                size = stream.seek(0, os.SEEK_END)
            place.replace(real)
        finally:
            place.unlink(missing_ok=True)
        note(f"{target}: written, {size} bytes")
    except OSError as error:
        raise tell_unwritable(target, error) from None


def _make_file(place: Path, target: Path) -> None:
    """Create an empty file, private if there is a target, whose mode it gets later."""
    mode = 0o600 if target.exists() else 0o666
    os.close(os.open(place, os.O_CREAT | os.O_EXCL | os.O_WRONLY, mode))


def name_hidden(target: Path) -> Path:
    """Return an unused hidden name next to the target."""
    return target.parent / f".{target.name[:40]}.{os.urandom(6).hex()}"

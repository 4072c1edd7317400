"""Write files atomically: a temporary file next to the target replaces it once it is complete."""

from __future__ import annotations

import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from .errors import BalcliError, note, tell_unwritable


@contextmanager
def replacing(target: Path) -> Iterator[Path]:
    """Yield a temporary file, which replaces the target afterwards unless there was an error.

    A symbolic link is kept; the file to which it points is replaced. A device or pipe is written to
    directly. An existing target keeps its mode.

    Raises:
        BalcliError: The target cannot be written; an existing file is unchanged.
    """
    try:
        mode = _read_mode(target)
        if mode is not None and stat.S_ISDIR(mode):
            raise BalcliError(f"{target}: is a folder, so no file can be written there")
        if mode is not None and not stat.S_ISREG(mode):
            yield target
            return
        real = Path(os.path.realpath(target))
        place = name_hidden(real)
        try:
            # if the target exists, the file is private until it gets the target's mode
            flags = os.O_CREAT | os.O_EXCL | os.O_WRONLY
            private = 0o600
            os.close(os.open(place, flags, 0o666 if mode is None else private))
            yield place
            if mode is not None:
                place.chmod(stat.S_IMODE(mode) & 0o777)
            with place.open("rb+") as stream:
                os.fsync(stream.fileno())
                size = stream.seek(0, os.SEEK_END)
            place.replace(real)
        finally:
            place.unlink(missing_ok=True)
        note(f"{target}: written, {size} bytes")
    except OSError as error:
        raise tell_unwritable(target, error) from None


def _read_mode(path: Path) -> int | None:
    """Return the mode of the file or device at a path; None if nothing is there.

    If the system refuses access, this raises OSError, where `Path.exists` would report a missing
    file.
    """
    try:
        return os.stat(path).st_mode
    except FileNotFoundError:
        return None


def name_hidden(target: Path) -> Path:
    """Return an unused hidden name next to the target."""
    return target.parent / f".{target.name[:40]}.{os.urandom(6).hex()}"

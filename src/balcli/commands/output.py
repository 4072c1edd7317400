"""Where results go: standard output, or a file that is written beside its place and moved there when it is whole."""
from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ..errors import BalcliError


def emit(text: str, output: Path | None = None) -> None:
    """Print once, or write the whole file or nothing of it; what the reader of a closed pipe does not want need not be written.

    Raises:
        BalcliError: if the file cannot be written; an older one is left as it was.
    """
    if output is None:
        try:
            sys.stdout.write(text if text.endswith("\n") else text + "\n")
            sys.stdout.flush()
        except BrokenPipeError:
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    else:
        write(text if text.endswith("\n") else text + "\n", output)


def keep(file: Path | None, force: bool) -> None:
    """Refuse to overwrite a file that is there, unless forced.

    Raises:
        BalcliError: with what to do.
    """
    if file is not None and file.exists() and not force:
        raise BalcliError(f"{file}: is there already; choose another name, or --force to overwrite it")


def write(content: str | bytes, target: Path) -> None:
    """Replace a file in one step."""
    data = content.encode() if isinstance(content, str) else content
    with beside(target) as place:
        place.write_bytes(data)


@contextmanager
def beside(target: Path) -> Iterator[Path]:
    """A new file beside the target, which replaces it when all has gone well and is gone otherwise.

    Raises:
        BalcliError: if it cannot be written; an older one is left as it was.
    """
    if target.is_dir():
        raise BalcliError(f"{target}: is a folder, so no file can be written there")
    place = None
    try:
        handle, name = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name[:40]}.")
        os.close(handle)
        place = Path(name)
        yield place
        place.chmod(_mode(target))
        place.replace(target)
    except OSError as error:
        raise BalcliError(f"{target}: cannot be written ({error.strerror or error})") from None
    finally:
        if place is not None:
            place.unlink(missing_ok=True)


def _mode(target: Path) -> int:
    """Permissions of the file that is replaced, or those of a new one."""
    if target.exists():
        return target.stat().st_mode & 0o777
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask

"""Where results go: standard output, or a file that is written beside its place and moved there
when it is whole.
"""

from __future__ import annotations

import errno
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TextIO

from ..errors import BalcliError


def emit(text: str, output: Path | None = None) -> None:
    """Print once, or write the whole file or nothing of it; what the reader of a closed pipe does
    not want need not be written.

    Raises:
        BalcliError: if the file cannot be written; an older one is left as it was.
    """
    if output is None:
        with standard_output() as stream:
            stream.write(text if text.endswith("\n") else text + "\n")
    else:
        write(text if text.endswith("\n") else text + "\n", output)


@contextmanager
def standard_output() -> Iterator[TextIO]:
    """Where results are printed. Whoever closes the pipe early has what they want.

    Raises:
        BalcliError: if it cannot be written.
    """
    try:
        yield sys.stdout
        sys.stdout.flush()
    except BrokenPipeError:
        _let_go()
    except OSError as error:
        _let_go()
        raise BalcliError(
            f"standard output: cannot be written ({error.strerror or error})"
        ) from None


def _let_go() -> None:
    """What is still to be written goes nowhere, so that nothing fails again when the program
    ends.
    """
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def keep(file: Path | None, force: bool) -> None:
    """Refuse to overwrite a file that is there, unless forced.

    Raises:
        BalcliError: with what to do.
    """
    if file is not None and os.path.lexists(file) and not force:
        raise BalcliError(
            f"{file}: is there already; choose another name, or --force to overwrite it"
        )


def made(file: Path) -> Path:
    """The file, in a folder that is there now.

    Raises:
        BalcliError: if the folder cannot be made.
    """
    try:
        file.parent.mkdir(exist_ok=True)
    except OSError as error:
        raise BalcliError(f"{file.parent}: cannot be made ({error.strerror or error})") from None
    return file


def write(content: str | bytes, target: Path) -> None:
    """Replace a file in one step."""
    data = content.encode() if isinstance(content, str) else content
    with beside(target) as place:
        place.write_bytes(data)


@contextmanager
def beside(target: Path) -> Iterator[Path]:
    """A new file beside the target, which replaces it when all has gone well and is gone otherwise.

    Through a symbolic link, what it points to is replaced. What is no ordinary file (/dev/null, a
    pipe) is itself written to.

    Raises:
        BalcliError: if it cannot be written; an older one is left as it was.
    """
    import tempfile

    real, place = Path(os.path.realpath(target)), None
    try:
        if real.is_dir():
            raise BalcliError(f"{target}: is a folder, so no file can be written there")
        if real.is_symlink():
            raise OSError(errno.ELOOP, "a symbolic link that leads to itself")
        if real.exists() and not real.is_file():
            yield real
            return
        handle, name = tempfile.mkstemp(dir=real.parent, prefix=f".{real.name[:40]}.")
        os.close(handle)
        place = Path(name)
        yield place
        place.chmod(_mode(real))
        place.replace(real)
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

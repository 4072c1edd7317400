"""Where results go: standard output, or a file that is written beside its place and moved there
when it is whole.
"""

from __future__ import annotations

import errno
import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TextIO, TypeVar

from ..errors import BalcliError, note, warn
from ..process import has_no_reader, unfinished
from ..render.formats import Format, Renderer, Units, render
from ..render.units import SYSTEMS

R = TypeVar("R")


def show(
    results: Sequence[R],
    renderer: Renderer[R],
    form: Format,
    output: Path | None,
    units: Units = Units.SI,
) -> None:
    """Print results in this format, or write them into a file.

    Raises:
        BalcliError: if the file cannot be written.
    """
    emit(render(results, renderer, form, SYSTEMS[units], seen=is_seen(output)), output)


def is_seen(output: Path | None) -> bool:
    """Whether a person sees what is printed, in a terminal."""
    return output is None and sys.stdout.isatty()


def draws_sketch(wanted: bool, form: Format) -> bool:
    """Whether pictures made of characters go with a result: where `--plot` asks for them and it is
    a table. Elsewhere a warning says that there are none.
    """
    if wanted and form is not Format.TABLE:
        warn(f"--plot draws with characters into a table; there are no pictures in {form}")
    return wanted and form is Format.TABLE


def emit(text: str, output: Path | None = None) -> None:
    """Print a text that ends in a newline, or write the whole file or nothing of it.

    Raises:
        BalcliError: if the file cannot be written; an older one is left as it was.
    """
    text = text if text.endswith("\n") else text + "\n"
    if output is not None:
        write_file(text, output)
        return
    with standard_output() as stream:
        stream.write(text)


@contextmanager
def standard_output() -> Iterator[TextIO]:
    """Where results are printed. Whoever closes the pipe early has what they want.

    Raises:
        BalcliError: if it cannot be written.
    """
    try:
        yield sys.stdout
        sys.stdout.flush()
    except OSError as error:
        _discard_what_is_left()
        if not has_no_reader(error):
            raise BalcliError(
                f"standard output: cannot be written ({error.strerror or error})"
            ) from None


def _discard_what_is_left() -> None:
    """Let what is still to be written go nowhere, so that nothing fails again when the program
    ends.
    """
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def refuse_existing(path: Path | None, force: bool) -> None:
    """Refuse to overwrite a file that is there, unless forced.

    Raises:
        BalcliError: with what to do.
    """
    if path is not None and os.path.lexists(path) and not force:
        raise BalcliError(
            f"{path}: already exists; choose another name, or --force to overwrite it"
        )


def make_folder_of(path: Path) -> Path:
    """Make the folder of a file, unless it is there; returns the file's path.

    Raises:
        BalcliError: if the folder cannot be made.
    """
    try:
        path.parent.mkdir(exist_ok=True)
    except OSError as error:
        raise BalcliError(f"{path.parent}: cannot be made ({error.strerror or error})") from None
    return path


def write_file(content: str | bytes, target: Path) -> None:
    """Replace a file in one step.

    Raises:
        BalcliError: if it cannot be written; an older one is left as it was.
    """
    data = content.encode() if isinstance(content, str) else content
    with replacing(target) as place:
        place.write_bytes(data)


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
        with _beside(real) as place:
            yield place
            if not place.exists():  # it is only a part, and has been moved elsewhere
                return
            if real.exists():
                place.chmod(real.stat().st_mode & 0o777)
            size = place.stat().st_size
            place.replace(real)
            note(f"{target}: written, {size} bytes")
    except OSError as error:
        raise BalcliError(f"{target}: cannot be written ({error.strerror or error})") from None


@contextmanager
def _beside(target: Path) -> Iterator[Path]:
    """A new, empty file in the target's folder, as secret as the target is; it is gone afterwards
    unless it has been moved, also where a signal ends the process.
    """
    place = target.parent / f".{target.name[:40]}.{os.urandom(6).hex()}"
    mode = 0o600 if target.exists() else 0o666
    unfinished.add(str(place))
    try:
        os.close(os.open(place, os.O_CREAT | os.O_EXCL | os.O_WRONLY, mode))
        yield place
    finally:
        place.unlink(missing_ok=True)
        unfinished.discard(str(place))

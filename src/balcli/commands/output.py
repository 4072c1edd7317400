"""Where results go: standard output, or a file."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, TextIO, TypeVar

from ..errors import BalcliError, warn
from ..process import has_no_reader
from ..render.formats import Format, Renderer, Units, render
from ..render.units import SYSTEMS

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..render.plot.style import Form

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
    """Let what is left go nowhere, so that nothing fails again when the program ends."""
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
    from ..files import replacing  # most results are printed

    data = content.encode() if isinstance(content, str) else content
    with replacing(target) as place:
        place.write_bytes(data)


def write_figure(figure: Figure, form: Form, target: Path) -> None:
    """Replace the file of a picture in one step; errors as of `write_file`."""
    from ..render.plot.style import save_figure  # few draw

    write_file(save_figure(figure, form), target)

"""Write results to standard output or into files; protect files that a command reads."""

from __future__ import annotations

import os
import sys
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, TextIO, TypeVar

from ..core.records import Node
from ..errors import BalcliError, tell_unwritable
from ..file.toml import parse_toml, read_bytes
from ..files import replacing
from ..process import has_no_reader
from ..show.formats import Format, Renderer, Units, render
from ..show.units import SYSTEMS

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..show.plot_style import Form


R = TypeVar("R")
_OF_RESULTS = ("OUT", "--output")  # options for which - means standard output


def show(
    results: Sequence[R],
    renderer: Renderer[R],
    form: Format,
    output: Path | None,
    units: Units = Units.SI,
) -> None:
    """Print results in a format or write them into a file.

    Args:
        results: Results of one kind.
        renderer: Renderer of this kind.
        form: Format of the output.
        output: File to write; None: standard output.
        units: System of units.

    Raises:
        BalcliError: The file cannot be written.
    """
    emit(render(results, renderer, form, SYSTEMS[units], seen=is_seen(output)), output)


def is_seen(output: Path | None) -> bool:
    """Return whether the output is printed to a terminal."""
    return output is None and sys.stdout.isatty()


def emit(text: str, output: Path | None = None) -> None:
    """Print a text or write it into a file, with a final newline.

    Args:
        text: Text.
        output: File to write; None: standard output.

    Raises:
        BalcliError: The file cannot be written; an existing file is unchanged.
    """
    text = text if text.endswith("\n") else text + "\n"
    if output is not None:
        write_file(text, output)
        return
    with standard_output() as stream:
        stream.write(text)


@contextmanager
def standard_output() -> Iterator[TextIO]:
    """Yield standard output. A closed pipe is not an error.

    Raises:
        BalcliError: Standard output cannot be written.
    """
    try:
        yield sys.stdout
        sys.stdout.flush()
    except OSError as error:
        # Discard the rest of the buffer; otherwise the exit of Python would fail again.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        if not has_no_reader(error):
            reason = error.strerror or error
            raise BalcliError(f"standard output: cannot be written ({reason})") from None


def write_file(content: str | bytes, target: Path) -> None:
    """Write a file in one step.

    Args:
        content: Whole content of the file.
        target: File to write.

    Raises:
        BalcliError: The file cannot be written; an existing file is unchanged.
    """
    data = content.encode() if isinstance(content, str) else content
    with replacing(target) as place:
        place.write_bytes(data)


def write_figure(figure: Figure, form: Form, target: Path) -> None:
    """Write the file of a picture in one step; raise the errors of `write_file`.

    Args:
        figure: Picture.
        form: Format of the file.
        target: File to write.
    """
    from ..show.plot_style import save_figure  # rarely needed

    write_file(save_figure(figure, form), target)


def make_folder_of(path: Path) -> Path:
    """Create the folder of a file unless it exists; return the file's path.

    Raises:
        BalcliError: The folder cannot be created.
    """
    try:
        path.parent.mkdir(exist_ok=True)
    except OSError as error:
        raise BalcliError(f"{path.parent}: cannot be created ({error.strerror or error})") from None
    return path


# ------------------------------------------------------------------ refusals
def refuse_existing(path: Path | None, force: bool) -> None:
    """Check that a file may be written.

    Args:
        path: File to write; None: standard output.
        force: Whether an existing file may be overwritten.

    Raises:
        BalcliError: The file exists and `force` is false.
    """
    if path is not None and os.path.lexists(path) and not force:
        raise BalcliError(f"{path}: already exists; choose another name, or --force")


def refuse_overwriting(*, reads: Sequence[str], writes: Mapping[str, Path | None]) -> None:
    """Check the targets of a command before it computes anything.

    Args:
        reads: Paths of the files that are read; `-` is standard input.
        writes: Target by option (`--output`); None: the option is not given.

    Raises:
        BalcliError: A target is also a file that is read, a file that an engine file names, or the
            target of another option; the folder of a target does not exist; standard input is read
            twice; or `-` is given for an option that does not allow it.
    """
    if list(reads).count("-") > 1:
        raise BalcliError("standard input (-) is named twice, and can be read only once")
    targets = {option: place for option, place in writes.items() if place is not None}
    sources = [Path(path) for path in reads if path != "-"]
    if any(map(os.path.isfile, targets.values())):
        sources += [file for source in sources for file in _list_named_files(source)]
    done: list[Path] = []
    for option, target in targets.items():
        if str(target) == "-" and option not in _OF_RESULTS:
            raise BalcliError(f"{option} -: name a file; standard output is only for results")
        for others, reason in (
            (sources, "this file is read and must not change"),
            (done, "another result is written there as well"),
        ):
            if any(_is_same_file(target, other) for other in others):
                raise BalcliError(f"{option} {target}: {reason}; choose another name")
        done.append(target)
        try:
            os.stat(os.path.join(target.parent, ""))
        except OSError as error:
            raise tell_unwritable(target, error) from None


def _is_same_file(first: Path, other: Path) -> bool:
    """Return whether two paths mean the same file, which need not exist yet; false for devices."""
    if not os.path.exists(first):
        return os.path.realpath(first) == os.path.realpath(other)
    return os.path.isfile(first) and os.path.exists(other) and os.path.samefile(first, other)


def refuse_leaving_files(text: bytes, source: str, target: Path) -> None:
    """Check that the files that an engine file names are also in the folder of its new copy.

    Args:
        text: Text of a valid engine or chain file.
        source: Path of this file; `-`: standard input, which names files in the working folder.
        target: Path of the new file.

    Raises:
        BalcliError: The target's folder lacks a named file, or has another file of this name.
    """
    folder = Path(source).parent
    if folder.resolve() == target.parent.resolve():
        return
    for name in _list_names(tomllib.loads(text.decode("utf-8-sig"))):
        with suppress(OSError):
            if (folder / name).read_bytes() == (target.parent / name).read_bytes():
                continue
        raise BalcliError(f'{target}: first copy "{name}", which the file names, from {folder}')


def _list_named_files(source: Path) -> list[Path]:
    """Return the files that an engine file names; empty if it cannot be read (reported later)."""
    try:
        data = parse_toml(read_bytes(source), str(source)) if os.path.isfile(source) else {}
        return [source.parent / name for name in _list_names(data)]
    except (BalcliError, AttributeError, TypeError):
        return []


def _list_names(data: Node) -> Iterator[str]:
    """Yield the file names in an engine file's tables."""
    yield from (one["file"] for one in data.get("engine", ()) if "file" in one)
    for table in (data.get("gas", {}), *data.get("cylinder", {}).values()):
        yield from (table[key] for key in ("indicator", "harmonics") if key in table)
    yield from (web["profile"] for web in data.get("web", ()) if "profile" in web)

"""Names of output files and their formats: `-` is standard output; endings determine formats."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, TypeVar

import typer

from ..errors import BalcliError, is_quiet, say
from ..file.examples import ExamplePath, find_by_name
from ..show.formats import Format
from .values import argument, optional

if TYPE_CHECKING:
    from ..show.plot_style import Form


F = TypeVar("F", bound=str)
T = TypeVar("T")

_SHORT = {"md": "markdown", "txt": "table", "text": "table"}
TEXTS = {
    ".txt": Format.TABLE,
    ".json": Format.JSON,
    ".csv": Format.CSV,
    ".md": Format.MARKDOWN,
}
SERIES = {".csv": Format.CSV, ".json": Format.JSON}  # long series of numbers
VARIANTS = {**TEXTS, ".parquet": Format.PARQUET}
PICTURES: dict[str, Form] = {".svg": "svg", ".png": "png", ".pdf": "pdf"}
# Endings of known formats, which --format cannot override.
_KNOWN = {*TEXTS, *PICTURES, ".html", ".htm", ".toml", ".parquet", ".xlsx", ".jpg", ".jpeg"}


class Place(NamedTuple):
    """Target of a sweep: a file, or a folder of files."""

    path: Path
    is_folder: bool


def read_place(text: str) -> Place | None:
    """Parse the target of a sweep: a folder ends with a slash; None is standard output."""
    path = parse_output(Path(text))
    return None if path is None else Place(path, text.endswith(("/", os.sep)))


def parse_output(path: Path | None) -> Path | None:
    """Return the file to write, or None for standard output."""
    return None if str(path) in ("-", "/dev/stdout", "/dev/fd/1") else path


def choose_target(second: Path | None, output: Path | None, source: str, ending: str) -> Path:
    """Return the file to which a page or picture is written: by default, one in the current folder
    with the name of the engine file.

    Args:
        second: Second argument of the command, which may name this file; None: not given.
        output: Value of `--output`; None: not given.
        source: Engine file; `-`: standard input.
        ending: Ending of the default name, such as `.html`.

    Raises:
        BalcliError: Both are given, or neither for an engine file without a name.
    """
    if second is not None and output is not None:
        raise BalcliError(f"{second} and --output {output}: one file is written; leave one out")
    target = second or output
    if target is not None:
        return target
    if source == "-" or not Path(source).stem:
        raise BalcliError(f"name the file to write, such as -o X{ending}")
    return Path(f"{Path(source).stem}{ending}")


def engine_argument(metavar: str, text: str) -> object:
    """Declare an argument that names an engine file, or several. The name of an example stands for
    its file; standard error says so.

    Args:
        metavar: Placeholder in help.
        text: Help of the argument.
    """
    return argument(metavar, text, callback=_find_engine)


def _find_engine(context: typer.Context, given: T) -> T | str | list[str]:
    """Return the file that each given text names."""
    if context.resilient_parsing:  # completion
        return given
    if isinstance(given, str):
        return _find_file(given)
    if isinstance(given, list):
        return [_find_file(text) for text in given]
    return given


def _find_file(typed: str) -> str:
    path = find_by_name(typed)
    if isinstance(path, ExamplePath) and not is_quiet():
        file = Path(f"{typed}.toml")
        say(f"{typed}: the example engine" + (f", not {file}" if file.exists() else ""))
    return path


def format_option(formats: Iterable[Format], text: str) -> object:
    """Declare an option `--format`, `-f`. Formats may be typed by name or ending, in upper or lower
    case.

    Args:
        formats: Formats that can be chosen.
        text: Help of the option.
    """

    named = {str(form): form for form in formats}

    def parse(name: str) -> Format:
        small = name.lower()
        form = named.get(_SHORT.get(small, small))
        if form is None:
            choices = ", ".join(f"'{choice}'" for choice in named)
            raise typer.BadParameter(f"'{name}' is not one of {choices}.")
        return form

    return optional("|".join(named), text, "--format", "-f", parser=parse)


def text_format(output: Path | None, asked: Format | None) -> Format:
    """Return the format of a result, by default a table; raise the errors of `format_of`.

    Args:
        output: File to write; None: standard output.
        asked: Value of `--format`; None: not given.
    """
    return format_of(output, asked, TEXTS, Format.TABLE)


def format_of(
    output: Path | None,
    asked: F | None,
    endings: Mapping[str, F],
    default: F | None = None,
    option: str = "--output",
) -> F:
    """Return the format of an output: by the ending of the file, or by `--format`.

    Args:
        output: File; None: standard output.
        asked: Value of `--format`; None: not given.
        endings: Formats that can be written, by ending (`.csv`).
        default: Format of standard output and of files without an ending if `asked` is None.
        option: Option that names the file, for messages.

    Raises:
        BalcliError: Format and ending contradict each other, or the ending is unknown.
    """
    ending = "" if output is None else output.suffix.lower()
    written = endings.get(ending)
    if written is not None:
        if asked not in (None, written):
            message = f"{option} {output}: {ending} is {written}, but --format is {asked}"
            raise BalcliError(f"{message}; leave one of them out")
        return written
    usual = asked or default
    if usual is not None and (not ending or (asked is not None and ending not in _KNOWN)):
        return usual
    reason = f"{ending} cannot be written here" if ending else "has no ending for its format"
    *others, last = endings
    known = f"{', '.join(others)} or {last}" if others else last
    raise BalcliError(f"{option} {output}: {reason}; give a name that ends in {known}")


def picture_form(output: Path, option: str = "--output") -> Form:
    """Return the format of a picture: svg, png or pdf; raise the errors of `format_of`.

    Args:
        output: File to write.
        option: Option that names the file.
    """
    return format_of(output, None, PICTURES, option=option)


def require_ending(output: Path | None, ending: str, option: str = "--output") -> None:
    """Check the ending of a file name.

    Args:
        output: File to write; None: no file.
        ending: Required ending, such as .html.
        option: Option that names the file.

    Raises:
        BalcliError: The file has another ending.
    """
    format_of(output, None, {ending: ending}, ending, option)

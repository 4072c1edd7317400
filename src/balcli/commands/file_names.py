"""What the name of a file says: `-` is standard output, and its ending is the format of what is
written into it. Nowhere else is an ending read.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, TypeVar

from ..errors import BalcliError
from ..render.formats import Format
from . import defaults
from .format_names import LATEX

if TYPE_CHECKING:
    from ..render.plot.style import Form

F = TypeVar("F", bound=str)

TEXTS = {
    ".txt": Format.TABLE,
    ".json": Format.JSON,
    ".csv": Format.CSV,
    ".md": Format.MARKDOWN,
}
PICTURES: dict[str, Form] = {".svg": "svg", ".png": "png", ".pdf": "pdf"}
# Who writes what a table cannot be.
INSTEAD = {
    ".tex": LATEX,
    **dict.fromkeys(
        PICTURES,
        "pictures are drawn by balcli plot FILE X.png, and by --plot of sweep, mounts, torsion and "
        "field",
    ),
    **dict.fromkeys((".html", ".htm"), "pages are written by balcli report FILE X.html"),
}
# What nobody takes for anything else, so that no --format can make it so.
KNOWN = {*TEXTS, *PICTURES, ".html", ".htm", ".toml", ".parquet", ".xlsx", ".jpg", ".jpeg"}


class SeriesFormat(StrEnum):
    """How long series of numbers are written."""

    CSV = "csv"
    JSON = "json"


class VariantsFormat(StrEnum):
    """How the variants of a sweep are written."""

    TABLE = "table"
    MARKDOWN = "markdown"
    CSV = "csv"
    JSON = "json"
    PARQUET = "parquet"


SERIES = {".csv": SeriesFormat.CSV, ".json": SeriesFormat.JSON}
VARIANTS = {
    ".csv": VariantsFormat.CSV,
    ".json": VariantsFormat.JSON,
    ".parquet": VariantsFormat.PARQUET,
    ".txt": VariantsFormat.TABLE,
    ".md": VariantsFormat.MARKDOWN,
}


class Place(NamedTuple):
    """Where results of a sweep go: one file, or a folder of several."""

    path: Path
    is_folder: bool


def read_place(text: str) -> Place | None:
    """A folder ends with a slash; None is standard output."""
    path = parse_output(Path(text))
    return None if path is None else Place(path, text.endswith(("/", os.sep)))


def parse_output(path: Path | None) -> Path | None:
    """Where to write, None for standard output."""
    return None if str(path) in ("-", "/dev/stdout", "/dev/fd/1") else path


def choose_target(second: Path | None, output: Path | None, example: str) -> Path:
    """Where a page or picture goes: the second name, or that of `--output`.

    Raises:
        BalcliError: there is neither, with an example, or both.
    """
    if second is not None and output is not None:
        raise BalcliError(f"{second} and --output {output}: one file is written; leave one out")
    if (target := second or output) is None:
        raise BalcliError(f"name the file to write, such as -o {example}")
    return target


def text_format(output: Path | None, asked: Format | None) -> Format:
    """How to write what people read; a table by default, or what a user has set as default. Errors
    as `format_of`.
    """
    return format_of(output, asked, TEXTS, defaults.usual.format or Format.TABLE)


def format_of(
    output: Path | None,
    asked: F | None,
    endings: Mapping[str, F],
    default: F | None = None,
    option: str = "--output",
) -> F:
    """The format in which to write into a file: the ending says it, and `--format` where there is
    no ending that is known.

    Args:
        output: the file; None: standard output.
        asked: the format of `--format`, if it was given.
        endings: small letters, with the point, and the format of each that can be written.
        default: of standard output, and of a file without an ending; None: there is none.
        option: by which the file was given, for messages.

    Raises:
        BalcliError: format and ending contradict each other, or the ending is none of these.
    """
    ending = "" if output is None else output.suffix.lower()
    written = endings.get(ending)
    if written is not None:
        if asked not in (None, written):
            raise BalcliError(
                f"{option} {output}: {ending} is {written}, but --format says {asked}; leave one "
                "of them out"
            )
        return written
    usual = asked or default
    if usual is not None and (not ending or (asked is not None and ending not in KNOWN)):
        return usual
    can = _listed(list(endings))
    said = f"{ending} cannot be written here" if ending else "has no ending that says its format"
    told = ending in INSTEAD and (".md" if ending == ".tex" else ".csv") in endings
    instead = f"; {INSTEAD[ending]}" if told else ""
    raise BalcliError(f"{option} {output}: {said}; give a name that ends in {can}{instead}")


def picture_form(output: Path, option: str = "--output") -> Form:
    """svg, png or pdf.

    Raises:
        BalcliError: another ending.
    """
    return format_of(output, None, PICTURES, option=option)


def require_ending(output: Path | None, ending: str, option: str = "--output") -> None:
    """Refuse a file whose ending promises anything but this one format.

    Raises:
        BalcliError: with what it must be.
    """
    format_of(output, None, {ending: ending}, ending, option)


def _listed(words: Sequence[str]) -> str:
    return " or ".join(filter(None, (", ".join(words[:-1]), words[-1])))

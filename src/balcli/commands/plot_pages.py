"""Pages of `balcli plot`: which there are, and the files that they go into."""

from __future__ import annotations

from collections.abc import Sequence
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING

from ..enginefile.fields import nearest
from ..errors import BalcliError
from ..render.plot.style import save_figure, save_pages
from .output import refuse_overwriting, write_file

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ..render.plot.style import Form


class What(StrEnum):
    """Which pictures are drawn on a page."""

    ALL = "all"
    POLAR = "polar"
    ORDERS = "orders"
    SPECTRUM = "spectrum"
    CURVES = "curves"
    FACTOR = "factor"
    BANK = "bank"
    INNER = "inner"
    PRESSURE = "pressure"
    P_V = "p-v"
    TORQUE = "torque"
    PIN = "pin"
    MAIN = "main"
    MODES = "modes"
    CAMPBELL = "campbell"
    RESPONSE = "response"
    WATERFALL = "waterfall"


OF_TORSION = (What.MODES, What.CAMPBELL, What.RESPONSE, What.WATERFALL)
OF_GAS = (What.PRESSURE, What.P_V, What.TORQUE, What.PIN, What.MAIN)
_SHOWN = {What.INNER: "inner", What.BANK: "force"}  # what of the engine these pages show alone


def complete_pages(typed: str) -> list[str]:
    """Names after the last comma of what has been typed."""
    before, comma, _ = typed.rpartition(",")
    return [f"{before}{comma}{page}" for page in What]


def parse_pages(text: str) -> tuple[What, ...]:
    """The pages of `--what`, each once.

    Raises:
        BalcliError: there is no such page, with those that there are.
    """
    words = dict.fromkeys(word.strip().lower() for word in text.split(",") if word.strip())
    known = [str(page) for page in What]
    for word in words or {"": None}:
        if word not in known:
            near = nearest(word, known)
            hint = f"; did you mean {near}?" if near else ""
            raise BalcliError(f'--what "{word[:60]}": choose from {", ".join(known)}{hint}')
    return tuple(map(What, words))


def choose_shown(pages: Sequence[What]) -> tuple[str, ...] | None:
    """What of an engine these pages show; None: whatever it has."""
    if not all(page in _SHOWN for page in pages):
        return None
    return tuple(_SHOWN[page] for page in pages)


def name_files(path: str, pages: Sequence[What], output: Path, form: Form) -> list[Path]:
    """Where pages go: one, or those of a PDF, into the file itself, else each into a file that has
    its name besides (`v8-pin.svg`).

    Raises:
        BalcliError: one is the engine file; standard input would have to be read twice.
    """
    one = len(pages) == 1 or form == "pdf"
    files = [output] if one else [output.with_stem(f"{output.stem}-{p}") for p in pages]
    chapters = {page in OF_TORSION for page in pages}
    writes = dict(zip(map("--what {}".format, pages), files, strict=False))
    refuse_overwriting(reads=[path] * len(chapters), writes=writes)
    return files


def write_pages(figures: Sequence[Figure], files: Sequence[Path], form: Form) -> None:
    """All pages into one file, or each into its own.

    Raises:
        BalcliError: one cannot be written.
    """
    if len(files) < len(figures):
        write_file(save_pages(figures), files[0])
        return
    contents = [save_figure(figure, form) for figure in figures]
    for content, file in zip(contents, files, strict=True):
        write_file(content, file)

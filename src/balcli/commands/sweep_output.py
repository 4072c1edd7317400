"""Writing the variants of a sweep as they are computed: to a stream, a text file or a Parquet
file.
"""

from __future__ import annotations

import signal
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..errors import BalcliError
from ..render.sweep import csv_text, json_text

if TYPE_CHECKING:
    from ..studies.sweep import Chunk, Sweep

ROWS_A_GROUP = 1 << 20  # of a Parquet file


def write(sweep: Sweep, chunks: Iterable[Chunk], form: str, output: Path | None) -> None:
    """All chunks, in one of the forms csv, json and parquet; a file takes its place when it is
    whole.

    Raises:
        BalcliError: the file cannot be written, or pyarrow is missing.
    """
    from .output import beside, standard_output

    if output is None:
        with standard_output() as stream:
            _copy(sweep, chunks, form, stream)
        return
    with beside(output) as place:
        if form == "parquet":
            _parquet(sweep, chunks, place)
        else:
            with place.open("w", encoding="utf-8") as stream:
                _copy(sweep, chunks, form, stream)


def _copy(sweep: Sweep, chunks: Iterable[Chunk], form: str, stream: Any) -> None:
    first = next(
        iter(chunks := iter(chunks)), None
    )  # a variant that cannot be is told before a heading is written
    for text in (json_text if form == "json" else csv_text)(
        sweep, chunks if first is None else chain([first], chunks)
    ):
        stream.write(text)


def _parquet(sweep: Sweep, chunks: Iterable[Chunk], place: Path) -> None:
    try:
        import pyarrow
        from pyarrow import parquet
    except ImportError:
        raise BalcliError("a .parquet file needs pyarrow: install balcli[scale]") from None
    schema = pyarrow.schema([(name, pyarrow.float64()) for name in sweep.columns])
    with parquet.ParquetWriter(place, schema) as writer:
        for columns in _grouped(sweep, chunks):
            writer.write_table(pyarrow.table(columns, schema=schema))


def _grouped(sweep: Sweep, chunks: Iterable[Chunk]) -> Iterator[list[Any]]:
    """Columns of many chunks together."""
    import numpy as np

    from ..studies.sweep import columns

    waiting: list[list[Any]] = []
    for chunk in chunks:
        waiting.append(columns(sweep, chunk))
        if sum(len(c[0]) for c in waiting) >= ROWS_A_GROUP:
            yield [np.concatenate(parts) for parts in zip(*waiting, strict=True)]
            waiting = []
    if waiting:
        yield [np.concatenate(parts) for parts in zip(*waiting, strict=True)]


class Stopped:
    """Whether the user has pressed Ctrl-C."""

    def __init__(self) -> None:
        self.at = 0  # variants that were complete then
        self.asked = False


@contextmanager
def interruptible() -> Iterator[Stopped]:
    """Ctrl-C is noted here and heeded between two chunks, so that what is written is whole; the
    second one kills.
    """
    stopped = Stopped()

    def note(*_: object) -> None:
        stopped.asked = True
        signal.signal(signal.SIGINT, before)

    before = signal.signal(signal.SIGINT, note)
    try:
        yield stopped
    finally:
        signal.signal(signal.SIGINT, before)


def heeding(chunks: Iterable[Chunk], stopped: Stopped) -> Iterator[Chunk]:
    """The chunks until Ctrl-C."""
    for chunk in chunks:
        yield chunk
        stopped.at += len(chunk.values[0])
        if stopped.asked:
            return


def with_progress(chunks: Iterable[Chunk], total: int, wanted: bool) -> Iterator[Chunk]:
    """A bar on standard error while they are computed, if that is a terminal."""
    if not (wanted and sys.stderr.isatty()):
        yield from chunks
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TimeRemainingColumn

    with Progress(
        BarColumn(), MofNCompleteColumn(), TimeRemainingColumn(), console=Console(stderr=True)
    ) as bar:
        task = bar.add_task("", total=total)
        for chunk in chunks:
            yield chunk
            bar.advance(task, len(chunk.values[0]))

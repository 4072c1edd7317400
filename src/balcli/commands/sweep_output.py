"""Writing the variants of a sweep as they are computed: to a stream, a text file or a Parquet
file.
"""

from __future__ import annotations

import signal
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import chain, islice
from pathlib import Path
from typing import TextIO

import numpy as np
import typer

from .. import __version__
from ..core.phasors import Array
from ..errors import BalcliError, Exit, say
from ..render.sweep import csv_text, json_text
from ..studies.sweep import Chunk, Sweep, list_columns
from .output import replacing, standard_output

ROWS_A_GROUP = 1 << 20  # of a Parquet file


@dataclass
class Interrupt:
    """Whether Ctrl-C has been pressed, how many variants were done by then, and the file that holds
    them.
    """

    noted: bool = False
    done: int = 0
    part: Path | None = None


def write_sweep(
    sweep: Sweep, chunks: Iterable[Chunk], kind: str, output: Path | None, interrupt: Interrupt
) -> None:
    """Write all chunks as csv, json or parquet. A file takes its place when it is whole; what there
    is of an interrupted one, a whole document of fewer rows, goes to `name.part` beside it.

    Raises:
        BalcliError: parquet without a file, the file cannot be written, or pyarrow is missing.
    """
    if output is None and kind == "parquet":
        raise BalcliError("parquet is written into a file: name one with -o")
    if output is None:
        with standard_output() as stream:
            _write_text(sweep, chunks, kind, stream)
        return
    with replacing(output) as place:
        if kind == "parquet":
            _write_parquet(sweep, chunks, place)
        else:
            with place.open("w", encoding="utf-8") as stream:
                _write_text(sweep, chunks, kind, stream)
        if interrupt.noted and place != output:  # a device has what it has
            interrupt.part = place.replace(output.with_name(f"{output.name}.part"))


def _write_text(sweep: Sweep, chunks: Iterable[Chunk], kind: str, stream: TextIO) -> None:
    write = json_text if kind == "json" else csv_text
    stream.writelines(write(sweep, _first_at_once(chunks)))


def _first_at_once(chunks: Iterable[Chunk]) -> Iterator[Chunk]:
    """The same chunks; the first is computed at once, so that a variant that cannot be is told
    before a heading is written.
    """
    waiting = iter(chunks)
    return chain(list(islice(waiting, 1)), waiting)


def _write_parquet(sweep: Sweep, chunks: Iterable[Chunk], place: Path) -> None:
    try:
        import pyarrow
        from pyarrow import parquet
    except ImportError:
        raise BalcliError("a .parquet file needs pyarrow: install balcli[scale]") from None
    units = {quantity.name: {"unit": quantity.unit} for quantity in sweep.quantities}
    schema = pyarrow.schema(
        [
            pyarrow.field(name, pyarrow.float64(), metadata=units.get(name))
            for name in sweep.columns
        ],
        metadata={
            "balcli.format": "balcli.sweep/1",
            "balcli.version": __version__,
            "balcli.engine": sweep.file.name,
        },
    )
    with parquet.ParquetWriter(place, schema) as writer:
        for columns in _row_groups(sweep, chunks):
            nulls = [pyarrow.array(column, from_pandas=True) for column in columns]  # for nan
            writer.write_table(pyarrow.table(nulls, schema=schema))


def _row_groups(sweep: Sweep, chunks: Iterable[Chunk]) -> Iterator[list[Array]]:
    """Columns of many chunks together: ROWS_A_GROUP rows or a few more, fewer in the last."""
    waiting: list[list[Array]] = []
    for chunk in chunks:
        waiting.append(list_columns(sweep, chunk))
        if sum(len(c[0]) for c in waiting) >= ROWS_A_GROUP:
            yield [np.concatenate(parts) for parts in zip(*waiting, strict=True)]
            waiting = []
    if waiting:
        yield [np.concatenate(parts) for parts in zip(*waiting, strict=True)]


@contextmanager
def noting_interrupt() -> Iterator[Interrupt]:
    """Ctrl-C is only noted here, for a loop to end between two chunks, so that what is written is
    whole; the second one kills.
    """
    interrupt = Interrupt()

    def note(*_: object) -> None:
        interrupt.noted = True
        signal.signal(signal.SIGINT, before)

    before = signal.signal(signal.SIGINT, note)
    try:
        yield interrupt
    finally:
        signal.signal(signal.SIGINT, before)


def until_interrupted(chunks: Iterable[Chunk], interrupt: Interrupt) -> Iterator[Chunk]:
    """The chunks, counted, until Ctrl-C is noted."""
    for chunk in chunks:
        yield chunk
        interrupt.done += len(chunk.values[0])
        if interrupt.noted:
            return


def exit_if_interrupted(interrupt: Interrupt, variants: int) -> None:
    """End with the status of an interruption, and say how far it has come, if there was one."""
    if interrupt.noted:
        place = f"; they are in {interrupt.part}" if interrupt.part is not None else ""
        say(f"balcli: stopped after {interrupt.done} of {variants} variants{place}")
        raise typer.Exit(Exit.INTERRUPTED)


def keeping(chunks: Iterable[Chunk], kept: list[Chunk]) -> Iterator[Chunk]:
    """The chunks, each of which is kept, too."""
    for chunk in chunks:
        kept.append(chunk)
        yield chunk


def showing_progress(chunks: Iterable[Chunk], total: int, wanted: bool) -> Iterator[Chunk]:
    """The chunks, with a bar on standard error while they are computed, if that is a terminal."""
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

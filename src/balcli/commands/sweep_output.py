"""Writing the variants of a sweep as they are computed: to a stream, a text file or a Parquet
file.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import chain, islice
from pathlib import Path
from typing import TextIO

from ..errors import BalcliError
from ..render.sweep import csv_text, json_text
from ..render.sweep_parquet import write_parquet
from ..studies.sweep import Chunk, Sweep, list_columns
from .output import replacing, standard_output
from .progress import Progress


def write_sweep(
    sweep: Sweep, chunks: Iterable[Chunk], kind: str, output: Path | None, progress: Progress
) -> str:
    """Write all chunks as csv, json or parquet. A file takes its place when it is whole; what there
    is of one that Ctrl-C has cut short, a whole document of fewer rows, goes to `name.part` beside
    it. Returns where that is, in words.

    Raises:
        BalcliError: parquet without a file, the file cannot be written, or pyarrow is missing.
    """
    if output is None and kind == "parquet":
        raise BalcliError("parquet is written into a file: name one with -o")
    if output is None:
        with standard_output() as stream:
            _write_text(sweep, chunks, kind, stream)
        return ""
    with replacing(output) as place:
        if kind == "parquet":
            write_parquet(sweep, (list_columns(sweep, chunk) for chunk in chunks), place)
        else:
            with place.open("w", encoding="utf-8") as stream:
                _write_text(sweep, chunks, kind, stream)
        if not progress.cut_short or place == output:  # a device has what it has
            return ""
        part = place.replace(output.with_name(f"{output.name}.part"))
    return f"they are in {part}"


def _write_text(sweep: Sweep, chunks: Iterable[Chunk], kind: str, stream: TextIO) -> None:
    write = json_text if kind == "json" else csv_text
    stream.writelines(write(sweep, _first_at_once(chunks)))


def _first_at_once(chunks: Iterable[Chunk]) -> Iterator[Chunk]:
    """The same chunks; the first is computed at once, so that a variant that cannot be is told
    before a heading is written.
    """
    waiting = iter(chunks)
    return chain(list(islice(waiting, 1)), waiting)


def until_stopped(
    chunks: Iterable[Chunk], progress: Progress, kept: list[Chunk] | None = None
) -> Iterator[Chunk]:
    """The chunks, each counted when it has been written, until Ctrl-C is noted; and kept, where
    there is a list for them.
    """
    done = 0
    for chunk in chunks:
        if kept is not None:
            kept.append(chunk)
        yield chunk
        done += len(chunk.values[0])
        if progress(done):
            return

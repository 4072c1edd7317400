"""Variants of a sweep, written as they are computed: to a stream, a text or a Parquet file."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator
from itertools import chain, islice
from pathlib import Path

import numpy as np

from ..errors import BalcliError
from ..files import replacing
from ..limits import MOST_ROWS_READ
from ..render.formats import Format, lay_out
from ..render.sweep import sweep_csv, sweep_json
from ..render.sweep_parquet import write_sweep_parquet
from ..render.sweep_table import Ends, make_sheet
from ..studies.sweep import Chunk, Sweep, split_columns
from .file_names import VariantsFormat
from .output import is_seen, standard_output
from .progress import Progress

_FIRST, _LAST = 20, 10  # rows of a table of many


def write_sweep(
    sweep: Sweep, chunks: Iterable[Chunk], kind: VariantsFormat, output: Path | None
) -> None:
    """Write all chunks as csv, json or parquet, or a table of them. A file takes its place when it
    is whole.

    Raises:
        BalcliError: parquet without a file, the file cannot be written, or pyarrow is missing.
    """
    if output is None and kind is VariantsFormat.PARQUET:
        raise BalcliError("parquet is written into a file: name one with -o")
    if output is None:
        with standard_output() as stream:
            stream.writelines(_make_text(sweep, chunks, kind, seen=is_seen(output)))
        return
    with replacing(output) as place:
        if kind is VariantsFormat.PARQUET:
            write_sweep_parquet(sweep, (split_columns(sweep, chunk) for chunk in chunks), place)
        else:
            with place.open("w", encoding="utf-8", newline="\n") as stream:
                stream.writelines(_make_text(sweep, chunks, kind))


def _make_text(
    sweep: Sweep, chunks: Iterable[Chunk], kind: VariantsFormat, *, seen: bool = False
) -> Iterator[str]:
    whole = _first_at_once(chunks)
    match kind:
        case VariantsFormat.JSON:
            return sweep_json(sweep, whole)
        case VariantsFormat.TABLE | VariantsFormat.MARKDOWN:
            sheet = make_sheet(sweep, _take_ends(sweep, whole))
            return iter([lay_out([sheet], Format(kind), seen=seen)])
        case _:
            return sweep_csv(sweep, whole)


def _take_ends(sweep: Sweep, chunks: Iterable[Chunk]) -> Ends:
    """The rows of a table: all if there are few, and no more kept than it shows."""
    first: list[tuple[float, ...]] = []
    last: deque[tuple[float, ...]] = deque(maxlen=_LAST)
    seen = 0
    for chunk in chunks:
        columns = split_columns(sweep, chunk)
        first += zip(*(column[: max(MOST_ROWS_READ - seen, 0)] for column in columns), strict=True)
        last += zip(*(column[-_LAST:] for column in columns), strict=True)
        seen += len(columns[0])
    if seen <= MOST_ROWS_READ:
        return Ends(np.array(first), np.empty((0, len(sweep.columns))), 0)
    return Ends(np.array(first[:_FIRST]), np.array(last), seen - _FIRST - _LAST)


def _first_at_once(chunks: Iterable[Chunk]) -> Iterator[Chunk]:
    """The same chunks; the first is computed at once, so that a variant that cannot be is told
    before a heading is written.
    """
    waiting = iter(chunks)
    return chain(list(islice(waiting, 1)), waiting)


def count_variants(
    chunks: Iterable[Chunk], progress: Progress, kept: list[Chunk] | None = None
) -> Iterator[Chunk]:
    """Yield the chunks and report each when it has been written; keep them in a list, if there is
    one.
    """
    done = 0
    for chunk in chunks:
        if kept is not None:
            kept.append(chunk)
        yield chunk
        done += len(chunk.values[0])
        progress(done)

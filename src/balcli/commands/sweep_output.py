"""Variants of a sweep, written as they are computed: to a stream, a text or a Parquet file."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import chain, islice
from pathlib import Path

import numpy as np

from ..errors import BalcliError
from ..files import replacing
from ..limits import MOST_ROWS_READ
from ..render.formats import Format, lay_out
from ..render.sheet import Sheet
from ..render.sweep import FIRST, make_sheet, sweep_csv, sweep_json
from ..render.sweep_parquet import write_sweep_parquet
from ..studies.sweep import Chunk, Sweep, split_columns
from .file_names import VariantsFormat
from .output import is_seen, standard_output

_LAST = 10  # rows of a table of many


def write_sweep(
    sweep: Sweep, chunks: Iterable[Chunk], kind: VariantsFormat, output: Path | None
) -> None:
    """Write all chunks as csv, json or parquet, or a table of them. A file takes its place when it
    is whole.

    Raises:
        BalcliError: Parquet without a file, the file cannot be written, or pyarrow is missing.
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
    waiting = iter(chunks)
    # A variant that cannot be is reported before a heading is written.
    whole = chain(list(islice(waiting, 1)), waiting)
    if kind in (VariantsFormat.TABLE, VariantsFormat.MARKDOWN):
        return iter([lay_out([_make_table(sweep, whole)], Format(kind), seen=seen)])
    return (sweep_json if kind is VariantsFormat.JSON else sweep_csv)(sweep, whole)


def _make_table(sweep: Sweep, chunks: Iterable[Chunk]) -> Sheet:
    """Return a table of all variants if there are few, else of the first and the last."""
    first = last = np.empty((0, len(sweep.columns)))
    for chunk in chunks:
        rows = np.stack(split_columns(sweep, chunk), axis=1)
        first = np.concatenate([first, rows[: MOST_ROWS_READ - len(first)]])
        last = np.concatenate([last, rows])[-_LAST:]
    if sweep.variants <= MOST_ROWS_READ:
        return make_sheet(sweep, first, 0)
    shown = np.concatenate([first[:FIRST], last])
    return make_sheet(sweep, shown, sweep.variants - len(shown))

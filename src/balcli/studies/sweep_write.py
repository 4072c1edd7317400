"""Write the variants of a sweep as they are computed: as text, as a Parquet file with units, or as
a folder of numbered Parquet files (blocks). The thread or dask worker that computes a block also
writes it. Parquet and dask need the extra `balcli[scale]`.

The folder holds a manifest that identifies the sweep. A block is written under a hidden name and
renamed when it is complete. Repeating the same sweep computes only the missing blocks. Nothing but
blocks and manifests is ever replaced or deleted.
"""

from __future__ import annotations

import hashlib
import json
import logging
import re
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import CancelledError
from contextlib import AbstractContextManager, contextmanager, nullcontext, suppress
from functools import partial
from itertools import chain, islice
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import ArgumentError, BalcliError, tell_unwritable
from ..files import replacing
from ..limits import MOST_ROWS_READ, MOST_THREADS
from ..process import count_cores
from ..shell.output import is_seen, standard_output
from ..shell.progress import Progress
from ..show.formats import Format, lay_out
from ..show.sheet import Sheet
from ..version import __version__
from .sweep import (
    Chunk,
    Item,
    Outcome,
    Share,
    Sweep,
    count_at_once,
    divide_grid,
    evaluate_chunks,
    run_in_order,
    share_among_threads,
    split_columns,
)
from .sweep_show import make_sheet, sweep_csv, sweep_json

# Largest number of rows in a block, and of boxes. A box is a set of variants that is evaluated as
# arrays, in about a tenth of a second.
ROWS_A_BLOCK = 1 << 20
BOXES_A_BLOCK = 8
MANIFEST = "_balcli_sweep.json"  # Parquet readers skip names that begin with _
_BLOCK = re.compile(r"part-\d{6,}\.parquet")
# Names of blocks, of unfinished blocks (hidden, from `files.name_hidden`) and of the manifest.
_OURS = re.compile(rf"{_BLOCK.pattern}|\.{_BLOCK.pattern}\.[0-9a-f]+|{re.escape(MANIFEST)}")
RETRIES = 3  # number of retries of a task that a worker has not finished
AHEAD = 4  # number of pending tasks for each thread


# ------------------------------------------------------------------ one file
def _describe(sweep: Sweep) -> dict[str, Any]:
    """Return the metadata that are written into a file or folder."""
    return {"format": "balcli.sweep/1", "version": __version__, "engine": sweep.file.name}


def write_sweep_parquet(sweep: Sweep, chunks: Iterable[Chunk], place: Path) -> None:
    """Write variants to a Parquet file as they are computed.

    Args:
        sweep: Sweep of the variants.
        chunks: All variants.
        place: Path of the file.

    Raises:
        BalcliError: Pyarrow is missing.
    """
    try:
        import pyarrow
        from pyarrow import parquet
    except ImportError:
        raise BalcliError("a .parquet file needs pyarrow: install balcli[scale]") from None
    real = pyarrow.float64()
    fields = [
        pyarrow.field(name, real, metadata={"unit": unit}) for name, unit in sweep.units.items()
    ]
    about = {f"balcli.{key}": text for key, text in _describe(sweep).items()}
    schema = pyarrow.schema(fields, about)
    with parquet.ParquetWriter(place, schema) as writer:
        for chunk in chunks:
            columns = split_columns(sweep, chunk)
            nulls = [pyarrow.array(column, from_pandas=True) for column in columns]  # nan: null
            writer.write_table(pyarrow.table(nulls, schema=schema))


def write_sweep(sweep: Sweep, chunks: Iterable[Chunk], kind: Format, output: Path | None) -> None:
    """Write all chunks as CSV, JSON, Parquet or a table. A file gets its name when it is complete.

    Raises:
        BalcliError: Parquet needs a file, the file cannot be written, or pyarrow is missing.
    """
    if output is None and kind is Format.PARQUET:
        raise BalcliError("parquet is written into a file: name one with -o")
    if output is None:
        with standard_output() as stream:
            stream.writelines(_make_text(sweep, chunks, kind, seen=is_seen(output)))
        return
    with replacing(output) as place:
        if kind is Format.PARQUET:
            write_sweep_parquet(sweep, chunks, place)
        else:
            with place.open("w", encoding="utf-8", newline="\n") as stream:
                stream.writelines(_make_text(sweep, chunks, kind))


def _make_text(
    sweep: Sweep, chunks: Iterable[Chunk], kind: Format, *, seen: bool = False
) -> Iterator[str]:
    waiting = iter(chunks)
    # An impossible variant is reported before a heading is written.
    whole = chain(list(islice(waiting, 1)), waiting)
    if kind in (Format.TABLE, Format.MARKDOWN):
        return iter([lay_out([_make_table(sweep, whole)], kind, seen=seen)])
    return (sweep_json if kind is Format.JSON else sweep_csv)(sweep, whole)


def _make_table(sweep: Sweep, chunks: Iterable[Chunk]) -> Sheet:
    """Return a table of the first variants."""
    first = np.empty((0, len(sweep.columns)))
    for chunk in chunks:
        rows = np.stack(split_columns(sweep, chunk), axis=1)
        first = np.concatenate([first, rows[: MOST_ROWS_READ - len(first)]])
    return make_sheet(sweep, first)


# ------------------------------------------------------------------ a folder of blocks
def write_blocks(
    sweep: Sweep, folder: Path, share: Share, progress: Progress, *, force: bool
) -> None:
    """Write all variants into a folder. Blocks from an interrupted run of the same sweep are kept.

    Args:
        share: Function that shares work among threads or workers.
        force: Whether to delete another sweep in this folder first.

    Raises:
        BalcliError: The folder holds other files or another sweep, it cannot be written, or pyarrow
            is missing.
    """
    try:
        _claim(folder, _name_sweep(sweep), force)
    except OSError as error:
        raise tell_unwritable(folder, error) from None
    rows = min(ROWS_A_BLOCK, BOXES_A_BLOCK * count_at_once(sweep))
    blocks = enumerate(map(sweep.cut, divide_grid(sweep.shape, rows)))
    done = 0
    for variants in share(partial(_write_block, folder.absolute()), blocks):
        done += variants
        progress(done)


def _write_block(folder: Path, numbered: tuple[int, Sweep]) -> int:
    """Compute and write a block unless it exists; return its number of variants."""
    number, block = numbered
    target = folder / f"part-{number:06}.parquet"
    if not target.exists():
        with replacing(target) as place:
            write_sweep_parquet(block, evaluate_chunks(block), place)
    return block.variants


def _name_sweep(sweep: Sweep) -> str:
    """Return the text of the manifest; equal sweeps have equal texts."""
    whole = repr((sweep.file, [(p.path, p.values.tobytes()) for p in sweep.parameters]))
    content = _describe(sweep) | {
        "columns": sweep.columns,
        "variants": sweep.variants,
        "rows_a_block": ROWS_A_BLOCK,
        "sha256": hashlib.sha256(whole.encode()).hexdigest(),
    }
    return json.dumps(content, indent=1, ensure_ascii=False) + "\n"


def _claim(folder: Path, manifest: str, force: bool) -> None:
    """Create the folder and its manifest, unless they exist.

    Raises:
        BalcliError: There is a file of this name, or the folder holds other files or another sweep.
    """
    if folder.exists() and not folder.is_dir():
        raise BalcliError(f"{folder}/: is a file; choose another name for the folder")
    folder.mkdir(exist_ok=True)
    with suppress(FileNotFoundError):
        if (folder / MANIFEST).read_bytes() == manifest.encode():
            return
    names = sorted(path.name for path in folder.iterdir())
    strange = [name for name in names if not _OURS.fullmatch(name)]
    if strange or (names and MANIFEST not in names):
        raise BalcliError(
            f"{folder}/: holds {(strange or names)[0]}, which is not part of a sweep; choose an "
            "empty or new folder"
        )
    if names and not force:
        raise ArgumentError(
            "{folder}/: holds another sweep; choose another folder, or {force} to replace it",
            folder=folder,
        )
    for name in sorted(names, key=MANIFEST.__eq__):  # manifest last: it shows that blocks are ours
        (folder / name).unlink()
    (folder / MANIFEST).write_bytes(manifest.encode())


# ------------------------------------------------------------------ dask
def share_work(jobs: int | None, dask: str) -> AbstractContextManager[Share]:
    """Return the context whose function shares work among threads or on a cluster."""
    if dask:
        return connect_cluster(dask)
    threads = jobs or min(count_cores(), MOST_THREADS)
    return nullcontext(partial(share_among_threads, threads=threads))


@contextmanager
def connect_cluster(address: str) -> Iterator[Share]:
    """Yield a function that shares work among the workers of a cluster. The address is that of a
    scheduler, such as tcp://host:8786, or `local` for a temporary cluster on this machine.

    Raises:
        BalcliError: Dask is not installed, or no scheduler responds.
    """
    try:
        import distributed
    except ImportError:
        raise ArgumentError("{dask} needs dask: install balcli[scale]") from None
    dask: Any = distributed
    options: dict[str, Any] = {"address": address, "timeout": 10}
    if address == "local":
        # Otherwise, workers log the loss of their scheduler when the cluster ends.
        quiet = {"dashboard_address": None, "silence_logs": logging.CRITICAL}
        options = {"threads_per_worker": 1, **quiet}
    try:
        client = dask.Client(**options)
    except (OSError, ValueError, RuntimeError) as error:
        raise ArgumentError(
            "{dask} {address}: no cluster answers there ({error})",
            address=address,
            error=str(error),
        ) from None
    with client as cluster:
        yield partial(run_on_cluster, cluster)


def run_on_cluster(
    client: Any, work: Callable[[Item], Outcome], items: Iterable[Item]
) -> Iterator[Outcome]:
    """Yield `work(item)` for each item, in order, computed by the workers of a client's cluster.

    Raises:
        BalcliError: Workers are lost repeatedly.
    """
    from distributed import KilledWorker  # an extra

    submit = partial(client.submit, pure=False, retries=RETRIES)
    ahead = AHEAD * max(sum(client.nthreads().values()), 1)
    try:
        yield from run_in_order(submit, work, items, ahead)
    except (KilledWorker, CancelledError) as error:
        raise ArgumentError(
            "{dask}: the cluster has lost its workers ({error}) and their results; start it again, "
            "or leave {dask} out",
            error=type(error).__name__,
        ) from None

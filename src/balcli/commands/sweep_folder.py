"""A sweep as a folder of numbered Parquet files, each written by the thread or worker that computes
it.

The folder holds a manifest that names the sweep. A block exists or not: it is written under a
hidden name and renamed when it is whole. The same sweep into the same folder computes the missing
blocks. Nothing but blocks and manifests is ever replaced or deleted.
"""

from __future__ import annotations

import hashlib
import json
import re
from contextlib import AbstractContextManager, suppress
from functools import partial
from pathlib import Path

from ..errors import BalcliError, tell_unwritable
from ..files import replacing
from ..render.sweep_parquet import write_sweep_parquet
from ..studies.sweep import Block, Share, Sweep, divide_into_blocks, evaluate_chunks, split_columns
from ..version import __version__
from .progress import Progress

ROWS_A_BLOCK = 1 << 20
MANIFEST = "_balcli_sweep.json"  # readers of Parquet pass over names that begin with _
_BLOCK = re.compile(r"part-\d{6,}\.parquet")
# An unfinished block is called as `files.name_hidden` has it.
_OURS = re.compile(rf"{_BLOCK.pattern}|\.{_BLOCK.pattern}\.[0-9a-f]+|{re.escape(MANIFEST)}")


def write_blocks(
    sweep: Sweep,
    folder: Path,
    sharing: AbstractContextManager[Share],
    progress: Progress,
    *,
    force: bool,
) -> None:
    """Write all variants into a folder; blocks that an interrupted run of this sweep has left there
    stay.

    Args:
        sharing: gives what shares work among threads or workers.
        force: whether an earlier sweep in this folder is deleted first.

    Raises:
        BalcliError: the folder holds something else or another sweep, it cannot be written, or
            pyarrow is missing.
    """
    try:
        _claim(folder, _name_sweep(sweep), force)
    except OSError as error:
        raise tell_unwritable(folder, error) from None
    done = 0
    try:
        with sharing as share:
            blocks = divide_into_blocks(sweep, ROWS_A_BLOCK)
            for variants in share(partial(_write_block, folder.absolute()), blocks):
                done += variants
                progress(done)
    except BalcliError:
        if not done:
            _give_up(folder)
        raise


def _give_up(folder: Path) -> None:
    """Delete the manifest, and the folder if it is empty then, where no block has been written."""
    if not any(_BLOCK.fullmatch(path.name) for path in folder.iterdir()):
        (folder / MANIFEST).unlink()
        with suppress(OSError):
            folder.rmdir()


def _write_block(folder: Path, block: Block) -> int:
    """Compute and write a block unless it is there; returns its number of variants."""
    target = folder / f"part-{block.number:06}.parquet"
    if not target.exists():
        rows = (split_columns(block.sweep, chunk) for chunk in evaluate_chunks(block.sweep))
        with replacing(target) as place:
            write_sweep_parquet(block.sweep, rows, place)
    return block.sweep.variants


def _name_sweep(sweep: Sweep) -> str:
    """Return the manifest: the same for the same engine, numbers, values and quantities."""
    whole = repr((sweep.file, [(p.path, p.values.tobytes()) for p in sweep.parameters]))
    content = {
        "format": "balcli.sweep/1",
        "version": __version__,
        "engine": sweep.file.name,
        "columns": sweep.columns,
        "variants": sweep.variants,
        "rows_a_block": ROWS_A_BLOCK,
        "sha256": hashlib.sha256(whole.encode()).hexdigest(),
    }
    return json.dumps(content, indent=1, ensure_ascii=False) + "\n"


def _claim(folder: Path, manifest: str, force: bool) -> None:
    """Make the folder and its manifest, unless they are there.

    Raises:
        BalcliError: there is a file of this name, or the folder holds something else or another
            sweep.
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
            f"{folder}/: holds {(strange or names)[0]}, which is no part of a sweep; choose a "
            "folder that is empty or not there"
        )
    if names and not force:
        raise BalcliError(
            f"{folder}/: holds another sweep; choose another folder, or --force to replace it"
        )
    for name in sorted(names, key=MANIFEST.__eq__):  # the manifest last: a run may be interrupted
        (folder / name).unlink()
    try:
        with (folder / MANIFEST).open("x", encoding="utf-8") as stream:
            stream.write(manifest)
    except FileExistsError:  # another run was faster
        raise BalcliError(f"{folder}/: another sweep is just beginning there") from None

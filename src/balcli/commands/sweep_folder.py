"""A sweep as a folder of numbered Parquet files, each of which is written by whoever computes it: a
thread, or a worker of a cluster.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable, Iterator
from contextlib import AbstractContextManager, suppress
from functools import partial
from pathlib import Path
from typing import TypeAlias

from ..errors import BalcliError
from ..files import discard, follow_link, make_folder, making_beside, name_hidden, name_part
from ..render.sweep_parquet import write_sweep_parquet
from ..studies.boxes import BoxSize, group_boxes
from ..studies.sweep import Chunk, Sweep, divide_sweep, evaluate_box, size_boxes, split_columns
from .progress import Progress

ROWS_A_PART = 1 << 20
_PART = re.compile(r"part-\d{6,}\.parquet")

Task: TypeAlias = tuple[int, list[Sweep]]  # number of a part, and the boxes that it is made of
Share: TypeAlias = Callable[[Callable[[Task], int], Iterable[Task]], Iterator[int]]


def write_parts(
    sweep: Sweep,
    target: Path,
    sharing: AbstractContextManager[Share],
    progress: Progress,
    *,
    force: bool,
) -> str:
    """Write all variants into a folder, which takes its place when it is whole. What there is of
    one that Ctrl-C has cut short, whole files of fewer rows, goes to `name.part` beside it, or
    to `name.part2` if something else is there. Returns where that is, in words.

    Args:
        sharing: gives what shares work among threads or workers.
        force: whether an earlier sweep in this folder may be replaced.

    Raises:
        BalcliError: something is in the folder already, or it cannot be written, or pyarrow is
            missing.
    """
    _refuse_content(target, force)
    size = size_boxes(sweep)
    groups = group_boxes(divide_sweep(sweep, size), ROWS_A_PART)
    tasks = ((number, [sweep.cut(box) for box in group]) for number, group in enumerate(groups))
    try:
        real = follow_link(target)
        with making_beside(real, make_folder) as folder:
            write = partial(_write_part, folder.absolute(), size)
            with sharing as share:
                written = _count_parts(share(write, tasks), progress)
            _keep_first(folder, written)
            if not progress.cut_short:
                _move(folder, real)
                return ""
            part = name_part(real, _is_sweep)
            _move(folder, part)
    except OSError as error:
        raise BalcliError(f"{target}/: cannot be written ({error.strerror or error})") from None
    return f"they are in {part}/"


def _count_parts(parts: Iterator[int], progress: Progress) -> int:
    """How many parts are written, of so many variants each, until Ctrl-C is noted."""
    written, done = 0, 0
    for written, variants in enumerate(parts, 1):  # noqa: B007 (the last one counts)
        done += variants
        if progress(done):
            break
    return written


def _write_part(folder: Path, size: BoxSize, task: Task) -> int:
    """Compute and write one part; returns its number of variants. Its file takes its name when it
    is whole: a worker that is taken for lost may still write while another does the same.
    """
    number, boxes = task
    name = _name_part(number)
    place = name_hidden(folder / name)
    every = (Chunk(box.whole, evaluate_box(box, box.whole, size)) for box in boxes)
    rows = (split_columns(box, chunk) for box, chunk in zip(boxes, every, strict=True))
    write_sweep_parquet(boxes[0], rows, place)
    place.replace(folder / name)
    return sum(box.variants for box in boxes)


def _name_part(number: int) -> str:
    """In the order of their names parts are in the order of rows."""
    return f"part-{number:06}.parquet"


# ------------------------------------------------------------------ folders
def _refuse_content(target: Path, force: bool) -> None:
    """BalcliError for what may not be replaced by a folder of parts."""
    if not os.path.lexists(target):
        return
    if not target.is_dir():
        raise BalcliError(f"{target}/: is a file; choose another name for the folder")
    names = sorted(os.listdir(target))
    others = _list_others(names)
    if others:
        raise BalcliError(
            f"{target}/: holds {others[0]}, which is no part of a sweep; choose a folder that is "
            "empty or not there"
        )
    if names and not force:
        raise BalcliError(
            f"{target}/: holds an earlier sweep; choose another folder, or --force to replace it"
        )


def _is_sweep(path: Path) -> bool:
    """Whether this is a folder that holds nothing but parts of a sweep, as far as can be seen."""
    if path.is_symlink():
        return False
    with suppress(OSError):
        return not _list_others(os.listdir(path))
    return False


def _list_others(names: list[str]) -> list[str]:
    """Those that are no parts."""
    return [name for name in names if not _PART.fullmatch(name)]


def _keep_first(folder: Path, count: int) -> None:
    """Delete all but so many parts: later ones, and what a lost worker has not finished."""
    kept = set(map(_name_part, range(count)))
    for file in folder.iterdir():
        if file.name not in kept:
            file.unlink()


def _move(folder: Path, target: Path) -> None:
    """Put a folder in the place of another, if there is one."""
    if not target.exists():
        folder.rename(target)
        return
    old = name_hidden(target)
    target.rename(old)
    try:
        folder.rename(target)
    except OSError:
        old.rename(target)
        raise
    discard(old)

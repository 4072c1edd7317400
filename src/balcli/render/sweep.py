"""Variants of a sweep as text, chunk by chunk: CSV and JSON, in full precision."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from itertools import product
from typing import TYPE_CHECKING

from .json import stamp

if TYPE_CHECKING:
    from ..core.phasors import Array
    from ..studies.sweep import Chunk, Sweep


def sweep_csv(sweep: Sweep, chunks: Iterable[Chunk]) -> Iterator[str]:
    """A header, and one variant a line; what has no value (axis of a circle) is an empty cell."""
    yield ",".join(sweep.columns) + "\n"
    for chunk in chunks:
        yield "\n".join(_lines(sweep, chunk, "")) + "\n"


def sweep_json(sweep: Sweep, chunks: Iterable[Chunk]) -> Iterator[str]:
    """`balcli.sweep/1`: columns, and one row a variant."""
    head = {
        "format": "balcli.sweep/1",
        "engine": {"name": sweep.file.name},
        "columns": sweep.columns,
    }
    yield json.dumps(stamp(head), ensure_ascii=False)[:-1] + ', "rows": ['
    before = ""
    for chunk in chunks:
        yield before + ",\n".join(f"[{line}]" for line in _lines(sweep, chunk, "null"))
        before = ",\n"
    yield "]}\n"


def _lines(sweep: Sweep, chunk: Chunk, nothing: str) -> Iterator[str]:
    """Rows of a chunk, with commas; each value of a parameter is written out once."""
    axes = [
        _texts(p.values[cut], nothing) for p, cut in zip(sweep.parameters, chunk.box, strict=True)
    ]
    columns = (_texts(values, nothing) for values in chunk.values)
    return map(",".join, zip(map(",".join, product(*axes)), *columns, strict=True))


def _texts(values: Array, nothing: str) -> list[str]:
    """Shortest texts that read back to the same numbers."""
    texts = list(map(repr, values.tolist()))
    if "nan" not in texts:
        return texts
    return [nothing if text == "nan" else text for text in texts]

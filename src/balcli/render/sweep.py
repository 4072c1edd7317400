"""Variants of a sweep: CSV and JSON in full precision, chunk by chunk as they are computed; a table
of the first and the last; the columns of kept ones.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np

from ..core.phasors import Array
from .csv import Columns
from .formats import Columnar
from .json import stamp
from .sheet import NAMELESS, Grid, Sheet, given, number
from .units import name_with_unit, unit_of_name
from .view import tell_assumed_speed

if TYPE_CHECKING:
    from ..studies.sweep import Chunk, Sweep, Swept

FIRST = 20  # rows of a table of many


def _head(sweep: Sweep) -> dict[str, Any]:
    return {
        "format": "balcli.sweep/1",
        "engine": {"name": sweep.file.name},
        "columns": sweep.columns,
    }


def columns(result: Swept) -> Columns:
    """Return a variant a row: its parameters and its figures."""
    sweep = result.sweep
    grids = np.meshgrid(*(p.values for p in sweep.parameters), indexing="ij")
    every = (value.ravel() for value in (*grids, *result.values))
    return Columns(dict(zip(sweep.columns, every, strict=True)), sweep.units)


def document(result: Swept) -> dict[str, Any]:
    """Return `balcli.sweep/1`: columns, and one row a variant."""
    cells = np.column_stack([*columns(result).values.values()]).astype(object)
    cells[cells != cells] = None
    return {**_head(result.sweep), "rows": cells.tolist()}


def sweep_csv(sweep: Sweep, chunks: Iterable[Chunk]) -> Iterator[str]:
    """Yield a header, and one variant a line; what has no value (axis of a circle) is an empty
    cell.
    """
    yield ",".join(sweep.columns) + "\n"
    for chunk in chunks:
        yield "\n".join(_lines(sweep, chunk, "")) + "\n"


def sweep_json(sweep: Sweep, chunks: Iterable[Chunk]) -> Iterator[str]:
    """Yield `balcli.sweep/1` as text."""
    yield json.dumps(stamp(_head(sweep)), ensure_ascii=False)[:-1] + ', "rows": ['
    before = ""
    for chunk in chunks:
        yield before + ",\n".join(f"[{line}]" for line in _lines(sweep, chunk, "null"))
        before = ",\n"
    yield "]}\n"


def _lines(sweep: Sweep, chunk: Chunk, nothing: str) -> Iterator[str]:
    """Return rows of a chunk, with commas; each value of a parameter is written out once."""
    axes = [
        _texts(p.values[cut], nothing) for p, cut in zip(sweep.parameters, chunk.box, strict=True)
    ]
    figures = (_texts(values, nothing) for values in chunk.values)
    return map(",".join, zip(map(",".join, product(*axes)), *figures, strict=True))


def _texts(values: Array, nothing: str) -> list[str]:
    """Return the shortest texts that read back to the same numbers."""
    texts = map(repr, values.tolist())
    return [nothing if text == "nan" else text for text in texts]


def make_sheet(sweep: Sweep, figures: Array, left_out: int) -> Sheet:
    """Return the table, each column in the unit that fits it.

    Args:
        sweep: What the variants are of.
        figures: Parameters and quantities, shape (variants, columns).
        left_out: Number of variants that are missing after the first FIRST.
    """
    largest = np.nanmax(np.abs(figures), axis=0, initial=0).tolist()
    units = [
        unit_of_name(name).fit(size)
        for name, size in zip(sweep.units.values(), largest, strict=True)
    ]
    asked = len(sweep.parameters)  # whose columns hold what the user gave
    rows = [
        (*(given(value, 8) for value in row[:asked]), *map(number, row[asked:]))
        for row in (figures / [unit.size for unit in units]).tolist()
    ]
    heads = map(name_with_unit, sweep.columns, (unit.name for unit in units))
    notes = []
    if left_out:
        rows.insert(FIRST, ("…",) * len(sweep.columns))
        whole = len(figures) + left_out
        notes += [f"{whole} variants, of which {left_out} are not shown: -o X.csv writes all."]
    if "operation.speed" not in sweep.columns and (assumed := tell_assumed_speed(sweep.file)):
        notes += [assumed]
    grid = Grid("", tuple(heads), tuple(rows), " ".join(notes))
    return Sheet(f"{sweep.file.name or NAMELESS}: variants", (grid,))


RENDERER = Columnar(document=document, columns=columns)

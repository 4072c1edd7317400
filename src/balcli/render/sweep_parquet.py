"""Variants of a sweep as a Parquet file, with its units."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..core.phasors import Array
from ..errors import BalcliError
from ..version import __version__

if TYPE_CHECKING:
    from ..studies.sweep import Sweep

ROWS_A_GROUP = 1 << 20  # of the file
NO_PYARROW = "a .parquet file needs pyarrow: install balcli[scale]"


def write_sweep_parquet(sweep: Sweep, rows: Iterable[list[Array]], place: Path) -> None:
    """Write variants as they come.

    Args:
        sweep: what they are of.
        rows: some at a time, as columns: parameters and quantities.
        place: of the file.

    Raises:
        BalcliError: pyarrow is missing.
    """
    try:
        import pyarrow
        from pyarrow import parquet
    except ImportError:
        raise BalcliError(NO_PYARROW) from None
    named = [(p.path, p.unit) for p in sweep.parameters]
    named += [(quantity.name, quantity.unit) for quantity in sweep.quantities]
    units = {name: {"unit": unit} for name, unit in named}
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
        for columns in _join_rows(rows):
            nulls = [pyarrow.array(column, from_pandas=True) for column in columns]  # for nan
            writer.write_table(pyarrow.table(nulls, schema=schema))


def _join_rows(rows: Iterable[list[Array]]) -> Iterator[list[Array]]:
    """Columns of many rows together: ROWS_A_GROUP rows or a few more, fewer in the last."""
    waiting: list[list[Array]] = []
    for columns in rows:
        waiting.append(columns)
        if sum(len(c[0]) for c in waiting) >= ROWS_A_GROUP:
            yield [np.concatenate(parts) for parts in zip(*waiting, strict=True)]
            waiting = []
    if waiting:
        yield [np.concatenate(parts) for parts in zip(*waiting, strict=True)]

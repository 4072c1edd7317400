"""Variants of a sweep as a Parquet file, with its units."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from ..core.phasors import Array
from ..errors import BalcliError
from ..version import __version__

if TYPE_CHECKING:
    from ..studies.sweep import Sweep

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
    schema = pyarrow.schema(
        [
            pyarrow.field(name, pyarrow.float64(), metadata={"unit": unit})
            for name, unit in sweep.units.items()
        ],
        metadata={
            "balcli.format": "balcli.sweep/1",
            "balcli.version": __version__,
            "balcli.engine": sweep.file.name,
        },
    )
    with parquet.ParquetWriter(place, schema) as writer:
        for columns in rows:
            nulls = [pyarrow.array(column, from_pandas=True) for column in columns]  # for nan
            writer.write_table(pyarrow.table(nulls, schema=schema))

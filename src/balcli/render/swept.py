"""The variants of a sweep that are kept; written as they are computed they are in `sweep`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .csv import Columns

if TYPE_CHECKING:
    from ..studies.swept import Swept


def columns(result: Swept) -> Columns:
    """A variant a row: its parameters and its figures."""
    sweep = result.sweep
    axes = {p.path: p.values for p in sweep.parameters}
    grid = dict(zip(axes, np.meshgrid(*axes.values(), indexing="ij"), strict=True))
    figures = {q.name: value for q, value in zip(sweep.quantities, result.values, strict=True)}
    units = {p.path: p.unit for p in sweep.parameters} | {q.name: q.unit for q in sweep.quantities}
    return Columns({name: value.ravel() for name, value in (grid | figures).items()}, units, axes)


def document(result: Swept) -> dict[str, Any]:
    """`balcli.sweep/1`: columns, and one row a variant."""
    found = columns(result).values
    table = np.column_stack([*found.values()])
    cells = table.astype(object)
    cells[np.isnan(table)] = None
    return {
        "format": "balcli.sweep/1",
        "engine": {"name": result.sweep.file.name},
        "columns": list(found),
        "rows": cells.tolist(),
    }

"""Results as CSV: full precision, one header, one figure or variant a line."""
from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from io import StringIO
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ..analysis import Analysis
    from .units import System


def write(header: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    """Rows under a header; None is an empty cell."""
    buffer = StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(header)
    writer.writerows([("" if cell is None else str(cell).lower() if isinstance(cell, bool) else cell) for cell in row] for row in rows)
    return buffer.getvalue()


def analyses(results: Sequence[Analysis], system: System) -> str:
    """One figure a row; cylinder 0 is the whole engine, an empty order the whole curve."""
    from .figures import rows

    return write(("engine", "cylinder", "quantity", "order", "figure", "value", "unit"),
                 ((result.engine.name, *row) for result in results for row in rows(result, system)))

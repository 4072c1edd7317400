"""Results as CSV: full precision, one header, one figure or variant a line."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Iterator, Mapping, Sequence
from io import StringIO
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ..results.analysis import Analysis
    from ..results.balance import Balance
    from ..results.two_engines import Combined
    from .units import System


def write(header: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    """Rows under a header; None is an empty cell."""
    buffer = StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(header)
    writer.writerows(
        [
            ("" if cell is None else str(cell).lower() if isinstance(cell, bool) else cell)
            for cell in row
        ]
        for row in rows
    )
    return buffer.getvalue()


def analyses(results: Sequence[Analysis], names: Sequence[str], system: System) -> str:
    """One figure a row, under the name of its engine; cylinder 0 is the whole engine, an empty
    order the whole curve.
    """
    from .extras import rows as extras
    from .figures import rows

    return write(
        ("engine", "cylinder", "quantity", "order", "figure", "value", "unit"),
        (
            (name, *row)
            for name, result in zip(names, results, strict=True)
            for row in (*rows(result, system), *extras(result, system))
        ),
    )


def sums(result: Combined, system: System) -> str:
    """One figure a row, of both engines together."""
    from .figures import rows

    return write(
        ("quantity", "order", "figure", "value", "unit"), (row[1:] for row in rows(result, system))
    )


def balances(result: Balance, system: System) -> str:
    """One figure a row: those of the devices, the scheme's other figures (SI, as in JSON: their
    names say the unit), and those of the engine without and with the devices.
    """
    from .devices import device_rows, practical_entry
    from .figures import rows
    from .scheme_details import details_document

    parts: list[tuple[str, Any]] = [
        (f"{kind} {number}", device)
        for kind, devices in (
            ("counterweight", result.remedy.counterweights),
            ("shaft", result.remedy.shafts),
            ("slider", result.remedy.sliders),
        )
        for number, device in enumerate(devices, 1)
    ]
    figures: list[Sequence[Any]] = []
    for (part, device), shop in zip(parts, result.practical, strict=True):
        figures += [(part, "", "", *figure) for figure in device_rows(device, system)]
        figures += [
            (part, "", "", name, value, "") for name, value in _named(practical_entry(shop))
        ]
    figures += [
        ("details", "", "", name, value, "") for name, value in _named(details_document(result))
    ]
    for state, analysis in (("before", result.before), ("after", result.after)):
        figures += [
            (state, row.quantity, row.order, row.figure, row.value, row.unit)
            for row in rows(analysis, system)
        ]
    return write(("part", "quantity", "order", "figure", "value", "unit"), figures)


def _named(value: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """Members of tables and lists by their paths: `card.1.bobweight_g`."""
    if isinstance(value, Mapping):
        members: Iterable[tuple[Any, Any]] = value.items()
    elif isinstance(value, list):
        members = enumerate(value, 1)
    else:
        yield path, value
        return
    for key, part in members:
        yield from _named(part, f"{path}.{key}".lstrip("."))

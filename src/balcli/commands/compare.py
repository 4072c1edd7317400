"""`balcli compare`"""

from __future__ import annotations

from ..render.formats import Format, Units
from .options import (
    EngineFiles,
    FormatOption,
    Only,
    Orders,
    Output,
    Speed,
    UnitsOption,
    checked_speed,
    only_list,
    order_list,
)


def compare(
    files: EngineFiles,
    format: FormatOption = Format.TABLE,  # noqa: A002 (the option's name)
    speed: Speed = None,
    orders: Orders = None,
    only: Only = None,
    units: UnitsOption = Units.SI,
    output: Output = None,
) -> None:
    """Engines side by side: free forces and moments by order, peaks, and their ratios to the first
    engine's.
    """
    from ..render import comparison as rendered
    from ..render.formats import render
    from ..render.units import SYSTEMS
    from ..results.comparison import compare_engines
    from .inputs import distinct, engine_of
    from .output import emit

    rpm, asked = checked_speed(speed), order_list(orders)
    engines = [engine_of(file, rpm)[1] for file in files]
    found = compare_engines(
        engines, distinct([engine.name for engine in engines], files), asked, only_list(only)
    )
    emit(
        render(
            format,
            sheets=lambda: [rendered.sheet(found, SYSTEMS[units])],
            documents=lambda: [rendered.document(found)],
            rows=lambda: rendered.rows(found, SYSTEMS[units]),
            into_file=output is not None,
        ),
        output,
    )

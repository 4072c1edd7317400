"""What a program reads of the analysis of one engine: JSON, and the same figures as CSV."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from ..documents.records import to_document
from .csv import Columns, Rows
from .devices import device_entries, device_rows, number_devices
from .figures import (
    FigureRow,
    assumptions,
    describe_engine,
    describe_state,
    figure_rows,
    order_entries,
    peak_entries,
)
from .formats import Columnar

if TYPE_CHECKING:
    from ..results.analysis import Analysis
    from .units import System

FORMAT = "balcli.analysis/1"


def document(result: Analysis) -> dict[str, Any]:
    """`balcli.analysis/1`."""
    engine = result.engine
    found: dict[str, Any] = {
        "format": FORMAT,
        "engine": describe_engine(engine),
        **describe_state(engine),
        "orders": order_entries(result.spectra),
        **assumptions(result, engine.inferred),
    }
    if largest := peak_entries(result):
        found["peak"] = largest
    if result.sizing is not None:
        found["sizing"] = {
            "scheme": result.sizing.remedy.scheme,
            **device_entries(result.sizing.remedy),
            "after": brief_document(result.sizing.after),
        }
    if result.cylinders:
        found["cylinders"] = [
            {"cylinder": number, "orders": order_entries(spectra)}
            for number, spectra in result.cylinders
        ]
    if result.inner is not None:
        from . import crankshaft

        found["inner"] = crankshaft.document(result.inner)
    if result.guide is not None:
        from . import guide_moments

        found["guide"] = guide_moments.document(result.guide)
    if result.travel is not None:
        from . import strokes

        found["travel"] = strokes.document(result.travel, result.engine.numbers)
    if result.why is not None:
        found["why"] = to_document(result.why)
    return found


def columns(result: Analysis) -> Columns:
    """An order a row: sizes and directions of each kind, named as the quantities of sweeps without
    their order.
    """
    spectra = result.spectra.with_moment_if(result.moments_known)
    orders = result.orders.tolist()
    values: dict[str, Any] = {"order": orders}
    units: dict[str, str] = {}
    for kind, phasors in spectra.items():
        parts = {"amplitude": phasors.major, "cos": phasors.x.real, "sin": -phasors.x.imag}
        if kind.vector:
            parts = {
                "major": phasors.major,
                "minor": np.abs(phasors.minor),
                "axis": phasors.axis_deg,
                "forward": np.abs(phasors.forward),
                "backward": np.abs(phasors.backward),
            }
        for part, figures in parts.items():
            values[f"{kind.name}.{part}"] = figures + 0.0
            units[f"{kind.name}.{part}"] = "deg" if part == "axis" else kind.si_unit
    return Columns(values, units)


def brief_document(result: Analysis) -> dict[str, Any]:
    """Peaks and orders alone, where the engine is known."""
    return {"peak": peak_entries(result), "orders": order_entries(result.spectra)}


def rows(result: Analysis, system: System, *, devices: bool = True) -> Rows:
    """CSV: a figure a line; cylinder 0 is the whole engine, an empty order the whole curve.

    Args:
        devices: whether those of the sizing are wanted.
    """
    header = ("cylinder", "quantity", "order", "figure", "value", "unit")
    return Rows(header, _all_rows(result, system, devices=devices))


def _all_rows(result: Analysis, system: System, *, devices: bool) -> Iterator[FigureRow]:
    yield from figure_rows(result, system)
    if devices and result.sizing is not None:
        for part, device in number_devices(result.sizing.remedy.devices):
            for figure, value, unit in device_rows(device, system):
                yield FigureRow(0, part, None, figure, value, unit)
    if result.travel is not None:
        from . import strokes

        yield from strokes.rows(result.travel, result.engine.numbers, system)
    if result.inner is not None:
        from . import crankshaft

        yield from crankshaft.rows(result.inner, system)
    if result.guide is not None:
        from . import guide_moments

        yield from guide_moments.rows(result.guide, system)
    if result.why is not None:
        from . import symmetry

        yield from symmetry.rows(result.why)


RENDERER = Columnar(document=document, columns=columns)

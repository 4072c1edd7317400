"""Results as JSON (SI units, names carry them)."""

from __future__ import annotations

import json
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from .devices import device_entries, practical_entry
from .figures import clean, entries, order_number, peaks
from .scheme_details import details_document

if TYPE_CHECKING:
    from ..forces.spectrum import Spectra
    from ..results.analysis import Analysis
    from ..results.balance import Balance


def dumps(document: Any) -> str:
    """One document on one line; a nan or infinity in it is a fault of ours and raises
    ValueError.
    """
    return json.dumps(document, ensure_ascii=False, allow_nan=False)


def analysis(result: Analysis) -> dict[str, Any]:
    """`balcli.analysis/1`."""
    engine = result.engine
    document: dict[str, Any] = {
        "format": "balcli.analysis/1",
        "engine": {
            "name": engine.name,
            "cylinders": engine.cylinders.count,
            "displacement_m3": clean(engine.displacement_m3),
        },
        "speed_rpm": clean(engine.speed_rpm),
        "reference_mm": [clean(v * 1e3) for v in engine.reference_m],
        "orders": orders(result.spectra),
    }
    if found := peaks(result):
        document["peak"] = found
    if result.sizing is not None:
        document["sizing"] = {
            "scheme": result.sizing.remedy.scheme,
            **device_entries(result.sizing.remedy),
            "after": after(result.sizing.after),
        }
    if result.cylinders:
        document["cylinders"] = [
            {"cylinder": number, "orders": orders(spectra)} for number, spectra in result.cylinders
        ]
    if result.inner is not None or result.guide is not None or result.travel is not None:
        from .extras import document as extras

        document |= extras(result)
    if result.why is not None:
        document["why"] = {
            "reasons": [asdict(reason) for reason in result.why.reasons],
            "firing": result.why.firing,
        }
    return document


def orders(spectra: Spectra) -> list[dict[str, Any]]:
    """One entry an order."""
    return [
        {"order": order_number(order), **entries(spectra, k)}
        for k, order in enumerate(spectra.orders)
    ]


def after(result: Analysis) -> dict[str, Any]:
    """What an analysis says of the engine, without the engine."""
    return {"peak": peaks(result), "orders": orders(result.spectra)}


def balance(result: Balance) -> dict[str, Any]:
    """`balcli.balance/1`."""
    remedy = result.remedy
    return {
        "format": "balcli.balance/1",
        "scheme": remedy.scheme,
        "order": remedy.order,
        **device_entries(remedy),
        "reasons": list(remedy.reasons),
        "practical": [practical_entry(p) for p in result.practical],
        "details": details_document(result),
        "before": after(result.before),
        "after": after(result.after),
    }

"""Results as JSON (SI units, names carry them)."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from .figures import clean, entries, order_number, peaks

if TYPE_CHECKING:
    from ..forces.spectrum import Spectra
    from ..results.analysis import Analysis
    from ..results.balance import Balance
    from ..sizing.sizing import Practical, Remedy


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
            **devices(result.sizing.remedy),
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


def devices(remedy: Remedy) -> dict[str, list[dict[str, Any]]]:
    """New devices, as an engine file would describe them."""
    return {
        "counterweights": [
            {
                "unbalance_kg_m": (d.unbalance or 0.0) / 1e6,
                "angle_deg": d.angle,
                "position_mm": d.position,
            }
            for d in remedy.counterweights
        ],
        "shafts": [
            {
                "ratio": d.ratio,
                "unbalance_kg_m": (d.unbalance or 0.0) / 1e6,
                "angle_deg": d.angle,
                "at_mm": list(d.at),
                "position_mm": d.position,
            }
            for d in remedy.shafts
        ],
        "sliders": [
            {
                "order": d.order,
                "unbalance_kg_m": (d.unbalance or 0.0) / 1e6,
                "direction_deg": d.direction,
                "angle_deg": d.angle,
                "at_mm": list(d.at),
                "position_mm": d.position,
            }
            for d in remedy.sliders
        ],
    }


def balance(result: Balance) -> dict[str, Any]:
    """`balcli.balance/1`."""
    remedy = result.remedy
    return {
        "format": "balcli.balance/1",
        "scheme": remedy.scheme,
        "order": remedy.order,
        **devices(remedy),
        "reasons": list(remedy.reasons),
        "practical": [practical(p) for p in result.practical],
        "details": details(remedy),
        "before": after(result.before),
        "after": after(result.after),
    }


def practical(p: Practical) -> dict[str, float | None]:
    """The workshop's figures of a device."""
    figures = {
        "unbalance_kg_m": p.unbalance,
        "mass_kg": p.mass,
        "radius_mm": p.radius * 1e3,
        "force_N": p.force,
        "speed_rpm": p.speed_rpm,
        "disc_radius_mm": p.disc_radius * 1e3,
        "disc_thickness_mm": p.disc_thickness * 1e3,
    }
    return {key: clean(value) for key, value in figures.items()} | (
        {} if p.depth is None else {"drill_depth_mm": clean(p.depth * 1e3)}
    )


def details(remedy: Remedy) -> dict[str, Any]:
    """Figures of a scheme that are no device."""
    return {key: _plain(value) for key, value in remedy.details.items()}


def _plain(value: Any) -> Any:
    """The same with clean numbers."""
    if isinstance(value, Mapping):
        return {key: _plain(part) for key, part in value.items()}
    if isinstance(value, list):
        return [_plain(part) for part in value]
    return clean(value) if isinstance(value, float) else value

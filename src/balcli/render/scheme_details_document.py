"""What a program reads of a scheme besides its devices: JSON."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import nan
from typing import Any

from ..results.balance import Balance
from ..sizing.bobweight_card import PISTON
from ..sizing.details import Detail, Dimension, Range
from ..sizing.device_tables import measure_direction
from ..sizing.scheme_figures import Bobweight, FactorPeaks, Optima, Optimum, PlaneNeed
from .figures import clean

# Of each dimension: the end of its keys, and how many of their units are one SI unit.
_JSON_UNITS: dict[Dimension, tuple[str, float]] = {
    "": ("", 1.0),
    "force": ("_N", 1.0),
    "moment": ("_Nm", 1.0),
    "unbalance": ("_kg_m", 1.0),
    "length": ("_mm", 1e3),
    "angle": ("_deg", 1.0),
    "share": ("", 1.0),
    "grams": ("_g", 1e3),
}


def details_document(result: Balance) -> dict[str, Any]:
    """All that the scheme says besides its devices."""
    remedy = result.remedy
    document = _optima_document(remedy.optima) if remedy.optima else {}
    document |= _document(remedy.details)
    if remedy.card:
        document["card"] = [_bobweight_document(bobweight) for bobweight in remedy.card]
    if remedy.needs:
        document["planes"] = [_document(_list_need(need)) for need in remedy.needs]
    if remedy.sweep:
        document["sweep"] = [_document(_list_peaks(peaks)) for peaks in remedy.sweep]
    if remedy.note:
        document["note"] = remedy.note
    if result.speed_note:
        document["speed"] = result.speed_note
    return document


def _document(details: Iterable[Detail]) -> dict[str, Any]:
    """Keys are the labels with the unit; details of a group stand in a table of their own."""
    document: dict[str, Any] = {}
    for detail in details:
        ending, per_si_unit = _JSON_UNITS[detail.dimension]
        table = document.setdefault(_key(detail.group), {}) if detail.group else document
        table[_key(detail.label) + ending] = _json_value(detail.value, per_si_unit)
    return document


def _key(label: str) -> str:
    return label.replace(" ", "_")


def _json_value(value: float | str | Range | tuple[float, ...], per_si_unit: float) -> Any:
    match value:
        case str():
            return value
        case Range():
            return {name: clean(per_si_unit * v) for name, v in value._asdict().items()}
        case tuple():
            return [clean(per_si_unit * v) for v in value]
        case _:
            return clean(per_si_unit * value)


def _bobweight_document(bobweight: Bobweight) -> dict[str, Any]:
    sums = {
        "piston_g": bobweight.sum_of(*PISTON),
        "small_end_g": bobweight.sum_of("small end"),
        "big_end_g": bobweight.sum_of("big end"),
        "rod_bearing_g": bobweight.sum_of("rod bearing"),
        "oil_g": bobweight.sum_of("oil"),
        "rotating_g": bobweight.rotating_g,
        "reciprocating_g": bobweight.reciprocating_g,
        "bobweight_g": bobweight.bobweight_g,
        "throw_g": bobweight.throw_g,
    }
    lines = [
        {"part": line.part, "rotates": line.rotates, "each_g": list(map(clean, line.each_g))}
        for line in bobweight.lines
    ]
    return {
        "throw": bobweight.throw,
        "cylinders": list(bobweight.cylinders),
        "factor": bobweight.factor,
        **{name: clean(value) for name, value in sums.items()},
        "lines": lines,
    }


def _optima_document(optima: Optima) -> dict[str, Any]:
    documents = [_document(list_optimum(optima, optimum)) for optimum in optima.found]
    unit_force = _document([Detail("unit force", "force", optima.unit_force)])
    return unit_force | {"fitted": documents[0], "optima": documents}


# ------------------------------------------------------------------ figures with their labels
def _list_peaks(peaks: FactorPeaks) -> tuple[Detail, ...]:
    return (
        Detail("factor", "", peaks.factor),
        Detail("peak force", "force", peaks.force),
        Detail("along", "force", peaks.along),
        Detail("across", "force", peaks.across),
        Detail("peak moment", "moment", peaks.moment),
        Detail("bobweight", "grams", peaks.bobweight_g / 1e3),
        Detail("counterweight", "unbalance", peaks.counterweight),
    )


def _list_need(need: PlaneNeed) -> Iterator[Detail]:
    """Place, and each unbalance with its direction from cylinder 1's pin."""
    yield Detail("position", "length", need.z)
    for name in ("wanted", "present", "missing"):
        vector: complex = getattr(need, name)
        yield Detail(name, "unbalance", abs(vector))
        yield Detail(name, "angle", measure_direction(vector) if vector else nan)


def list_optimum(optima: Optima, optimum: Optimum, group: str = "") -> tuple[Detail, ...]:
    """What one optimum of a single cylinder's design is, under a heading."""
    return (
        Detail("design", "", optimum.design, group),
        Detail("criterion", "", optimum.criterion, group),
        Detail("engine force", "", optimum.engine_force, group),
        Detail("k", "", optimum.k, group),
        Detail("mu", "", optimum.mu, group),
        Detail("unbalance", "unbalance", optima.find_unbalance(optimum), group),
        Detail("largest", "", optimum.largest, group),
        Detail("mean", "", optimum.mean, group),
    )

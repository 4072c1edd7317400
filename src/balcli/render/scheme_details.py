"""Figures of a scheme that are no device: for people, and as JSON."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from math import nan
from typing import Any

from ..results.balance import Balance
from ..sizing.details import Bobweight, Detail, Dimension, FactorPeaks, Optima, Optimum, Range
from .figures import clean
from .sheet import Facts, Grid, degrees, number
from .units import System, Unit

# of each dimension: the end of its JSON keys, and how many of their units are one SI unit
_JSON_UNITS: dict[Dimension, tuple[str, float]] = {
    "": ("", 1.0),
    "force": ("_N", 1.0),
    "moment": ("_Nm", 1.0),
    "unbalance": ("_kg_m", 1.0),
    "length": ("_mm", 1e3),
    "angle": ("_deg", 1.0),
}
_CARD = (
    "piston",
    "small_end",
    "big_end",
    "rod_bearing",
    "oil",
    "rotating",
    "reciprocating",
    "bobweight",
)


# ------------------------------------------------------------------ for programs
def details_document(result: Balance) -> dict[str, Any]:
    """All that the scheme says besides its devices."""
    remedy = result.remedy
    document = _optima_document(remedy.optima) if remedy.optima else {}
    document |= _document(remedy.details)
    if remedy.card:
        document["card"] = [_bobweight_document(bobweight) for bobweight in remedy.card]
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
    masses = {name: clean(v) for name, v in bobweight._asdict().items() if name.endswith("_g")}
    return bobweight._asdict() | masses | {"cylinders": list(bobweight.cylinders)}


def _optima_document(optima: Optima) -> dict[str, Any]:
    documents = [_document(_list_optimum(optima, optimum)) for optimum in optima.found]
    unit_force = _document([Detail("unit force", "force", optima.unit_force)])
    return unit_force | {"fitted": documents[0], "optima": documents}


# ------------------------------------------------------------------ for people
def details_parts(result: Balance, system: System) -> Iterator[Grid | Facts]:
    """All that the scheme says besides its devices and its note."""
    remedy = result.remedy
    details = list(remedy.details)
    if remedy.optima:
        fitted = _list_optimum(remedy.optima, remedy.optima.found[0], "fitted")
        details = [Detail("unit force", "force", remedy.optima.unit_force), *fitted, *details]
    if result.speed_note:
        details.append(Detail("speed", "", result.speed_note))
    if not result.before.moments_known:
        details = [d._replace(value=nan) if d.dimension == "moment" else d for d in details]
    if details:
        pairs = tuple(pair for detail in details for pair in _list_facts(detail, system))
        yield Facts(pairs, "Details")
    if remedy.card:
        yield _card_grid(remedy.card)
    if remedy.sweep:
        known = result.before.moments_known
        peaks = remedy.sweep if known else tuple(p._replace(moment=nan) for p in remedy.sweep)
        yield _sweep_grid(peaks, system)
    if remedy.optima:
        yield _optima_grid(remedy.optima)


def _list_facts(detail: Detail, system: System) -> Iterator[tuple[str, str]]:
    """Label and value; of a range two."""
    label = f"{detail.group} {detail.label}".lstrip()
    match detail.value:
        case str():
            yield label, detail.value
        case Range():
            yield f"{label} least", _figure(detail.value.least, detail.dimension, system)
            yield f"{label} largest", _figure(detail.value.largest, detail.dimension, system)
        case tuple():
            yield label, f"{', '.join(map(degrees, detail.value))} deg"
        case _:
            yield label, _figure(detail.value, detail.dimension, system)


def _figure(value: float, dimension: Dimension, system: System) -> str:
    """A figure with its unit."""
    if dimension == "":
        return number(value)
    if dimension == "angle":
        return f"{value + 0.0:.3f} deg".replace("-0.000", "0.000")
    unit: Unit = getattr(system, dimension)
    return f"{number(unit.of(value))} {unit.name}"


def _card_grid(card: tuple[Bobweight, ...]) -> Grid:
    """Grams are what a balancing shop's scales show, in either system; equal pins stand in one
    column.
    """
    columns: dict[tuple[float, ...], list[int]] = {}
    for bobweight in card:
        masses = tuple(getattr(bobweight, f"{name}_g") for name in _CARD)
        columns.setdefault(masses, []).extend(bobweight.cylinders)
    heads = [f"cylinders {', '.join(map(str, cylinders))}" for cylinders in columns.values()]
    rows = tuple(
        (name.replace("_", " "), *(number(masses[k], 5) for masses in columns))
        for k, name in enumerate(_CARD)
    )
    pins = "each pin" if len(columns) < len(card) else "pin"
    return Grid(f"Bobweight card, g for {pins}", ("", *heads), rows)


def _sweep_grid(sweep: tuple[FactorPeaks, ...], system: System) -> Grid:
    force, moment = system.force, system.moment
    heads = (
        "factor",
        f"force, {force.name}",
        "along 1st bank",
        "across it",
        f"moment, {moment.name}",
    )
    rows = tuple(
        (
            f"{peaks.factor:g}",
            number(force.of(peaks.force)),
            number(force.of(peaks.along)),
            number(force.of(peaks.across)),
            number(moment.of(peaks.moment)),
        )
        for peaks in sweep
    )
    return Grid("Largest values by factor", heads, rows)


def _optima_grid(optima: Optima) -> Grid:
    heads = ("design", "criterion", "engine force", "k", "μ", "largest/J", "mean/J")
    rows = tuple(
        (
            optimum.design,
            optimum.criterion,
            optimum.engine_force,
            f"{optimum.k:.5f}",
            f"{optimum.mu:.6f}",
            f"{optimum.largest:.6f}",
            f"{optimum.mean:.6f}",
        )
        for optimum in optima.found
    )
    return Grid("Optima of both designs", heads, rows)


# ------------------------------------------------------------------ figures with their labels
def _list_peaks(peaks: FactorPeaks) -> tuple[Detail, ...]:
    return (
        Detail("factor", "", peaks.factor),
        Detail("peak force", "force", peaks.force),
        Detail("along", "force", peaks.along),
        Detail("across", "force", peaks.across),
        Detail("peak moment", "moment", peaks.moment),
    )


def _list_optimum(optima: Optima, optimum: Optimum, group: str = "") -> tuple[Detail, ...]:
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

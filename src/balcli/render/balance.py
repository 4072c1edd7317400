"""A balance: devices, their practical figures, and what shakes before and after."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

import numpy as np

from ..core.peaks import Peak
from ..engine.positions import MOMENTS_UNKNOWN
from ..forces.kinds import FORCE, MOMENT, ROLL
from ..results.balance import Balance
from ..sizing.sizing import Remedy
from . import figures
from .analysis import brief_document
from .csv import Rows
from .devices import device_entries, device_grid, device_rows, practical_entry
from .figures import assumptions, clean, order_number
from .sheet import NAMELESS, Facts, Grid, Sheet, Text, capitalized, degrees, number
from .units import System, Unit

_UNITS = {"N": "force", "Nm": "moment", "kg_m": "unbalance", "mm": "length"}
_CARD = (
    "piston_g",
    "small_end_g",
    "big_end_g",
    "rod_bearing_g",
    "oil_g",
    "rotating_g",
    "reciprocating_g",
    "bobweight_g",
)


def sheet(result: Balance, system: System) -> Sheet:
    """Why and what, the workshop's figures, and both analyses side by side."""
    remedy, known = result.remedy, result.before.moments_known
    order = "" if remedy.order is None else f", order {remedy.order}"
    parts: list[Grid | Facts | Text] = []
    if remedy.reasons and not remedy.devices and not remedy.beyond:
        parts.append(Text("What is changed, and why", remedy.reasons))
    elif remedy.reasons:
        parts.append(Text("What is fitted, and why", tuple(dict.fromkeys(remedy.reasons))))
        parts += [device_grid(remedy, system), _practical(result, system)]
    else:
        parts.append(
            Text(
                "Nothing is fitted",
                () if "note" in remedy.details or not known else ("Orders 1 and 2 are balanced.",),
            )
        )
    if "note" in remedy.details:
        parts.append(Text("Note", (str(remedy.details["note"]),)))
    if not known:
        parts.append(Text("Forces alone", (capitalized(f"{MOMENTS_UNKNOWN}."),)))
    parts += _details(remedy.details if known else _without_moments(remedy.details), system)
    parts += _permitted(result, system)
    parts += [_orders(result, system), _peaks(result, system)]
    return Sheet(
        f"{result.before.engine.name or NAMELESS}: {remedy.scheme}{order}",
        tuple(parts),
    )


def _practical(result: Balance, system: System) -> Grid:
    rows = []
    first = result.practical[0]
    drilled = first.depth is not None
    for k, p in enumerate(result.practical, 1):
        depth = (
            []
            if p.depth is None
            else ["too small" if math.isnan(p.depth) else number(system.length.of(p.depth), 3)]
        )
        rows.append(
            (
                str(k),
                f"{p.speed_rpm:.0f}",
                number(system.force.of(p.force)),
                number(system.mass.of(p.mass), 4),
                number(system.length.of(p.disc_radius), 3),
                number(system.length.of(p.disc_thickness), 3),
                *depth,
            )
        )
    names = (
        "device",
        "rpm",
        f"pulls, {system.force.name}",
        f"mass, {system.mass.name}",
        f"disc r, {system.length.name}",
        f"thick, {system.length.name}",
        *([f"drill, {system.length.name}"] if drilled else []),
    )
    hole = (
        "; drill: depth of a radial hole from that radius inwards that removes as much"
        if drilled
        else ""
    )
    return Grid(
        "Practical figures",
        names,
        tuple(rows),
        note=f"Mass at a radius of {number(system.length.of(first.radius), 4)} "
        f"{system.length.name}; "
        f"disc: a semicircular one of steel{hole}.",
    )


def _permitted(result: Balance, system: System) -> Iterator[Grid]:
    """What a grade permits beside each counterweight, if one was asked for."""
    if result.permitted is None:
        return
    unit, each = system.unbalance, result.permitted.each
    rows = [
        (
            str(k),
            number(unit.of(p.unbalance)),
            number(unit.of(each), 4),
            f"{each / p.unbalance:.2%}" if p.unbalance else "–",
        )
        for k, p in enumerate(result.practical[: len(result.remedy.counterweights)], 1)
    ]
    yield Grid(
        f"Permitted residual unbalance, ISO 21940-11, G {result.permitted.grade:g}",
        ("counterweight", f"unbalance, {unit.name}", f"permitted, {unit.name}", "share"),
        tuple(rows),
        f"A crankshaft of {result.permitted.mass:g} kg at {result.before.engine.speed_rpm:g} rpm; "
        "all counterweights share alike.",
    )


# ------------------------------------------------------------------ before and after
def _orders(result: Balance, system: System) -> Grid:
    columns = (FORCE, MOMENT, ROLL)

    def row(k: int) -> tuple[str, ...]:
        cells = [f"{order_number(result.before.orders[k])}"]
        for kind in columns:
            unit = system.unit(kind)
            for analysis in (result.before, result.after):
                phasors = analysis.spectra[kind.name]
                if kind is MOMENT and not analysis.moments_known:
                    cells.append("–")
                    continue
                cells.append(
                    "balanced"
                    if phasors.balanced[k]
                    else number(unit.of(float(phasors.major[k])), 4)
                )
        return tuple(cells)

    heads = [
        head for kind in columns for head in (f"{kind.name}, {system.unit(kind).name}", "after")
    ]
    return Grid(
        "Largest value by order, before and after",
        ("order", *heads),
        tuple(map(row, range(len(result.before.orders)))),
    )


def _peaks(result: Balance, system: System) -> Grid:
    rows = []
    for (kind, before), (_, after) in zip(result.before.peaks, result.after.peaks, strict=True):
        unit = system.unit(kind)
        told = kind is not MOMENT or result.before.moments_known
        cells = (*_peak(before, unit), *_peak(after, unit)) if told else ("–",) * 4
        rows.append((f"{kind.name}, {unit.name}", *cells))
    note = (
        "Sized for steady mean speed; both columns are those of the uneven speed."
        if result.before.engine.ripple
        else ""
    )
    return Grid(
        "Largest over a revolution, all orders",
        ("", "before", "at, deg", "after", "at, deg"),
        tuple(rows),
        note=note,
    )


def _peak(peak: Peak, unit: Unit) -> tuple[str, str]:
    if not peak.value:
        return "none", "–"
    return number(unit.of(peak.value)), degrees(float(np.degrees(peak.theta)))


# ------------------------------------------------------------------ details
def _without_moments(details: Any) -> Any:
    """The same with nan for every moment, which is not known."""
    if isinstance(details, list):
        return [_without_moments(part) for part in details]
    if not isinstance(details, Mapping):
        return details
    return {
        key: math.nan if "moment" in key or "couple" in key else _without_moments(value)
        for key, value in details.items()
    }


def _details(details: Mapping[str, Any], system: System) -> Iterator[Grid | Facts | Text]:
    """Figures of a scheme that are no device."""
    plain = [
        fact
        for key, value in details.items()
        if key in ("reached_deg", "knuckle_angles_deg")
        or (key != "note" and not isinstance(value, list))
        for fact in _facts(key, value, system)
    ]
    if plain:
        yield Facts(tuple(plain), "Details")
    if "card" in details:
        yield _card(details["card"])
    if "sweep" in details:
        yield _sweep(details["sweep"], system)
    if "optima" in details:
        yield _optima(details["optima"])


def _facts(key: str, value: Any, system: System) -> Iterator[tuple[str, str]]:
    ending = next((f"_{e}" for e in (*_UNITS, "deg") if key.endswith(f"_{e}")), "")
    stem = key.removesuffix(ending)
    if isinstance(value, Mapping):
        for name, part in value.items():
            yield from _facts(f"{stem} {name}{ending}", part, system)
        return
    words = stem.replace("_", " ")
    if isinstance(value, list):
        yield words, f"{', '.join(map(degrees, value))} deg"
    elif isinstance(value, float):
        yield words, _sized(value, ending[1:], system)
    else:
        yield words, str(value)


def _sized(value: float, ending: str, system: System) -> str:
    """A figure with the unit that the end of its name tells."""
    if ending == "deg":
        return f"{value + 0.0:.3f} deg".replace("-0.000", "0.000")
    unit = getattr(system, _UNITS[ending]) if ending else Unit("", 1.0)
    return f"{number(unit.of(value / 1e3 if ending == 'mm' else value))} {unit.name}".strip()


def _card(card: list[dict[str, Any]]) -> Grid:
    """Grams are what a balancing shop's scales show, in either system; equal pins stand in one
    column.
    """
    equal: dict[tuple[float, ...], list[dict[str, Any]]] = {}
    for entry in card:
        equal.setdefault(tuple(entry[key] for key in _CARD), []).append(entry)
    rows = [
        (
            key.removesuffix("_g").replace("_", " "),
            *(number(entries[0][key], 5) for entries in equal.values()),
        )
        for key in _CARD
    ]
    heads = [
        f"cylinders {', '.join(str(n) for entry in entries for n in entry['cylinders'])}"
        for entries in equal.values()
    ]
    pins = "each pin" if len(equal) < len(card) else "pin"
    return Grid(f"Bobweight card, g for {pins}", ("", *heads), tuple(rows))


def _sweep(sweep: list[dict[str, float]], system: System) -> Grid:
    unit = system.force
    rows = [
        (
            f"{row['factor']:g}",
            *(number(unit.of(row[key])) for key in ("peak_force_N", "along_N", "across_N")),
            number(system.moment.of(row["peak_moment_Nm"])),
        )
        for row in sweep
    ]
    heads = (
        "factor",
        f"force, {unit.name}",
        "along 1st bank",
        "across it",
        f"moment, {system.moment.name}",
    )
    return Grid("Largest values by factor", heads, tuple(rows))


def _optima(optima: list[dict[str, Any]]) -> Grid:
    rows = [
        (
            o["design"],
            o["criterion"],
            o["engine_force"],
            f"{o['k']:.5f}",
            f"{o['mu']:.6f}",
            f"{o['largest']:.6f}",
            f"{o['mean']:.6f}",
        )
        for o in optima
    ]
    return Grid(
        "Optima of both designs",
        ("design", "criterion", "engine force", "k", "μ", "largest/J", "mean/J"),
        tuple(rows),
    )


# ------------------------------------------------------------------ JSON and CSV
def document(result: Balance) -> dict[str, Any]:
    """`balcli.balance/1`."""
    remedy, permitted = result.remedy, result.permitted
    document = {
        "format": "balcli.balance/1",
        "scheme": remedy.scheme,
        "order": remedy.order,
        **device_entries(remedy),
        "reasons": list(remedy.reasons),
        "practical": [practical_entry(p) for p in result.practical],
        "details": details_document(remedy),
        **assumptions(result.before),
        "before": brief_document(result.before),
        "after": brief_document(result.after),
    }
    if permitted is not None:
        document["permitted"] = {
            "grade": permitted.grade,
            "mass_kg": permitted.mass,
            "each_g_mm": 1e6 * permitted.each,
        }
    return document


def details_document(remedy: Remedy) -> dict[str, Any]:
    """Figures of a scheme that are no device, as JSON has them."""
    return {key: _cleaned(value) for key, value in remedy.details.items()}


def _cleaned(value: Any) -> Any:
    """The same value with plain floats in it: no nan, no negative zero."""
    if isinstance(value, Mapping):
        return {key: _cleaned(part) for key, part in value.items()}
    if isinstance(value, list):
        return [_cleaned(part) for part in value]
    return clean(value) if isinstance(value, float) else value


def rows(result: Balance, system: System) -> Rows:
    """CSV: a figure a line: those of the devices, the scheme's other figures (SI, as in JSON: their
    names say the unit), and those of the engine without and with the devices.
    """
    header = ("part", "quantity", "order", "figure", "value", "unit")
    return Rows(header, _all_rows(result, system))


def _all_rows(result: Balance, system: System) -> Iterator[tuple[Any, ...]]:
    parts = [
        (f"{kind} {number}", device)
        for kind, devices in (
            ("counterweight", result.remedy.counterweights),
            ("shaft", result.remedy.shafts),
            ("slider", result.remedy.sliders),
        )
        for number, device in enumerate(devices, 1)
    ]
    for (part, device), practical in zip(parts, result.practical, strict=True):
        for figure in device_rows(device, system):
            yield part, "", "", *figure
        for name, value in _with_paths(practical_entry(practical)):
            yield part, "", "", name, value, ""
    for name, value in _with_paths(details_document(result.remedy)):
        yield "details", "", "", name, value, ""
    for name, value in _with_paths(document(result).get("permitted", {})):
        yield "permitted", "", "", name, value, ""
    for state, analysis in (("before", result.before), ("after", result.after)):
        for row in figures.rows(analysis, system):
            yield state, row.quantity, row.order, row.figure, row.value, row.unit


def _with_paths(value: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """Members of tables and lists by their paths: `card.1.bobweight_g`."""
    if isinstance(value, Mapping):
        members: Iterable[tuple[Any, Any]] = value.items()
    elif isinstance(value, list):
        members = enumerate(value, 1)
    else:
        yield path, value
        return
    for key, part in members:
        yield from _with_paths(part, f"{path}.{key}".lstrip("."))

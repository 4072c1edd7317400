"""The analysis of one engine."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np

from ..core.peaks import Peak
from ..core.phasors import Array, Phasors
from ..engine.build import Engine
from ..engine.positions import MOMENTS_UNKNOWN
from ..forces.kinds import FORCE, MOMENT, ROLL, Kind
from ..forces.spectrum import Spectra
from ..forces.textbook import TextbookUnits
from ..limits import HIGHEST_ORDER_UNASKED
from ..results.analysis import Analysis, Sizing
from . import crankshaft, figures, guide_moments, strokes, symmetry
from .csv import Rows
from .devices import device_entries, device_grid
from .figures import (
    Result,
    assumptions,
    clean,
    order_entries,
    order_number,
    peak_deg,
    peaks,
    phase_deg,
)
from .sheet import NAMELESS, Facts, Grid, Sheet, Text, capitalized, degrees, number
from .terminal_plot import sketches
from .units import System, Unit
from .verdict import verdict


def sheet(result: Analysis, system: System, *, pictures: bool = False) -> Sheet:
    """The whole analysis: what the engine is, what it does order by order, peaks, verdict, sizing;
    pictures of characters.
    """
    engine, known = result.engine, result.moments_known
    spectra = result.spectra if known else result.spectra.without_moment()
    parts: list[Grid | Facts | Text] = [facts(result, system)]
    parts += order_by_order(spectra, system)
    if spectra.vectors():
        told = spectra if known else replace(spectra, moment=None)
        parts += _textbook(told, result.textbook, system)
    if result.peaks:
        parts.append(largest(result, system, "Largest over a revolution, all orders"))
    parts += [
        _share(n, share if known else share.without_moment(), system)
        for n, share in result.cylinders
    ]
    if result.travel is not None:
        parts += strokes.sheet_parts(result.travel, engine.numbers, system)
    if result.inner is not None:
        parts += crankshaft.sheet_parts(result.inner, system)
    if result.guide is not None:
        parts += guide_moments.sheet_parts(result.guide, system)
    if found := _judge(result, system):
        parts.append(Text("Verdict", found))
    if result.why is not None:
        parts += symmetry.sheet_parts(result.why)
    if result.sizing is not None:
        parts += _sizing(result.sizing, system)
    if pictures:
        drawn = result if known else replace(result, spectra=replace(spectra, moment=None))
        parts += sketches(drawn, system)
    return Sheet(engine.name or NAMELESS, tuple(parts))


def _judge(result: Analysis, system: System) -> tuple[str, ...]:
    """The verdict; of forces alone where moments are not known, which it then says."""
    spectra = result.spectra
    if result.moments_known:
        return verdict(spectra, system, result.of_one_cylinder)
    forces = verdict(replace(spectra, moment=None), system, result.of_one_cylinder)
    return (*forces, capitalized(f"{MOMENTS_UNKNOWN}.")) if spectra.vectors() else ()


def document(result: Analysis) -> dict[str, Any]:
    """`balcli.analysis/1`."""
    engine = result.engine
    found: dict[str, Any] = {
        "format": "balcli.analysis/1",
        "engine": {
            "name": engine.name,
            "cylinders": engine.cylinders.count,
            "displacement_m3": clean(engine.displacement_m3),
        },
        "speed_rpm": clean(engine.speed_rpm),
        "reference_mm": [clean(v * 1e3) for v in engine.reference_m],
        "orders": order_entries(result.spectra),
        **assumptions(result),
    }
    if largest_values := peaks(result):
        found["peak"] = largest_values
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
        found["inner"] = crankshaft.document(result.inner)
    if result.guide is not None:
        found["guide"] = guide_moments.document(result.guide)
    if result.travel is not None:
        found["travel"] = strokes.document(result.travel, engine.numbers)
    if result.why is not None:
        found["why"] = symmetry.document(result.why)
    return found


def brief_document(result: Analysis) -> dict[str, Any]:
    """Peaks and orders alone, where the engine is known."""
    return {"peak": peaks(result), "orders": order_entries(result.spectra)}


def rows(result: Analysis, system: System) -> Rows:
    """CSV: a figure a line; cylinder 0 is the whole engine, an empty order the whole curve."""
    return Rows(
        ("cylinder", "quantity", "order", "figure", "value", "unit"), _all_rows(result, system)
    )


def _all_rows(result: Analysis, system: System) -> Iterator[figures.Row]:
    yield from figures.rows(result, system)
    if result.travel is not None:
        yield from strokes.rows(result.travel, result.engine.numbers, system)
    if result.inner is not None:
        yield from crankshaft.rows(result.inner, system)
    if result.guide is not None:
        yield from guide_moments.rows(result.guide, system)
    if result.why is not None:
        yield from symmetry.rows(result.why)


# ------------------------------------------------------------------ what it is
def facts(result: Analysis, system: System) -> Facts:
    """The engine in a few lines, with the masses that the figures include."""
    engine, length, mass = result.engine, system.length, system.mass
    c = engine.cylinders
    first = engine.numbers.index(1)

    def of_first(values: np.ndarray) -> float:
        return float(values[first if len(values) > 1 else 0])

    unequal = "" if engine.equal else " (cylinder 1; others differ)"
    radius, lam, weighed = float(c.radius), of_first(c.lam), engine.weighed[first]
    crank = (
        f"r = {number(length.of(radius))} {length.name}, rod {number(length.of(radius / lam))} "
        f"{length.name}, "
        f"λ = {number(lam, 4)}{unequal}"
    )
    reciprocating, rotating = (
        number(mass.of(float(kg)), 4)
        for kg in (weighed.piston + weighed.small_end, weighed.big_end + weighed.share)
    )
    masses = (
        f"reciprocating {reciprocating} {mass.name} a cylinder (piston, rod's share at its pin)"
    )
    if c.linkage is None or not c.linkage.turning:  # else the pins stand still
        masses += f", rotating {rotating} {mass.name} a pin (rod's share, throw)"
    about = ", ".join(number(length.of(float(v))) for v in engine.reference_m)
    higher = ""
    if result.has_higher_orders:
        higher = f"to {HIGHEST_ORDER_UNASKED}; --orders asks for higher ones"
    pairs = [
        ("cylinders", f"{c.count}{_banks(engine)}{_bore(engine, system)}"),
        ("crank", crank),
        ("firing", _firing(engine)),
        (
            "speed",
            (
                f"{number(float(engine.speed_rpm), 6)} rpm"
                f"{', uneven: figures are those of the uneven speed' if engine.ripple else ''}"
            ),
        ),
        ("masses", masses + unequal),
        ("orders", higher),
        (
            "reference",
            f"moments about x, y, z = {about} {length.name}"
            if result.moments_known
            else "moments are not known: crank.spacing is missing",
        ),
        ("devices", _counted(engine)),
        ("source", engine.source),
    ]
    return Facts(tuple((name, value) for name, value in pairs if value))


def _bore(engine: Engine, system: System) -> str:
    """Bore, stroke and displacement, where the file gives the bore."""
    bore_m, stroke_m = float(engine.bore_m), 2 * float(engine.cylinders.radius)
    if math.isnan(bore_m):
        return ""
    bore, stroke = (number(system.length.of(v)) for v in (bore_m, stroke_m))
    volume = number(system.volume.of(float(engine.displacement_m3)), 4)
    return f", bore × stroke {bore} × {stroke} {system.length.name}, {volume} {system.volume.name}"


def _banks(engine: Engine) -> str:
    if engine.rotary:
        return " that turn about a crank standing still"
    axes = np.ravel(engine.cylinders.axis_deg)
    if len(axes) == 1:
        return " in line"
    return (
        f", banks at {', '.join(f'{a:.4g}' for a in axes[:9])}{' …' if len(axes) > 9 else ''} deg"
    )


def _firing(engine: Engine) -> str:
    if not engine.fires_deg:
        return ""
    order = list(engine.fires_deg)
    instants = [*engine.fires_deg.values(), 180.0 * engine.strokes]
    gaps = [b - a for a, b in pairwise(instants)]
    even = max(gaps) - min(gaps) < 0.05
    return (
        f"{'-'.join(map(str, order))}, "
        f"{f'every {gaps[0]:.4g}' if even else 'after ' + ', '.join(f'{g:.4g}' for g in gaps)} "
        "deg"
    )


def _counted(engine: Engine) -> str:
    return f"{len(engine.devices)} of the file are included" if engine.devices else ""


# ------------------------------------------------------------------ order by order
def _rows(
    orders: Array, phasors: list[Phasors], row: Callable[[int], tuple[str, ...]]
) -> tuple[tuple[str, ...], ...]:
    """Orders up to 2, and those in which one of these quantities is not balanced."""
    return tuple(
        row(k)
        for k, order in enumerate(orders)
        if order <= 2 or not all(p.balanced[k] for p in phasors)
    )


def order_by_order(spectra: Spectra, system: System, roll: str = "") -> Iterator[Grid]:
    """Phasors and scalars, and vectors along x and y.

    Args:
        roll: a sentence on what the roll is, if it is more than the couple C less the torque T.
    """
    for kind, phasors in spectra.vectors():
        yield _vectors(kind, phasors, system.unit(kind))
    if spectra.scalars():
        yield _scalars(spectra, system.moment, roll)
    if spectra.vectors():
        yield _directions(spectra, system)


def _vectors(kind: Kind, phasors: Phasors, unit: Unit) -> Grid:
    def row(k: int) -> tuple[str, ...]:
        name = f"{order_number(phasors.orders[k])}"
        if phasors.balanced[k]:
            return name, "balanced", "", "", "", ""
        if np.isnan(phasors.forward[k]):
            return name, "–", "–", "–", "–", "–"
        sizes = (
            phasors.major[k],
            phasors.minor[k],
            abs(phasors.forward[k]),
            abs(phasors.backward[k]),
        )
        largest, smallest, ahead, against = (number(unit.of(float(v))) for v in sizes)
        return name, largest, smallest, degrees(float(phasors.axis_deg[k]), 180), ahead, against

    return Grid(
        f"{capitalized(kind.label)} by order, {unit.name}",
        ("order", "largest", "smallest", "axis, deg", "with crank", "against"),
        _rows(phasors.orders, [phasors], row),
    )


def _scalars(spectra: Spectra, unit: Unit, roll: str) -> Grid:
    scalars = spectra.scalars()

    def row(k: int) -> tuple[str, ...]:
        cells = [f"{order_number(spectra.orders[k])}"]
        for _, phasors in scalars:
            c = phasors.x[k]
            at = peak_deg(c, spectra.orders[k])
            cells += (
                ["balanced", ""]
                if c == 0
                else [number(unit.of(abs(c))), "–" if at is None else degrees(at)]
            )
        return tuple(cells)

    labels = [ROLL.name if roll and kind == ROLL else kind.label for kind, _ in scalars]
    heads = [head for label in labels for head in (label, "peak, deg")]
    return Grid(
        f"About the crank axis, {unit.name}",
        ("order", *heads),
        _rows(spectra.orders, [phasors for _, phasors in scalars], row),
        note=roll,
    )


def _directions(spectra: Spectra, system: System) -> Grid:
    """Vertical and horizontal, as builders state them."""
    vectors = spectra.vectors()

    def row(k: int) -> tuple[str, ...]:
        cells = [f"{order_number(spectra.orders[k])}"]
        for kind, phasors in vectors:
            unit = system.unit(kind)
            for c in (phasors.x[k], phasors.y[k]):
                cells += (
                    ["0", "–"] if c == 0 else [number(unit.of(abs(c)), 4), degrees(phase_deg(c))]
                )
        return tuple(cells)

    units = ", ".join(system.unit(kind).name for kind, _ in vectors)
    heads = [head for kind, _ in vectors for axis in "xy" for head in (kind.symbol + axis, "deg")]
    return Grid(
        f"Along x (vertical) and y (horizontal), {units}",
        ("order", *heads),
        _rows(spectra.orders, [phasors for _, phasors in vectors], row),
        note="Value = amplitude · cos(order · θ − angle). The moment about y is that of the "
        "forces along x.",
    )


def _textbook(spectra: Spectra, units: TextbookUnits, system: System) -> Iterator[Grid]:
    if not units.force:
        return
    cylinder = "one cylinder" if units.equal else "cylinder 1"
    if spectra.force is not None:
        note = (
            f"F1 = m r ω² = {number(system.force.of(units.force))} {system.force.name} "
            f"(reciprocating mass of {cylinder}), "
            "Fn = A_n F1 its n-th order."
        )
        yield _multiples(FORCE, spectra.force, units, note)
    if spectra.moment is not None and units.arm == units.arm:
        note = (
            f"a = {number(system.length.of(units.arm), 4)} {system.length.name}, the distance "
            "of "
            "neighbouring throws."
        )
        yield _multiples(MOMENT, spectra.moment, units, note)


def _multiples(kind: Kind, phasors: Phasors, units: TextbookUnits, note: str) -> Grid:
    size, ratios = units.size(kind), units.ratios

    def row(k: int) -> tuple[str, ...]:
        parts = [
            float(v) for v in (phasors.major[k], abs(phasors.forward[k]), abs(phasors.backward[k]))
        ]
        own = size * ratios[k]
        return (
            f"{order_number(phasors.orders[k])}",
            *(number(p / size, 4) if size else "–" for p in parts),
            number(parts[0] / own, 4) if ratios[k] > 1e-12 and size else "–",
        )

    unit = units.name(kind)
    heads = (
        "order",
        f"largest, {unit}",
        "with crank",
        "against",
        f"largest, {unit.replace('1', 'n')}",
    )
    return Grid(
        f"{capitalized(kind.label)} in textbook units",
        heads,
        _rows(phasors.orders, [phasors], row),
        note,
    )


def largest(result: Result, system: System, title: str) -> Facts:
    """The peaks."""
    return Facts(
        tuple(
            (kind.name, _peak(peak, system.unit(kind)))
            if kind is not MOMENT or result.moments_known
            else (kind.name, "–")
            for kind, peak in result.peaks
        ),
        title,
    )


def _peak(peak: Peak, unit: Unit) -> str:
    if not peak.value:
        return "none"
    return (
        f"{number(unit.of(peak.value))} {unit.name} at crank angle "
        f"{degrees(float(np.degrees(peak.theta)))} deg"
    )


def _share(cylinder: int, share: Spectra, system: System) -> Grid:
    """Each cylinder's part, the lecturer's table: vectors as size and angle."""

    def cell(v: complex, unit: Unit) -> str:
        return (
            "0"
            if v == 0
            else f"{number(unit.of(abs(v)), 4)} ∠ {degrees(float(np.degrees(np.angle(v))))}"
        )

    vectors = share.vectors()

    def row(k: int) -> tuple[str, ...]:
        cells = [f"{order_number(share.orders[k])}"]
        for kind, phasors in vectors:
            unit = system.unit(kind)
            cells += [cell(phasors.forward[k], unit), cell(phasors.backward[k], unit)]
        return tuple(cells)

    heads = [
        f"{kind.name} {way}, {system.unit(kind).name}"
        for kind, _ in vectors
        for way in ("with", "against")
    ]
    return Grid(
        f"Cylinder {cylinder} alone",
        ("order", *heads),
        tuple(row(k) for k in range(len(share.orders))),
    )


def _sizing(sizing: Sizing, system: System) -> Iterator[Grid | Text | Facts]:
    remedy, after = sizing.remedy, sizing.after
    if not (remedy.counterweights or remedy.shafts or remedy.sliders):
        needs = "no counterweight and no shaft"
        yield Text(
            "Sizing",
            (
                f"Orders 1 and 2 need {needs}."
                if after.moments_known
                else f"The forces of orders 1 and 2 need {needs}; moments are not known.",
            ),
        )
        return
    yield Text(
        "Sizing: what leaves no free force or moment of orders 1 and 2"
        if after.moments_known
        else "Sizing: what leaves no free force of orders 1 and 2 (moments are not known)",
        tuple(dict.fromkeys(remedy.reasons)),
    )
    yield device_grid(remedy, system)
    yield largest(after, system, "Largest with these devices")

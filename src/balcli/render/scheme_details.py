"""What a person reads of a scheme besides its devices: figures, bobweight card, factors."""

from __future__ import annotations

from collections.abc import Iterator
from math import isnan, nan

from ..results.balance import Balance
from ..sizing.details import Detail, Dimension, Range
from ..sizing.device_tables import measure_direction
from ..sizing.scheme_figures import Bobweight, FactorPeaks, Optima, PlaneNeed
from .bobweights import group_equal_pins, multiply, name_pins, percent
from .scheme_details_document import list_optimum
from .sheet import NEGLIGIBLE, UNKNOWN, Facts, Grid, degrees, number, size_text
from .units import ShownUnit, System

# Labels of the roll without and with new devices: of inertia, and with gas where there is some.
_ROLLS = (("roll before", "roll left"), ("roll with gas before", "roll with gas left"))
_BESIDE_GAS = {"roll before": "roll of inertia before", "roll left": "roll of inertia left"}

# How well a system was solved, and the like: in JSON and CSV only.
_FOR_PROGRAMS = {"condition number", "relative error bound", "axial distance", "improvement"}


def details_parts(result: Balance, system: System) -> Iterator[Grid | Facts]:
    """All that the scheme says besides its devices and its note."""
    remedy = result.remedy
    if details := _choose_details(result):
        pairs = tuple(pair for detail in details for pair in _list_facts(detail, system))
        yield Facts(pairs, "Details")
    if remedy.needs:
        yield _needs_grid(remedy.needs, system)
    if remedy.card:
        yield _card_grid(remedy.card)
    if remedy.sweep:
        known = result.before.moments_known
        peaks = remedy.sweep if known else tuple(p._replace(moment=nan) for p in remedy.sweep)
        yield _sweep_grid(peaks, system)
    if remedy.optima:
        yield _optima_grid(remedy.optima)


def _choose_details(result: Balance) -> list[Detail]:
    """Figures that people are shown, as they are called beside each other; nan: not known."""
    remedy = result.remedy
    details = list(remedy.details)
    if remedy.optima:
        fitted = list_optimum(remedy.optima, remedy.optima.found[0], "fitted")
        details = [Detail("unit force", "force", remedy.optima.unit_force), *fitted, *details]
    if result.speed_note:
        details.append(Detail("speed", "", result.speed_note))
    if not result.before.moments_known:
        details = [d._replace(value=nan) if _needs_places(d) else d for d in details]
    if result.before.engine.gas is not None:
        details = [d._replace(label=_BESIDE_GAS.get(d.label, d.label)) for d in details]
    return [_name_order(d, remedy.order) for d in details if d.label not in _FOR_PROGRAMS]


def _needs_places(detail: Detail) -> bool:
    """Whether it takes the places of the throws to know it: of moments, but not about the crank."""
    return detail.dimension == "moment" and all(detail.label not in labels for labels in _ROLLS)


def tell_growing_rolls(result: Balance, system: System) -> Iterator[str]:
    """A sentence for every order whose roll, with gas where there is some, is larger with new
    devices than without them.
    """
    remedy, (x, y, _) = result.remedy, result.before.engine.reference_m
    pivot = "the point of reference" if x or y else "the crankshaft"
    for group in dict.fromkeys(detail.group for detail in remedy.details):
        of_order = {d.label: d.value for d in remedy.details if d.group == group}
        grown = [
            _find_growth(of_order[before], of_order[left])
            for before, left in _ROLLS
            if before in of_order
        ]
        if not grown or grown[-1] <= 0:
            continue
        order, size = group or f"order {remedy.order}", size_text(grown[-1], system.moment)
        why = f"where they stand, the devices' forces have levers about {pivot}."
        if grown[0] < 0:
            why = (
                "what they take of the roll of inertia stood against that of the gas at this speed."
            )
        with_gas = " with gas" * (len(grown) > 1)
        yield f"The roll of {order}{with_gas} grows by {size}: {why}"


def _find_growth(before: object, left: object) -> float:
    """By how much the second figure is above the first; 0 where that is negligible."""
    if not isinstance(before, float) or not isinstance(left, float):
        return 0.0
    return left - before if abs(left - before) > NEGLIGIBLE * max(before, left) else 0.0


def _name_order(detail: Detail, order: int | None) -> Detail:
    """What a scheme for one order leaves, with that order: others may leave more."""
    of_order = {"left", "before"}.intersection(detail.label.split())
    named = of_order and order is not None and not detail.group
    return detail._replace(group=f"order {order}") if named else detail


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
            figure = _figure(detail.value, detail.dimension, system)
            yield label, f"{figure} {detail.what}".rstrip()


def _figure(value: float, dimension: Dimension, system: System) -> str:
    """A figure with its unit; a dash where it is not known."""
    if isnan(value):
        return UNKNOWN
    if dimension == "":
        return number(value)
    if dimension == "share":
        return percent(value)
    if dimension == "grams":
        return f"{number(1e3 * value)} g"
    if dimension == "angle":
        return f"{value + 0.0:.3f} deg".replace("-0.000", "0.000")
    unit: ShownUnit = getattr(system, dimension)
    return f"{number(unit.of(value))} {unit.name}"


def _needs_grid(needs: tuple[PlaneNeed, ...], system: System) -> Grid:
    """What the file has in each plane, and what is missing."""
    sizes = [abs(v) for need in needs for v in (need.wanted, need.present, need.missing)]
    unit, length = system.unbalance.fit(max(sizes)), system.length
    at = "at, deg"
    heads = (f"z, {length.name}", "wanted", at, "in the file", at, "missing", at)

    def row(need: PlaneNeed) -> tuple[str, ...]:
        vectors = (need.wanted, need.present, need.missing)
        cells = ((number(unit.of(abs(v))), _direction(v)) for v in vectors)
        return number(length.of(need.z)), *(cell for pair in cells for cell in pair)

    title = f"What each plane has, and lacks, {unit.name}"
    return Grid(title, heads, tuple(map(row, needs)))


def _direction(vector: complex) -> str:
    """From cylinder 1's pin, degrees; a dash where there is nothing."""
    return degrees(measure_direction(vector)) if vector else "–"


def _card_grid(card: tuple[Bobweight, ...]) -> Grid:
    """Quantity x each = sum, in grams as a balancing shop's scales show, in either system; equal
    pins stand in one column.
    """
    columns = group_equal_pins(card)
    heads = [name_pins(pins) for pins in columns]
    weighed = (line for pins in columns for line in pins[0].lines if line.sum_g)
    labels = list(dict.fromkeys(line.part for line in weighed))
    rows = [(part, *(_line_cell(pins[0], part) for pins in columns)) for part in labels]
    sums = (
        ("rotating", [pins[0].rotating_g for pins in columns]),
        ("reciprocating", [pins[0].reciprocating_g for pins in columns]),
        (f"bobweight ({percent(card[0].factor)})", [pins[0].bobweight_g for pins in columns]),
    )
    rows += [(name, *(number(value, 5) for value in values)) for name, values in sums]
    return Grid("Bobweight card, g for each pin", ("", *heads), tuple(rows))


def _line_cell(bobweight: Bobweight, part: str) -> str:
    line = next((line for line in bobweight.lines if line.part == part), None)
    return "–" if line is None else f"{multiply(line)} = {number(line.sum_g, 5)}"


def _sweep_grid(sweep: tuple[FactorPeaks, ...], system: System) -> Grid:
    force, moment = system.force, system.moment
    unbalance = system.unbalance.fit(max(abs(peaks.counterweight) for peaks in sweep))
    heads = (
        "factor",
        "bobweight, g",
        f"weight, {unbalance.name}",
        f"force, {force.name}",
        "along",
        "across",
        f"moment, {moment.name}",
    )
    rows = tuple(
        (
            percent(peaks.factor),
            number(peaks.bobweight_g),
            number(unbalance.of(peaks.counterweight)),
            number(force.of(peaks.force)),
            number(force.of(peaks.along)),
            number(force.of(peaks.across)),
            number(moment.of(peaks.moment)),
        )
        for peaks in sweep
    )
    note = (
        "Bobweight of the first pin; weight: the largest counterweight to add. What is left: the "
        "largest force, along and across the first bank; all orders."
    )
    return Grid("Largest values by factor", heads, rows, note=note)


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

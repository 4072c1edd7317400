"""Show further figures of a scheme: details, bobweight card, range of balance factors."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import chain
from math import isnan, nan
from typing import Any, NamedTuple

from ..core.records import Node, find_unit, remove_unit
from ..show.sheet import (
    NEGLIGIBLE,
    UNKNOWN,
    Column,
    Facts,
    Grid,
    degrees,
    number,
    size_text,
    unit_cell,
)
from ..show.units import ShownUnit, System
from ..sizing.bobweights import NO_THROW, PIN_ALONE, Bobweight, CardLine, FactorPeaks, PlaneNeed
from ..sizing.planes import find_unbalance, measure_direction
from .answer import Balance

# Keys of the roll without and with new devices. First pair: of inertia; second: inertia and gas.
_ROLLS = (
    ("roll_before_Nm", "roll_left_Nm"),
    ("roll_with_gas_before_Nm", "roll_with_gas_left_Nm"),
)
# Figures on the numerical solution, which appear only in JSON and CSV.
_FOR_PROGRAMS = {"condition_number", "relative_error_bound", "axial_distance_mm", "improvement"}
_NOTES_OF_CARD = {"throw"}  # sentences that stand below the bobweights


class _Figure(NamedTuple):
    """A figure of the details with its key. `group` is the key of the dict that holds the figure;
    empty if the details themselves hold it.
    """

    group: str
    key: str
    value: Any


def details_parts(result: Balance, system: System) -> Iterator[Grid | Facts]:
    """Yield the further figures, tables and notes of a scheme."""
    remedy = result.remedy
    details = [(_name(figure), _show(figure, system)) for figure in _choose_figures(result)]
    if details:
        yield Facts(tuple(details), "Details")
    compensators = tuple(_tell_compensators(result, system))
    if compensators:
        yield Facts(compensators, "Compensators")
    if remedy.needs:
        yield _needs_grid(remedy.needs, system)
    if remedy.card:
        yield from card_grids(remedy.card, system.scales)
    if remedy.sweep:
        sweep = remedy.sweep
        if not result.before.moments_known:
            sweep = tuple(replace(row, peak_moment_Nm=nan) for row in sweep)
        yield _sweep_grid(sweep, system)
    if optima := remedy.details.get("optima"):
        yield _optima_grid(optima)


def _tell_compensators(result: Balance, system: System) -> Iterator[tuple[str, str]]:
    """Yield position, force and unbalances of each compensator."""
    remedy = result.remedy
    for compensator in remedy.details.get("compensators", ()):
        position = compensator["position_mm"]
        pair = [shaft for shaft in remedy.shafts if shaft.position == position]
        mass = size_text(find_unbalance(pair[0]), system.unbalance)
        angles = " and ".join(f"{shaft.angle:.4f} deg (shaft {shaft.ratio:+d})" for shaft in pair)
        place = f"{number(system.length.of(position / 1e3))} {system.length.name}"
        force = size_text(compensator["force_N"], system.force)
        yield f"at z = {place}", f"force of {force}; 2 unbalances of {mass} at {angles}"


def tell_change(result: Balance, system: System) -> str:
    """Return in words the changes to a measured crankshaft for the wanted factor; empty without a
    measured mass or a wanted factor.
    """
    details = result.remedy.details
    changes = details.get("change")
    if not changes:
        return ""
    sizes = [change["unbalance_kg_m"] for change in changes]
    alike = all(abs(size - sizes[0]) <= 1e-9 * abs(sizes[0]) for size in sizes)
    steps = []
    for change, size in zip(changes, sizes, strict=True):
        pin = f"pin {change['throw']}"
        if alike:
            pin = "each pin" if len(sizes) > 1 else "the pin"
        mass = size_text(abs(size), system.unbalance)
        step = f"{change['action']} {mass} opposite {pin}"
        steps.append(step if size else f"change nothing at {pin}")
    has = percent(details["measured_factor"])
    wanted = percent(details["wanted_factor"])
    return f"The crank has the factor {has}; for {wanted}, {', '.join(dict.fromkeys(steps))}."


def tell_best_factors(result: Balance, system: System) -> str:
    """Return a sentence on the best factors and what they minimise; empty if no factor is best."""
    remedy = result.remedy
    best = []
    for name, figures in remedy.details.get("best", {}).items():
        key = next(key for key in figures if key != "factor")
        load = name.replace("_", " ")
        size = size_text(figures[key], system.force if find_unit(key) == "N" else system.moment)
        goal = f"peak {load}" if key.startswith("peak") else f"{load} load"
        best.append((percent(figures["factor"]), f"the smallest {goal} ({size})"))
    if not best:
        return ""
    factors = [row.factor for row in remedy.sweep] or [0.0, 1.0]
    (first, least), *more = best
    text = f"Between {percent(min(factors))} and {percent(max(factors))}"
    text += f" the factor {first} leaves {least}"
    for factor, goal in more:
        text += f", and {'also' if factor == first else factor} {goal}"
    return f"{text}."


def _list_figures(result: Balance) -> Iterator[_Figure]:
    """Yield the figures of the details one by one; tables are omitted."""
    for key, value in result.remedy.details.items():
        if isinstance(value, dict) and key != "best":
            for name, figure in value.items():
                yield _Figure(key, name, figure)
        elif key not in ("best", "optima", "change", "compensators"):
            yield _Figure("", key, value)


def _choose_figures(result: Balance) -> Iterator[_Figure]:
    """Yield the figures that tables show; figures that are not known are nan."""
    order = result.remedy.order
    about_crank = {*chain(*_ROLLS)}
    for figure in _list_figures(result):
        if figure.key in _FOR_PROGRAMS | _NOTES_OF_CARD:
            continue
        shown = figure
        moment = find_unit(shown.key) == "N·m" and shown.key not in about_crank
        if moment and not result.before.moments_known:
            shown = shown._replace(value=nan)
        if result.before.engine.gas is not None and shown.key in _ROLLS[0]:
            shown = shown._replace(key=shown.key.replace("roll", "roll_of_inertia"))
        states = {"left", "before", "after"}.intersection(shown.key.split("_"))
        if states and order and not shown.group:
            shown = shown._replace(group=f"order {order}")  # the figure is for this order only
        yield shown


def _name(figure: _Figure) -> str:
    label = f"{remove_unit(figure.group)} {remove_unit(figure.key).removesuffix('_g')}"
    return label.replace("_", " ").lstrip()


def _show(figure: _Figure, system: System) -> str:
    """Return a figure with its unit; a dash if it is not known."""
    value = figure.value
    if isinstance(value, str):
        return value
    if value == [] or (isinstance(value, float) and isnan(value)):
        return UNKNOWN
    if isinstance(value, list):
        return _show_list(value)
    return _show_number(figure, system)


def _show_list(values: list[Any]) -> str:
    """Return words, or angles in degrees."""
    if isinstance(values[0], str):
        return ", ".join(values)
    return f"{', '.join(map(degrees, values))} deg"


def _show_number(figure: _Figure, system: System) -> str:
    """Return a number with the unit that its key, or that of its group, names."""
    value = figure.value
    unit = find_unit(figure.key) or find_unit(figure.group)
    if figure.key.endswith("_g"):
        return f"{number(system.scales.of(value / 1e3))} {system.scales.name}"
    if unit == "deg":
        return f"{value + 0.0:.3f} deg".replace("-0.000", "0.000")
    if not unit:
        return percent(value) if figure.key.startswith("factor") else number(value)
    if unit == "kg·m":
        return size_text(value, system.unbalance)
    if unit == "mm":
        return size_text(value / 1e3, system.instead_of(unit))
    return size_text(value, system.instead_of(unit))


def tell_distances(result: Balance, system: System) -> Iterator[str]:
    """Yield a sentence on every pair of shafts whose roll depends only on their distance along the
    force.
    """
    for figures in result.remedy.details.values():
        if isinstance(figures, dict) and "distance_mm" in figures:
            distance = size_text(figures["distance_mm"] / 1e3, system.length)
            yield (
                f"{distance} apart along the force; only this distance counts: to the sides, the "
                "shafts may be anywhere, equally far from the crank on opposite sides."
            )


def tell_growing_rolls(result: Balance, system: System) -> Iterator[str]:
    """Yield a sentence for every order whose roll (of inertia; for an engine with gas, of inertia
    and gas) is larger with the new devices than without them.
    """
    remedy = result.remedy
    x, y, _ = result.before.engine.reference_m
    pivot = "the point of reference" if x or y else "the crankshaft"
    groups = {"": remedy.details}
    for key, value in remedy.details.items():
        if type(value) is dict:
            groups[key] = value
    for group, figures in groups.items():
        grown = []
        for before, left in _ROLLS:
            if before in figures:
                grown.append(_find_growth(figures[before], figures[left]))
        if not grown or grown[-1] <= 0:
            continue
        order = group.replace("_", " ") or f"order {remedy.order}"
        with_gas = " with gas" if len(grown) > 1 else ""
        why = f"the forces of the devices do not pass through {pivot}"
        if grown[0] < 0:
            why = "the devices cancel inertia roll that opposes the gas roll at this speed"
        size = size_text(grown[-1], system.moment)
        yield f"The roll of {order}{with_gas} grows by {size}: {why}."


def _find_growth(before: float, left: float) -> float:
    """Return by how much the second figure exceeds the first; 0 if that is negligible."""
    growth = left - before
    return growth if abs(growth) > NEGLIGIBLE * max(before, left) else 0.0


# ------------------------------------------------------------------ tables
def _needs_grid(needs: Sequence[PlaneNeed], system: System) -> Grid:
    """Return the table of the unbalance that each plane needs, has and lacks."""
    length = system.length
    series = {
        "wanted": [need.wanted for need in needs],
        "in the file": [need.present for need in needs],
        "missing": [need.missing for need in needs],
    }
    unit = system.unbalance.fit_values(map(abs, chain(*series.values())))
    heads = [Column(f"z, {length.name}", words=True)]
    for name in series:
        heads += [Column(name), Column("at, deg")]
    rows = []
    for need, *vectors in zip(needs, *series.values(), strict=True):
        row = [unit_cell(need.position_mm / 1e3, length)]
        for vector in vectors:
            row += [unit_cell(abs(vector), unit), _show_direction(vector)]
        rows.append(row)
    title = f"Present and missing unbalance of each plane, {unit.name}"
    return Grid.of_rows(title, heads, rows)


def _show_direction(unbalance: complex) -> str:
    return degrees(measure_direction(unbalance)) if unbalance else UNKNOWN


class _CardRow(NamedTuple):
    """Name, terms and sum of masses on a pin."""

    name: str
    terms: str
    grams: float


def card_grids(card: Sequence[Bobweight], *units: ShownUnit) -> Iterator[Grid]:
    """Yield tables of the masses in the bobweight of each pin, as quantity x each = sum; pins with
    equal masses share a table.

    Args:
        card: Bobweights of all pins.
        units: Units of mass, one column for each; terms of the sums use the first unit.
    """
    alike: dict[tuple[object, ...], list[Bobweight]] = {}
    for bobweight in card:
        throw = round(bobweight.throw_g, 6), bobweight.is_whole_throw
        alike.setdefault((bobweight.lines, *throw), []).append(bobweight)
    for pins in alike.values():
        heads = [Column("", words=True), Column("quantity × each")]
        heads += [Column(unit.name) for unit in units]
        rows = []
        for mass in _list_masses(pins[0], units[0]):
            sums = [unit_cell(mass.grams / 1e3, unit, 5) for unit in units]
            rows.append((mass.name, mass.terms, *sums))
        names = ", ".join("+".join(map(str, pin.cylinders)) for pin in pins)
        noun = "pins" if len(pins) > 1 else "pin"
        note = "" if pins[0].throw_g else f"The throw itself {NO_THROW}."
        if not pins[0].is_whole_throw:
            note = PIN_ALONE
        yield Grid.of_rows(f"Bobweight of {noun} {names}", heads, rows, note)


def _list_masses(pin: Bobweight, unit: ShownUnit) -> Iterator[_CardRow]:
    """Yield the rows of a pin."""
    yield from _list_terms(pin, unit, rotates=True)
    yield _CardRow("rotating sum", "", pin.rotating_g)
    yield from _list_terms(pin, unit, rotates=False)
    yield _CardRow("reciprocating sum", "", pin.reciprocating_g)
    whole = number(unit.of(pin.reciprocating_g / 1e3), 5)
    share = f"{whole} × {percent(pin.factor)}"
    yield _CardRow("balanced share", share, pin.factor * pin.reciprocating_g)
    yield _CardRow("bobweight (rotating + share)", "", pin.bobweight_g)
    if not pin.is_whole_throw:
        yield _CardRow("crank pin alone", "", pin.throw_g)
    elif pin.throw_g:
        yield _CardRow("throw itself, at the crank radius", "", pin.throw_g)
        yield _CardRow("counterweight opposite", "", pin.bobweight_g + pin.throw_g)


def _list_terms(pin: Bobweight, unit: ShownUnit, *, rotates: bool) -> Iterator[_CardRow]:
    """Yield the rotating or the reciprocating parts on a pin."""
    for line in pin.lines:
        if line.rotates == rotates and line.sum_g:
            yield _CardRow(line.part, _multiply(line, unit), line.sum_g)


def _multiply(line: CardLine, unit: ShownUnit) -> str:
    """Return the terms of a line's sum: `2 × 775`, or `775 + 780`."""
    masses = [number(unit.of(mass_g / 1e3)) for mass_g in line.each_g]
    if len(set(line.each_g)) == 1:
        return f"{len(masses)} × {masses[0]}"
    return " + ".join(masses)


def percent(share: float) -> str:
    """Return a balance factor in percent, as shops write it."""
    return f"{number(100 * share)} %"


def _sweep_grid(sweep: tuple[FactorPeaks, ...], system: System) -> Grid:
    unbalance = system.unbalance.fit_values(row.counterweight_kg_m for row in sweep)
    force = system.force
    heads = [
        Column("factor", words=True),
        Column(f"bobweight, {system.scales.name}"),
        Column(f"weight, {unbalance.name}"),
        Column(f"force, {force.name}"),
        Column("along"),
        Column("across"),
        Column(f"moment, {system.moment.name}"),
    ]
    rows = []
    for row in sweep:
        cells = (
            percent(row.factor),
            unit_cell(row.bobweight_g / 1e3, system.scales),
            unit_cell(row.counterweight_kg_m, unbalance),
            unit_cell(row.peak_force_N, force),
            unit_cell(row.along_N, force),
            unit_cell(row.across_N, force),
            unit_cell(row.peak_moment_Nm, system.moment),
        )
        rows.append(cells)
    note = (
        "Bobweight: of the first pin. Weight: largest counterweight to add. Force: largest force "
        "left, all orders added up. Along, across: largest components along and across bank 1."
    )
    return Grid.of_rows("Largest values by factor", heads, rows, note)


def _optima_grid(optima: Sequence[Node]) -> Grid:
    heads = [
        Column("design", words=True),
        Column("criterion"),
        Column("engine force"),
        Column("k"),
        Column("μ"),
        Column("largest, mrω²"),
        Column("mean, mrω²"),
    ]
    rows = []
    for optimum in optima:
        sizes = [f"{optimum[key]:.6f}" for key in ("mu", "largest", "mean")]
        criterion = (optimum["design"], optimum["criterion"], optimum["engine_force"])
        rows.append((*criterion, f"{optimum['k']:.5f}", *sizes))
    return Grid.of_rows("Optima of both designs", heads, rows)

"""Show further figures of a scheme: details, bobweight card, range of balance factors."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import chain
from math import isnan, nan
from typing import Any, NamedTuple

from ..core.records import Node, find_unit, remove_unit
from ..show.sheet import NEGLIGIBLE, UNKNOWN, Column, Facts, Grid, degrees, number, size_text
from ..show.units import ShownUnit, System
from ..sizing.bobweights import NO_THROW, Bobweight, CardLine, FactorPeaks, PlaneNeed
from ..sizing.planes import find_unbalance, measure_direction
from .answer import Balance

# Keys of the roll without and with new devices. First pair: of inertia; second: inertia and gas.
_ROLLS = (
    ("roll_before_Nm", "roll_left_Nm"),
    ("roll_with_gas_before_Nm", "roll_with_gas_left_Nm"),
)
# Figures on the numerical solution, which appear only in JSON and CSV.
_FOR_PROGRAMS = {"condition_number", "relative_error_bound", "axial_distance_mm", "improvement"}


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
    if details := tuple((_name(each), _show(each, system)) for each in _choose_figures(result)):
        yield Facts(details, "Details")
    if compensators := tuple(_tell_compensators(result, system)):
        yield Facts(compensators, "Compensators")
    if remedy.needs:
        yield _needs_grid(remedy.needs, system)
    if remedy.card:
        yield from card_grids(remedy.card, system.scales)
    if remedy.sweep:
        known = result.before.moments_known
        rows = (row if known else replace(row, peak_moment_Nm=nan) for row in remedy.sweep)
        yield _sweep_grid(tuple(rows), system)
    if optima := remedy.details.get("optima"):
        yield _optima_grid(optima)


def _tell_compensators(result: Balance, system: System) -> Iterator[tuple[str, str]]:
    """Yield position, force and unbalances of each compensator."""
    remedy = result.remedy
    for each in remedy.details.get("compensators", ()):
        pair = [shaft for shaft in remedy.shafts if shaft.position == each["position_mm"]]
        mass = size_text(find_unbalance(pair[0]), system.unbalance)
        angles = " and ".join(f"{shaft.angle:.4f} deg (shaft {shaft.ratio:+d})" for shaft in pair)
        place = f"{number(system.length.of(each['position_mm'] / 1e3))} {system.length.name}"
        force = size_text(each["force_N"], system.force)
        yield f"at z = {place}", f"force of {force}; 2 unbalances of {mass} at {angles}"


def tell_change(result: Balance, system: System) -> str:
    """Return in words the changes to a measured crankshaft for the wanted factor; empty without a
    measured mass or a wanted factor.
    """
    details = result.remedy.details
    unit = system.unbalance
    if not (changes := details.get("change")):
        return ""
    sizes = [one["unbalance_kg_m"] for one in changes]
    alike = all(abs(size - sizes[0]) <= 1e-9 * abs(sizes[0]) for size in sizes)
    everywhere = "each pin" if len(sizes) > 1 else "the pin"
    what = []
    for one, size in zip(changes, sizes, strict=True):
        pin = everywhere if alike else f"pin {one['throw']}"
        done = f"{one['action']} {size_text(abs(size), unit)} opposite {pin}"
        what.append(done if size else f"change nothing at {pin}")
    has = percent(details["measured_factor"])
    wanted = percent(details["wanted_factor"])
    return f"The crank has the factor {has}; for {wanted}, {', '.join(dict.fromkeys(what))}."


def tell_best_factors(result: Balance, system: System) -> str:
    """Return a sentence on the best factors and what they minimise; empty if no factor is best."""
    remedy = result.remedy
    told = []
    for name, one in remedy.details.get("best", {}).items():
        key = next(key for key in one if key != "factor")
        what = name.replace("_", " ")
        size = size_text(one[key], system.force if find_unit(key) == "N" else system.moment)
        goal = f"peak {what}" if key.startswith("peak") else f"{what} load"
        told.append((percent(one["factor"]), f"the smallest {goal} ({size})"))
    if not told:
        return ""
    factors = [row.factor for row in remedy.sweep] or [0.0, 1.0]
    (first, least), *more = told
    others = "".join(f", and {'also' if factor == first else factor} {x}" for factor, x in more)
    between = f"Between {percent(min(factors))} and {percent(max(factors))}"
    return f"{between} the factor {first} leaves {least}{others}."


def _list_figures(result: Balance) -> Iterator[_Figure]:
    """Yield the figures of the details one by one; tables are omitted."""
    for key, value in result.remedy.details.items():
        if isinstance(value, dict) and key != "best":
            yield from (_Figure(key, name, figure) for name, figure in value.items())
        elif key not in ("best", "optima", "change", "compensators"):
            yield _Figure("", key, value)


def _choose_figures(result: Balance) -> Iterator[_Figure]:
    """Yield the figures that tables show; figures that are not known are nan."""
    order = result.remedy.order
    about_crank = {*chain(*_ROLLS)}
    for each in _list_figures(result):
        if each.key in _FOR_PROGRAMS:
            continue
        moment = find_unit(each.key) == "N·m" and each.key not in about_crank
        if moment and not result.before.moments_known:
            each = each._replace(value=nan)
        if result.before.engine.gas is not None and each.key in _ROLLS[0]:
            each = each._replace(key=each.key.replace("roll", "roll_of_inertia"))
        states = {"left", "before", "after"}.intersection(each.key.split("_"))
        if states and order and not each.group:
            each = each._replace(group=f"order {order}")  # the figure is for this order only
        yield each


def _name(figure: _Figure) -> str:
    label = f"{remove_unit(figure.group)} {remove_unit(figure.key).removesuffix('_g')}"
    return label.replace("_", " ").lstrip()


def _show(figure: _Figure, system: System) -> str:
    """Return a figure with its unit; a dash if it is not known."""
    value = figure.value
    unit = find_unit(figure.key) or find_unit(figure.group)
    if isinstance(value, str):
        return value
    if value == [] or (isinstance(value, float) and isnan(value)):
        return UNKNOWN
    if isinstance(value, list):
        words = isinstance(value[0], str)
        return ", ".join(value) if words else f"{', '.join(map(degrees, value))} deg"
    if figure.key.endswith("_g"):
        return f"{number(system.scales.of(value / 1e3))} {system.scales.name}"
    if unit == "deg":
        return f"{value + 0.0:.3f} deg".replace("-0.000", "0.000")
    if not unit:
        return percent(value) if figure.key.startswith("factor") else number(value)
    shown = system.unbalance if unit == "kg·m" else system.instead_of(unit)
    return size_text(value / 1e3 if unit == "mm" else value, shown)


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
    groups = {"": remedy.details} | {k: v for k, v in remedy.details.items() if type(v) is dict}
    for group, figures in groups.items():
        known = [pair for pair in _ROLLS if pair[0] in figures]
        grown = [_find_growth(figures[before], figures[left]) for before, left in known]
        if not grown or grown[-1] <= 0:
            continue
        order = group.replace("_", " ") or f"order {remedy.order}"
        why = f"the forces of the devices do not pass through {pivot}"
        took = "the devices cancel inertia roll that opposes the gas roll at this speed"
        why = took if grown[0] < 0 else why
        gas = " with gas" * (len(grown) > 1)
        size = size_text(grown[-1], system.moment)
        yield f"The roll of {order}{gas} grows by {size}: {why}."


def _find_growth(before: float, left: float) -> float:
    """Return by how much the second figure exceeds the first; 0 if that is negligible."""
    return left - before if abs(left - before) > NEGLIGIBLE * max(before, left) else 0.0


# ------------------------------------------------------------------ tables
def _needs_grid(needs: Sequence[PlaneNeed], system: System) -> Grid:
    """Return the table of the unbalance that each plane needs, has and lacks."""
    length = system.length
    series = {
        "wanted": [need.wanted for need in needs],
        "in the file": [need.present for need in needs],
        "missing": [need.missing for need in needs],
    }
    unit = system.unbalance.fit(max(map(abs, chain(*series.values()))))
    places = [number(length.of(need.position_mm / 1e3)) for need in needs]
    columns = [Column(f"z, {length.name}", places, words=True)]
    for name, vectors in series.items():
        angles = [degrees(measure_direction(v)) if v else UNKNOWN for v in vectors]
        columns.append(Column(name, [number(unit.of(abs(vector))) for vector in vectors]))
        columns.append(Column("at, deg", angles))
    return Grid(f"Present and missing unbalance of each plane, {unit.name}", columns)


def card_grids(card: Sequence[Bobweight], *units: ShownUnit) -> Iterator[Grid]:
    """Yield tables of the masses in the bobweight of each pin, as quantity x each = sum; pins with
    equal masses share a table.

    Args:
        card: Bobweights of all pins.
        units: Units of mass, one column for each; terms of the sums use the first unit.
    """
    alike: dict[tuple[CardLine, ...], list[Bobweight]] = {}
    for bobweight in card:
        alike.setdefault(bobweight.lines, []).append(bobweight)
    for pins in alike.values():
        names = ", ".join("+".join(map(str, pin.cylinders)) for pin in pins)
        masses = list(_list_masses(pins[0], units[0]))
        columns = [
            Column("", [name for name, _, _ in masses], words=True),
            Column("quantity × each", [how for _, how, _ in masses]),
        ]
        for unit in units:
            sums = [number(unit.of(grams / 1e3), 5) for _, _, grams in masses]
            columns.append(Column(unit.name, sums))
        note = "" if pins[0].throw_g else f"The throw itself {NO_THROW}."
        yield Grid(f"Bobweight of pin{'s' * (len(pins) > 1)} {names}", columns, note)


def _list_masses(pin: Bobweight, unit: ShownUnit) -> Iterator[tuple[str, str, float]]:
    """Yield name, terms and sum (g) of the masses on a pin."""
    for rotates, name, total in (
        (True, "rotating", pin.rotating_g),
        (False, "reciprocating", pin.reciprocating_g),
    ):
        for line in pin.lines:
            if line.rotates == rotates and line.sum_g:
                yield line.part, _multiply(line, unit), line.sum_g
        yield f"{name} sum", "", total
    whole = number(unit.of(pin.reciprocating_g / 1e3), 5)
    share = f"{whole} × {percent(pin.factor)}"
    yield "balanced share", share, pin.factor * pin.reciprocating_g
    yield "bobweight (rotating + share)", "", pin.bobweight_g
    if pin.throw_g:
        yield "throw itself, at the crank radius", "", pin.throw_g
        yield "counterweight opposite", "", pin.bobweight_g + pin.throw_g


def _multiply(line: CardLine, unit: ShownUnit) -> str:
    """Return the terms of a line's sum: `2 × 775`, or `775 + 780`."""
    each = [number(unit.of(mass_g / 1e3)) for mass_g in line.each_g]
    if len(set(line.each_g)) == 1:
        return f"{len(each)} × {each[0]}"
    return " + ".join(each)


def percent(share: float) -> str:
    """Return a balance factor in percent, as shops write it."""
    return f"{number(100 * share)} %"


def _sweep_grid(sweep: tuple[FactorPeaks, ...], system: System) -> Grid:
    unbalance = system.unbalance.fit(max(abs(row.counterweight_kg_m) for row in sweep))
    scales = system.scales
    force = system.force
    moment = system.moment

    def write(unit: ShownUnit, sizes: Iterable[float]) -> list[str]:
        return [number(unit.of(size)) for size in sizes]

    bobweights = write(scales, (row.bobweight_g / 1e3 for row in sweep))
    weights = write(unbalance, (row.counterweight_kg_m for row in sweep))
    columns = [
        Column("factor", [percent(row.factor) for row in sweep], words=True),
        Column(f"bobweight, {scales.name}", bobweights),
        Column(f"weight, {unbalance.name}", weights),
        Column(f"force, {force.name}", write(force, (row.peak_force_N for row in sweep))),
        Column("along", write(force, (row.along_N for row in sweep))),
        Column("across", write(force, (row.across_N for row in sweep))),
        Column(f"moment, {moment.name}", write(moment, (row.peak_moment_Nm for row in sweep))),
    ]
    note = (
        "Bobweight: of the first pin. Weight: largest counterweight to add. Force: largest force "
        "left, all orders added up. Along, across: largest components along and across bank 1."
    )
    return Grid("Largest values by factor", columns, note)


def _optima_grid(optima: Sequence[Node]) -> Grid:
    columns = [
        Column("design", [optimum["design"] for optimum in optima], words=True),
        Column("criterion", [optimum["criterion"] for optimum in optima]),
        Column("engine force", [optimum["engine_force"] for optimum in optima]),
        Column("k", [f"{optimum['k']:.5f}" for optimum in optima]),
        Column("μ", [f"{optimum['mu']:.6f}" for optimum in optima]),
        Column("largest, mrω²", [f"{optimum['largest']:.6f}" for optimum in optima]),
        Column("mean, mrω²", [f"{optimum['mean']:.6f}" for optimum in optima]),
    ]
    return Grid("Optima of both designs", columns)

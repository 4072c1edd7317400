"""Show a balance: devices, their figures for the workshop, and free forces before and after."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..analysis.devices_show import (
    device_grid,
    device_rows,
    holes_grid,
    number_devices,
    practical_grid,
)
from ..analysis.ladder_show import ladder_grid, list_ladder, tell_usual
from ..analysis.order_tables import fit_largest
from ..analysis.overview import name_column
from ..analysis.parts import lay_out_parts
from ..analysis.verdict_words import VerdictWords, name_orders
from ..analysis.web_parts import write_ranges
from ..core.peaks import Peak
from ..core.records import Node, list_figures, remove_unit, to_document, write_each
from ..engine.engine import Engine
from ..errors import MOMENTS_UNKNOWN, ArgumentError, name_option, tell
from ..file.fields import counted, join_words
from ..forces.crankshaft import CrankLoads, find_crank_loads
from ..forces.kinds import FORCE, MOMENT, ROLL, ROLL_TOTAL
from ..forces.spectrum import compute_spectra
from ..show.figures import figure_rows
from ..show.formats import Columns, Renderer, Rows
from ..show.sheet import (
    NAMELESS,
    NEGLIGIBLE,
    NOTHING,
    UNKNOWN,
    Column,
    Facts,
    Grid,
    Sheet,
    Text,
    assumed_facts,
    degrees,
    number,
    order_name,
    sentence,
    size_cell,
    size_text,
    unit_cell,
)
from ..show.units import IMPERIAL, SI, ShownUnit, System
from ..sizing.factor import name_one_cylinder
from ..sizing.ladder import AS_DRAWN, WEIGHTS_AT_THROWS
from ..sizing.planes import find_unbalance, name_kind
from ..sizing.remedy import Remedy
from ..sizing.workshop import HoleRow
from .answer import Balance
from .scheme_show import (
    card_grids,
    details_parts,
    percent,
    tell_best_factors,
    tell_change,
    tell_distances,
    tell_growing_rolls,
)
from .web_show import lay_out_fitted

_TURNING_WEIGHTS = (
    "The pin stands still; the cylinders turn and carry the counterweights. Angles count from the "
    "axis of cylinder 1, which is over pin 1 at crank angle 0."
)
_ROUNDING = 1e-9  # a smaller share of a couple or of a length is rounding
_SIGNED = "Weighed by ____________________   Date ______________   Checked ________________"


def sheet(result: Balance, system: System) -> Sheet:
    """Return the printed page: devices with reasons, figures for the workshop, and both analyses
    side by side.
    """
    remedy = result.remedy
    engine = result.before.engine
    loads = [find_crank_loads(state.engine) for state in (result.before, result.after)]
    parts: list[Grid | Facts | Text] = [*assumed_facts(result.assumed)]
    if hasattr(result, "ladder"):
        usual = remedy.scheme == "auto"  # other schemes do not fit a step of the ladder
        parts.append(ladder_grid(result.ladder, engine, system, tell_fitted=usual))
    parts += lay_out_remedy(result, system)
    changes = [
        *_orders(result, system),
        *_peaks(result, system),
        *_crank_loads(loads, engine, system),
    ]
    parts += changes or [Text("Before and after", ("Nothing changes by 1 % or more.",))]
    return Sheet(f"{engine.name or NAMELESS}: {_name_fitted(remedy)}", tuple(parts))


def lay_out_remedy(
    result: Balance, system: System, *, with_table: bool = True
) -> Iterator[Grid | Facts | Text]:
    """Yield devices with reasons, figures for the workshop, notes and details.

    Args:
        result: Balance to show.
        system: System of units.
        with_table: Whether to include the table of devices.
    """
    if change := tell_change(result, system):
        yield Text("", (change,))
    yield from _lay_out_devices(result, system, with_table=with_table)
    if notes := tuple(filter(None, _list_notes(result, system))):
        yield Text("Note", notes)
    if not result.before.moments_known:
        yield Text("Forces only", (sentence(MOMENTS_UNKNOWN),))
    yield from _permitted(result, system)
    yield from lay_out_initial(result, system)
    yield from details_parts(result, system)


def _lay_out_devices(
    result: Balance, system: System, *, with_table: bool
) -> Iterator[Grid | Facts | Text]:
    """Yield the devices with their reasons, and their figures for the workshop."""
    remedy = result.remedy
    if remedy.webs:
        yield Text("Webs and reason", (remedy.web_reason,))
        yield from lay_out_fitted(result, system)
        if not remedy.devices:
            yield from lay_out_parts(result.parts, system)
    if remedy.reasons and not remedy.devices and not remedy.beyond:
        yield Text("Changes and reasons", remedy.reasons)
    elif remedy.reasons:
        yield Text("Fitted devices and reasons", tuple(dict.fromkeys(remedy.reasons)))
        if with_table:
            yield device_grid(remedy, system)
        yield practical_grid(remedy, result.practical, result.tools, result.misfits, system)
        if any(figures.holes for figures in result.practical):
            yield holes_grid(remedy, result.practical, result.tools, system)
        if hasattr(result, "parts"):
            yield from lay_out_parts(result.parts, system)
    elif remedy.beyond:
        beyond = "No engine file can describe these devices: see Details."
        yield Text("Fitted devices", (beyond,))
    elif not remedy.webs:
        yield Text("Nothing is fitted", ())


def _list_notes(result: Balance, system: System) -> Iterator[str]:
    """Yield notes on what the scheme does and leaves; those without meaning are empty."""
    remedy = result.remedy
    if remedy.note:
        yield sentence(tell(remedy.note, name_option))
    if hasattr(result, "ladder") and remedy.steps == ():
        yield tell_usual(result.ladder)
    if remedy.step or remedy.steps is not None:
        yield _tell_left(result, system)
    for left in remedy.moments_left:
        size = size_text(left.moment_Nm, system.moment)
        yield (
            f"The one eccentric of the shaft at {left.ratio:+d} leaves a moment of {size}; two "
            "eccentrics in different planes cancel it."
        )
    yield _tell_kept(result)
    yield _tell_couple(result, system)
    yield _tell_bearings(result, system)
    yield tell_best_factors(result, system)
    yield from tell_distances(result, system)
    if result.before.engine.rotary and remedy.counterweights:
        yield _TURNING_WEIGHTS
    yield from tell_growing_rolls(result, system)


def _name_fitted(remedy: Remedy) -> str:
    """Return in words what a remedy fits: steps of the ladder, or its scheme and order."""
    steps = (remedy.step,) if remedy.step else remedy.steps
    if steps is not None:
        return f"{join_words(steps) if steps else 'nothing'} ({remedy.scheme})"
    order = "" if remedy.order is None else f", order {remedy.order}"
    return f"{remedy.scheme}{order}"


def _tell_left(result: Balance, system: System) -> str:
    """Return words on the forces and moments of orders 1 and 2 that steps of the ladder leave."""
    moments_known = result.after.moments_known
    kinds = (FORCE, MOMENT) if moments_known else (FORCE,)
    spectra = compute_spectra(result.after.engine, [1, 2], [kind.name for kind in kinds])
    left = []
    for k, order in enumerate((1, 2)):
        sizes = []
        for kind in kinds:
            if size := float(spectra[kind.name].major[k]):
                sizes.append(f"{kind.name} {size_text(size, system.unit(kind))}")
        if sizes:
            left.append(f"order {order}: {', '.join(sizes)}")
    if left:
        return f"Leaves {'; '.join(left)}."
    return f"Leaves no {'force or moment' if moments_known else 'force'} of orders 1 and 2."


def _tell_couple(result: Balance, system: System) -> str:
    """Return words on the transverse couple if the devices do not change it; empty if the couple
    is negligible, or if the devices change it.
    """
    after = result.after
    if not hasattr(after, "verdict") or after.verdict.couple is None or _changes_couple(result):
        return ""
    words = VerdictWords(after.spectra, after.scales, system, after.engine)
    return f"{words.write_couple(after.verdict.couple)} No scheme changes the couple."


def _changes_couple(result: Balance) -> bool:
    """Return whether the devices change the transverse couple of any order."""
    before = result.before.spectra["couple"].x
    after = result.after.spectra["couple"].x
    largest = np.abs(before).max(initial=0.0)
    return bool(np.any(np.abs(after - before) > _ROUNDING * largest))


def _tell_kept(result: Balance) -> str:
    """Return that counterweights of the file stay, if steps of the ladder add others; else an empty
    text.
    """
    remedy = result.remedy
    of_ladder = bool(remedy.step) or remedy.steps is not None
    devices = result.before.engine.devices
    own = [device for device in devices if device.is_counterweight]
    if not (of_ladder and own and remedy.counterweights):
        return ""
    return "The counterweights of the file stay; those in the table are in addition."


def _tell_bearings(result: Balance, system: System) -> str:
    """Return in words by how much counterweights at every throw lower the largest main bearing
    load, if the scheme is counterweights and fits no counterweight; else return an empty text.
    """
    remedy = result.remedy
    steps = result.ladder.steps if hasattr(result, "ladder") else ()
    loads = {step.step: step.main_bearing_N for step in steps}
    before = loads.get(AS_DRAWN)
    after = loads.get(WEIGHTS_AT_THROWS)
    if remedy.scheme != "counterweights" or remedy.devices or not (before and after):
        return ""
    unit = system.unit(FORCE).fit(before)
    return (
        "Counterweights at every throw lower the largest main bearing load from "
        f"{number(unit.of(before))} to {number(unit.of(after))} {unit.name}."
    )


def _permitted(result: Balance, system: System) -> Iterator[Grid]:
    """Yield the table of permitted unbalance if a grade was given. The permitted unbalance is
    compared with the missing unbalance of existing counterweights, or shown as the tolerance of new
    counterweights.
    """
    if not hasattr(result, "permitted"):
        return
    remedy = result.remedy
    length = system.length
    permitted = result.permitted.each_g_mm / 1e6
    judge: Callable[[float, float], str]
    if remedy.needs:
        head = f"plane at z, {length.name}"
        figure = "missing"
        last = "of permitted"
        judge = _compare_with_permitted
        sizes = [abs(need.missing) for need in remedy.needs]
        names = [number(length.of(need.position_mm / 1e3)) for need in remedy.needs]
    elif result.permitted.planes_m:
        if not hasattr(result, "initial"):
            yield _permitted_in_planes(result, system)
        return
    else:
        head = "counterweight"
        figure = "unbalance"
        last = "tolerance"
        judge = _find_tolerance
        sizes = [find_unbalance(weight) for weight in remedy.counterweights]
        names = [str(k) for k in range(1, len(sizes) + 1)]
    unit = system.unbalance.fit_values(sizes)
    columns = [
        Column(head, names, words=True),
        Column(f"{figure}, {unit.name}", [number(unit.of(size)) for size in sizes]),
        Column(f"permitted, {unit.name}", [number(unit.of(permitted))] * len(sizes)),
        Column(last, [judge(size, permitted) for size in sizes]),
    ]
    yield Grid(_name_grade(result), columns, _tell_rotor(result, system))


def _name_grade(result: Balance) -> str:
    return f"Permitted residual unbalance, ISO 21940-11, G {result.permitted.grade:g}"


def _tell_rotor(result: Balance, system: System) -> str:
    """Return words on the rotor for which an unbalance is permitted."""
    mass = system.mass
    return (
        f"A crankshaft of {number(mass.of(result.permitted.mass_kg))} {mass.name} at "
        f"{result.before.engine.speed_rpm:g} rpm; all planes have equal shares."
    )


def _permitted_in_planes(result: Balance, system: System) -> Grid:
    """Return the table of the unbalance that a grade permits in each correction plane."""
    length = system.length
    permitted = result.permitted.each_g_mm / 1e6
    unit = system.unbalance.fit(permitted)
    heads = [
        Column(f"plane at z, {length.name}", words=True),
        Column(f"permitted, {unit.name}"),
    ]
    rows = []
    for place in result.permitted.planes_m:
        rows.append([unit_cell(place, length), unit_cell(permitted, unit)])
    return Grid.of_rows(_name_grade(result), heads, rows, _tell_rotor(result, system))


def lay_out_initial(result: Balance, system: System) -> Iterator[Grid]:
    """Yield the table of the initial unbalance in the correction planes, if the file has tolerances
    of webs; with a drill, whether the holes suffice.
    """
    if not hasattr(result, "initial"):
        return
    initial = result.initial
    length = system.length
    largest = []
    for plane in initial.planes:
        largest += [plane.worst_kg_m, plane.capacity_kg_m, plane.permitted_kg_m]
    unit = system.unbalance.fit_values(largest)
    heads = [
        Column(f"plane at z, {length.name}", words=True),
        Column("worst"),
        Column("rss"),
        Column("permitted"),
        Column("capacity"),
        Column("verdict", words=True),
    ]
    rows = []
    for plane in initial.planes:
        verdict = UNKNOWN
        if plane.enough is not None:
            verdict = "holes suffice" if plane.enough else "holes do not suffice"
        row = [
            unit_cell(plane.position_mm / 1e3, length),
            unit_cell(plane.worst_kg_m, unit),
            unit_cell(plane.rss_kg_m, unit),
            unit_cell(plane.permitted_kg_m, unit),
            unit_cell(plane.capacity_kg_m, unit),
            verdict,
        ]
        rows.append(row)
    title = f"Initial unbalance within the tolerances of the webs, {unit.name}"
    grid = Grid.of_rows(title, heads, rows, " ".join(_tell_initial(result, system)))
    known = [column for column in grid.columns if {*column.cells} != {UNKNOWN}]
    yield grid._replace(columns=known)


def _tell_initial(result: Balance, system: System) -> Iterator[str]:
    """Yield notes on the table of the initial unbalance."""
    initial = result.initial
    yield "Worst: all dimensions at their limits. Rss: root of the sum of squares."
    if initial.exact:
        noun = "webs" if len(initial.exact) > 1 else "web"
        yield f"Without tolerances, and counted as exact: {noun} {write_ranges(initial.exact)}."
    if initial.planes[0].permitted_kg_m is not None:
        yield f"Permitted: G {result.permitted.grade:g} of ISO 21940-11, in equal shares."
    rows = dict.fromkeys(initial.holes)
    for row in rows:
        length = system.length
        depth = size_text(row.depth, length)
        rim = size_text(row.rim, length)
        room = size_text(row.room, length)
        told = f"{counted(row.holes, 'hole')}, {depth} deep from a rim of {rim}, in {room}"
        yield f"Capacity: {told} along the crank{_tell_width(row, length)}."


def _tell_width(row: HoleRow, length: ShownUnit) -> str:
    """Return in words that a row of holes is wider than the web; empty if it is not."""
    if row.web is None or row.room <= row.web * (1 + _ROUNDING):
        return ""
    return f", wider than the web there, which is {size_text(row.web, length)} thick"


def _compare_with_permitted(missing: float, permitted: float) -> str:
    verdict = "over" if missing > permitted else "within"
    return f"{missing / permitted:.1%}, {verdict}"


def _find_tolerance(unbalance: float, permitted: float) -> str:
    """Return the permitted unbalance as a share of the unbalance of a new counterweight."""
    return f"±{permitted / unbalance:.2%}" if unbalance else "–"


# ------------------------------------------------------------------ before and after
def card_sheet(result: Balance, system: System) -> Sheet:
    """Return the bobweight card for the wall of a shop: masses in g and oz, then the counterweights
    to add, the holes to drill and the permitted unbalance.

    Raises:
        BalcliError: The scheme has no card.
    """
    remedy = result.remedy
    engine = result.before.engine
    if not remedy.card:
        raise ArgumentError(
            "{format} card: scheme {name} has no bobweight card; leave {scheme} out, or choose "
            "{scheme} factor",
            name=remedy.scheme,
        )
    factor = remedy.card[0].factor
    rods = len(remedy.card[0].cylinders)
    factor_text = f"{percent(factor)} of all reciprocating mass on the pin"
    if rods > 1:
        factor_text += f" = {percent(factor * rods)} of {name_one_cylinder(engine)}"
    parts: list[Grid | Facts | Text] = [Facts((("balance factor", factor_text),))]
    parts += card_grids(remedy.card, SI.scales, IMPERIAL.scales)
    if remedy.devices:
        what = "Still missing on the crankshaft" if remedy.needs else "Counterweights"
        parts.append(device_grid(remedy, system)._replace(title=what))
        if any(figures.holes for figures in result.practical):
            parts.append(holes_grid(remedy, result.practical, result.tools, system))
    if remedy.note:
        parts.append(Text("Note", (sentence(tell(remedy.note, name_option)),)))
    parts += _permitted(result, system)
    parts += lay_out_initial(result, system)
    parts.append(Text("", (_SIGNED,)))
    return Sheet(f"Bobweight card: {engine.name or NAMELESS}", tuple(parts))


def _find_changes(before: ArrayLike, after: ArrayLike) -> NDArray[np.bool_]:
    """Return whether each value changes by at least 1 % of the larger one of before and after;
    False for nan (not known).

    Args:
        before, after: Values of any shape, not negative.
    """
    change = np.abs(np.subtract(after, before))
    return (change > 0) & (change >= 0.01 * np.maximum(before, after))


def _tell_unchanged(values: Collection[str]) -> str:
    """Return a line that lists values as unchanged; empty if there are none."""
    return f"Unchanged within 1 %: {', '.join(values)}." if values else ""


def _orders(result: Balance, system: System) -> Iterator[Grid]:
    """Yield a table of the orders whose force, moment or roll changes, or of all given orders."""
    has_gas = result.before.engine.gas is not None
    kinds = (FORCE, MOMENT, ROLL_TOTAL if has_gas else ROLL)
    before = result.before.spectra.with_moment_if(result.before.moments_known)
    after = result.after.spectra.with_moment_if(result.after.moments_known)
    sizes = np.array([[before[kind.name].major, after[kind.name].major] for kind in kinds])
    scales = dict(result.before.of_one_cylinder)
    if has_gas:  # one cylinder gives no scale for the roll with gas
        scales[ROLL_TOTAL.name] = float(sizes[2].max())
    every = result.every_order
    least = [NEGLIGIBLE * scales[kind.name] for kind in kinds]
    small = (sizes < np.reshape(least, (-1, 1, 1))) & (not every)  # kind, state, order
    changed = (_find_changes(*sizes.swapaxes(0, 1)) & ~small.all(axis=1)) | every
    left = np.where(changed | small.any(axis=1), 0.0, sizes[:, 1])
    shown = np.flatnonzero(changed.any(axis=0))
    orders = [order_name(order) for order in result.before.orders[shown]]
    columns = [Column("order", orders, words=True)]
    unchanged = []
    for k, kind in enumerate(kinds):
        unit = fit_largest(system.unit(kind), before[kind.name], after[kind.name])
        if changed[k].any():
            heads = f"{name_column(kind)}, {unit.name}", "after"
            for head, values, tiny in zip(heads, sizes[k], small[k], strict=True):
                cells = [size_cell(float(values[n]), unit, negligible=tiny[n]) for n in shown]
                columns.append(Column(head, cells))
        if same := result.before.orders[left[k] > 0].tolist():
            most = size_text(float(left[k].max()), system.unit(kind))
            unchanged.append(f"{name_column(kind)} of {name_orders(same)} (at most {most})")
    if len(shown):
        title = "Largest value by order, before and after"
        yield Grid(title, columns, _tell_unchanged(unchanged))


def _peaks(result: Balance, system: System) -> Iterator[Grid]:
    """Yield a table of those largest values over a revolution that change."""
    rows = []
    unchanged: list[str] = []
    for (kind, before), (_, after) in zip(result.before.peaks, result.after.peaks, strict=True):
        if kind is MOMENT and not result.before.moments_known:
            continue
        if result.every_order or _find_changes(before.value, after.value):
            unit = system.unit(kind).fit(max(before.value, after.value))
            rows.append((f"{kind.name}, {unit.name}", *_peak(before, unit), *_peak(after, unit)))
        elif after.value > 0:
            unchanged.append(f"largest {kind.name} ({size_text(after.value, system.unit(kind))})")
    uneven = "Devices are sized for steady mean speed; both columns are for the uneven speed."
    if rows:
        notes = (_tell_unchanged(unchanged), uneven if result.before.engine.ripple else "")
        title = "Largest over a revolution, all orders"
        heads = _head_before_and_after("at, deg")
        yield Grid.of_rows(title, heads, rows, " ".join(filter(None, notes)))


def _head_before_and_after(place: str) -> tuple[Column, ...]:
    """Return the heads of a table of values and their places, before and after."""
    return (
        Column("", words=True),
        Column("before"),
        Column(place),
        Column("after"),
        Column(place),
    )


def _crank_loads(
    states: Sequence[CrankLoads | None], engine: Engine, system: System
) -> Iterator[Grid]:
    """Yield a table of those largest loads within the crankshaft that change."""
    rows = []
    for name, kind, key, place in (
        ("largest main bearing load", FORCE, "main_N", "main_mm"),
        ("largest inner moment", MOMENT, "inner_moment_Nm", "inner_mm"),
    ):
        sizes = []
        for state in states:
            size = getattr(state, key, None)
            sizes.append(np.nan if size is None else size)  # nan: not known
        if not _find_changes(*sizes):
            continue
        unit = system.unit(kind).fit(max(sizes))
        row = [f"{name}, {unit.name}"]
        for state, size in zip(states, sizes, strict=True):
            row.append(number(unit.of(size)))
            row.append(number(system.length.of(getattr(state, place) / 1e3)))
        rows.append(row)
    if rows:
        heads = _head_before_and_after(f"at z, {system.length.name}")
        bearings = _tell_assumed_bearings(states, engine)
        note = (
            f"Loads by inertia only{bearings}. Where several places have the largest value, the "
            "first is listed."
        )
        yield Grid.of_rows("Within the crankshaft", heads, rows, note)


def _tell_assumed_bearings(states: Sequence[CrankLoads | None], engine: Engine) -> str:
    """Return in words where bearings are assumed; empty if the file gives them, or if none carries
    a known load.
    """
    is_known = any(state is not None and state.main_N is not None for state in states)
    if engine.has_given_bearings or not is_known:
        return ""
    return "; bearings half-way between throws, and as far outside the end throws"


def _peak(peak: Peak, unit: ShownUnit) -> tuple[str, str]:
    if not peak.value:
        return NOTHING, ""
    at = degrees(float(np.degrees(peak.theta))) if peak.every else "any"
    return number(unit.of(peak.value)), at


# ------------------------------------------------------------------ JSON and CSV
def columns(result: Balance) -> Columns:
    """Return the columns of a DataFrame with a row for each new device: its keys in an engine file,
    and its figures for the workshop. The remaining forces are in `after`, an analysis with its own
    columns.
    """
    units: dict[str, str] = {"device": ""}
    lines: list[Node] = []
    for device, practical in zip(result.remedy.devices, result.practical, strict=True):
        line: Node = {"device": name_kind(device)}
        for name, value, unit in device_rows(device, SI):
            line[name] = value
            units[name] = unit
        for key, figure, unit in list_figures(to_document(practical), ("unbalance_kg_m",)):
            line[remove_unit(key)] = figure
            units[remove_unit(key)] = unit
        lines.append(line)
    values = {name: [line.get(name) for line in lines] for name in units}
    return Columns(values, {name: unit for name, unit in units.items() if unit})


def rows(result: Balance, system: System) -> Rows:
    """Return the rows of CSV, one for each figure: of the devices, of the scheme's details (as in
    JSON: SI, with the unit in the name), and of the engine without and with the devices.
    """
    header = ("part", "quantity", "order", "figure", "value", "unit")
    return Rows(header, _all_rows(result, system))


def _all_rows(result: Balance, system: System) -> Iterator[tuple[object, ...]]:
    devices = number_devices(result.remedy.devices)
    for (part, device), practical in zip(devices, result.practical, strict=True):
        for figure in device_rows(device, system):
            yield part, "", "", *figure
        yield from _rows_of(part, practical)
    yield from _rows_of("details", result.details)
    steps = (result.remedy.step,) if result.remedy.step else result.remedy.steps
    for name in steps or ():
        yield "step", "", "", "name", name, ""
    if hasattr(result, "ladder"):
        for step, name, value, unit in list_ladder(result.ladder):
            yield "ladder", step, "", name, value, unit
    yield from _rows_of("permitted", getattr(result, "permitted", None))
    yield from _rows_of("initial", getattr(result, "initial", None))
    yield from _rows_of("parts", getattr(result, "parts", None))
    for state, analysis in (("before", result.before), ("after", result.after)):
        for row in figure_rows(analysis, system):
            yield state, row.quantity, row.order, row.figure, row.value, row.unit
        if loads := find_crank_loads(analysis.engine):
            for name, value in write_each(loads).items():
                yield state, "bearings", "", name, value, ""


def _rows_of(part: str, record: object) -> Iterator[tuple[object, ...]]:
    """Yield the figures of a record; nothing if it is None."""
    for name, value in () if record is None else _with_paths(write_each(record)):
        yield part, "", "", name, value, ""


def _with_paths(value: object, path: str = "") -> Iterator[tuple[str, object]]:
    """Yield the members of tables and lists with their paths: `card.1.bobweight_g`."""
    if not isinstance(value, (dict, list)):
        yield path, value
        return
    for key, part in value.items() if isinstance(value, dict) else enumerate(value, 1):
        yield from _with_paths(part, f"{path}.{key}".lstrip("."))


RENDERER = Renderer(sheet=sheet, rows=rows, columns=columns)

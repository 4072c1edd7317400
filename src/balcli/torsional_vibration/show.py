"""Show the result of `balcli torsion` as tables (modes, criticals, Holzer's tables, forced
vibration over speed, sized damper) and as CSV.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterable, Iterator, Sequence
from operator import attrgetter
from typing import NamedTuple

import numpy as np

from ..core.records import (
    IN_CSV,
    Figure,
    Node,
    find_unit,
    list_figures,
    list_series,
    remove_unit,
    to_document,
)
from ..core.vibration import Real
from ..file.fields import counted
from ..show.engine_facts import list_silent
from ..show.formats import Renderer, Rows, name_cell
from ..show.sheet import (
    UNKNOWN,
    Column,
    Facts,
    Grid,
    Sheet,
    Text,
    assumed_facts,
    number,
    order_name,
    size_text,
)
from ..show.units import SI, ShownUnit, System
from .answer import BEYOND, HolzerTable, ThrowFormulas, TorsionAnalysis
from .dampers import DAMPER_KEYS, FIGURES, SizedDamper
from .measured import MeasuredCurve, MeasuredRow
from .response import Edge, TorsionResponse, WorstTorque
from .system import TorsionalSystem
from .verdicts import BarredRange, LimitVerdict, find_hardest_verdict
from .worst_misfire import MisfireCase, WorstMisfire

_MOST_MODES = 5  # largest number of shapes in a table; more do not fit into a terminal
_MOST_CRITICALS = 24  # largest number of listed criticals
_LEAST_SHARE = 0.01  # least share of work of a listed critical speed
_MOST_LISTED = 8  # largest number of orders, or shafts without a diameter, in one sentence
_MOST_OUTSIDE = 3  # number of critical speeds that are named on each side of the range
_MOST_MEASURED = 10  # largest number of measured points in a table
_MOST_ORDERS = 3  # number of orders that are listed for a shaft's torque
_LEAST_AMPLITUDE = 1e-3  # least amplitude of a listed order, as a share of the largest one


# ------------------------------------------------------------------ for programs
class Line(NamedTuple):
    """A line of the CSV of a torsional system; None is an empty cell."""

    part: str
    number: float | None = None
    speed_rpm: float | None = None
    order: float | None = None
    name: str = ""
    figure: str = ""
    value: float | bool | str | None = None
    unit: str = ""


def rows(result: TorsionAnalysis, system: System) -> Rows:
    """Return CSV with one figure in each row."""
    units = {} if system == SI else _choose_units(system)
    return Rows(Line._fields, (_convert(line, units) for line in _list_lines(to_document(result))))


def _choose_units(system: System) -> dict[str, ShownUnit]:
    """Return the units of `system` that replace SI units in CSV, by the names in CSV."""
    units = {}
    for name in (*System._fields, "torsional_damping", "torsional_stiffness"):
        in_si = getattr(SI, name).name.translate(IN_CSV)
        units[in_si] = getattr(system, name)
    return units | {"m": system.length}


def _convert(line: Line, units: dict[str, ShownUnit]) -> Line:
    """Return a row converted to these units."""
    if line.unit not in units or not isinstance(line.value, (int, float)):
        return line
    unit = units[line.unit]
    return line._replace(value=unit.of(line.value) + 0.0, unit=unit.name)


def _put(head: Line, figures: Iterable[Figure]) -> Iterator[Line]:
    """Yield a line of CSV for each of the figures, with the leading cells of `head`."""
    head = head._replace(name=name_cell(head.name))
    for each in figures:
        yield head._replace(figure=remove_unit(each.name), value=each.value, unit=each.unit)


def _list_lines(document: Node) -> Iterator[Line]:
    """Yield all lines of CSV."""
    for key in ("no_gas_in", "no_burning_in"):
        if key in document:
            yield Line("engine", figure=key, value=" ".join(map(str, document[key])))
    for part in ("node", "shaft"):
        for described in document[f"{part}s"]:
            yield from _put(Line(part, name=described["name"]), list_figures(described, ("name",)))
    for k, mode in enumerate(document["modes"], 1):
        yield from _put(Line("mode", k), list_figures(mode))
        for node, angle in zip(document["nodes"], mode["shape"], strict=True):
            yield from _put(Line("mode", k, name=node["name"]), [Figure("angle", angle, "")])
    for critical in document.get("criticals", ()):
        where = ("mode", "speed_rpm", "order")
        head = Line("critical", *(critical[key] for key in where))
        yield from _put(head, list_figures(critical, where))
    for critical in document.get("criticals_outside", ()):
        where = ("mode", "speed_rpm", "order")
        head = Line("critical_outside", *(critical[key] for key in where))
        yield from _put(head, list_figures(critical, where))
    yield from _list_extras(document)


def _list_extras(document: Node) -> Iterator[Line]:
    """Yield the lines of further requested parts: Holzer's tables, damper, response."""
    for k, table in enumerate(document.get("holzer", ()), 1):
        *frequency, residual = list_figures(table, ("mode", "rows"))
        yield from _put(Line("holzer", k), frequency)
        for row in table["rows"]:
            yield from _put(Line("holzer", k, name=row["node"]), list_figures(row, ("node",)))
        yield from _put(Line("holzer", k), [residual])
    if throw := document.get("throw"):
        yield from _put(Line("throw"), list_figures(throw))
    if damper := document.get("damper"):
        figures = list_figures(damper, ("node", "kind"))
        yield from _put(Line("damper", name=damper["node"]), figures)
    yield from _list_misfires(document.get("misfire", {}))
    yield from _list_response(document.get("response", {}))
    yield from _list_measured(document.get("measured", {}))
    yield from _list_limits(document.get("limits", ()))
    for k, ends in enumerate(document.get("barred_rpm", ()), 1):
        for key, end in zip(("from", "to"), ends, strict=True):
            yield Line("barred", k, figure=key, value=end, unit="rpm")


def _list_misfires(misfire: Node) -> Iterator[Line]:
    """Yield the lines of each misfire, and the line of the worst one."""
    for case in misfire.get("cases", ()):
        head = Line("misfire", case["cylinder"], case["speed_rpm"], name=case["shaft"])
        yield from _put(head, list_figures(case, ("cylinder", "shaft", "speed_rpm")))
    if misfire:
        yield Line("misfire", misfire["worst"], figure="worst", value=True)


def _list_limits(limits: Iterable[Node]) -> Iterator[Line]:
    """Yield the lines of each limit, and of the ranges in which it is exceeded."""
    for k, limit in enumerate(limits, 1):
        head = Line("limit", k, limit.get("speed_rpm"), name=limit["shaft"])
        yield from _put(head, list_figures(limit, ("shaft", "speed_rpm", "barred")))
        for span in limit.get("barred", ()):
            of_range = Line("barred", k, span["peak_rpm"], name=limit["shaft"])
            yield from _put(of_range, list_figures(span, ("peak_rpm", "rule_rpm")))
            for key, end in zip(("rule_from", "rule_to"), span.get("rule_rpm", ()), strict=False):
                yield from _put(of_range, [Figure(key, end, "rpm")])


def _list_measured(measured: Node) -> Iterator[Line]:
    """Yield the lines of a measured curve, and of its difference from the computed one."""
    if not measured:
        return
    for row in measured["rows"]:
        head = Line("measured", None, row["speed_rpm"], row["order"])
        yield from _put(head, list_figures(row, ("speed_rpm", "order")))
    yield from _put(Line("measured"), list_figures(measured, ("rows",)))


def _list_response(response: Node) -> Iterator[Line]:
    """Yield the lines for every speed, then lines for the largest values over all speeds."""
    if response:
        yield from _list_speeds(response)
        yield from _list_worst(response)


def _list_speeds(response: Node) -> Iterator[Line]:
    """Yield the lines for every speed."""
    shafts = response.get("shafts", ())
    dampers = response.get("dampers", ())
    pendulums = response.get("pendulums", ())
    for s, speed in enumerate(response.get("speeds_rpm", ())):
        head = Line("response", speed_rpm=speed)
        for torque in response.get("excitations", ()):
            of_torque = head._replace(name=torque["node"], order=torque["crank_order"])
            yield from _put(of_torque, list_series(torque, s))
        if "imep_Pa" in response:
            yield from _put(head, [Figure("imep", response["imep_Pa"][s], "Pa")])
        for shaft in shafts:
            yield from _put(head._replace(name=shaft["name"]), list_series(shaft, s))
        yield from _put(head, [Figure("free_end", response["free_end_deg"][s], "deg")])
        for damper in dampers:
            yield from _put(head._replace(name=damper["node"]), list_series(damper, s))
        for group in pendulums:
            swing = Figure("pendulums", group["half_swing_deg"][s], "deg")
            yield from _put(head._replace(name=group["node"]), [swing])


def _list_worst(response: Node) -> Iterator[Line]:
    """Yield the lines for the largest values over all speeds."""
    for part in (*response.get("shafts", ()), *response.get("dampers", ())):
        worst = part["worst"]
        head = Line("worst", None, worst["speed_rpm"], name=part.get("name") or part["node"])
        yield from _put(head, list_figures(worst, ("speed_rpm", "orders")))
        for share in worst.get("orders", ()):
            yield from _put(head._replace(order=share["order"]), list_figures(share, ("order",)))
    for group in response.get("pendulums", ()):
        yield from _put_swing("pendulums", group["node"], group["worst"])
    yield from _put_swing("free_end", "", response["free_end_worst"])


def _put_swing(figure: str, node: str, worst: Node) -> Iterator[Line]:
    """Yield the line of the largest swing of the pendulums at a node, or of the free end."""
    head = Line("worst", None, worst["speed_rpm"], worst.get("order"), name=node)
    figures = [Figure(figure, worst["half_swing_deg"], "deg")]
    if "edge" in worst:
        figures.append(Figure("edge", worst["edge"], ""))
    yield from _put(head, figures)


# ------------------------------------------------------------------ for people
def sheet(result: TorsionAnalysis, system: System) -> Sheet:
    """Return the sheet: modes first, then the requested parts."""
    parts: list[Grid | Facts | Text] = []
    if silent := tuple(list_silent(result.system.silent)):
        parts.append(Facts(silent))
    parts += assumed_facts(result.assumed)
    if hasattr(result, "damper"):
        limits = result.limits if hasattr(result, "limits") else ()
        parts.append(_show_damper(result.damper, limits, system))
    if hasattr(result, "misfire"):
        parts.append(show_misfires(result.misfire, system))
    if result.throw is not None:
        parts.append(show_throw(result, result.throw, system))
    parts += [show_modes(result), show_shapes(result, system)]
    if result.modes and hasattr(result, "criticals"):
        parts.append(show_criticals(result))
    parts += [show_holzer(result, table, system) for table in result.holzer or ()]
    if hasattr(result, "response"):
        parts.append(show_response(result, result.response, system))
        parts += show_excitations(result, result.response, system)
        parts += show_limits(result, system)
    if result.measured is not None:
        parts.append(show_measured(result, result.measured))
    return Sheet(f"{result.name or 'shafts without a name'}: torsion", tuple(parts))


def show_measured(result: TorsionAnalysis, curve: MeasuredCurve) -> Grid:
    """Return the points of a measured curve that differ most from the computed one."""
    farthest = sorted(curve.rows, key=_measure_miss, reverse=True)[:_MOST_MEASURED]
    heads = [Column("rpm", words=True), Column("order")]
    heads += [Column("measured, deg"), Column("computed, deg"), Column("difference, deg")]
    rows = []
    for row in farthest:
        amplitudes = (number(row.measured_deg), number(row.computed_deg))
        difference = number(row.computed_deg - row.measured_deg, 3)
        rows.append((number(row.speed_rpm), order_name(row.order), *amplitudes, difference))
    end = result.system.free_end
    points = counted(len(curve.rows), "measured point")
    note = f"Root mean square difference of {points}: {number(curve.rms_deg)} deg."
    if len(curve.rows) > len(farthest):
        note += f" The {len(farthest)} with the largest differences are shown."
    return Grid.of_rows(f"Measured amplitudes of {end}", heads, rows, note)


def _measure_miss(row: MeasuredRow) -> float:
    return abs(row.computed_deg - row.measured_deg)


_RING = ShownUnit("kg·mm²", 1e-6, SI.inertia, 1e7)


def _show_damper(sized: SizedDamper, limits: Sequence[LimitVerdict], system: System) -> Facts:
    """Return the figures of the sized damper, its effect on the largest stress, and whether the
    limits of all shafts are kept with it.
    """
    kind = system.stress if sized.measure == "stress" else system.moment
    unit = kind.fit_values((sized.before, sized.after))
    units = _choose_units(system)
    units["kg m2"] = _RING if system == SI else system.inertia
    pairs = [("on", sized.node)]
    for key, (name, size, label) in DAMPER_KEYS.items():
        if (value := getattr(sized, name)) is not None:
            shown = units.get(find_unit(name).translate(IN_CSV), ShownUnit("", 1)).fit(value)
            text = size_text(value, shown, 6).rstrip()
            if key == FIGURES[sized.kind]:
                start = number(shown.of(sized.start / size))
                text += f" (best for mode {sized.mode} alone: {start})"
            pairs.append((label, text))
    largest = f"largest {sized.measure}"
    pairs.append((f"{largest} without the damper", _tell_largest(sized.before, unit)))
    pairs.append((f"{largest} with it", _tell_largest(sized.after, unit)))
    if hardest := find_hardest_verdict(limits):
        pairs.append(("limit with it", _tell_limit(hardest, system)))
    if sized.heat_W:
        heat = size_text(sized.heat_W, system.heat)
        pairs.append(("heat", f"up to {heat}, at {number(sized.heat_rpm)} rpm"))
    return Facts(tuple(pairs), f"Sized: a {sized.kind} damper")


def _tell_limit(hardest: LimitVerdict, system: System) -> str:
    """Return in words whether a limit is kept, by the verdict on the shaft that uses it most."""
    if hardest.limit_Pa is None:
        limit = size_text(hardest.limit_Nm or 0.0, system.moment)
    else:
        limit = size_text(hardest.limit_Pa, system.stress)
    percent = number(100 * (hardest.share or 0.0), 3)
    used = f"{hardest.shaft} uses {percent} % of {limit} at {number(hardest.speed_rpm or 0.0)} rpm"
    if hardest.verdict == "passes":
        return f"kept: {used}"
    return f"exceeded: {used}; try another inertia (--damper-inertia) or kind"


def _tell_largest(size: float, unit: ShownUnit) -> str:
    if not math.isfinite(size):
        return "without bound"
    return f"±{number(unit.of(size))} {unit.name}"


def show_misfires(misfire: WorstMisfire, system: System) -> Grid:
    """Return the largest load of a shaft with each misfire."""
    torque = system.moment.fit(max(case.torque_Nm or 0.0 for case in misfire.cases))
    stress = system.stress.fit(0.0)
    first = misfire.cases[0]
    if first.share is not None:
        figure = "share"
    elif first.stress_Pa is not None:
        figure = stress.name
    else:
        figure = f"± {torque.name}"
    heads = [
        Column("cylinder"),
        Column(figure),
        Column("shaft", words=True),
        Column("at rpm"),
    ]
    rows = []
    for case in misfire.cases:
        row = (str(case.cylinder), _size_case(case, stress, torque), case.shaft)
        rows.append((*row, number(case.speed_rpm)))
    note = (
        f"Worst: cylinder {misfire.worst}. The results below are those without firing in this "
        "cylinder."
    )
    return Grid.of_rows("Largest value of any shaft, one cylinder not firing", heads, rows, note)


def _size_case(case: MisfireCase, stress: ShownUnit, torque: ShownUnit) -> str:
    """Return the largest load with a misfire, without its unit."""
    if case.share is not None:
        return f"{case.share:.0%}"
    if case.stress_Pa is not None:
        return number(stress.of(case.stress_Pa))
    return number(torque.of(case.torque_Nm or 0.0))


def show_throw(result: TorsionAnalysis, throw: ThrowFormulas, system: System) -> Grid:
    """Return the stiffness of the throws by each formula, and what is used."""
    stiffness = system.torsional_stiffness
    first = result.modes[0].frequency_Hz if result.modes else math.nan
    used = {"mean": "mean, used", "file": "file, used"}
    lines = [
        ("Ker Wilson", throw.ker_wilson_Nm_per_rad, throw.ker_wilson_mode_1_Hz),
        ("Carter", throw.carter_Nm_per_rad, throw.carter_mode_1_Hz),
    ]
    if throw.used in used:
        lines.append((used[throw.used], throw.used_Nm_per_rad, first))
    names = {"Ker Wilson": "ker-wilson", "Carter": "carter"}
    rows = []
    for name, size, hertz in lines:
        formula = f"{name}, used" if names.get(name) == throw.used else name
        figures = [math.nan if value is None else value for value in (size, hertz)]
        rows.append((formula, number(stiffness.of(figures[0])), number(figures[1])))
    heads = [Column("formula", words=True), Column(stiffness.name), Column("mode 1, Hz")]
    note = "Journal and pin overlap, so Ker Wilson's formula does not hold."
    if throw.spread is not None:
        note = f"The formulas differ by {100 * throw.spread:.2g} %."
    note += " Measured crankshafts differ from both by about 10 to 15 %."
    return Grid.of_rows("Throw stiffness from dimensions", heads, rows, note)


def show_modes(result: TorsionAnalysis) -> Grid | Text:
    if not result.modes:
        return Text("Natural modes", ("None: no inertia can swing on a shaft.",))
    heads = [
        Column("mode", words=True),
        Column("Hz"),
        Column("1/min"),
        Column("nodes"),
        Column("node in", words=True),
    ]
    rows = []
    for mode in result.modes:
        places = [*mode.node_in, *(f"at {name}" for name in mode.node_at)]
        row = (
            str(mode.number),
            number(mode.frequency_Hz, 6),
            number(mode.frequency_Hz * 60, 6),
            str(mode.nodes),
            ", ".join(places) or UNKNOWN,
        )
        rows.append(row)
    note = "Node in: shafts whose ends turn against each other."
    note += _name_left_out(result.system, ".")
    return Grid.of_rows("Natural modes", heads, rows, note)


def show_shapes(result: TorsionAnalysis, system: System) -> Grid:
    nodes = result.nodes
    inertias = [node.inertia_kg_m2 or math.nan for node in nodes]
    columns = [
        Column("node", [node.name for node in nodes], words=True),
        Column(system.inertia.name, [number(system.inertia.of(each)) for each in inertias]),
    ]
    if any(node.gear != 1 for node in nodes):
        columns.append(Column("gear", [number(node.gear) for node in nodes]))
    for mode in result.modes[:_MOST_MODES]:
        angles = [f"{angle + 0.0:.4f}" for angle in mode.shape.round(4).tolist()]
        columns.append(Column(f"mode {mode.number}", angles))
    note = "Actual angle of each inertia, not reduced to the crank; the largest is 1."
    note += _count_in_json(len(result.modes) - _MOST_MODES, "mode")
    return Grid("Inertias and shapes", columns, note)


def _count_in_json(left: int, what: str) -> str:
    """Return a note on the rows or columns that only JSON has; "" if there are none."""
    return f" JSON has {counted(left, f'more {what}')}." if left > 0 else ""


def show_criticals(result: TorsionAnalysis) -> Grid | Text:
    title = "Critical speeds"
    if hasattr(result, "response"):
        title += f", {_name_span(result.response.speeds_rpm)}"
    scope = _name_scope(result)
    criticals = result.criticals
    outside = _name_outside(result)
    if not criticals:
        none = f"None: no order meets a mode that it drives. {scope}{outside}"
        return Text(title, (none,))
    large = [critical for critical in criticals if critical.work_share >= _LEAST_SHARE]
    shown = large[:_MOST_CRITICALS]
    heads = [
        Column("mode", words=True),
        Column("order"),
        Column("rpm"),
        Column("phase sum"),
        Column("share"),
    ]
    rows = []
    for critical in shown:
        row = (
            str(critical.mode),
            order_name(critical.order),
            number(critical.speed_rpm),
            number(critical.phase_sum),
            f"{critical.work_share:.1%}",
        )
        rows.append(row)
    note = f"Sorted by work. Share: part of all work done on that mode. {scope}"
    note += _count_in_json(len(criticals) - len(shown), "critical speed")
    return Grid.of_rows(title, heads, rows, note + outside)


def _name_outside(result: TorsionAnalysis) -> str:
    """Return a note on the critical speeds with most work just outside the range of speeds."""
    if not hasattr(result, "criticals_outside"):
        return ""
    first = float(result.response.speeds_rpm[0])
    below = [each for each in result.criticals_outside if each.speed_rpm < first]
    above = [each for each in result.criticals_outside if each.speed_rpm > first]
    named = []
    for side in (below, above):
        for critical in sorted(side, key=attrgetter("work"))[-_MOST_OUTSIDE:]:
            named.append(critical)
    named.sort(key=attrgetter("speed_rpm"))
    speeds = []
    for critical in named:
        order = order_name(critical.order)
        speeds.append(f"{number(critical.speed_rpm)} rpm (mode {critical.mode}, order {order})")
    return f" Just outside: {', '.join(speeds)}." if speeds else ""


def _name_scope(result: TorsionAnalysis) -> str:
    """Return a note on the orders, speeds, dampers and torques behind the critical speeds."""
    rated = result.system.rated_rpm
    note = f"Included: {_list_orders(result.orders)}."
    note += _name_left_out(result.system, ", which shift the critical speeds.")
    if hasattr(result, "response"):
        return note
    if rated:
        note += f" Up to {number(BEYOND * rated)} rpm, {BEYOND:g} × the file's speed."
    return note + _name_gas(result)


def _list_orders(orders: Sequence[float]) -> str:
    """Return the orders by name; if there are many, only the first and the last."""
    if len(orders) > _MOST_LISTED:
        return f"{len(orders)} orders, {order_name(orders[0])} to {order_name(orders[-1])}"
    word = "orders" if len(orders) > 1 else "order"
    return f"{word} {', '.join(map(order_name, orders))}"


def _name_left_out(system: TorsionalSystem, end: str) -> str:
    """Return a note on the dampers that modes and criticals ignore."""
    dampers = []
    if system.rings:
        dampers.append("viscous rings")
    if system.pendulums:
        dampers.append("pendulums")
    return f" Excluded: {' and '.join(dampers)}{end}" if dampers else ""


def show_holzer(result: TorsionAnalysis, table: HolzerTable, system: System) -> Grid:
    inertia = system.inertia
    stiffness = system.torsional_stiffness
    angles = [row.angle for row in table.rows]
    torques = [row.torque_Nm for row in table.rows]
    sums = [row.sum_Nm for row in table.rows]
    unit = system.moment.fit_values((*torques, *sums))
    heads = [
        Column("node", words=True),
        Column(f"J, {inertia.name}"),
        Column("angle"),
        Column("J ω² angle"),
        Column("sum"),
        Column(f"k, {stiffness.name}"),
        Column("twist"),
    ]
    lines = []
    for row in table.rows:
        has_shaft = row.stiffness_Nm_per_rad != 0  # the last node has none
        rigidity = row.stiffness_Nm_per_rad if has_shaft else math.nan
        line = (
            row.node,
            number(inertia.of(row.inertia_kg_m2)),
            number(_settle(row.angle, angles), 6),
            number(unit.of(_settle(row.torque_Nm, torques))),
            number(unit.of(_settle(row.sum_Nm, torques))),
            number(stiffness.of(rigidity)).replace("inf", "rigid"),
            number(row.twist if has_shaft else math.nan),
        )
        lines.append(line)
    what = f"mode {table.mode}" if table.mode else "trial"
    omega = 2 * np.pi * table.frequency_Hz
    title = f"Holzer's table, {what}: {number(omega, 7)} rad/s; torques in {unit.name}"
    left = f"{size_text(_settle(table.residual_Nm, torques), system.moment, 5)}."
    if result.system.chain.clamped[table.end]:
        end = table.rows[table.end]
        angle = number(_settle(end.angle, angles), 6)
        left = f"an angle of {angle} at {end.node}, which is fixed."
    return Grid.of_rows(title, heads, lines, f"Left over at the end: {left}")


def _settle(value: float, others: Sequence[float]) -> float:
    """Return an angle or torque, or 0 if it is a rounding error compared with others."""
    return 0.0 if abs(value) <= 1e-9 * sum(map(abs, others)) else value


def show_response(
    result: TorsionAnalysis, response: TorsionResponse, system: System
) -> Grid | Text:
    span = _name_span(response.speeds_rpm)
    worst = _describe_worst(result, response, system)
    if not response.shafts:
        return Text(f"Vibration, {span}", (worst + _describe_edges(result, response),))
    unit = system.moment.fit(max(_add_amplitudes(shaft.worst) for shaft in response.shafts))
    stress = system.stress.fit(0.0)
    with_stress = any(result.system.stress_by_torque)
    heads = [
        Column("shaft", words=True),
        Column(f"± {unit.name}"),
        Column("at rpm"),
        Column(f"sum, {unit.name}"),
    ]
    if with_stress:
        heads.append(Column(stress.name))
    heads.append(Column("largest orders", words=True))
    rows = []
    for shaft in response.shafts:
        most = shaft.worst
        row = [
            shaft.name,
            number(unit.of(most.half_peak_to_peak_Nm)),
            f"{_MARKS[most.edge]}{number(most.speed_rpm)}",
            number(unit.of(_add_amplitudes(most))),
        ]
        if with_stress:
            row.append(number(math.nan if most.stress_Pa is None else stress.of(most.stress_Pa)))
        row.append(_name_orders(most, unit))
        rows.append(row)
    note = (
        "±: half of peak to peak at the worst speed, all orders added with their phases. sum: sum "
        f"of their amplitudes, too large because orders do not peak together. {worst}"
        f"{_name_gas(result, ' The gas torque is the same at every speed.')}"
        f"{_describe_edges(result, response)}"
    )
    return Grid.of_rows(f"Vibratory torque, {span}", heads, rows, note)


def show_excitations(
    result: TorsionAnalysis, response: TorsionResponse, system: System
) -> Iterator[Text]:
    """Yield a line for each torque on a node, at the rated speed if that is one of the speeds,
    otherwise at the last speed.
    """
    if not response.excitations:
        return
    speeds = response.speeds_rpm
    rated = result.system.rated_rpm or 0.0
    rpm = rated if speeds[0] <= rated <= speeds[-1] else float(speeds[-1])
    lines = []
    unknown = False
    for shown, torque in zip(response.excitations, result.system.torques, strict=True):
        size = size_text(float(torque.amplitude(np.array(rpm))), system.moment)
        phase = "phase not known"
        if torque.turn is not None:
            turns = math.copysign(1, result.system.gears[torque.node])
            angle = math.degrees(-turns * cmath.phase(torque.turn))
            phase = f"phase {number(angle % 360)}°"
        else:
            unknown = True
        name = f"{shown.node}, order {order_name(shown.order)}"
        at_crank = f"crank order {order_name(shown.crank_order)}"
        lines.append(f"{name} ({at_crank}): ±{size} at {number(rpm)} rpm, {phase}.")
    if unknown:
        lines.append("What a torque without a known phase causes is added in the worst phase.")
    yield Text("Torques on nodes", tuple(lines))


# What the speed of a largest value is marked with at an end of the range.
_MARKS: dict[Edge | None, str] = {None: "", "first": "< ", "last": "> "}


def _describe_edges(result: TorsionAnalysis, response: TorsionResponse) -> str:
    """Return sentences on the shafts whose largest value is at an end of the range of speeds."""
    edges = [(shaft.name, shaft.worst.edge) for shaft in response.shafts]
    edges.append((f"swing of {result.system.free_end}", response.free_end_worst.edge))
    sentences = ""
    advice = ""
    for end, place, side in (("first", "lowest", "below"), ("last", "highest", "above")):
        names = [name for name, edge in edges if edge == end]
        if names:
            speed = number(float(response.speeds_rpm[0 if end == "first" else -1]))
            if len(names) > _MOST_LISTED:
                names[_MOST_LISTED:] = ["..."]
            sentences += (
                f" Largest at {speed} rpm, the {place} speed: {', '.join(names)}; {side}, more may "
                "occur."
            )
            advice = " Widen the range of speeds."
    return sentences + advice


def _add_amplitudes(torque: WorstTorque) -> float:
    """Return the sum of the amplitudes of all orders."""
    return sum(order.amplitude_Nm for order in torque.orders)


def _name_span(ends: Sequence[float] | Real) -> str:
    low = number(float(ends[0]))
    high = number(float(ends[-1]))
    return f"{low} rpm" if ends[0] == ends[-1] else f"{low} to {high} rpm"


def _name_gas(result: TorsionAnalysis, included: str = "") -> str:
    """Return `included` if gas torque is included, else a note that it is not; "" for a chain."""
    excitation = result.system.excitation
    if excitation is None or not excitation.growing.any():
        return ""
    if excitation.gas is not None:
        return included.replace("the same at every", "computed for each")
    alone = " Inertia only; gas torque is not included."
    return included if excitation.steady.any() else alone


def _describe_worst(result: TorsionAnalysis, response: TorsionResponse, system: System) -> str:
    """Return sentences on the largest swing of free end and pendulums, and the largest heat of
    dampers.
    """
    free_end = response.free_end_worst.half_swing_deg
    speed = response.free_end_worst.speed_rpm
    parts = [(f"{result.system.free_end} swings by ±{number(free_end)} deg", speed)]
    for pendulums in response.pendulums or ():
        largest = pendulums.worst
        swing = f"swing by ±{number(largest.half_swing_deg)} deg, most in order {largest.order:g},"
        parts.append((f"The pendulums of {pendulums.node} {swing}", largest.speed_rpm))
    for each in response.dampers or ():
        heat = f"up to {size_text(each.worst.heat_W, system.heat)} into heat"
        parts.append((f"The damper of {each.node} turns {heat}", each.worst.speed_rpm))
    return " ".join(f"{what} at {number(speed)} rpm." for what, speed in parts)


def _name_orders(torque: WorstTorque, unit: ShownUnit) -> str:
    """Return the largest orders of a shaft's torque and their amplitudes in this unit."""
    falling = sorted(torque.orders, key=attrgetter("amplitude_Nm"), reverse=True)
    largest = falling[0].amplitude_Nm if falling else 0.0
    named = []
    for torque_order in falling[:_MOST_ORDERS]:
        if torque_order.amplitude_Nm > _LEAST_AMPLITUDE * largest:
            amplitude = number(unit.of(torque_order.amplitude_Nm), 3)
            named.append(f"{order_name(torque_order.order)}: {amplitude}")
    return ", ".join(named)


def show_limits(result: TorsionAnalysis, system: System) -> Iterator[Grid | Facts | Text]:
    """Yield the verdicts on shafts, the barred ranges of each, and the barred speeds of all."""
    if hasattr(result, "limits"):
        yield _show_verdicts(result, system)
        if ranges := _show_ranges(result):
            yield ranges
    if hasattr(result, "barred_rpm"):
        ends = result.response.speeds_rpm
        spans = ", ".join(_name_barred(span, ends) for span in result.barred_rpm)
        facts = [("barred speeds", spans or "none in this range")]
        if result.system.angle_limit is not None:
            limit = number(math.degrees(result.system.angle_limit))
            facts.insert(0, ("limit", f"±{limit} deg at {result.system.free_end}"))
        yield Facts(tuple(facts))


def _show_verdicts(result: TorsionAnalysis, system: System) -> Grid | Text:
    """Return the verdict on each limit; the note names shafts that are not checked or fail."""
    checked = [verdict for verdict in result.limits if verdict.share is not None]
    title = f"Limits, {_name_span(result.response.speeds_rpm)}"
    note = " ".join((*_name_unchecked(result.limits), *_name_failures(result.limits)))
    if not checked:
        return Text(title, (note,))
    torque = system.moment.fit(max(verdict.limit_Nm or 0.0 for verdict in checked))
    ruled = any(verdict.rule for verdict in checked)
    heads = [
        Column("shaft", words=True),
        Column("largest"),
        Column("limit"),
        Column("unit", words=True),
        Column("at rpm"),
        Column("share"),
        Column("verdict", words=True),
    ]
    if ruled:
        heads.insert(1, Column("rule", words=True))
    rows = []
    for verdict in checked:
        row = _show_verdict(verdict, system.stress.fit(0.0), torque)
        if ruled:
            row.insert(1, verdict.rule or UNKNOWN)
        rows.append(row)
    return Grid.of_rows(title, heads, rows, note)


def _show_verdict(verdict: LimitVerdict, stress: ShownUnit, torque: ShownUnit) -> list[str]:
    """Return the row of a limit, without its rule."""
    stressed = verdict.kind == "stress"
    unit = stress if stressed else torque
    value = verdict.value_Pa if stressed else verdict.value_Nm
    limit = verdict.limit_Pa if stressed else verdict.limit_Nm
    return [
        verdict.shaft,
        number(unit.of(value or 0.0)),
        number(unit.of(limit or 0.0)),
        unit.name,
        number(verdict.speed_rpm or 0.0),
        f"{verdict.share:.0%}",
        verdict.verdict,
    ]


def _name_unchecked(verdicts: Iterable[LimitVerdict]) -> Iterator[str]:
    """Yield a sentence for each reason why shafts are not checked."""
    reasons: dict[str, list[str]] = {}
    for verdict in verdicts:
        if verdict.share is None:
            reasons.setdefault(verdict.reason or "", []).append(verdict.shaft)
    for reason, names in reasons.items():
        named = names[:_MOST_LISTED]
        if len(names) > _MOST_LISTED:
            named.append("...")
        yield f"{', '.join(named)}: not checked ({reason})."


def _name_failures(verdicts: Iterable[LimitVerdict]) -> Iterator[str]:
    """Yield a sentence for each limit that fails."""
    for verdict in verdicts:
        if verdict.verdict == "fails":
            yield f"{verdict.shaft} fails: {verdict.reason}."


def _show_ranges(result: TorsionAnalysis) -> Grid | None:
    """Return the barred ranges of each limit; None if there are none."""
    ruled = any(verdict.rule and verdict.barred for verdict in result.limits)
    heads = [
        Column("shaft", words=True),
        Column("rpm", words=True),
        Column("peak"),
        Column("share"),
    ]
    if ruled:
        heads += [Column("transient"), Column("M68 range, rpm", words=True)]
    kinds = {verdict.kind for verdict in result.limits if verdict.barred}
    mixed = len(kinds) > 1
    if mixed:
        heads.insert(1, Column("limit", words=True))
    rows = []
    for verdict in result.limits:
        for span in verdict.barred or ():
            row = [verdict.shaft, _name_range(span), number(span.peak_rpm), f"{span.share:.0%}"]
            if mixed:
                row.insert(1, verdict.kind or "")
            if ruled:
                share = span.transient_share
                row.append(UNKNOWN if share is None else f"{share:.0%}")
                row.append(UNKNOWN if span.rule_rpm is None else _name_ends(span.rule_rpm))
            rows.append(row)
    return Grid.of_rows("Barred speeds", heads, rows, "") if rows else None


def _name_barred(span: tuple[float, float], speeds_rpm: Real) -> str:
    """Return a range of barred speeds in words; it is open where the speeds end."""
    low, high = span
    below = low <= speeds_rpm[0]
    above = high >= speeds_rpm[-1]
    if below and not above:
        return f"below {number(high)} rpm"
    return f"above {number(low)} rpm" if above and not below else _name_span(span)


def _name_range(span: BarredRange) -> str:
    """Return a barred range in words; a side on which only the speeds end is open."""
    if span.open == "both":
        return f"all from {number(span.from_rpm)} to {number(span.to_rpm)}"
    if span.open == "below":
        return f"below {number(span.to_rpm)}"
    if span.open == "above":
        return f"above {number(span.from_rpm)}"
    return _name_ends((span.from_rpm, span.to_rpm))


def _name_ends(ends: tuple[float, float]) -> str:
    return f"{number(ends[0])} to {number(ends[1])}"


RENDERER = Renderer(sheet=sheet, rows=rows)

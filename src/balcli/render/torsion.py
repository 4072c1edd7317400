"""What a person reads of torsional vibration: modes, criticals, Holzer's tables, forced vibration
over speed, and a damper that was sized.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from ..core.vibration import Real
from ..torsion.analysis import BEYOND, HolzerTable, TorsionAnalysis
from ..torsion.damper_sizing import SizedDamper
from ..torsion.response import TorsionResponse
from ..torsion.system import Excitation, TorsionalSystem
from .engine_facts import list_silent
from .sheet import Facts, Grid, Sheet, Text, number, order_name, size_text
from .torsion_document import DAMPER_UNITS, choose_units, convert_to_si, document, rows
from .units import SI, ShownUnit, System

__all__ = ["document", "rows", "sheet"]

_MOST_MODES = 5  # shown with their shapes: more do not fit into a terminal
_MOST_CRITICALS = 12  # shown: those that do most work
_MOST_BARE = 8  # shafts without a diameter that are named
_MOST_ORDERS = 3  # of a shaft's torque, named beside it


def sheet(result: TorsionAnalysis, system: System) -> Sheet:
    """Modes first, then what was asked."""
    parts: list[Grid | Facts | Text] = []
    if silent := list_silent(result.system.silent):
        parts.append(Facts(tuple(silent)))
    if result.damper is not None:
        parts.append(_damper(result.damper, system))
    parts += [_modes(result), _shapes(result, system)]
    excitation = result.system.excitation
    if result.modes and excitation is not None and len(excitation.orders):
        parts.append(_criticals(result, excitation))
    parts += [_holzer(result, table, system) for table in result.holzer]
    if result.response is not None:
        parts.append(_response(result, result.response, system))
        if limits := tuple(_judge_limits(result, system)):
            parts.append(Facts(limits, "Limits"))
    return Sheet(f"{result.system.name or 'shafts without a name'}: torsion", tuple(parts))


_DAMPER_LABELS = {
    "inertia": "ring",
    "damping": "damping",
    "stiffness": "stiffness",
    "loss": "loss factor",
    "mass": "pendulums, in all",
    "radius": "hung up at a radius of",
    "length": "length to the centre of mass",
}
_RING = ShownUnit("kg·mm²", 1e-6, SI.inertia, 1e7)


def _damper(sized: SizedDamper, system: System) -> Facts:
    """What to make, and what it does."""
    finite = [value for value in (sized.before, sized.after) if not math.isinf(value)]
    kind = system.stress if sized.measure == "stress" else system.moment
    unit = kind.fit(max(finite))
    before = "without bound" if math.isinf(sized.before) else _tell_swings(sized.before, unit)
    pairs, units = [("on", sized.node)], choose_units(system) | {"": ShownUnit("", 1)}
    units["kg m2"] = _RING if system == SI else system.inertia
    for key, value in sized.damper.model_dump(exclude={"kind"}, exclude_none=True).items():
        own = convert_to_si(key, value)
        shown = units[DAMPER_UNITS[key]].fit(own)
        told = size_text(own, shown, 6).rstrip()
        if key == sized.figure:
            alone = number(shown.of(convert_to_si(key, sized.start)))
            told += f" (best for mode {sized.mode} alone: {alone})"
        pairs.append((_DAMPER_LABELS[key], told))
    pairs.append((f"largest {sized.measure} with none there", before))
    pairs.append((f"largest {sized.measure} with it", _tell_swings(sized.after, unit)))
    if sized.heat:
        heat = size_text(sized.heat, system.heat)
        pairs.append(("heat", f"up to {heat}, at {number(sized.heat_rpm)} rpm"))
    return Facts(tuple(pairs), f"Sized: a {sized.damper.kind} damper")


def _tell_swings(amplitude: float, unit: ShownUnit) -> str:
    return f"±{number(unit.of(amplitude))} {unit.name}"


def _modes(result: TorsionAnalysis) -> Grid | Text:
    if not result.modes:
        return Text("Natural modes", ("None: nothing has inertia that could swing on a shaft.",))
    rows = tuple(
        (
            str(mode.number),
            number(mode.frequency_hz, 6),
            number(mode.frequency_hz * 60, 6),
            str(mode.nodes),
            ", ".join([*mode.still, *(f"at {name}" for name in mode.at_rest)]) or "–",
        )
        for mode in result.modes
    )
    note = "Node in: the shafts whose ends turn against each other."
    if result.system.rings:
        note += " Rings in oil are left out, as if they were not there."
    if result.system.pendulums and result.system.rings:
        note += " So are pendulums, which follow the order."
    elif result.system.pendulums:
        note += " Pendulums are left out; they follow the order."
    return Grid(
        "Natural modes", ("mode", "Hz", "1/min", "nodes", "node in"), rows, note, words=(0, 4)
    )


def _shapes(result: TorsionAnalysis, system: System) -> Grid:
    shown = result.modes[:_MOST_MODES]
    geared = bool(np.any(result.system.gears != 1))
    heads = [
        "node",
        system.inertia.name,
        *["gear"] * geared,
        *(f"mode {mode.number}" for mode in shown),
    ]
    rows = []
    for k, name in enumerate(result.system.nodes):
        inertia = system.inertia.of(float(result.system.chain.inertia[k]))
        cells = [name, number(inertia) if inertia else "–"]
        cells += [number(float(result.system.gears[k]))] * geared
        rows.append((*cells, *(f"{round(float(mode.shape[k]), 4) + 0.0:.4f}" for mode in shown)))
    note = "Angle of each node by itself, the largest 1."
    left = len(result.modes) - len(shown)
    if left:
        note += f" JSON has {left} mode{'s' * (left > 1)} more."
    return Grid("Inertias and shapes", tuple(heads), tuple(rows), note)


def _criticals(result: TorsionAnalysis, excitation: Excitation) -> Grid | Text:
    span = "" if result.response is None else f", {_tell_span(result.response)}"
    title, scope = f"Critical speeds{span}", _tell_scope(result, excitation)
    if not result.criticals:
        return Text(title, (f"None: no order meets a mode that it drives. {scope}",))
    shown = result.criticals[:_MOST_CRITICALS]
    rows = tuple(
        (
            str(each.mode),
            order_name(each.order),
            number(each.speed_rpm),
            number(each.phase_sum, 4),
            f"{each.work_share:.1%}",
        )
        for each in shown
    )
    note = f"Those that do most work first; share: of all work done on the mode. {scope}"
    left = len(result.criticals) - len(shown)
    if left:
        note += f" JSON has {left} more."
    return Grid(title, ("mode", "order", "rpm", "phase sum", "share"), rows, note)


def _tell_scope(result: TorsionAnalysis, excitation: Excitation) -> str:
    """Which orders, speeds, dampers and torques critical speeds are of."""
    several = "s to" * (len(excitation.orders) > 1)
    note = f"Of order{several} {order_name(float(excitation.orders.max()))}."
    rated = result.system.rated_rpm
    if result.response is None and rated:
        note += f" To {number(BEYOND * rated)} rpm, {BEYOND:g} times the file's."
    elif result.response is None:
        note += " At any speed: the file gives none."
    system = result.system
    dampers = ["rings in oil"] * bool(system.rings) + ["pendulums"] * bool(system.pendulums)
    if dampers:
        note += f" Without {' and '.join(dampers)}, which shift them."
    if system.pendulums:
        note += " The order that pendulums are tuned to meets modes in which their node is at rest."
    if result.response is None:
        note += _tell_gas(result)
    return note


def _holzer(result: TorsionAnalysis, asked: HolzerTable, system: System) -> Grid:
    table, chain = asked.table, result.system.chain
    inertia, stiffness = system.inertia, system.torsional_stiffness
    unit = system.moment.fit(float(np.abs([table.torque, table.total]).max()))
    rows = tuple(
        (
            name,
            number(inertia.of(float(chain.inertia[k]))),
            number(_settle(table.angle[k], table.angle), 6),
            number(unit.of(_settle(table.torque[k], table.torque))),
            number(unit.of(_settle(table.total[k], table.torque))),
            _stiffness(stiffness.of(float(table.stiffness[k]))),
            number(float(table.twist[k]), 4) if table.stiffness[k] else "–",
        )
        for k, name in enumerate(result.system.nodes)
    )
    what = f"mode {asked.mode}" if asked.mode else "trial"
    title = f"Holzer's table, {what}: {number(asked.omega, 7)} rad/s; torques in {unit.name}"
    residual = _settle(table.residual, table.torque)
    left = f"Left over at the end: {size_text(residual, system.moment, 5)}."
    if chain.clamped[asked.end]:
        name, angle = result.system.nodes[asked.end], _settle(table.angle[asked.end], table.angle)
        left = f"Left over at the end: the angle of {name}, which is fixed, {number(angle, 6)}."
    heads = (
        "node",
        f"J, {inertia.name}",
        "angle",
        "J ω² angle",
        "sum",
        f"k, {stiffness.name}",
        "twist",
    )
    return Grid(title, heads, rows, left)


def _stiffness(value: float) -> str:
    return "rigid" if np.isinf(value) else number(value) if value else "–"


def _settle(value: float, beside: Real) -> float:
    """An angle or torque, as 0 where it is what rounding left over of those beside it."""
    return 0.0 if abs(value) <= 1e-9 * float(np.abs(beside).sum()) else float(value)


def _response(result: TorsionAnalysis, response: TorsionResponse, system: System) -> Grid | Text:
    span = _tell_span(response)
    if not result.system.shafts:
        return Text(f"Vibration, {span}", (_tell_swing(result, response),))
    rows, worst = [], response.worst
    unit = system.moment.fit(float(worst.sums.max()))
    stress = system.stress.fit(0.0)
    stressed = bool(np.any(np.isfinite(response.stress)))
    for k, name in enumerate(result.system.shafts):
        cells = [
            name,
            number(unit.of(float(worst.torque[k]))),
            number(float(worst.speeds_rpm[k])),
            number(unit.of(float(worst.sums[k]))),
        ]
        if stressed:
            cells.append(number(stress.of(float(worst.stress[k])), 4))
        rows.append((*cells, _name_orders(response, k, unit)))
    heads = [
        "shaft",
        f"± {unit.name}",
        "at rpm",
        f"sum, {unit.name}",
        *[stress.name] * stressed,
        "largest orders",
    ]
    title, note = f"Vibratory torque, {span}", _explain_response(result, response, system)
    return Grid(title, tuple(heads), tuple(rows), note, words=(0, len(heads) - 1))


def _explain_response(result: TorsionAnalysis, response: TorsionResponse, system: System) -> str:
    """What the torques are, how far the first node swings, and what dampers turn to heat."""
    note = (
        "Largest half of peak to peak, orders added up in time; sum: of their amplitudes, which "
        f"do not peak together. {_tell_swing(result, response)}"
    )
    note += _tell_gas(result, " Gas as in the file at every speed.")
    for k, name in enumerate(response.dampers):
        note += (
            f" The damper of {name.removesuffix(' ring')} turns up to "
            f"{size_text(float(response.worst.heat[k]), system.heat)} to heat, at "
            f"{number(float(response.worst.hottest_rpm[k]))} rpm."
        )
    return note


def _tell_span(response: TorsionResponse) -> str:
    return _tell_range(float(response.speeds_rpm[0]), float(response.speeds_rpm[-1]))


def _tell_range(low: float, high: float) -> str:
    return f"{number(low)} rpm" if low == high else f"{number(low)} to {number(high)} rpm"


def _tell_gas(result: TorsionAnalysis, where_counted: str = "") -> str:
    """What an engine's gas has to do with it: it stays as it is, whatever the speed, or there is
    none; nothing of a chain.
    """
    excitation = result.system.excitation
    if excitation is None or not excitation.growing.any():
        return ""
    alone = " Of inertia alone: the torque of the gas is not in this."
    return where_counted if excitation.steady.any() else alone


def _tell_swing(result: TorsionAnalysis, response: TorsionResponse) -> str:
    """The largest swing of the first node and of pendulums, and where."""
    worst = response.worst
    swing = number(float(np.degrees(worst.free_end)), 4)
    told = f"{result.system.nodes[0]} swings by ±{swing} deg at {number(worst.swing_rpm)} rpm."
    for k, pendulums in enumerate(result.system.pendulums):
        swing = number(float(np.degrees(worst.pendulums[k])), 4)
        told += (
            f" The pendulums of {result.system.nodes[pendulums.node]} swing by ±{swing} deg at "
            f"{number(float(worst.pendulum_rpm[k]))} rpm."
        )
    return told


def _name_orders(response: TorsionResponse, shaft: int, unit: ShownUnit) -> str:
    """The largest orders of a shaft's torque with their amplitudes in this unit."""
    sizes = response.worst.amplitudes[:, shaft]
    largest = np.argsort(-sizes, kind="stable")[:_MOST_ORDERS]
    return ", ".join(
        f"{order_name(float(response.orders[k]))}: {number(unit.of(float(sizes[k])), 3)}"
        for k in largest
        if sizes[k] > 1e-3 * sizes.max()
    )


def _judge_limits(result: TorsionAnalysis, units: System) -> Iterator[tuple[str, str]]:
    """The limits of the file, and which speeds pass them."""
    system, limits = result.system, []
    stress = "" if system.limit_pa is None else size_text(system.limit_pa, units.stress, None)
    if stress and any(system.sections):
        limits.append(stress)
    if system.angle_limit is not None:
        limits.append(f"±{number(float(np.degrees(system.angle_limit)))} deg at {system.nodes[0]}")
    if limits:
        yield "limit", " and ".join(limits)
        yield "barred speeds", _list_barred(result)
    if stress and stress not in limits:
        yield "not judged", f"{stress}: no shaft has a diameter, so that no stress is known"
    elif stress and (bare := list(_list_unjudged(system))):
        named = ", ".join(bare[:_MOST_BARE]) + ", ..." * (len(bare) > _MOST_BARE)
        yield "not judged", f"{named}: no diameter, so that no stress is known"


def _list_unjudged(system: TorsionalSystem) -> Iterator[str]:
    """Shafts that twist and have no diameter; rubber is none."""
    rings = set(system.nodes[system.last + 1 :])
    each = zip(system.shafts, system.sections, system.chain.stiffness, strict=True)
    for name, section, stiffness in each:
        if section is None and math.isfinite(stiffness) and name not in rings:
            yield name


def _list_barred(result: TorsionAnalysis) -> str:
    """Ranges of speed, and whether the file's own is among them."""
    barred, own = result.barred_rpm or (), result.system.rated_rpm
    told = ", ".join(_tell_range(low, high) for low, high in barred) or "none in this range"
    if own is not None and any(low <= own <= high for low, high in barred):
        told += f"; the file's own speed, {number(own)} rpm, is barred"
    return told

"""What a program reads of torsional vibration: JSON, and the same figures as CSV."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from ..core.vibration import Real
from ..torsion.analysis import HolzerTable, TorsionAnalysis
from ..torsion.damper_sizing import SizedDamper
from ..torsion.modes import NaturalMode
from ..torsion.response import TorsionResponse
from ..torsion.system import TorsionalSystem
from .csv import Rows, name_cell
from .figures import clean, clean_each, clean_finite, silent_entries
from .sheet import order_number
from .units import SI, ShownUnit, System

# Endings of keys in JSON, by the units of CSV.
_ENDINGS = {
    "": "",
    "kg m2": "_kg_m2",
    "N m s/rad": "_Nms_per_rad",
    "N m/rad": "_Nm_per_rad",
    "kg": "_kg",
    "m": "_m",
    "Pa": "_Pa",
    "N m": "_Nm",
    "W": "_W",
    "rpm": "_rpm",
}
# SI units of a damper's figures, and how many of a file's units they are.
DAMPER_UNITS = {
    "inertia": "kg m2",
    "damping": "N m s/rad",
    "stiffness": "N m/rad",
    "loss": "",
    "mass": "kg",
    "radius": "m",
    "length": "m",
}
_IN_FILE = {"kg m2": 1e6, "m": 1e3}
_HEADER = ("part", "number", "speed_rpm", "order", "name", "figure", "value", "unit")


def document(result: TorsionAnalysis) -> dict[str, Any]:
    """`balcli.torsion/1`, SI units."""
    system = result.system
    found: dict[str, Any] = {
        "format": "balcli.torsion/1",
        "name": system.name or None,
        **silent_entries(system.silent),
        "nodes": [
            {"name": name, "inertia_kg_m2": clean(inertia), "gear": clean(gear)}
            for name, inertia, gear in zip(
                system.nodes, system.chain.inertia, system.gears, strict=True
            )
        ],
        "shafts": [
            {"name": name, "stiffness_Nm_per_rad": clean_finite(stiffness)}
            for name, stiffness in zip(system.shafts, system.chain.stiffness, strict=True)
        ],
        "modes": [
            {
                "frequency_Hz": clean(mode.frequency_hz),
                "shape": clean_each(mode.shape),
                "nodes": mode.nodes,
                "node_in": list(mode.still),
                "node_at": list(mode.at_rest),
                "loss": clean(mode.loss),
            }
            for mode in result.modes
        ],
    }
    if system.excitation is not None:
        found["criticals"] = [
            {
                "mode": each.mode,
                "order": order_number(each.order),
                "speed_rpm": clean(each.speed_rpm),
                "phase_sum": clean(each.phase_sum),
                "work_share": clean(each.work_share),
            }
            for each in result.criticals
        ]
    if result.holzer:
        found["holzer"] = [_holzer_document(result, table) for table in result.holzer]
    if result.response is not None:
        found["response"] = _response_document(result, result.response)
    if result.damper is not None:
        found["damper"] = _damper_document(result.damper)
    if result.barred_rpm is not None:
        found["barred_rpm"] = [[clean(low), clean(high)] for low, high in result.barred_rpm]
    return found


def _holzer_document(result: TorsionAnalysis, asked: HolzerTable) -> dict[str, Any]:
    columns = _list_holzer(result, asked)
    rows = [
        {"node": node}
        | {name + _ENDINGS[unit]: clean_finite(values[k]) for name, unit, values in columns}
        for k, node in enumerate(result.system.nodes)
    ]
    mode = {} if asked.mode is None else {"mode": asked.mode}
    frequency = {"frequency_Hz": clean(asked.omega / (2 * np.pi))}
    return mode | frequency | {"rows": rows, "residual_Nm": clean(asked.table.residual)}


def _list_holzer(result: TorsionAnalysis, asked: HolzerTable) -> tuple[tuple[str, str, Real], ...]:
    """Columns of Holzer's table: name, unit, a value a node."""
    table = asked.table
    return (
        ("inertia", "kg m2", result.system.chain.inertia),
        ("angle", "", table.angle),
        ("torque", "N m", table.torque),
        ("sum", "N m", table.total),
        ("stiffness", "N m/rad", table.stiffness),
        ("twist", "", table.twist),
    )


def _response_document(result: TorsionAnalysis, response: TorsionResponse) -> dict[str, Any]:
    shafts, worst = [], response.worst
    for k, name in enumerate(result.system.shafts):
        entry: dict[str, Any] = {
            "name": name,
            "half_peak_to_peak_Nm": clean_each(response.torque[:, k]),
            "sum_of_amplitudes_Nm": clean_each(response.sums[:, k]),
        }
        stress = {}
        if result.system.sections[k] is not None:
            entry["stress_Pa"] = clean_each(response.stress[:, k])
            stress = {"stress_Pa": clean(worst.stress[k])}
        entry["worst"] = {
            "speed_rpm": clean(worst.speeds_rpm[k]),
            "half_peak_to_peak_Nm": clean(worst.torque[k]),
            **stress,
            "orders": [
                {"order": order_number(float(order)), "amplitude_Nm": clean(amplitude)}
                for order, amplitude in zip(response.orders, worst.amplitudes[:, k], strict=True)
            ],
        }
        shafts.append(entry)
    found: dict[str, Any] = {
        "speeds_rpm": clean_each(response.speeds_rpm),
        "shafts": shafts,
        "free_end_deg": clean_each(np.degrees(response.free_end)),
        "free_end_worst": {
            "speed_rpm": clean(worst.swing_rpm),
            "half_swing_deg": clean(np.degrees(worst.free_end)),
        },
    }
    if response.dampers:
        found["dampers"] = [
            {
                "node": name.removesuffix(" ring"),
                "heat_W": clean_each(response.heat[:, k]),
                "worst": {
                    "speed_rpm": clean(worst.hottest_rpm[k]),
                    "heat_W": clean(worst.heat[k]),
                },
            }
            for k, name in enumerate(response.dampers)
        ]
    if result.system.pendulums:
        found["pendulums"] = [
            {
                "node": result.system.nodes[each.node],
                "half_swing_deg": clean_each(np.degrees(response.pendulums[:, k])),
                "worst": {
                    "speed_rpm": clean(worst.pendulum_rpm[k]),
                    "half_swing_deg": clean(np.degrees(worst.pendulums[k])),
                },
            }
            for k, each in enumerate(result.system.pendulums)
        ]
    return found


def _damper_document(sized: SizedDamper) -> dict[str, Any]:
    """The damper as an engine or chain file has it, in SI, and what it does."""
    doubts = {"doubts": list(sized.doubts)} if sized.doubts else {}
    return {
        "node": sized.node,
        "kind": sized.damper.kind,
        **{name + _ENDINGS[unit]: value for name, unit, value in _list_damper(sized)},
        **doubts,
    }


def _list_damper(sized: SizedDamper) -> Iterator[tuple[str, str, float | None]]:
    """Figures of a damper, and what it does: name, unit, value."""
    for name, unit in DAMPER_UNITS.items():
        if (value := getattr(sized.damper, name)) is not None:
            yield name, unit, clean(convert_to_si(name, value))
    measured = "Pa" if sized.measure == "stress" else "N m"
    yield "mode", "", sized.mode
    yield "before", measured, clean_finite(sized.before)
    yield "after", measured, clean(sized.after)
    yield "heat", "W", clean(sized.heat)
    yield "heat", "rpm", clean(sized.heat_rpm)


def convert_to_si(name: str, value: float) -> float:
    """A figure of a damper, which a file has in units of its own."""
    return value / _IN_FILE.get(DAMPER_UNITS[name], 1.0)


def rows(result: TorsionAnalysis, system: System) -> Rows:
    """Every figure of the document a row."""
    lines, units = _lines(result), choose_units(system)
    return Rows(_HEADER, lines if system == SI else (_convert(line, units) for line in lines))


Line = tuple[Any, ...]


def choose_units(system: System) -> dict[str, ShownUnit]:
    """What people read in place of SI units of CSV."""
    return {
        "kg m2": system.inertia,
        "N m s/rad": system.torsional_damping,
        "N m/rad": system.torsional_stiffness,
        "kg": system.mass,
        "m": system.length,
        "Pa": system.stress,
        "N m": system.moment,
        "W": system.heat,
    }


def _convert(line: Line, units: dict[str, ShownUnit]) -> Line:
    """A row in the units of people who do not read SI."""
    *where, value, name = line
    if name not in units or value is None:
        return line
    return (*where, clean(units[name].of(value)), units[name].name)


def _lines(result: TorsionAnalysis) -> Iterator[Line]:
    for key, numbers in silent_entries(result.system.silent).items():
        yield "engine", None, None, None, "", key, " ".join(map(str, numbers)), ""
    yield from _system_lines(result.system)
    for number, mode in enumerate(result.modes, 1):
        yield from _mode_lines(number, mode, result.system)
    for each in result.criticals:
        order = order_number(each.order)
        where = ("critical", each.mode, clean(each.speed_rpm), order, "")
        yield *where, "phase_sum", clean(each.phase_sum), ""
        yield *where, "work_share", clean(each.work_share), ""
    for number, asked in enumerate(result.holzer, 1):
        yield from _holzer_lines(number, result, asked)
    if result.damper is not None:
        node = name_cell(result.damper.node)
        for name, unit, value in _list_damper(result.damper):
            yield "damper", None, None, None, node, name, value, unit
    if result.response is not None:
        yield from _response_lines(result.system, result.response)
        yield from _worst_lines(result.system, result.response)
    for number, (low, high) in enumerate(result.barred_rpm or (), 1):
        yield "barred", number, None, None, "", "from", clean(low), "rpm"
        yield "barred", number, None, None, "", "to", clean(high), "rpm"


def _system_lines(system: TorsionalSystem) -> Iterator[Line]:
    for name, inertia, gear in zip(system.nodes, system.chain.inertia, system.gears, strict=True):
        where = ("node", None, None, None, name_cell(name))
        yield *where, "inertia", clean(inertia), "kg m2"
        yield *where, "gear", clean(gear), ""
    for name, stiffness in zip(system.shafts, system.chain.stiffness, strict=True):
        where = ("shaft", None, None, None, name_cell(name))
        yield *where, "stiffness", clean_finite(stiffness), "N m/rad"


def _mode_lines(number: int, mode: NaturalMode, system: TorsionalSystem) -> Iterator[Line]:
    where = ("mode", number, None, None)
    yield *where, "", "frequency", clean(mode.frequency_hz), "Hz"
    yield *where, "", "nodes", mode.nodes, ""
    yield *where, "", "loss", clean(mode.loss), ""
    for name, angle in zip(system.nodes, mode.shape, strict=True):
        yield *where, name_cell(name), "angle", clean(angle), ""


def _holzer_lines(number: int, result: TorsionAnalysis, asked: HolzerTable) -> Iterator[Line]:
    where, columns = ("holzer", number, None, None), _list_holzer(result, asked)
    yield *where, "", "frequency", clean(asked.omega / (2 * np.pi)), "Hz"
    for k, node in enumerate(map(name_cell, result.system.nodes)):
        for name, unit, values in columns:
            yield *where, node, name, clean_finite(values[k]), unit
    yield *where, "", "residual", clean(asked.table.residual), "N m"


def _response_lines(system: TorsionalSystem, response: TorsionResponse) -> Iterator[Line]:
    """At every speed."""
    for s, speed in enumerate(response.speeds_rpm):
        where = ("response", None, clean(speed), None)
        for k, name in enumerate(map(name_cell, system.shafts)):
            yield *where, name, "half_peak_to_peak", clean(response.torque[s, k]), "N m"
            yield *where, name, "sum_of_amplitudes", clean(response.sums[s, k]), "N m"
            if system.sections[k] is not None:
                yield *where, name, "stress", clean(response.stress[s, k]), "Pa"
        yield *where, "", "free_end", clean(np.degrees(response.free_end[s])), "deg"
        for k, name in enumerate(response.dampers):
            node = name_cell(name.removesuffix(" ring"))
            yield *where, node, "heat", clean(response.heat[s, k]), "W"
        for k, each in enumerate(system.pendulums):
            node, swing = name_cell(system.nodes[each.node]), np.degrees(response.pendulums[s, k])
            yield *where, node, "pendulums", clean(swing), "deg"


def _worst_lines(system: TorsionalSystem, response: TorsionResponse) -> Iterator[Line]:
    """The largest over all speeds."""
    worst = response.worst
    for k, name in enumerate(map(name_cell, system.shafts)):
        where = ("worst", None, clean(worst.speeds_rpm[k]), None)
        yield *where, name, "half_peak_to_peak", clean(worst.torque[k]), "N m"
        if system.sections[k] is not None:
            yield *where, name, "stress", clean(worst.stress[k]), "Pa"
        for order, amplitude in zip(response.orders, worst.amplitudes[:, k], strict=True):
            at_order = (*where[:3], order_number(float(order)))
            yield *at_order, name, "amplitude", clean(amplitude), "N m"
    for k, name in enumerate(response.dampers):
        where = ("worst", None, clean(worst.hottest_rpm[k]), None)
        yield *where, name_cell(name.removesuffix(" ring")), "heat", clean(worst.heat[k]), "W"
    for k, each in enumerate(system.pendulums):
        where = ("worst", None, clean(worst.pendulum_rpm[k]), None)
        node, swing = name_cell(system.nodes[each.node]), np.degrees(worst.pendulums[k])
        yield *where, node, "pendulums", clean(swing), "deg"
    where = ("worst", None, clean(worst.swing_rpm), None)
    yield *where, "", "free_end", clean(np.degrees(worst.free_end)), "deg"

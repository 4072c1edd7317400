"""What a program reads of torsional vibration: JSON, and the same figures as CSV."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from ..torsion.analysis import HolzerTable, TorsionAnalysis
from ..torsion.damper_sizing import SizedDamper
from ..torsion.response import Response
from .csv import Rows, name_cell
from .figures import clean, clean_each
from .sheet import order_number
from .units import System

_HEADER = ("part", "number", "speed_rpm", "order", "name", "figure", "value", "unit")


def document(result: TorsionAnalysis) -> dict[str, Any]:
    """`balcli.torsion/1`, SI units."""
    system = result.system
    found: dict[str, Any] = {
        "format": "balcli.torsion/1",
        "name": system.name or None,
        "nodes": [
            {"name": name, "inertia_kg_m2": clean(inertia), "gear": clean(gear)}
            for name, inertia, gear in zip(
                system.nodes, system.chain.inertia, system.gears, strict=True
            )
        ],
        "shafts": [
            {"name": name, "stiffness_Nm_per_rad": _finite(stiffness)}
            for name, stiffness in zip(system.shafts, system.chain.stiffness, strict=True)
        ],
        "modes": [
            {
                "frequency_Hz": clean(mode.frequency_hz),
                "shape": clean_each(mode.shape),
                "nodes": mode.nodes,
                "node_in": list(mode.still),
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
    table = asked.table
    columns = (table.angle, table.torque, table.total, table.stiffness, table.twist)
    keys = ("angle", "torque_Nm", "sum_Nm", "stiffness_Nm_per_rad", "twist")
    rows = [
        {"node": name, "inertia_kg_m2": clean(inertia)}
        | {key: _finite(value) for key, value in zip(keys, values, strict=True)}
        for name, inertia, *values in zip(
            result.system.nodes, result.system.chain.inertia, *columns, strict=True
        )
    ]
    mode = {} if asked.mode is None else {"mode": asked.mode}
    frequency = {"frequency_Hz": clean(asked.omega / (2 * np.pi))}
    return mode | frequency | {"rows": rows, "residual_Nm": clean(table.residual)}


def _response_document(result: TorsionAnalysis, response: Response) -> dict[str, Any]:
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
    return found


def _damper_document(sized: SizedDamper) -> dict[str, Any]:
    """The damper as an engine or chain file has it, in SI, and what it does."""
    damper = sized.damper
    si = {
        "inertia_kg_m2": (damper.inertia, 1e6),
        "damping_Nms_per_rad": (damper.damping, 1),
        "stiffness_Nm_per_rad": (damper.stiffness, 1),
        "loss": (damper.loss, 1),
        "mass_kg": (damper.mass, 1),
        "radius_m": (damper.radius, 1e3),
        "length_m": (damper.length, 1e3),
    }
    figures = {key: clean(value / per) for key, (value, per) in si.items() if value is not None}
    unit = "Pa" if sized.measure == "stress" else "Nm"
    doubts = {"doubts": list(sized.doubts)} if sized.doubts else {}
    return {
        "node": sized.node,
        "kind": damper.kind,
        **figures,
        "mode": sized.mode,
        f"before_{unit}": _finite(sized.before),
        f"after_{unit}": clean(sized.after),
        "heat_W": clean(sized.heat),
        "heat_rpm": clean(sized.heat_rpm),
        **doubts,
    }


def _finite(value: float) -> float | None:
    return clean(value) if np.isfinite(value) else None


def rows(result: TorsionAnalysis, system: System) -> Rows:
    """Every figure of the document a row, SI."""
    return Rows(_HEADER, _lines(result))


Line = tuple[Any, ...]


def _lines(result: TorsionAnalysis) -> Iterator[Line]:
    said = document(result)
    yield from _system_lines(said)
    for number, mode in enumerate(said["modes"], 1):
        yield from _mode_lines(number, mode, said["nodes"])
    for each in said.get("criticals", ()):
        where = ("critical", each["mode"], each["speed_rpm"], each["order"], "")
        yield *where, "phase_sum", each["phase_sum"], ""
        yield *where, "work_share", each["work_share"], ""
    for number, table in enumerate(said.get("holzer", ()), 1):
        yield from _holzer_lines(number, table)
    yield from _damper_lines(said.get("damper", {}))
    if "response" in said:
        yield from _response_lines(said["response"])
    for number, (low, high) in enumerate(said.get("barred_rpm", ()), 1):
        yield "barred", number, None, None, "", "from", low, "rpm"
        yield "barred", number, None, None, "", "to", high, "rpm"


def _system_lines(said: dict[str, Any]) -> Iterator[Line]:
    for node in said["nodes"]:
        name = name_cell(node["name"])
        yield "node", None, None, None, name, "inertia", node["inertia_kg_m2"], "kg m2"
        yield "node", None, None, None, name, "gear", node["gear"], ""
    for shaft in said["shafts"]:
        stiffness = shaft["stiffness_Nm_per_rad"]
        yield "shaft", None, None, None, name_cell(shaft["name"]), "stiffness", stiffness, "N m/rad"


def _mode_lines(number: int, mode: dict[str, Any], nodes: list[dict[str, Any]]) -> Iterator[Line]:
    where = ("mode", number, None, None)
    yield *where, "", "frequency", mode["frequency_Hz"], "Hz"
    yield *where, "", "nodes", mode["nodes"], ""
    yield *where, "", "loss", mode["loss"], ""
    for node, angle in zip(nodes, mode["shape"], strict=True):
        yield *where, name_cell(node["name"]), "angle", angle, ""


def _damper_lines(damper: dict[str, Any]) -> Iterator[Line]:
    for key, value in damper.items():
        if key not in ("node", "kind", "doubts"):
            figure, _, unit = key.partition("_")
            node = name_cell(damper["node"])
            yield "damper", None, None, None, node, figure, value, _DAMPER_UNITS.get(unit, "")


_HOLZER_UNITS = {
    "inertia_kg_m2": ("inertia", "kg m2"),
    "angle": ("angle", ""),
    "torque_Nm": ("torque", "N m"),
    "sum_Nm": ("sum", "N m"),
    "stiffness_Nm_per_rad": ("stiffness", "N m/rad"),
    "twist": ("twist", ""),
}
_DAMPER_UNITS = {
    "kg_m2": "kg m2",
    "Nms_per_rad": "N m s/rad",
    "Nm_per_rad": "N m/rad",
    "kg": "kg",
    "m": "m",
    "Pa": "Pa",
    "Nm": "N m",
    "W": "W",
    "rpm": "rpm",
}


def _holzer_lines(number: int, table: dict[str, Any]) -> Iterator[Line]:
    where = ("holzer", number, None, None)
    yield *where, "", "frequency", table["frequency_Hz"], "Hz"
    for row in table["rows"]:
        for key, (figure, unit) in _HOLZER_UNITS.items():
            yield *where, name_cell(row["node"]), figure, row[key], unit
    yield *where, "", "residual", table["residual_Nm"], "N m"


def _response_lines(said: dict[str, Any]) -> Iterator[Line]:
    for k, speed in enumerate(said["speeds_rpm"]):
        where = ("response", None, speed, None)
        for shaft in said["shafts"]:
            name = name_cell(shaft["name"])
            yield *where, name, "half_peak_to_peak", shaft["half_peak_to_peak_Nm"][k], "N m"
            yield *where, name, "sum_of_amplitudes", shaft["sum_of_amplitudes_Nm"][k], "N m"
            if "stress_Pa" in shaft:
                yield *where, name, "stress", shaft["stress_Pa"][k], "Pa"
        yield *where, "", "free_end", said["free_end_deg"][k], "deg"
        for damper in said.get("dampers", ()):
            yield *where, name_cell(damper["node"]), "heat", damper["heat_W"][k], "W"
    for damper in said.get("dampers", ()):
        worst = damper["worst"]
        where = ("worst", None, worst["speed_rpm"], None)
        yield *where, name_cell(damper["node"]), "heat", worst["heat_W"], "W"
    for shaft in said["shafts"]:
        worst, name = shaft["worst"], name_cell(shaft["name"])
        where = ("worst", None, worst["speed_rpm"], None)
        yield *where, name, "half_peak_to_peak", worst["half_peak_to_peak_Nm"], "N m"
        if "stress_Pa" in worst:
            yield *where, name, "stress", worst["stress_Pa"], "Pa"
    swing = said["free_end_worst"]
    yield "worst", None, swing["speed_rpm"], None, "", "free_end", swing["half_swing_deg"], "deg"

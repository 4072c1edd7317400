"""What a person and a program read of torsional vibration: modes, criticals, Holzer's tables, and
forced vibration over speed.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from ..core.singular_values import Real
from ..torsion.analysis import HolzerTable, TorsionAnalysis
from ..torsion.response import Response
from .csv import Rows, name_cell
from .figures import clean
from .sheet import Facts, Grid, Sheet, Text, number, order_number
from .units import System

_HEADER = ("part", "number", "speed_rpm", "order", "name", "figure", "value", "unit")
_MOST_MODES = 5  # shown with their shapes: more do not fit into a terminal
_MOST_CRITICALS = 12  # shown: those that do most work
_MOST_ORDERS = 3  # of a shaft's torque, named beside it


def sheet(result: TorsionAnalysis, system: System) -> Sheet:
    """Modes first, then what was asked; units are SI."""
    parts: list[Grid | Facts | Text] = [_modes(result), _shapes(result)]
    if result.criticals:
        parts.append(_criticals(result))
    parts += [_holzer(result, table) for table in result.holzer]
    if result.response is not None:
        parts.append(_response(result, result.response))
    if result.barred_rpm is not None:
        parts.append(_barred(result))
    return Sheet(f"{result.system.name or 'chain without a name'}: torsion", tuple(parts))


def _modes(result: TorsionAnalysis) -> Grid:
    rows = tuple(
        (
            str(mode.number),
            number(mode.frequency_hz, 6),
            number(mode.frequency_hz * 60, 6),
            str(mode.nodes),
            ", ".join(mode.still) or "–",
        )
        for mode in result.modes
    )
    note = "Node in: the shafts whose ends turn against each other."
    if result.system.rings:
        note += " Rings in oil are left out, as if they were not there."
    if result.system.pendulums:
        note += (
            " So are pendulums, which follow the order."
            if result.system.rings
            else (" Pendulums are left out; they follow the order.")
        )
    return Grid(
        "Natural modes", ("mode", "Hz", "1/min", "nodes", "node in"), rows, note, words=(0, 4)
    )


def _shapes(result: TorsionAnalysis) -> Grid:
    shown = result.modes[:_MOST_MODES]
    geared = bool(np.any(result.system.gears != 1))
    heads = ["node", "kg·m²", *["gear"] * geared, *(f"mode {mode.number}" for mode in shown)]
    rows = []
    for k, name in enumerate(result.system.nodes):
        inertia = result.system.chain.inertia[k]
        cells = [name, number(float(inertia)) if inertia else "–"]
        cells += [number(float(result.system.gears[k]))] * geared
        rows.append((*cells, *(_signed(mode.shape[k]) for mode in shown)))
    note = "Angle of each node by itself, the largest 1."
    left = len(result.modes) - len(shown)
    if left:
        note += f" JSON has {left} mode{'s' * (left > 1)} more."
    return Grid("Inertias and shapes", tuple(heads), tuple(rows), note)


def _signed(value: float) -> str:
    return f"{round(float(value), 4) + 0.0:.4f}"


def _criticals(result: TorsionAnalysis) -> Grid:
    shown = result.criticals[:_MOST_CRITICALS]
    rows = tuple(
        (
            str(each.mode),
            f"{order_number(each.order)}",
            number(each.speed_rpm),
            number(each.phase_sum, 4),
            f"{each.work_share:.1%}",
        )
        for each in shown
    )
    note = "Those that do most work first; share: of all work done on the mode."
    left = len(result.criticals) - len(shown)
    if left:
        note += f" JSON has {left} more."
    heads = ("mode", "order", "rpm", "phase sum", "share")
    return Grid("Critical speeds", heads, rows, note)


def _holzer(result: TorsionAnalysis, asked: HolzerTable) -> Grid:
    table, chain = asked.table, result.system.chain
    rows = tuple(
        (
            name,
            number(float(chain.inertia[k])),
            number(float(table.angle[k]), 6),
            number(float(table.torque[k])),
            number(_settle(asked, float(table.total[k]))),
            _stiffness(float(table.stiffness[k])),
            number(float(table.twist[k]), 4) if table.stiffness[k] else "–",
        )
        for k, name in enumerate(result.system.nodes)
    )
    what = f"mode {asked.mode}" if asked.mode else "trial"
    title = f"Holzer's table, {what}: {number(asked.omega, 7)} rad/s"
    left = f"Left over at the end: {number(_settle(asked, table.residual))} N·m."
    heads = ("node", "J, kg·m²", "angle", "J ω² angle", "sum, N·m", "k, N·m/rad", "twist")
    return Grid(title, heads, rows, left)


def _stiffness(value: float) -> str:
    return "rigid" if np.isinf(value) else number(value) if value else "–"


def _settle(asked: HolzerTable, value: float) -> float:
    """A torque, as 0 where it is what rounding left over."""
    size = float(np.abs(asked.table.torque).sum())
    return 0.0 if abs(value) <= 1e-9 * size else value


def _response(result: TorsionAnalysis, response: Response) -> Grid:
    rows = []
    stressed = bool(np.any(np.isfinite(response.stress)))
    for k, name in enumerate(result.system.shafts):
        worst = int(np.argmax(response.torque[:, k]))
        cells = [
            name,
            number(float(response.torque[worst, k])),
            number(float(response.speeds_rpm[worst])),
            number(float(response.sums[worst, k])),
        ]
        if stressed:
            cells.append(number(float(response.stress[worst, k]) / 1e6, 4))
        rows.append((*cells, _name_orders(response, worst, k)))
    worst = int(np.argmax(response.free_end))
    swing = number(float(np.degrees(response.free_end[worst])), 4)
    note = (
        "Largest half of peak to peak, orders added up in time; sum: of their amplitudes, which "
        f"never peak together. {result.system.nodes[0]} swings by ±{swing} deg at "
        f"{number(float(response.speeds_rpm[worst]))} rpm."
    )
    for k, name in enumerate(response.dampers):
        hottest = int(np.argmax(response.heat[:, k]))
        note += (
            f" The damper of {name.removesuffix(' ring')} turns up to "
            f"{number(float(response.heat[hottest, k]), 4)} W to heat, at "
            f"{number(float(response.speeds_rpm[hottest]))} rpm."
        )
    heads = ["shaft", "± N·m", "at rpm", "sum, N·m", *["N/mm²"] * stressed, "largest orders"]
    span = (
        f"{number(float(response.speeds_rpm[0]))} to {number(float(response.speeds_rpm[-1]))} rpm"
    )
    title = f"Vibratory torque, {span}"
    return Grid(title, tuple(heads), tuple(rows), note, words=(0, len(heads) - 1))


def _name_orders(response: Response, speed: int, shaft: int) -> str:
    """The largest orders of a shaft's torque with their amplitudes in N m."""
    sizes = response.amplitudes[:, speed, shaft]
    largest = np.argsort(-sizes, kind="stable")[:_MOST_ORDERS]
    return ", ".join(
        f"{order_number(float(response.orders[k]))}: {number(float(sizes[k]), 3)}"
        for k in largest
        if sizes[k] > 1e-3 * sizes.max()
    )


def _barred(result: TorsionAnalysis) -> Facts:
    system, limits = result.system, []
    if system.limit_pa is not None:
        limits.append(f"{number(system.limit_pa / 1e6)} N/mm²")
    if system.angle_limit is not None:
        limits.append(f"±{number(float(np.degrees(system.angle_limit)))} deg at {system.nodes[0]}")
    ranges = [f"{number(a)} to {number(b)} rpm" for a, b in result.barred_rpm or ()]
    barred = ", ".join(ranges) or "none in this range"
    return Facts((("limit", " and ".join(limits)), ("barred speeds", barred)), "Limits")


# ------------------------------------------------------------------ for programs
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
                "shape": _list(mode.shape),
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
    shafts = []
    for k, name in enumerate(result.system.shafts):
        worst = int(np.argmax(response.torque[:, k]))
        amplitudes = response.amplitudes[:, worst, k]
        entry: dict[str, Any] = {
            "name": name,
            "half_peak_to_peak_Nm": _list(response.torque[:, k]),
            "sum_of_amplitudes_Nm": _list(response.sums[:, k]),
        }
        if result.system.sections[k] is not None:
            entry["stress_Pa"] = _list(response.stress[:, k])
        entry["worst"] = {
            "speed_rpm": clean(response.speeds_rpm[worst]),
            "half_peak_to_peak_Nm": clean(response.torque[worst, k]),
            "orders": [
                {"order": order_number(float(order)), "amplitude_Nm": clean(amplitude)}
                for order, amplitude in zip(response.orders, amplitudes, strict=True)
            ],
        }
        shafts.append(entry)
    found: dict[str, Any] = {
        "speeds_rpm": _list(response.speeds_rpm),
        "shafts": shafts,
        "free_end_deg": _list(np.degrees(response.free_end)),
    }
    if response.dampers:
        found["dampers"] = [
            {"node": name.removesuffix(" ring"), "heat_W": _list(response.heat[:, k])}
            for k, name in enumerate(response.dampers)
        ]
    return found


def _list(values: Real) -> list[float | None]:
    return [clean(value) for value in values]


def _finite(value: float) -> float | None:
    return clean(value) if np.isfinite(value) else None


def rows(result: TorsionAnalysis, system: System) -> Rows:
    """Every figure of the document a row, SI."""
    return Rows(_HEADER, _lines(result))


Line = tuple[Any, ...]


def _lines(result: TorsionAnalysis) -> Iterator[Line]:
    said = document(result)
    for node in said["nodes"]:
        name = name_cell(node["name"])
        yield "node", None, None, None, name, "inertia", node["inertia_kg_m2"], "kg m2"
        yield "node", None, None, None, name, "gear", node["gear"], ""
    for shaft in said["shafts"]:
        stiffness = shaft["stiffness_Nm_per_rad"]
        yield "shaft", None, None, None, name_cell(shaft["name"]), "stiffness", stiffness, "N m/rad"
    for number_, mode in enumerate(said["modes"], 1):
        yield "mode", number_, None, None, "", "frequency", mode["frequency_Hz"], "Hz"
        yield "mode", number_, None, None, "", "nodes", mode["nodes"], ""
        yield "mode", number_, None, None, "", "loss", mode["loss"], ""
        for node, angle in zip(said["nodes"], mode["shape"], strict=True):
            yield "mode", number_, None, None, name_cell(node["name"]), "angle", angle, ""
    for each in said.get("criticals", ()):
        where = ("critical", each["mode"], each["speed_rpm"], each["order"], "")
        yield *where, "phase_sum", each["phase_sum"], ""
        yield *where, "work_share", each["work_share"], ""
    for number_, table in enumerate(said.get("holzer", ()), 1):
        yield from _holzer_lines(number_, table)
    if "response" in said:
        yield from _response_lines(said["response"])
    for number_, (low, high) in enumerate(said.get("barred_rpm", ()), 1):
        yield "barred", number_, None, None, "", "from", low, "rpm"
        yield "barred", number_, None, None, "", "to", high, "rpm"


_HOLZER_UNITS = {
    "inertia_kg_m2": ("inertia", "kg m2"),
    "angle": ("angle", ""),
    "torque_Nm": ("torque", "N m"),
    "sum_Nm": ("sum", "N m"),
    "stiffness_Nm_per_rad": ("stiffness", "N m/rad"),
    "twist": ("twist", ""),
}


def _holzer_lines(number_: int, table: dict[str, Any]) -> Iterator[Line]:
    where = ("holzer", number_, None, None)
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

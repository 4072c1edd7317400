"""What a program reads of an engine on its mounts: JSON, and the same figures as CSV."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from ..core.vibration import Real
from ..mounting.motions import AXES
from ..mounting.report import MountReport
from ..mounting.response import LargestAmplitude, MountingResponse
from .csv import Rows, name_cell
from .figures import clean, clean_each, silent_entries
from .sheet import order_number
from .units import System

_HEADER = ("part", "name", "order", "speed_rpm", "figure", "value", "unit")


def document(result: MountReport) -> dict[str, Any]:
    """`balcli.mounts/1`, SI but for what a name says otherwise."""
    modes, mounted = result.modes, result.mounted
    settled = zip(mounted.names, modes.settled.forces, modes.settled.travel, strict=True)
    found: dict[str, Any] = {
        "format": "balcli.mounts/1",
        "name": result.name,
        "modes": [
            {
                "frequency_Hz": clean(mode.hertz),
                "energy_percent": {
                    axis: clean(100 * share) for axis, share in zip(AXES, mode.shares, strict=True)
                },
                "shape": [clean(value) for value in mode.shape],
                "motion": mode.motion,
                "loss_factor": clean(mode.loss),
                "meets": [
                    {"order": order_number(one.order), "speed_rpm": clean(one.speed_rpm)}
                    for one in result.meetings
                    if one.mode == k
                ],
            }
            for k, mode in enumerate(modes.six)
        ],
        "roll_axis": clean_each(modes.roll_axis),
        "elastic_centre_mm": clean_each(1e3 * modes.centre.point),
        "static": {
            "mounts": [
                {"name": name, "force_N": clean_each(force), "travel_mm": clean_each(1e3 * travel)}
                for name, force, travel in settled
            ]
        },
        "stiffness_N_per_m": [clean_each(row) for row in modes.stiffness],
    }
    if result.response is not None:
        found["response"] = _response(result, result.response)
    if result.fitted is not None:
        found["fitted"] = {
            "scheme": result.fitted.remedy.scheme,
            "response": _response(result, result.fitted.response),
        }
    if result.others:
        found["others"] = [
            {"name": other.name, "response": _response(result, other.response)}
            for other in result.others
        ]
    return found


def _response(result: MountReport, response: MountingResponse) -> dict[str, Any]:
    orders = [order_number(order) for order in response.loads.orders]

    def curves(names: Sequence[str], key: str, values: Real, scale: float) -> list[dict[str, Any]]:
        return [
            {
                "name": name,
                "orders": [
                    {"order": order, key: clean_each(scale * values[n, :, k])}
                    for n, order in enumerate(orders)
                ],
            }
            for k, name in enumerate(names)
        ]

    mounts = curves(result.mounted.names, "force_N", response.force, 1.0)
    points = curves(result.mounted.point_names, "motion_mm", response.motion, 1e3)
    for k, mount in enumerate(mounts):
        mount["peak_N"] = clean_each(response.force_peak[:, k])
        mount["worst"] = _worst_entry(response.worst_force[k], "force_N", 1.0)
    for k, point in enumerate(points):
        point["peak_mm"] = clean_each(1e3 * response.motion_peak[:, k])
        point["worst"] = _worst_entry(response.worst_motion[k], "motion_mm", 1e3)
    return {
        **silent_entries(response.loads.silent),
        "speeds_rpm": clean_each(response.speeds_rpm),
        "mounts": mounts,
        "points": points,
        "passed": [
            {
                "order": order,
                "rigid": _components(response.free[n]),
                "on_mounts": _components(response.passed[n]),
            }
            for n, order in enumerate(orders)
        ],
    }


def _worst_entry(worst: LargestAmplitude, key: str, scale: float) -> dict[str, Any]:
    return {
        key: clean(scale * worst.value),
        "speed_rpm": clean(worst.speed_rpm),
        "order": order_number(worst.order),
        f"order_{key}": clean(scale * worst.alone),
    }


def _components(load: Real) -> dict[str, list[float | None]]:
    """Amplitudes by speed of a load (speeds, 6), as far as there is any."""
    keys = [*(f"force_{axis}_N" for axis in "xyz"), *(f"moment_{axis}_Nm" for axis in "xyz")]
    return {key: clean_each(load[:, k]) for k, key in enumerate(keys) if load[:, k].any()}


def rows(result: MountReport, system: System) -> Rows:
    """A figure a line."""
    return Rows(_HEADER, _lines(result, system))


def _lines(result: MountReport, system: System) -> Iterator[tuple[Any, ...]]:
    force, length = system.force, system.length
    for k, mode in enumerate(result.modes.six, 1):
        name = f"mode {k}"
        yield "mode", name, None, None, "frequency", clean(mode.hertz), "Hz"
        yield "mode", name, None, None, "motion", mode.motion, ""
        for axis, share in zip(AXES, mode.shares, strict=True):
            yield "mode", name, None, None, f"energy {axis}", clean(100 * share), "%"
    for one in result.meetings:
        cells = ("meeting", f"mode {one.mode + 1}", order_number(one.order))
        yield *cells, clean(one.speed_rpm), "speed", clean(one.speed_rpm), "rpm"
    settled = result.modes.settled
    for k, name in enumerate(result.mounted.names):
        for j, axis in enumerate("xyz"):
            own = clean(force.of(settled.forces[k, j]))
            yield "static", name_cell(name), None, None, f"force {axis}", own, force.name
            own = clean(length.of(settled.travel[k, j]))
            yield "static", name_cell(name), None, None, f"travel {axis}", own, length.name
    if result.response is not None:
        yield from _curves(result, result.response, "", system)
    if result.fitted is not None:
        yield from _curves(result, result.fitted.response, "with scheme ", system)
    for other in result.others:
        yield from _curves(result, other.response, f"{name_cell(other.name)}: ", system)


def _curves(
    result: MountReport, response: MountingResponse, part: str, system: System
) -> Iterator[tuple[Any, ...]]:
    force, length = system.force, system.length
    groups = (
        ("mount", result.mounted.names, response.force, response.force_peak, force),
        ("point", result.mounted.point_names, response.motion, response.motion_peak, length),
    )
    for key, numbers in silent_entries(response.loads.silent).items():
        yield f"{part}engine", "", None, None, key, " ".join(map(str, numbers)), ""
    for kind, names, by_order, peak, unit in groups:
        figure = "force" if kind == "mount" else "motion"
        for k, name in enumerate(names):
            for s, rpm in enumerate(response.speeds_rpm):
                head = (f"{part}{kind}", name_cell(name))
                for n, order in enumerate(response.loads.orders):
                    value = clean(unit.of(by_order[n, s, k]))
                    yield *head, order_number(order), clean(rpm), figure, value, unit.name
                value = clean(unit.of(peak[s, k]))
                yield *head, None, clean(rpm), f"peak {figure}", value, unit.name

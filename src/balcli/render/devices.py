"""Counterweights, balancer shafts and sliders of a remedy, and what a workshop asks of them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from ..enginefile.model import Counterweight, Shaft, Slider
from ..sizing.device_tables import FIELDS, DeviceTable, find_unbalance, name_kind
from ..sizing.remedy import Remedy
from .figures import clean
from .sheet import Grid, degrees, number

if TYPE_CHECKING:
    from ..sizing.workshop import Practical
    from .units import System, Unit

_JSON_NAMES = {
    "unbalance": "unbalance_kg_m",
    "angle": "angle_deg",
    "direction": "direction_deg",
    "position": "position_mm",
    "at": "at_mm",
}
_CSV_FIELDS = ("ratio", "order", "unbalance", "angle", "direction", "position", "at")


# ------------------------------------------------------------------ for people
def device_grid(remedy: Remedy, system: System) -> Grid:
    """One row a device."""
    heads = (
        "device",
        "turns",
        f"{system.unbalance.name}",
        "angle, deg",
        f"x, y, {system.length.name}",
        f"z, {system.length.name}",
    )
    rows = tuple(_grid_row(device, system) for device in remedy.devices)
    return Grid("", heads, rows, words=(0, 3, 4))


def _grid_row(device: DeviceTable, system: System) -> tuple[str, ...]:
    match device:
        case Counterweight():
            turns, angle = "1", f"{degrees(device.angle)} from pin 1"
            place = "on the crank"
        case Shaft():
            turns, angle = f"{device.ratio:+d}", degrees(device.angle)
            place = _place(device.at, system.length)
        case Slider():
            turns = str(device.order)
            angle = f"{degrees(device.angle)} along {degrees(device.direction)}"
            place = _place(device.at, system.length)
    unbalance = number(system.unbalance.of(find_unbalance(device)))
    return (
        name_kind(device),
        turns,
        unbalance,
        angle,
        place,
        _length(device.position, system.length),
    )


def _place(at: tuple[float, ...], unit: Unit) -> str:
    return ", ".join(_length(coordinate, unit) for coordinate in at)


def _length(millimetres: float, unit: Unit) -> str:
    return number(unit.of(millimetres / 1e3))


def practical_grid(practical: tuple[Practical, ...], system: System) -> Grid:
    """The workshop's figures, one row a device; there must be one."""
    first = practical[0]
    drilled = first.depth is not None
    names = [
        "device",
        "rpm",
        f"pulls, {system.force.name}",
        f"mass, {system.mass.name}",
        f"disc r, {system.length.name}",
        f"thick, {system.length.name}",
    ]
    note = (
        f"Mass at a radius of {number(system.length.of(first.radius), 4)} {system.length.name}; "
        "disc: a semicircular one of steel"
    )
    if drilled:
        names.append(f"drill, {system.length.name}")
        note += "; drill: depth of a radial hole from that radius inwards that removes as much"
    rows = tuple((str(k), *_practical_row(p, system)) for k, p in enumerate(practical, 1))
    return Grid("Practical figures", tuple(names), rows, note=f"{note}.")


def _practical_row(p: Practical, system: System) -> list[str]:
    row = [
        f"{p.speed_rpm:.0f}",
        number(system.force.of(p.force)),
        number(system.mass.of(p.mass), 4),
        number(system.length.of(p.disc_radius), 3),
        number(system.length.of(p.disc_thickness), 3),
    ]
    if p.depth is not None:
        too_small = math.isnan(p.depth)
        row.append("too small" if too_small else number(system.length.of(p.depth), 3))
    return row


# ------------------------------------------------------------------ for programs
def device_entries(remedy: Remedy) -> dict[str, list[dict[str, Any]]]:
    """New devices in JSON, as an engine file would describe them."""
    entries: dict[str, list[dict[str, Any]]] = {f"{kind.__name__.lower()}s": [] for kind in FIELDS}
    for device in remedy.devices:
        entries[f"{name_kind(device)}s"].append(_device_entry(device))
    return entries


def _device_entry(device: DeviceTable) -> dict[str, Any]:
    values = {field: getattr(device, field) for field in FIELDS[type(device)]}
    values["unbalance"] = find_unbalance(device)
    if "at" in values:
        values["at"] = list(values["at"])
    return {_JSON_NAMES.get(field, field): value for field, value in values.items()}


def practical_entry(p: Practical) -> dict[str, float | None]:
    """The workshop's figures of a device in JSON."""
    figures = {
        "unbalance_kg_m": p.unbalance,
        "mass_kg": p.mass,
        "radius_mm": p.radius * 1e3,
        "force_N": p.force,
        "speed_rpm": p.speed_rpm,
        "disc_radius_mm": p.disc_radius * 1e3,
        "disc_thickness_mm": p.disc_thickness * 1e3,
    }
    if p.depth is not None:
        figures["drill_depth_mm"] = p.depth * 1e3
    return {key: clean(value) for key, value in figures.items()}


def device_rows(device: DeviceTable, system: System) -> Iterator[tuple[str, Any, str]]:
    """Name, value and unit of every figure of a device, as an engine file would say it."""
    length, unbalance = system.length, system.unbalance
    for field in _CSV_FIELDS:
        if field not in FIELDS[type(device)]:
            continue
        value = getattr(device, field)
        match field:
            case "ratio" | "order":
                yield field, value, ""
            case "unbalance":
                yield field, _convert(value or 0.0, 1e-6, unbalance), unbalance.name
            case "angle" | "direction":
                yield field, value, "deg"
            case "position":
                yield field, _convert(value, 1e-3, length), length.name
            case "at":
                for axis, coordinate in zip("xy", value, strict=True):
                    yield f"at_{axis}", _convert(coordinate, 1e-3, length), length.name


def _convert(value: float, size: float, unit: Unit) -> float:
    """A value in units of this size (in SI units) in another unit; as it is where that is the
    same.
    """
    return value if unit.size == size else unit.of(value * size)

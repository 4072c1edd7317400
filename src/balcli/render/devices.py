"""Counterweights, balancer shafts and sliders of a remedy, and what a workshop asks of them."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

from ..enginefile.model import Counterweight, Shaft, Slider
from ..limits import MOST_HOLES
from ..sizing.device_tables import FIELDS, DeviceTable, find_unbalance, name_kind
from ..sizing.remedy import Remedy
from .figures import clean
from .sheet import UNKNOWN, Grid, capitalized, degrees, given, number

if TYPE_CHECKING:
    from ..sizing.workshop import Holes, Practical, Tools
    from .units import ShownUnit, System

_JSON_NAMES = {
    "unbalance": "unbalance_kg_m",
    "angle": "angle_deg",
    "direction": "direction_deg",
    "position": "position_mm",
    "at": "at_mm",
}
ANGLES = (
    "Angles count in the sense of rotation, clockwise seen from the free end (front): of "
    "counterweights from cylinder 1's crank pin, of shafts from x."
)
_CSV_FIELDS = ("ratio", "order", "unbalance", "angle", "direction", "position", "at")


# ------------------------------------------------------------------ for people
def device_grid(remedy: Remedy, system: System) -> Grid:
    """One row a device."""
    unit = system.unbalance.fit(max(map(find_unbalance, remedy.devices), default=0.0))
    heads = (
        "device",
        "speed ratio",
        unit.name,
        "angle, deg",
        f"x, y, {system.length.name}",
        f"z, {system.length.name}",
    )
    free = remedy.free
    rows = tuple(
        _grid_row(device, anywhere, unit, system.length)
        for device, anywhere in zip(remedy.devices, free, strict=True)
    )
    note = " ".join([ANGLES, *_explain_places(remedy.devices, free)])
    return Grid("", heads, rows, note, words=(0, 3, 4))


def _explain_places(devices: Sequence[DeviceTable], free: Sequence[bool]) -> Iterator[str]:
    """What to know of shafts: how they stand, and where, if nobody has said so."""
    if any(isinstance(device, Shaft) for device in devices):
        yield (
            "Shafts stand so at crank angle 0; angles of those that turn against the crank count "
            "in its sense, too."
        )
    if any(isinstance(device, Slider) for device in devices):
        yield "Of sliders: the phase at crank angle 0, along a path that counts from x."
    if any(free):
        yield "free: the shaft may stand anywhere, for it makes a moment alone."
    shafts = zip(devices, free, strict=True)
    if any(isinstance(d, Shaft) and not any(d.at) and not anywhere for d, anywhere in shafts):
        yield (
            "At 0, 0, the crank's centre line, a shaft adds no roll about it; elsewhere, where a "
            "real one stands, it does."
        )


def _grid_row(
    device: DeviceTable, free: bool, unit: ShownUnit, length: ShownUnit
) -> tuple[str, ...]:
    match device:
        case Counterweight():
            turns, angle = "1", f"{degrees(device.angle)} from pin 1"
            place = "crank axis"
        case Shaft():
            turns, angle = f"{device.ratio:+d}", degrees(device.angle)
            place = "free" if free else _place(device.at, length)
        case Slider():
            turns = str(device.order)
            angle = f"{degrees(device.angle)} along {degrees(device.direction)}"
            place = _place(device.at, length)
    unbalance = number(unit.of(find_unbalance(device)))
    return (name_kind(device), turns, unbalance, angle, place, _length(device.position, length))


def _place(at: tuple[float, ...], unit: ShownUnit) -> str:
    return ", ".join(_length(coordinate, unit) for coordinate in at)


def _length(millimetres: float, unit: ShownUnit) -> str:
    return number(unit.of(millimetres / 1e3))


def practical_grid(remedy: Remedy, practical: tuple[Practical, ...], system: System) -> Grid:
    """The workshop's figures, one row a device; there must be one."""
    first = practical[0]
    names = [
        "device",
        "rpm",
        f"force, {system.force.name}",
        f"mass, {system.mass.name}",
        f"disc r, {system.length.name}",
        f"thick, {system.length.name}",
    ]
    radius = f"{number(system.length.of(first.radius), 4)} {system.length.name}"
    note = f"Force: centrifugal; mass at a radius of {radius}; disc: a semicircular one of steel."
    if remedy.sliders:
        note = f"Force: the largest of a stroke; mass at an amplitude of {radius}."
    rows = tuple(
        (f"{k} {name_kind(device)}", *_practical_row(figures, system, isinstance(device, Slider)))
        for k, (device, figures) in enumerate(zip(remedy.devices, practical, strict=True), 1)
    )
    return Grid("Sizes of the weights", tuple(names), rows, note)


def _practical_row(p: Practical, system: System, slides: bool) -> list[str]:
    """What slides is no disc."""
    disc = (p.disc_radius, p.disc_thickness)
    return [
        given(p.speed_rpm),
        number(system.force.of(p.force)),
        number(system.mass.of(p.mass), 4),
        *(UNKNOWN if slides else number(system.length.of(length), 3) for length in disc),
    ]


def holes_grid(
    remedy: Remedy, practical: tuple[Practical, ...], tools: Tools, system: System
) -> Grid:
    """Where to drill, how many holes and how deep; or where to put slugs. There must be a drill."""
    unit = system.length
    drill = f"{number(unit.of(tools.drill or 0.0), 4)} {unit.name}"
    rim = tell_rim(tools, f"{number(unit.of(practical[0].radius), 4)} {unit.name}")
    heads = ("for", "holes at, deg", "holes", f"depth of each, {unit.name}")
    rows = tuple(
        (f"{k} {name_kind(device)}", *_holes_row(figures.holes, unit))
        for k, (device, figures) in enumerate(zip(remedy.devices, practical, strict=True), 1)
        if figures.holes is not None
    )
    if tools.slug is None:
        title = f"Holes to drill, {drill}"
        what = "Holes remove steel opposite to the weight to add"
    else:
        title = f"Holes for slugs of {number(tools.slug / 1e3)} g/cm³, {drill}"
        what = "Slugs stand where weight is to be added and count less the steel removed for them"
    note = f"{what}; radial, {rim} inwards, side by side along the axis."
    for reason in dict.fromkeys(p.holes.reason for p in practical if p.holes and p.holes.reason):
        note += f" {capitalized(reason)}."
    note = " ".join([note, *explain_holes(practical, tools, unit)])
    return Grid(title, heads, rows, note)


def tell_rim(tools: Tools, radius: str) -> str:
    """From where holes go inwards, and whether anybody has said so."""
    why = "--radius" if tools.radius else "the crank radius, assumed: --radius says where it is"
    return f"from a rim at {radius} ({why})"


def explain_holes(practical: Sequence[Practical], tools: Tools, unit: ShownUnit) -> Iterator[str]:
    """How long the largest row of holes is, and that they go deep where nobody has said how deep
    they may.
    """
    planned = [p.holes for p in practical if p.holes and not math.isnan(p.holes.depth)]
    most = max((holes.number for holes in planned), default=0)
    if most > 1 and tools.drill is not None:
        length = f"{number(unit.of(most * tools.drill), 3)} {unit.name}"
        yield f"{most} holes side by side take {length} along the axis at the least."
    deepest = max((holes.depth for holes in planned), default=0.0)
    if tools.max_depth is None and deepest > practical[0].radius / 2:
        depth, rim = (number(unit.of(way), 3) for way in (deepest, practical[0].radius))
        yield (
            f"They go {depth} of {rim} {unit.name} towards the axis: --max-depth says how deep "
            "they may."
        )


def _holes_row(holes: Holes, unit: ShownUnit) -> tuple[str, ...]:
    many = math.isnan(holes.depth)
    return (
        degrees(holes.angle_deg),
        f"more than {MOST_HOLES}" if many else str(holes.number),
        "–" if many else number(unit.of(holes.depth), 4),
    )


# ------------------------------------------------------------------ for programs
def device_entries(remedy: Remedy) -> dict[str, list[dict[str, Any]]]:
    """New devices in JSON, as an engine file would describe them."""
    entries: dict[str, list[dict[str, Any]]] = {f"{kind.__name__.lower()}s": [] for kind in FIELDS}
    for device, free in zip(remedy.devices, remedy.free, strict=True):
        entry = _device_entry(device)
        if isinstance(device, Shaft):
            entry["free"] = free
        entries[f"{name_kind(device)}s"].append(entry)
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
    entry = {key: clean(value) for key, value in figures.items()}
    if p.holes is not None:
        entry["drill_depth_mm"] = clean(p.holes.depth * 1e3)
        entry["holes"] = p.holes.number
        entry["hole_angle_deg"] = clean(p.holes.angle_deg)
    return entry


def practical_columns(p: Practical) -> Iterator[tuple[str, float | None, str]]:
    """Name, value and unit of every workshop's figure but the unbalance, which the device has."""
    for key, value in practical_entry(p).items():
        name, _, unit = key.rpartition("_")
        if unit in ("kg", "mm", "N", "rpm", "deg"):
            yield name, value, unit
        elif key == "holes":
            yield key, value, ""


def number_devices(devices: Iterable[DeviceTable]) -> Iterator[tuple[str, DeviceTable]]:
    """Each device with its name among those of its kind: `shaft 2`."""
    numbers: Counter[str] = Counter()
    for device in devices:
        kind = name_kind(device)
        numbers[kind] += 1
        yield f"{kind} {numbers[kind]}", device


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


def _convert(value: float, size: float, unit: ShownUnit) -> float:
    """A value in units of this size (SI) in another unit; as it is where that is the same."""
    return value if unit.size == size else unit.of(value * size)

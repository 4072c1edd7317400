"""Show counterweights, balancer shafts and sliders of a remedy, and their figures for the
workshop.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING

from ..file.model import Counterweight, Shaft, Slider
from ..show.sheet import UNKNOWN, Grid, degrees, given, number
from ..sizing.planes import FIELDS, DeviceTable, find_free, find_unbalance, name_kind
from ..sizing.remedy import Remedy
from .records import find_value

if TYPE_CHECKING:
    from ..show.units import ShownUnit, System
    from ..sizing.workshop import Practical, Tools


_ORDER = ("ratio", "order", "unbalance", "angle", "direction", "position", "at")  # sequence in CSV
ANGLES = (
    "Angles count in the direction of rotation, clockwise seen from the free end (front). Angles "
    "of counterweights count from cylinder 1's crank pin, those of shafts from x."
)


# ------------------------------------------------------------------ for people
def device_grid(remedy: Remedy, system: System) -> Grid:
    """Return a table with one row for each device.

    Args:
        remedy: Devices.
        system: System of units.
    """
    devices, free, length = remedy.devices, find_free(remedy.devices), system.length
    unit = system.unbalance.fit(max(map(find_unbalance, devices), default=0.0))

    def cells(device: DeviceTable, anywhere: bool) -> tuple[str, ...]:
        turns, angle, place = "1", degrees(device.angle), "crank axis"
        if isinstance(device, Counterweight):
            angle += " from pin 1"
            place = f"crank of {device.engine}" if device.engine else place
        else:
            place = "free" if anywhere else ", ".join(_length(v, length) for v in device.at)
            turns = f"{device.ratio:+d}" if isinstance(device, Shaft) else str(device.order)
        if isinstance(device, Slider):
            angle += f" along {degrees(device.direction)}"
        unbalance, z = number(unit.of(find_unbalance(device))), _length(device.position, length)
        return name_kind(device), turns, unbalance, angle, place, z

    heads = ("speed ratio", unit.name, "angle, deg", f"x, y, {length.name}", f"z, {length.name}")
    rows = tuple(cells(*each) for each in zip(devices, free, strict=True))
    note = " ".join([ANGLES, *_explain_places(devices, free)])
    return Grid("", ("device", *heads), rows, note, words=(0, 3, 4))


def _explain_places(devices: Sequence[DeviceTable], free: Sequence[bool]) -> Iterator[str]:
    """Yield notes on shafts and sliders: where their angles count from, and where they may be."""
    if any(isinstance(device, Shaft) for device in devices):
        yield (
            "Angles of shafts are those at crank angle 0, and count in the direction in which the "
            "crank turns, even if a shaft turns against the crank."
        )
    if any(isinstance(device, Slider) for device in devices):
        yield "Angles of sliders: phase at crank angle 0, and direction of the path from x."
    if any(free):
        yield "free: the shaft may be anywhere, because it makes only a moment."
    shafts = zip(devices, free, strict=True)
    if any(isinstance(d, Shaft) and not any(d.at) and not anywhere for d, anywhere in shafts):
        yield (
            "At 0, 0 (on the crank axis), a shaft adds no roll about this axis; a real shaft "
            "elsewhere does."
        )


def _length(millimetres: float, unit: ShownUnit, digits: int | None = None) -> str:
    return number(unit.of(millimetres / 1e3), digits)


def list_radii(practical: Sequence[Practical], unit: ShownUnit) -> str:
    """Return in words the radii of the devices; equal radii are named once."""
    radii = dict.fromkeys(_length(each.radius_mm, unit, 4) for each in practical)
    return f"{', '.join(radii)} {unit.name}"


def practical_grid(remedy: Remedy, practical: tuple[Practical, ...], system: System) -> Grid:
    """Return a table of figures for the workshop, one row for each device.

    Args:
        remedy: Devices.
        practical: Figures for the workshop, one entry for each device; at least one entry.
        system: System of units.
    """
    length, mass, force = system.length, system.mass, system.force
    radius = list_radii(practical, length)
    note = f"Force: centrifugal. Mass: at a radius of {radius}. Disc: semicircular, of steel."
    if remedy.sliders:
        note = f"Force: largest over a stroke. Mass: at an amplitude of {radius}."
    rows = []
    for k, (device, p) in enumerate(zip(remedy.devices, practical, strict=True), 1):
        disc = [UNKNOWN, UNKNOWN]
        if not (isinstance(device, Slider) or p.disc_radius_mm is None):  # it is a disc
            thickness = p.disc_thickness_mm or 0.0
            disc = [_length(size, length, 3) for size in (p.disc_radius_mm, thickness)]
        at_speed = (given(p.speed_rpm), number(force.of(p.force_N)), number(mass.of(p.mass_kg)))
        rows.append((f"{k} {name_kind(device)}", *at_speed, *disc))
    units = (f"force, {force.name}", f"mass, {mass.name}")
    sizes = (f"disc r, {length.name}", f"thick, {length.name}")
    return Grid("Sizes of the weights", ("device", "rpm", *units, *sizes), tuple(rows), note)


def holes_grid(
    remedy: Remedy, practical: tuple[Practical, ...], tools: Tools, system: System
) -> Grid:
    """Return a table of holes to drill, one row for each device. The holes replace weights on the
    opposite side, or take slugs of heavy metal.

    Args:
        remedy: Devices.
        practical: Figures for the workshop, one entry for each device; at least one entry.
        tools: Tools of the workshop, with a drill.
        system: System of units.
    """
    unit = system.length
    drill = f"{number(unit.of(tools.drill or 0.0))} {unit.name}"
    why = "--radius" if tools.radius else "the crank radius; --radius changes it"
    rim = f"from a rim at {list_radii(practical, unit)} ({why})"
    rows = []
    for k, (device, p) in enumerate(zip(remedy.devices, practical, strict=True), 1):
        if p.holes is not None:
            at, depth = degrees(p.hole_angle_deg or 0.0), _length(p.drill_depth_mm or 0.0, unit, 4)
            rows.append((f"{k} {name_kind(device)}", at, f"{p.holes}", depth))
    if tools.slug is None:
        title = f"Holes to drill, {drill}"
        what = "Holes remove steel opposite to the weight that is needed. They are"
    else:
        title = f"Holes for slugs of {number(tools.slug / 1e3)} g/cm³, {drill}"
        what = "Slugs replace steel on the side of the weight that is needed. Holes are"
    note = f"{what} radial, {rim} inwards, and side by side along the axis."
    heads = ("for", "holes at, deg", "holes", f"depth of each, {unit.name}")
    return Grid(title, heads, tuple(rows), note)


def number_devices(devices: Iterable[DeviceTable]) -> Iterator[tuple[str, DeviceTable]]:
    """Yield the name (kind and number, such as `shaft 2`) of each device, and the device."""
    numbers: Counter[str] = Counter()
    for device in devices:
        kind = name_kind(device)
        numbers[kind] += 1
        yield f"{kind} {numbers[kind]}", device


def device_rows(device: DeviceTable, system: System) -> Iterator[tuple[str, float | str, str]]:
    """Yield name (as in an engine file), value and unit of every figure of a device.

    Args:
        device: Table of the device.
        system: System of units.
    """
    own = FIELDS[type(device)]
    if isinstance(device, Counterweight) and device.engine is not None:
        yield "engine", device.engine, ""
    figures = {field: find_value(device, field) for field in _ORDER if field in own}
    figures |= zip(("at_x", "at_y"), figures.pop("at", ()), strict=False)
    for field, value in figures.items():
        if field in ("position", "at_x", "at_y"):
            yield field, system.length.of(value / 1e3), system.length.name
        elif field == "unbalance":
            yield field, system.unbalance.of(value), system.unbalance.name
        else:
            yield field, value, "deg" if field in ("angle", "direction") else ""

"""Show counterweights, balancer shafts and sliders of a remedy, and their figures for the
workshop.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING

from ..file.fields import join_words
from ..file.model import Counterweight, Shaft, Slider
from ..show.sheet import UNKNOWN, Column, Grid, degrees, given, number, size_text, unit_cell
from ..sizing.planes import FIELDS, DeviceTable, find_free, find_unbalance, name_kind
from ..sizing.remedy import Remedy
from .records import find_value

if TYPE_CHECKING:
    from ..show.units import ShownUnit, System
    from ..sizing.workshop import Misfit, Practical, Tools


_ORDER = ("ratio", "order", "unbalance", "angle", "direction", "position", "at")  # sequence in CSV
ANGLES = (
    "Angles count in the direction of rotation, clockwise seen from the free end (front). Angles "
    "of counterweights count from cylinder 1's crank pin, those of shafts from x."
)
_OF_ENGINES = (
    "Angles of counterweights count from the pin of cylinder 1 of the engine that carries them, in "
    "the direction in which that engine turns: anticlockwise, seen from the free end (front), if "
    "it turns against the first. Angles of shafts count from x, in the direction of the first."
)


# ------------------------------------------------------------------ for people
def device_grid(remedy: Remedy, system: System) -> Grid:
    """Return a table with one row for each device.

    Args:
        remedy: Devices.
        system: System of units.
    """
    devices = remedy.devices
    free = find_free(devices)
    length = system.length
    unit = system.unbalance.fit_values(map(find_unbalance, devices))
    heads = [
        Column("device", words=True),
        Column("speed ratio"),
        Column(unit.name),
        Column("angle, deg", words=True),
        Column(f"x, y, {length.name}", words=True),
        Column(f"z, {length.name}"),
    ]
    rows = []
    for device, anywhere in zip(devices, free, strict=True):
        cells = (
            name_kind(device),
            _tell_turns(device),
            unit_cell(find_unbalance(device), unit),
            _tell_angle(device),
            _tell_place(device, length, anywhere),
            _length(device.position, length),
        )
        rows.append(cells)
    of_engines = any(isinstance(device, Counterweight) and device.engine for device in devices)
    angles = _OF_ENGINES if of_engines else ANGLES
    return Grid.of_rows("", heads, rows, " ".join([angles, *_explain_places(devices, free)]))


def _tell_turns(device: DeviceTable) -> str:
    """Return the speed of a device in multiples of the crank speed."""
    match device:
        case Counterweight():
            return "1"
        case Shaft():
            return f"{device.ratio:+g}"
        case Slider():
            return str(device.order)


def _tell_angle(device: DeviceTable) -> str:
    """Return the angle of a device; of a counterweight also what it counts from, of a slider the
    direction of its path.
    """
    angle = degrees(device.angle)
    match device:
        case Counterweight():
            return f"{angle} from pin 1"
        case Slider():
            return f"{angle} along {degrees(device.direction)}"
        case Shaft():
            return angle


def _tell_place(device: DeviceTable, unit: ShownUnit, anywhere: bool) -> str:
    """Return the place of a device's axis across the crank."""
    if isinstance(device, Counterweight):
        return f"crank of {device.engine}" if device.engine else "crank axis"
    if anywhere:
        return "free"
    x, y = device.at
    return f"{_length(x, unit)}, {_length(y, unit)}"


def _explain_places(devices: Sequence[DeviceTable], free: Sequence[bool]) -> Iterator[str]:
    """Yield notes on shafts and sliders: where their angles count from, and where they may be."""
    shafts = [device for device in devices if isinstance(device, Shaft)]
    if shafts:
        yield (
            "Angles of shafts are those at crank angle 0, and count in the direction in which the "
            "crank turns, even if a shaft turns against the crank."
        )
    if any(isinstance(device, Slider) for device in devices):
        yield "Angles of sliders: phase at crank angle 0, and direction of the path from x."
    if any(free):
        yield "free: the shaft may be anywhere, because it makes only a moment."
    on_axis = sum(not any(shaft.at) for shaft in shafts)
    if on_axis > sum(free):
        yield (
            "At 0, 0 (on the crank axis), a shaft adds no roll about this axis; a real shaft "
            "elsewhere does."
        )


def _length(millimetres: float, unit: ShownUnit, digits: int | None = None) -> str:
    return number(unit.of(millimetres / 1e3), digits)


def list_radii(practical: Sequence[Practical], unit: ShownUnit) -> str:
    """Return in words the radii of the devices; equal radii are named once."""
    radii = dict.fromkeys(_length(figures.radius_mm, unit, 4) for figures in practical)
    return f"{', '.join(radii)} {unit.name}"


def practical_grid(
    remedy: Remedy,
    practical: tuple[Practical, ...],
    tools: Tools,
    misfits: Sequence[Misfit],
    system: System,
) -> Grid:
    """Return a table of figures for the workshop, one row for each device.

    Args:
        remedy: Devices.
        practical: Figures for the workshop, one entry for each device; at least one entry.
        tools: Tools of the workshop.
        misfits: Counterweights whose half discs do not fit around the crank.
        system: System of units.
    """
    length = system.length
    mass = system.mass
    force = system.force
    heads = [
        Column("device", words=True),
        Column("rpm"),
        Column(f"force, {force.name}"),
        Column(f"mass, {mass.name}"),
        Column(f"disc r, {length.name}"),
        Column(f"thick, {length.name}"),
    ]
    rows = []
    for k, (device, figures) in enumerate(zip(remedy.devices, practical, strict=True), 1):
        row = [
            f"{k} {name_kind(device)}",
            given(figures.speed_rpm),
            unit_cell(figures.force_N, force),
            unit_cell(figures.shape_kg, mass),
            _disc_cell(figures.disc_radius_mm, length),
            _disc_cell(figures.disc_thickness_mm, length),
        ]
        rows.append(row)
    notes = ["Force: centrifugal; of sliders, the largest over a stroke."]
    if not remedy.sliders:
        notes = ["Force: centrifugal."]
    if any(p.disc_mass_kg is not None for p in practical):
        notes.append("Disc: semicircular, of steel.")
    if tools.radius is not None:
        heads.append(Column(f"at radius, {mass.name}"))
        for row, figures in zip(rows, practical, strict=True):
            row.append(unit_cell(figures.mass_kg, mass))
        radii = list_radii(practical, length)
        place = "a radius (of sliders, an amplitude)" if remedy.sliders else "a radius"
        notes.append(f"Last column: mass at {place} of {radii}.")
    notes += _tell_misfits([misfit for misfit in misfits if not misfit.asked], length)
    return Grid.of_rows("Sizes of the weights", heads, rows, " ".join(notes))


def _disc_cell(millimetres: float | None, unit: ShownUnit) -> str:
    if millimetres is None:
        return UNKNOWN
    return _length(millimetres, unit, 3)


def _tell_misfits(misfits: Sequence[Misfit], unit: ShownUnit) -> Iterator[str]:
    """Yield sentences on the counterweights for which the room around the crank has no half
    disc.
    """
    if unknown := [misfit for misfit in misfits if misfit.room.radius_m is None]:
        names = _name_misfits(unknown)
        yield f"The room for {names} is not known, so no half disc is stated."
    if without := [misfit for misfit in misfits if misfit.room.radius_m == 0]:
        yield (
            f"No half disc of steel fits for {_name_misfits(without)}: the pistons reach the crank "
            "axis."
        )
    thick = [misfit for misfit in misfits if misfit.disc is not None]
    if not thick:
        return
    thickest = max(thick, key=lambda misfit: misfit.thickness)
    yield (
        f"No half disc of steel fits for {_name_misfits(thick)}: at the radius of the room, "
        f"{size_text(thickest.room.radius_m or 0.0, unit)}, the thickness is "
        f"{size_text(thickest.thickness, unit)}; half the smallest distance of throws is "
        f"{size_text(thickest.room.thickness_m, unit)}."
    )


def _name_misfits(misfits: Sequence[Misfit]) -> str:
    """Return the numbers of the counterweights in words."""
    noun = "counterweight" if len(misfits) == 1 else "counterweights"
    return f"{noun} {join_words([str(misfit.number) for misfit in misfits])}"


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
    why = "as given" if tools.radius else "the crank radius"
    rim = f"from a rim at {list_radii(practical, unit)} ({why})"
    rows = []
    for k, (device, figures) in enumerate(zip(remedy.devices, practical, strict=True), 1):
        if figures.holes is not None:
            angle = degrees(figures.hole_angle_deg or 0.0)
            depth = _length(figures.drill_depth_mm or 0.0, unit, 4)
            rows.append((f"{k} {name_kind(device)}", angle, str(figures.holes), depth))
    if tools.slug is None:
        title = f"Holes to drill, {drill}"
        advice = "Holes remove steel opposite to the weight that is needed. They are"
    else:
        title = f"Holes for slugs of {number(tools.slug / 1e3)} g/cm³, {drill}"
        advice = "Slugs replace steel on the side of the weight that is needed. Holes are"
    note = f"{advice} radial, {rim} inwards, and side by side along the axis."
    heads = [
        Column("for", words=True),
        Column("holes at, deg"),
        Column("holes"),
        Column(f"depth of each, {unit.name}"),
    ]
    return Grid.of_rows(title, heads, rows, note)


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

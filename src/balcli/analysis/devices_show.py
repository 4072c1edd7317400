"""Show counterweights, balancer shafts and sliders of a remedy, and their figures for the
workshop.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

from ..core.records import list_figures, remove_unit, to_document
from ..file.model import Counterweight, Shaft, Slider
from ..forces.kinds import FORCE, MOMENT
from ..limits import SMALL, WORTH_A_SHAFT
from ..show.sheet import (
    UNKNOWN,
    Grid,
    capitalized,
    degrees,
    given,
    number,
    size_cell,
    size_text,
)
from ..sizing.ladder import SHAFT, SHAFTS, Ladder, LeftOut
from ..sizing.planes import FIELDS, DeviceTable, find_free, find_unbalance, name_kind
from ..sizing.remedy import Remedy
from .records import find_value

if TYPE_CHECKING:
    from ..engine.engine import Engine
    from ..show.units import ShownUnit, System
    from ..sizing.workshop import Practical, Tools


_ROUNDING = 1e-12  # a smaller share of one cylinder's value is rounding
_HARDLY = 0.05  # a smaller share of one cylinder's first order, %, would be printed as 0.0
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


def ladder_grid(
    ladder: Ladder, engine: Engine, system: System, *, tell_fitted: bool = True
) -> Grid:
    """Return a table with one row for each step of the ladder, and sentences on omitted steps.

    Args:
        ladder: Ladder to show.
        engine: Engine as drawn.
        system: System of units.
        tell_fitted: Whether a sentence names the step that `balcli balance` fits.
    """
    steps, scale = ladder.steps, ladder.scale
    columns = [("step", [f"{k} {step.title}" for k, step in enumerate(steps)])]
    for name, kind, key, of_one in (
        ("force", FORCE, "peak_force_N", scale.force_N),
        ("moment", MOMENT, "peak_moment_Nm", scale.moment_Nm),
        ("main bearing", FORCE, "main_bearing_N", scale.force_N),
    ):
        if of_one is not None and getattr(steps[0], key) is not None:
            sizes = [getattr(step, key) or 0.0 for step in steps]
            unit = system.unit(kind).fit(max(sizes))
            clean = (size if size > _ROUNDING * of_one else 0.0 for size in sizes)
            columns.append((f"{name}, {unit.name}", [size_cell(size, unit) for size in clean]))
    for name, key in (("weights", "counterweights"), ("shafts", "shafts")):
        columns.append((name, [str(getattr(step, key) or UNKNOWN) for step in steps]))
    mass = system.mass
    weigh = (number(mass.of(step.mass_kg), 3) if step.mass_kg else UNKNOWN for step in steps)
    columns.append((mass.name, [*weigh]))
    fitted = [step.step for step in steps].index(ladder.auto)
    notes = []
    if tell_fitted:
        option = "" if ladder.small == SMALL else f" --small {100 * ladder.small:g}%"
        what = f"step {fitted}" if fitted else "no step"
        notes.append(f"By default, `balcli balance{option}` applies {what}.")
        if fitted < len(steps) - 1:
            first = size_text(scale.force_N, system.force)
            if scale.moment_Nm is not None:
                first += f", {size_text(scale.moment_Nm, system.moment)}"
            least = f"{100 * WORTH_A_SHAFT:.0f} % of one cylinder's first order ({first})"
            notes.append(f"Each shaft of later steps would cancel less than {least}.")
    notes += [_tell_left_out(one, ladder, system) for one in ladder.left_out]
    at = "mean " * bool(engine.ripple) + f"{given(float(engine.speed_rpm))} rpm"
    title = f"What balances it, step by step ({at})"
    return Grid.of_columns(title, columns, " ".join(filter(None, notes)))


def _tell_left_out(out: LeftOut, ladder: Ladder, system: System) -> str:
    """Return a sentence on an omitted step: the force or the moment that it would remove, or the
    change of the main bearing load.
    """
    size, fall = abs(ladder.measure(out)), out.main_bearing_N
    if size < _HARDLY:
        return ""
    digits = f"{size:.1f}" if round(size, 1) < 100 * ladder.small else f"{size:.3g}"
    share = "" if math.isnan(size) else f" ({digits} % of one cylinder's first order)"
    if fall is not None:
        change = size_text(abs(fall), system.force)
        does = f"{'lower' if fall >= 0 else 'raise'} the largest main bearing load by {change}"
    else:
        force, moment, scale = out.force_N, out.moment_Nm or 0.0, ladder.scale
        by_moment = moment * scale.force_N > force * (scale.moment_Nm or 0.0)
        most = size_text(*((moment, system.moment) if by_moment else (force, system.force)))
        does = f"remove {'up to ' * (out.step == SHAFTS)}{most}"
    who = {SHAFT: f"a {SHAFT} is left out: it", SHAFTS: f"{SHAFTS} are left out: each"}
    what = who.get(out.step, f"{out.step} are left out: they")
    return f"{capitalized(what)} would {does}{share}."


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


def list_ladder(ladder: Ladder) -> Iterator[tuple[str, str, Any, str]]:
    """Yield step, name, value and SI unit of every figure of a ladder."""
    for step in ladder.steps:
        for name, value, unit in list_figures(to_document(step), ("step",)):
            yield step.step, remove_unit(name), value, unit


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

"""Compute the figures of a device for the workshop: mass at a radius, force, a first guess of its
size in steel, and holes to drill.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import count
from typing import Annotated, NamedTuple

import numpy as np

from ..core.phasors import wrap_degrees
from ..core.records import HIDDEN, Node
from ..core.unbalance import STEEL, find_drill_depth, find_drilled_unbalance
from ..engine.devices import find_sector
from ..engine.engine import Engine
from ..errors import Argument, ArgumentError, Message, check_number, join_messages
from ..file.model import Counterweight, Sector, Shaft, Slider
from ..file.read import T, TableReader
from .planes import DeviceTable, as_millimetres, find_order, find_unbalance
from .remedy import Remedy
from .room import HalfDisc, Room, find_rooms

ROUNDING = 1e-12  # share by which n holes may fall short before a hole is added


class Tools(NamedTuple):
    """Tools and limits of a workshop, lengths in m; None: not given.

    Attributes:
        radius: Radius at which masses are stated; default: the crank radius.
        thickness: Thickness of semicircular discs, from which their radius follows.
        disc: Radius of semicircular discs, from which their thickness follows; default for a
            counterweight: the radius of the room around the crank; for a shaft: half the thickness.
        drill: Diameter of the drill; without it no holes are planned.
        max_depth: Largest depth of holes; default: to the axis.
        slug: Density of slugs that fill the holes, kg/m3; default: empty holes.
        width: Axial room for a row of holes; default: the smallest distance of neighbouring
            throws, or the stroke if there is one throw or positions are not known.
    """

    radius: float | None = None
    thickness: float | None = None
    disc: float | None = None
    drill: float | None = None
    max_depth: float | None = None
    slug: float | None = None
    width: float | None = None


class Shapes(NamedTuple):
    """Shapes of new devices as machine parts; None: not given.

    Attributes:
        bearings: Places z of the two bearings of each new shaft, m.
        sector: Inner radius, m, outer radius, m, and opening, deg, of new counterweights, which
            are then sectors instead of half discs.
    """

    bearings: tuple[float, ...] | None = None
    sector: tuple[float, ...] | None = None


class Practical(NamedTuple):
    """The workshop's figures of a device.

    Attributes:
        unbalance_kg_m: Unbalance of the device.
        mass_kg: Mass at `radius_mm` that makes the unbalance; mass of a slider whose amplitude is
            `radius_mm`.
        radius_mm: Radius at which masses are stated.
        force_N: Centrifugal force, or largest force of a slider, at the engine's speed.
        speed_rpm: Speed of the shaft; for a slider, its oscillations a minute.
        disc_radius_mm: Radius of a semicircular steel disc whose diameter passes through the axis
            of rotation; this and the other figures of the disc are left out for a counterweight
            that is a sector or for which no disc fits, and for a slider.
        disc_thickness_mm: Thickness of this disc.
        disc_mass_kg: Mass of this disc.
        drill_depth_mm: Depth of each radial hole from a rim at `radius_mm` inwards. All figures of
            holes are None without a drill, and for sliders.
        holes: Number of equal holes side by side along the axis. Empty holes are opposite to the
            unbalance; holes with slugs are on its side.
        hole_angle_deg: Angle of the holes, measured like the angle of the device.
        sector_kg: Mass of a counterweight that is a sector; None for other devices.
    """

    unbalance_kg_m: float
    mass_kg: float
    radius_mm: float
    force_N: float
    speed_rpm: float
    disc_radius_mm: float | None = None
    disc_thickness_mm: float | None = None
    disc_mass_kg: float | None = None
    drill_depth_mm: float | None = None
    holes: int | None = None
    hole_angle_deg: float | None = None
    sector_kg: Annotated[float | None, HIDDEN] = None

    @property
    def shape_kg(self) -> float | None:
        """Mass of the half disc or of the sector; None without either."""
        return self.disc_mass_kg if self.sector_kg is None else self.sector_kg


class HolesDoNotFitError(ArgumentError):
    """More holes are needed than fit side by side on the crank."""


def find_practical(engine: Engine, remedy: Remedy, tools: Tools) -> tuple[Practical, ...]:
    """Return the workshop's figures of all devices, in the order of `remedy.devices`.

    Raises:
        ArgumentError: Figures of tools are impossible, or exclude each other.
        HolesDoNotFitError: Holes do not fit on the crank.
        TypeError: A figure is no number.
    """
    tools = Tools(*map(_check_figure, Tools._fields, tools))
    _refuse_impossible(tools)
    rim = min((_find_rim(engine, one, tools) for one in remedy.devices), default=math.inf)
    if tools.drill is not None and tools.drill > 2 * rim:
        raise ArgumentError(
            "{drill}: {width:g} mm is wider than a rim of radius {rim:g} mm",
            width=1e3 * tools.drill,
            rim=1e3 * rim,
        )
    width = tools.width or _find_width(engine, remedy)
    rooms = find_rooms(engine)
    figures = []
    for device in remedy.devices:
        shape = _find_shape(device, tools, rooms)
        figures.append(_find_figures(engine, device, tools, width, shape))
    return tuple(figures)


def _refuse_impossible(tools: Tools) -> None:
    """Raise ArgumentError for figures that are not above 0, or that exclude each other."""
    strange = []
    for name, figure in tools._asdict().items():
        if figure is None or 0 < figure < math.inf:
            continue
        shown = f"{1e-3 * figure:g} g/cm3" if name == "slug" else f"{1e3 * figure:g} mm"
        strange.append(Message("{argument}: {shown}", argument=Argument(name), shown=shown))
    if strange:
        raise ArgumentError("{strange}; give figures above 0", strange=join_messages(strange))
    if tools.drill is None and (tools.max_depth, tools.slug, tools.width) != (None,) * 3:
        raise ArgumentError("{max_depth}, {slug} and {width} are for holes: give {drill}")
    if tools.slug is not None and tools.slug <= STEEL:
        raise ArgumentError(
            "{slug}: {density:g} g/cm3 is not denser than steel", density=tools.slug / 1e3
        )
    if tools.thickness is not None and tools.disc is not None:
        raise ArgumentError("{disc} and {thickness}: give one of them, the other follows from it")


def _check_figure(name: str, figure: float | None) -> float | None:
    if figure is None:
        return None
    wanted = "a length in m, such as 0.02"
    if name == "slug":
        wanted = "a density in kg/m3, such as 17500"
    return check_number(f"Tools: {name}", figure, f"give {wanted}")


def _find_figures(
    engine: Engine, device: DeviceTable, tools: Tools, width: float, shape: Node
) -> Practical:
    """Return the figures of a device. `width` is the room for holes, m, and `shape` has the figures
    of its half disc or sector.
    """
    unbalance = find_unbalance(device)
    order = find_order(device)
    radius = _find_rim(engine, device, tools)
    return Practical(
        unbalance_kg_m=unbalance,
        mass_kg=unbalance / radius,
        radius_mm=1e3 * radius,
        force_N=unbalance * (order * float(engine.omega)) ** 2,
        speed_rpm=order * float(engine.speed_rpm),
        **shape,
        **_plan_holes(device, unbalance, radius, tools, width),
    )


def _plan_holes(
    device: DeviceTable, unbalance: float, rim: float, tools: Tools, room: float
) -> Node:
    """Return the smallest number of holes that the depth allows, with depth and angle.

    Raises:
        HolesDoNotFitError: More holes are needed than fit side by side.
    """
    if tools.drill is None or isinstance(device, Slider):
        return {}
    deepest = _find_deepest(rim, tools)
    density = _find_drilled_density(tools)
    of_one = find_drilled_unbalance(deepest, rim, tools.drill, density)
    needed = unbalance / of_one * (1 - ROUNDING) if of_one else math.inf
    count = max(float(np.ceil(needed)), 1.0)
    if tools.width is None and not isinstance(device, Counterweight):
        room = math.inf
    if count * tools.drill > room * (1 + ROUNDING) or math.isinf(count):
        fitting = _count_fitting(room, tools.drill)
        raise HolesDoNotFitError(
            "{drill} {size:g} mm: {count:g} holes for {wanted:.6g} g mm do not fit: {room:g} mm "
            "({width}) have room for {fitting:g} holes side by side, {possible:.6g} g mm; use a "
            "larger drill, {radius} or {max_depth}, or {slug}",
            size=1e3 * tools.drill,
            count=count,
            wanted=1e6 * unbalance,
            room=1e3 * room,
            fitting=fitting,
            possible=1e6 * fitting * of_one,
        )
    depth = find_drill_depth(unbalance / count, rim, tools.drill, density)
    depth = deepest if math.isnan(depth) else min(depth, deepest)
    angle = float(wrap_degrees(device.angle + (180 if tools.slug is None else 0), 360))
    return {"drill_depth_mm": 1e3 * depth, "holes": int(count), "hole_angle_deg": angle}


def _find_deepest(rim: float, tools: Tools) -> float:
    """Return the largest depth of a hole from a rim inwards, m."""
    return min(rim, tools.max_depth or rim)


def _find_drilled_density(tools: Tools) -> float:
    """Return the density of what a hole removes, kg/m3; with a slug, of what it adds."""
    return STEEL if tools.slug is None else tools.slug - STEEL


def _count_fitting(room: float, drill: float) -> float:
    """Return the number of holes that fit side by side."""
    return float(np.floor(room / drill * (1 + ROUNDING)))


class HoleRow(NamedTuple):
    """The holes that fit side by side in a plane, all as deep as possible.

    Attributes:
        holes: Number of holes.
        depth: Depth of each, m.
        rim: Radius from which they are drilled, m.
        room: Room along the crank, m.
        web: Thickness of the web in the plane, m, which may be less than the room; None: not known.
        unbalance: Unbalance that they remove (with slugs: add) together, kg m.
    """

    holes: int
    depth: float
    rim: float
    room: float
    web: float | None
    unbalance: float


def plan_hole_row(engine: Engine, remedy: Remedy, tools: Tools, z: float) -> HoleRow | None:
    """Return the holes that fit in a plane; None without a drill.

    Args:
        engine: Engine.
        remedy: New devices, whose planes limit the room.
        tools: Tools of the workshop.
        z: Position of the plane, m.
    """
    if tools.drill is None:
        return None
    rim = tools.radius or engine.find_radius(z)
    depth = _find_deepest(rim, tools)
    room = tools.width or _find_width(engine, remedy)
    count = _count_fitting(room, tools.drill)
    of_one = find_drilled_unbalance(depth, rim, tools.drill, _find_drilled_density(tools))
    web = None if engine.webs is None else engine.webs.find_nearest(z).body.thickness
    return HoleRow(int(count), depth, rim, room, web, count * of_one)


def _find_rim(engine: Engine, device: DeviceTable, tools: Tools) -> float:
    """Return the radius of a device, m: the given radius, or that of the nearest throw."""
    return tools.radius or engine.find_radius(device.position / 1e3)


def _find_width(engine: Engine, remedy: Remedy) -> float:
    """Return the room for holes along the crank, m: the smallest distance of neighbouring throws
    (the stroke if there is one throw or positions are not known), or of neighbouring planes of new
    counterweights if that is less.
    """
    places = engine.joined_throws_m
    room = float(np.diff(places).min()) if len(places) > 1 else 2 * engine.find_radius(places[0])
    planes = np.unique([weight.position / 1e3 for weight in remedy.counterweights])
    return min([room, *np.diff(planes).tolist()])


# ------------------------------------------------------------------ discs and sectors
class Misfit(NamedTuple):
    """A counterweight for which the room around the crank has no half disc, or not the one that is
    asked for.

    Attributes:
        number: Number of the device, from 1.
        room: Room around its crank.
        disc: Half disc that would be needed; None if the radius of the room is not known.
        asked: Whether the half disc was asked for, and is listed though it does not fit.
    """

    number: int
    room: Room
    disc: HalfDisc | None
    asked: bool

    @property
    def thickness(self) -> float:
        """Thickness of the half disc, m; 0 without one."""
        return 0.0 if self.disc is None else self.disc.thickness


def find_misfits(engine: Engine, remedy: Remedy, tools: Tools) -> tuple[Misfit, ...]:
    """Return the counterweights whose half discs the room around the crank does not have.

    Args:
        engine: Engine without the new devices.
        remedy: New devices.
        tools: Tools of the workshop, which may ask for a radius or a thickness.
    """
    rooms = find_rooms(engine)
    misfits = []
    for number, device in enumerate(remedy.devices, 1):
        if not isinstance(device, Counterweight) or device.sector is not None:
            continue
        room = rooms[device.engine]
        asked = _find_asked_disc(device, tools)
        disc = asked or room.find_disc(find_unbalance(device))
        is_unlimited = asked is not None and room.radius_m is None
        if not (is_unlimited or room.takes(disc)):
            misfits.append(Misfit(number, room, disc, asked is not None))
    return tuple(misfits)


def _find_shape(device: DeviceTable, tools: Tools, rooms: Mapping[str | None, Room]) -> Node:
    """Return the figures of a device's half disc or sector; empty for a slider, and for a
    counterweight that fits in no half disc.
    """
    if isinstance(device, Slider):
        return {}
    if isinstance(device, (Counterweight, Shaft)) and device.sector is not None:
        return {"sector_kg": float(find_sector(device, device.sector).mass)}
    disc = _find_asked_disc(device, tools)
    if disc is None and isinstance(device, Counterweight):
        disc = rooms[device.engine].shape(find_unbalance(device))
    elif disc is None:
        disc = HalfDisc.as_long_as_wide(find_unbalance(device))
    if disc is None:
        return {}
    return {
        "disc_radius_mm": 1e3 * disc.radius,
        "disc_thickness_mm": 1e3 * disc.thickness,
        "disc_mass_kg": disc.mass,
    }


def _find_asked_disc(device: DeviceTable, tools: Tools) -> HalfDisc | None:
    """Return the half disc of the radius or thickness that is asked for; None if neither is."""
    if tools.disc is not None:
        return HalfDisc.of_radius(find_unbalance(device), tools.disc)
    if tools.thickness is not None:
        return HalfDisc.of_thickness(find_unbalance(device), tools.thickness)
    return None


# ------------------------------------------------------------------ shapes of new devices
def shape_devices(engine: Engine, remedy: Remedy, shapes: Shapes) -> Remedy:
    """Return the remedy with its counterweights as sectors if a sector is given, and its shafts
    with names and bearings if bearings are given. Eccentrics on one axis at one speed form one
    shaft.

    Args:
        engine: Engine without the new devices.
        remedy: New devices.
        shapes: Bearings and sector.

    Raises:
        ArgumentError: Bearings or sector are impossible, or no new device can have them.
    """
    for key, devices in (("sector", remedy.counterweights), ("bearings", remedy.shafts)):
        if getattr(shapes, key) is not None and not devices:
            raise ArgumentError(
                "{argument}: scheme {name} fits no device with {key}",
                argument=Argument(key),
                name=remedy.scheme,
                key=key,
            )
    of_weights: Node = {}
    if shapes.sector is not None:
        of_weights["sector"] = _read_sector(shapes.sector)
    of_axes: dict[object, Node] = {}
    if shapes.bearings is not None:
        of_axes = _name_shafts(engine, remedy.shafts, _read_bearings(shapes.bearings))
    shaped = []
    for device in remedy.devices:
        shape: Node = {}
        if isinstance(device, Counterweight):
            shape = of_weights
        elif isinstance(device, Shaft):
            shape = of_axes.get((device.ratio, device.at), {})
        shaped.append(device.model_copy(update=shape))
        shape.pop("bearings", None)  # only the first eccentric of a shaft has the key
    return remedy._replace(devices=tuple(shaped))


def _name_shafts(engine: Engine, shafts: Sequence[Shaft], bearings: Node) -> dict[object, Node]:
    """Return name and bearings of each new shaft by its speed ratio and axis. Names are "balancer
    1", "balancer 2", ... without those that the file uses.
    """
    used = set() if engine.model is None else {shaft.name for shaft in engine.model.shaft}
    free = (name for name in map("balancer {}".format, count(1)) if name not in used)
    named: dict[object, Node] = {}
    for shaft in shafts:
        axis = (shaft.ratio, shaft.at)
        if axis not in named:
            named[axis] = {"name": next(free), **bearings}
    return named


def _read_sector(values: Sequence[float]) -> Sector | None:
    """Return a sector whose thickness follows from the unbalance."""
    sector = dict(zip(("inner_radius", "outer_radius", "opening"), values, strict=False))
    sector |= {key: as_millimetres(value) for key, value in sector.items() if key != "opening"}
    return _read_table("sector", {"unbalance": 1, "sector": sector}, Counterweight).sector


def _read_bearings(values: Sequence[float]) -> Node:
    """Return the key `bearings` of a shaft."""
    places = [as_millimetres(z) for z in values]
    shaft = _read_table("bearings", {"ratio": 1, "inertia": 1, "bearings": places}, Shaft)
    return {"bearings": shaft.bearings}


def _read_table(argument: str, values: Node, table: type[T]) -> T:
    reader = TableReader("an option")
    read = reader.read_table(argument, values, table)
    if read is None:
        raise ArgumentError(
            "{argument}: {problems}",
            argument=Argument(argument),
            problems="; ".join(problem.message for problem in reader.problems),
        )
    return read

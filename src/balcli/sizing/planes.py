"""Choose positions of devices along the crank, and handle devices as tables of the engine file (g
mm, degrees, mm). Analyses use the figures of these tables, so an engine file with the same tables
gives the same results. `sense` is 1 for forces and moments that turn with the crank, -1 for those
that turn against it.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from ..core.phasors import EPS, wrap_degrees
from ..engine.engine import Engine, Placed
from ..errors import MOMENTS_UNKNOWN, ArgumentError
from ..file.fields import limit_digits
from ..file.model import Counterweight, Shaft, Slider
from .options import SchemeOptions
from .residual import Residual, ResidualPart

if TYPE_CHECKING:
    from ..engine.webs.build import Webs

SAME_PLACE = (
    "one plane, or planes at the same z, cannot take a moment; choose two planes with some "
    "distance between them"
)


def find_ends(engine: Engine) -> tuple[float, float]:
    """Return z of the end planes, m: the first and the last throw. If all throws are in one plane,
    the end planes are half a bore (without a bore: the crank radius) on either side of it.
    """
    low, high = _find_end_throws(engine)
    if low < high:
        return low, high
    bore = float(engine.bore_m)
    half = bore / 2 if bore > 0 else engine.find_radius(low)
    return low - half, high + half


def explain_ends(engine: Engine) -> str:
    """Return in words where the end planes are if they are not the first and the last throw; empty
    if they are.
    """
    low, high = _find_end_throws(engine)
    if low < high:
        return ""
    distance = "half a bore" if engine.bore_m > 0 else "the crank radius"
    return f"the throws count as one plane, and the weights stand {distance} on either side of it"


def _find_end_throws(engine: Engine) -> tuple[float, float]:
    """Return z of the first and the last throw of all cranks, m."""
    throws = [move_along(crank).engine.joined_throws_m for crank in engine.cranks]
    places = np.concatenate(throws)
    return float(places.min()), float(places.max())


def find_carriers(engine: Engine) -> dict[int, Placed]:
    """Return the first of the cranks that turn in each direction (1: as the first crank, -1:
    against it), moved to its position along z.
    """
    first = {crank.ratio: crank for crank in reversed(engine.cranks)}
    return {sense: move_along(first[sense]) for sense in sorted(first, reverse=True)}


def move_along(placed: Placed) -> Placed:
    """Return a geared engine with its places along z in the coordinates of all engines together."""
    own = placed.engine
    z = float(placed.at_m[2])
    if not z:
        return placed
    cylinders = replace(own.cylinders, z=own.cylinders.z + z)
    devices = tuple(device._replace(z=device.z + z) for device in own.devices)
    moved = replace(own, throws_m=own.throws_m + z, pins_m=own.pins_m + z, devices=devices)
    return placed._replace(engine=replace(moved, cylinders=cylinders))


def find_length(engine: Engine) -> tuple[float, float]:
    """Return z of the first and the last throw or cylinder, m."""
    places: list[float] = []
    for crank in engine.cranks:
        own = move_along(crank).engine
        places += map(float, own.throws_m)
        places += map(float, np.ravel(own.cylinders.z))
    return min(places), max(places)


def locate_force(residual: Residual, sense: int) -> float:
    """Return the z (m) at which the force that turns in the direction `sense` would cause as much
    of the moment as possible: `z_ref + Re(M / iV)` (M: moment, V: force, both turning in this
    direction; z_ref: z of the point of reference). The force must not be 0.
    """
    return residual.reference.z + (residual.moment(sense) / residual.force(sense)).real


def find_single_plane(engine: Engine, residual: Residual, sense: int) -> tuple[float, bool]:
    """Return the z (m) within the engine that is nearest to where the force that turns in the
    direction `sense` acts, and whether a device at this z that cancels the force cancels the moment
    as well. The force must not be 0.
    """
    low, high = find_length(engine)
    near = min(max(locate_force(residual, sense), low), high)
    rounded = round(near, 12)  # m; short decimals are easier to read
    for z in (rounded, near):
        if takes_moment(residual, sense, z):
            return z, True
    return round(near, 9), False


def takes_moment(residual: Residual, sense: int, z: float) -> bool:
    """Return whether a device at z (m) that cancels the force turning in the direction `sense` also
    cancels the moment turning in this direction.
    """
    left = residual.moment(sense) - (z - residual.reference.z) * residual.force(sense)
    return abs(left) <= residual.noise[ResidualPart("moment", sense)]


def choose_plane(engine: Engine, options: SchemeOptions, residual: Residual, sense: int) -> float:
    """Return the z (m) of the option `position`; by default, the z within the engine that is
    nearest to where the force that turns in the direction `sense` acts.
    """
    return read_position(options, find_single_plane(engine, residual, sense)[0])


def read_position(options: SchemeOptions, usual: float) -> float:
    """Return the z (m) of the option `position`, by default `usual`; ArgumentError for several
    z.
    """
    if isinstance(options.position, tuple):
        raise ArgumentError("{position}: this scheme takes only one position along z")
    return usual if options.position is None else options.position


def find_planes(engine: Engine, residual: Residual, sense: int) -> tuple[float, ...]:
    """Return the fewest planes (z, m) in which devices cancel the force and the moment that turn in
    the direction `sense`: one plane if that suffices, else the two end planes; empty if there is
    nothing to cancel.
    """
    if residual.force(sense):
        z, enough = find_single_plane(engine, residual, sense)
        if enough:
            return (z,)
    elif not residual.moment(sense):
        return ()
    return find_ends(engine)


def read_planes(engine: Engine, options: SchemeOptions) -> tuple[float, ...]:
    """Return the given planes (z, m); ArgumentError for several planes if moments are not
    known.
    """
    if options.planes == "ends":
        return tuple(dict.fromkeys(find_ends(engine)))
    if options.planes == "throws":
        return tuple(dict.fromkeys(float(z) for z in engine.throws_m))
    if options.planes == "webs":
        return tuple(float(web.z) for web in take_webs(engine).webs)
    places = options.planes if isinstance(options.planes, tuple) else ()
    if len(set(places)) > 1 and not engine.places_known:
        raise ArgumentError("{planes}: {unknown}", unknown=MOMENTS_UNKNOWN)
    return places


def take_webs(engine: Engine) -> Webs:
    """Return the webs of an engine; ArgumentError for a file without [[web]]."""
    if engine.webs is None:
        raise ArgumentError(
            "{planes} webs: the file has no [[web]]; give ends, throws, or places along z"
        )
    return engine.webs


def read_two_planes(engine: Engine, options: SchemeOptions) -> tuple[float, float]:
    """Return the two given planes (z, m), by default the ends; ArgumentError if there are not
    two.
    """
    planes = find_ends(engine) if options.planes in (None, "ends") else options.planes
    if not isinstance(planes, tuple) or len(planes) != 2:
        raise ArgumentError("{planes}: give ends, or two places along z, for opposite eccentrics")
    low, high = planes
    if low == high:
        raise ArgumentError("{planes}: {same}", same=SAME_PLACE)
    return low, high


DeviceTable: TypeAlias = Counterweight | Shaft | Slider

# Kinds of devices in the order of the file, with the keys that describe a new device.
FIELDS: dict[type[DeviceTable], tuple[str, ...]] = {
    Counterweight: ("unbalance", "angle", "position", "axle"),
    Shaft: ("ratio", "unbalance", "angle", "at", "position"),
    Slider: ("order", "unbalance", "direction", "angle", "at", "position"),
}
KINDS = tuple(FIELDS)
TABLES = ("counterweight", "shaft", "slider")  # tables of these kinds in an engine file
_ROUNDING = (
    1e-10  # a sum of eccentrics below this share of the largest counts as 0: figures have 12 digits
)


def name_kind(device: DeviceTable) -> str:
    """Return the name of a device's table: "counterweight", "shaft" or "slider"."""
    return type(device).__name__.lower()


def round_figures(device: DeviceTable) -> DeviceTable:
    """Return a device with the digits that a file has."""
    figures = {key: limit_digits(getattr(device, key)) for key in FIELDS[type(device)]}
    return device.model_copy(update=figures)


def find_order(device: DeviceTable) -> float:
    """Return the number of turns or oscillations of a device per turn of the crank."""
    match device:
        case Counterweight():
            return 1
        case Shaft():
            return abs(device.ratio)
        case Slider():
            return device.order


def find_unbalance(device: DeviceTable) -> float:
    """Return the unbalance of a device with given or fitted unbalance, kg m."""
    return (device.unbalance or 0.0) / 1e6


def find_free(devices: Sequence[DeviceTable]) -> tuple[bool, ...]:
    """Return whether each device belongs to a shaft that may be anywhere: the eccentrics of the
    shaft together make a moment but no force, and x and y are not given.
    """
    shafts: dict[float, list[Shaft]] = {}  # by speed ratio
    for device in devices:
        if isinstance(device, Shaft) and not any(device.at):
            shafts.setdefault(device.ratio, []).append(device)
    free: list[Shaft] = []
    for eccentrics in shafts.values():
        if len(eccentrics) > 1 and _cancel(eccentrics):
            free += eccentrics
    return tuple(any(device is shaft for shaft in free) for device in devices)


def _cancel(eccentrics: Sequence[Shaft]) -> bool:
    """Return whether the forces of the eccentrics of a shaft cancel each other."""
    forces = []
    for eccentric in eccentrics:
        forces.append(cmath.rect(find_unbalance(eccentric), math.radians(eccentric.angle)))
    return abs(sum(forces)) <= _ROUNDING * max(map(abs, forces))


def measure_direction(vector: complex, origin_deg: float = 0.0) -> float:
    """Return the direction of a vector, degrees from `origin_deg`, in (-180, 180]."""
    return _plain(float(wrap_degrees(math.degrees(cmath.phase(vector)) - origin_deg, 360)), 360)


def as_millimetres(metres: float) -> float:
    """Return a length in mm without rounding errors in its last digits."""
    return _plain(metres * 1e3, abs(metres * 1e3))


def _plain(figure: float, size: float) -> float:
    """Return the figure with nine decimals if that changes it by less than an ulp of `size`."""
    short = round(figure, 9) + 0.0
    return short if abs(figure - short) <= size * EPS else figure

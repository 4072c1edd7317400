"""Balancer shafts in their bearings, and counterweights as sectors (`analyze --only parts`).

The load `F_i = U_i k^2 omega^2 e^{i angle_i}` of an eccentric at z_i turns with its shaft, which
turns k times as fast as the crank. Of its two bearings A takes `sum F_i (z_B - z_i)/(z_B - z_A)`,
B the rest. The bending moment at a section is the sum of all loads and bearing forces before it,
each times its arm; it is largest at a load or bearing.

A gear that drives the shaft against a drag T presses on it, at the mesh in direction d, with `T/R
e^{i d} (i sign(k) - tan alpha)`, R the pitch radius, alpha the pressure angle. This force stands
still; the lever rule shares it, too.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from ..core.cylinders import find_innermost
from ..core.loads import find_arms
from ..core.phasors import Array, Complex, unit, wrap_degrees
from ..core.records import find_unit, list_figures, to_document
from ..engine.devices import build_device, find_given_unbalance, find_sector
from ..engine.engine import Engine, take_model
from ..file.model import Counterweight, Shaft, group_eccentrics
from ..show.figures import FigureRow
from ..show.sheet import UNKNOWN, Facts, Grid, Text, degrees, number, size_text
from ..show.units import ShownUnit, System, name_with_unit
from .records import BalanceParts, BalancerShaft, CounterweightPart, ShaftBearing, ShaftGear

_ROUNDING = 1e-12  # of the sum of all loads: less is no load


def find_parts(engine: Engine) -> BalanceParts:
    """Return the balancer shafts and counterweights of an engine file as parts, at the mean speed.

    Args:
        engine: Engine without trailing axes.

    Raises:
        BalcliError: No file describes this engine.
    """
    model = take_model(engine)
    return describe_parts(engine, model.shaft, model.counterweight)


def describe_parts(
    engine: Engine, shafts: Sequence[Shaft], counterweights: Sequence[Counterweight]
) -> BalanceParts:
    """Return balancer shafts and counterweights of an engine as parts.

    Args:
        engine: Engine without trailing axes.
        shafts: Entries of its balancer shafts.
        counterweights: Its counterweights.
    """
    skirt = None if engine.model is None else engine.model.piston.skirt
    lowest = None
    if skirt is not None and not engine.rotary:  # counterweights there turn with the cylinders
        lowest = float(find_innermost(engine.cylinders).min()) - skirt / 1e3
    return BalanceParts(
        tuple(
            _describe_shaft(name, [*entries.values()], float(engine.omega))
            for name, entries in group_eccentrics(shafts)
        ),
        tuple(_describe_counterweight(one, lowest) for one in counterweights),
    )


# ------------------------------------------------------------------ shafts
def _describe_shaft(name: str, entries: Sequence[Shaft], omega: float) -> BalancerShaft:
    """Return a shaft in its bearings.

    Args:
        name: Name of the shaft.
        entries: Its tables.
        omega: Crank speed, rad/s.
    """
    devices = [build_device(entry, 0.0) for entry in entries]
    order, ratio = devices[0].order, entries[0].ratio
    shaft = BalancerShaft(name, ratio, order * sum(abs(float(d.spin)) for d in devices))
    bearings = next((entry.bearings for entry in entries if entry.bearings), None)
    if bearings is None:
        return shaft
    gear = next((entry.gear for entry in entries if entry.gear), None)
    drag = max(entry.drag for entry in entries)
    vectors: Complex = np.array([d.forward + d.backward for d in devices], complex)
    loads: Complex = (order * omega) ** 2 * vectors
    places, planes = np.array([float(d.z) for d in devices]), np.array(bearings) / 1e3
    turning = _share(loads, places, planes)
    fixed, described = np.zeros(2, complex), None
    if gear is not None:
        tangential, slope = 1e3 * drag / gear.radius, math.tan(math.radians(gear.pressure_angle))
        described = ShaftGear(tangential, tangential * slope, drag * order * omega)
        force = tangential * unit(gear.direction) * (1j * np.sign(ratio) - slope)
        fixed = _share(np.array([force]), np.array([gear.position / 1e3]), planes)
    bending, place = _find_bending(loads, places, turning, planes)
    return shaft._replace(
        bearings=tuple(map(_describe_bearing, bearings, turning.tolist(), fixed.tolist())),
        bending_Nm=bending,
        bending_position_mm=place,
        gear=described,
    )


def _share(loads: Complex, places: Array, planes: Array) -> Complex:
    """Return the loads of two bearings, N, shape (2,).

    Args:
        loads: Forces on the shaft, N, shape (loads,).
        places: Their places, m, shape (loads,).
        planes: Places of the bearings, m, shape (2,).
    """
    other = planes[::-1]
    found: Complex = ((other[:, None] - places) / (other - planes)[:, None]) @ loads
    return np.where(np.abs(found) <= _ROUNDING * np.abs(loads).sum(), 0, found)


def _describe_bearing(position_mm: float, turning: complex, fixed: complex) -> ShaftBearing:
    return ShaftBearing(
        position_mm=position_mm,
        rotating_N=abs(turning),
        fixed_N=abs(fixed),
        largest_N=abs(turning) + abs(fixed),
        rotating_deg=_find_direction(turning) if turning else None,
        fixed_deg=_find_direction(fixed) if fixed else None,
    )


def _find_direction(vector: complex) -> float:
    """Return the direction of a vector from x, deg, in (-180, 180]."""
    return float(wrap_degrees(math.degrees(math.atan2(vector.imag, vector.real)), 360))


def _find_bending(
    loads: Complex, places: Array, reactions: Complex, planes: Array
) -> tuple[float, float | None]:
    """Return the largest bending moment, N m, and its place, mm; None where nothing bends.

    Args:
        loads: Forces on the shaft, N, shape (loads,).
        places: Their places, m, shape (loads,).
        reactions: Loads of the bearings, N, shape (2,).
        planes: Places of the bearings, m, shape (2,).
    """
    z = np.sort(np.concatenate([places, planes]))
    moments = np.abs(find_arms(places, z) @ loads - find_arms(planes, z) @ reactions)
    largest = float(moments.max())
    if largest <= _ROUNDING * float(np.abs(loads).sum() * np.ptp(z)):
        return 0.0, None
    first = np.flatnonzero(moments >= largest * (1 - _ROUNDING))[0]
    return largest, 1e3 * float(z[first])


# ------------------------------------------------------------------ counterweights
def _describe_counterweight(table: Counterweight, lowest: float | None) -> CounterweightPart:
    """Return a counterweight as a part.

    Args:
        table: The counterweight.
        lowest: Least distance of a piston's lowest edge from the crank axis, m; None: not known.
    """
    angle = float(wrap_degrees(table.angle, 360))
    if (sector := table.sector) is None:
        return CounterweightPart(table.position, angle, float(find_given_unbalance(table) or 0.0))
    found = find_sector(table, sector)
    return CounterweightPart(
        position_mm=table.position,
        angle_deg=angle,
        unbalance_kg_m=float(found.unbalance),
        mass_kg=float(found.mass),
        center_of_mass_m=float(found.center_of_mass),
        thickness_m=float(found.thickness),
        inertia_kg_m2=float(found.inertia),
        clearance_m=None if lowest is None else lowest - sector.outer_radius / 1e3,
    )


# ------------------------------------------------------------------ how it is shown
_BEARINGS_NOTE = (
    "Bearing loads depend on the resultant force and moment and on the bearing places only; "
    "moving weights without changing both changes bending only."
)
_CLEARANCE_NOTE = (
    "Clearance: from the rim to the lowest edge of a piston at its inner dead centre; on the safe "
    "side where a counterweight does not stand opposite its pin."
)
_LABELS = {
    "position_mm": "z",
    "angle_deg": "at",
    "unbalance_kg_m": "unbalance",
    "mass_kg": "mass",
    "center_of_mass_m": "centre of mass",
    "thickness_m": "thickness",
    "inertia_kg_m2": "inertia",
    "clearance_m": "clearance",
}


def lay_out_parts(parts: BalanceParts, system: System) -> Iterator[Grid | Facts | Text]:
    """Yield a table of the shafts in their bearings, lines on each shaft, and a table of the
    counterweights.

    Args:
        parts: Shafts and counterweights.
        system: System of units.
    """
    if any(shaft.bearings for shaft in parts.shafts):
        yield _lay_out_bearings(parts.shafts, system)
    if parts.shafts:
        pairs = tuple((shaft.name, _tell_shaft(shaft, system)) for shaft in parts.shafts)
        yield Facts(pairs, "Bending, inertia and drag of shafts")
    if parts.counterweights:
        yield _lay_out_counterweights(parts.counterweights, system)
    if not (parts.shafts or parts.counterweights):
        yield Text("Parts", ("The file has no balancer shafts and no counterweights.",))


def _lay_out_bearings(shafts: Sequence[BalancerShaft], system: System) -> Grid:
    pairs = [(shaft.name, bearing) for shaft in shafts for bearing in shaft.bearings or ()]
    unit = system.force.fit(max(bearing.largest_N for _, bearing in pairs))
    heads = (f"bearing, {system.length.name}", f"turning, {unit.name}", "at, deg")
    largest = (f"fixed, {unit.name}", f"largest, {unit.name}")
    rows = tuple(
        (
            name,
            number(system.length.of(bearing.position_mm / 1e3)),
            number(unit.of(bearing.rotating_N)),
            "" if bearing.rotating_deg is None else degrees(bearing.rotating_deg),
            number(unit.of(bearing.fixed_N)),
            number(unit.of(bearing.largest_N)),
        )
        for name, bearing in pairs
    )
    return Grid("Balancer shafts", ("shaft", *heads, *largest), rows, _BEARINGS_NOTE)


def _tell_shaft(shaft: BalancerShaft, system: System) -> str:
    """Return in words ratio, bending, inertia and drag of a shaft."""
    inertia, length = system.of_parts["kg·m²"], system.length
    told = [f"ratio {shaft.ratio:+d}"]
    if shaft.bending_Nm is not None:
        bending = f"bending {size_text(shaft.bending_Nm, system.moment)}"
        if shaft.bending_position_mm is not None:
            place = number(length.of(shaft.bending_position_mm / 1e3))
            bending += f" at z = {place} {length.name}"
        told.append(bending)
    if shaft.inertia_at_crank_kg_m2:
        told.append(f"inertia at the crank {size_text(shaft.inertia_at_crank_kg_m2, inertia)}")
    if shaft.gear is not None:
        told.append(f"drag {size_text(shaft.gear.power_W, system.heat)}")
    return ", ".join(told)


def _lay_out_counterweights(parts: Sequence[CounterweightPart], system: System) -> Grid:
    length, largest = system.length, max(abs(part.unbalance_kg_m) for part in parts)
    units = system.of_parts | {
        "deg": ShownUnit("deg", 1),
        "mm": ShownUnit(length.name, 1e3 * length.size),
        "kg·m": system.unbalance.fit(largest),
    }
    columns = [("counterweight", [str(k) for k in range(1, len(parts) + 1)])]
    for key, label in _LABELS.items():
        values, unit = [getattr(part, key) for part in parts], units[find_unit(key)]
        if any(value is not None for value in values):
            cells = [UNKNOWN if value is None else number(unit.of(value)) for value in values]
            columns.append((name_with_unit(label, unit.name), cells))
    has_clearance = any(part.clearance_m is not None for part in parts)
    return Grid.of_columns("Counterweights", columns, _CLEARANCE_NOTE if has_clearance else "")


def list_part_rows(parts: BalanceParts) -> Iterator[FigureRow]:
    """Yield every figure of shafts and counterweights, SI."""
    for shaft in parts.shafts:
        for name, value, unit_ in list_figures(to_document(shaft), ("name",)):
            label = f"shaft {shaft.name.removeprefix('shaft ')}"
            yield FigureRow(0, label, None, name, value, unit_)
    for k, part in enumerate(parts.counterweights, 1):
        for name, value, unit_ in list_figures(to_document(part)):
            yield FigureRow(0, f"counterweight {k}", None, name, value, unit_)

"""Compute the bearing loads and bending of balancer shafts, and the shapes of counterweights
(`analyze --only parts`).

A shaft with the speed ratio k turns at k times the crank speed omega. Its eccentric number j has
the unbalance U_j at the position z_j, in the direction angle_j at crank angle 0, and loads the
shaft with the force `F_j = U_j k^2 omega^2 e^{i angle_j}` (i: imaginary unit). This load turns with
the shaft. The bearing at z_A takes `sum F_j (z_B - z_j)/(z_B - z_A)`, the bearing at z_B the rest.
The bending moment at a section is the sum of all loads and bearing forces before the section, each
times its distance from the section. It is largest at a load or bearing.

A gear may drive the shaft against a drag torque T. With the mesh in direction d from the axis of
the shaft, the pitch radius R and the pressure angle alpha, the gear presses on the shaft with the
force `T/R e^{i d} (i sign(k) - tan alpha)`. This force has a fixed direction; the lever rule shares
it between the bearings as well.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from ..core.loads import find_arms
from ..core.phasors import Array, Complex, unit, wrap_degrees
from ..core.records import Node, find_unit, remove_unit
from ..engine.devices import build_device, find_given_unbalance, find_sector, group_eccentrics
from ..engine.engine import Engine, refuse_geared
from ..file.model import Counterweight, Sector, Shaft
from ..show.figures import FigureRow, record_rows
from ..show.sheet import UNKNOWN, Column, Facts, Grid, Text, size_text, unit_cell
from ..show.units import ShownUnit, System, name_with_unit
from ..sizing.planes import measure_direction
from ..sizing.room import find_lowest_edge
from .records import (
    BalanceParts,
    BalancerShaft,
    CounterweightPart,
    Eccentric,
    ShaftBearing,
    ShaftGear,
)
from .web_parts import (
    describe_crank,
    describe_throws,
    describe_webs,
    lay_out_webs,
    list_web_rows,
)

_ROUNDING = 1e-12  # share of the sum of all loads; a smaller load is rounding


def find_parts(
    engine: Engine,
    shafts: Sequence[Shaft],
    counterweights: Sequence[Counterweight],
    *,
    throws: bool = False,
) -> BalanceParts:
    """Return bearing loads of balancer shafts, at the mean speed, shapes of counterweights, and the
    webs of the crankshaft.

    Args:
        engine: One engine, not an array of variants.
        shafts: The `[[shaft]]` tables of the engine.
        counterweights: The `[[counterweight]]` tables of the engine.
        throws: Whether to describe the throws as well.
    """
    refuse_geared(engine)
    omega = float(engine.omega)
    lowest = find_lowest_edge(engine)
    described = []
    eccentrics = []
    for name, entries in group_eccentrics(shafts):
        described.append(_describe_shaft(name, [*entries.values()], omega))
        for entry in entries.values():
            if entry.sector is not None:
                eccentrics.append(_describe_eccentric(name, entry, entry.sector))
    weights = tuple(_describe_counterweight(table, lowest) for table in counterweights)
    return BalanceParts(
        tuple(described),
        weights,
        tuple(eccentrics) or None,
        webs=describe_webs(engine),
        throws=describe_throws(engine) if throws else None,
        crank=describe_crank(engine),
    )


# ------------------------------------------------------------------ shafts
def _describe_shaft(name: str, entries: Sequence[Shaft], omega: float) -> BalancerShaft:
    """Return bearing loads, bending, inertia and gear of a balancer shaft.

    Args:
        name: Name of the shaft.
        entries: The `[[shaft]]` tables of this shaft.
        omega: Crank speed, rad/s.
    """
    devices = [build_device(entry, 0.0) for entry in entries]
    order = devices[0].order
    inertia = order * sum(abs(float(device.spin)) for device in devices)
    shaft = name, entries[0].ratio, inertia
    bearings = next((entry.bearings for entry in entries if entry.bearings), None)
    if bearings is None:
        return BalancerShaft(*shaft)
    places = np.array([float(d.z) for d in devices])
    planes = np.array(bearings) / 1e3
    vectors: Complex = np.array([d.forward + d.backward for d in devices], complex)
    loads: Complex = (order * omega) ** 2 * vectors
    turning = _share(loads, places, planes)
    gear, fixed = _describe_gear(entries, order * omega, planes)
    borne = tuple(map(_describe_bearing, bearings, turning.tolist(), fixed.tolist()))
    bending, place = _find_bending(loads, places, turning, planes)
    return BalancerShaft(*shaft, borne, bending, place, gear)


def _describe_gear(
    entries: Sequence[Shaft], omega: float, planes: Array
) -> tuple[ShaftGear | None, Complex]:
    """Return the gear of a shaft (None if it has none) and the bearing loads that the gear causes,
    N, shape (2,).

    Args:
        entries: Tables of the shaft.
        omega: Speed of the shaft, rad/s.
        planes: Positions z of the bearings, m, shape (2,).
    """
    gear = next((entry.gear for entry in entries if entry.gear), None)
    if gear is None:
        return None, np.zeros(2, complex)
    drag = max(entry.drag for entry in entries)
    sense = np.sign(entries[0].ratio)
    tangential = 1e3 * drag / gear.radius
    slope = math.tan(math.radians(gear.pressure_angle))
    force: Complex = np.array([tangential * unit(gear.direction) * (1j * sense - slope)])
    loads = _share(force, np.array([gear.position / 1e3]), planes)
    return ShaftGear(tangential, tangential * slope, drag * omega), loads


def _share(loads: Complex, places: Array, planes: Array) -> Complex:
    """Return the loads of two bearings, N, shape (2,), by the lever rule.

    Args:
        loads: Forces on the shaft, N, shape (loads,).
        places: Positions z of the forces, m, shape (loads,).
        planes: Positions z of the bearings, m, shape (2,).
    """
    other = planes[::-1]
    shares: Complex = ((other[:, None] - places) / (other - planes)[:, None]) @ loads
    return np.where(np.abs(shares) <= _ROUNDING * np.abs(loads).sum(), 0, shares)


def _describe_bearing(position_mm: float, turning: complex, fixed: complex) -> ShaftBearing:
    return ShaftBearing(
        position_mm,
        abs(turning),
        abs(fixed),
        abs(turning) + abs(fixed),
        measure_direction(turning) if turning else None,
        measure_direction(fixed) if fixed else None,
    )


def _find_bending(
    loads: Complex, places: Array, reactions: Complex, planes: Array
) -> tuple[float, float | None]:
    """Return the largest bending moment, N m, and its position z, mm; (0, None) without bending.

    Args:
        loads: Forces on the shaft, N, shape (loads,).
        places: Positions z of the forces, m, shape (loads,).
        reactions: Loads of the bearings, N, shape (2,).
        planes: Positions z of the bearings, m, shape (2,).
    """
    z = np.sort(np.concatenate([places, planes]))
    moments = np.abs(find_arms(places, z) @ loads - find_arms(planes, z) @ reactions)
    largest = float(moments.max())
    if largest <= _ROUNDING * float(np.abs(loads).sum() * np.ptp(z)):
        return 0.0, None
    first = np.flatnonzero(moments >= largest * (1 - _ROUNDING))[0]
    return largest, 1e3 * float(z[first])


def _describe_eccentric(name: str, table: Shaft, sector: Sector) -> Eccentric:
    """Return mass and shape of an eccentric that is a sector on the core of its shaft."""
    shape = find_sector(table, sector)
    return Eccentric(
        shaft=name,
        position_mm=table.position,
        unbalance_kg_m=float(shape.unbalance),
        mass_kg=float(shape.mass),
        inertia_kg_m2=float(shape.inertia),
        thickness_m=float(shape.thickness),
    )


# ------------------------------------------------------------------ counterweights
def _describe_counterweight(table: Counterweight, lowest: float | None) -> CounterweightPart:
    """Return unbalance and, for a sector, mass and shape of a counterweight.

    Args:
        table: The `[[counterweight]]` table.
        lowest: Smallest distance of any piston's lowest edge from the crank axis, m; None: not
            known.
    """
    place = table.position, float(wrap_degrees(table.angle, 360))
    if table.sector is None:
        return CounterweightPart(*place, float(find_given_unbalance(table) or 0.0))
    unbalance, mass, radius, thickness, inertia = map(float, find_sector(table, table.sector))
    clearance = None if lowest is None else lowest - table.sector.outer_radius / 1e3
    return CounterweightPart(*place, unbalance, mass, radius, thickness, inertia, clearance)


# ------------------------------------------------------------------ how it is shown
_BEARINGS_NOTE = (
    "Bearing loads depend only on the resultant force and moment and on the bearing positions. "
    "Moving weights so that both resultants stay the same changes only the bending."
)
_RADIUS_NOTE = "Radius: distance of the centre of mass from the crank axis."
_CLEARANCE_NOTE = "Clearance: gap between weight and lowest piston edge, as if both had the same z."


_BEARING = {
    "position_mm": "bearing",
    "rotating_N": "turning",
    "rotating_deg": "at",
    "fixed_N": "fixed",
    "largest_N": "largest",
}
_SHORT = {"position_mm": "z", "angle_deg": "at", "center_of_mass_m": "radius"}
_ECCENTRIC = {
    "position_mm": "z",
    "unbalance_kg_m": "unbalance",
    "mass_kg": "mass",
    "inertia_kg_m2": "inertia",
    "thickness_m": "length",
}
_CORE_NOTE = "Mass and inertia include the core of the shaft."
_WEIGHT = {key: remove_unit(key) for key in CounterweightPart._fields} | _SHORT


def lay_out_parts(parts: BalanceParts, system: System) -> Iterator[Grid | Facts | Text]:
    """Yield a table of the bearing loads of the shafts, a line on each shaft, and a table of the
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
    if bare := [shaft.name for shaft in parts.shafts if not shaft.bearings]:
        unknown = f"Loads are not known: the file gives no bearings for {', '.join(bare)}."
        yield Text("Balancer shafts", (unknown,))
    if parts.eccentrics:
        yield _lay_out_eccentrics(parts.eccentrics, system)
    if parts.counterweights:
        yield _lay_out_counterweights(parts.counterweights, system)
    if parts.webs or parts.throws:
        yield from lay_out_webs(parts, system)
    if not (parts.shafts or parts.counterweights or parts.webs):
        yield Text("Parts", ("The file has no balancer shafts and no counterweights.",))


def _lay_out_bearings(shafts: Sequence[BalancerShaft], system: System) -> Grid:
    pairs = [(shaft.name, bearing) for shaft in shafts for bearing in shaft.bearings or ()]
    names, bearings = zip(*pairs, strict=True)
    unit = system.force.fit_values(bearing.largest_N for bearing in bearings)
    shaft = Column("shaft", names, words=True)
    columns = [shaft, *list_columns(bearings, _BEARING, {"N": unit}, system)]
    return Grid("Balancer shafts", columns, _BEARINGS_NOTE)


def list_columns(
    records: Sequence[object], labels: Mapping[str, str], units: Node, system: System
) -> Iterator[Column]:
    """Yield a column for each figure that is known for at least one record.

    Args:
        records: Records, one for each row.
        labels: Labels of the figures, by their keys.
        units: Units in addition to those of the system, by their SI names.
        system: System of units.
    """
    length = system.length
    angle = ShownUnit("deg", 1)
    units = units | system.of_parts | {"deg": angle, "mm": length._replace(size=1e3 * length.size)}
    for key, label in labels.items():
        unit_ = units[find_unit(key)]
        cells = []
        for record in records:
            value = getattr(record, key)
            cells.append(unit_cell(value, unit_))
        if set(cells) != {UNKNOWN}:
            yield Column(name_with_unit(label, unit_.name), cells)


def _tell_shaft(shaft: BalancerShaft, system: System) -> str:
    """Return in words ratio, bending, inertia and drag of a shaft."""
    words = [f"ratio {shaft.ratio:+g}"]
    if shaft.bending_Nm is not None:
        bending = f"bending {size_text(shaft.bending_Nm, system.moment)}"
        if shaft.bending_position_mm is not None:
            bending += f" at z = {size_text(shaft.bending_position_mm / 1e3, system.length)}"
        words.append(bending)
    if inertia := shaft.inertia_at_crank_kg_m2:
        words.append(f"inertia at the crank {size_text(inertia, system.of_parts['kg·m²'])}")
    if shaft.gear is not None:
        words.append(f"drag {size_text(shaft.gear.power_W, system.heat)}")
    return ", ".join(words)


def _lay_out_eccentrics(parts: Sequence[Eccentric], system: System) -> Grid:
    unit_ = system.unbalance.fit_values(part.unbalance_kg_m for part in parts)
    shaft = Column("shaft", [part.shaft for part in parts], words=True)
    columns = [shaft, *list_columns(parts, _ECCENTRIC, {"kg·m": unit_}, system)]
    return Grid("Eccentrics", columns, _CORE_NOTE)


def _lay_out_counterweights(parts: Sequence[CounterweightPart], system: System) -> Grid:
    unit_ = system.unbalance.fit_values(part.unbalance_kg_m for part in parts)
    numbers = Column("no.", [str(k) for k in range(1, len(parts) + 1)], words=True)
    columns = [numbers, *list_columns(parts, _WEIGHT, {"kg·m": unit_}, system)]
    notes = []
    if any(part.mass_kg is not None for part in parts):
        notes.append(_RADIUS_NOTE)
    if any(part.clearance_m is not None for part in parts):
        notes.append(_CLEARANCE_NOTE)
    return Grid("Counterweights", columns, " ".join(notes))


def list_part_rows(parts: BalanceParts) -> Iterator[FigureRow]:
    """Yield every figure of shafts and counterweights in SI units."""
    for shaft in parts.shafts:
        name = f"shaft {shaft.name.removeprefix('shaft ')}"
        yield from record_rows(0, name, None, shaft, "name")
    for k, eccentric in enumerate(parts.eccentrics or (), 1):
        yield from record_rows(0, f"eccentric {k}", None, eccentric, "shaft")
    for k, weight in enumerate(parts.counterweights, 1):
        yield from record_rows(0, f"counterweight {k}", None, weight)
    yield from list_web_rows(parts)

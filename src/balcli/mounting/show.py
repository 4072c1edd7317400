"""Show an engine on its mounts as tables and CSV."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import product
from typing import NamedTuple

import numpy as np

from ..core.vibration import Real
from ..engine.figures import find_first_largest
from ..forces.kinds import FREE, MOMENT, Kind as LoadKind
from ..show.engine_facts import list_silent
from ..show.figures import clean, silent_entries
from ..show.formats import Renderer, Rows, name_cell
from ..show.sheet import (
    NAMELESS,
    Column,
    Facts,
    Grid,
    Sheet,
    Text,
    assumed_facts,
    degrees,
    number,
    order_name,
)
from ..show.units import ShownUnit, System
from .records import BodyResponse, MountForce, MountReport, PointMotion, WorstForce, WorstMotion
from .rigid_body import AXES

_HEADER = ("part", "name", "order", "speed_rpm", "figure", "value", "unit")
_COLUMNS = 6  # largest number of columns of orders or speeds in a table
_ROWS = 9  # largest number of rows of speeds in a table
_SHARE = 1e-3  # loads below this share of the largest load on rigid mounts have no row


class Kind(NamedTuple):
    """Kind of result: the force of mounts, or the motion of points. Mounts and points are places.

    Attributes:
        part: "mount" or "point".
        figure: "force" or "motion".
        unit: Unit in which values are shown, relative to the unit of the records.
    """

    part: str
    figure: str
    unit: ShownUnit

    def places(self, response: BodyResponse) -> tuple[MountForce | PointMotion, ...]:
        """Return the mounts or the points."""
        return response.mounts if self.part == "mount" else response.points

    def show(self, value: float) -> str:
        """Return a value of a record as text for a table."""
        return number(self.unit.of(value), 4)

    def find_highest(self, response: BodyResponse) -> MountForce | PointMotion:
        """Return the place with the largest value; the first of equal ones."""
        places = self.places(response)
        return places[int(find_first_largest([place.worst.largest for place in places]))]

    def tell_worst(self, place: MountForce | PointMotion) -> str:
        """Return a place's largest value and its speed as text."""
        worst = place.worst
        size = f"{self.show(worst.largest)} {self.unit.name}"
        return f"{size} at {number(worst.speed_rpm, 4)} rpm"


def list_kinds(system: System) -> tuple[Kind, Kind]:
    """Return the forces of mounts and the motion of points."""
    length = ShownUnit(system.length.name, 1e3 * system.length.size)  # lengths of records are in mm
    return Kind("mount", "force", system.force), Kind("point", "motion", length)


def sheet(result: MountReport, system: System) -> Sheet:
    """Return the sheet: the answer (forces on the frame), modes, rest, and tables over speed."""
    parts: list[Grid | Facts | Text] = [*assumed_facts(result.assumed)]
    force, motion = list_kinds(system)
    if hasattr(result, "response"):
        kinds = (force, motion) if result.response.points else (force,)
        parts.append(Text("Forces on the frame", tuple(_answer(result, result.response, kinds))))
        parts += [_grid_worst(result, kind) for kind in kinds]
    parts += [_grid_modes(result), _tell_body(result, motion.unit)]
    parts.append(_grid_rest(result, system, motion.unit))
    if hasattr(result, "response"):
        if any(mode.meets for mode in result.modes):
            parts.append(_grid_meetings(result))
        parts.append(_grid_speeds(result, result.response, force))
        parts.append(_grid_passed(result.response, system))
    return Sheet(f"{result.name or NAMELESS}: on its mounts", tuple(parts))


def _answer(result: MountReport, response: BodyResponse, kinds: Sequence[Kind]) -> Iterator[str]:
    """Yield sentences on the largest force and motion, their cause, and the effect of a scheme."""
    force = kinds[0]
    place = force.find_highest(response)
    worst = place.worst
    if worst.largest:
        alone = f"{force.show(worst.alone)} {force.unit.name}"
        yield (
            f"Largest mount force: {force.tell_worst(place)} at mount {place.name}; order "
            f"{order_name(worst.order)} alone makes {alone}. {_explain(result, response, worst)}"
        )
    else:
        yield "The orders included put no force on the mounts."
    for kind in kinds[1:]:
        place = kind.find_highest(response)
        yield f"Largest motion: {kind.tell_worst(place)} at point {place.name}."
    yield f"Orders included: {', '.join(map(order_name, response.orders))}."
    gas = _tell_gas(response)
    yield gas
    for other in result.beside:
        changes = "; ".join(_compare(response, other.response, kind) for kind in kinds)
        sentences = [f"With {other.name} {changes}."]
        other_gas = _tell_gas(other.response)
        if other_gas != gas:
            sentences.append(other_gas)
        yield " ".join(sentences)


def _tell_gas(response: BodyResponse) -> str:
    """Return a sentence on whether gas is included, and on cylinders that do not fire."""
    if response.loads.gas is None:
        return "Inertia only: gas torque, which also rolls an engine, is not included."
    silent = "".join(f"; {what} cylinder {n}" for what, n in list_silent(response.loads.silent))
    gas = "gas of each speed" if response.loads.law else "same gas diagram at every speed"
    return f"Inertia and gas torque, with the {gas}{silent}."


def _compare(own: BodyResponse, other: BodyResponse, kind: Kind) -> str:
    """Return the largest value of another response as text, with the change in percent."""
    before = kind.find_highest(own).worst.largest
    place = kind.find_highest(other)
    of = "force of any mount" if kind.part == "mount" else f"motion at {place.name}"
    more = f" ({place.worst.largest / before - 1:+.0%})" if before else ""
    return f"the largest {of} is {kind.tell_worst(place)}{more}"


def _explain(result: MountReport, response: BodyResponse, worst: WorstForce | WorstMotion) -> str:
    """Return a sentence on why a value is largest at its speed."""
    speeds = response.speeds_rpm
    hertz = worst.order * worst.speed_rpm / 60
    met = worst.resonance
    k = met.mode - 1 if met else worst.mode
    mode = result.modes[k]
    named = f"mode {k + 1} ({mode.motion}, {number(mode.frequency_Hz, 3)} Hz)"
    if met:
        order = order_name(met.order)
        at = number(met.speed_rpm, 4)
        return f"Order {order} meets {named} at {at} rpm: resonance."
    for end, rpm in (("slowest", speeds[0]), ("fastest", speeds[-1])):
        if len(speeds) > 1 and abs(worst.speed_rpm / rpm - 1) < 1e-9:
            return f"This is the {end} speed of the range; most of the force is from {named}."
    return f"Most of the force is from {named}; this order then has {number(hertz, 3)} Hz."


def _grid_worst(result: MountReport, kind: Kind) -> Grid:
    """Return a table of the largest value of each mount or point, in this and other responses."""
    names = [place.name for place in kind.places(result.responses[0])]
    columns = [Column(kind.part, names, words=True)]
    heads = ["all orders", *(f"with {other.name}" for other in result.beside)]
    for head, response in zip(heads, result.responses, strict=True):
        every = [place.worst for place in kind.places(response)]
        columns.append(Column(head, [kind.show(worst.largest) for worst in every]))
        columns.append(Column("at, rpm", [number(worst.speed_rpm, 4) for worst in every]))
        if response is result.response:
            columns.append(Column("largest order", [order_name(worst.order) for worst in every]))
            columns.append(Column("alone", [kind.show(worst.alone) for worst in every]))
    note = "Largest value in the cycle at any speed of the range; orders add with their phases."
    title = f"Largest {kind.figure} of each {kind.part}, {kind.unit.name}"
    return Grid(title, columns, note)


def _grid_modes(result: MountReport) -> Grid:
    heads = [
        Column("mode", words=True),
        Column("Hz"),
        Column("motion", words=True),
        *(Column(f"{axis} %") for axis in AXES),
    ]
    damped = any(mode.loss_factor for mode in result.modes)
    if damped:
        heads.append(Column("damping %"))
    rows = []
    for k, mode in enumerate(result.modes, 1):
        row = [str(k), number(mode.frequency_Hz, 4), mode.motion]
        for axis in AXES:
            share = round(mode.energy_percent[axis], 1) + 0.0
            row.append(f"{share:.1f}")
        if damped:
            row.append(f"{50 * mode.loss_factor:.1f}")
        rows.append(row)
    note = (
        "x, y, z %: kinetic energy of motion along the axes; rx, ry, rz %: of rotation about them; "
        "products of inertia may make some negative. Hz: with dynamic stiffness, without damping."
    )
    return Grid.of_rows("Natural modes", heads, rows, note)


def _tell_body(result: MountReport, length: ShownUnit) -> Facts:
    point = np.round(result.elastic_centre_mm, 6) / length.size + 0.0
    axis = np.round(result.roll_axis, 9) + 0.0
    angle = degrees(math.degrees(math.acos(min(1.0, abs(result.roll_axis[2])))))
    rolls = f"{_write_vector(axis)} through the centre of gravity, {angle} deg from z"
    centre = f"{_write_vector(point)} {length.name}"
    return Facts((("torque roll axis", rolls), ("elastic centre", centre)), "The body")


def _write_vector(vector: Real) -> str:
    """Return the components of a vector in brackets."""
    components = [number(float(component), 4) for component in vector]
    return f"({', '.join(components)})"


def _grid_rest(result: MountReport, system: System, length: ShownUnit) -> Grid:
    heads = [
        Column("mount", words=True),
        *(Column(f"{axis}, {system.force.name}") for axis in "xyz"),
        *(Column(f"travel {axis}, {length.name}") for axis in "xyz"),
    ]
    rows = []
    for mount in result.static.mounts:
        forces = [number(system.force.of(force), 4) for force in mount.force_N]
        travels = [number(length.of(travel), 3) for travel in mount.travel_mm]
        rows.append([mount.name, *forces, *travels])
    leaning = ""
    torque = result.response.loads.mean if hasattr(result, "response") else 0.0
    if torque and not result.mounted.carries_load:
        mean = number(system.moment.of(abs(torque)), 4)
        leaning = f" and the reaction to the load's mean torque of {mean} {system.moment.name}"
    note = f"Forces of the body on its mounts under its weight{leaning}, with static stiffness."
    return Grid.of_rows("At rest", heads, rows, note)


def _grid_meetings(result: MountReport) -> Grid:
    orders = sorted({meeting.order for mode in result.modes for meeting in mode.meets})
    shown = orders[:_COLUMNS]
    heads = [
        Column("mode", words=True),
        Column("Hz"),
        *(Column(f"order {order_name(order)}") for order in shown),
    ]
    rows = []
    for k, mode in enumerate(result.modes, 1):
        rpm = {meeting.order: meeting.speed_rpm for meeting in mode.meets}
        speeds = [number(rpm.get(order, math.nan), 4) for order in shown]
        rows.append([str(k), number(mode.frequency_Hz, 4), *speeds])
    note = "The JSON output has all orders." if len(orders) > _COLUMNS else ""
    return Grid.of_rows("Where orders meet modes, rpm", heads, rows, note)


def _pick(count: int, most: int) -> list[int]:
    """Return at most `most` indices of `range(count)`, evenly spaced, including both ends."""
    return sorted({round(k * (count - 1) / (most - 1)) for k in range(most)})


def _grid_speeds(result: MountReport, response: BodyResponse, force: Kind) -> Grid:
    speeds = _pick(len(response.speeds_rpm), _ROWS)
    columns = [Column("rpm", [number(response.speeds_rpm[s], 4) for s in speeds], words=True)]
    labels = ("", *(f", {other.name}" for other in result.beside))
    for label, each in zip(labels, result.responses, strict=True):
        for mount in each.mounts:
            forces = [number(force.unit.of(mount.peak_N[s]), 4) for s in speeds]
            columns.append(Column(f"{mount.name}{label}", forces))
    title = f"Force of each mount by speed, all orders together, {force.unit.name}"
    return Grid(title, columns)


class _RigidLoad(NamedTuple):
    """Component of the load of one order on rigid mounts, by speed.

    Attributes:
        order: Order.
        kind: Force or moment.
        axis: Axis of the component.
        amplitude: Amplitude on rigid mounts.
        through: Amplitude through the mounts of the file.
    """

    order: float
    kind: LoadKind
    axis: str
    amplitude: Real
    through: Real

    @property
    def name(self) -> str:
        """Name in tables."""
        if self.kind == MOMENT and self.axis == "z":
            return "roll z"
        return f"{self.kind.name} {self.axis}"


def _list_rigid_loads(response: BodyResponse) -> Iterator[_RigidLoad]:
    """Yield the components that are not 0, order by order."""
    none = np.zeros(len(response.speeds_rpm))
    for passed in response.passed:
        for kind, axis in product(FREE, "xyz"):
            key = kind.key_along(axis)
            if key in passed.rigid:
                through = passed.on_mounts.get(key, none)
                yield _RigidLoad(passed.order, kind, axis, passed.rigid[key], through)


def _grid_passed(response: BodyResponse, system: System) -> Grid:
    rpm = response.speeds_rpm
    speeds = _pick(len(rpm), _COLUMNS - 1)
    heads = [
        Column("order", words=True),
        Column("load", words=True),
        Column(f"rigid, {number(float(rpm[-1]), 4)} rpm"),
        *(Column(f"{number(rpm[s], 4)} rpm") for s in speeds),
    ]
    loads = list(_list_rigid_loads(response))
    rows = []
    for load in loads:
        most = max(other.amplitude[-1] for other in loads if other.kind == load.kind)
        if load.amplitude[-1] > _SHARE * most:
            unit = system.unit(load.kind)
            size = f"{number(unit.of(load.amplitude[-1]), 4)} {unit.name}"
            shares = (f"{load.through[s] / load.amplitude[s]:.1%}" for s in speeds)
            rows.append((order_name(load.order), load.name, size, *shares))
    note = (
        "Load through the mounts, as a share of the load of the same engine on rigid mounts; "
        "moments about the centre of gravity."
    )
    return Grid.of_rows("Passed on to the frame", heads, rows, note)


# ------------------------------------------------------------------ CSV
def rows(result: MountReport, system: System) -> Rows:
    """Return CSV with one figure in each line."""
    return Rows(_HEADER, _list_lines(result, system))


def _list_lines(result: MountReport, system: System) -> Iterator[tuple[object, ...]]:
    force, motion = list_kinds(system)
    for k, mode in enumerate(result.modes, 1):
        head = ("mode", f"mode {k}", None, None)
        yield *head, "frequency", clean(mode.frequency_Hz), "Hz"
        yield *head, "motion", mode.motion, ""
        for axis, share in mode.energy_percent.items():
            yield *head, f"energy {axis}", clean(share), "%"
    for k, mode in enumerate(result.modes, 1):
        for meeting in mode.meets:
            rpm = meeting.speed_rpm
            yield "meeting", f"mode {k}", meeting.order, rpm, "speed", rpm, "rpm"
    for mount in result.static.mounts:
        head = ("static", name_cell(mount.name), None, None)
        for axis, own, travel in zip("xyz", mount.force_N, mount.travel_mm, strict=True):
            yield *head, f"force {axis}", clean(force.unit.of(own)), force.unit.name
            yield *head, f"travel {axis}", clean(motion.unit.of(travel)), motion.unit.name
    for label, response in zip(_list_labels(result), result.responses, strict=False):
        for key, numbers in silent_entries(response.loads.silent).items():
            yield f"{label}engine", "", None, None, key, " ".join(map(str, numbers)), ""
        yield from _list_imep(response, label)
        for kind in (force, motion):
            yield from _list_curves(response, kind, label)


def _list_labels(result: MountReport) -> list[str]:
    """Return the beginning of the names of rows for each of the responses."""
    labels = [""]
    if hasattr(result, "fitted"):
        labels.append("with scheme ")
    if hasattr(result, "others"):
        labels += [f"{name_cell(other.name)}: " for other in result.others]
    return labels


def _list_imep(response: BodyResponse, label: str) -> Iterator[tuple[object, ...]]:
    """Yield the indicated mean effective pressure by speed, if it depends on the speed."""
    if response.imep_Pa is not None:
        for rpm, imep in zip(response.speeds_rpm, response.imep_Pa.tolist(), strict=True):
            yield f"{label}engine", "", None, clean(rpm), "imep", imep, "Pa"


def _list_curves(response: BodyResponse, kind: Kind, label: str) -> Iterator[tuple[object, ...]]:
    """Yield the lines of every mount or point, by speed and order."""
    figure = kind.figure
    unit = kind.unit
    for name, orders, peak, _ in kind.places(response):
        head = (f"{label}{kind.part}", name_cell(name))
        curves = [*((order, figure, curve) for order, curve in orders)]
        for s, rpm in enumerate(response.speeds_rpm):
            for order, key, curve in (*curves, (None, f"peak {figure}", peak)):
                yield *head, order, clean(rpm), key, clean(unit.of(curve[s])), unit.name


RENDERER = Renderer(sheet=sheet, rows=rows)

"""What a person reads of field balancing: how angles count, corrections, what the shop does, and
the readings before and after.
"""

from __future__ import annotations

from collections.abc import Iterator

from ..field_balancing.balance import FieldBalance, PlaneCorrection, find_eccentricity
from ..field_balancing.influence import find_senses, has_opposite_senses
from ..field_balancing.read import is_mass
from ..field_balancing.shop import Piece, find_angle_deg
from .field_balancing_document import document, find_sensor_name, rows
from .sheet import Facts, Grid, Sheet, Text, degrees, number
from .units import ShownUnit, System

__all__ = ["document", "rows", "sheet"]

_WAY = {"with": "the way the rotor turns", "against": "against the way the rotor turns"}


def sheet(result: FieldBalance, system: System) -> Sheet:
    """Everything, the corrections first; weights and readings are in the units of the file."""
    file = result.file
    parts: list[Grid | Facts | Text] = [_angles(result), _corrections(result, system)]
    if file.places or file.drill:
        parts.append(_work(result, system.length))
    if file.grade is not None:
        parts.append(_permitted(result, system))
    parts += [_readings(result), _influence(result)]
    title = f"{file.name or 'rotor without a name'}: field balancing"
    return Sheet(title, tuple(parts))


def _angles(result: FieldBalance) -> Text:
    phases, weights = find_senses(result.file)
    same = "as phases do" if phases == weights else "the other way round than phases"
    senses = (
        f"Phases of readings {result.file.rotation}: they count {phases} rotation. Angles of "
        f"weights count {weights} rotation, {same}:"
    )
    picture = f"a weight at 30 deg stands 30 deg on from the 0 mark, going {_WAY[weights]}."
    return Text("How angles count", (senses, picture))


def _corrections(result: FieldBalance, system: System) -> Grid:
    file, trimmed = result.file, result.influence.trimmed
    heads = ["plane", f"weight, {file.weight_unit}", "at, deg"]
    if trimmed:
        heads += [f"add now, {file.weight_unit}", "at, deg"]
    moments = all(p.unbalance is not None for p in result.planes) and file.radius is not None
    if moments:
        heads += [f"radius, {system.length.name}", f"unbalance, {system.unbalance.name}"]
    heads += ["own effect"]

    def row(p: PlaneCorrection) -> tuple[str, ...]:
        cells = [p.plane, *_polar(p.total)]
        if trimmed:
            cells += _polar(p.step)
        if moments and file.radius is not None and p.unbalance is not None:
            radius = file.radius[file.planes.index(p.plane)]
            cells.append(number(system.length.of(radius / 1e3), 4))
            cells.append(number(system.unbalance.of(p.unbalance / 1e6), 4))
        return (*cells, f"{p.own:.0%}{', at its limit' if p.limited else ''}")

    marked = frozenset((k, 1) for k, p in enumerate(result.planes) if p.limited)
    note = " ".join(_explain_corrections(result))
    return Grid("Corrections", tuple(heads), tuple(map(row, result.planes)), note, marked)


def _explain_corrections(result: FieldBalance) -> Iterator[str]:
    file, trimmed = result.file, result.influence.trimmed
    yield "Weights to add, counted from the rotor as found, all trial weights off."
    if trimmed:
        yield f"Add now: on top of what was on in '{trimmed}'."
    yield f"Own effect: what no other plane can do; condition {number(result.condition, 3)}."
    for p in result.planes:
        if p.limited:
            amount, angle = _polar(p.total - p.step + p.wanted)
            best = f"{amount} {file.weight_unit} at {angle} deg"
            yield f"Without its limit, {p.plane} would take {best}."
    left_out = [plane for plane in file.planes if plane not in {p.plane for p in result.planes}]
    if left_out:
        yield f"Left out: {', '.join(left_out)}."
    for plane in left_out:
        if weight := _find_weight_on(result, plane):
            amount, angle = _polar(weight)
            kept = f"{amount} {file.weight_unit} at {angle} deg"
            yield f"What was on in '{trimmed}' stays on in {plane}: {kept}."


def _find_weight_on(result: FieldBalance, plane: str) -> complex:
    """What was on in the last run with a correction in, angles as the file counts them."""
    weight = complex(result.influence.on[result.file.planes.index(plane)])
    return weight.conjugate() if has_opposite_senses(result.file) else weight


def _polar(value: complex, size: int = 4) -> tuple[str, str]:
    return number(abs(value), size), degrees(find_angle_deg(value)) if value else "–"


def _work(result: FieldBalance, length: ShownUnit) -> Grid:
    file = result.file
    drilled = file.drill is not None
    heads = ["plane", "hole" if drilled else "place", "at, deg", f"weight, {file.weight_unit}"]
    if drilled:
        heads += [f"drill, {length.name}", f"depth, {length.name}"]
    rows: list[tuple[str, ...]] = []
    for p in result.planes:
        for piece in p.pieces:
            cells = [p.plane, _place(result, p, piece)]
            cells += [degrees(piece.angle_deg), number(piece.weight, 4)]
            if file.drill is not None and piece.depth_mm is not None:
                drill = file.drill[file.planes.index(p.plane)]
                cells.append(number(length.of(drill / 1e3), 6))
                cells.append(number(length.of(piece.depth_mm / 1e3), 3))
            rows.append(tuple(cells))
        if not p.pieces:
            rows.append((p.plane, *["–"] * (len(heads) - 1)))
    what = "Holes to drill" if drilled else "Weights to put on"
    when = f", on top of '{result.influence.trimmed}'" if result.influence.trimmed else ""
    return Grid(f"{what}{when}", tuple(heads), tuple(rows), " ".join(_explain_work(result)))


def _explain_work(result: FieldBalance) -> Iterator[str]:
    drilled = result.file.drill is not None
    if drilled:
        yield "Radial holes in steel, from the rim inwards, opposite to where weights would go."
        as_much = "Each does as much as this weight at the rim; its steel, further in, weighs more."
        yield as_much if is_mass(result.file) else "Each removes this unbalance."
    else:
        yield "Together they do what the corrections do."
    if drilled and result.influence.trimmed:
        yield "Depths are of new holes: those drilled before are not in the file."
    elif result.influence.trimmed and result.file.most is not None:
        yield "The limit is for these alone: what a place carries already is not in the file."
    if result.limited:
        yield "Places and limits allow no better: see the readings below."
    if result.limited and drilled and result.file.places is None:
        some = [24] * len(result.file.planes)
        yield f"For more than one hole in a plane give places, such as places = {some}."


def _place(result: FieldBalance, p: PlaneCorrection, piece: Piece) -> str:
    """Which of the places it is."""
    places = result.file.places
    if piece.place is None or not places:
        return "–"
    return f"{piece.place} of {len(places[result.file.planes.index(p.plane)])}"


def _permitted(result: FieldBalance, system: System) -> Grid:
    file, unit, mass = result.file, system.unbalance, system.mass

    def told(unbalance: float) -> str:
        return number(unit.of(unbalance / 1e6), 4)

    rows, marked = [], set()
    for k, p in enumerate(result.planes):
        if p.permitted is not None:
            rows.append(
                (
                    p.plane,
                    told(p.permitted.permitted),
                    told(p.permitted.present),
                    "reached" if p.permitted.reached else "not reached",
                    told(p.permitted.after),
                )
            )
            if not p.permitted.reached:
                marked.add((k, 3))
    trimmed = result.influence.trimmed
    state = f"in '{trimmed}'" if trimmed else "in the rotor as found"
    eccentricity = number(1e3 * (find_eccentricity(file) or 0.0), 4)
    return Grid(
        f"Permitted residual unbalance, ISO 21940-11, G {file.grade:g}",
        ("plane", f"permitted, {unit.name}", f"there now, {unit.name}", "", f"after, {unit.name}"),
        tuple(rows),
        f"{mass.of(file.mass or 0.0):g} {mass.name} at {file.speed:g} rpm: {eccentricity} µm. "
        f"There now: {state}, by its readings; after: what the corrections leave of it.",
        frozenset(marked),
        words=(0, 3),
    )


def find_label(result: FieldBalance, k: int) -> str:
    """Name of a reading: its sensor, and its speed where there are several."""
    speeds, name = result.influence.speeds_rpm, find_sensor_name(result, k)
    return f"{name}, {speeds[k]:g} rpm" if len(set(speeds)) > 1 else name


def _readings(result: FieldBalance) -> Grid:
    influence = result.influence
    unit = f", {result.file.unit}" if result.file.unit else ""
    states = [("as found", influence.found)]
    if influence.trimmed:
        states.append((influence.state, influence.now))
    states.append(("after", result.after))
    heads = ["reading", *(head for name, _ in states for head in (f"{name}{unit}", "at, deg"))]
    rows = [
        (
            find_label(result, k),
            *(cell for _, values in states for cell in _polar(complex(values[k]))),
        )
        for k in range(len(result.after))
    ]
    weighted = " weighted" if result.file.reading_weights else ""
    note = f"Largest{weighted} after: {number(result.largest, 4)}, rms {number(result.rms, 4)}. "
    if not result.after.any():
        note = "All readings are cancelled."
    elif result.minimise == "max":
        which = "No weights that fit" if result.limited else "No weights"
        note += f"{which} leave less than {number(result.bound, 4)} as the largest."
    else:
        which = "that the places and limits allow" if result.limited else "possible"
        note += f"The sum of their squares is the least {which}."
    return Grid("Readings, predicted after the corrections", tuple(heads), tuple(rows), note)


def _influence(result: FieldBalance) -> Grid:
    planes = [result.file.planes.index(p.plane) for p in result.planes]
    heads = ["reading"]
    for p in result.planes:
        heads += [p.plane, "at, deg"]
    rows = [
        (find_label(result, k), *(cell for j in planes for cell in _polar(complex(row[j]), 5)))
        for k, row in enumerate(result.influence.coefficients)
    ]
    note = (
        f"Change of a reading by 1 {result.file.weight_unit} at 0 deg in the plane; angles count "
        f"as phases do, {find_senses(result.file)[0]} rotation."
    )
    if result.influence.trimmed and result.file.influence is None:
        note += " By least squares over all runs."
    return Grid("Influence coefficients", tuple(heads), tuple(rows), note)

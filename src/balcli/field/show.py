"""Field balancing as people read it (tables), and as programs do (JSON, CSV).

Polar picture of field balancing: readings before and after on the left, weights on the right.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import cycle
from typing import TYPE_CHECKING

import numpy as np

from ..core.phasors import Complex
from ..core.records import Node, angle_deg, list_figures, to_document
from ..show.csv import Rows, name_cell
from ..show.formats import Renderer
from ..show.plot_style import BLUE, INK, MANY_LOOKS, PAPER, SOFT, fit_name, open_figure, put_title
from ..show.sheet import UNKNOWN, Facts, Grid, Sheet, Text, degrees, number
from ..show.units import System
from .answer import FieldBalance, Permitted

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from matplotlib.projections.polar import PolarAxes

    from ..show.plot_style import Look


_HEADER = ("part", "speed_rpm", "name", "figure", "value", "unit")
_WAY = {"with": "the way the rotor turns", "against": "against the way the rotor turns"}


# ------------------------------------------------------------------ for programs
def rows(result: FieldBalance, system: System) -> Rows:
    """Return every figure of corrections and readings as CSV, in the units of the file."""
    return Rows(_HEADER, _list_lines(to_document(result), result.file.planes))


def _list_lines(found: Node, planes: tuple[str, ...]) -> Iterator[tuple[object, ...]]:
    for each in found["corrections"]:
        yield from _list_part("correction", each, each["plane"], found["weight_unit"])
    for part in ("before", "residual"):
        for reading, value in zip(found["readings"], found[part], strict=True):
            yield from _list_part(part, value, unit=found["unit"] or "", **reading)
    for reading, line in zip(found["readings"], found["influence"], strict=True):
        for plane, value in zip(planes, line, strict=True):
            name = f"{reading['sensor']} by {plane}"
            yield from _list_part("influence", value, name, "", reading["speed_rpm"])
    for each in found.get("permitted", {"planes": ()})["planes"]:
        yield from _list_part("permitted", each, each["plane"])
    keys = ("condition", "largest", "rms", "bound")
    yield from _list_part("details", {key: found[key] for key in keys if key in found})


def _list_part(
    part: str, found: Node, sensor: str = "", unit: str = "", speed_rpm: float | None = None
) -> Iterator[tuple[object, ...]]:
    """Yield a line for each figure of an object; weights and amplitudes have this unit."""
    for name, value, known in list_figures(found, ("plane",)):
        of_file = name.rpartition(".")[2] in ("weight", "amplitude")
        cells = part, speed_rpm, name_cell(sensor), name, value
        yield *cells, name_cell(unit) if of_file else known


# ------------------------------------------------------------------ for people
def sheet(result: FieldBalance, system: System) -> Sheet:
    """Return all tables; weights and readings are in the units of the file."""
    file = result.file
    parts: list[Grid | Facts | Text] = [_show_senses(result), _show_corrections(result, system)]
    if file.places or file.drill:
        parts.append(_show_pieces(result, system))
    if result.permitted is not None:
        parts.append(_show_permitted(result, result.permitted, system))
    parts += [_show_readings(result), _show_influence(result)]
    return Sheet(f"{file.name or 'rotor without a name'}: field balancing", tuple(parts))


def _show_senses(result: FieldBalance) -> Text:
    phases, weights = result.phases, result.weights
    same = "as phases do" if phases == weights else "the other way round than phases"
    senses = (
        f"Phases of readings {result.file.rotation}: they count {phases} rotation. Angles of "
        f"weights count {weights} rotation, {same}:"
    )
    picture = f"a weight at 30 deg stands 30 deg on from the 0 mark, going {_WAY[weights]}."
    return Text("How angles count", (senses, picture))


def _polar(value: complex, digits: int = 4) -> tuple[str, str]:
    """Return the cells of a weight or reading: magnitude and angle."""
    return number(abs(value), digits), degrees(angle_deg(value)) if value else UNKNOWN


def _weight_text(result: FieldBalance, value: complex) -> str:
    amount, angle = _polar(value)
    return f"{amount} {result.weight_unit} at {angle} deg"


def _show_corrections(result: FieldBalance, system: System) -> Grid:
    file, unit = result.file, result.weight_unit
    columns = ["plane", f"weight, {unit}", "at, deg"]
    columns += [f"add now, {unit}", "at, deg"] if result.trimmed else []
    if file.radius is not None:
        columns += [f"radius, {system.length.name}", f"unbalance, {system.unbalance.name}"]
    lines = []
    for each in result.corrections:
        cells = [each.plane, *_polar(each.weight), *(_polar(each.step) if result.trimmed else ())]
        if file.radius is not None:
            radius = file.radius[file.planes.index(each.plane)]
            cells.append(number(system.length.of(radius / 1e3), 4))
            cells.append(number(system.unbalance.of((each.unbalance_g_mm or 0.0) / 1e6), 4))
        limit = ", at its limit" if each.at_limit else ""
        lines.append((*cells, f"{each.own_effect:.0%}{limit}"))
    return Grid(
        "Corrections",
        (*columns, "own effect"),
        tuple(lines),
        " ".join(_explain_corrections(result)),
        frozenset((k, 1) for k, each in enumerate(result.corrections) if each.at_limit),
    )


def _explain_corrections(result: FieldBalance) -> Iterator[str]:
    yield "Weights to add, counted from the rotor as found, all trial weights off."
    if result.trimmed:
        yield f"Add now: on top of what was on in '{result.trimmed}'."
    yield f"Own effect: share that no other planes have; condition {number(result.condition, 3)}."
    for each in result.corrections:
        if each.wanted is not None:
            best = _weight_text(result, each.wanted)
            yield f"Without its limit, {each.plane} would take {best}."
    if result.left_out:
        yield f"Left out: {', '.join(result.left_out)}."
    for plane, weight in zip(result.file.planes, result.runs.weights_on, strict=True):
        if weight and plane in result.left_out:
            kept = _weight_text(result, result.file.turn(complex(weight)))
            yield f"What was on in '{result.trimmed}' stays on in {plane}: {kept}."


def _show_pieces(result: FieldBalance, system: System) -> Grid:
    file, length = result.file, system.length
    columns = ["plane", "hole" if file.drill else "place", "at, deg"]
    columns += [f"weight, {file.weight_unit}"]
    columns += [f"drill, {length.name}", f"depth, {length.name}"] if file.drill else []
    lines: list[tuple[str, ...]] = []
    for each in result.corrections:
        k = file.planes.index(each.plane)
        for piece in each.pieces:
            count = len(file.places[k]) if file.places else 0
            place = UNKNOWN if piece.place is None else f"{piece.place} of {count}"
            cells = [each.plane, place, degrees(piece.angle_deg), number(piece.weight, 4)]
            if file.drill is not None and piece.depth_mm is not None:
                cells.append(number(length.of(file.drill[k] / 1e3), 6))
                cells.append(number(length.of(piece.depth_mm / 1e3), 3))
            lines.append(tuple(cells))
        if not each.pieces:
            lines.append((each.plane, *[UNKNOWN] * (len(columns) - 1)))
    what = "Holes to drill" if file.drill else "Weights to put on"
    when = f", on top of '{result.trimmed}'" if result.trimmed else ""
    note = " ".join(_explain_pieces(result))
    return Grid(f"{what}{when}", tuple(columns), tuple(lines), note)


def _explain_pieces(result: FieldBalance) -> Iterator[str]:
    file, drilled = result.file, result.file.drill is not None
    if drilled:
        yield "Radial holes in steel, from the rim inwards, opposite to where weights would go."
        as_much = "Each does as much as this weight at the rim; its steel, further in, weighs more."
        yield as_much if file.weighs_masses else "Each removes this unbalance."
    else:
        yield "Together they are equal to the corrections."
    if drilled and result.trimmed:
        yield "Depths are of new holes: those drilled before are not in the file."
    elif result.trimmed and file.most is not None:
        yield "The limit is for these alone: weights already at a place are not in the file."
    if result.limited:
        yield "Places and limits allow no better: see the readings below."
    if result.limited and drilled and file.places is None:
        example = [24] * len(file.planes)
        yield f"For more than one hole in a plane give places, such as places = {example}."


def _show_permitted(result: FieldBalance, found: Permitted, system: System) -> Grid:
    file, unit, mass = result.file, system.unbalance, system.mass
    lines = []
    for x in found.planes:
        permitted, present, scatter, after = (
            UNKNOWN if g_mm is None else number(unit.of(g_mm / 1e6), 4)
            for g_mm in (x.permitted_g_mm, x.present_g_mm, x.scatter_g_mm, x.after_g_mm)
        )
        lines.append((x.plane, permitted, present, scatter, x.verdict, after))
    spread = "how far the true unbalance may lie from it (95 %), by how badly the readings fit"
    if found.planes[0].scatter_g_mm is None:
        spread = "unknown, the fit has as many unknowns as readings; add a run"
    state = f"in '{result.trimmed}'" if result.trimmed else "in the rotor as found"
    return Grid(
        f"Permitted residual unbalance, ISO 21940-11, G {file.grade:g}",
        (
            "plane",
            *(f"{name}, {unit.name}" for name in ("permitted", "there now", "scatter")),
            "",
            f"after, {unit.name}",
        ),
        tuple(lines),
        f"{mass.of(file.mass or 0.0):g} {mass.name} at {file.speed:g} rpm: "
        f"{number(1e3 * found.specific_mm, 4)} µm. There now: {state}, by its readings; after: "
        f"what the corrections leave of it. Scatter: {spread}.",
        frozenset((k, 4) for k, each in enumerate(found.planes) if not each.reached),
        words=(0, 4),
    )


def name_readings(result: FieldBalance) -> list[str]:
    """Return a name for every reading: its sensor, and its speed where there are several."""
    several = len({each.speed_rpm for each in result.readings}) > 1
    return [
        f"{each.sensor}, {each.speed_rpm:g} rpm" if several else each.sensor
        for each in result.readings
    ]


def _show_readings(result: FieldBalance) -> Grid:
    unit = f", {result.unit}" if result.unit else ""
    states = {f"as found{unit}": result.runs.found}
    if result.trimmed:
        states[f"{result.runs.state}{unit}"] = result.before
    states[f"after{unit}"] = result.residual
    weighted = " weighted" if result.file.reading_weights else ""
    note = f"Largest{weighted} after: {number(result.largest, 4)}, rms {number(result.rms, 4)}. "
    if not result.residual.any():
        note = "All readings are cancelled."
    elif result.bound is not None:
        which = "No weights that fit" if result.limited else "No weights"
        note += f"{which} leave less than {number(result.bound, 4)} as the largest."
    else:
        which = "that the places and limits allow" if result.limited else "possible"
        note += f"The sum of their squares is the least {which}."
    title = "Readings, predicted after the corrections"
    return _show_polar(title, result, [*states], [*states.values()], 4, note)


def _show_influence(result: FieldBalance) -> Grid:
    planes = [each.plane for each in result.corrections]
    columns = [result.influence[:, result.file.planes.index(plane)] for plane in planes]
    note = (
        f"Change of a reading by 1 {result.weight_unit} at 0 deg in the plane; angles count as "
        f"phases do, {result.phases} rotation."
    )
    if result.trimmed and result.file.influence is None:
        note += " By least squares over all runs."
    return _show_polar("Influence coefficients", result, planes, columns, 5, note)


def _show_polar(
    title: str,
    result: FieldBalance,
    names: Sequence[str],
    columns: Sequence[Complex],
    digits: int,
    note: str,
) -> Grid:
    """Return a table of complex columns, a line for each reading."""
    heads = [head for name in names for head in (name, "at, deg")]
    lines = [
        (name, *(cell for value in values for cell in _polar(complex(value), digits)))
        for name, *values in zip(name_readings(result), *columns, strict=True)
    ]
    return Grid(title, ("reading", *heads), tuple(lines), note)


RENDERER = Renderer(sheet=sheet, rows=rows)


_MOST_LABELLED = 8  # readings; more names would overlap


def make_field(result: FieldBalance) -> Figure:
    """Return the picture of a rotor before and after balancing."""
    with open_figure(11.0, 6.2) as fig:
        left, right = fig.subplots(1, 2, subplot_kw={"projection": "polar"})
        _draw_readings(left, result)
        _draw_weights(right, result)
        unit = f", {result.unit}" if result.unit else ""
        readings = f"Readings{unit}; phases count {result.phases} rotation"
        weights = f"Weights, {result.weight_unit}; angles count {result.weights} rotation"
        for ax, sense, title in ((left, result.phases, readings), (right, result.weights, weights)):
            ax.set_theta_zero_location("N")  # the rotor turns anticlockwise
            ax.set_theta_direction(1 if sense == "with" else -1)
            ax.set_thetagrids(np.arange(0, 360, 30))
            ax.set_title(title, pad=24)
            ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.08), ncols=3)
        name = fit_name(result.name or "rotor without a name")
        put_title(fig, f"{name}: field balancing")
        return fig


def _draw_readings(ax: PolarAxes, result: FieldBalance) -> None:
    """Draw each reading from a hollow dot (in the last run) to a full one (predicted)."""
    hollow: Look = {"color": SOFT, "markerfacecolor": PAPER}
    ends = [*zip(result.before, result.residual, strict=True)]
    for name, (start, end) in zip(name_readings(result), ends, strict=True):
        angles, sizes = [np.angle(start or end), np.angle(end or start)], [abs(start), abs(end)]
        ax.plot(angles, sizes, color=SOFT, linewidth=1, linestyle=(0, (4, 2)))
        ax.plot(angles[:1], sizes[:1], "o", **hollow)
        ax.plot(angles[1:], sizes[1:], "o", color=BLUE, markersize=5, zorder=3)
        if len(ends) <= _MOST_LABELLED:
            label = f"{fit_name(name, 30)}: {number(abs(start), 3)}"
            ax.annotate(label, (angles[0], sizes[0]), xytext=(6, 5), textcoords="offset points")
    ax.plot([], [], "o", label=fit_name(result.runs.state, 30), **hollow)
    ax.plot([], [], "o", color=BLUE, label="after (predicted)")
    ax.set_ylim(0, 1.25 * (float(np.abs(ends).max()) or 1.0))


def _draw_weights(ax: PolarAxes, result: FieldBalance) -> None:
    """Draw the weight of every plane as a ray, and the pieces of which the shop makes it."""
    drilled = result.file.drill is not None
    marks: Look = {"marker": "x" if drilled else "s", "markerfacecolor": "none", "linestyle": ""}
    sizes = [0.0]
    for each, (line, colour) in zip(result.corrections, cycle(MANY_LOOKS), strict=False):
        name = fit_name(each.plane, 30)
        rays = [(each.step, name, line, 2.0)]
        if each.wanted is not None:
            wanted = each.wanted - each.weight + each.step
            rays.append((wanted, f"{name}, wanted", ":", 1.0))
        for weight, label, style, width in rays:
            text = f"{label}: {number(abs(weight), 3)} at {angle_deg(weight):.1f} deg"
            look: Look = {"color": colour, "linestyle": style, "linewidth": width}
            angle, size = np.angle(weight), abs(weight)
            ax.plot([angle, angle], [0, size], label=text, **look)
            ax.plot([angle], [size], "o", color=colour, markersize=5)
            sizes.append(size)
        if drilled or result.file.places:
            for piece in each.pieces:
                ax.plot([np.radians(piece.angle_deg)], [piece.weight], color=colour, **marks)
                sizes.append(piece.weight)
    if drilled or result.file.places:
        ax.plot([], [], color=INK, label="holes" if drilled else "places", **marks)
    ax.set_ylim(0, 1.15 * (max(sizes) or 1.0))

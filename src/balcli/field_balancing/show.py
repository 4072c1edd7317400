"""Show the result of field balancing as tables and CSV.

`make_field` draws polar diagrams: readings before and after the corrections on the left, weights on
the right.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from itertools import cycle
from typing import TYPE_CHECKING

import numpy as np

from ..core.phasors import Array, Complex
from ..core.records import Node, angle_deg, list_figures, to_document
from ..show.formats import Renderer, Rows, name_cell
from ..show.plot_style import BLUE, INK, MANY_LOOKS, PAPER, SOFT, fit_name, open_figure, put_title
from ..show.sheet import UNKNOWN, Column, Facts, Grid, Sheet, Text, degrees, number
from ..show.units import System
from .amplitudes import AmplitudeFit, Answers
from .answer import FieldBalance, Permitted

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from matplotlib.projections.polar import PolarAxes

    from ..show.plot_style import Look


_ROUNDING = 1e-9  # a predicted amplitude below this share of the reading as found is 0
_HEADER = ("part", "speed_rpm", "name", "figure", "value", "unit")
_WAY = {"with": "the way the rotor turns", "against": "against the way the rotor turns"}


# ------------------------------------------------------------------ for programs
def rows(result: FieldBalance, system: System) -> Rows:
    """Return all figures as CSV, with weights and readings in the units of the file."""
    return Rows(_HEADER, _list_lines(to_document(result), result.file.planes))


def _list_lines(document: Node, planes: tuple[str, ...]) -> Iterator[tuple[object, ...]]:
    for correction in document["corrections"]:
        plane = correction["plane"]
        yield from _list_part("correction", correction, plane, document["weight_unit"])
    for part in ("before", "residual"):
        for reading, value in zip(document["readings"], document[part], strict=True):
            yield from _list_part(part, value, unit=document["unit"] or "", **reading)
    for reading, line in zip(document["readings"], document["influence"], strict=True):
        for plane, value in zip(planes, line, strict=True):
            name = f"{reading['sensor']} by {plane}"
            yield from _list_part("influence", value, name, "", reading["speed_rpm"])
    for permitted in document.get("permitted", {"planes": ()})["planes"]:
        yield from _list_part("permitted", permitted, permitted["plane"])
    for solution in document.get("solutions", ()):
        yield from _list_part("solution", solution, planes[0], document["weight_unit"])
    keys = ("condition", "largest", "rms", "bound", "method", "ambiguous", "fit_rms")
    yield from _list_part("details", {key: document[key] for key in keys if key in document})


def _list_part(
    part: str, figures: Node, sensor: str = "", unit: str = "", speed_rpm: float | None = None
) -> Iterator[tuple[object, ...]]:
    """Yield a line for each figure of an object; `unit` is that of weights and amplitudes."""
    for name, value, own_unit in list_figures(figures, ("plane",)):
        of_file = name.rpartition(".")[2] in ("weight", "amplitude")
        cells = part, speed_rpm, name_cell(sensor), name, value
        yield *cells, name_cell(unit) if of_file else own_unit


# ------------------------------------------------------------------ for people
def sheet(result: FieldBalance, system: System) -> Sheet:
    """Return all tables; weights and readings are in the units of the file."""
    file = result.file
    parts: list[Grid | Facts | Text] = [_show_senses(result)]
    if result.fit is not None and result.fit.answers is not None:
        parts += [_show_answers(result, result.fit.answers, system)]
        parts += [_show_open_readings(result, result.fit, result.fit.answers)]
        return Sheet(f"{file.name or 'rotor without a name'}: field balancing", tuple(parts))
    parts.append(_show_corrections(result, system))
    if file.places or file.drill:
        parts.append(_show_pieces(result, system))
    if result.permitted is not None:
        parts.append(_show_permitted(result, result.permitted, system))
    parts += [_show_readings(result), _show_influence(result)]
    return Sheet(f"{file.name or 'rotor without a name'}: field balancing", tuple(parts))


def _show_senses(result: FieldBalance) -> Text:
    if result.fit is not None:
        marked = "Readings are amplitudes only; angles of weights count as they are marked."
        return Text("How angles count", (marked,))
    phases = result.phases
    weights = result.weights
    same = "like phases" if phases == weights else "opposite to phases"
    senses = (
        f"Phases of readings {result.file.rotation}: they count {phases} rotation. Angles of "
        f"weights count {weights} rotation, {same}:"
    )
    picture = f"a weight at 30 deg is 30 deg from the 0 mark, going {_WAY[weights]}."
    return Text("How angles count", (senses, picture))


def _list_polar(
    head: str, values: Iterable[complex], digits: int = 4, marked: Collection[int] = ()
) -> list[Column]:
    """Return two columns of weights or readings: magnitudes below `head`, and angles.

    Args:
        head: Heading of the magnitudes.
        values: Weights or readings.
        digits: Digits of the magnitudes.
        marked: Rows with highlighted magnitudes.
    """
    values = [complex(value) for value in values]
    sizes = [number(abs(value), digits) for value in values]
    angles = [degrees(angle_deg(value)) if value else UNKNOWN for value in values]
    return [Column(head, sizes, marked=marked), Column("at, deg", angles)]


def _tell_weight(result: FieldBalance, value: complex) -> str:
    return f"{number(abs(value))} {result.weight_unit} at {degrees(angle_deg(value))} deg"


def _show_corrections(result: FieldBalance, system: System) -> Grid:
    file = result.file
    unit = result.weight_unit
    every = result.corrections
    at_limit = [k for k, each in enumerate(every) if each.at_limit]
    columns = [Column("plane", [each.plane for each in every], words=True)]
    columns += _list_polar(f"weight, {unit}", [each.weight for each in every], marked=at_limit)
    if result.trimmed:
        columns += _list_polar(f"add now, {unit}", [each.step for each in every])
    if file.radius is not None:
        radii = dict(zip(file.planes, file.radius, strict=True))
        lengths = [number(system.length.of(radii[each.plane] / 1e3)) for each in every]
        unbalances = [_show_g_mm(each.unbalance_g_mm, system) for each in every]
        columns.append(Column(f"radius, {system.length.name}", lengths))
        columns.append(Column(f"unbalance, {system.unbalance.name}", unbalances))
    shares = [f"{each.own_effect:.0%}{', at its limit' * each.at_limit}" for each in every]
    columns.append(Column("own effect", shares))
    return Grid("Corrections", columns, " ".join(_explain_corrections(result)))


def _show_answers(result: FieldBalance, answers: Answers, system: System) -> Grid:
    """Return the table of both weights that fit the amplitudes."""
    (plane,) = result.used
    k = result.file.planes.index(plane)
    columns = [Column("answer", ["lighter", "heavier"], words=True)]
    columns.append(Column("plane", [plane, plane], words=True))
    columns += _list_polar(f"weight, {result.weight_unit}", answers.corrections)
    per_weight = result.file.find_unbalance_per_weight(k)
    if result.file.radius is not None and per_weight is not None:
        radius = number(system.length.of(result.file.radius[k] / 1e3))
        columns.append(Column(f"radius, {system.length.name}", [radius, radius]))
        sizes = [abs(weight) * per_weight for weight in answers.corrections]
        unbalances = [number(system.unbalance.of(size)) for size in sizes]
        columns.append(Column(f"unbalance, {system.unbalance.name}", unbalances))
    return Grid(
        "Two answers",
        columns,
        "Two answers fit. Put the lighter one on: if the reading does not fall as predicted, use "
        "the other. A trial weight off the circle through the others would decide. Weights to add "
        "to the rotor as found, with all trial weights off.",
    )


def _show_open_readings(result: FieldBalance, fit: AmplitudeFit, answers: Answers) -> Grid:
    """Return the table of readings with the lighter answer on, by which answer is right."""
    lighter = answers.corrections[0]
    as_found = np.abs(fit.influence.found)
    unit = f", {result.unit}" if result.unit else ""
    columns = [Column("reading", _name_readings(result), words=True)]
    columns.append(Column(f"as found{unit}", _write_amplitudes(fit.measured, fit.measured)))
    for head, alpha in (
        ("if it is right", answers.firsts),
        ("if the other is right", answers.others),
    ):
        predicted = np.abs(as_found + alpha * lighter)
        columns.append(Column(head, _write_amplitudes(predicted, as_found)))
    return Grid("Readings, predicted with the lighter one on", columns, _tell_misfit(result, fit))


def _write_amplitudes(amplitudes: Array, as_found: Array) -> list[str]:
    """Return amplitudes as texts; rounding errors of readings as found are 0."""
    shown = np.where(amplitudes <= _ROUNDING * as_found, 0, amplitudes)
    return [number(float(amplitude)) for amplitude in shown]


def _tell_misfit(result: FieldBalance, fit: AmplitudeFit) -> str:
    amount = " ".join(filter(None, [number(fit.rms, 3), result.unit]))
    return f"Misfit of the amplitudes: {amount} (rms), {fit.share:.1%} of the largest reading."


def _show_g_mm(value: float | None, system: System) -> str:
    return UNKNOWN if value is None else number(system.unbalance.of(value / 1e6))


def _explain_corrections(result: FieldBalance) -> Iterator[str]:
    yield "Weights to add to the rotor as found, with all trial weights off."
    if result.file.radius is not None and result.file.weighs_masses:
        yield "Trial weights count at the radius of their plane unless a run gives its own."
    if result.trimmed:
        yield f"Add now: in addition to the weights of '{result.trimmed}'."
    yield (
        "Own effect: share of a plane's effect that other planes cannot produce. Condition "
        f"number of the influence coefficients: {number(result.condition, 3)}."
    )
    for correction in result.corrections:
        if correction.wanted is not None:
            best = _tell_weight(result, correction.wanted)
            yield f"Without its limit, {correction.plane} would need {best}."
    if result.left_out:
        yield f"Planes left out: {', '.join(result.left_out)}."
    for plane, weight in zip(result.file.planes, result.runs.weights_on, strict=True):
        if weight and plane in result.left_out:
            kept = _tell_weight(result, result.file.turn(complex(weight)))
            yield f"The weight of '{result.trimmed}' in {plane} stays on: {kept}."


def _show_pieces(result: FieldBalance, system: System) -> Grid:
    file = result.file
    length = system.length
    heads = [
        Column("plane", words=True),
        Column("hole" if file.drill else "place"),
        Column("at, deg"),
        Column(f"weight, {file.weight_unit}"),
    ]
    if file.drill:
        heads += [Column(f"drill, {length.name}"), Column(f"depth, {length.name}")]
    lines: list[tuple[str, ...]] = []
    for correction in result.corrections:
        k = file.planes.index(correction.plane)
        for piece in correction.pieces:
            count = len(file.places[k]) if file.places else 0
            place = UNKNOWN if piece.place is None else f"{piece.place} of {count}"
            cells = [correction.plane, place, degrees(piece.angle_deg), number(piece.weight)]
            if file.drill is not None and piece.depth_mm is not None:
                cells.append(number(length.of(file.drill[k] / 1e3), 6))
                cells.append(number(length.of(piece.depth_mm / 1e3), 3))
            lines.append(tuple(cells))
        if not correction.pieces:
            lines.append((correction.plane, *[UNKNOWN] * (len(heads) - 1)))
    task = "Holes to drill" if file.drill else "Weights to put on"
    when = f", in addition to '{result.trimmed}'" if result.trimmed else ""
    note = "In each plane, these weights together replace the single weight above."
    if file.drill:
        note = (
            "Radial holes in steel, from the rim inwards, opposite to the weights. Each hole has "
            "the effect of its weight at the rim; the removed steel, nearer the axis, is heavier."
        )
    if result.trimmed and (file.drill or file.most):
        note += " Limits and depths ignore earlier weights and holes, which are not in the file."
    return Grid.of_rows(f"{task}{when}", heads, lines, note)


def _show_permitted(result: FieldBalance, permitted: Permitted, system: System) -> Grid:
    file = result.file
    unit = system.unbalance.name
    mass = system.mass
    every = permitted.planes
    not_reached = [k for k, each in enumerate(every) if not each.reached]

    def write(sizes: Iterable[float | None]) -> list[str]:
        return [_show_g_mm(size, system) for size in sizes]

    columns = [
        Column("plane", [each.plane for each in every], words=True),
        Column(f"permitted, {unit}", write(each.permitted_g_mm for each in every)),
        Column(f"there now, {unit}", write(each.now_g_mm for each in every)),
        Column("", [each.verdict for each in every], words=True, marked=not_reached),
        Column(f"after, {unit}", write(each.after_g_mm for each in every)),
    ]
    state = f"in '{result.trimmed}'" if result.trimmed else "of the rotor as found"
    note = (
        f"{mass.of(file.mass or 0.0):g} {mass.name} at {file.speed:g} rpm: permitted eccentricity "
        f"{number(1e3 * permitted.specific_mm)} µm. There now: unbalance {state}, from its "
        "readings; after: unbalance after the corrections."
    )
    if result.fit is None:
        scatter = Column(f"scatter, {unit}", write(each.scatter_g_mm for each in every))
        columns.insert(3, scatter)
        note += f" Scatter: {_explain_scatter(permitted)}."
    return Grid(f"Permitted residual unbalance, ISO 21940-11, G {file.grade:g}", columns, note)


def _explain_scatter(found: Permitted) -> str:
    if found.planes[0].scatter_g_mm is None:
        return "unknown, because the fit has as many unknowns as readings; add a run"
    return "largest error of 'there now' (95 %), estimated from the residuals of the fit"


def _name_readings(result: FieldBalance) -> list[str]:
    """Return a name for every reading: its sensor, and its speed if there are several."""
    several = len({each.speed_rpm for each in result.readings}) > 1
    return [
        f"{each.sensor}, {each.speed_rpm:g} rpm" if several else each.sensor
        for each in result.readings
    ]


def _show_readings(result: FieldBalance) -> Grid:
    unit = f", {result.unit}" if result.unit else ""
    columns = [Column("reading", _name_readings(result), words=True)]
    as_found = result.runs.found if result.fit is None else result.fit.measured.astype(complex)
    columns += _list_readings(result, f"as found{unit}", as_found)
    if result.trimmed:
        columns += _list_readings(result, f"{result.runs.state}{unit}", result.runs.latest)
    columns += _list_readings(result, f"after{unit}", result.residual)
    what = f"Largest{' weighted' * bool(result.file.reading_weights)} reading after the corrections"
    note = f"{what}: {number(result.largest)}, rms {number(result.rms)}. "
    if not result.residual.any():
        note = "All readings are cancelled."
    elif result.bound is not None:
        which = "No allowed weights" if result.limited else "No weights"
        note += f"{which} make the largest reading smaller than {number(result.bound)}."
    else:
        which = "that the places and limits allow" if result.limited else "possible"
        note += f"The sum of squares of the readings is the least {which}."
    if result.fit is not None:
        note += f" {_tell_misfit(result, result.fit)}"
    return Grid("Readings, predicted after the corrections", columns, note)


def _list_readings(result: FieldBalance, head: str, values: Complex) -> list[Column]:
    """Return the columns of readings: amplitudes below `head`, and phases if readings have any."""
    columns = _list_polar(head, values)
    return columns if result.fit is None else columns[:1]


def _show_influence(result: FieldBalance) -> Grid:
    columns = [Column("reading", _name_readings(result), words=True)]
    for correction in result.corrections:
        effects = result.influence[:, result.file.planes.index(correction.plane)]
        columns += _list_polar(correction.plane, effects, 5)
    note = f"Change of a reading by 1 {result.weight_unit} at 0 deg in the plane; "
    if result.fit is None:
        note += f"angles count like phases, {result.phases} rotation."
    else:
        note += "angles count from the reading as found, in the direction of those of weights."
    if result.trimmed and result.file.influence is None:
        note += " The coefficients are fitted to all runs by least squares."
    return Grid("Influence coefficients", columns, note)


RENDERER = Renderer(sheet=sheet, rows=rows)


_MOST_LABELLED = 8  # largest number of readings with a name; more names would overlap


def make_field(result: FieldBalance) -> Figure:
    """Return the picture of a rotor before and after balancing."""
    with open_figure(11.0, 6.2) as fig:
        left, right = fig.subplots(1, 2, subplot_kw={"projection": "polar"})
        _draw_readings(left, result)
        _draw_weights(right, result)
        unit = f", {result.unit}" if result.unit else ""
        readings = f"Readings{unit}; phases count {result.phases} rotation"
        weights = f"Weights, {result.weight_unit}; angles count {result.weights} rotation"
        if result.fit is not None:
            readings = f"Readings{unit}; amplitudes only"
            weights = f"Weights, {result.weight_unit}; angles as they are marked"
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
    """Draw each reading as a hollow dot (latest run) joined to a full dot (after corrections)."""
    hollow: Look = {"color": SOFT, "markerfacecolor": PAPER}
    ends = [*zip(result.runs.latest, result.residual, strict=True)]
    for name, (start, end) in zip(_name_readings(result), ends, strict=True):
        angles = [np.angle(start or end), np.angle(end or start)]
        sizes = [abs(start), abs(end)]
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
    """Draw the weight of every plane as a ray, and its single weights or holes as marks."""
    drilled = result.file.drill is not None
    marks: Look = {"marker": "x" if drilled else "s", "markerfacecolor": "none", "linestyle": ""}
    sizes = [0.0]
    answers = zip(("lighter", "heavier"), result.solutions or (), MANY_LOOKS, strict=False)
    for name, weight, (line, colour) in answers:
        text = f"{name}: {number(abs(weight), 3)} at {angle_deg(weight):.1f} deg"
        angles = [np.angle(weight)] * 2
        ax.plot(angles, [0, abs(weight)], label=text, color=colour, linestyle=line, marker="o")
        sizes.append(abs(weight))
    for correction, (line, colour) in zip(result.corrections, cycle(MANY_LOOKS), strict=False):
        name = fit_name(correction.plane, 30)
        rays = {name: (correction.step, line)}
        if correction.wanted is not None:
            rays[f"{name}, wanted"] = (correction.wanted - correction.weight + correction.step, ":")
        for label, (weight, style) in rays.items():
            angle = np.angle(weight)
            size = abs(weight)
            text = f"{label}: {number(size, 3)} at {angle_deg(weight):.1f} deg"
            look: Look = {"color": colour, "linestyle": style, "marker": "o", "markersize": 5}
            ax.plot([angle, angle], [0, size], label=text, markevery=[1], **look)
            sizes.append(size)
        if drilled or result.file.places:
            for piece in correction.pieces:
                ax.plot([np.radians(piece.angle_deg)], [piece.weight], color=colour, **marks)
                sizes.append(piece.weight)
    if drilled or result.file.places:
        ax.plot([], [], color=INK, label="holes" if drilled else "places", **marks)
    ax.set_ylim(0, 1.15 * (max(sizes) or 1.0))

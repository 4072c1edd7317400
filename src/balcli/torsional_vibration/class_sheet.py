"""Write the sheet of a calculation for a classification society or a customer: one HTML page with
inputs, modes, Holzer's tables, excitation, critical speeds, and stresses against their limits, with
all cylinders firing and with the worst misfire.

Tables are the blocks of the terminal; this module adds what the terminal does not show.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Iterator, Sequence
from datetime import date
from html import escape
from pathlib import Path
from typing import NamedTuple

import numpy as np

from ..core.phases import RPM
from ..engine.engine import Engine
from ..errors import ArgumentError
from ..file.fields import counted
from ..process import Tell, tell_nobody
from ..show.engine_facts import engine_facts
from ..show.notebook import write_block
from ..show.plot_style import inline_svg, save_figure
from ..show.sheet import (
    UNKNOWN,
    Column,
    Facts,
    Grid,
    Text,
    number,
    order_name,
    size_text,
    tell_assumed,
)
from ..show.units import System
from ..version import __version__
from . import show
from .answer import (
    HolzerAsked,
    HolzerTable,
    TorsionAnalysis,
    TorsionQuestion,
    answer_question,
    tabulate_chain,
)
from .load import Source
from .misfire import MisfireAsked, compute_all_cycles
from .modes import sum_phases
from .permitted import M68, LimitTable, MeanLimit, ShaftLimit
from .plot import DrawnCase, make_limits, make_torsion
from .system import TorsionalSystem
from .throw_stiffness import ThrowSize
from .verdicts import LimitVerdict

_STYLE = Path(__file__).parent / "assets" / "sheet.css"
_MOST_TABLES = 4  # largest number of Holzer's tables
_MOST_SUMS = 4  # largest number of modes whose phase sums are listed
_LEAST_TORQUE = 1e-3  # orders with a smaller share of the largest torque are left out

Part = Grid | Facts | Text


class SheetFile(NamedTuple):
    """Name and content of the file that a sheet describes."""

    name: str
    content: bytes


class Cases(NamedTuple):
    """Results of both cases.

    Attributes:
        firing: With all cylinders firing.
        misfire: With the worst misfire; None for a chain, and for an engine without gas.
        compressing: Whether the cylinder of the misfire compresses.
    """

    firing: TorsionAnalysis
    misfire: TorsionAnalysis | None
    compressing: bool


class Section(NamedTuple):
    """A section of the page.

    Attributes:
        key: Its id.
        title: Its heading.
        parts: Its tables and texts.
        pictures: Its pictures, as SVG for a page.
    """

    key: str
    title: str
    parts: Sequence[Part]
    pictures: Sequence[str] = ()


def make_cases(source: Source, question: TorsionQuestion, tell: Tell = tell_nobody) -> Cases:
    """Return the results that a sheet shows.

    Args:
        source: File of the chain or engine.
        question: Request with speeds, without a damper to size.
        tell: Function that is called with the share of the work done so far.

    Raises:
        BalcliError: A response lacks excitation or passes an undamped resonance.
        InputError: The file contradicts itself.
    """
    firing = answer_question(source, question)
    engine = source.engine
    if engine is None or engine.gas is None or not firing.shafts:
        return Cases(firing, None, compressing=False)
    compressing = compute_all_cycles(engine)
    asked = MisfireAsked(worst=True, compressing=compressing)
    misfire = answer_question(source._replace(misfire=asked), question, tell)
    return Cases(firing, misfire, compressing)


def write_sheet(cases: Cases, source: Source, file: SheetFile, system: System) -> str:
    """Return the page.

    Args:
        cases: Results, from `make_cases`.
        source: File of the chain or engine.
        file: Its name and content.
        system: System of units.
    """
    sections = list(_list_sections(cases, source, file, system))
    name = cases.firing.name or file.name
    lines = [
        "<!DOCTYPE html>",
        '<html lang="en">',
        '<head><meta charset="utf-8">',
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        f"<title>{escape(name)}: torsional vibration</title>",
        f"<style>\n{_STYLE.read_text(encoding='utf-8')}</style></head>",
        "<body><main>",
        f"<h1>{escape(name)}: torsional vibration calculation</h1>",
        _write_summary(cases),
        *map(_write_section, sections),
        '<div class="signed"><span>calculated</span><span>checked</span><span>date</span></div>',
        "</main></body></html>",
    ]
    return "\n".join(lines)


def _write_section(section: Section) -> str:
    """Return a section; one without content says so."""
    blocks = []
    for part in section.parts:
        kind = 'class="facts"'
        if not isinstance(part, Facts):
            kind = 'class="wide" tabindex="0"'  # keys scroll a table that is too wide
        blocks.append(f"<div {kind}>{write_block(part)}</div>")
    blocks += [f"<figure>{picture}</figure>" for picture in section.pictures]
    body = "\n".join(blocks)
    return f'<section id="{section.key}">\n<h2>{escape(section.title)}</h2>\n{body}\n</section>'


def _write_summary(cases: Cases) -> str:
    """Return the verdicts of both cases in a few lines."""
    lines = [f"Firing: {_sum_up(cases.firing)}"]
    if cases.misfire is not None:
        lines.append(f"{_name_misfire(cases, cases.misfire)}: {_sum_up(cases.misfire)}")
    paragraphs = "".join(f"<p>{escape(line)}</p>" for line in lines)
    return f'<div class="verdict">{paragraphs}</div>'


def _sum_up(result: TorsionAnalysis) -> str:
    """Return the verdicts on all limits in a sentence."""
    if not hasattr(result, "limits"):
        return "no limit is given, so nothing is judged."
    named: dict[str, list[str]] = {"fails": [], "barred": [], "passes": [], "not checked": []}
    for verdict in result.limits:
        named[verdict.verdict].append(_name_verdict(verdict))
    words = []
    for verdict_word in ("fails", "barred"):
        if named[verdict_word]:
            words.append(f"{verdict_word}: {', '.join(named[verdict_word])}")
    if named["passes"]:
        words.append(f"{counted(len(named['passes']), 'limit')} kept")
    if named["not checked"]:
        words.append(f"{counted(len(named['not checked']), 'shaft')} not checked")
    return "; ".join(words) + "."


def _name_verdict(verdict: LimitVerdict) -> str:
    """Return a limit by its shaft, kind and share."""
    if verdict.share is None:
        return verdict.shaft
    return f"{verdict.shaft} ({verdict.kind}, {verdict.share:.0%})"


def _name_misfire(cases: Cases, misfire: TorsionAnalysis) -> str:
    """Return the worst misfire in words."""
    how = "compresses but does not burn" if cases.compressing else "has no gas force"
    return f"Worst misfire (cylinder {misfire.misfire.worst} {how})"


def _list_sections(
    cases: Cases, source: Source, file: SheetFile, system: System
) -> Iterator[Section]:
    """Yield the sections in their order."""
    firing = cases.firing
    yield Section("inputs", "Inputs", [_show_inputs(firing, source, file, system)])
    nodes = _show_nodes(firing, system)
    yield Section("mass-elastic", "Mass-elastic system", [nodes, _show_shafts(firing, system)])
    yield Section("throw", "Throw stiffness", list(_show_throw(firing, system)))
    shapes = [show.show_modes(firing), show.show_shapes(firing, system)]
    yield Section("modes", "Natural frequencies and modes", shapes)
    yield Section("holzer", "Holzer's tables", list(_show_holzer(firing, system)))
    entries = show.show_excitations(firing, firing.response, system)
    excitation: list[Part] = [_show_excitation(firing, system), *entries]
    yield Section("excitation", "Excitation", excitation)
    criticals = [show.show_criticals(firing)] if firing.modes else [_say("No mode.")]
    campbell = [_draw_campbell(firing, system)] if firing.modes else []
    yield Section("criticals", "Critical speeds", criticals, campbell)
    response = [show.show_response(firing, firing.response, system)]
    if firing.measured is not None:
        response.append(show.show_measured(firing, firing.measured))
    yield Section("response", "Amplitudes and stresses, all cylinders firing", response)
    limits = list(show.show_limits(firing, system))
    pictures = list(_draw_limits(cases, system))
    nothing = _say("The file gives no limit.")
    yield Section("limits", "Limits, all cylinders firing", limits or [nothing], pictures)
    yield Section("misfire", "Misfire", list(_show_misfire(cases, system)))
    yield Section("dampers", "Dampers", list(_show_dampers(cases, system)))
    yield Section("conventions", "Conventions", [_tell_conventions(firing)])


def _say(line: str) -> Text:
    """Return a line in place of a section's content."""
    return Text("", (line,))


# ------------------------------------------------------------------ inputs and system
def _show_inputs(result: TorsionAnalysis, source: Source, file: SheetFile, system: System) -> Facts:
    """Return where the figures come from, and the engine."""
    engine = source.engine
    speeds = result.response.speeds_rpm
    span = f"{number(float(speeds[0]))} to {number(float(speeds[-1]))} rpm"
    pairs = [
        ("name", result.name or UNKNOWN),
        ("source", (engine.source if engine is not None else "") or "not given in the file"),
        ("file", file.name),
        ("SHA-256 of the file", hashlib.sha256(file.content).hexdigest()),
        ("calculated with", f"balcli {__version__}, {date.today().isoformat()}"),
        ("speeds", f"{span}, {counted(len(speeds), 'speed')} given; peaks between them are found"),
    ]
    if engine is not None:
        pairs += _describe_engine(engine, system)
        pairs += _tell_power(result, system)
    if result.system.rated_rpm:
        pairs.append(("rated speed", f"{number(result.system.rated_rpm)} rpm"))
    orders = [order_name(order) for order in result.orders]
    pairs.append(("orders", f"{orders[0]} to {orders[-1]}, {counted(len(orders), 'order')}"))
    pairs.append(("assumed", tell_assumed(result.assumed or ()) or "nothing"))
    warnings = [str(doubt) for doubt in (*source.doubts, *result.doubts)]
    pairs.append(("warnings", "; ".join(warnings) or "none"))
    return Facts(tuple(pairs))


def _describe_engine(engine: Engine, system: System) -> Iterator[tuple[str, str]]:
    """Yield cylinders, crank, firing and masses; speed and assumed values stand elsewhere."""
    for name, text in engine_facts(engine, system, whole=False).pairs:
        if name not in ("speed", "assumed"):
            yield name, text


def _tell_power(result: TorsionAnalysis, system: System) -> Iterator[tuple[str, str]]:
    """Yield mean torque and power of an engine with gas at its rated speed."""
    means = result.system.means
    rpm = result.system.rated_rpm
    if means is None or rpm is None:
        return
    torque = float(means.find_total(np.array(rpm)))
    power = size_text(torque * rpm * RPM, system.power)
    yield "indicated", f"{size_text(torque, system.moment)} on average, {power}"


def _show_nodes(result: TorsionAnalysis, system: System) -> Grid:
    """Return the inertias, front to rear."""
    inertia = system.inertia
    heads = [Column("node", words=True), Column(f"J, {inertia.name}"), Column("gear")]
    rows = []
    for node in result.nodes:
        size = node.inertia_kg_m2 or math.nan
        rows.append((node.name, number(inertia.of(size), 6), number(node.gear, 6)))
    note = "J at the node's own speed; gear: that speed over the speed of the crankshaft."
    return Grid.of_rows("Inertias", heads, rows, note)


def _show_shafts(result: TorsionAnalysis, system: System) -> Grid | Text:
    """Return the shafts with stiffness, section, losses and limits."""
    own = result.system
    if not result.shafts:
        return _say("There is no shaft.")
    stiffness = system.torsional_stiffness
    length = system.length
    dashpots = own.damping.dashpots
    heads = [
        Column("shaft", words=True),
        Column(f"k, {stiffness.name}"),
        Column(f"diameter, {length.name}"),
        Column(f"bore, {length.name}"),
    ]
    if any(own.lengths):
        heads.append(Column(f"length, {length.name}"))
    heads.append(Column("loss"))
    if np.any(dashpots):
        heads.append(Column(f"dashpot, {system.torsional_damping.name}"))
    heads.append(Column("limit", words=True))
    rows = []
    for k, shaft in enumerate(result.shafts):
        outer, inner = own.sections[k]
        row = [
            shaft.name,
            number(stiffness.of(shaft.stiffness_Nm_per_rad), 6).replace("inf", "rigid"),
            number(length.of(outer or math.nan), 6),
            number(length.of(inner)) if outer else UNKNOWN,
        ]
        if any(own.lengths):
            row.append(number(length.of(own.lengths[k] or math.nan), 6))
        row.append(number(float(own.damping.loss[k])))
        if np.any(dashpots):
            row.append(number(system.torsional_damping.of(float(dashpots[k]))))
        row.append(_name_limits(own, k, system) or UNKNOWN)
        rows.append(row)
    notes = ["With a length: a plain shaft, whose k follows from it."] if any(own.lengths) else []
    notes.append(_name_node_damping(own, system))
    return Grid.of_rows("Shafts", heads, rows, " ".join(notes).strip())


def _name_limits(own: TorsionalSystem, shaft: int, system: System) -> str:
    """Return the limits of a shaft in words."""
    limits = [limit for limit in own.limits if limit.column == shaft]
    return "; ".join(_name_limit(limit, system) for limit in limits)


def _name_limit(limit: ShaftLimit, system: System) -> str:
    """Return a limit in words."""
    permitted = limit.limit
    if isinstance(permitted, LimitTable):
        unit = (system.stress if limit.kind == "stress" else system.moment).fit(0.0)
        sizes = [number(unit.of(size)) for size in permitted.values]
        if len(sizes) == 1:
            return f"{sizes[0]} {unit.name}"
        at = ", ".join(number(rpm) for rpm in permitted.rpm)
        return f"{', '.join(sizes)} {unit.name} at {at} rpm"
    if isinstance(permitted, MeanLimit):
        return "mean torque"
    return (
        f"M68: tensile strength {permitted.tensile:g} N/mm², c_K {permitted.factor:g}, rated "
        f"{permitted.rated_rpm:g} rpm"
    )


def _name_node_damping(own: TorsionalSystem, system: System) -> str:
    """Return a note on the damping of nodes against ground."""
    unit = system.torsional_damping
    parts = []
    for name, damping in zip(own.nodes, own.damping.nodes.tolist(), strict=False):
        if damping:
            parts.append(f"{name} {number(unit.of(damping))}")
    return f"Damping against ground, {unit.name}: {', '.join(parts)}." if parts else ""


def _show_throw(result: TorsionAnalysis, system: System) -> Iterator[Part]:
    """Yield the dimensions of a throw, and its stiffness by both formulas."""
    if result.throw is None or result.system.throw is None:
        yield _say("The stiffness of the throws is given; the file has no dimensions of a throw.")
        return
    yield _show_throw_size(result.system.throw.size, system)
    yield show.show_throw(result, result.throw, system)


def _show_throw_size(throw: ThrowSize, system: System) -> Facts:
    """Return the dimensions of a throw."""
    length = system.length
    journal = throw.journal_diameter, throw.journal_bore, throw.journal_length
    pin = throw.pin_diameter, throw.pin_bore, throw.pin_length
    web = f"{size_text(throw.thickness, length)} thick, {size_text(throw.width, length)} wide"
    pairs = [
        ("crank radius", size_text(throw.radius, length)),
        ("main journal", _tell_cylinder(*journal, system)),
        ("crank pin", _tell_cylinder(*pin, system)),
        ("web", web),
        ("shear modulus", f"{number(throw.shear_modulus / 1e9)} GPa"),
    ]
    return Facts(tuple(pairs))


def _tell_cylinder(diameter: float, bore: float, length: float, system: System) -> str:
    """Return the dimensions of a journal or pin, m, in words."""
    hollow = f", bore {size_text(bore, system.length)}" if bore else ""
    outside = size_text(diameter, system.length)
    return f"diameter {outside}{hollow}, {size_text(length, system.length)} long"


# ------------------------------------------------------------------ modes and excitation
def _show_holzer(result: TorsionAnalysis, system: System) -> Iterator[Part]:
    """Yield Holzer's table of each mode with a critical speed in the range."""
    modes = sorted({critical.mode for critical in result.criticals})[:_MOST_TABLES]
    if not modes:
        yield _say("No mode has a critical speed in the range of speeds.")
    for mode in modes:
        table = _tabulate(result, mode)
        if table is None:
            text = f"Mode {mode} has no table: the chain has a loop, or a branch swings by itself."
            yield _say(text)
        else:
            yield show.show_holzer(result, table, system)


def _tabulate(result: TorsionAnalysis, mode: int) -> HolzerTable | None:
    """Return Holzer's table of a mode; None if it cannot be followed along the chain."""
    try:
        return tabulate_chain(result.system, result.modes, HolzerAsked(mode))
    except ArgumentError:
        return None


def _show_excitation(result: TorsionAnalysis, system: System) -> Grid:
    """Return the amplitude of each order at rated speed, and its phase sums in the lowest modes."""
    whole = result.system.require_excitation()
    cylinders = whole.steady.shape[1]
    excitation = whole._replace(further=(), nodes=whole.nodes[:cylinders])
    speeds = result.response.speeds_rpm
    rpm = result.system.rated_rpm or float(speeds[-1])
    torque = np.abs(excitation.at(np.array([rpm * RPM]))[:, 0, :]).max(axis=1)
    modes = result.modes[:_MOST_SUMS]
    sums = sum_phases(excitation, modes, rpm * RPM)
    unit = system.moment.fit(float(torque.max()))
    heads = [Column("order"), Column(f"amplitude, {unit.name}")]
    heads += [Column(f"phase sum, mode {mode.number}") for mode in modes]
    rows = []
    for k in np.flatnonzero(torque >= _LEAST_TORQUE * torque.max()).tolist():
        row = [order_name(float(excitation.orders[k])), number(unit.of(float(torque[k])))]
        row += [number(float(of_mode[k]), 3) for of_mode in sums]
        rows.append(row)
    title = f"Torque on one node at {number(rpm)} rpm"
    note = (
        "Gas and inertia torque of a cylinder, or a torque of a chain file; of different ones, the "
        "largest. Phase sum: sum over these torques of an order, each times the angle of its node, "
        "divided by the largest. Critical speeds count torques on nodes as well."
    )
    return Grid.of_rows(title, heads, rows, note)


def _draw_campbell(result: TorsionAnalysis, system: System) -> str:
    """Return the Campbell diagram as SVG for the page."""
    figure = make_torsion(result, "campbell", system, titled=False)
    return inline_svg(save_figure(figure, "svg"), "campbell")


# ------------------------------------------------------------------ limits, misfire, dampers
def _draw_limits(cases: Cases, system: System) -> Iterator[str]:
    """Yield the pictures of all limits as SVG for the page."""
    drawn = [DrawnCase("firing", cases.firing)]
    if cases.misfire is not None:
        worst = cases.misfire.misfire.worst
        drawn.append(DrawnCase(f"cylinder {worst} not firing", cases.misfire))
    for k, figure in enumerate(make_limits(drawn, system), 1):
        yield inline_svg(save_figure(figure, "svg"), f"limits-{k}")


def _show_misfire(cases: Cases, system: System) -> Iterator[Part]:
    """Yield the misfire of each cylinder, and torques and limits with the worst one."""
    if cases.misfire is None:
        yield _say("There are no cylinders with gas, so there is no misfire.")
        return
    worst = cases.misfire
    yield _say(f"{_name_misfire(cases, worst)}.")
    yield show.show_misfires(worst.misfire, system)
    yield show.show_response(worst, worst.response, system)
    yield from show.show_limits(worst, system)


def _show_dampers(cases: Cases, system: System) -> Iterator[Part]:
    """Yield the dampers, and their heat in both cases."""
    own = cases.firing.system
    dampers = cases.firing.response.dampers or ()
    if not dampers and not own.pendulums:
        yield _say("There are no dampers.")
        return
    lines = list(_describe_dampers(own, system))
    results = [("firing", cases.firing)]
    if cases.misfire is not None:
        results.append(("worst misfire", cases.misfire))
    for name, result in results:
        for damper in result.response.dampers or ():
            heat = size_text(damper.worst.heat_W, system.heat)
            lines.append(f"{damper.node}, {name}: {heat} at {number(damper.worst.speed_rpm)} rpm.")
        for pendulum in result.response.pendulums or ():
            swing = f"±{number(pendulum.worst.half_swing_deg)} deg"
            speed = number(pendulum.worst.speed_rpm)
            lines.append(f"{pendulum.node}, {name}: swings by {swing} at {speed} rpm.")
    yield Text("", tuple(lines))


def _describe_dampers(own: TorsionalSystem, system: System) -> Iterator[str]:
    """Yield the figures of each damper."""
    inertia = system.inertia
    for ring in own.rings:
        size = f"{number(inertia.of(ring.inertia), 6)} {inertia.name}"
        unit = system.torsional_damping
        oil = f"{number(unit.of(ring.damping), 6)} {unit.name}"
        yield f"{own.nodes[ring.node]}: viscous damper, ring {size}, damping {oil}."
    for name in own.nodes[own.last + 1 :]:
        yield f"{name}: ring on rubber, listed among the inertias and shafts."
    for group in own.pendulums:
        length = system.length
        radius = number(length.of(group.radius))
        arm = number(length.of(group.length))
        yield (
            f"{own.nodes[group.node]}: pendulums, {number(group.mass)} kg together, pivots at "
            f"{radius} {length.name}, arm {arm} {length.name}."
        )


_SYNTHESIS = (
    "half of peak to peak, all orders added with their phases, as a society's synthesis of all "
    "harmonic orders; also between the given speeds. The sum of amplitudes stands beside it."
)
_STRESS = "nominal shear stress at the surface of the shaft, without stress concentration"
_UNDAMPED = (
    "of the undamped system; viscous rings and pendulums count in the response, but not in modes, "
    "critical speeds and Holzer's tables"
)
_LOSS = "relative damping over 2 pi, or one over the magnifier"
_VERDICTS = (
    "share: largest value over the limit at the same speed; barred: the limit is exceeded in the "
    "listed ranges, which must be passed quickly; fails: a rule allows no such range"
)
_LEFT_OUT = (
    "start-up, ice, synchronizing, bending, fatigue of the crankshaft, and torques that the file "
    "does not give"
)
_M68 = (
    "formulas of IACS UR M68, revisions 2 and 3, for shafts of ship propulsion; the rules of the "
    "classification society decide"
)


def _tell_conventions(result: TorsionAnalysis) -> Facts:
    """Return what the figures mean, and what they leave out."""
    pairs = [
        ("vibratory torque, stress", _SYNTHESIS),
        ("stress", _STRESS),
        ("modes", _UNDAMPED),
        ("loss", _LOSS),
        ("verdicts", _VERDICTS),
        ("left out", _LEFT_OUT),
    ]
    if any(isinstance(limit.limit, M68) for limit in result.system.limits):
        pairs.append(("M68", _M68))
    return Facts(tuple(pairs))

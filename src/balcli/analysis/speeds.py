"""Analyze one engine at several speeds, and make the sheet that builders of marine engines use.

At several speeds, the printed sheet has a table for each kind of force or moment, with a row for
each speed. JSON and CSV have the analyses of all speeds.

The marine sheet has external forces and moments by order, vertical and horizontal, guide-force
moments and torque. Vertical is along x, horizontal along y. The moment of vertical forces, which is
about the y axis, is also called vertical: M1V is My of order 1, and M1H is Mx of order 1.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import astuple, dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np

from ..core.phasors import Array
from ..core.records import HIDDEN, WrittenAs
from ..engine.engine import Engine
from ..file.assumed import Assumed
from ..file.fields import order_number
from ..forces.kinds import FORCE, MOMENT, ROLL, ROLL_TOTAL, TORQUE, TORQUE_TOTAL, Kind
from ..show.engine_facts import engine_facts, tell_place
from ..show.figures import clean, name_engine
from ..show.formats import Renderer, Rows, name_cell, write_named
from ..show.sheet import (
    NAMELESS,
    Column,
    Facts,
    Grid,
    NamedResult,
    Sheet,
    Text,
    assumed_facts,
    capitalized,
    given,
    order_name,
    size_text,
)
from . import sections, show as analysis_show
from .answer import Analysis, analyze
from .comparison import (
    Line,
    analyze_alike,
    find_lines_that_matter,
    fit_unit,
    list_lines,
    make_line,
    show_sizes,
)
from .ladder_show import ladder_grid
from .records import Includes, PowerRelatedUnbalance, name_included
from .sections import define_guide_moments

if TYPE_CHECKING:
    from ..show.units import System


@dataclass(frozen=True, kw_only=True, eq=False)
class SpeedSeries:
    """Analyses of one engine at several speeds, for the same orders.

    Attributes:
        engine: Engine.
        analyses: Analysis at each speed, in the given order of speeds.
        every_order: Whether the caller chose the orders; if so, all of them are shown.
    """

    format: Literal["balcli.speeds/1"] = "balcli.speeds/1"
    engine: Annotated[Engine, WrittenAs(name_engine)]
    analyses: tuple[Analysis, ...]
    every_order: Annotated[bool, HIDDEN] = False

    @property
    def speeds_rpm(self) -> list[float]:
        """Speed of each analysis, rpm."""
        return [float(one.engine.speed_rpm) for one in self.analyses]

    @property
    def lines(self) -> tuple[Line, ...]:
        """Every figure, with a value for each speed."""
        return list_lines(self.analyses, every_order=self.every_order)


@dataclass(frozen=True)
class MarineOrder:
    """Amplitudes of one order; null if not known.

    Attributes:
        order: Order.
        force_v_N: External force along x.
        force_h_N: External force along y.
        moment_v_Nm: External moment about y, from the forces along x.
        moment_h_Nm: External moment about x, from the forces along y.
        guide_h_Nm: H-type guide-force moment.
        guide_x_Nm: X-type guide-force moment.
        torque_Nm: Torque of inertia and, with [gas], of gas on the crank.
    """

    order: float
    force_v_N: float
    force_h_N: float
    moment_v_Nm: float
    moment_h_Nm: float
    guide_h_Nm: float
    guide_x_Nm: float
    torque_Nm: float


# Names as engineers write them, with `n` for the order.
_EXTERNAL = (
    Kind("force_v", "external vertical force FnV", "FnV", "force_v_N", dimension="force"),
    Kind("force_h", "external horizontal force FnH", "FnH", "force_h_N", dimension="force"),
    Kind("moment_v", "external vertical moment MnV", "MnV", "moment_v_Nm"),
    Kind("moment_h", "external horizontal moment MnH", "MnH", "moment_h_Nm"),
)
_INTERNAL = (
    Kind("guide_h", "H-type guide-force moment Hn", "Hn", "guide_h_Nm"),
    Kind("guide_x", "X-type guide-force moment Xn", "Xn", "guide_x_Nm"),
    Kind("torque", "torque on the crank Tn", "Tn", "torque_Nm"),
)
FIGURES = (*_EXTERNAL, *_INTERNAL)  # in the order of the fields of `MarineOrder`


@dataclass(frozen=True)
class MarineSpeed:
    """All orders at one speed.

    Attributes:
        speed_rpm: Crank speed.
        orders: Amplitudes by order.
    """

    speed_rpm: float
    orders: tuple[MarineOrder, ...]


@dataclass(frozen=True)
class CountedEngine:
    """An engine and its number of cylinders.

    Attributes:
        name: Name of the engine.
        cylinders: Number of cylinders.
    """

    name: str
    cylinders: int


def count_cylinders(engine: Engine) -> CountedEngine:
    """Return name and number of cylinders."""
    return CountedEngine(engine.name, len(engine.numbers))


@dataclass(frozen=True, kw_only=True, eq=False)
class MarineSheet:
    """External forces and moments, guide-force moments and torque, as builders of marine engines
    list them.

    Attributes:
        engine: Name and number of cylinders of the engine.
        includes: Whether guide-force moments and torque include the gas.
        axes: Axes that are called vertical and horizontal.
        height_m: Distance from the crankshaft to the middle of each guide, sorted by cylinder
            number.
        assumed: Values that are used because the engine file leaves them out.
        speeds: Amplitudes by speed and order.
        lines: Amplitudes by order and figure, with a value for each speed.
        related: Power related unbalance at the rated speed; None without a power.
        every_order: Whether tables show negligible orders as well.
    """

    format: Literal["balcli.marine/1"] = "balcli.marine/1"
    engine: Annotated[Engine, WrittenAs(count_cylinders)]
    includes: Includes
    axes: Mapping[str, str] = field(default_factory={"v": "x", "h": "y"}.copy)
    height_m: Array
    assumed: tuple[Assumed, ...] | None = None
    speeds: tuple[MarineSpeed, ...]
    lines: Annotated[tuple[Line, ...], HIDDEN]
    related: Annotated[PowerRelatedUnbalance | None, HIDDEN] = None
    every_order: Annotated[bool, HIDDEN] = False

    @property
    def speeds_rpm(self) -> list[float]:
        """Speeds of the sheet, rpm."""
        return [speed.speed_rpm for speed in self.speeds]


def find_marine_sheet(
    engine: Engine,
    speeds_rpm: Sequence[float] = (),
    orders: Iterable[float] | None = None,
    guide_height_m: float | None = None,
    every_order: bool = False,
) -> MarineSheet:
    """Compute external forces and moments, guide-force moments and torque of an engine by order.

    Args:
        engine: One engine, not an array of variants.
        speeds_rpm: Speeds; default: the speed of the engine.
        orders: Orders; default: all orders that `analyze` shows at one or more of the speeds.
        guide_height_m: Distance from the crankshaft to the middle of the guides; default: each
            rod's length.
        every_order: Whether tables show negligible orders; if `orders` is given, they always do.

    Raises:
        BalcliError: An order is invalid or too high.
    """
    torque = TORQUE if engine.gas is None else TORQUE_TOTAL
    words = ["force", "moment", "guide", torque.name]
    drives = engine.gas is not None and not engine.is_pump
    if drives or (engine.rated and engine.rated.power_W):
        words.append("pru")
    ask = partial(analyze, only=words, guide_height=guide_height_m)
    speeds = [float(speed) for speed in speeds_rpm] or [float(engine.speed_rpm)]
    analyses = analyze_alike([engine.at_speed(speed) for speed in speeds], orders, ask)
    listed = [_list_amplitudes(analysis, torque.name) for analysis in analyses]
    first = analyses[0]
    return MarineSheet(
        engine=engine.at_speed(speeds[0]),
        includes=name_included(engine.gas is not None),
        height_m=first.guide.height_m,
        assumed=first.assumed,
        speeds=tuple(map(MarineSpeed, speeds, listed)),
        lines=_list_lines(analyses, listed),
        related=first.power_related_unbalance if "pru" in words else None,
        every_order=every_order or orders is not None,
    )


def _list_lines(
    analyses: Sequence[Analysis], listed: Sequence[Sequence[MarineOrder]]
) -> tuple[Line, ...]:
    """Return amplitudes by order and figure. Forces and moments are compared with those of one
    cylinder, other figures with their largest amplitude at any order.

    Args:
        analyses: Analysis at each speed.
        listed: Amplitudes at each speed by order.
    """
    at_speeds = []
    for orders in listed:
        at_speeds.append([astuple(order)[1:] for order in orders])
    figures = np.array(at_speeds)
    single = np.nan_to_num(figures).max(axis=1)  # shape (speeds, figures)
    single[:, 4:6] = single[:, 4:6].max(axis=1, keepdims=True)
    for k, analysis in enumerate(analyses):
        of_one = analysis.of_one_cylinder
        single[k, :4] = np.repeat([of_one["force"], of_one["moment"]], 2)
    lines = []
    for k, order in enumerate(listed[0]):
        for i, kind in enumerate(FIGURES):
            values = tuple(figures[:, k, i].tolist())
            lines.append(make_line(kind, order.order, values, tuple(single[:, i].tolist())))
    return tuple(lines)


def _list_amplitudes(analysis: Analysis, torque: str) -> tuple[MarineOrder, ...]:
    """Return amplitudes at one speed by order."""
    spectra = analysis.spectra.with_moment_if(analysis.moments_known)
    force = spectra["force"]
    moment = spectra["moment"]
    guides = (analysis.guide.h, analysis.guide.x) if hasattr(analysis, "guide") else (None, None)
    columns = [np.abs(component) for component in (force.x, force.y, moment.y, moment.x)]
    for guide in guides:
        unknown = np.full(analysis.orders.shape, np.nan)
        columns.append(unknown if guide is None else guide.major)
    columns.append(np.abs(spectra[torque].x))
    listed = [column.tolist() for column in columns]
    return tuple(map(MarineOrder, map(order_number, analysis.orders), *listed))


def sheet(named: NamedResult[SpeedSeries], system: System) -> Sheet:
    """Return the sheet of an engine at several speeds.

    Args:
        named: Analyses with the engine's name.
        system: System of units.
    """
    engine = named.result.analyses[0].engine
    return Sheet(engine.name or NAMELESS, tuple(_parts(named, system)))


def rows(named: NamedResult[SpeedSeries], system: System) -> Rows:
    """Return the rows of CSV: those of each analysis, after the engine's name and the speed.

    Args:
        named: Analyses with the engine's name.
        system: System of units.
    """
    name = name_cell(named.name)
    header: Sequence[str] = ()
    lines: list[Sequence[object]] = []
    series = named.result
    for speed, analysis in zip(series.speeds_rpm, series.analyses, strict=True):
        at_speed = analysis_show.rows(analysis, system, named=named.view.parts)
        header = at_speed.header
        for line in at_speed.lines:
            lines.append((name, speed, *line))
    return Rows(("engine", "speed_rpm", *header), lines)


def _parts(named: NamedResult[SpeedSeries], system: System) -> Iterator[Facts | Grid | Text]:
    series = named.result
    view = named.view
    speeds = series.speeds_rpm
    first = series.analyses[0]
    heads_with_facts = not view.parts or view.whole
    if heads_with_facts:
        yield engine_facts(first.engine, system, whole=view.whole, speeds_rpm=speeds)
    else:
        yield from assumed_facts(first.assumed)
    kinds = dict.fromkeys(line.kind for line in series.lines)
    if not (view.parts or view.whole):  # the brief form
        roll = ROLL if first.engine.gas is None else ROLL_TOTAL
        kinds = dict.fromkeys(kind for kind in kinds if kind in (FORCE, MOMENT, roll))
    for kind in kinds:
        own = [line for line in series.lines if line.kind == kind]
        yield _kind_part(kind, own, speeds, system, whole=view.whole or view.every_order)
    for analysis in series.analyses:
        if hasattr(analysis, "ladder"):
            yield ladder_grid(analysis.ladder, analysis.engine, system, tell_skirt=heads_with_facts)
    if hasattr(first, "why"):
        yield sections.lay_out_symmetry(first.why)


def _kind_part(
    kind: Kind, lines: list[Line], speeds_rpm: list[float], system: System, *, whole: bool
) -> Grid | Text:
    """Return a table of a kind by speed, with a column for each order and the peak; a sentence if
    all orders are negligible.
    """
    shown = lines if whole else find_lines_that_matter(lines)
    if not shown:
        largest = max(line.largest for line in lines)
        if not largest:
            return Text("", (f"Balanced: {kind.label}.",))
        most = size_text(largest, system.unit(kind), 2)
        return Text("", (f"Negligible: {kind.label} (at most {most}).",))
    unit = fit_unit(kind, shown, system)
    columns = [Column("rpm", [given(speed) for speed in speeds_rpm])]
    columns += [Column(line.label, show_sizes(line, unit, every=whole)) for line in shown]
    title = f"{capitalized(kind.label)}, {unit.name}: largest by order"
    return Grid(title, columns)


RENDERER = Renderer(sheet=sheet, document=write_named, rows=rows)


_AXES = "V: vertical, along x, from which bank angles count. H: horizontal, along y."
_NAMES = (
    "In FnV, FnH, MnV and MnH, n is the order: column MnV lists M1V, M2V and so on. Values are "
    "amplitudes. The moment of vertical forces is called vertical."
)


def lay_out_marine(named: NamedResult[MarineSheet], system: System) -> Sheet:
    """Return the printed marine sheet: the engine, forces and moments on its frame and on its
    crank, and the meaning of the names.

    Args:
        named: Marine sheet with the engine's name.
        system: System of units.
    """
    result = named.result
    head = engine_facts(result.engine, system, whole=False, speeds_rpm=result.speeds_rpm)
    alone = "of inertia only, without gas"
    of_what = alone if result.engine.gas is None else "of inertia and gas"
    parts: list[Facts | Grid | Text] = [head]
    if len(result.speeds) == 1:
        title = f"Guide-force moments Hn, Xn and torque on the crank Tn, {of_what}"
        external = _grid_by_order("External forces and moments", _EXTERNAL, result, system)
        if result.engine.is_pump:
            external = _name_unbalanced(external)
        parts.append(external._replace(note=_NAMES))
        parts.append(_grid_by_order(title, _INTERNAL, result, system))
    else:
        for kind in FIGURES:
            lines = [line for line in result.lines if line.kind == kind]
            speeds = result.speeds_rpm
            whole = result.every_order
            parts.append(_kind_part(kind, lines, speeds, system, whole=whole))
        parts.append(Text("", (f"Guide-force moments and torque are {of_what}.",)))
    if result.related is not None and not result.engine.is_pump:
        from .crank_drive import lay_out_related  # loads the curves of the gas

        parts.append(lay_out_related(result.related, system))
    notes = [_AXES]
    if result.engine.is_pump:  # a packager's foundation needs the point, and no other line has it
        notes.append(f"Moments are about {tell_place(result.engine.reference_m, system)}.")
    notes.append(define_guide_moments(result.height_m, system))
    return Sheet(result.engine.name or NAMELESS, (*parts, Text("", tuple(notes))))


def _name_unbalanced(external: Grid) -> Grid:
    """Return the table of external forces with the words of packagers of compressors."""
    first, *others = external.columns
    words = {"1": "1 (primary)", "2": "2 (secondary)"}
    cells = [words.get(cell, cell) for cell in first.cells]
    columns = [first._replace(cells=cells), *others]
    return external._replace(title="Unbalanced forces and couples", columns=columns)


def list_marine(named: NamedResult[MarineSheet], system: System) -> Rows:
    """Return the rows of CSV: a line for each speed and order, a column for each figure.

    Args:
        named: Marine sheet with the engine's name.
        system: System of units.
    """
    units = [system.unit(kind) for kind in FIGURES]
    heads = []
    for kind, unit in zip(FIGURES, units, strict=True):
        heads.append(f"{kind.name}_{unit.name.replace('·', '')}")
    lines = []
    for speed in named.result.speeds:
        for order, *figures in map(astuple, speed.orders):
            values = [clean(unit.of(size)) for unit, size in zip(units, figures, strict=True)]
            lines.append((name_cell(named.name), speed.speed_rpm, order, *values))
    return Rows(("engine", "speed_rpm", "order", *heads), lines)


def _grid_by_order(title: str, kinds: Sequence[Kind], result: MarineSheet, system: System) -> Grid:
    """Return a table for one speed, with a row for each whole order up to 2 and each other order
    that matters.
    """
    every = result.every_order
    lines = {(line.kind, line.order): line for line in result.lines}
    orders = []
    for order in dict.fromkeys(line.order for line in result.lines):
        row = [lines[kind, order] for kind in kinds]
        if every:
            matters = any(line.largest for line in row)
        else:
            matters = not all(all(line.negligible) for line in row)
        if matters or order in (0, 1, 2):
            orders.append(order)
    columns = [Column("order", [order_name(order or 0) for order in orders], words=True)]
    for kind in kinds:
        alike = [line for line in result.lines if _share_unit(line.kind, kind, kinds)]
        unit = fit_unit(kind, alike, system)
        cells = []
        for order in orders:
            cells += show_sizes(lines[kind, order], unit, every=every, digits=4)  # of the one speed
        columns.append(Column(f"{kind.symbol}, {unit.name}", cells))
    return Grid(title, columns)


def _share_unit(kind: Kind, other: Kind, kinds: Sequence[Kind]) -> bool:
    """Return whether a kind is in this table, in the unit of another kind."""
    return kind in kinds and kind.dimension == other.dimension


MARINE = Renderer(sheet=lay_out_marine, document=write_named, rows=list_marine)

"""Compute the parts of an engine from the tables of its file, in stages: plan, running gears, pins,
firing angles, masses, places, cylinders.

Each stage is a function of earlier stages. `Parts` runs a stage once, when it is first needed. So a
mistake in one table does not prevent the stages that do not need this table, and the trial of a
numbering computes only the stages up to the pins.

Dicts of cylinders have the cylinder numbers as keys. Angles count from x in the direction of
rotation.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import cached_property
from itertools import chain
from typing import TYPE_CHECKING, NamedTuple, cast

import numpy as np

from ..core.cylinders import Cylinders, find_travel
from ..core.mechanisms.linkage import Articulated, Rotary
from ..core.phasors import Array, Figure, unit
from ..core.speed_ripple import RippleLine
from ..errors import InputError, Problem
from ..file.fields import counted
from ..file.model import PISTON_PARTS, Articulation, EngineFile
from .figures import (
    FileFigures,
    RodFigures,
    column,
    or_zero,
    rod_figures,
    shared_column,
    value_or,
)
from .layout import (
    OPPOSED,
    Cell,
    Plan,
    bank_angles,
    cycle_deg,
    find_instants,
    find_intervals,
    find_pins,
    find_row_angle,
    plan_cylinders,
)
from .rods import CylinderMasses, RodPlace, RunningGear, weigh_rod

if TYPE_CHECKING:
    from ..core.mechanisms.linkage import Linkage
    from .gas import EngineGas
    from .webs.build import Webs


# ------------------------------------------------------------------ pistons and rods
def find_masters(parts: Parts) -> dict[int, int]:
    """Return the cylinder number of the master rod, by number of each articulated cylinder."""
    table = parts.model.articulation
    cells = parts.plan.cells
    if table is None:
        return {}
    places = parts.find_master_places()
    masters = {}
    hung = []
    for cell in cells:
        if cell.bank == places[cell.throw] - 1:
            masters[cell.throw] = cell.number
        else:
            hung.append(cell)
    return {cell.number: masters[cell.throw] for cell in hung if cell.throw in masters}


def find_gears(parts: Parts) -> dict[int, RunningGear]:
    """Return piston and rod of each cylinder, by its number."""
    gears = {}
    for number in parts.plan.numbers:
        rod = parts.find_rod(number, articulated=number in parts.masters)
        gears[number] = parts.weigh_gear(rod)
    return gears


def find_strokes(parts: Parts) -> dict[int, Figure]:
    """Return twice the crank radius of each cylinder's pin, mm, by cylinder number. A cylinder with
    an articulated rod has the value of its master. Key 0, the number for the general figures of
    rods, has the stroke of the first throw.
    """
    strokes = {0: parts.throw_strokes[0]}
    for cell in parts.plan.cells:
        on_pin = parts.masters.get(cell.number, cell.number)
        own = parts.override(on_pin, "stroke")
        strokes[cell.number] = value_or(own, parts.throw_strokes[cell.throw])
    return strokes


# ------------------------------------------------------------------ crank pins and firing
class Pins(NamedTuple):
    """Angles of cylinder axes and crank pins, deg.

    Attributes:
        axes_deg: Axis of each cylinder.
        tops_deg: Angle of each cylinder's crank pin at top dead centre. With articulated rods, the
            angle of the axis (nominal dead centre) is used, because all cylinders of a throw then
            fire evenly.
        throws_deg: Angle of each throw, by its index from 0: the one in the file, or the one that
            the firing order needs.
        leads_deg: Angle of each crank pin from cylinder 1's pin.
    """

    axes_deg: dict[int, Figure]
    tops_deg: dict[int, Figure]
    throws_deg: Mapping[int, Figure]
    leads_deg: dict[int, Figure]


def set_pins(parts: Parts) -> Pins:
    """Return axes, dead centres, throws and crank pins."""
    model = parts.model
    figures = parts.figures
    cells = parts.plan.cells
    banks = bank_angles(model.layout, figures)
    turn = find_row_angle(model.layout, parts.plan.throws, figures)
    axes = {}
    for cell in cells:
        own = parts.override(cell.number, "bank")
        axes[cell.number] = value_or(own, banks[cell.bank] + cell.throw * turn)
    tops = axes
    if model.articulation is None:
        tops = {}
        for number, axis in axes.items():
            top = parts.gears[number].top_deg(parts.find_radius(number))
            tops[number] = axis + parts.sense * top
    splay = figures.take("crank.splay", model.crank.splay)
    throws = _set_throws(parts, tops, splay)
    pins = {}
    for cell in cells:
        own = parts.override(cell.number, "throw")
        pins[cell.number] = value_or(own, throws[cell.throw] + cell.bank * splay)
    leads = {number: pin - pins[1] for number, pin in pins.items()}
    return Pins(axes, tops, throws, leads)


def _set_throws(parts: Parts, tops: Mapping[int, Figure], splay: Figure) -> dict[int, Figure]:
    """Return the angle of each throw, deg: the one in the file, or the one that the firing order
    needs.
    """
    layout = parts.model.layout
    if parts.throws_given or parts.order is None:
        given = parts.model.crank.throws or OPPOSED[: parts.plan.throws]
        return dict(enumerate(parts.figures.take_each("crank.throws", given)))
    fires = find_instants(parts.order, layout.firing_intervals, cycle_deg(layout))
    wanted = find_pins(fires, tops, parts.sense)
    throws: dict[int, Figure] = {}
    for cell in reversed(parts.plan.cells):  # the first cylinder of a throw decides
        if cell.number in wanted:
            throws[cell.throw] = wanted[cell.number] - cell.bank * splay
    return throws


def find_true_tops(parts: Parts) -> Mapping[int, Figure]:
    """Return the angle of each crank pin at top dead centre, deg: `Pins.tops_deg`, or with
    articulated rods (except in arrays of variants) the true dead centres of the pistons.
    """
    pins = parts.pins
    if parts.model.articulation is None or parts.rank:
        return pins.tops_deg
    found = find_travel(parts.cylinders).top_deg
    tops = {}
    for number, top in zip(parts.numbers, found, strict=True):
        tops[number] = pins.axes_deg[number] + parts.sense * float(top)
    return tops


def find_fires(parts: Parts) -> dict[int, Figure]:
    """Return the firing angle of each cylinder, deg, counted from the first cylinder of the firing
    order; empty without a firing order.

    Raises:
        InputError: The order takes more than a cycle.
    """
    layout = parts.model.layout
    if parts.order is None:
        return {}
    intervals = layout.firing_intervals
    cycle = cycle_deg(layout)
    if intervals is None and parts.throws_given:
        leads = parts.pins.leads_deg
        ready = {}
        for number, top in parts.true_tops_deg.items():
            ready[number] = parts.sense * float(top - leads[number])
        intervals = tuple(find_intervals(parts.order, ready, cycle))
    return find_instants(parts.order, intervals, cycle)


def find_throw_masses(parts: Parts) -> tuple[Figure, ...]:
    """Return the unbalanced mass of each throw, kg; in a file with [[web]], that of its crank pin,
    because each web has its own plane.
    """
    if parts.webs is not None:
        return tuple(pin.mass for pin in parts.webs.pins)
    given = parts.model.crank.throw_mass
    return parts.figures.take_for_each("crank.throw_mass", given, parts.plan.throws)


def find_webs(parts: Parts) -> Webs | None:
    """Return the webs of the crank; None for a file without [[web]]."""
    if not parts.model.web:
        return None
    from .webs.build import BareThrow, build_webs  # loaded only for files with [[web]]

    throws = []
    for throw, stroke in enumerate(parts.throw_strokes):
        number = next(cell.number for cell in parts.plan.cells if cell.throw == throw)
        pin_deg = parts.pins.axes_deg[1] + parts.pins.leads_deg[number]
        throws.append(BareThrow(float(stroke) / 2, parts.places.pins[throw], pin_deg))
    return build_webs(parts.model, throws, parts.figures)


def weigh_cylinders(parts: Parts) -> dict[int, CylinderMasses]:
    """Return the masses of each cylinder as a workshop weighs them, by cylinder number."""
    take = parts.figures.take
    bobweight = parts.model.bobweight
    plan = parts.plan
    of_throws = find_throw_masses(parts)
    rod_bearing = take("bobweight.rod_bearing", bobweight.rod_bearing)
    oil = parts.figures.take_optional("bobweight.oil", bobweight.oil)
    oil_per_pin = parts.figures.take_optional("bobweight.oil_per_pin", bobweight.oil_per_pin)
    piston = tuple(parts.find_piston_masses().items())
    weighed = {}
    crosshead = take("crosshead.mass", parts.model.crosshead.mass)
    for cell in parts.plan.cells:
        number = cell.number
        hung = cell.number in parts.masters
        gear = parts.gears[number]
        own = parts.override(number, "piston_mass")
        shared: Figure = 0.0
        if oil_per_pin is not None and not hung:
            shared = oil_per_pin / _count_rods_on_pin(parts, cell)
        masses = CylinderMasses(
            cell.throw,
            piston=gear.piston,
            piston_parts=piston if own is None else (("mass", own),),
            small_end=gear.small_end,
            big_end=gear.big_end,
            share=of_throws[cell.throw] / plan.rods_on_throw,
            rod_bearing=rod_bearing,
            oil=or_zero(oil) + shared,
            crosshead=value_or(parts.override(number, "crosshead_mass"), crosshead),
        )
        # The pin of an articulated rod is a knuckle pin, without bearing shells and oil.
        weighed[number] = masses._replace(rod_bearing=0.0, oil=0.0) if hung else masses
    return weighed


def _count_rods_on_pin(parts: Parts, cell: Cell) -> Figure:
    """Return the number of rods on the crank pin of a cylinder. Articulated rods do not count;
    split pins of a throw are two pins.
    """
    leads = parts.pins.leads_deg
    count: Figure = 0.0
    for other in parts.plan.cells:
        if other.throw != cell.throw or other.number in parts.masters:
            continue
        apart = leads[other.number] - leads[cell.number]
        on_pin = np.abs((apart + 180) % 360 - 180) < 1e-9
        count = count + np.asarray(on_pin, float)
    return count


# ------------------------------------------------------------------ places along the crank
class Places(NamedTuple):
    """Places along the crank, m.

    Attributes:
        z: Position of each cylinder, by its number.
        throws: Position of each throw, in the middle of its rods, shape (throws, *trailing).
        pins: Position of each throw as [crank] gives it, or the middle of its rods if [crank] gives
            none but 0, shape (throws, *trailing).
        reference: x, y, z of the point about which moments are taken: the point of the file, or the
            point on the crank axis half-way between the outermost throws.
    """

    z: dict[int, Figure]
    throws: Array
    pins: Array
    reference: tuple[Figure, Figure, Figure]


def find_places(parts: Parts) -> Places:
    """Return the places of cylinders and throws."""
    model = parts.model
    figures = parts.figures
    plan = parts.plan
    if model.crank.positions is None or "crank.positions" in figures.displaced:
        spacing = figures.take("crank.spacing", model.crank.spacing or 0.0)
        along = tuple((throw - (plan.throws - 1) / 2) * spacing for throw in range(plan.throws))
    else:
        along = figures.take_each("crank.positions", model.crank.positions)
    stagger = figures.take("layout.stagger", model.layout.stagger)
    z: dict[int, Figure] = {}
    middles: dict[int, Figure] = dict.fromkeys(range(plan.throws), 0.0)
    for c in plan.cells:
        shared = plan.rods_on_throw > 1
        offset = (c.bank - (plan.rods_on_throw - 1) / 2) * stagger if shared else 0.0
        own = parts.override(c.number, "position")
        z[c.number] = value_or(own, along[c.throw] + offset) / 1e3
        middles[c.throw] = middles[c.throw] + (z[c.number] - offset / 1e3)  # shapes may differ
    throws = column([middle / plan.rods_on_throw for middle in middles.values()], parts.rank)
    given = any(np.any(place) for place in along)
    pins = column([place / 1e3 for place in along], parts.rank) if given else throws
    if model.frame.reference is None:
        middle = 0.0, 0.0, (throws.min(axis=0) + throws.max(axis=0)) / 2
        return Places(z, throws, pins, middle)
    x, y, height = figures.take_each("frame.reference", model.frame.reference)
    return Places(z, throws, pins, (x / 1e3, y / 1e3, height / 1e3))


# ------------------------------------------------------------------ arrays
def group_banks(parts: Parts) -> dict[int, list[int]]:
    """Return the cylinder numbers in groups, in the order of the plan; the key of a group is its
    first number. The cylinders of a group have the same axis in every variant or, in rotary
    engines, where axes and pins are exchanged (`_turn`), the same pin angle.
    """
    banks: dict[bytes, list[int]] = {}
    for number, axis in _turn(parts)[0].items():
        value = np.asarray(axis, float) + 0.0  # +0.0 for -0.0
        banks.setdefault(value.tobytes(), []).append(number)
    return {bank[0]: bank for bank in banks.values()}


def _turn(parts: Parts) -> tuple[Mapping[int, Figure], Mapping[int, Figure]]:
    """Return the angles of axes, and of crank pins from cylinder 1's. In rotary engines, where
    cylinders turn about pins at rest, the two are exchanged (`core.mechanisms.linkage.Rotary`).
    """
    axes = parts.pins.axes_deg
    leads = parts.pins.leads_deg
    if not parts.model.layout.rotary:
        return axes, leads
    pins = {number: axes[1] + lead for number, lead in leads.items()}
    angles = {number: axis - axes[1] for number, axis in axes.items()}
    return pins, angles


def arrange_cylinders(parts: Parts) -> Cylinders:
    """Return the arrays of all cylinders, one row each, sorted by bank (`Parts.numbers`)."""
    axes, pins = _turn(parts)
    numbers = parts.numbers
    rank = parts.rank
    gears = parts.gears
    weighed = parts.weighed
    masters = parts.masters
    radius = parts.find_radius
    same_gear = all(gears[n] is gears[numbers[0]] for n in numbers)
    same_throws = not (isinstance(parts.model.crank.throw_mass, tuple) or parts.model.web)
    alike = same_gear and same_throws

    different = numbers[:1] if alike else numbers

    def of_each(find: Callable[[int], Figure]) -> Array:
        """Return a figure of all cylinders, as a single row if they are equal."""
        return shared_column([find(number) for number in different], rank)

    def find_rotating(number: int) -> Figure:
        """Return the mass on the crank pin, kg; that of an articulated rod is on a knuckle pin."""
        share = weighed[number].share
        return share if number in masters else share + weighed[number].rotating

    at_pistons = of_each(lambda n: weighed[n].reciprocating)
    linkage = _link(parts, at_pistons)
    turning = linkage is not None and linkage.turning
    banks = list(parts.banks.values())
    radii = of_each(radius)
    offsets = of_each(lambda n: gears[n].offset)
    lengths = of_each(lambda n: gears[n].length)
    couples = of_each(lambda n: gears[n].couple)
    rotating = of_each(find_rotating)
    first = next(k for k, bank in enumerate(banks) if 1 in bank)
    axes_of_banks = [axes[bank[0]] for bank in banks]
    pins_of_rows = [pins[n] for n in numbers]
    places = [parts.places.z[n] for n in numbers]
    return Cylinders(
        axis_deg=column(axes_of_banks, rank),
        pin_deg=column(pins_of_rows, rank),
        starts=np.cumsum([0, *map(len, banks[:-1])]),
        first=first,
        z=column(places, rank),
        radius=radii,
        offset=offsets,
        lam=radii / lengths,
        eps=offsets / lengths,
        reciprocating=0 * at_pistons if turning else at_pistons,
        rotating=0 * rotating if turning else rotating,
        couple=couples,
        linkage=linkage,
    )


def _link(parts: Parts, at_pistons: Array) -> Linkage | None:
    """Return the mechanism of articulated rods or turning cylinders; None for plain slider-cranks.

    Args:
        parts: Stages of the engine.
        at_pistons: Masses at the piston pins, kg: one row for each cylinder, or a single row.
    """
    table = parts.model.articulation
    rotary = parts.model.layout.rotary
    if table is None:
        return Rotary(at_pistons) if rotary else None
    hung = _hang_rods(parts, table)
    if not rotary:
        return hung
    both = at_pistons + hung.mass
    return Rotary(both, hung, hung.mass / np.where(both == 0, 1.0, both))


def _hang_rods(parts: Parts, table: Articulation) -> Articulated:
    """Return the mechanism of master and articulated rods. If the cylinders turn about a crank at
    rest, all angles change sign.
    """
    numbers = parts.numbers
    masters = parts.masters
    axes = parts.pins.axes_deg
    rank = parts.rank
    radius_mm = parts.figures.take("articulation.knuckle_radius", table.knuckle_radius)
    knuckle_angles = parts.find_knuckle_angles()
    cells = {cell.number: cell for cell in parts.plan.cells}
    rows_of_masters: list[int] = []
    masses: list[Figure] = []
    ratios: list[Figure] = []
    pins: list[Figure] = []
    leads: list[Figure] = []
    for number in numbers:
        hangs = number in masters
        master = masters.get(number, number)
        lead = axes[number] - axes[master]
        pin = lead
        if hangs and knuckle_angles is not None:
            cell = cells[number]
            pin = knuckle_angles[cell.throw][cell.bank]
        rows_of_masters.append(numbers.index(master))
        masses.append(parts.gears[number].big_end if hangs else 0.0)
        ratios.append(radius_mm / (parts.strokes[number] / 2) if hangs else 0.0)
        pins.append(parts.sense * pin)
        leads.append(parts.sense * lead)
    return Articulated(
        mass=column(masses, rank),
        master=np.array(rows_of_masters),
        knuckle=column(ratios, rank) * unit(column(pins, rank)),
        lead_deg=column(leads, rank),
    )


# ------------------------------------------------------------------ the stages together
def list_joint_paths(model: EngineFile, varied: Iterable[str]) -> frozenset[str]:
    """Return the names of figures of which arrays make only the gas an array of variants, while all
    other stages have numbers.

    Args:
        model: Engine file.
        varied: Names of the figures that vary.
    """
    if model.gas is None:
        return frozenset()
    if any(path.startswith("cylinder.") and path.endswith(".heat") for path in varied):
        return frozenset()
    if any(table.has("heat") or table.has("indicator") for table in model.cylinder.values()):
        return frozenset()
    return frozenset(f"gas.{key}" for key in model.gas.joint_keys)


class Parts:
    """The parts of an engine, or of variants of it.

    Args:
        model: Engine file.
        varied: Arrays of variants that replace figures, by dotted name.
        rank: Minimum number of trailing axes, the axes of the variants. Arrays of joint figures
            (`list_joint_paths`) make no trailing axes: only the gas has them.
        known_gas: Gas of the cylinders, if it is already known; otherwise the rules of
            `engine.build` build it.
    """

    plan: cached_property[Plan] = cached_property(lambda self: plan_cylinders(self.model))
    masters = cached_property(find_masters)
    strokes = cached_property(find_strokes)
    gears = cached_property(find_gears)
    pins = cached_property(set_pins)
    fires_deg = cached_property(find_fires)
    true_tops_deg = cached_property(find_true_tops)
    weighed = cached_property(weigh_cylinders)
    places = cached_property(find_places)
    webs = cached_property(find_webs)
    banks = cached_property(group_banks)
    cylinders = cached_property(arrange_cylinders)

    def __init__(
        self,
        model: EngineFile,
        varied: Mapping[str, Figure] | None = None,
        rank: int = 0,
        known_gas: EngineGas | None = None,
    ) -> None:
        self.model = model
        self.gas = known_gas
        self.figures = FileFigures(varied or {}, model)
        self.varies = bool(varied)
        joint = list_joint_paths(model, varied or {})
        apart = [value for path, value in (varied or {}).items() if path not in joint]
        self.rank = max(rank, *map(np.ndim, apart), 0)
        # -1 if the crank turns backwards, seen from a cylinder that turns about it.
        self.sense = -1 if model.layout.rotary else 1
        given = model.crank.throws is not None
        # If figures vary and the file gives throws, the firing order might not fit every variant;
        # the order is then ignored, unless the gas needs it.
        needed = model.gas is not None and not self.rank
        self.order = None if varied and given and not needed else model.layout.firing_order
        self.tables = self.figures.cylinder_tables(model)  # tables of single cylinders, by number
        self._gears: dict[tuple[int, int, bool], RunningGear] = {}

    @property
    def numbers(self) -> tuple[int, ...]:
        """Cylinder number of each row of `cylinders`."""
        return tuple(chain.from_iterable(self.banks.values()))

    @property
    def throws_given(self) -> bool:
        """Whether the throws are known without the firing order: the file gives them, or the only
        throw is at 0.
        """
        return self.model.crank.throws is not None or (self.plan.throws == 1 and not self.rank)

    @property
    def throw_strokes(self) -> tuple[Figure, ...]:
        """Stroke of every throw, mm."""
        given = self.model.crank.stroke
        count = self.plan.throws
        return self.figures.take_for_each("crank.stroke", given, count)

    def find_radius(self, number: int) -> Figure:
        """Return the crank radius of a cylinder, m."""
        return self.strokes[number] / 2e3

    @cached_property
    def _general_rods(self) -> tuple[RodFigures, RodFigures]:
        """General figures of rods on crank pins, and of articulated rods."""
        rod = rod_figures(self.figures, self.model.rod)
        table = self.model.articulation
        if table is None:
            return rod, RodFigures()
        return rod, rod_figures(self.figures, table.rod, "articulation.rod")

    def override(self, number: int, key: str) -> Figure | None:
        """Return a figure of [cylinder.N] in the unit of the file; None if the file gives none.

        Args:
            number: Number N of the cylinder.
            key: Key of its table.
        """
        table = self.tables.get(number)
        if table is None:
            return None
        return self.figures.take_optional(f"cylinder.{number}.{key}", getattr(table, key))

    def find_rod(self, number: int, articulated: bool = False) -> RodPlace:
        """Return the figures of a cylinder's rod.

        Args:
            number: Number of the cylinder; 0 for the general figures.
            articulated: Whether the rod is articulated.
        """
        general = self._general_rods[articulated]
        own = RodFigures()
        if (table := self.tables.get(number)) is not None:
            own = rod_figures(self.figures, table, f"cylinder.{number}", "rod_")
        return RodPlace(number, articulated, general.with_own(own), own, general)

    def find_piston_masses(self) -> dict[str, Figure]:
        """Return the masses of the parts of a piston, kg, by their keys; only `mass` for pistons
        weighed whole.
        """
        table = self.model.piston
        take = self.figures.take_optional
        masses = {}
        for key in ("mass", *PISTON_PARTS):
            mass = take(f"piston.{key}", getattr(table, key))
            if mass is not None:
                masses[key] = mass
        return masses

    def kind_of_rod(self, place: RodPlace) -> tuple[int, int, bool]:
        """Return a key that is the same for rods with the same figures: cylinder number (0 if the
        cylinder has no figures of its own), throw (0 if no stroke differs, in [crank] or in a
        table of a cylinder), and whether the rod is articulated.
        """
        number = place.number if place.number in self.tables else 0
        throw = 0
        if self._strokes_differ and place.number:
            throw = next(c.throw for c in self.plan.cells if c.number == place.number)
        return number, throw, place.articulated

    @cached_property
    def _strokes_differ(self) -> bool:
        """Whether the file gives strokes of single throws or cylinders."""
        if isinstance(self.model.crank.stroke, tuple):
            return True
        return any(self.override(number, "stroke") is not None for number in self.tables)

    def weigh_gear(self, place: RodPlace) -> RunningGear:
        """Return piston and rod of one cylinder; cylinders without figures of their own share one
        object.
        """
        number = place.number
        key = self.kind_of_rod(place)
        if key not in self._gears:
            offset = self.figures.take("piston.offset", self.model.piston.offset)
            mass = sum(self.find_piston_masses().values())
            gear = weigh_rod(
                place.rod,
                place.rod.length_for(self.find_radius(number)),
                value_or(self.override(number, "piston_offset"), offset) / 1e3,
                value_or(self.override(number, "piston_mass"), mass),
            )
            if self.model.rod.motion == "harmonic":  # infinitely long: it does not swing
                gear = gear._replace(length=np.inf, spin=0.0, couple=0.0)
            self._gears[key] = gear
        return self._gears[key]

    def find_ripple(self) -> tuple[RippleLine, ...]:
        """Return the orders of the uneven speed; empty for a steady speed."""
        take = self.figures.take
        lines = []
        for k, line in enumerate(self.model.operation.speed_ripple, 1):
            path = f"operation.speed_ripple.{k}"
            amplitude = take(f"{path}.amplitude", line.amplitude)
            lines.append(RippleLine(line.order, amplitude, take(f"{path}.angle", line.angle)))
        return tuple(lines)

    def find_master_places(self) -> tuple[int, ...]:
        """Return the bank of each throw's master rod, from 1; empty without articulated rods."""
        table = self.model.articulation
        if table is None:
            return ()
        masters = table.masters
        throws = self.plan.throws
        if len(masters) not in (1, throws):
            message = f"{counted(len(masters), 'master')} for {counted(throws, 'row')}; give one "
            message += f"from 1 to {self.plan.banks}, or one per row"
            raise InputError([Problem("articulation.master", message)])
        return masters if len(masters) > 1 else masters * throws

    def find_knuckle_angles(self) -> list[tuple[Figure, ...]] | None:
        """Return the angles of each throw's knuckle pins by bank, deg; None where the file gives
        none.
        """
        table = self.model.articulation
        path = "articulation.knuckle_angles"
        if table is None or table.knuckle_angles is None:
            return None
        banks = self.plan.banks
        throws = self.plan.throws
        every = cast(tuple[float, ...], table.knuckle_angles)
        angles = [self.figures.take_each(path, every)] * throws
        if rows := [row for row in table.knuckle_angles if isinstance(row, tuple)]:
            angles = [self.figures.take_each(f"{path}.{k}", row) for k, row in enumerate(rows, 1)]
        message = ""
        if len(angles) != throws:
            given = counted(len(angles), "list")
            message = f"has {given} for {counted(throws, 'row')}: give one per row"
        elif wrong := [row for row in angles if len(row) != banks]:
            given = counted(len(wrong[0]), "angle")
            message = f"has {given} for {counted(banks, 'bank')}: give one per bank"
        if message:
            raise InputError([Problem(path, message)])
        return angles

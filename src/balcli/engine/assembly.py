"""An engine while it is put together from its file: cylinders, rods, pins, places, mechanisms.

Everything is worked out where it is first asked for, by a rule or by the engine itself, and once.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import cached_property
from itertools import chain
from typing import TYPE_CHECKING, Any

import numpy as np

from ..core.cylinders import Cylinders, find_travel
from ..core.mechanisms.linkage import Articulated, Rotary
from ..core.phasors import Array, Figure, unit
from ..core.speed_ripple import RippleLine
from ..file.model import ONE_BY_ONE, Articulation, EngineFile
from .figures import (
    NOTHING,
    FileFigures,
    OwnFigures,
    RodFigures,
    column,
    either,
    own_figures,
    rod_figures,
    shared_column,
)
from .layout import (
    Cell,
    Plan,
    bank_angles,
    cycle_deg,
    find_dead_centres,
    find_instants,
    find_intervals,
    find_pins,
    plan_cylinders,
)
from .rods import RodPlace, RunningGear, Weighed, weigh_rod

if TYPE_CHECKING:
    from ..core.mechanisms.linkage import Linkage
    from .gas import EngineGas


# Few engines have rods on rods, turn, or say of gas: those that do import what it takes.

# What a file without mistakes has that can be relied on (`file.read.Draft`).
ALL_KEYS = frozenset(EngineFile.model_fields) | {
    f"{path}.{key}" for path, table in ONE_BY_ONE.items() for key in table.model_fields
}
PISTON_PARTS = ("mass", "piston", "pin", "rings", "locks")  # keys of [piston] that are masses


class Assembly:
    """What an engine file says, part by part, for one engine or for variants of it.

    What is given by cylinder is keyed by its number. Angles are from x in the sense of rotation.

    Args:
        model: the file.
        varied: by dotted name, arrays of variants in place of some of its figures.
        rank: trailing axes of the engine, if more than `varied` has.
        legible: keys of the file that can be relied on (`file.read.Draft`). What needs others
            must not be asked for.
        known_gas: gas of the cylinders, if that is known; else the rules build it.
    """

    def __init__(
        self,
        model: EngineFile,
        varied: Mapping[str, Figure] | None = None,
        rank: int = 0,
        legible: Iterable[str] = ALL_KEYS,
        known_gas: EngineGas | None = None,
    ) -> None:
        self.model, self.gas = model, known_gas
        self.figures = FileFigures(varied or {}, model)
        self.varies = bool(varied)
        self.rank = max(rank, *map(np.ndim, (varied or {}).values()), 0)
        self.legible = frozenset(legible)
        self._gears: dict[tuple[int, bool], RunningGear] = {}
        # Beside given throws a firing order would have to fit every variant, and adds nothing, but
        # to the gas of a single one.
        given = "crank.throws" in self.legible and model.crank.throws is not None
        needed = model.gas is not None and not self.rank
        self.order = None if varied and given and not needed else model.layout.firing_order
        # In which the crank turns, seen from a cylinder.
        self.sense = -1 if model.layout.rotary else 1

    # ------------------------------------------------------------------ which cylinders
    @cached_property
    def plan(self) -> Plan:
        """Banks, throws and numbers; InputError where they do not fit together."""
        return plan_cylinders(self.model.crank, self.model.layout)

    @cached_property
    def own(self) -> dict[int, OwnFigures]:
        """Overrides of single cylinders, by number."""
        tables = self.figures.cylinder_tables(self.model)
        return {number: own_figures(self.figures, number, own) for number, own in tables.items()}

    def own_of(self, number: int) -> OwnFigures:
        return self.own.get(number, NOTHING)

    @cached_property
    def axes_deg(self) -> dict[int, Figure]:
        """Axis of each cylinder."""
        banks = bank_angles(self.model.layout, self.figures)
        return {
            c.number: either(self.own_of(c.number).bank_deg, banks[c.bank]) for c in self.plan.cells
        }

    # ------------------------------------------------------------------ pistons and rods
    @cached_property
    def radius(self) -> Figure:
        """Crank radius, m."""
        return self.figures.take("crank.stroke", self.model.crank.stroke) / 2e3

    @cached_property
    def masters(self) -> dict[int, int]:
        """Cylinder with the master rod, of each articulated cylinder; empty without any."""
        table = self.model.articulation
        if table is None:
            return {}
        on_throw = {c.throw: c.number for c in self.plan.cells if c.bank == table.master - 1}
        each = ((c.number, on_throw.get(c.throw, c.number)) for c in self.plan.cells)
        return {number: master for number, master in each if number != master}

    @cached_property
    def _general_rods(self) -> tuple[RodFigures, RodFigures]:
        """Figures that hold for all rods on crank pins, and for all articulated ones."""
        rod, table = rod_figures(self.figures, self.model.rod), self.model.articulation
        if table is None:
            return rod, RodFigures()
        return rod, rod_figures(self.figures, table.rod, "articulation.rod")

    def rod_place(self, number: int, articulated: bool = False) -> RodPlace:
        """The figures of a cylinder's rod; number 0 stands for what holds for all."""
        own, general = self.own_of(number).rod, self._general_rods[articulated]
        return RodPlace(number, articulated, general.with_own(own), own, general)

    @cached_property
    def piston_parts(self) -> dict[str, Figure]:
        """Masses of the parts that all pistons are made of, kg, by their keys; of a piston weighed
        as a whole that of `mass`.
        """
        table, take = self.model.piston, self.figures.take_optional
        given = {key: take(f"piston.{key}", getattr(table, key)) for key in PISTON_PARTS}
        return {key: mass for key, mass in given.items() if mass is not None}

    @cached_property
    def gears(self) -> dict[int, RunningGear]:
        """Piston and rod of each cylinder."""
        return {n: self.gear_of(self.rod_place(n, n in self.masters)) for n in self.plan.numbers}

    def gear_of(self, place: RodPlace) -> RunningGear:
        """Piston and rod of one cylinder; cylinders without overrides share one."""
        key = (place.number if place.number in self.own else 0, place.articulated)
        if key not in self._gears:
            own = self.own_of(place.number)
            offset = self.figures.take("piston.offset", self.model.piston.offset) / 1e3
            self._gears[key] = weigh_rod(
                place.rod,
                place.rod.length_for(self.radius),
                either(own.piston_offset, offset),
                either(own.piston_mass, sum(self.piston_parts.values())),
            )
        return self._gears[key]

    @cached_property
    def weighed(self) -> dict[int, Weighed]:
        """Masses of each cylinder as a shop weighs them, by number."""
        take, crank, bobweight = self.figures.take, self.model.crank, self.model.bobweight
        share = take("crank.throw_mass", crank.throw_mass) / self.plan.rods_on_throw
        rod_bearing = take("bobweight.rod_bearing", bobweight.rod_bearing)
        oil, found = take("bobweight.oil", bobweight.oil), {}
        per_pin = take("bobweight.oil_per_pin", bobweight.oil_per_pin)
        if self.figures.is_displaced("bobweight.oil_per_pin"):
            per_pin = 0.0
        elif self.figures.is_displaced("bobweight.oil"):
            oil = 0.0
        for cell in self.plan.cells:
            number, gear = cell.number, self.gears[cell.number]
            own, hung = self.own_of(number).piston_mass, number in self.masters
            found[number] = Weighed(
                cell.throw,
                piston=gear.piston,
                piston_parts=tuple(self.piston_parts.items()) if own is None else (("mass", own),),
                small_end=gear.small_end,
                big_end=gear.big_end,
                share=share,
                rod_bearing=0.0 if hung else rod_bearing,
                oil=0.0 if hung else oil + self._share_of_pin(per_pin, cell),
            )
        return found

    def _share_of_pin(self, whole: Figure, cell: Cell) -> Figure:
        """Return the share that a rod has of a figure of its crank pin, which others may share."""
        if not np.any(whole):
            return 0.0
        found: Any = 0.0
        lead = self.leads_deg[cell.number]
        for other in self.plan.cells:
            if other.throw == cell.throw and other.number not in self.masters:
                apart = (self.leads_deg[other.number] - lead + 180) % 360 - 180
                found = found + (np.abs(apart) < 1e-9)
        share: Figure = whole / found
        return share

    # ------------------------------------------------------------------ crank pins and firing
    @cached_property
    def tops_deg(self) -> dict[int, Figure]:
        """Where each cylinder's crank pin stands when it is at top dead centre.

        Nominally on its axis where rods are articulated: only then do all cylinders of a throw fire
        evenly.
        """
        if self.model.articulation is not None:
            return self.axes_deg
        return {
            number: self.axes_deg[number] + self.sense * gear.top_deg(self.radius)
            for number, gear in self.gears.items()
        }

    @cached_property
    def true_tops_deg(self) -> Mapping[int, Figure]:
        """Where each crank pin stands at top dead centre, found on the motion of the piston where
        rods are articulated.
        """
        if self.model.articulation is None or self.rank:
            return self.tops_deg
        tops = zip(self.numbers, find_travel(self.cylinders).top_deg, strict=True)
        return {n: self.axes_deg[n] + self.sense * float(top) for n, top in tops}

    @cached_property
    def splay_deg(self) -> Figure:
        """By which each further bank's pin leads the one before it."""
        return self.figures.take("crank.splay", self.model.crank.splay)

    @cached_property
    def throws_given(self) -> bool:
        """Whether the crank is known without the firing order: the file gives its throws, or it has
        one, at 0.
        """
        return self.model.crank.throws is not None or (self.plan.throws == 1 and not self.rank)

    @cached_property
    def throws_deg(self) -> Mapping[int, Figure]:
        """Angle of each throw (from 0): as given, or as the firing order needs it."""
        throws = self.model.crank.throws
        if not self.throws_given and self.order is not None:
            wanted = find_pins(self.fires_deg, self.tops_deg, self.sense)
            cells = reversed(self.plan.cells)
            return {c.throw: wanted[c.number] - c.bank * self.splay_deg for c in cells}
        return dict(enumerate(self.figures.take_each("crank.throws", throws or (0.0,))))

    @cached_property
    def leads_deg(self) -> dict[int, Figure]:
        """Crank pin of each cylinder, from cylinder 1's."""
        pins = {}
        for c in self.plan.cells:
            on_throw = self.throws_deg[c.throw] + c.bank * self.splay_deg
            pins[c.number] = either(self.own_of(c.number).throw_deg, on_throw)
        return {number: pin - pins[1] for number, pin in pins.items()}

    @cached_property
    def fires_deg(self) -> dict[int, Figure]:
        """When each cylinder fires, after the first of the firing order; empty without one.

        Raises:
            InputError: the order takes more than a cycle.
        """
        layout = self.model.layout
        if self.order is None:
            return {}
        intervals, cycle = layout.firing_intervals, cycle_deg(layout)
        if intervals is None and self.throws_given:
            pins = {number: float(lead) for number, lead in self.leads_deg.items()}
            tops = {number: float(top) for number, top in self.true_tops_deg.items()}
            ready = find_dead_centres(pins, tops, self.sense)
            intervals = tuple(find_intervals(self.order, ready, cycle))
        return find_instants(self.order, intervals, cycle)

    # ------------------------------------------------------------------ places along the crank
    @cached_property
    def _leans_mm(self) -> dict[int, Figure]:
        """Axial offset of each rod from the middle of its throw (stagger)."""
        on_throw = self.plan.rods_on_throw
        if on_throw == 1:
            return dict.fromkeys(self.plan.numbers, 0.0)
        stagger = self.figures.take("layout.stagger", self.model.layout.stagger)
        return {c.number: (c.bank - (on_throw - 1) / 2) * stagger for c in self.plan.cells}

    @cached_property
    def places(self) -> dict[int, Figure]:
        """z of each cylinder, m."""
        crank, throws = self.model.crank, self.plan.throws
        if crank.positions is None or self.figures.is_displaced("crank.positions"):
            spacing = self.figures.take("crank.spacing", crank.spacing or 0.0)
            along = tuple((t - (throws - 1) / 2) * spacing for t in range(throws))
        else:
            along = self.figures.take_each("crank.positions", crank.positions)
        on_throws = {c.number: along[c.throw] + self._leans_mm[c.number] for c in self.plan.cells}
        return {n: either(self.own_of(n).position_mm, z) / 1e3 for n, z in on_throws.items()}

    @cached_property
    def throws_m(self) -> Array:
        """z of each throw, in the middle of its rods, shape (throws, *trailing)."""
        middles: dict[int, Figure] = dict.fromkeys(range(self.plan.throws), 0.0)
        for c in self.plan.cells:
            own = self.places[c.number] - self._leans_mm[c.number] / 1e3
            middles[c.throw] = middles[c.throw] + own  # of any shape
        return column([z / self.plan.rods_on_throw for z in middles.values()], self.rank)

    @cached_property
    def reference_m(self) -> tuple[Figure, Figure, Figure]:
        """x, y, z of the point of moments: the file's, or on the crank axis half-way between the
        first and the last throw.
        """
        if self.model.frame.reference is not None:
            x, y, z = self.figures.take_each("frame.reference", self.model.frame.reference)
            return x / 1e3, y / 1e3, z / 1e3
        return 0.0, 0.0, (self.throws_m.min(axis=0) + self.throws_m.max(axis=0)) / 2

    # ------------------------------------------------------------------ speed
    @cached_property
    def ripple(self) -> tuple[RippleLine, ...]:
        """Lines of the uneven speed; empty for a steady one."""
        take, lines = self.figures.take, []
        for k, line in enumerate(self.model.operation.speed_ripple, 1):
            path = f"operation.speed_ripple.{k}"
            amplitude = take(f"{path}.amplitude", line.amplitude)
            lines.append(RippleLine(line.order, amplitude, take(f"{path}.angle", line.angle)))
        return tuple(lines)

    # ------------------------------------------------------------------ mechanisms
    @cached_property
    def _banks(self) -> list[list[int]]:
        """Numbers of the cylinders that have the same axis, by value, at every variant, bank by
        bank: all in the order of the plan. Of a rotary engine, of pins that stand still.
        """
        banks: dict[bytes, list[int]] = {}
        for number, axis in self._turned_deg[0].items():
            value = np.asarray(axis, float) + 0.0  # which makes 0.0 of -0.0
            banks.setdefault(value.tobytes(), []).append(number)
        return list(banks.values())

    @cached_property
    def _turned_deg(self) -> tuple[Mapping[int, Figure], Mapping[int, Figure]]:
        """Axes of the cylinders, and their crank pins from cylinder 1's; where the cylinders turn
        about pins that stand still, the other way round (core.rotary).
        """
        axes = self.axes_deg
        if not self.model.layout.rotary:
            return axes, self.leads_deg
        still = {n: axes[1] + lead for n, lead in self.leads_deg.items()}
        return still, {n: axis - axes[1] for n, axis in axes.items()}

    @cached_property
    def numbers(self) -> tuple[int, ...]:
        """Cylinder of each row of `cylinders`."""
        return tuple(chain.from_iterable(self._banks))

    @cached_property
    def cylinders(self) -> Cylinders:
        """All cylinders, sorted by bank."""
        axes, pins = self._turned_deg
        gears, weighed, radius, rank = self.gears, self.weighed, self.radius, self.rank
        at_pistons = self._of_each(lambda n: weighed[n].reciprocating)
        linkage: Linkage | None = None
        if self.model.articulation is not None or self.model.layout.rotary:
            linkage = build_linkage(self, at_pistons)
        turning = linkage is not None and linkage.turning
        return Cylinders(
            axis_deg=column([axes[bank[0]] for bank in self._banks], rank),
            pin_deg=column([pins[n] for n in self.numbers], rank),
            starts=np.cumsum([0, *map(len, self._banks[:-1])]),
            first=next(k for k, bank in enumerate(self._banks) if 1 in bank),
            z=column([self.places[n] for n in self.numbers], rank),
            radius=column([radius], rank)[0],
            lam=self._of_each(lambda n: radius / gears[n].length),
            eps=self._of_each(lambda n: gears[n].offset / gears[n].length),
            reciprocating=0 * at_pistons if turning else at_pistons,
            rotating=self._of_each(lambda n: 0.0 if turning else self._at_pin(n)),
            couple=self._of_each(lambda n: gears[n].couple),
            linkage=linkage,
        )

    def _of_each(self, find: Callable[[int], Figure]) -> Array:
        """A figure of piston and rod for each row of `cylinders`; one row where all are equal."""
        gears, numbers = self.gears, self.numbers
        if all(gears[n] is gears[numbers[0]] for n in numbers):  # no cylinder says more of its own
            numbers = numbers[:1]
        return shared_column([find(n) for n in numbers], self.rank)

    def _at_pin(self, number: int) -> Figure:
        """What turns with a crank pin because of one cylinder, kg."""
        weighed = self.weighed[number]
        return weighed.share + (0.0 if number in self.masters else weighed.rotating)

    @cached_property
    def knuckle_angles_deg(self) -> tuple[Figure, ...] | None:
        """Of each bank's knuckle pin, as given."""
        table = self.model.articulation
        if table is None or table.knuckle_angles is None:
            return None
        return self.figures.take_each("articulation.knuckle_angles", table.knuckle_angles)


def build_linkage(parts: Assembly, at_pistons: Array) -> Linkage:
    """Return the mechanism of an engine with articulated rods, or whose cylinders turn.

    Args:
        parts: the engine as far as it is put together.
        at_pistons: masses at the piston pins, kg, one row a cylinder or one for all.
    """
    table = parts.model.articulation
    if table is None:
        return Rotary(at_pistons)
    hung = _hang_rods(parts, table)
    if not parts.model.layout.rotary:
        return hung
    both = at_pistons + hung.mass
    return Rotary(both, hung, hung.mass / np.where(both == 0, 1.0, both))


def _hang_rods(parts: Assembly, table: Articulation) -> Articulated:
    """Return the mechanism of master and articulated rods. Seen from turning cylinders all angles
    are in the mirror (core.rotary).
    """
    numbers, masters, axes, rank = parts.numbers, parts.masters, parts.axes_deg, parts.rank
    angles = {n: axes[n] - axes[master] for n, master in masters.items()}
    if (given := parts.knuckle_angles_deg) is not None:
        angles = {c.number: given[c.bank] for c in parts.plan.cells if c.number in masters}
    radius_mm = parts.figures.take("articulation.knuckle_radius", table.knuckle_radius)
    stroke_mm = parts.figures.take("crank.stroke", parts.model.crank.stroke)
    ratio = radius_mm / (stroke_mm / 2)
    pins_deg = column([parts.sense * angles.get(n, 0.0) for n in numbers], rank)
    of_master = [masters.get(n, n) for n in numbers]
    leads = [parts.sense * (axes[n] - axes[m]) for n, m in zip(numbers, of_master, strict=True)]
    masses = [parts.gears[n].big_end if n in masters else 0.0 for n in numbers]
    ratios = column([ratio if n in masters else 0.0 for n in numbers], rank)
    return Articulated(
        mass=column(masses, rank),
        master=np.array([numbers.index(master) for master in of_master]),
        knuckle=ratios * unit(pins_deg),
        lead_deg=column(leads, rank),
    )

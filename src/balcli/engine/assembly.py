"""An engine while it is put together from its file: cylinders, rods, pins, places, mechanisms.

Everything is worked out where it is first asked for, by a rule or by the engine itself, and once.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import cached_property
from itertools import chain
from typing import TYPE_CHECKING

import numpy as np

from ..core.cylinders import Cylinders
from ..core.phasors import Array, Figure
from ..core.speed_ripple import RippleLine
from ..enginefile.model import ONE_BY_ONE, EngineFile
from . import firing
from .arrays import column, shared_column
from .figures import NOTHING, FileFigures, OwnFigures, RodFigures, either, own_figures, rod_figures
from .layout import Plan, bank_angles, cycle_deg, plan_cylinders
from .rods import RodPlace, RunningGear, weigh_rod

# Few engines have rods on rods, turn, or say of gas: those that do import what it takes.
if TYPE_CHECKING:
    from ..core.mechanisms.articulated import Articulated
    from ..core.mechanisms.rotary import Rotary
    from .gas import EngineGas

# What a file without mistakes has that can be relied on (`enginefile.read.Draft`).
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
        legible: keys of the file that can be relied on (`enginefile.read.Draft`). What needs others
            must not be asked for.
        known_gas: what `gas` would find, if that is known.
    """

    def __init__(
        self,
        model: EngineFile,
        varied: Mapping[str, Figure] | None = None,
        rank: int = 0,
        legible: Iterable[str] = ALL_KEYS,
        known_gas: EngineGas | None = None,
    ) -> None:
        self.model, self._known_gas = model, known_gas
        self.figures = FileFigures(varied or {}, model)
        self.varies = bool(varied)
        self.rank = max(rank, *map(np.ndim, (varied or {}).values()), 0)
        self.legible = frozenset(legible)
        self._gears: dict[tuple[int, bool], RunningGear] = {}
        # Beside given throws a firing order would have to fit every variant, and adds nothing, but
        # to the gas of a single one.
        self.order = model.layout.firing_order
        needed = model.gas is not None and not self.rank
        if (
            varied
            and not needed
            and "crank.throws" in self.legible
            and model.crank.throws is not None
        ):
            self.order = None
        # In which the crank turns, seen from a cylinder.
        self.sense = -1 if model.layout.rotary else 1

    # ------------------------------------------------------------------ which cylinders
    @cached_property
    def plan(self) -> Plan:
        """Banks, throws and numbers; InputError where they do not fit together."""
        return plan_cylinders(self.model.crank, self.model.layout)

    @cached_property
    def own(self) -> dict[int, OwnFigures]:
        """What is said of single cylinders."""
        tables = self.figures.cylinder_tables(self.model)
        return {number: own_figures(self.figures, number, own) for number, own in tables.items()}

    def own_of(self, number: int) -> OwnFigures:
        return self.own.get(number, NOTHING)

    @cached_property
    def axes_deg(self) -> dict[int, Figure]:
        """Axis of each cylinder."""
        banks = bank_angles(self.model.layout, self.figures)
        general = {c.number: banks[c.bank] for c in self.plan.cells}
        return {n: either(self.own_of(n).bank_deg, axis) for n, axis in general.items()}

    # ------------------------------------------------------------------ pistons and rods
    @cached_property
    def radius(self) -> Figure:
        """Of the crank, m."""
        return self.figures.take("crank.stroke", self.model.crank.stroke) / 2e3

    @cached_property
    def masters(self) -> dict[int, int]:
        """Cylinder with the master rod, of each articulated cylinder; empty without any."""
        table = self.model.articulation
        if table is None:
            return {}
        from .articulation import find_masters

        return find_masters(table, self.plan)

    @cached_property
    def rod(self) -> RodFigures:
        """What holds for all rods on crank pins."""
        return rod_figures(self.figures, self.model.rod)

    @cached_property
    def articulated_rod(self) -> RodFigures:
        """What holds for all articulated rods; nothing where there are none."""
        table = self.model.articulation
        if table is None:
            return RodFigures()
        return rod_figures(self.figures, table.rod, "articulation.rod")

    def rod_place(self, number: int, articulated: bool = False) -> RodPlace:
        """The figures of a cylinder's rod; number 0 stands for what holds for all."""
        own, general = self.own_of(number).rod, self.articulated_rod if articulated else self.rod
        return RodPlace(number, articulated, general.with_own(own), own, general)

    @cached_property
    def piston_parts(self) -> dict[str, Figure]:
        """Masses of the parts that all pistons are made of, kg, by their keys; of a piston weighed
        as a whole that of `mass`.
        """
        table = self.model.piston
        given = {
            key: self.figures.take_optional(f"piston.{key}", getattr(table, key))
            for key in PISTON_PARTS
        }
        return {key: mass for key, mass in given.items() if mass is not None}

    def piston_parts_of(self, number: int) -> tuple[tuple[str, Figure], ...]:
        """What one cylinder's piston was weighed in, by the keys of [piston]."""
        own = self.own_of(number).piston_mass
        return tuple(self.piston_parts.items()) if own is None else (("mass", own),)

    @cached_property
    def piston_mass(self) -> Figure:
        """Of all pistons of which nothing else is said, kg."""
        return sum(self.piston_parts.values())

    def piston_offset(self, number: int) -> Figure:
        """Of the path of a cylinder's piston pin, m."""
        general = self.figures.take("piston.offset", self.model.piston.offset) / 1e3
        return either(self.own_of(number).piston_offset, general)

    @cached_property
    def gears(self) -> dict[int, RunningGear]:
        """Piston and rod of each cylinder."""
        masters = self.masters
        places = {number: self.rod_place(number, number in masters) for number in self.plan.numbers}
        return {number: self.gear_of(place) for number, place in places.items()}

    def gear_of(self, place: RodPlace) -> RunningGear:
        """Piston and rod of one cylinder; those of which nothing is said alone are one for all."""
        key = (place.number if place.number in self.own else 0, place.articulated)
        if key not in self._gears:
            self._gears[key] = weigh_rod(
                place.rod,
                place.rod.length_for(self.radius),
                self.piston_offset(place.number),
                either(self.own_of(place.number).piston_mass, self.piston_mass),
            )
        return self._gears[key]

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
        from ..core.strokes import find_travel

        tops = find_travel(self.cylinders).top_deg
        return {
            n: self.axes_deg[n] + self.sense * float(top)
            for n, top in zip(self.numbers, tops, strict=True)
        }

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
    def _given_fires_deg(self) -> dict[int, Figure]:
        """Firing angles as far as they do not follow from the throws."""
        intervals = self.model.layout.firing_intervals
        if self.order is None or (intervals is None and self.throws_given):
            return {}
        return firing.find_instants(self.order, intervals, cycle_deg(self.model.layout))

    @cached_property
    def throws_deg(self) -> Mapping[int, Figure]:
        """Angle of each throw (from 0): as given, or as the firing order needs it."""
        throws = self.model.crank.throws
        if not self.throws_given and self.order is not None:
            wanted = firing.find_pins(self._given_fires_deg, self.tops_deg, self.sense)
            cells = reversed(self.plan.cells)
            return {c.throw: wanted[c.number] - c.bank * self.splay_deg for c in cells}
        return dict(enumerate(self.figures.take_each("crank.throws", throws or (0.0,))))

    @cached_property
    def pins_deg(self) -> dict[int, Figure]:
        """Crank pin of each cylinder."""
        on_throws = {
            c.number: self.throws_deg[c.throw] + c.bank * self.splay_deg for c in self.plan.cells
        }
        return {n: either(self.own_of(n).throw_deg, pin) for n, pin in on_throws.items()}

    @cached_property
    def leads_deg(self) -> dict[int, Figure]:
        """Crank pin of each cylinder, from cylinder 1's."""
        return {number: pin - self.pins_deg[1] for number, pin in self.pins_deg.items()}

    @cached_property
    def dead_centres_deg(self) -> dict[int, float]:
        """Where the crank stands at each top dead centre, in [0, 360) after cylinder 1's; at the
        true ones where rods are articulated.
        """
        pins = {number: float(lead) for number, lead in self.leads_deg.items()}
        tops = {number: float(top) for number, top in self.true_tops_deg.items()}
        return firing.find_dead_centres(pins, tops, self.sense)

    @cached_property
    def fires_deg(self) -> dict[int, Figure]:
        """When each cylinder fires, after the first of the firing order; empty without one.

        Raises:
            InputError: the order takes more than a cycle.
        """
        if self.order is None or self._given_fires_deg:
            return self._given_fires_deg
        cycle = cycle_deg(self.model.layout)
        intervals = firing.find_intervals(self.order, self.dead_centres_deg, cycle)
        return firing.find_instants(self.order, intervals, cycle)

    # ------------------------------------------------------------------ places along the crank
    @cached_property
    def _leans_mm(self) -> dict[int, Figure]:
        """How far each rod stands behind the middle of its throw."""
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
        take, path = self.figures.take, "operation.speed_ripple"
        return tuple(
            RippleLine(
                line.order,
                take(f"{path}.{k}.amplitude", line.amplitude),
                take(f"{path}.{k}.angle", line.angle),
            )
            for k, line in enumerate(self.model.operation.speed_ripple, 1)
        )

    # ------------------------------------------------------------------ mechanisms
    @cached_property
    def share_of_throw(self) -> Figure:
        """Mass of a throw that one of its pins has, kg."""
        mass = self.figures.take("crank.throw_mass", self.model.crank.throw_mass)
        return mass / self.plan.rods_on_throw

    @cached_property
    def rod_bearing(self) -> Figure:
        """Bearing shells of one rod, kg."""
        return self.figures.take("bobweight.rod_bearing", self.model.bobweight.rod_bearing)

    @cached_property
    def oil(self) -> Figure:
        """Oil that turns with a pin, for one rod, kg."""
        return self.figures.take("bobweight.oil", self.model.bobweight.oil)

    @cached_property
    def _turned_deg(self) -> tuple[Mapping[int, Figure], Mapping[int, Figure]]:
        """Axes of the cylinders, and their crank pins from cylinder 1's; where the cylinders turn
        about pins that stand still, the other way round (core.rotary).
        """
        if not self.model.layout.rotary:
            return self.axes_deg, self.leads_deg
        axes = self.axes_deg
        still = {n: axes[1] + lead for n, lead in self.leads_deg.items()}
        return still, {n: axis - axes[1] for n, axis in axes.items()}

    @cached_property
    def banks(self) -> list[list[int]]:
        """Numbers of the cylinders that have the same axis, bank by bank."""
        return _share_axes(self._turned_deg[0])

    @cached_property
    def numbers(self) -> tuple[int, ...]:
        """Cylinder of each row of `cylinders`."""
        return tuple(chain.from_iterable(self.banks))

    @cached_property
    def cylinders(self) -> Cylinders:
        """All cylinders, sorted by bank."""
        axes, pins = self._turned_deg
        gears, radius, rank = self.gears, self.radius, self.rank
        rotary = self.model.layout.rotary
        at_pistons = self._of_each(lambda n: gears[n].piston + gears[n].small_end)
        hung = self._hung
        return Cylinders(
            axis_deg=column([axes[bank[0]] for bank in self.banks], rank),
            pin_deg=column([pins[n] for n in self.numbers], rank),
            starts=np.cumsum([0, *map(len, self.banks[:-1])]),
            first=next(k for k, bank in enumerate(self.banks) if 1 in bank),
            z=column([self.places[n] for n in self.numbers], rank),
            radius=column([radius], rank)[0],
            lam=self._of_each(lambda n: radius / gears[n].length),
            eps=self._of_each(lambda n: gears[n].offset / gears[n].length),
            reciprocating=0 * at_pistons if rotary else at_pistons,
            rotating=self._of_each(self._at_pin),
            couple=self._of_each(lambda n: gears[n].couple),
            linkage=_turn_cylinders(at_pistons, hung) if rotary else hung,
        )

    def _of_each(self, find: Callable[[int], Figure]) -> Array:
        """A figure of piston and rod for each row of `cylinders`; one row where all are equal."""
        gears, numbers = self.gears, self.numbers
        if all(gears[n] is gears[numbers[0]] for n in numbers):  # no cylinder says more of its own
            numbers = numbers[:1]
        return shared_column([find(n) for n in numbers], self.rank)

    def _at_pin(self, number: int) -> Figure:
        """What turns with a crank pin because of one cylinder, kg; pins of a rotary stand still."""
        if self.model.layout.rotary:
            return 0.0
        if number in self.masters:
            return self.share_of_throw
        return self.gears[number].big_end + self.share_of_throw + self.rod_bearing + self.oil

    @cached_property
    def knuckle_angles_deg(self) -> tuple[Figure, ...] | None:
        """Of each bank's knuckle pin, as given."""
        table = self.model.articulation
        if table is None or table.knuckle_angles is None:
            return None
        return self.figures.take_each("articulation.knuckle_angles", table.knuckle_angles)

    @cached_property
    def _hung(self) -> Articulated | None:
        """Master and articulated rods."""
        table, masters, axes = self.model.articulation, self.masters, self.axes_deg
        if table is None:
            return None
        from .articulation import KnucklePins, build_linkage

        angles = {n: axes[n] - axes[master] for n, master in masters.items()}
        if (given := self.knuckle_angles_deg) is not None:
            angles = {c.number: given[c.bank] for c in self.plan.cells if c.number in masters}
        radius_mm = self.figures.take("articulation.knuckle_radius", table.knuckle_radius)
        stroke_mm = self.figures.take("crank.stroke", self.model.crank.stroke)
        knuckles = KnucklePins(radius_mm / (stroke_mm / 2), angles, masters)
        big_ends = [self.gears[n].big_end for n in self.numbers]
        return build_linkage(knuckles, self.numbers, axes, big_ends, self.sense, self.rank)

    # ------------------------------------------------------------------ gas
    @cached_property
    def gas(self) -> EngineGas | None:
        """Gas of the cylinders; None without [gas], and for variants, whose figures are arrays."""
        if self._known_gas is not None or self.model.gas is None or self.rank:
            return self._known_gas
        from .build_gas import build_gas  # files without [gas] do not pay for it

        return build_gas(self)


def _share_axes(axes_deg: Mapping[int, Figure]) -> list[list[int]]:
    """The banks: numbers of the cylinders that have the same axis, by value, at every variant.

    Banks, and the cylinders of each, stand in the order in which `axes_deg` names them.
    """
    banks: dict[bytes, list[int]] = {}
    for number, axis in axes_deg.items():
        value = np.asarray(axis, float) + 0.0  # which makes 0.0 of -0.0
        banks.setdefault(value.tobytes(), []).append(number)
    return list(banks.values())


def _turn_cylinders(at_pistons: Array, hung: Articulated | None) -> Rotary:
    """The mechanism of cylinders that turn, with the masses at their piston pins, kg."""
    from ..core.mechanisms.rotary import Rotary

    if hung is None:
        return Rotary(at_pistons)
    both = at_pistons + hung.mass
    return Rotary(both, hung, hung.mass / np.where(both == 0, 1.0, both))

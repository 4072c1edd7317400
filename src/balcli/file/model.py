"""The tables of an engine file: one pydantic class per part, in its units (mm, kg, degrees, rpm, kg
mm^2, g mm, s).

The tables check and never derive: what follows from the figures (rod length from its ratio, inertia
from a pendulum) is computed by the package `engine`. A validator is built only for a table that a
file has.
"""

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import chain, pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Self

from pydantic import BeforeValidator, Field, PrivateAttr

from ..limits import MOST_RIPPLES
from .fields import Choice, FileName, Label, OneOf, counted, join_words, parse_firing_order
from .table import (
    INTERVAL_TOLERANCE_DEG,
    Angle,
    Angles,
    Count,
    Distance,
    FileTable,
    GivenInertia,
    Heat,
    Inertia,
    Intervals,
    Length,
    Lengths,
    Mass,
    Numbers,
    NumbersOfBanks,
    Period,
    Place,
    Power,
    RippleOrder,
    RodRatio,
    ShaftRatio,
    Share,
    ShareOfGas,
    Size,
    Speed,
    Switch,
    Triple,
    Unbalance,
)

if TYPE_CHECKING:
    from .engine_tables import Engine
    from .gas_tables import Bearing, Flywheel, Gas
    from .mount_tables import Body, Mount, Point
    from .torsion_tables import Torsion


class Crank(FileTable):
    """The crankshaft and its throws."""

    choices = (Choice((("spacing",), ("positions",))),)

    stroke: Size
    """Twice the crank radius. Example: 90"""
    throws: Angles | None = None
    """Angle of every throw, free end to flywheel end; may be left out where firing_order fixes
    them. Example: [0, 180, 180, 0]"""
    spacing: Distance | None = None
    """Axial distance of neighbouring throws; without it (or positions) moments of several throws
    are not known. Example: 100"""
    positions: Lengths | None = None
    """Axial place of every throw, instead of spacing. Example: [-150, -50, 50, 150]"""
    throw_mass: Mass = 0.0
    """Unbalanced mass of one whole throw, referred to the crank radius; its pins share it
    equally. Example: 0.8"""
    inertia: GivenInertia | None = None
    """Polar moment of inertia of the whole crankshaft with throws and counterweights, for its
    uneven speed. Example: 90000"""
    splay: Angle = 0.0
    """Split pins: angle by which each further bank's pin leads the one before it. Example: -30"""


class Pendulum(FileTable):
    """A pendulum test of a rod: swung about one of its bores."""

    pivot: Annotated[str, OneOf("small_end", "big_end")]
    """The bore about whose centre the rod swings. Example: 'small_end'"""
    period: Period
    """One full swing, there and back. Example: 0.82"""


class Rod(FileTable):
    """The connecting rod of every cylinder."""

    choices = (
        Choice((("length",), ("ratio",)), required=True),
        Choice((("mass", "cg"), ("small_end", "big_end")), complete=("small_end", "big_end")),
        Choice((("inertia",), ("pendulum",))),
    )

    length: Size | None = None
    """Distance of the two centres. Example: 160"""
    ratio: RodRatio | None = None
    """Crank radius over rod length (lambda), instead of length. Example: 0.28"""
    mass: Mass | None = None
    """Mass of the whole rod with bolts, without bearing shells. Example: 0.6"""
    cg: Length | None = None
    """From the big-end centre to the centre of mass. Example: 45"""
    small_end: Mass | None = None
    """Mass weighed at the small end, instead of mass and cg. Example: 0.17"""
    big_end: Mass | None = None
    """Mass weighed at the big end, instead of mass and cg. Example: 0.43"""
    inertia: Inertia | None = None
    """Moment of inertia about the centre of mass; left out: two masses at the ends. Example:
    2300"""
    pendulum: Pendulum | None = None
    """A pendulum test, instead of inertia."""


PISTON_PARTS = ("piston", "pin", "rings", "locks")  # keys of [piston], instead of its mass


class Piston(FileTable):
    """One piston with its rings, pin and locks: weighed together, or part by part."""

    choices = (Choice((("mass",), PISTON_PARTS), required=True, complete=True),)

    bore: Size | None = None
    """Cylinder bore. Example: 86"""
    mass: Mass | None = None
    """Piston, pin, rings and locks together. Example: 0.5"""
    piston: Mass | None = None
    """The bare piston, instead of mass, which is then the sum. Example: 0.36"""
    pin: Mass | None = None
    """Piston pin. Example: 0.1"""
    rings: Mass | None = None
    """All rings of one piston. Example: 0.036"""
    locks: Mass | None = None
    """Both locks (clips) of the pin. Example: 0.004"""
    offset: Length = 0.0
    """Of the pin path, + towards the side to which the crank pin moves after top dead centre.
    Example: -1.6"""


class Crosshead(FileTable):
    """Crosshead between the piston rod and the connecting rod of large engines."""

    mass: Mass = 0.0
    """Of each cylinder, with piston rod and pin; it moves with the piston. Example: 2400"""


class Layout(FileTable):
    """Banks, rods on a throw, and firing."""

    choices = (Choice((("bank_angle",), ("banks",), ("radial",))),)

    bank_angle: Angle | None = None
    """A vee: banks at minus and plus half of this angle. Example: 90"""
    banks: Angles | None = None
    """Angle of every bank. Example: [-90, 90]"""
    radial: Count | None = None
    """Number of banks, evenly round the crank. Example: 9"""
    rods: Annotated[str, OneOf("shared", "alternating")] = "shared"
    """Shared: every throw carries one rod of each bank; alternating: the throws take the banks
    in turn. Example: 'alternating'"""
    stagger: Length = 0.0
    """Axial distance of adjacent rods on a throw, first bank towards the free end. Example: 22"""
    firing_order: Annotated[Numbers | None, BeforeValidator(parse_firing_order)] = None
    """Numbers of the cylinders as they fire. Example: [1, 3, 4, 2]"""
    firing_intervals: Intervals | None = None
    """From each firing to the next; left out: as crank.throws give them, even without these.
    Example: [405, 315]"""
    rotary: Switch = False
    """The crank stands still and the cylinders turn about it. Example: true"""
    strokes: Annotated[int, OneOf(2, 4)] = 4
    """Two-stroke or four-stroke. Example: 4"""
    numbering: NumbersOfBanks | None = None
    """Cylinder numbers of each bank, free end to flywheel end. Example: [[1, 3], [2, 4]]"""

    def _check_numbers(self) -> Iterator[str]:
        for key, numbers in (
            ("firing_order", self.firing_order or ()),
            ("numbering", chain(*self.numbering or ())),
        ):
            twice = [str(number) for number, times in Counter(numbers).items() if times > 1]
            if twice:
                listed = join_words(twice[:5])
                yield f"{key} has cylinder {listed} more than once; name every cylinder once"

    def _check_intervals(self) -> Iterator[str]:
        intervals, order, cycle = self.firing_intervals, self.firing_order, 180 * self.strokes
        if intervals is None:
            return
        if order is None:
            yield "firing_intervals is given without firing_order; give both, or neither"
        elif len(intervals) != len(order):
            yield (
                f"firing_intervals has {counted(len(intervals), 'interval')} for "
                f"{counted(len(order), 'firing')}; give one for each, the last one "
                "back to the first cylinder"
            )
        elif gaps := _list_gaps(intervals, cycle):
            yield (
                "firing_intervals look like angles that count from the first firing: "
                f"{join_words([f'{angle:g}' for angle in intervals])}; give the angle from each "
                f"firing to the next: [{', '.join(f'{gap:g}' for gap in gaps)}]"
            )
        elif abs(sum(intervals) - cycle) > INTERVAL_TOLERANCE_DEG:
            yield (
                f"firing_intervals add up to {sum(intervals):g} degrees; the cycle of a "
                f"{self.strokes}-stroke has {cycle} (within {INTERVAL_TOLERANCE_DEG:g}); give the "
                "angle from each firing to the next"
            )


def _list_gaps(angles: Sequence[float], cycle: float) -> list[float]:
    """Return the interval after each firing if these numbers rise from 0 or to the whole cycle, as
    angles that count from the first firing do; else an empty list.
    """
    first = angles[0] == 0
    gaps = [b - a for a, b in pairwise([*angles, cycle] if first else [0, *angles])]
    rises = min(gaps) > 0 and (first or angles[-1] == cycle) and len(angles) > 1
    fits = sum(angles) == cycle and max(gaps) > min(gaps) + INTERVAL_TOLERANCE_DEG
    return gaps if rises and not fits else []


class Bobweight(FileTable):
    """Masses that turn with a crank pin in addition to rod and throw."""

    choices = (Choice((("oil",), ("oil_per_pin",))),)

    rod_bearing: Mass = 0.0
    """Big-end bearing shells of one rod. Example: 0.047"""
    oil: Mass = 0.0
    """Allowance for oil, for each rod. Example: 0.004"""
    oil_per_pin: Mass | None = None
    """Allowance for oil of a whole crank pin, as shops write it, instead of oil; its rods share
    it equally. Example: 0.005"""


class Ripple(FileTable):
    """One order of the uneven crank speed: mean speed times amplitude * cos(order * theta -
    angle).
    """

    order: RippleOrder
    """Times for each turn of the crank. Example: 4"""
    amplitude: Share
    """Of the mean speed. Example: 0.01"""
    angle: Angle = 0.0
    """Phase: it is largest at angle / order. Example: 0"""


class Operation(FileTable):
    """How the engine runs."""

    speed: Speed = 1000.0
    """Crank speed (mean over the angle). Example: 3000"""
    power: Power | None = None
    """Brake power at this speed, for the power related unbalance. Example: 3820"""
    speed_ripple: Annotated[tuple[Ripple, ...], Field(max_length=MOST_RIPPLES)] = ()
    """Uneven crank speed, by orders: whole ones, or halves of a four-stroke engine."""


class Frame(FileTable):
    """The frame of the engine."""

    reference: Triple | None = None
    """x, y, z of the point about which all moments are taken; left out: on the crank axis,
    half-way between the first and the last throw. Example: [0, 0, 0]"""
    up: Angle | None = None
    """Direction that points up on the test bed, from the x axis in the sense of rotation; left
    out: results name x and y. Example: 0"""


class Override(FileTable):
    """Figures of a cylinder that differs from the others."""

    choices = (
        *(choice.for_overrides("rod_") for choice in Rod.choices),
        Choice((("heat",), ("indicator",))),
    )

    piston_mass: Mass | None = None
    """As piston.mass. Example: 0.502"""
    crosshead_mass: Mass | None = None
    """As crosshead.mass. Example: 2450"""
    piston_offset: Length | None = None
    """As piston.offset. Example: 0.8"""
    rod_length: Size | None = None
    """As rod.length. Example: 160"""
    rod_ratio: RodRatio | None = None
    """As rod.ratio. Example: 0.28"""
    rod_mass: Mass | None = None
    """As rod.mass. Example: 0.602"""
    rod_cg: Length | None = None
    """As rod.cg. Example: 45"""
    rod_small_end: Mass | None = None
    """As rod.small_end. Example: 0.17"""
    rod_big_end: Mass | None = None
    """As rod.big_end. Example: 0.43"""
    rod_inertia: Inertia | None = None
    """As rod.inertia. Example: 2300"""
    rod_pendulum: Pendulum | None = None
    """As rod.pendulum."""
    gas: ShareOfGas | None = None
    """Share of the gas force; 0: a misfire. Example: 0"""
    heat: Heat | None = None
    """As gas.heat, of a computed cycle; 0: a cylinder that compresses and does not burn.
    Example: 0"""
    indicator: Annotated[str, FileName()] | None = None
    """As gas.indicator, a diagram of its own. Example: 'p_3.csv'"""
    bank: Angle | None = None
    """Angle of this cylinder's axis. Example: 30"""
    throw: Angle | None = None
    """Angle of this cylinder's crank pin. Example: 120"""
    position: Length | None = None
    """Axial place of this cylinder. Example: 50"""


class Device(FileTable):
    """Keys of all devices: the size, as unbalance or as mass and radius."""

    choices = (Choice((("unbalance",), ("mass", "radius")), required=True, complete=True),)

    unbalance: Unbalance | None = None
    """Mass times radius; "fit": `balcli balance` finds it. Example: 9000"""
    mass: Mass | None = None
    """With radius, instead of unbalance. Example: 0.5"""
    radius: Distance | None = None
    """With mass, instead of unbalance. Example: 40"""
    position: Length = 0.0
    """Axial place (z). Example: 0"""

    @property
    def to_fit(self) -> bool:
        """Whether its unbalance is "fit", for `balcli balance` to find."""
        return self.unbalance is not None and math.isnan(self.unbalance)


class Counterweight(Device):
    """An unbalance fixed to the crankshaft."""

    angle: Angle = 0.0
    """At crank angle 0, from cylinder 1's crank pin. Example: 180"""
    engine: Annotated[str, Label()] | None = None
    """With [[engine]]: the engine whose crank carries it; left out: the first. Example: 'lower'"""


class Shaft(Device):
    """A balancer shaft, or one of several eccentrics on it."""

    ratio: ShaftRatio
    """Times crank speed; negative: against the crank. Example: -2"""
    angle: Angle = 0.0
    """Of the eccentric at crank angle 0, from the x axis. Example: 90"""
    at: Place = (0.0, 0.0)
    """x, y of the shaft. Example: [-40, 60]"""
    role: Annotated[str, OneOf("balancer", "compensator")] = "balancer"
    """Compensator: far from the engine, its force makes a moment and is meant to remain.
    Example: 'balancer'"""


class Slider(Device):
    """A reciprocating balance mass."""

    order: Count
    """Strokes for each turn of the crank. Example: 2"""
    direction: Angle
    """Of its path, from the x axis. Example: 90"""
    angle: Angle = 0.0
    """Phase at crank angle 0: displacement ~ cos(order * theta + angle). Example: 180"""
    at: Place = (0.0, 0.0)
    """x, y of its middle. Example: [0, 0]"""


def label_table(table: FileTable, number: int) -> str:
    """Return the word for a table of several in dotted names: its name, with `_` for spaces, if
    that is a word; else its number.

    Args:
        table: Table, which may have a name.
        number: Number of the table, from 1.
    """
    name = "" if table.by_number else getattr(table, "name", "").replace(" ", "_")
    return name if name.isidentifier() else str(number)


class EngineFile(FileTable):
    """One engine: crank, rods, pistons, layout, and the devices that balance it."""

    name: str = ""
    """What the engine is called. Example: 'in-line four'"""
    source: str = ""
    """Where the figures come from, and which are assumed. Example: 'weighed, May 2024'"""
    crank: Crank
    rod: Rod
    piston: Piston
    crosshead: Crosshead = Crosshead.model_construct()
    layout: Layout = Layout.model_construct()
    bobweight: Bobweight = Bobweight.model_construct()
    operation: Operation = Operation.model_construct()
    frame: Frame = Frame.model_construct()
    articulation: "Articulation | None" = None
    gas: "Gas | None" = None
    flywheel: "Flywheel | None" = None
    bearing: "Bearing | None" = None
    torsion: "Torsion | None" = None
    cylinder: dict[int, Override] = {}  # noqa: RUF012 - pydantic copies it
    """What differs in single cylinders, by their numbers."""
    counterweight: tuple[Counterweight, ...] = ()
    """Unbalance fixed to the crankshaft."""
    shaft: tuple[Shaft, ...] = ()
    """Balancer shafts."""
    slider: tuple[Slider, ...] = ()
    """Reciprocating balance masses."""
    engine: "tuple[Engine, ...]" = ()
    """Several engines that are geared together."""
    body: "Body | None" = None
    mount: "tuple[Mount, ...]" = ()
    """What the body stands on."""
    point: "tuple[Point, ...]" = ()
    """Points whose motion is wanted."""

    _folder: Path = PrivateAttr(Path())
    _cranks: tuple["EngineFile", ...] = PrivateAttr(())

    @property
    def folder(self) -> Path:
        """Where the file stands, and the files that it names."""
        return self._folder

    @property
    def cranks(self) -> "tuple[EngineFile, ...]":
        """The files of the engines that are geared together; an ordinary file is its own."""
        return self._cranks or (self,)

    def with_cranks(self, cranks: Sequence["EngineFile"]) -> Self:
        """Return a copy of this file, which has [[engine]], with these files of its engines."""
        copy = self.model_copy()
        copy._cranks = tuple(cranks)
        return copy

    @property
    def crank_names(self) -> tuple[str, ...]:
        """Names of the engines of [[engine]]: their own, or letters."""
        return tuple(one.name or chr(ord("A") + k) for k, one in enumerate(self.engine))

    @property
    def has_gas(self) -> bool:
        """Whether the engine has [gas], or one of several that are geared together."""
        return any(crank.gas is not None for crank in self.cranks)

    def with_table(self, key: str, **values: object) -> Self:
        """Return a copy of this file with other values in one table; they are not checked."""
        table: FileTable = getattr(self, key)
        return self.model_copy(update={key: table.model_copy(update=values)})

    def tables(self) -> Iterator[tuple[str, FileTable]]:
        """Yield every table with its dotted name (`crank`, `shaft.1`, `mount.left`), as far as the
        file has it or it has defaults; not the tables within tables.
        """
        for name, part in self:
            if isinstance(part, FileTable):
                yield name, part
            elif isinstance(part, tuple):
                for number, table in enumerate(part, 1):
                    yield f"{name}.{label_table(table, number)}", table
            elif isinstance(part, dict):
                yield from ((f"{name}.{number}", table) for number, table in part.items())


class ArticulatedRod(Rod):
    """An articulated rod, from its knuckle pin (its big end) to its piston pin."""

    length: Size | None = None
    """From the knuckle pin to the piston pin. Example: 200"""
    cg: Length | None = None
    """From the knuckle pin to the centre of mass. Example: 100"""
    big_end: Mass | None = None
    """Mass weighed at the knuckle pin, instead of mass and cg. Example: 0.3"""


class Articulation(FileTable):
    """A radial with one master rod, to which the others are hinged."""

    master: Count = 1
    """Number of the bank that carries the master rod. Example: 1"""
    knuckle_radius: Size
    """From the crank pin to the knuckle pins. Example: 55"""
    knuckle_angles: Angles | None = None
    """One for each bank, from the master rod's axis (its own is 0); left out: bank angles from
    it. Example: [0, 72, 144, 216, 288]"""
    rod: ArticulatedRod
    """The articulated rods."""

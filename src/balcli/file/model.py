"""The tables of an engine file: one pydantic class per part, in its units (mm, kg, degrees, rpm, kg
mm^2, g mm, s).

The tables check and never derive: what follows from the figures (rod length from its ratio, inertia
from a pendulum) is computed by the package `engine`. A validator is built only for a table that a
file has.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from pydantic import BeforeValidator, Field, PrivateAttr

from ..limits import MOST_RIPPLES
from .fields import Choice, FileName, Flag, OneOf, counted, join_words, parse_firing_order
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
    RippleOrder,
    RodRatio,
    ShaftRatio,
    Share,
    ShareOfGas,
    Size,
    Speed,
    TableRule,
    Triple,
    Unbalance,
    key,
    needed,
)

if TYPE_CHECKING:
    from .gas_tables import Bearing, Flywheel, Gas
    from .mount_tables import Body, Mount, Point
    from .torsion_tables import Torsion


class Crank(FileTable):
    """The crankshaft."""

    choices = (Choice((("spacing",), ("positions",))),)

    stroke: Size = needed("twice the crank radius", 90)
    throws: Angles | None = key(
        "angle of every throw, free end to flywheel end; may be left out where firing_order fixes "
        "them",
        [0, 180, 180, 0],
    )
    spacing: Distance | None = key(
        "axial distance of neighbouring throws; without it (or positions) moments of several "
        "throws are not known",
        100,
    )
    positions: Lengths | None = key(
        "axial place of every throw, instead of spacing", [-150, -50, 50, 150]
    )
    throw_mass: Mass = key(
        "unbalanced mass of one whole throw, referred to the crank radius; its pins share it "
        "equally",
        0.8,
        default=0.0,
    )
    inertia: GivenInertia | None = key(
        "polar moment of inertia of the whole crankshaft with throws and counterweights, for its "
        "uneven speed",
        90000,
    )
    splay: Angle = key(
        "split pins: angle by which each further bank's pin leads the one before it",
        -30,
        default=0.0,
    )

    def _check_places(self) -> Iterator[str]:
        if self.throws and self.positions and len(self.throws) != len(self.positions):
            yield (
                f"positions has {counted(len(self.positions), 'place')} for "
                f"{counted(len(self.throws), 'throw')}; give one for each throw"
            )

    rules = (TableRule(_check_places, {"throws", "positions"}),)


class Pendulum(FileTable):
    """A pendulum test of a rod: swung about one of its bores."""

    pivot: Annotated[Literal["small_end", "big_end"], OneOf("small_end", "big_end")] = needed(
        "the bore about whose centre the rod swings", "small_end"
    )
    period: Period = needed("one full swing, there and back", 0.82)


class Rod(FileTable):
    """The connecting rod."""

    choices = (
        Choice((("length",), ("ratio",)), required=True),
        Choice((("mass", "cg"), ("small_end", "big_end")), complete=("small_end", "big_end")),
        Choice((("inertia",), ("pendulum",))),
    )

    length: Size | None = key("distance of the two centres", 160)
    ratio: RodRatio | None = key("crank radius over rod length (lambda), instead of length", 0.28)
    mass: Mass | None = key("mass of the whole rod with bolts, without bearing shells", 0.6)
    cg: Length | None = key("from the big-end centre to the centre of mass", 45)
    small_end: Mass | None = key("mass weighed at the small end, instead of mass and cg", 0.17)
    big_end: Mass | None = key("mass weighed at the big end, instead of mass and cg", 0.43)
    inertia: Inertia | None = key(
        "moment of inertia about the centre of mass; left out: two masses at the ends", 2300
    )
    pendulum: Pendulum | None = key("a pendulum test, instead of inertia")


class Piston(FileTable):
    """One piston with its rings, pin and locks: weighed together, or part by part."""

    choices = (
        Choice((("mass",), ("piston", "pin", "rings", "locks")), required=True, complete=True),
    )

    bore: Size | None = key("cylinder bore", 86)
    mass: Mass | None = key("piston, pin, rings and locks together", 0.5)
    piston: Mass | None = key("the bare piston, instead of mass, which is then the sum", 0.36)
    pin: Mass | None = key("piston pin", 0.1)
    rings: Mass | None = key("all rings of one piston", 0.036)
    locks: Mass | None = key("both locks (clips) of the pin", 0.004)
    offset: Length = key(
        "of the pin path, + towards the side to which the crank pin moves after top dead centre",
        -1.6,
        default=0.0,
    )


class Layout(FileTable):
    """Banks, rods on a throw, and firing."""

    choices = (Choice((("bank_angle",), ("banks",), ("radial",))),)

    bank_angle: Angle | None = key("a vee: banks at minus and plus half of this angle", 90)
    banks: Angles | None = key("angle of every bank", [-90, 90])
    radial: Count | None = key("number of banks, evenly round the crank", 9)
    rods: Annotated[Literal["shared", "alternating"], OneOf("shared", "alternating")] = key(
        "shared: every throw carries one rod of each bank; alternating: the throws take the banks "
        "in turn",
        "alternating",
        default="shared",
    )
    stagger: Length = key(
        "axial distance of adjacent rods on a throw, first bank towards the free end",
        22,
        default=0.0,
    )
    firing_order: Annotated[Numbers | None, BeforeValidator(parse_firing_order)] = key(
        "numbers of the cylinders as they fire", [1, 3, 4, 2]
    )
    firing_intervals: Intervals | None = key(
        "from each firing to the next; left out: as crank.throws give them, even without these",
        [405, 315],
    )
    rotary: Annotated[bool, Flag()] = key(
        "the crank stands still and the cylinders turn about it", True, default=False
    )
    strokes: Annotated[Literal[2, 4], OneOf(2, 4)] = key("two-stroke or four-stroke", 4, default=4)
    numbering: NumbersOfBanks | None = key(
        "cylinder numbers of each bank, free end to flywheel end", [[1, 3], [2, 4]]
    )

    def _check_firing_order(self) -> Iterator[str]:
        yield from _refuse_repeated("firing_order", self.firing_order or ())

    def _check_numbering(self) -> Iterator[str]:
        yield from _refuse_repeated("numbering", chain(*self.numbering or ()))

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
        elif abs(sum(intervals) - cycle) > INTERVAL_TOLERANCE_DEG:
            yield (
                f"firing_intervals add up to {sum(intervals):g} degrees; the cycle of a "
                f"{self.strokes}-stroke has {cycle} (within {INTERVAL_TOLERANCE_DEG:g}); give the "
                "angle from each firing to the next"
            )

    rules = (
        TableRule(_check_firing_order, {"firing_order"}),
        TableRule(_check_numbering, {"numbering"}),
        TableRule(_check_intervals, {"firing_intervals", "firing_order", "strokes"}),
    )


def _refuse_repeated(key: str, numbers: Iterable[int]) -> Iterator[str]:
    twice = [str(number) for number, times in Counter(numbers).items() if times > 1]
    if twice:
        listed = join_words(twice[:5])
        yield f"{key} has cylinder {listed} more than once; name every cylinder once"


class Bobweight(FileTable):
    """What turns with a crank pin besides rod and throw; it rotates."""

    choices = (Choice((("oil",), ("oil_per_pin",))),)

    rod_bearing: Mass = key("big-end bearing shells of one rod", 0.047, default=0.0)
    oil: Mass = key("allowance for oil, for each rod", 0.004, default=0.0)
    oil_per_pin: Mass | None = key(
        "allowance for oil of a whole crank pin, as shops write it, instead of oil; its rods share "
        "it equally",
        0.005,
    )


class Ripple(FileTable):
    """One order of the uneven crank speed: mean speed times amplitude * cos(order * theta -
    angle).
    """

    order: RippleOrder = needed("times for each turn of the crank", 4)
    amplitude: Share = needed("of the mean speed", 0.01)
    angle: Angle = key("phase: it is largest at angle / order", 0, default=0.0)


class Operation(FileTable):
    """How the engine runs."""

    speed: Speed = key("crank speed (mean over the angle)", 3000, default=1000.0)
    speed_ripple: Annotated[tuple[Ripple, ...], Field(max_length=MOST_RIPPLES)] = key(
        "uneven crank speed, by orders: whole ones, or halves of a four-stroke engine", default=()
    )


class Frame(FileTable):
    """The engine's frame."""

    reference: Triple | None = key(
        "x, y, z of the point about which all moments are taken; left out: on the crank axis, "
        "half-way between the first and the last throw",
        [0, 0, 0],
    )


class Override(FileTable):
    """What differs in one cylinder."""

    choices = (
        *(choice.for_overrides("rod_") for choice in Rod.choices),
        Choice((("heat",), ("indicator",))),
    )

    piston_mass: Mass | None = key("as piston.mass", 0.502)
    piston_offset: Length | None = key("as piston.offset", 0.8)
    rod_length: Size | None = key("as rod.length", 160)
    rod_ratio: RodRatio | None = key("as rod.ratio", 0.28)
    rod_mass: Mass | None = key("as rod.mass", 0.602)
    rod_cg: Length | None = key("as rod.cg", 45)
    rod_small_end: Mass | None = key("as rod.small_end", 0.17)
    rod_big_end: Mass | None = key("as rod.big_end", 0.43)
    rod_inertia: Inertia | None = key("as rod.inertia", 2300)
    rod_pendulum: Pendulum | None = key("as rod.pendulum")
    gas: ShareOfGas | None = key("share of the gas force; 0: a misfire", 0)
    heat: Heat | None = key(
        "as gas.heat, of a computed cycle; 0: a cylinder that compresses and does not burn", 0
    )
    indicator: Annotated[str, FileName()] | None = key(
        "as gas.indicator, a diagram of its own", "p_3.csv"
    )
    bank: Angle | None = key("angle of this cylinder's axis", 30)
    throw: Angle | None = key("angle of this cylinder's crank pin", 120)
    position: Length | None = key("axial place of this cylinder", 50)


class Device(FileTable):
    """What all devices share: how much, as unbalance or as mass and radius."""

    choices = (Choice((("unbalance",), ("mass", "radius")), required=True, complete=True),)

    unbalance: Unbalance | None = key("mass times radius", 9000)
    mass: Mass | None = key("with radius, instead of unbalance", 0.5)
    radius: Distance | None = key("with mass, instead of unbalance", 40)
    position: Length = key("axial place (z)", 0, default=0.0)


class Counterweight(Device):
    """An unbalance fixed to the crankshaft."""

    angle: Angle = key("at crank angle 0, from cylinder 1's crank pin", 180, default=0.0)


class Shaft(Device):
    """A balancer shaft, or one of several eccentrics on it."""

    ratio: ShaftRatio = needed("times crank speed; negative: against the crank", -2)
    angle: Angle = key("of the eccentric at crank angle 0, from the x axis", 90, default=0.0)
    at: Place = key("x, y of the shaft", [-40, 60], default=(0.0, 0.0))


class Slider(Device):
    """A reciprocating balance mass."""

    order: Count = needed("strokes for each turn of the crank", 2)
    direction: Angle = needed("of its path, from the x axis", 90)
    angle: Angle = key(
        "phase at crank angle 0: displacement ~ cos(order * theta + angle)", 180, default=0.0
    )
    at: Place = key("x, y of its middle", [0, 0], default=(0.0, 0.0))


def label_table(table: FileTable, number: int) -> str:
    """Return the word for a table of several in dotted names: its name, with `_` for spaces, if
    that is a word; else its number.
    """
    name = getattr(table, "name", "").replace(" ", "_")
    return name if name.isidentifier() else str(number)


# Tables on which most depends: what depends on some of their keys does not on others, which may
# be mistaken.
ONE_BY_ONE: dict[str, type[FileTable]] = {"crank": Crank, "layout": Layout}


class EngineFile(FileTable):
    """One engine: crank, rods, pistons, layout, and the devices that balance it."""

    name: str = key("what the engine is called", "in-line four", default="")
    source: str = key(
        "where the figures come from, and what is assumed", "weighed, May 2024", default=""
    )
    crank: Crank
    rod: Rod
    piston: Piston
    layout: Layout = Layout.model_construct()
    bobweight: Bobweight = Bobweight.model_construct()
    operation: Operation = Operation.model_construct()
    frame: Frame = Frame.model_construct()
    articulation: Articulation | None = None
    gas: Gas | None = None
    flywheel: Flywheel | None = None
    bearing: Bearing | None = None
    torsion: Torsion | None = None
    cylinder: dict[int, Override] = key(
        "what differs in single cylinders, by their numbers", default={}
    )
    counterweight: tuple[Counterweight, ...] = key("unbalance fixed to the crankshaft", default=())
    shaft: tuple[Shaft, ...] = key("balancer shafts", default=())
    slider: tuple[Slider, ...] = key("reciprocating balance masses", default=())
    body: Body | None = None
    mount: tuple[Mount, ...] = key("what the body stands on", default=())
    point: tuple[Point, ...] = key("points whose motion is wanted", default=())

    _folder: Path = PrivateAttr(Path())

    @property
    def folder(self) -> Path:
        """Where the file stands, and the files that it names."""
        return self._folder

    def with_table(self, key: str, **values: object) -> EngineFile:
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

    length: Size | None = key("from the knuckle pin to the piston pin", 200)
    cg: Length | None = key("from the knuckle pin to the centre of mass", 100)
    big_end: Mass | None = key("mass weighed at the knuckle pin, instead of mass and cg", 0.3)


class Articulation(FileTable):
    """A radial with one master rod, to which the others are hinged."""

    master: Count = key("number of the bank that carries the master rod", 1, default=1)
    knuckle_radius: Size = needed("from the crank pin to the knuckle pins", 55)
    knuckle_angles: Angles | None = key(
        "one for each bank, from the master rod's axis (its own is 0); left out: bank angles from "
        "it",
        [0, 72, 144, 216, 288],
    )
    rod: ArticulatedRod = needed("the articulated rods")

"""The tables of an engine file: one pydantic class for each table, in the units of the file (mm,
kg, degrees, rpm, kg mm^2, g mm, s).

The tables only check figures. Values that follow from these figures (the length of a rod from
rod.ratio, its inertia from a pendulum test) are computed by the package `engine`. pydantic builds a
validator only for tables that a file has. The string below a key documents it
(`table.document_keys`).
"""

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, ClassVar, Self

from pydantic import Field, PrivateAttr

from ..limits import HIGHEST_RIPPLE_ORDER, HIGHEST_SHAFT_ORDER, MOST_LIST_VALUES, MOST_RIPPLES
from .fields import (
    Choice,
    FileName,
    Label,
    Number,
    OneOf,
    OneOrEach,
    SpeedRatio,
    Whole,
    counted,
    join_words,
)
from .firing_order import FiringOrder
from .table import (
    FIT,
    INTERVAL_TOLERANCE_DEG,
    Angle,
    Angles,
    AnglesOfRows,
    Count,
    Density,
    Distance,
    FileTable,
    GivenInertia,
    Heat,
    Inertia,
    Intervals,
    Length,
    Lengths,
    Mass,
    Masses,
    Name,
    Numbers,
    NumbersOfBanks,
    Place,
    RodRatio,
    Share,
    Size,
    Speed,
    Switch,
    Triple,
    label_table,
)
from .units import ANGLE, LENGTH, PLAIN, POWER, TIME, TORQUE, UNBALANCE

if TYPE_CHECKING:
    from .check_table import Check
    from .engine_tables import Engine
    from .gas_tables import Bearing, Flywheel, Gas
    from .locomotive_tables import Axle, Locomotive
    from .mount_tables import Body, Mount, Point
    from .torsion_tables import Torsion
    from .web_tables import Web


class Crank(FileTable):
    """The crankshaft and its throws."""

    choices = (Choice((("spacing",), ("positions",))),)

    stroke: Annotated[float | tuple[float, ...], OneOrEach(Number(LENGTH, above=0, most=1e9))]
    """Twice the crank radius; a list has a stroke for each throw. Example: 90"""
    throws: Angles | None = None
    """Angle of every throw, free end to flywheel end; a throw further ahead fires earlier. May be
    left out where layout.firing_order determines the throws. Example: [0, 180, 180, 0]"""
    spacing: Distance | None = None
    """Axial distance between neighbouring throws; without spacing and positions, moments of
    several throws are not known. Example: 100"""
    positions: Lengths | None = None
    """Axial position of every throw, instead of spacing. Example: [-150, -50, 50, 150]"""
    throw_mass: Masses = 0.0
    """Unbalanced mass of one whole throw, referred to the crank radius; the pins of a throw share
    it equally; a list has a mass for each throw. Example: 0.8"""
    inertia: GivenInertia | None = None
    """Polar moment of inertia of the whole crankshaft with throws and counterweights, to compute
    the uneven speed. Example: 90000"""
    splay: Angle = 0.0
    """Split pins: angle by which each bank's pin leads the pin of the bank before. Example: -30"""

    @property
    def strokes(self) -> tuple[float, ...]:
        """Stroke of every throw, or a single stroke for all throws, mm."""
        return self.stroke if isinstance(self.stroke, tuple) else (self.stroke,)

    @property
    def throw_masses(self) -> tuple[float, ...]:
        """Mass of every throw, or a single mass for all throws, kg."""
        return self.throw_mass if isinstance(self.throw_mass, tuple) else (self.throw_mass,)


class Pendulum(FileTable):
    """A pendulum test: the rod swings about one of its bores."""

    pivot: Annotated[str, OneOf("small_end", "big_end")]
    """The bore about whose centre the rod swings. Example: 'small_end'"""
    period: Annotated[float, Number(TIME, above=0, most=1e6)]
    """Time of one full swing, there and back. Example: 0.82"""


class RodKeys(FileTable):
    """Keys that every kind of rod has."""

    choices = (
        Choice((("length",), ("ratio",)), required=True),
        Choice((("mass", "cg"), ("small_end", "big_end")), complete=("small_end", "big_end")),
        Choice((("inertia",), ("pendulum",))),
    )

    length: Size | None = None
    """Distance between the bore centres. Example: 160"""
    ratio: RodRatio | None = None
    """Crank radius over rod length (lambda), instead of length. Example: 0.28"""
    mass: Mass | None = None
    """Mass of the whole rod with bolts, without bearing shells. Example: 0.6"""
    cg: Length | None = None
    """Distance from the big-end centre to the centre of mass. Example: 45"""
    small_end: Mass | None = None
    """Mass weighed at the small end, instead of mass and cg. Example: 0.17"""
    big_end: Mass | None = None
    """Mass weighed at the big end, instead of mass and cg. Example: 0.43"""
    inertia: Inertia | None = None
    """Moment of inertia about the centre of mass; left out: the rod counts as two masses at its
    ends. Example: 2300"""
    pendulum: Pendulum | None = None
    """A pendulum test, instead of inertia."""


class Rod(RodKeys):
    """The connecting rod of every cylinder."""

    choices = (RodKeys.choices[0]._replace(unless="motion"), *RodKeys.choices[1:])

    motion: Annotated[str, OneOf("exact", "harmonic")] = "exact"
    """Harmonic: the pistons have a sinusoidal motion, as with a Scotch yoke or a rod of infinite
    length; then length and ratio may be left out. Example: 'harmonic'"""

    def _check_motion(self) -> Iterator[str]:
        length = self.length is not None or self.ratio is not None
        if self.has("motion") and self.motion == "exact" and not length:
            yield from RodKeys.choices[0].mistakes(())


PISTON_PARTS = ("piston", "pin", "rings", "locks")  # keys of [piston], instead of its mass


class Piston(FileTable):
    """One piston with its rings, pin and locks: weighed together, or part by part."""

    choices = (Choice((("mass",), PISTON_PARTS), required=True, complete=True),)

    bore: Size | None = None
    """Cylinder bore. Example: 86"""
    rod_diameter: Distance = 0.0
    """Diameter of the piston rod, which passes through the cover of the crank end. Example: 70"""
    mass: Mass | None = None
    """Piston, pin, rings and locks together. Example: 0.5"""
    piston: Mass | None = None
    """The bare piston; all four parts together replace mass. Example: 0.36"""
    pin: Mass | None = None
    """Piston pin. Example: 0.1"""
    rings: Mass | None = None
    """All rings of one piston. Example: 0.036"""
    locks: Mass | None = None
    """Both locks (clips) of the pin. Example: 0.004"""
    skirt: Distance | None = None
    """Distance from the pin's axis to the piston edge nearest the crank; needed for the clearance
    of counterweights. Example: 38"""
    offset: Length = 0.0
    """Offset of the piston pin's path, positive towards the side to which the crank pin moves after
    top dead centre. Example: -1.6
    """


class Crosshead(FileTable):
    """Crosshead between piston rod and connecting rod, as in large engines."""

    mass: Mass = 0.0
    """Mass of each crosshead with piston rod and pin; it moves with the piston. Example: 2400"""


class Layout(FileTable):
    """Banks, rods on a throw, and firing."""

    choices = (Choice((("bank_angle",), ("banks",), ("radial",))),)

    bank_angle: Angle | None = None
    """Angle of a vee: its banks are at minus and plus half this angle. Example: 90"""
    banks: Angles | None = None
    """Angle of every bank. Example: [-90, 90]"""
    radial: Count | None = None
    """Number of banks of a radial, evenly spaced round the crank. Example: 9"""
    rows: Count | None = None
    """Number of rows of a radial, each on a throw of its own; left out: one row for each throw.
    Example: 2"""
    row_angle: Angle | None = None
    """Angle by which each row of a radial is turned from the row before it; left out: if rows
    is given, the banks of all rows together are evenly spaced; if not, the rows are in line.
    Example: 25.714"""
    rods: Annotated[str, OneOf("shared", "alternating")] = "shared"
    """Shared: every throw carries one rod of each bank; alternating: every throw carries only one
    rod, and the throws belong to the banks in turn. Example: 'alternating'"""
    stagger: Length = 0.0
    """Axial distance between adjacent rods on a throw, first bank towards the free end. Example:
    22"""
    firing_order: Annotated[Numbers | None, FiringOrder()] = None
    """Numbers of the cylinders in the order in which they fire, or names with a letter for the bank
    and a number that counts along it (1R-6L-5R-2L). Example: [1, 3, 4, 2]"""
    firing_intervals: Intervals | None = None
    """Angle from each firing to the next; left out: they follow from crank.throws, and without
    crank.throws they are equal. Example: [405, 315]
    """
    rotary: Switch = False
    """Whether the crank stands still and the cylinders turn about it. Example: true"""
    strokes: Annotated[int, OneOf(2, 4)] = 4
    """Strokes of a cycle: 2 or 4. Example: 4"""
    numbering: NumbersOfBanks | None = None
    """Cylinder numbers of each bank, free end to flywheel end; in a radial in rows, numbers of each
    row in the direction of rotation. Example: [[1, 3], [2, 4]]"""

    @property
    def in_rows(self) -> bool:
        """Whether `numbering` lists rows of a radial, because `rows` or `row_angle` is given."""
        return self.rows is not None or self.row_angle is not None

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
        intervals = self.firing_intervals
        order = self.firing_order
        cycle = 180 * self.strokes
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


class Bobweight(FileTable):
    """Masses that turn with a crank pin in addition to rod and throw."""

    choices = (Choice((("oil",), ("oil_per_pin",))),)

    rod_bearing: Mass = 0.0
    """Big-end bearing shells of one rod. Example: 0.047"""
    oil: Mass = 0.0
    """Allowance for oil, for each rod. Example: 0.004"""
    oil_per_pin: Mass | None = None
    """Allowance for oil of a whole crank pin, instead of oil; the rods on the pin share it equally.
    Example: 0.005"""


class Ripple(FileTable):
    """One order of the uneven crank speed: mean speed times amplitude * cos(order * theta -
    angle).
    """

    order: Annotated[float, Whole(least=0.5, most=HIGHEST_RIPPLE_ORDER, halves=True)]
    """Oscillations per turn of the crank. Example: 4"""
    amplitude: Share
    """Amplitude as a share of the mean speed. Example: 0.01"""
    angle: Angle = 0.0
    """Phase: the speed is largest at crank angle = angle / order. Example: 0"""


class Operation(FileTable):
    """Speed and power of the engine."""

    speed: Speed = 1000.0
    """Crank speed; if it is uneven, its mean over the crank angle. Example: 3000"""
    power: Annotated[float, Number(POWER, above=0, most=1e9)] | None = None
    """Brake power at this speed, needed for the power related unbalance. Example: 3820"""
    speed_ripple: Annotated[tuple[Ripple, ...], Field(max_length=MOST_RIPPLES)] = ()
    """Uneven crank speed by orders: whole orders, and half orders of a four-stroke engine."""


class Frame(FileTable):
    """The frame of the engine."""

    reference: Triple | None = None
    """x, y, z of the point about which all moments are taken; left out: the point on the crank
    axis half-way between the outermost throws (a throw stands in the middle of its rods).
    Example: [0, 0, 0]"""
    up: Angle | None = None
    """Upward direction on the test bed, as an angle from the x axis in the direction of rotation;
    left out: results name x and y instead of vertical and horizontal. Example: 0"""
    crankcase: Size | None = None
    """Radius of the free room around the crank axis, which limits new counterweights; left out:
    only the pistons limit them. Example: 85"""


class Override(FileTable):
    """Figures of a cylinder that differs from the others."""

    choices = (
        *(choice.for_overrides("rod_") for choice in Rod.choices),
        Choice((("heat",), ("indicator",))),
    )

    piston_mass: Mass | None = None
    """piston.mass of this cylinder. Example: 0.502"""
    crosshead_mass: Mass | None = None
    """crosshead.mass of this cylinder. Example: 2450"""
    piston_offset: Length | None = None
    """piston.offset of this cylinder. Example: 0.8"""
    rod_length: Size | None = None
    """rod.length of this cylinder. Example: 160"""
    rod_ratio: RodRatio | None = None
    """rod.ratio of this cylinder. Example: 0.28"""
    rod_mass: Mass | None = None
    """rod.mass of this cylinder. Example: 0.602"""
    rod_cg: Length | None = None
    """rod.cg of this cylinder. Example: 45"""
    rod_small_end: Mass | None = None
    """rod.small_end of this cylinder. Example: 0.17"""
    rod_big_end: Mass | None = None
    """rod.big_end of this cylinder. Example: 0.43"""
    rod_inertia: Inertia | None = None
    """rod.inertia of this cylinder. Example: 2300"""
    rod_pendulum: Pendulum | None = None
    """rod.pendulum of this cylinder."""
    gas: Annotated[float, Number(PLAIN, least=0, most=100)] | None = None
    """Factor by which the gas force of this cylinder is multiplied; 0: a misfire. Example: 0"""
    heat: Heat | None = None
    """gas.heat of this cylinder, for a computed cycle; 0: the cylinder compresses but does not
    burn. Example: 0"""
    indicator: Annotated[str, FileName()] | None = None
    """gas.indicator of this cylinder. Example: 'p_3.csv'"""
    bore: Size | None = None
    """piston.bore of this cylinder. Example: 240"""
    piston_rod_diameter: Distance | None = None
    """piston.rod_diameter of this cylinder. Example: 60"""
    stroke: Size | None = None
    """Stroke of this cylinder (twice the radius of its crank pin), if it differs from the stroke of
    its throw. Example: 85"""
    bank: Angle | None = None
    """Angle of this cylinder's axis. Example: 30"""
    throw: Angle | None = None
    """Angle of this cylinder's crank pin. Example: 120"""
    position: Length | None = None
    """Axial position of this cylinder. Example: 50"""


class Device(FileTable):
    """Keys of all devices: the unbalance, or mass and radius; and the axial position."""

    choices: ClassVar[tuple[Choice, ...]] = (
        Choice((("unbalance",), ("mass", "radius")), required=True, complete=True),
    )

    unbalance: Annotated[float, Number(UNBALANCE, most=1e24, word=FIT)] | None = None
    """Mass times radius; "fit": `balcli balance` computes the unbalance. Example: 9000"""
    mass: Mass | None = None
    """Mass, with radius, instead of unbalance. Example: 0.5"""
    radius: Distance | None = None
    """Radius of the centre of the mass, with mass, instead of unbalance. Example: 40"""
    position: Length = 0.0
    """Axial position (z). Example: 0"""

    @property
    def to_fit(self) -> bool:
        """Whether the unbalance is "fit", which means that `balcli balance` computes it."""
        return self.unbalance is not None and math.isnan(self.unbalance)


class Sector(FileTable):
    """A counterweight, or the eccentric of a shaft, as a sector of a disc; its middle is at the
    angle of the device. The shaft within the inner radius turns with an eccentric.
    """

    inner_radius: Distance = 0.0
    """Inner radius; for a shaft, the radius of its core. Example: 30"""
    outer_radius: Size
    """Outer radius. Example: 75"""
    opening: Annotated[float, Number(ANGLE, above=0, most=360)]
    """Full angle of the sector. Example: 140"""
    thickness: Size | None = None
    """Thickness (length along the shaft), instead of the unbalance; left out: it follows from the
    unbalance. Example: 18"""
    density: Density = 7.85
    """Density. Example: 7.85"""

    def _check_radii(self) -> Iterator[str]:
        yield from self.check_below("inner_radius", "outer_radius")


def check_sector(device: Device, sector: Sector | None) -> Iterator[str]:
    """Yield what is wrong with the sector of a device and the unbalance beside it."""
    if sector is None:
        return
    is_sized = device.unbalance is not None or device.mass is not None
    if is_sized == (sector.thickness is not None):
        has = "sector.thickness and an unbalance" if is_sized else "a sector without thickness"
        yield f"has {has}; give either sector.thickness or unbalance, the other follows"
    elif is_sized and sector.opening == 360:
        yield "has a sector with opening = 360, which has no unbalance; give less than 360"
    elif device.unbalance is not None and device.unbalance < 0:
        yield f"has a sector and unbalance = {device.unbalance:g} < 0; turn its angle by 180 deg"


class Counterweight(Device):
    """An unbalance fixed to the crankshaft."""

    choices = (
        Device.choices[0]._replace(instead=("sector",)),
        Choice((("inertia",), ("sector",))),
    )

    angle: Angle = 0.0
    """Angle from cylinder 1's crank pin to the counterweight. Example: 180"""
    engine: Annotated[str, Label()] | None = None
    """With [[engine]]: engine whose crank carries the counterweight; left out: the first engine.
    Example: 'lower'"""
    axle: Name | None = None
    """Axle of a locomotive that carries the counterweight; left out: the driving axle. Example:
    'leading'"""
    inertia: Inertia = 0.0
    """Polar moment of inertia about the crank axis, for an uneven speed; not used if crank.inertia
    is given, which includes the counterweights. Example: 2600"""
    sector: Sector | None = None
    """Shape of the counterweight as a sector; give its thickness, or the unbalance, not both."""

    def _check_sector(self) -> Iterator[str]:
        yield from check_sector(self, self.sector)


class Gear(FileTable):
    """The gear that drives a balancer shaft."""

    position: Length
    """Axial position (z). Example: -150"""
    radius: Size
    """Pitch radius. Example: 35"""
    direction: Angle
    """Direction from the shaft's axis to the mesh, measured from the x axis. Example: 90"""
    pressure_angle: Annotated[float, Number(ANGLE, least=0, below=90)] = 20.0
    """Pressure angle. Example: 20"""


class Shaft(Device):
    """A balancer shaft, or one of several eccentrics on it. inertia, bearings, gear and drag belong
    to the whole shaft; give each in one of its entries.
    """

    choices = (
        Device.choices[0]._replace(instead=("inertia", "sector")),
        Choice((("inertia",), ("sector",))),
    )
    by_number: ClassVar[bool] = True

    name: Name = ""
    """Name of the shaft: entries with the same name are eccentrics of one shaft. Example:
    'left'"""
    ratio: Annotated[float, SpeedRatio(HIGHEST_SHAFT_ORDER)]
    """Speed over crank speed; negative: against the crank. Shafts at multiples of 1/2 (camshafts,
    pumps) have a fixed phase to the crank; others (belts) are listed separately. Example: -2"""
    angle: Angle = 0.0
    """Angle of the eccentric at crank angle 0, from the x axis. Example: 90"""
    at: Place = (0.0, 0.0)
    """x, y of the shaft. Example: [-40, 60]"""
    role: Annotated[str, OneOf("balancer", "compensator")] = "balancer"
    """Compensator: a shaft far from the engine, used for the moment of its force about the engine;
    the force itself is meant to remain. Example: 'balancer'"""
    inertia: Inertia = 0.0
    """Polar moment of inertia about the shaft's own axis, for an uneven speed and for sizing the
    flywheel; the sectors of a shaft give it instead. Example: 150"""
    sector: Sector | None = None
    """Shape of the eccentric as a sector on the core of the shaft; give its thickness, or the
    unbalance, not both."""
    bearings: Place | None = None
    """Axial positions (z) of the shaft's two bearings. Example: [-130, 130]"""
    gear: Gear | None = None
    """The gear that drives the shaft."""
    drag: Annotated[float, Number(TORQUE, least=0, most=1e12)] = 0.0
    """Friction torque on the shaft, which its gear transmits. Example: 0.2"""

    @property
    def drifts(self) -> bool:
        """Whether the shaft has no fixed phase to the crank: its ratio is no multiple of 1/2."""
        return 2 * self.ratio % 1 != 0

    def _check_sector(self) -> Iterator[str]:
        yield from check_sector(self, self.sector)

    def _check_bearings(self) -> Iterator[str]:
        if self.bearings is not None and self.bearings[0] == self.bearings[1]:
            yield f"bearings are both at {self.bearings[0]:g} mm; give two different places"


class Slider(Device):
    """A reciprocating balance mass."""

    order: Count
    """Oscillations per turn of the crank. Example: 2"""
    direction: Angle
    """Direction of the mass's path, from the x axis. Example: 90"""
    angle: Angle = 0.0
    """Phase: the displacement is proportional to cos(order * theta + angle), with theta the crank
    angle. Example: 180"""
    at: Place = (0.0, 0.0)
    """x, y of the middle of the mass's path. Example: [0, 0]"""


class EngineFile(FileTable):
    """One engine: crank, rods, pistons, layout, and the devices that balance it."""

    name: str = ""
    """Name of the engine. Example: 'in-line four'"""
    source: str = ""
    """Where the figures come from, and which figures are assumed. Example: 'weighed, May 2024'"""
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
    locomotive: "Locomotive | None" = None
    check: "Check | None" = None
    cylinder: dict[int, Override] = {}  # noqa: RUF012 - pydantic copies it
    """Figures of cylinders that differ from the others, by cylinder number."""
    counterweight: tuple[Counterweight, ...] = ()
    """Unbalances fixed to the crankshaft."""
    shaft: tuple[Shaft, ...] = ()
    """Balancer shafts."""
    slider: tuple[Slider, ...] = ()
    """Reciprocating balance masses."""
    engine: "tuple[Engine, ...]" = ()
    """Several engines that are geared together."""
    body: "Body | None" = None
    mount: "tuple[Mount, ...]" = ()
    """Mounts of the body."""
    point: "tuple[Point, ...]" = ()
    """Points whose motion is wanted."""
    axle: "tuple[Axle, ...]" = ()
    """Coupled axles of a locomotive."""
    web: "tuple[Web, ...]" = ()
    """Webs of the crankshaft."""

    _folder: Path = PrivateAttr(Path())
    _cranks: tuple["EngineFile", ...] = PrivateAttr(())

    @property
    def folder(self) -> Path:
        """Folder of the file and of the files that it names."""
        return self._folder

    @property
    def cranks(self) -> "tuple[EngineFile, ...]":
        """Files of the engines that are geared together; for an ordinary file, the file itself."""
        return self._cranks or (self,)

    def with_cranks(self, cranks: Sequence["EngineFile"]) -> Self:
        """Return a copy of this file with the engine files that its [[engine]] tables name."""
        copy = self.model_copy()
        copy._cranks = tuple(cranks)
        return copy

    @property
    def crank_names(self) -> tuple[str, ...]:
        """Names of the engines in [[engine]]; an engine without a name is called A, B and so on."""
        return tuple(one.name or chr(ord("A") + k) for k, one in enumerate(self.engine))

    @property
    def has_gas(self) -> bool:
        """Whether the engine, or at least one of the engines geared together, has [gas]."""
        return any(crank.gas is not None for crank in self.cranks)

    def with_table(self, key: str, **values: object) -> Self:
        """Return a copy of this file with other values in one table; the values are not checked."""
        table: FileTable = getattr(self, key)
        return self.model_copy(update={key: table.model_copy(update=values)})

    def with_inferred(self, key: str, **values: object) -> Self:
        """Return a copy of this file with inferred values in one table. A key that the file does
        not give still counts as not given, and is not written to files.
        """
        table: FileTable = getattr(self, key)
        changed = table.model_copy(update=values)
        changed.model_fields_set.intersection_update(table.model_fields_set)
        return self.model_copy(update={key: changed})

    def tables(self) -> Iterator[tuple[str, FileTable]]:
        """Yield every table that the file has or that has defaults, with its dotted name (`crank`,
        `shaft.1`, `mount.left`); tables within tables are omitted.
        """
        for name, part in self:
            if isinstance(part, FileTable):
                yield name, part
            elif isinstance(part, tuple):
                for number, table in enumerate(part, 1):
                    yield f"{name}.{label_table(table, number)}", table
            elif isinstance(part, dict):
                yield from ((f"{name}.{number}", table) for number, table in part.items())


class ArticulatedRod(RodKeys):
    """An articulated rod, from its knuckle pin (its big end) to its piston pin."""

    length: Size | None = None
    """Distance from the knuckle pin to the piston pin. Example: 200"""
    cg: Length | None = None
    """Distance of the centre of mass from the knuckle pin. Example: 100"""
    big_end: Mass | None = None
    """Mass weighed at the knuckle pin, instead of mass and cg. Example: 0.3"""


class Articulation(FileTable):
    """A radial engine with a master rod, to which the other rods are hinged."""

    master: Annotated[int | tuple[int, ...], OneOrEach(Whole(least=1, most=MOST_LIST_VALUES))] = 1
    """Number of the bank that carries the master rod; in a radial in rows, place of the master rod
    in its row. A list has a number for each row. Example: 1"""
    knuckle_radius: Size
    """Distance from the crank pin to the knuckle pins. Example: 55"""
    knuckle_angles: AnglesOfRows | None = None
    """Angle of each bank's knuckle pin from the master rod's axis (0 for the master's own bank), or
    a list of these angles for each row; left out: the angles of the banks from the master's bank.
    Example: [0, 72, 144, 216, 288]"""
    rod: ArticulatedRod
    """The articulated rods."""

    @property
    def masters(self) -> tuple[int, ...]:
        """Values of `master`: a number for each row, or a single number for all rows."""
        return self.master if isinstance(self.master, tuple) else (self.master,)

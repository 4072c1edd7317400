"""Define `Engine`, from which all results are computed: arrays in SI units, with a row for each
cylinder. `engine.build` makes it from an engine file.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, NamedTuple, Self, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from ..core.cylinders import Cylinders, Device, DeviceKind, find_travel
from ..core.phases import RPM
from ..core.phasors import Array, Complex, Figure, Phasors, unit
from ..core.records import HIDDEN, Node, WrittenAs
from ..core.speed_ripple import RippleLine
from ..errors import MOMENTS_UNKNOWN, BalcliError, wrong_type
from ..file.assumed import Assumed, join_assumed, select_assumed
from ..file.doubt import Doubt, name_files
from ..file.doubts import doubt_drifting, find_suspicious
from ..file.fields import join_words
from ..file.model import EngineFile
from ..file.plain_tables import list_tables
from .clearance import THROW_IN_BORES, SweptCylinder, doubt_clearances
from .figures import find_first_largest, or_zero, place_in_plane
from .firing.fits import find_fitting_splay
from .numbering import doubt_firing
from .rods import CylinderMasses

if TYPE_CHECKING:
    from .gas import EngineGas
    from .webs.build import Webs


CylinderNumber: TypeAlias = int | str  # 3, or "upper.3" with the name of a geared engine


class Bearings(NamedTuple):
    """Bearings of the crankshaft; None where the file gives none.

    Attributes:
        pin_m2: Projected area (diameter times width) of each crank pin's bearing, m2.
        main_m2: Projected area of each main bearing, m2.
        pin_m, main_m: Outer and inner diameter of each crank pin and of each main journal, m.
        main_positions_m: Positions of the main bearings along the crank, m, ascending.
    """

    pin_m2: float | None = None
    main_m2: float | None = None
    pin_m: tuple[float, float] | None = None
    main_m: tuple[float, float] | None = None
    main_positions_m: tuple[float, ...] | None = None


class Rating(NamedTuple):
    """Speed of the file, rpm, and brake power at this speed, W; None where the file gives none."""

    speed_rpm: float
    power_W: float | None = None


class TurningInertia(NamedTuple):
    """Constant inertia of turning parts, referred to the crank speed, kg m2.

    Attributes:
        momentum: Angular momentum at a crank speed of 1 rad/s: `J + sum k J_s` with the inertia J
            of crankshaft and flywheel, and the ratio k and the inertia J_s of each shaft.
        energy: Twice the kinetic energy at a crank speed of 1 rad/s: `J + sum k^2 J_s`.
    """

    momentum: Figure
    energy: Figure


class SilentCylinders(NamedTuple):
    """Numbers of the cylinders that do not fire.

    Attributes:
        without_gas: Cylinders without any gas force, not even that of compression.
        without_burning: Cylinders that compress and expand their charge, but burn nothing.
    """

    without_gas: tuple[CylinderNumber, ...] = ()
    without_burning: tuple[CylinderNumber, ...] = ()


def place_in_mm(place_m: Iterable[Figure]) -> tuple[float, ...]:
    """Return the coordinates of a place in mm, from those in m."""
    return tuple(1e3 * float(v) for v in place_m)


def as_number(figure: Figure) -> float:
    """Return a figure that does not vary as a plain number."""
    return float(figure)


class Placed(NamedTuple):
    """One of several engines that are geared together one to one, and its place among them. All
    these engines together are called "the whole".

    Attributes:
        engine: The engine alone, in its own axes, by its own crank angle and direction of rotation.
        name: Name of the engine in the file.
        file: Path of its engine file.
        ratio: 1: its crank turns in the direction of the first engine's crank. -1: its crank turns
            in the opposite direction, and the engine is mirrored in y.
        phase_deg: Crank angle by which it leads the first engine, in its own direction of rotation.
        turn_deg: Angle by which it is turned about z.
        at_m: Place of its origin (its crank axis at its z = 0), in the axes of the whole.
        load: Whether its crank drives the load.
        load_sense: `ratio` of the engine whose crank passes this engine's torque on to the load:
            the engine that drives the load, or this engine if each engine has its own load.
    """

    engine: Annotated[Engine, HIDDEN]
    name: str = ""
    file: str = ""
    ratio: int = 1
    phase_deg: Annotated[Figure, WrittenAs(as_number)] = 0.0
    turn_deg: Annotated[Figure, WrittenAs(as_number)] = 0.0
    at_m: Annotated[tuple[Figure, ...], WrittenAs(place_in_mm, "at_mm")] = (0.0, 0.0, 0.0)
    load: bool = True
    load_sense: Annotated[int, HIDDEN] = 1

    def turn(self, vector: complex | Complex) -> Complex:
        """Return a vector in the axes of the whole, from one in this engine's own axes."""
        return unit(self.turn_deg) * (vector if self.ratio > 0 else np.conj(vector))

    def find_own_unbalance(self, seen: complex) -> complex:
        """Return an unbalance on this engine's crank, kg m, in its own axes at its crank angle 0.
        `seen` is the unbalance in the axes of the whole at crank angle 0 of the first engine.
        """
        return complex(np.conj(unit(self.phase_deg)) * self.turn_back(seen))

    def turn_back(self, vector: complex | Complex) -> Complex:
        """Return a vector in this engine's own axes, from one in the axes of the whole."""
        back: Complex = np.conj(unit(self.turn_deg)) * vector
        return back if self.ratio > 0 else np.conj(back)

    def turn_axial(self, vector: complex | Complex) -> Complex:
        """Return a moment in the axes of the whole, from one in this engine's own axes. Mirroring
        the engine also changes the sign of a moment.
        """
        return self.ratio * self.turn(vector)

    def find_place(self, own: complex | Complex) -> Complex:
        """Return a point x + iy in the axes of the whole, m, from one in the engine's own axes."""
        return self.turn(own) + place_in_plane(*self.at_m[:2])

    def find_device(self, own: Device) -> Device:
        """Return a device in the axes of the whole, by the crank angle of the first engine.
        `own` is the device in this engine's own axes, by this engine's crank angle.
        """
        lead = unit(own.order * self.phase_deg)
        forward = lead * own.forward
        backward = np.conj(lead) * own.backward
        if self.ratio < 0:  # a mirrored vector turns the other way
            forward, backward = backward, forward
        return own._replace(
            forward=self.turn(forward),
            backward=self.turn(backward),
            place=self.find_place(own.place),
            z=own.z + self.at_m[2],
        )

    def find_own_place(self, place: complex | Complex) -> Complex:
        """Return a point x + iy in the engine's own axes, m, from one in the axes of the whole."""
        return self.turn_back(place - place_in_plane(*self.at_m[:2]))

    @property
    def swept(self) -> SweptCylinder:
        """Cylinder that its throws sweep, in the axes of the whole; no figure may vary."""
        x, y, z = (float(place) for place in self.at_m)
        throws = z + np.ravel(self.engine.throws_m)
        bore = float(np.nan_to_num(self.engine.bore_m))  # nan if the file gives none
        side = THROW_IN_BORES * bore / 2
        return SweptCylinder(
            axis_m=complex(x, y),
            radius_m=float(np.max(self.engine.throw_radii_m)),
            start_m=float(throws.min()) - side,
            end_m=float(throws.max()) + side,
        )


NONE_SILENT = SilentCylinders()


class ThrowShare(NamedTuple):
    """Share of a cylinder in the unbalanced mass of its throw.

    Attributes:
        mass: Mass at the crank radius, kg.
        is_whole: Whether it has the cheeks as well; otherwise it is that of the crank pin alone.
    """

    mass: float
    is_whole: bool


_ONE_PLACE = 1e-9  # m; throws that are closer have the same position


@dataclass(frozen=True, eq=False, repr=False)
class Engine:
    """An engine, or variants of one, in SI units unless a name ends in another unit.

    An array of a figure that varies has the axes of the variants as its last axes ("trailing axes",
    `*trailing` in shapes); all figures of an engine broadcast against each other.

    Attributes:
        name: Name in the file; may be empty.
        source: Source of the figures; may be empty.
        numbers: Cylinder number of each row of `cylinders`.
        cylinders: Geometry and masses, one row for each cylinder, sorted by bank, with the trailing
            axes of the variants.
        fires_deg: Crank angle from the first firing to the firing of each cylinder, by cylinder
            number, in the firing order; empty without a firing order.
        strokes: 2 or 4.
        bore_m: Cylinder bore; nan where the file gives none.
        bores_m: Bore of each cylinder; empty if all have `bore_m`.
        throws_m: Position of each throw along the crank (the middle of its rods), shape (throws,
            *trailing).
        throw_radii_m: Crank radius of each throw, same shape.
        pins_m: Position of each throw as [crank] gives it, same shape; `throws_m` if [crank] gives
            no positions.
        speed_rpm: Mean crank speed.
        ripple: Orders of the uneven speed; empty for a steady speed.
        reference_m: x, y, z of the point about which moments are taken.
        webs: Webs and pins of the crankshaft; None for a file without [[web]].
        up_deg: Direction that points up, deg from x; None where the file gives none.
        devices: Counterweights, shafts and sliders of the file, in this order.
        weighed: Masses of piston, rod and throw for each row of `cylinders`.
        places_known: Whether the file gives the positions of its throws along the crank. If not,
            all throws are in one plane, and moments have no meaning.
        gas: Gas in the cylinders at this speed; None where the file has no [gas], and for arrays of
            variants.
        gas_of_variants: Function that returns the gas torque of variants, N m, for orders of shape
            (orders,); None except in sweeps.
        crank_inertia: Polar moment of inertia of the crankshaft with throws and counterweights,
            kg m2; None if the file gives none.
        flywheel_inertia: Polar moment of inertia of the flywheel, kg m2; None if the file has none.
        bearings: Bearings of the crankshaft; None if the file gives none.
        rated: Speed of the file, and brake power at this speed.
        inferred: Values used for keys that the file leaves out and on which results depend.
        model: Engine file; None if no file describes this engine.
        of_locomotive: Whether its file describes a locomotive. Its balance weights are in the
            wheels, and no balancer shaft can be fitted.
        placed: The engines that are geared together, if this engine is the whole of them;
            `cylinders` and all figures derived from `cylinders` are then those of the first engine.
            Empty for a single engine.
    """

    name: str
    source: str
    numbers: tuple[CylinderNumber, ...]
    cylinders: Cylinders
    fires_deg: Mapping[int, Figure]
    strokes: int
    bore_m: Figure
    bores_m: tuple[Figure, ...]
    throws_m: Array
    throw_radii_m: Array
    pins_m: Array
    speed_rpm: Figure
    ripple: tuple[RippleLine, ...]
    reference_m: tuple[Figure, Figure, Figure]
    devices: tuple[Device, ...]
    weighed: tuple[CylinderMasses, ...]
    places_known: bool = True
    gas: EngineGas | None = None
    gas_of_variants: Callable[[Array], Phasors] | None = None
    crank_inertia: Figure | None = None
    flywheel_inertia: Figure | None = None
    bearings: Bearings | None = None
    rated: Rating | None = None
    webs: Webs | None = None
    up_deg: float | None = None
    inferred: tuple[Assumed, ...] = ()
    model: EngineFile | None = None
    of_locomotive: bool = False
    placed: tuple[Placed, ...] = ()

    @classmethod
    def of(cls, engine: Engine) -> Self:
        """Return an engine of this class with the figures of another engine."""
        return cls(**{each.name: getattr(engine, each.name) for each in fields(engine)})

    # -------------------------------------------------------------- the file and its variants
    def at_speed(self, speed: Figure) -> Self:
        """Return the engine at another speed (rpm), with the gas of that speed."""
        gas = None if self.gas is None else self.gas.at(float(speed))
        return replace(self, speed_rpm=speed, gas=gas)

    def to_dict(self) -> Node:
        """Return the tables of the engine file, with numbers in mm, kg, degrees and rpm; `load`
        makes the same engine from them.

        Raises:
            BalcliError: No file describes this engine.
        """
        return list_tables(take_model(self))

    @property
    def doubts(self) -> tuple[Doubt, ...]:
        """Warnings of unlikely figures in the file, of missing positions, and of a speed for which
        the file does not give the gas.
        """
        unknown = () if self.places_known else (Doubt("crank.spacing", MOMENTS_UNKNOWN),)
        return (*unknown, *self.unlikely, *self.doubt_speeds(self.speed_rpm))

    @property
    def unlikely(self) -> tuple[Doubt, ...]:
        """Warnings of figures in the file that are allowed but unlikely."""
        if self.placed:
            of_files = name_files((one.file, one.engine.unlikely) for one in self.placed)
            if self.model is None:
                return of_files
            return (*of_files, *doubt_drifting(self.model), *self.doubt_clearances())
        of_gas = () if self.gas is None else self.gas.doubts
        if self.model is None:
            return of_gas
        of_file = *find_suspicious(self.model), *doubt_firing(self.model)
        return (*of_file, *self._doubt_webs(self.model), *of_gas)

    def _doubt_webs(self, model: EngineFile) -> Iterator[Doubt]:
        """Yield warnings of webs that overlap main bearings."""
        if self.webs is not None:
            from .webs.overlap import doubt_overlaps  # loaded only for files with [[web]]

            yield from doubt_overlaps(self.webs, model.bearing)

    def doubt_clearances(self) -> Iterator[Doubt]:
        """Yield warnings of geared engines whose cranks would strike each other."""
        yield from doubt_clearances([one.swept for one in self.placed])

    def doubt_speeds(self, speeds_rpm: ArrayLike) -> tuple[Doubt, ...]:
        """Return warnings if the file does not give the gas at some of these speeds (rpm)."""
        if self.placed:
            of_files = ((one.file, one.engine.doubt_speeds(speeds_rpm)) for one in self.cranks)
            return name_files(of_files)
        law = None if self.gas is None else self.gas.law
        return () if law is None else tuple(law.list_doubts(speeds_rpm))

    @property
    def speed_assumed(self) -> bool:
        """Whether the speed is the default, given neither by the file nor by a change."""
        if self.model is None or "speed" in self.model.operation.model_fields_set:
            return False
        return float(self.speed_rpm) == self.model.operation.speed

    def list_assumed(
        self, *chapters: str, without: Collection[str] = ()
    ) -> tuple[Assumed, ...] | None:
        """Return the values of `inferred` on which results depend; None if there are none.

        Args:
            chapters: Tables on which the results depend, besides those that describe every engine:
                gas, torsion, body, mount, flywheel.
            without: Keys to omit.
        """
        if self.placed:
            names = [one.name for one in self.cranks]
            lists = [one.engine.list_assumed(*chapters, without=without) for one in self.cranks]
            return join_assumed(names, lists) or None
        chapters = (*chapters, "flywheel") if self.ripple else chapters
        given = () if self.speed_assumed else ("operation.speed",)
        steady = () if self.ripple or "flywheel" in chapters else ("crank.inertia",)
        return select_assumed(self.inferred, chapters, {*given, *steady, *without}) or None

    # -------------------------------------------------------------- in words
    def __repr__(self) -> str:
        return f"<Engine {self.summary}>"

    @property
    def summary(self) -> str:
        """Name, number of cylinders, displacement and speed, in words."""
        words = [f"{len(self.numbers)} cylinder{'s' * (len(self.numbers) != 1)}"]
        volume = self.displacement_m3
        if isinstance(volume, float) and not math.isnan(volume):
            words.append(f"{volume * 1e3:.4g} L")
        if isinstance(self.speed_rpm, float):
            words.append(f"{self.speed_rpm:g} rpm")
        return f'"{self.name}": {", ".join(words)}' if self.name else ", ".join(words)

    # -------------------------------------------------------------- several cranks
    @cached_property
    def cranks(self) -> tuple[Placed, ...]:
        """Engines that are geared together, each in its own axes and by its own crank angle, with
        the speed, devices and point of reference of the whole. For a single engine, this engine.
        """
        return tuple(_share_state(self)) if self.placed else (Placed(self),)

    @property
    def every_device(self) -> tuple[Device, ...]:
        """Devices of all engines and of the whole, in the axes of the whole."""
        return tuple(one.find_device(own) for one in self.cranks for own in one.engine.devices)

    # -------------------------------------------------------------- motion
    @property
    def omega(self) -> Figure:
        """Mean crank speed, rad/s."""
        return self.speed_rpm * RPM

    @property
    def cycle_revolutions(self) -> int:
        """Number of revolutions after which the forces repeat, gas and devices included."""
        orders = [
            *(line.order for line in self.ripple),
            *(each.order for each in self.every_device),
        ]
        half_orders = any(order % 1 for order in orders)
        return 2 if half_orders or (self.gas is not None and self.strokes == 4) else 1

    def find_turning_inertia(self, *, beyond_pins: bool = False) -> TurningInertia:
        """Return the inertia of all parts that turn in a constant ratio to the crank: crankshaft,
        flywheel and shafts; without `crank.inertia`, also the counterweights. The crankshaft of a
        rotary engine stands still and is left out.

        Args:
            beyond_pins: Whether to subtract the throw masses from `crank.inertia`, because the
                caller counts them with the pins.
        """
        if self.placed:
            each = [one.engine.find_turning_inertia(beyond_pins=beyond_pins) for one in self.cranks]
            momenta = (one.ratio * own.momentum for one, own in zip(self.cranks, each, strict=True))
            return TurningInertia(sum(momenta), sum(own.energy for own in each))
        crank = None if self.rotary else self.crank_inertia
        on_crank = or_zero(crank) + or_zero(self.flywheel_inertia)
        if beyond_pins and crank is not None:
            radii = zip(self.weighed, self.cylinders.radius_of_each, strict=True)
            on_crank = on_crank - sum(masses.share * radius**2 for masses, radius in radii)
        momentum = on_crank
        energy = on_crank
        for device in self.devices:
            if device.kind is DeviceKind.SHAFT or crank is None:
                momentum = momentum + device.spin
                energy = energy + np.abs(device.spin) * device.order
        return TurningInertia(momentum, energy)

    def find_constant_inertia(self) -> float | None:
        """Return the moment of inertia of all parts that turn in a constant ratio to the crank,
        referred to the crank, kg m2; None if the file gives no such inertia.
        """
        crank = None if self.rotary else self.crank_inertia
        inertia = float(self.find_turning_inertia().energy)
        is_given = inertia or crank is not None or self.flywheel_inertia is not None
        return inertia if is_given else None

    # -------------------------------------------------------------- cylinders and crank pins
    def find_radius(self, z_m: float) -> float:
        """Return the crank radius, m, of the throw nearest to a plane; of equally near throws, the
        radius of the first.

        Args:
            z_m: Position of the plane along the crank, m.
        """
        near = find_first_largest(-np.abs(np.ravel(self.throws_m) - z_m))
        return float(np.ravel(self.throw_radii_m)[near])

    @property
    def is_pump(self) -> bool:
        """Whether any cylinder compresses, or has gas at its crank end."""
        return self.gas is not None and self.gas.has_pump_ends

    @property
    def compressing(self) -> list[CylinderNumber]:
        """Numbers of the cylinders with a compressor cycle."""
        if self.gas is None:
            return []
        pairs = zip(self.numbers, self.gas.cylinders, strict=True)
        return [number for number, cylinder in pairs if cylinder.compresses]

    @property
    def displacement_m3(self) -> Figure:
        """Swept volume, m3, of all cylinders except dummies, which the firing order leaves out."""
        if self.placed:
            return sum(one.engine.displacement_m3 for one in self.placed)
        stroke = find_travel(self.cylinders).stroke
        works = {*self.fires_deg, *self.compressing}
        burning = [row for row, n in enumerate(self.numbers) if not self.fires_deg or n in works]
        if self.bores_m:
            return sum(math.pi / 4 * self.bores_m[row] ** 2 * stroke[row] for row in burning)
        volume: Array = math.pi / 4 * self.bore_m**2 * stroke[burning].sum(axis=0)
        return volume if volume.ndim else float(volume)

    @property
    def rotary(self) -> bool:
        """Whether the cylinders turn about a crank at rest. `cylinders.linkage` then has all their
        masses.
        """
        c = self.cylinders
        return c.linkage is not None and c.linkage.turning and not self.placed

    @property
    def equal(self) -> bool:
        """Whether all cylinders have the same mechanism and reciprocating masses."""
        c = self.cylinders
        return len(c.radius) == len(c.lam) == len(c.eps) == len(c.reciprocating) == 1 and (
            c.linkage is None or len(c.linkage.mass) == 1
        )

    @property
    def rising_numbers(self) -> list[CylinderNumber]:
        """Numbers of the cylinders, rising; for geared engines, one engine after the other."""
        if not self.placed:
            return sorted(self.numbers)
        each = ((one.name, sorted(one.engine.numbers)) for one in self.placed)
        return [f"{name}.{number}" for name, numbers in each for number in numbers]

    @property
    def first_axis_deg(self) -> Figure:
        """Angle of cylinder 1's axis, deg; its crank pin points along it at crank angle 0."""
        return self.cylinders.axis_deg[self.cylinders.first]

    @property
    def pins_deg(self) -> dict[CylinderNumber, Figure]:
        """Angle of each cylinder's crank pin from that of cylinder 1, deg, by cylinder number."""
        return dict(zip(self.numbers, self.cylinders.pin_deg, strict=True))

    @cached_property
    def joined_throws(self) -> tuple[tuple[int, ...], ...]:
        """Throws of the file (from 0), grouped into throws of the crank, from the free end on.

        Throws at the same angle form one throw of the crank if they have the same position, or if
        they are neighbours less than half a bore apart that carry rods of different banks (as in a
        file with a throw for each cylinder). Without known positions, every throw of the file is a
        throw of the crank, in the order of the file. If [crank] gives positions of throws, a
        cylinder's own position moves only its rod, not its throw.
        """
        c = self.cylinders
        z = np.ravel(self.pins_m).tolist()
        if self.rotary or self.placed or not self.places_known:
            return tuple((throw,) for throw in range(len(z)))
        turned = np.round(np.stack([np.ravel(c.pin_deg), np.ravel(c.axis_of_each_deg)]), 6) % 360
        pins: list[set[complex]] = [set() for _ in z]
        banks: list[set[float]] = [set() for _ in z]
        pin_of_row = (turned[0] + 1j * np.ravel(c.radius)).tolist()
        for masses, pin, bank in zip(self.weighed, pin_of_row, turned[1].tolist(), strict=True):
            pins[masses.throw].add(pin)
            banks[masses.throw].add(bank)
        joined: list[list[int]] = []
        first = [min(one.real for one in each) for each in pins]
        for throw in sorted(range(len(z)), key=lambda k: (round(z[k], 9), first[k], k)):
            before = joined[-1] if joined else []
            if before and pins[before[0]] == pins[throw]:
                apart = abs(z[throw] - z[before[-1]])
                same_bank = any(banks[throw] & banks[each] for each in before)
                if apart < _ONE_PLACE or (apart < self.bore_m / 2 and not same_bank):
                    before.append(throw)
                    continue
            joined.append([throw])
        return tuple(map(tuple, joined))

    @property
    def joined_throws_m(self) -> Array:
        """Position of each of the `joined_throws` (the middle of its rods), m, shape (throws,)."""
        places = np.ravel(self.throws_m)
        joined = self.joined_throws
        of_throw = np.repeat(np.arange(len(joined)), [len(throws) for throws in joined])
        throws = [throw for throws in joined for throw in throws]
        return np.asarray(np.bincount(of_throw, places[throws]) / np.bincount(of_throw))

    @property
    def joined_throw_of_rows(self) -> list[int]:
        """Index in `joined_throws` of the throw of each row of `cylinders`."""
        index = {throw: k for k, throws in enumerate(self.joined_throws) for throw in throws}
        return [index[masses.throw] for masses in self.weighed]

    def find_throw_share(self, row: int) -> ThrowShare:
        """Return the share of a cylinder in the unbalanced mass of its throw; with webs, in that of
        pin and cheeks.
        """
        own = self.weighed[row]
        mass = float(own.share)
        if self.webs is None:
            return ThrowShare(mass, is_whole=True)
        cheeks = self.webs.find_cheeks(own.throw)
        if cheeks is None:
            return ThrowShare(mass, is_whole=False)
        rods = sum(other.throw == own.throw for other in self.weighed)
        radius = float(self.cylinders.radius_of_each[row])
        return ThrowShare(mass + cheeks / radius / rods, is_whole=True)

    @property
    def rows_by_pin(self) -> list[list[int]]:
        """Rows of the cylinders on each crank pin, in the order of the throws. A split throw has
        several pins, in their order along the crank.
        """
        first = [self.joined_throws[k][0] for k in self.joined_throw_of_rows]
        rows = sorted(range(len(self.numbers)), key=self.numbers.__getitem__)
        pins: dict[tuple[int, float, float], list[int]] = {}
        for row in rows:
            radius = float(self.cylinders.radius_of_each[row])
            pin = first[row], float(self.cylinders.pin_deg[row]) % 360, radius
            pins.setdefault(pin, []).append(row)
        along = sorted(pins, key=lambda pin: (pin[0], float(self.cylinders.z[pins[pin]].min())))
        return [pins[pin] for pin in along]

    @property
    def splay_for_even_firing(self) -> float | None:
        """Value of `crank.splay` (deg) with which the cylinders fire evenly in the order of the
        file. None if there is no such value, for a single throw or articulated rods, or if the file
        gives firing intervals.
        """
        if self.model is None or self.model.layout.firing_intervals or len(self.throws_m) == 1:
            return None
        return find_fitting_splay(self.model)

    @property
    def has_given_bearings(self) -> bool:
        """Whether the file gives the positions of the main bearings."""
        return self.bearings is not None and self.bearings.main_positions_m is not None

    # -------------------------------------------------------------- gas
    @property
    def silent(self) -> SilentCylinders:
        """Cylinders that do not fire; none for an engine without [gas]."""
        if self.gas is None:
            return NONE_SILENT
        by_number = dict(zip(self.numbers, self.gas.cylinders, strict=True))
        gas_by_number = [(number, by_number[number]) for number in self.rising_numbers]
        return SilentCylinders(
            tuple(number for number, own in gas_by_number if not own.share),
            tuple(number for number, own in gas_by_number if own.share and own.heat == 0),
        )

    @property
    def mechanical_efficiency(self) -> float | None:
        """Brake work over indicated work; None if the file does not give it. Also None if some
        cylinders do not fire: their friction remains, so the efficiency in the file does not hold.
        """
        if self.gas is None or any(self.silent):
            return None
        return self.gas.mechanical_efficiency


# ------------------------------------------------------------------ engines of a whole
def _share_state(whole: Engine) -> Iterator[Placed]:
    """Yield the engines of a whole with its speed, devices, gas and point of reference, each in its
    own axes and by its own crank angle.
    """
    start = 0
    for row, placed in enumerate(whole.placed):
        own = placed.engine
        stop = start + len(placed.engine.numbers)
        x, y, z = whole.reference_m
        reference = placed.find_own_place(place_in_plane(x, y))
        lines = (
            RippleLine(line.order, line.amplitude, line.angle_deg + line.order * placed.phase_deg)
            for line in whole.ripple
        )
        carried = (_move(device, placed) for device in whole.devices if device.crank == row)
        gas = None if whole.gas is None else own.gas
        if gas is not None and whole.gas is not None:
            seen = (c._replace(like=c.like - start) for c in whole.gas.cylinders[start:stop])
            pairs = zip(seen, gas.cylinders, strict=True)  # `seen` is at the speed of the whole
            each = (c._replace(nominal_deg=mine.nominal_deg) for c, mine in pairs)
            gas = replace(gas, cylinders=tuple(each))
        yield placed._replace(
            engine=replace(
                own,
                speed_rpm=whole.speed_rpm,
                ripple=tuple(lines),
                reference_m=(reference.real, reference.imag, z - placed.at_m[2]),
                devices=(*own.devices, *carried),
                gas=gas,
            )
        )
        start = stop


def _move(device: Device, placed: Placed) -> Device:
    """Return a device of the whole in the axes of one engine. Devices that are not on a crankshaft
    belong to the first engine, by whose crank angle they turn.
    """
    moved = device._replace(z=device.z - placed.at_m[2], crank=0)
    if device.kind is DeviceKind.COUNTERWEIGHT:
        return moved
    back = unit(-np.asarray(placed.turn_deg))
    return moved._replace(
        place=placed.find_own_place(device.place),
        forward=back * device.forward,
        backward=back * device.backward,
    )


# ------------------------------------------------------------------ an engine as an argument
def check_engine(function: str, value: object) -> Engine:
    """Return the argument of a public function, checked to be an engine.

    Args:
        function: Name of the function, for the message.
        value: Argument of the function.

    Raises:
        TypeError: The value is not an engine.
    """
    if not isinstance(value, Engine):
        raise wrong_type(function, value, "give an Engine; load(...) makes one of a path or a dict")
    return value


def refuse_geared(subject: Engine | EngineFile) -> None:
    """Raise an error if engines are geared together, for results that cover only a single engine.

    Raises:
        BalcliError: The engine, or its file, joins several engines.
    """
    geared = subject.placed if isinstance(subject, Engine) else subject.engine
    if geared:
        files = list(dict.fromkeys(one.file or one.name for one in geared))
        if len(files) == 1:
            raise BalcliError(
                f"{len(geared)} engines of {files[0]} are geared together; run this on {files[0]}"
            )
        raise BalcliError(f"{join_words(files)} are geared together; run this on one of them")


def take_model(engine: Engine) -> EngineFile:
    """Return the engine file of an engine.

    Raises:
        BalcliError: No file describes this engine.
    """
    if engine.model is None:
        message = (
            "no file describes this engine, because it is a variant or has added devices; use "
        )
        raise BalcliError(f"{engine.summary}: {message}the engine from which it was made")
    return engine.model


def find_crank(engine: Engine, number: CylinderNumber) -> tuple[Placed, int]:
    """Return the engine that has a cylinder, and the row of the cylinder in the arrays of that
    engine; arguments and errors as for `find_row`.
    """
    row = find_row(engine, number)
    for crank in engine.cranks:
        if row < len(crank.engine.numbers):
            break
        row -= len(crank.engine.numbers)
    return crank, row


def find_row(engine: Engine, number: CylinderNumber) -> int:
    """Return the row of a cylinder in the arrays of its engine.

    Args:
        engine: Engine.
        number: Cylinder number.

    Raises:
        BalcliError: The engine has no such cylinder.
    """
    if number not in engine.numbers:
        name = engine.name or "the engine"
        numbers = engine.rising_numbers
        some = f"cylinders 1 to {numbers[-1]}" if len(numbers) > 1 else "only cylinder 1"
        if engine.placed:
            some = f"cylinders {', '.join(map(str, numbers))}"
        raise BalcliError(f"there is no cylinder {number}: {name} has {some}")
    return engine.numbers.index(number)

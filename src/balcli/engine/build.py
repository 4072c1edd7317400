"""Engine: what all computation needs of an engine file, in SI units, one row a cylinder."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..core.cylinders import Cylinders, Device, find_travel
from ..core.phases import RPM
from ..core.phasors import Array, Figure, Phasors
from ..core.speed_ripple import RippleLine
from ..errors import MOMENTS_UNKNOWN, BalcliError, InputError, check_type, naming_file, wrong_type
from ..file.doubts import find_suspicious
from ..file.model import EngineFile
from ..file.plain_tables import change_tables, list_tables
from ..names import NOTEBOOK, import_name
from .devices import build_devices
from .layout import are_places_known
from .numbering import doubt_firing, find_fitting_splay, list_inferred
from .parse import find_contradictions, parse_dict
from .parts import Parts
from .rods import Weighed

if TYPE_CHECKING:
    from ..file.gas_tables import Bearing, Flywheel
    from .gas import EngineGas


class Bearings(NamedTuple):
    """Diameter times width of each bearing, m2; None where the file does not say."""

    pin_m2: float | None = None
    main_m2: float | None = None


class SilentCylinders(NamedTuple):
    """Numbers of the cylinders of an engine that do not fire.

    Attributes:
        without_gas: no gas force, not even that of compression.
        without_burning: they compress, but burn nothing.
    """

    without_gas: tuple[int, ...] = ()
    without_burning: tuple[int, ...] = ()


NONE_SILENT = SilentCylinders()
_ONE_PLACE = 1e-9  # m


@dataclass(frozen=True, eq=False, repr=False)
class Engine:
    """An engine, or variants of one, in SI units except where a name says otherwise.

    A figure of variants is an array with their axes; all of an engine's broadcast against each
    other.

    Attributes:
        name: what the file calls it; may be empty.
        source: where its figures come from; may be empty.
        numbers: cylinder number of each row of `cylinders`.
        cylinders: geometry and masses, one row a cylinder, sorted by bank; their arrays have the
            trailing axes of the variants.
        fires_deg: crank angle at which each cylinder fires, after the first, by its number and in
            the firing order; empty where the file gives none.
        strokes: 2 or 4.
        bore_m: nan where the file gives none.
        throws_m: place of each throw along the crank, shape (throws, *trailing).
        speed_rpm: mean crank speed.
        ripple: lines of its uneven speed; empty for a steady one.
        reference_m: x, y, z of the point about which moments are taken.
        devices: counterweights, shafts and sliders of the file, in this order.
        weighed: masses behind each row of `cylinders`.
        places_known: whether the file says where its throws stand along the crank; if not, they
            count as standing in one plane, and what is said of moments means nothing.
        gas: what the gas does in the cylinders; None where the file does not say, and for arrays
            of variants.
        gas_of_variants: torque of the gas of variants on the crank by orders (orders,), N m; None
            where nobody may ask for it.
        crank_inertia: polar moment of inertia of the crankshaft with throws and counterweights, kg
            m2; None where the file gives none.
        flywheel_inertia: that of the flywheel, kg m2, likewise.
        bearings: of the crankshaft; None where the file gives none.
        inferred: keys that the file leaves out, with the values that are taken, where results
            depend on them (`layout.strokes = 4`).
        model: the file that says all this; None where no file says it.
    """

    name: str
    source: str
    numbers: tuple[int, ...]
    cylinders: Cylinders
    fires_deg: Mapping[int, Figure]
    strokes: int
    bore_m: Figure
    throws_m: Array
    speed_rpm: Figure
    ripple: tuple[RippleLine, ...]
    reference_m: tuple[Figure, Figure, Figure]
    devices: tuple[Device, ...]
    weighed: tuple[Weighed, ...]
    places_known: bool = True
    gas: EngineGas | None = None
    gas_of_variants: Callable[[Array], Phasors] | None = None
    crank_inertia: Figure | None = None
    flywheel_inertia: Figure | None = None
    bearings: Bearings | None = None
    inferred: tuple[str, ...] = ()
    model: EngineFile | None = None

    def vary(self, changes: Mapping[str, Any] = MappingProxyType({}), /, **named: Any) -> Engine:
        """The engine of the same file with other values of some of its keys.

        Args:
            changes, named: values by dotted names of the engine file (`layout.bank_angle`,
                `crank.throws.2`, `operation.speed`, `name`), in its units or with units of their
                own; None leaves a key out. What says the same otherwise (`rod.ratio` beside
                `rod.length`) is left out, and so is a firing order that given throws no longer fit.

        Raises:
            InputError: every mistake of the file as it would then be.
            BalcliError: no file says what this engine is.

        Example:
            >>> engine.vary({"layout.bank_angle": 60, "rod.length": "6 in"})
        """
        check_type("vary", changes, Mapping, 'give a dict, such as {"rod.length": 150}')
        return vary_engine(self, {**changes, **named})

    def to_dict(self) -> dict[str, Any]:
        """The tables of its file, from which `load` makes the same engine: numbers in mm, kg,
        degrees, rpm.

        Raises:
            BalcliError: no file says what this engine is.
        """
        return list_tables(take_model(self))

    def __repr__(self) -> str:
        return f"<Engine {self.summary}>"

    @property
    def doubts(self) -> tuple[str, ...]:
        """What its file says that is allowed and yet unlikely, in words; what is not known."""
        unknown = () if self.places_known else (MOMENTS_UNKNOWN,)
        return (*unknown, *self.unlikely)

    @property
    def unlikely(self) -> tuple[str, ...]:
        """What its file says that is allowed and yet unlikely, in words."""
        of_gas = () if self.gas is None else self.gas.doubts
        if self.model is None:
            return of_gas
        return (*find_suspicious(self.model), *doubt_firing(self.model), *of_gas)

    @property
    def summary(self) -> str:
        """What it is, in a few words."""
        words = [f"{len(self.numbers)} cylinder{'s' * (len(self.numbers) != 1)}"]
        volume = self.displacement_m3
        if isinstance(volume, float) and not math.isnan(volume):
            words.append(f"{volume * 1e3:.4g} L")
        if isinstance(self.speed_rpm, float):
            words.append(f"{self.speed_rpm:g} rpm")
        return f'"{self.name}": {", ".join(words)}' if self.name else ", ".join(words)

    def _repr_html_(self) -> str:
        return import_name(NOTEBOOK)(self)

    @property
    def speed_assumed(self) -> bool:
        """Whether neither its file nor anybody else says its speed."""
        if self.model is None or "speed" in self.model.operation.model_fields_set:
            return False
        return float(self.speed_rpm) == self.model.operation.speed

    @property
    def omega(self) -> Figure:
        """Mean crank speed, rad/s."""
        return self.speed_rpm * RPM

    @property
    def displacement_m3(self) -> Figure:
        """Swept volume of all cylinders but dummies, which the firing order leaves out."""
        stroke = find_travel(self.cylinders).stroke
        burning = [row for row, n in enumerate(self.numbers) if n in (self.fires_deg or {n})]
        volume: Array = math.pi / 4 * self.bore_m**2 * stroke[burning].sum(axis=0)
        return volume if volume.ndim else float(volume)

    @property
    def first_axis_deg(self) -> Figure:
        """Where cylinder 1's crank pin points at crank angle 0, along its axis."""
        return self.cylinders.axis_deg[self.cylinders.first]

    @property
    def equal(self) -> bool:
        """Whether all cylinders have one mechanism and one set of reciprocating masses."""
        c = self.cylinders
        return len(c.lam) == len(c.eps) == len(c.reciprocating) == 1 and (
            c.linkage is None or len(c.linkage.mass) == 1
        )

    @property
    def period_revolutions(self) -> int:
        """After how many revolutions speed and forces repeat themselves: 2 where the uneven speed
        has half orders.
        """
        return 2 if any(line.order % 1 for line in self.ripple) else 1

    @property
    def cycle_revolutions(self) -> int:
        """After how many revolutions everything in a cylinder repeats itself."""
        return 2 if self.gas is not None and self.strokes == 4 else self.period_revolutions

    @property
    def rotary(self) -> bool:
        """Whether the cylinders turn and the crank stands still: then the cylinders have masses on
        a linkage only.
        """
        c = self.cylinders
        return c.linkage is not None and c.linkage.turning

    @cached_property
    def joined_throws(self) -> tuple[tuple[int, ...], ...]:
        """Throws of the file that are one throw of the crank, from the free end to the flywheel.

        Throws of one angle are one where they stand in one place, and where they are next to each
        other, nearer than half a bore and on different banks: a file with a throw for each cylinder
        has such. Throws whose places are unknown each stand alone, in the file's order. Where
        [crank] places the throws, a cylinder's own position moves its rod alone.
        """
        c, z = self.cylinders, np.ravel(self.throws_m)
        crank = None if self.model is None else self.model.crank
        if crank is not None and crank.positions is not None:
            z = np.array(crank.positions) / 1e3
        elif crank is not None and crank.spacing:
            z = np.arange(len(z)) * crank.spacing / 1e3
        if self.rotary or not self.places_known:
            return tuple((throw,) for throw in range(len(z)))
        turned = np.round(np.stack([np.ravel(c.pin_deg), np.ravel(c.axis_of_each_deg)]), 6) % 360
        pins, banks = ([{*side[rows].tolist()} for rows in self._rows_by_throw] for side in turned)
        joined: list[list[int]] = []
        for throw in sorted(range(len(z)), key=lambda k: (round(float(z[k]), 9), min(pins[k]), k)):
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
        """Place of each of the `joined_throws`, in the middle of its rods, shape (throws,)."""
        places = np.ravel(self.throws_m)
        return np.array([places[[*throws]].mean() for throws in self.joined_throws])

    @property
    def joined_throw_of_rows(self) -> list[int]:
        """Index of the one of `joined_throws` that each row of `cylinders` is on."""
        found = {throw: k for k, throws in enumerate(self.joined_throws) for throw in throws}
        return [found[weighed.throw] for weighed in self.weighed]

    @property
    def _rows_by_throw(self) -> list[list[int]]:
        rows: list[list[int]] = [[] for _ in range(len(self.throws_m))]
        for row, weighed in enumerate(self.weighed):
            rows[weighed.throw].append(row)
        return rows

    @property
    def rows_by_pin(self) -> list[list[int]]:
        """Rows of the cylinders on each crank pin, in the order of the throws; split pins are
        several, in their order along the throw.
        """
        first = [self.joined_throws[k][0] for k in self.joined_throw_of_rows]
        rows = sorted(range(len(self.numbers)), key=self.numbers.__getitem__)
        pins: dict[tuple[int, float], list[int]] = {}
        for row in rows:
            pin = first[row], float(self.cylinders.pin_deg[row]) % 360
            pins.setdefault(pin, []).append(row)
        along = sorted(pins, key=lambda pin: (pin[0], float(self.cylinders.z[pins[pin]].min())))
        return [pins[pin] for pin in along]

    @property
    def pins_deg(self) -> dict[int, Figure]:
        """Crank pin of each cylinder after cylinder 1's, by number."""
        return dict(zip(self.numbers, self.cylinders.pin_deg, strict=True))

    @property
    def silent(self) -> SilentCylinders:
        """Those that do not fire; none of an engine whose file says nothing of gas."""
        if self.gas is None:
            return NONE_SILENT
        each = sorted(zip(self.numbers, self.gas.cylinders, strict=True))
        return SilentCylinders(
            tuple(number for number, own in each if not own.share),
            tuple(number for number, own in each if own.share and own.heat == 0),
        )

    @property
    def mechanical_efficiency(self) -> float | None:
        """Brake over indicated work; None: the file does not say, or a cylinder burns nothing, and
        yet has its friction.
        """
        if self.gas is None or any(self.silent):
            return None
        return self.gas.mechanical_efficiency

    @property
    def splay_for_even_firing(self) -> float | None:
        """`crank.splay` (deg) with which several throws would make the cylinders fire evenly in the
        file's order; None where none would, or the file says at which intervals they fire.
        """
        if self.model is None or self.model.layout.firing_intervals or len(self.throws_m) == 1:
            return None
        return find_fitting_splay(self.model)


def build(
    model: EngineFile,
    varied: Mapping[str, Figure] | None = None,
    *,
    rank: int = 0,
    gas: EngineGas | None = None,
) -> Engine:
    """The engine that a file describes, or variants of it.

    Args:
        model: a checked model.
        varied: what takes the place of some of its figures, by dotted name (`rod.ratio`,
            `crank.throws.2`): arrays, which broadcast against each other. Beside given throws the
            firing order is then left out.
        rank: trailing axes that the engine has at least. What does not vary along one has length 1
            there, here and in all that is computed.
        gas: that of the engine, where it is known already.

    Raises:
        InputError: what does not fit together, by its path in the file.
        BalcliError: figures that cannot vary beside what the file gives.
    """
    parts = assemble(model, varied, rank=rank, gas=gas)
    bore = parts.figures.take_optional("piston.bore", model.piston.bore)
    return Engine(
        name=model.name,
        source=model.source,
        numbers=parts.numbers,
        cylinders=parts.cylinders,
        fires_deg=parts.fires_deg,
        strokes=model.layout.strokes,
        bore_m=math.nan if bore is None else bore / 1e3,
        throws_m=parts.places.throws,
        speed_rpm=parts.figures.take("operation.speed", model.operation.speed),
        ripple=parts.find_ripple(),
        reference_m=parts.places.reference,
        devices=tuple(build_devices(model, parts.figures, parts.pins.axes_deg[1])),
        weighed=tuple(parts.weighed[number] for number in parts.numbers),
        places_known=are_places_known(model, parts.plan, varied or ()),
        gas=parts.gas,
        crank_inertia=_in_si(parts.figures.take_optional("crank.inertia", model.crank.inertia)),
        flywheel_inertia=None if model.flywheel is None else _find_flywheel(parts, model.flywheel),
        bearings=None if model.bearing is None else _find_bearings(model.bearing),
        inferred=() if varied else tuple(list_inferred(parts)),
        model=None if varied else model,
    )


def check_engine(function: str, value: object) -> Engine:
    """The engine that a function of the library was given.

    Raises:
        TypeError: it is none, with how to make one.
    """
    if not isinstance(value, Engine):
        raise wrong_type(function, value, "give an Engine; load(...) makes one of a path or a dict")
    return value


def take_model(engine: Engine) -> EngineFile:
    """What the file of an engine says.

    Raises:
        BalcliError: no file says what it is.
    """
    if engine.model is None:
        raise BalcliError(
            f"{engine.summary}: no engine file can say what this engine is (it has devices that "
            "none describes, or is a variant); take the one from which it was made"
        )
    return engine.model


def find_row(engine: Engine, number: int, option: str) -> int:
    """Row of the cylinder with this number, which an option names.

    Raises:
        BalcliError: there is none.
    """
    if number not in engine.numbers:
        some = ", ".join(map(str, sorted(engine.numbers)))
        raise BalcliError(
            f"{option} {number}: {engine.name or 'the engine'} has the cylinders {some}"
        )
    return engine.numbers.index(number)


def assemble(
    model: EngineFile,
    varied: Mapping[str, Figure] | None = None,
    *,
    rank: int = 0,
    gas: EngineGas | None = None,
) -> Parts:
    """The parts of an engine that fit together; arguments and errors as of `build`."""
    parts = Parts(model, varied, rank, known_gas=gas)
    if problems := find_contradictions(parts):
        raise InputError(problems)
    return parts


def _in_si(inertia: Figure | None) -> Figure | None:
    """Kg m2 from the kg mm2 of the file."""
    return None if inertia is None else inertia * 1e-6


def _find_flywheel(parts: Parts, table: Flywheel) -> Figure | None:
    """Moment of inertia of the flywheel, kg m2."""
    take = parts.figures.take_optional
    inertia = take("flywheel.inertia", table.inertia)
    mass = take("flywheel.mass", table.mass)
    radius = take("flywheel.radius_of_gyration", table.radius_of_gyration)
    if mass is None or radius is None:
        return _in_si(inertia)
    return mass * (radius * 1e-3) ** 2


def _find_bearings(table: Bearing) -> Bearings:
    pairs = (table.pin_diameter, table.pin_width), (table.main_diameter, table.main_width)
    return Bearings(*(None if a is None or b is None else a * b * 1e-6 for a, b in pairs))


# Changes that leave it out.
NO_FIRING_ORDER: dict[str, Any] = {"layout.firing_order": None, "layout.firing_intervals": None}


def vary_engine(engine: Engine, changes: Mapping[str, Any]) -> Engine:
    """The engine of the same file with other values of some keys, by dotted names; errors as of
    `Engine.vary`.
    """
    for path in changes:
        if not isinstance(path, str):
            raise wrong_type("vary", path, 'name a key of the engine file, such as "rod.length"')
    model = take_model(engine)
    changes = dict(changes)
    try:
        return _build_changed(engine, changes)
    except InputError:
        kept = model.crank.throws is None or model.gas is not None
        if kept or model.layout.firing_order is None or NO_FIRING_ORDER.keys() & changes.keys():
            raise
        first = NO_FIRING_ORDER | changes
    try:
        return _build_changed(engine, first)
    except InputError:
        return _build_changed(engine, changes)  # with all that is wrong of it


def _build_changed(engine: Engine, changes: Mapping[str, Any]) -> Engine:
    model = take_model(engine)
    name = f"{engine.name or 'engine'} with {', '.join(changes)}"
    with naming_file(name):
        return build(parse_dict(change_tables(model, changes), model.folder))

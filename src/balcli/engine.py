"""Engine: what the computation needs of an engine file, in SI units, one row per cylinder, with its devices."""
from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import articulation, firing
from .core.inertia import Cylinders, Device
from .core.phasors import unit
from .core.rotary import Rotary
from .errors import InputError, Problem
from .layout import Plan, cycle, plan
from .model import ArticulatedRod, Bobweight, Counterweight, EngineFile, Override, Rod, Shaft, Slider

STANDARD_GRAVITY = 9.80665          # m/s2, by definition (CGPM 1901)
NEAREST_TO_LOCK = 1e-6              # how far lambda + |offset| / rod length must stay below 1


@dataclass(frozen=True)
class Ripple:
    """One line of an uneven crank speed: `omega = mean (1 + sum amplitude cos(order theta - angle))`."""

    order: int
    amplitude: Any
    angle_deg: Any


@dataclass(frozen=True)
class Weighed:
    """Masses of one cylinder as a shop weighs them, kg, and on which throw (from 0) its rod runs.

    `share` is the pin's share of the throw mass; bearing and oil count on the bobweight card only.
    """

    throw: int
    piston: Any
    small_end: Any
    big_end: Any
    share: Any
    rod_bearing: Any
    oil: Any


@dataclass(frozen=True)
class Engine:
    """An engine, SI except where a name says otherwise; arrays may have a trailing axis of variants.

    Attributes:
        numbers: cylinder number of each row of `cylinders`.
        fires_deg: firing angle by cylinder number, where the file gives a firing order.
        throws_m: place of each throw along the crank.
        reference_m: point about which moments are taken.
        weighed: masses behind each row of `cylinders`.
        devices: counterweights, shafts and sliders of the file, in this order.
    """

    name: str
    source: str
    numbers: tuple[int, ...]
    cylinders: Cylinders
    fires_deg: Mapping[int, Any]
    strokes: int
    bore_m: Any
    throws_m: NDArray[np.float64]
    speed_rpm: Any
    ripple: tuple[Ripple, ...]
    reference_m: tuple[Any, Any, Any]
    devices: tuple[Device, ...]
    weighed: tuple[Weighed, ...]

    @property
    def omega(self) -> Any:
        """Mean crank speed, rad/s."""
        return self.speed_rpm * (math.pi / 30)

    @property
    def displacement_m3(self) -> Any:
        """Swept volume by bore and twice the crank radius."""
        return math.pi / 4 * self.bore_m**2 * (2 * self.cylinders.radius) * self.cylinders.count

    @property
    def first_axis_deg(self) -> Any:
        """Where cylinder 1's crank pin points at crank angle 0."""
        return self.cylinders.axis_deg[self.cylinders.first]

    @property
    def equal(self) -> bool:
        """Whether all cylinders have one mechanism and one set of reciprocating masses."""
        c = self.cylinders
        return len(c.lam) == len(c.eps) == len(c.reciprocating) == 1 and c.linkage is None

    @property
    def pins_deg(self) -> dict[int, Any]:
        """Crank pin by cylinder number."""
        return dict(zip(self.numbers, self.cylinders.pin_deg, strict=True))


def build(file: EngineFile, rank: int = 0) -> Engine:
    """The engine that a file describes.

    Args:
        file: a checked model; numbers in it may have been replaced by arrays of variants.
        rank: number of axes of those arrays, which broadcast against each other; what does not vary along an axis has length 1
            there, here and in all that is computed.

    Raises:
        InputError: what does not fit together, by its path in the file.
    """
    layout = plan(file.crank, file.layout)
    masters = articulation.masters(file, layout)
    _refuse([*articulation.mistakes(file, layout), *_strangers(layout, file.cylinder), *_half_rods(file, masters)])
    radius = file.crank.stroke / 2e3
    rods = [_rod(file, number, number in masters) for number in layout.numbers]
    _refuse(p for number, rod in zip(layout.numbers, rods, strict=True) for p in _mistakes(file, number, rod, radius, number in masters))
    axis = {c.number: _own(file, c.number, "bank", layout.banks[c.bank]) for c in layout.cells}
    sense = -1 if file.layout.rotary else 1             # in which the crank turns, seen from a cylinder
    top = {n: axis[n] + sense * rod.top_deg(radius) for n, rod in zip(layout.numbers, rods, strict=True)}
    top |= {n: axis[n] for n in masters}                # nominal: an articulated piston's dead centre is off by some degrees
    pin, fires = _pins(file, layout, top)
    places, throws = _places(file, layout, rank)
    still, turning = axis, {n: pin[n] - pin[1] for n in layout.numbers}
    if file.layout.rotary:                              # cylinders turn about pins that stand still (core.rotary)
        still, turning = _shared_objects({n: axis[1] + turning[n] for n in axis}), {n: axis[n] - axis[1] for n in axis}
    order = _by_axis(layout, still)
    rods = [rods[row] for row in order]
    numbers = tuple(layout.numbers[row] for row in order)
    starts = [k for k, n in enumerate(numbers) if k == 0 or still[n] is not still[numbers[k - 1]]]
    cylinders = Cylinders(
        axis_deg=_column([still[numbers[row]] for row in starts], rank),
        pin_deg=_column([turning[n] for n in numbers], rank),
        starts=np.array(starts),
        first=int(np.searchsorted(starts, numbers.index(1), side="right")) - 1,
        z=_column([places[n] for n in numbers], rank),
        radius=_column([radius], rank)[0],
        lam=_shared([radius / rod.length for rod in rods], rank),
        eps=_shared([rod.offset / rod.length for rod in rods], rank),
        reciprocating=_shared([0.0 if file.layout.rotary else rod.piston + rod.small_end for rod in rods], rank),
        rotating=_shared([_at_pin(file, layout, rod, n in masters) for n, rod in zip(numbers, rods, strict=True)], rank),
        couple=_shared([rod.couple for rod in rods], rank),
        linkage=Rotary(_shared([rod.piston + rod.small_end for rod in rods], rank)) if file.layout.rotary else
        articulation.linkage(file, layout, numbers, axis, [rod.big_end for rod in rods], rank),
    )
    _refuse(articulation.locked(file, cylinders, numbers))
    return Engine(
        name=file.name, source=file.source, numbers=numbers, cylinders=cylinders, fires_deg=fires, strokes=file.layout.strokes,
        bore_m=math.nan if file.piston.bore is None else file.piston.bore / 1e3,
        throws_m=throws, speed_rpm=file.operation.speed,
        ripple=tuple(Ripple(line.order, line.amplitude, line.angle) for line in file.operation.speed_ripple),
        reference_m=_reference(file, throws), devices=devices(file, axis[1]),
        weighed=tuple(_weighed(file, layout, layout.cells[row].throw, rod) for row, rod in zip(order, rods, strict=True)),
    )


def devices(file: EngineFile, first_axis_deg: Any) -> tuple[Device, ...]:
    """Counterweights, shafts and sliders of a file; a counterweight's angle counts from cylinder 1's pin, others from x."""
    return (*(_counterweight(d, first_axis_deg) for d in file.counterweight),
            *(_shaft(d) for d in file.shaft), *(_slider(d) for d in file.slider))


def _counterweight(d: Counterweight, first_axis_deg: Any) -> Device:
    return Device(1, _unbalance(d) * unit(d.angle + first_axis_deg), 0j, 0j, d.position / 1e3, 0)


def _shaft(d: Shaft) -> Device:
    turning = _unbalance(d) * unit(d.angle)
    forward, backward = (turning, 0j) if d.ratio > 0 else (0j, turning)
    return Device(abs(d.ratio), forward, backward, _place(d.at), d.position / 1e3, 1)


def _slider(d: Slider) -> Device:
    """Its displacement `U cos(n theta + angle)` is two vectors of half the size, turning against each other."""
    half, direction, phase = _unbalance(d) / 2, unit(d.direction), unit(d.angle)
    return Device(d.order, half * direction * phase, half * direction * np.conj(phase), _place(d.at), d.position / 1e3, 2)


def _unbalance(d: Counterweight | Shaft | Slider) -> Any:
    """kg m"""
    if d.unbalance is not None:
        return d.unbalance / 1e6
    return (d.mass or 0.0) * (d.radius or 0.0) / 1e3


def _place(at: Sequence[Any]) -> Any:
    return at[0] / 1e3 + 1j * (at[1] / 1e3)


# ------------------------------------------------------------------ pistons and rods
@dataclass(frozen=True)
class _Parts:
    """Piston and rod of one cylinder, SI: `spin` is the rod's moment of inertia about its centre of mass, `couple` is H."""

    length: Any
    offset: Any
    piston: Any
    small_end: Any
    big_end: Any
    spin: Any
    couple: Any

    def top_deg(self, radius: Any) -> Any:
        """Crank angle of top dead centre."""
        return np.degrees(np.arcsin(self.offset / (radius + self.length)))


def _rod(file: EngineFile, number: int, articulated: bool) -> _Parts:
    """Piston and rod of a cylinder: the engine's, with what its own table says otherwise (THEORY 3)."""
    own = file.cylinder.get(number)
    figures = _overridden(file.articulation.rod if articulated and file.articulation else file.rod, own)
    length = figures["length"] / 1e3 if "length" in figures else file.crank.stroke / 2e3 / figures["ratio"]
    if "small_end" in figures:
        small, big = figures["small_end"], figures["big_end"]
    else:
        mass, from_big_end = figures.get("mass", 0.0), figures.get("cg", 0.0) / 1e3
        small, big = mass * (from_big_end / length), mass * ((length - from_big_end) / length)
    whole = small + big
    share = small / np.where(whole == 0, 1.0, whole)                         # s_b / l
    if "inertia" in figures:
        spin = figures["inertia"] / 1e6
    elif "pendulum" in figures:
        swing = figures["pendulum"]
        arm = length * (share if swing.pivot == "big_end" else 1 - share)
        spin = whole * arm * (STANDARD_GRAVITY * (swing.period / (2 * math.pi)) ** 2 - arm)
    else:
        spin = whole * share * (1 - share) * length**2
    return _Parts(length, _own(file, number, "piston_offset", file.piston.offset) / 1e3,
                  _own(file, number, "piston_mass", file.piston.mass), small, big, spin,
                  whole * share * (1 - share) * length**2 - spin)


def _weighed(file: EngineFile, layout: Plan, throw: int, rod: _Parts) -> Weighed:
    extra = file.bobweight or Bobweight.model_construct()
    return Weighed(throw, rod.piston, rod.small_end, rod.big_end, file.crank.throw_mass / layout.rods_on_throw,
                   extra.rod_bearing, extra.oil)


_GROUPS = (({"length"}, {"ratio"}), ({"mass", "cg"}, {"small_end", "big_end"}), ({"inertia"}, {"pendulum"}))


def _at_pin(file: EngineFile, layout: Plan, rod: _Parts, articulated: bool) -> Any:
    """What turns with a crank pin because of one cylinder, kg; the pins of a rotary engine stand still."""
    if file.layout.rotary:
        return 0.0
    return (0.0 if articulated else rod.big_end) + file.crank.throw_mass / layout.rods_on_throw


def _overridden(rod: Rod | ArticulatedRod, own: Override | None) -> dict[str, Any]:
    """Figures of a rod; a figure of the cylinder's own displaces those of the engine that say the same otherwise."""
    figures = {key: value for key in type(rod).model_fields if (value := getattr(rod, key)) is not None}
    if own is None:
        return figures
    mine = {key: value for key in Rod.model_fields if (value := getattr(own, f"rod_{key}")) is not None}
    for ways in _GROUPS:
        for way in ways:
            if way & mine.keys():
                for key in set().union(*ways) - way:
                    figures.pop(key, None)
    return figures | mine


def _own(file: EngineFile, number: int, key: str, default: Any) -> Any:
    own = file.cylinder.get(number)
    value = None if own is None else getattr(own, key)
    return default if value is None else value


def _mistakes(file: EngineFile, number: int, rod: _Parts, radius: Any, articulated: bool) -> list[Problem]:
    """What keeps a mechanism from turning, or a pendulum test from being one."""
    own = file.cylinder.get(number)

    def path(*keys: str) -> str:
        """Where one of these figures of the rod is given, or the first might be."""
        for key in keys:
            if own is not None and getattr(own, f"rod_{key}") is not None:
                return f"cylinder.{number}.rod_{key}"
        return "rod." + next((key for key in keys if getattr(file.rod, key) is not None), keys[0])

    if not np.all(rod.spin >= 0):
        return [Problem(path("pendulum"), "the period is too quick for the distance of its pivot from the centre of mass: the moment of inertia "
                                          f"about it would be {np.min(rod.spin) * 1e6:g} kg mm2 (period: a full swing, in seconds)")]
    lam, eps = np.max(radius / rod.length), np.max(np.abs(rod.offset / rod.length))
    if articulated or lam + eps <= 1 - NEAREST_TO_LOCK:                     # what an articulated rod can do depends on its master
        return []
    offset = f", with the piston offset of {np.max(np.abs(rod.offset)) * 1e3:g} mm lambda + |offset|/length = {lam + eps:.9g}" if eps else ""
    return [Problem(path("length", "ratio"), f"the crank cannot turn: crank radius {np.max(radius) * 1e3:g} mm over rod length "
                    f"{np.min(rod.length) * 1e3:g} mm is lambda = {lam:.9g}{offset}; at most 1 - {NEAREST_TO_LOCK:g} is allowed: "
                    f"make the rod longer{' or the offset smaller' if eps else ''}")]


# ------------------------------------------------------------------ where the cylinders stand
def _pins(file: EngineFile, layout: Plan, top: Mapping[int, Any]) -> tuple[dict[int, Any], dict[int, Any]]:
    """Crank pin and firing angle of every cylinder, deg; the firing angles are empty where the file says nothing of them."""
    order, intervals = file.layout.firing_order, file.layout.firing_intervals
    sense = -1 if file.layout.rotary else 1
    splay = {c.number: c.bank * file.crank.splay for c in layout.cells}
    if file.crank.throws is None and order is not None:
        fires = firing.instants(order, intervals, cycle(file.layout))
        wanted = firing.pins(fires, top, sense)
        throw = {c.throw: wanted[c.number] - splay[c.number] for c in reversed(layout.cells)}
    else:
        fires = {}
        throw = dict(enumerate(file.crank.throws or (0.0,)))
    pin = {c.number: _own(file, c.number, "throw", throw[c.throw] + splay[c.number]) for c in layout.cells}
    if order is None:
        return pin, fires
    relative = {n: angle - pin[1] for n, angle in pin.items()}
    if not fires:
        found = intervals or firing.from_pins(order, relative, top, cycle(file.layout), sense)
        if isinstance(found, Problem):
            raise InputError([found])
        fires = firing.instants(order, found, cycle(file.layout))
    off = firing.disagreement(fires, relative, top, sense)
    _refuse([off] if off else [])
    return pin, fires


def _places(file: EngineFile, layout: Plan, rank: int) -> tuple[dict[int, Any], NDArray[np.float64]]:
    """Place of every cylinder and of every throw along the crank, m (a throw stands in the middle of its rods)."""
    crank = file.crank
    along = crank.positions or [(t - (layout.throws - 1) / 2) * (crank.spacing or 0.0) for t in range(layout.throws)]
    middle = (layout.rods_on_throw - 1) / 2
    lean = {c.number: (c.bank - middle) * file.layout.stagger if layout.rods_on_throw > 1 else 0.0 for c in layout.cells}
    place = {c.number: _own(file, c.number, "position", along[c.throw] + lean[c.number]) / 1e3 for c in layout.cells}
    throws = [sum(place[c.number] - lean[c.number] / 1e3 for c in layout.cells if c.throw == t) / layout.rods_on_throw
              for t in range(layout.throws)]
    return place, _column(throws, rank)


def _reference(file: EngineFile, throws: NDArray[np.float64]) -> tuple[Any, Any, Any]:
    if file.frame.reference is not None:
        x, y, z = file.frame.reference
        return x / 1e3, y / 1e3, z / 1e3
    return 0.0, 0.0, (throws.min(axis=0) + throws.max(axis=0)) / 2


def _shared_objects(angles: Mapping[int, Any]) -> dict[int, Any]:
    """Equal angles as one object."""
    known: dict[bytes, Any] = {}
    return {n: known.setdefault(np.asarray(angle, float).tobytes(), angle) for n, angle in angles.items()}


def _by_axis(layout: Plan, axis: Mapping[int, Any]) -> list[int]:
    """Rows of the cells such that cylinders on one axis stand together."""
    seen: dict[int, int] = {}
    return sorted(range(len(layout.cells)), key=lambda row: seen.setdefault(id(axis[layout.cells[row].number]), row))


def _strangers(layout: Plan, own: Mapping[int, Override]) -> list[Problem]:
    return [Problem(f"cylinder.{n}", f"there is no cylinder {n}; this engine has cylinders 1 to {len(layout.cells)}")
            for n in own if n not in layout.numbers]


def _half_rods(file: EngineFile, articulated: Collection[int]) -> list[Problem]:
    """Cylinders whose own rod is weighed at one end only, where the engine's rod does not give the other."""
    ends = ("small_end", "big_end")
    return [Problem(f"cylinder.{n}.rod_{here}", f"needs rod_{missing} beside it: weigh the rod at both ends")
            for n, own in file.cylinder.items() for here, missing in (ends, ends[::-1])
            if getattr(own, f"rod_{here}") is not None and getattr(own, f"rod_{missing}") is None
            and (n in articulated or getattr(file.rod, missing) is None)]


def _refuse(problems: Iterable[Problem]) -> None:
    if found := tuple(dict.fromkeys(problems)):
        raise InputError(found)


# ------------------------------------------------------------------ arrays
def _column(values: Sequence[Any], rank: int) -> NDArray[np.float64]:
    """One row each, shape (len(values), *trailing); scalars get trailing axes of length 1."""
    rows = np.broadcast_arrays(*(np.asarray(v, float) for v in values))
    stacked = np.stack(rows)
    return stacked.reshape(len(values), *stacked.shape[1:] or (1,) * rank)


def _shared(values: Sequence[Any], rank: int) -> NDArray[np.float64]:
    """The same, or a single row where all are equal."""
    column = _column(values, rank)
    return column[:1] if (column == column[:1]).all() else column

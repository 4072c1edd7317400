"""Compute the balance masses in the wheels of a locomotive, the hammer blow and the forces along
the track: `locomotive`.

Each revolving mass is an unbalance: a complex product of mass and radius, whose angle counts from
cylinder 1's crank pin, on an axle at a position z. The revolving masses are those of the crank
pins, the coupling masses, and the counterweights of the file. The lever rule divides each unbalance
between the two planes of its axle's balance masses. A share c of the reciprocating masses of all
cylinders is balanced as if it turned with the crank; each axle balances its part f of this share.
Let S be the revolving unbalance in one of these planes, and Q the unbalance of all reciprocating
masses in this plane. The wheel then gets the balance mass `B = -(S + c f Q)`. The remaining
unbalance `S + B` loads and unloads the rail once a turn: at the crank speed w, the hammer blow is
`|S + B| w^2`, not `|B| w^2`. In Q, the unbalance of an inclined cylinder stands at the angle of its
crank pin minus the bank angle, so that the balance mass points straight back along the track when
the piston is at the outer dead centre.

Sources: Sarkar, Theory of Machines, ch. 12; Khurmi and Gupta, Theory of Machines, ch. 22; Bridge
Stress Committee 1928 (blow of a rail and of the engine).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Literal, NamedTuple

import numpy as np

from ..balancing.answer import insert_remedy
from ..core.cylinders import DeviceKind
from ..core.peaks import find_longest
from ..core.phasors import Array, Complex, unit, wrap_degrees
from ..core.records import HIDDEN, INLINE, Polar, angle_deg
from ..engine.engine import Engine, check_engine, refuse_geared, take_model
from ..errors import MOMENTS_UNKNOWN, Argument, ArgumentError, InputError, Problem
from ..file.doubt import Doubt
from ..file.edit import set_keys, set_speed
from ..file.fields import Number
from ..file.locomotive_tables import FACTOR, Axle, Locomotive
from ..file.model import Counterweight, EngineFile
from ..file.units import FORCE, SPEED, VELOCITY, convert
from ..forces.spectrum import compute_spectra, find_relevant_orders
from ..show.result import Result
from ..sizing.remedy import Remedy, fit_devices

_ROUNDING = 1e-12  # a sum below this share of its terms' magnitudes is 0
_WHY = "In the wheels, opposite all revolving masses"
NO_TABLE = "write [locomotive] with planes and factor, or start from `balcli new locomotive`"
NO_SPEED = "give it in km/h (with wheel_diameter), or give operation.speed in rpm"
_NOTE = "by balcli locomotive"
NO_CRANKS = "does not suit [locomotive]: give fixed cylinders, each with a rod on a crank pin"


class WheelLoads(NamedTuple):
    """A wheel: its balance mass, and its load on the rail.

    Attributes:
        plane_mm: Position z of the balance mass.
        unbalance: Unbalance of the balance mass, angle from cylinder 1's crank pin.
        mass_kg: Balance mass; null without `locomotive.radius`.
        hammer_blow_N: Amplitude of the load that the remaining unbalance adds.
        least_rail_load_N: Static load less the hammer blow; below 0 the wheel lifts. Null without
            wheel load (the static load in the file).
        most_rail_load_N: Sum of static load and hammer blow; null without wheel load.
        lift_rpm: Crank speed at which the wheel lifts; null without wheel load or hammer blow.
        lift_km_h: Speed on the track at which the wheel lifts; null without a wheel diameter.
    """

    plane_mm: float
    unbalance: Annotated[complex, Polar("unbalance_kg_m", "angle_deg"), INLINE]
    mass_kg: float | None
    hammer_blow_N: float
    least_rail_load_N: float | None
    most_rail_load_N: float | None
    lift_rpm: float | None
    lift_km_h: float | None


class AxleLoads(NamedTuple):
    """A coupled axle.

    Attributes:
        name: Name of the axle.
        driving: Whether the axle has cranks.
        hammer_blow_N: Amplitude of the varying load of both wheels together.
        wheels: Its wheels, by ascending z.
    """

    name: str
    driving: bool
    hammer_blow_N: float
    wheels: tuple[WheelLoads, ...]


class RailLoad(NamedTuple):
    """Load of one rail.

    Attributes:
        hammer_blow_N: Amplitude of the varying load of all wheels on this rail together.
    """

    hammer_blow_N: float


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class LocomotiveBalance(Result):
    """Balance masses in the wheels of a locomotive, the hammer blow, and the forces and moments
    that remain along the track.

    Attributes:
        speed_rpm: Crank speed, taken as steady.
        speed_km_h: Speed on the track; null without a wheel diameter.
        factor: Share of the reciprocating mass that the wheels balance; null: no balance masses are
            sized.
        axles: Coupled axles, front to rear.
        rails: Rails, by ascending z.
        hammer_blow_N: Amplitude of the varying load of all wheels together.
        tractive_variation_N: Amplitude of order 1 of the free force along the track.
        tractive_variation_peak_N: Largest absolute value of this force, all orders together.
        swaying_couple_z_mm: Place along the crank about which the swaying couple is taken: that of
            `frame.reference`; without it, half-way between the planes of the wheels.
        swaying_couple_Nm: Amplitude of order 1 of the free moment about y.
        swaying_couple_peak_Nm: Largest absolute value of this moment, all orders together.
        engine: Engine without the balance masses that are sized.
        remedy: Balance masses that are sized, as tables of the engine file.
    """

    format: Literal["balcli.locomotive/1"] = "balcli.locomotive/1"
    speed_rpm: float
    speed_km_h: float | None
    factor: float | None
    axles: tuple[AxleLoads, ...]
    rails: tuple[RailLoad, ...]
    hammer_blow_N: float
    tractive_variation_N: float
    tractive_variation_peak_N: float
    swaying_couple_z_mm: float
    swaying_couple_Nm: float
    swaying_couple_peak_Nm: float
    engine: Annotated[Engine, HIDDEN]
    remedy: Annotated[Remedy, HIDDEN]

    @property
    def summary(self) -> str:
        """Name of the engine and the largest hammer blow of a wheel, in words."""
        blow = max(wheel.hammer_blow_N for wheel in self.wheels)
        return f"of {self.engine.summary}; hammer blow {blow:.4g} N"

    @property
    def wheels(self) -> tuple[WheelLoads, ...]:
        """Wheels of all axles."""
        return tuple(wheel for axle in self.axles for wheel in axle.wheels)

    @property
    def doubts(self) -> tuple[Doubt, ...]:
        """Warnings of an uneven speed, and of cylinders that do not lie along the track."""
        doubts = []
        if take_model(self.engine).operation.speed_ripple:
            message = "has no effect, because the speed is taken as steady"
            doubts.append(Doubt("operation.speed_ripple", message))
        aside = np.abs(wrap_degrees(self.engine.cylinders.axis_of_each_deg, 180))
        for number, degrees in sorted(zip(self.engine.numbers, aside.tolist(), strict=True)):
            if degrees > 45:
                far = f"cylinder {number} is {degrees:.4g} deg from the track"
                doubts.append(Doubt("", f"{far}; in a locomotive file x points along the track"))
        return tuple(doubts)


# ------------------------------------------------------------------ unbalances in the wheels
class Unbalances(NamedTuple):
    """Unbalances in the planes of the balance masses, from cylinder 1's crank pin, kg m.

    Attributes:
        revolving: Unbalance of the revolving masses of each axle, shape (axles, 2).
        reciprocating: Unbalance of each axle's part of the reciprocating masses, shape (axles, 2).
        size: Sum of the magnitudes of all terms, to which rounding errors are proportional.
    """

    revolving: Complex
    reciprocating: Complex
    size: float

    def drop_noise(self, sums: Complex) -> Complex:
        """Return sums of unbalances, 0 where they are rounding errors."""
        return np.where(np.abs(sums) <= _ROUNDING * self.size, 0, sums)


def find_unbalances(engine: Engine, axles: Sequence[Axle], planes_m: Array) -> Unbalances:
    """Return the unbalances in the wheels of a locomotive, before balance masses are sized.

    Args:
        engine: Engine.
        axles: Its axles.
        planes_m: Planes of the balance masses, m, shape (2,).
    """
    c = engine.cylinders
    place = {
        n: k for k, a in enumerate(axles) if a.has_cranks for n in a.cylinders or engine.numbers
    }
    names = {"": min(place.values())} | {axle.name: k for k, axle in enumerate(axles)}
    weights = [d for d in engine.devices if d.kind is DeviceKind.COUNTERWEIGHT]
    turned = [complex(d.forward) / complex(unit(engine.first_axis_deg)) for d in weights]
    pins = unit(c.pin_deg) * c.radius_of_each
    revolving = np.array([*(c.rotating * pins), *turned])
    on_axle = np.array([*(place[n] for n in engine.numbers), *(names[d.axle] for d in weights)])
    reciprocating = c.reciprocating * pins / unit(c.axis_of_each_deg)
    share = (np.array([*c.z, *(d.z for d in weights)]) - planes_m[0]) / np.ptp(planes_m)
    levers = np.stack([1 - share, share], axis=1)
    parts = np.array([axle.part for axle in axles])
    of_axles = (on_axle == np.arange(len(axles))[:, None]) * revolving
    return Unbalances(
        of_axles @ levers,
        np.outer(parts / parts.sum(), reciprocating @ levers[: c.count]),
        float(np.abs(revolving) @ np.abs(levers).sum(axis=1) + np.abs(reciprocating).sum()),
    )


def locomotive(
    engine: Engine,
    factor: float | str | None = None,
    *,
    hammer_blow: float | str | None = None,
    speed: float | str | None = None,
) -> LocomotiveBalance:
    """Return the balance masses in the wheels of a locomotive, the rail loads, and the remaining
    variation of tractive effort and swaying couple.

    Args:
        engine: Engine of a file with [locomotive]. The speed is taken as steady.
        factor: Share of the reciprocating mass to balance instead of the file's, 0 to 1 or "2/3".
        hammer_blow: Largest hammer blow of a wheel, from which the factor follows, N or "40 kN".
        speed: Speed instead of the file's: crank speed in rpm, or "80 km/h".

    Raises:
        InputError: The file has no [locomotive], speed or positions of throws, or its cylinders are
            articulated or turn.
        BalcliError: An argument is out of its range.
        TypeError: `engine` is not an Engine.

    Example:
        >>> locomotive(load_example("locomotive2"), 2 / 3).axles[0].wheels[0].hammer_blow_N
    """
    model = take_model(check_engine("locomotive", engine))
    refuse_geared(model)
    table = _take_table(engine, model, speed_given=speed is not None)
    axles = table.list_axles(model.axle)
    rpm = float(engine.speed_rpm) if speed is None else _read_speed(table, speed)
    engine = replace(engine, speed_rpm=rpm, ripple=())
    square = float(engine.omega) ** 2
    unbalances = find_unbalances(engine, axles, np.array(table.planes) / 1e3)
    if hammer_blow is not None and factor is not None:
        raise ArgumentError("{hammer_blow} determines the factor; leave {factor} out")
    if hammer_blow is not None:
        limit = _read(Number(FORCE, above=0), "hammer_blow", hammer_blow) / square
        largest = float(np.abs(unbalances.reciprocating).max())
        c: float | None = min(limit / largest, 1.0) if largest else 1.0
    else:
        c = table.factor if factor is None else _read(FACTOR, "factor", factor)
    left = unbalances.revolving if c is None else -c * unbalances.reciprocating
    left = unbalances.drop_noise(left)
    added = unbalances.drop_noise(left - unbalances.revolving)
    names = [axle.name if model.axle else None for axle in axles]
    weights = _list_weights(table, names, added)
    share = f" and {c:.4g} of the reciprocating ones" if c else ""
    remedy = Remedy("locomotive").add_devices(weights, f"{_WHY}{share}")
    middle = _find_middle(engine, model, table)
    fitted = replace(fit_devices(engine, remedy), reference_m=middle)
    spectra = compute_spectra(fitted, find_relevant_orders(fitted), ("force", "moment"))
    along = spectra["force"].x
    about_y = spectra["moment"].y

    def blow(some: Complex) -> float:
        """Return the hammer blow of several wheels together, N."""
        return float(abs(unbalances.drop_noise(some.sum()))) * square

    return LocomotiveBalance(
        speed_rpm=rpm,
        speed_km_h=table.find_km_h(rpm),
        factor=c,
        axles=tuple(
            AxleLoads(a.name, a.has_cranks, blow(rest), _list_wheels(engine, table, a, new, rest))
            for a, new, rest in zip(axles, added, left, strict=True)
        ),
        rails=tuple(RailLoad(blow(side)) for side in left.T),
        hammer_blow_N=blow(left),
        tractive_variation_N=float(abs(along[0])),
        tractive_variation_peak_N=float(find_longest(spectra.orders, along[:, None]).value),
        swaying_couple_z_mm=1e3 * middle[2],
        swaying_couple_Nm=float(abs(about_y[0])),
        swaying_couple_peak_Nm=float(find_longest(spectra.orders, about_y[:, None]).value),
        engine=engine,
        remedy=remedy,
    )


def _find_middle(
    engine: Engine, model: EngineFile, table: Locomotive
) -> tuple[float, float, float]:
    """Return the point about which the swaying couple is taken, m: the file's point of reference;
    without it, the middle of the track, half-way between the planes of the wheels.
    """
    x, y, z = (float(figure) for figure in engine.reference_m)
    if model.frame.reference is None:
        z = sum(table.planes) / 2e3
    return x, y, z


def _take_table(engine: Engine, model: EngineFile, *, speed_given: bool) -> Locomotive:
    """Return [locomotive] of a file; InputError if a key that all results need is missing."""
    if (table := model.locomotive) is None:
        raise InputError([Problem.of_missing("locomotive", NO_TABLE)])
    problems = {
        Problem.of_missing("locomotive.speed", NO_SPEED): engine.speed_assumed and not speed_given,
        Problem("crank.spacing", MOMENTS_UNKNOWN): not engine.places_known,
        Problem("layout", NO_CRANKS): engine.cylinders.linkage is not None,
    }
    if found := [problem for problem, there in problems.items() if there]:
        raise InputError(found)
    return table


def _read(number: Number, argument: str, value: object) -> float:
    """Return an argument, read like a key of a file (ArgumentError)."""
    try:
        return number.read(value)
    except ValueError as error:
        raise ArgumentError(
            "{argument}: {error}", argument=Argument(argument), error=str(error)
        ) from None


def _read_speed(table: Locomotive, speed: float | str) -> float:
    """Return a crank speed, rpm, which may be given as a speed on the track."""
    try:
        rpm: object = table.find_rpm(convert(str(speed), VELOCITY))
    except ValueError:
        rpm = speed
    return _read(Number(SPEED, above=0, most=1e9), "speed", rpm)


def _list_wheels(
    engine: Engine, table: Locomotive, axle: Axle, added: Complex, left: Complex
) -> tuple[WheelLoads, ...]:
    """Return both wheels of an axle, from added and remaining unbalances in their planes, kg m."""
    load = table.wheel_load if axle.wheel_load is None else axle.wheel_load
    rpm = float(engine.speed_rpm)
    square = float(engine.omega) ** 2
    wheels = []
    for z, new, rest in zip(table.planes, added.tolist(), left.tolist(), strict=True):
        blow = abs(rest) * square
        wheel = WheelLoads(z, new, None, blow, None, None, None, None)
        if table.radius is not None:
            wheel = wheel._replace(mass_kg=abs(new) / table.radius * 1e3)
        if load is not None:
            wheel = wheel._replace(least_rail_load_N=load - blow, most_rail_load_N=load + blow)
        if load is not None and blow:
            lift = rpm * math.sqrt(load / blow)
            wheel = wheel._replace(lift_rpm=lift, lift_km_h=table.find_km_h(lift))
        wheels.append(wheel)
    return tuple(wheels)


def _list_weights(
    table: Locomotive, names: Sequence[str | None], added: Complex
) -> Iterator[Counterweight]:
    """Yield balance masses of these unbalances (kg m) as tables of the engine file.

    Args:
        table: [locomotive] of the file.
        names: Names of the axles in the file; only None if the file has no [[axle]].
        added: Unbalances, shape (axles, 2).
    """
    for name, row in zip(names, added.tolist(), strict=True):
        for z, new in zip(table.planes, row, strict=True):
            size = abs(new) * 1e6
            angle = angle_deg(new)
            if size:
                yield Counterweight.model_construct(
                    unbalance=size, angle=angle, position=float(z), axle=name
                )


def insert_weights(text: bytes, result: LocomotiveBalance, file: str, rpm: float | None) -> str:
    """Return the text of an engine file with the balance masses as counterweights and without
    `locomotive.factor`.

    Args:
        text: Text of the file, UTF-8.
        result: Balance of the locomotive.
        file: Name of the file, for messages.
        rpm: Crank speed to write; None: the speed of the file remains.
    """
    new = set_keys(text.decode("utf-8-sig"), "locomotive", {"factor": None}, _NOTE)
    if rpm is not None:
        new = set_speed(new, rpm, _NOTE)
    return insert_remedy(new.encode(), result.remedy, file)

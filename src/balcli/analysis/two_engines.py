"""Two engines on one frame, geared one to one (H, U and opposed-piston engines): the sum of their
phasors, and the tables that show it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Annotated, Literal, get_args

import numpy as np

from ..core.peaks import Peak
from ..core.phasors import Array, Figure, Phasors, unit
from ..core.records import HIDDEN, INLINE, WrittenAs
from ..core.speed_ripple import RippleLine
from ..engine.engine import Engine, check_engine
from ..errors import BalcliError, check_number, check_type
from ..file.fields import counted
from ..forces.kinds import EVERY_KIND, GAS, KINDS, Kind
from ..forces.spectrum import (
    Spectra,
    add_parts,
    check_orders,
    choose_orders,
    compute_spectra,
    find_relevant_orders,
    list_gas_orders,
    merge_orders,
)
from ..limits import FARTHEST_DEG, FARTHEST_M, HIGHEST_ORDER_UNASKED
from ..shell.arguments import read_position, tell_arguments
from ..show.csv import Rows
from ..show.engine_facts import tell_pivot, tell_speed
from ..show.figures import (
    EngineSize,
    EngineState,
    Peaks,
    describe_state,
    figure_rows,
    find_peaks,
    list_assumed,
    list_orders,
    measure_engine,
    place_in_mm,
)
from ..show.formats import Renderer
from ..show.result import Result
from ..show.sheet import Facts, Grid, Sheet, number, tell_assumed
from .answer import DEFAULT_ORDERS
from .order_tables import order_tables, peak_facts

if TYPE_CHECKING:
    from ..show.units import ShownUnit, System


Load = Literal["first", "second", "both"]
LOADS: tuple[str, ...] = get_args(Load)


@dataclass(frozen=True)
class EngineOfTwo:
    """One of two engines.

    Attributes:
        size: Name and size of the engine.
        gas: Whether its file has gas; left out where neither file has.
    """

    size: Annotated[EngineSize, INLINE]
    gas: bool | None = None


def measure_engines(engines: tuple[Engine, ...]) -> tuple[EngineOfTwo, ...]:
    """Return names and sizes of engines, and which of them have gas, if any has."""
    has_gas = [engine.gas is not None for engine in engines]
    sizes = map(measure_engine, engines)
    return tuple(map(EngineOfTwo, sizes, has_gas if any(has_gas) else [None] * len(has_gas)))


@dataclass(frozen=True)
class Arrangement:
    """Arrangement of the second engine relative to the first, and the load of both.

    Attributes:
        phase_deg: Crank angle by which the second engine leads, in its own sense of rotation.
        at_m: Position of its origin (its crank axis at its z = 0) in the first engine's axes.
        turn_deg: Angle by which the second engine is turned about z, with all its banks.
        reverse: Whether the second crank turns against the first. The second engine is then a
            mirror image of the engine in its file (y with opposite sign), so that angles in the
            file still count in its own sense of rotation.
        load: Crank with flywheel and load, which carries the whole inertia torque; "both": each
            crank carries its own torque, and the gears carry none of it. If both cranks turn alike,
            the choice makes no difference.
    """

    phase_deg: float = 0.0
    at_m: Annotated[tuple[float, ...], WrittenAs(place_in_mm, "at_mm")] = (0.0, 0.0, 0.0)
    turn_deg: float = 0.0
    reverse: bool = False
    load: str = "first"

    def __post_init__(self) -> None:
        """Raise BalcliError for a value that is infinite or too large, an unknown load, or a load
        that makes no difference.
        """
        for option, value in (("phase", self.phase_deg), ("turn", self.turn_deg)):
            if not abs(value) <= FARTHEST_DEG:
                raise BalcliError(f"--{option} {value:g}: give up to {FARTHEST_DEG:g} degrees")
        if not all(abs(value) <= FARTHEST_M for value in self.at_m):
            raise BalcliError(f"--at: give a place up to {FARTHEST_M:g} m away")
        if self.load not in LOADS:
            raise BalcliError(f'--load "{self.load[:60]}": choose from {", ".join(LOADS)}')
        if self.load != "first" and not self.reverse:
            raise BalcliError(f"--load {self.load}: makes a difference only with --reverse")


@dataclass(frozen=True, kw_only=True, repr=False)
class Combined(Result):
    """Forces and moments of two engines on their common frame, about the first one's point of
    reference.

    Geared one to one, the kinetic energies add. So the inertia torque at the first crank is T1 +
    T2, each in the sense of its own crank, whichever way they turn. The torque that the load takes
    does not act on the frame. With the load on the first crank, the roll is therefore C - (T1 +
    T2). With the load on a second crank that turns against it, the roll is C + (T1 + T2). If each
    crank has its own load, the roll is C - T1 + T2. Gas torques add in the same way, with the
    orders of both cycles; an engine without gas has none.

    Attributes:
        engines: Both engines, in the given order.
        arrangement: Position and phase of the second engine, and the crank with the load.
        state: Speed and point of reference of both.
        spectra: Orders shown, sum of both engines.
        assumed: Values that are used because an engine file leaves them out.
        peak: Largest values over a revolution, sum of all orders.
        every_order: Whether orders were given; then all of them are shown.
    """

    format: Literal["balcli.sum/1"] = "balcli.sum/1"
    engines: Annotated[tuple[Engine, Engine], WrittenAs(measure_engines)]
    arrangement: Arrangement
    state: Annotated[EngineState, INLINE]
    spectra: Annotated[Spectra, WrittenAs(list_orders, "orders")]
    assumed: tuple[str, ...] | None = None
    peak: Peaks
    every_order: Annotated[bool, HIDDEN] = False

    @property
    def summary(self) -> str:
        """Names of both engines, in words."""
        return f"of {' and '.join(engine.name or 'an engine' for engine in self.engines)}"

    @property
    def moments_known(self) -> bool:
        """Whether both engine files give the positions of their throws."""
        return all(engine.places_known for engine in self.engines)

    @property
    def peaks(self) -> list[tuple[Kind, Peak]]:
        """Force and moment, with their peaks."""
        return self.peak.items()


def combine_engines(
    first: Engine, second: Engine, arrangement: Arrangement, orders: Iterable[float] | None = None
) -> Combined:
    """Return the sum of both engines at the (possibly uneven) speed of the first; with gas if one
    of them has some.

    Args:
        first: Engine without trailing axes.
        second: Engine without trailing axes.
        arrangement: Arrangement of the second engine.
        orders: Orders to show; default: as in `analyze`.

    Raises:
        BalcliError: An order is negative or too high.
    """
    given = (first, second)
    asked = None if orders is None else check_orders(orders, given)
    second = gear_to(second, first, arrangement.phase_deg)
    computed = merge_orders(
        find_relevant_orders(first),
        find_relevant_orders(second),
        DEFAULT_ORDERS if asked is None else asked,
        *(list_gas_orders(engine) for engine in (first, second) if engine.gas is not None),
    )
    few = computed[computed <= HIGHEST_ORDER_UNASKED] if asked is None else asked
    visible = _compute_sum(first, second, arrangement, few)
    if asked is None:
        of_gas = merge_orders(*map(list_gas_orders, (first, second)))
        visible = visible.select_orders(choose_orders(visible, of_gas))
    # an engine close to locking has tens of thousands of orders, which all contribute to the peaks
    one, other = (replace(engine, gas=None) for engine in (first, second))
    return Combined(
        engines=given,
        arrangement=arrangement,
        state=describe_state(first),
        spectra=visible,
        assumed=list_assumed(("first", "second"), [e.list_assumed("gas") for e in (first, second)]),
        peak=find_peaks(_compute_sum(one, other, arrangement, computed)),
        every_order=asked is not None,
    )


def _compute_sum(first: Engine, second: Engine, arrangement: Arrangement, orders: Array) -> Spectra:
    """Return the spectra of both engines together, with gas if one of them has some."""
    about_origin = replace(second, reference_m=(0.0, 0.0, 0.0))
    one, own = (
        compute_spectra(engine, orders, KINDS if engine.gas is None else (*KINDS, GAS.name))
        for engine in (first, about_origin)
    )
    return _add_spectra(one, place_spectra(own, arrangement, first.reference_m), arrangement)


def gear_to(engine: Engine, leader: Engine, phase_deg: float) -> Engine:
    """Return an engine at the (possibly uneven) speed of another one, to which it is geared.

    Args:
        engine: Engine whose speed is replaced.
        leader: Engine that determines the speed.
        phase_deg: Crank angle by which `engine` leads, deg.
    """
    ripple = tuple(
        RippleLine(line.order, line.amplitude, line.angle_deg + line.order * phase_deg)
        for line in leader.ripple
    )
    return replace(engine.at_speed(leader.speed_rpm), ripple=ripple)


def place_spectra(
    own: Spectra, arrangement: Arrangement, reference_m: tuple[Figure, Figure, Figure]
) -> Spectra:
    """Return the phasors of an engine in its place, over the crank angle of the engine to which it
    is geared.

    Args:
        own: All kinds of inertia, and the gas torque if there is gas, about the engine's own origin
            and over its own crank angle.
        arrangement: Arrangement of the engine.
        reference_m: Point of reference of the result, in the other engine's axes.
    """
    n = own.orders
    places = zip(arrangement.at_m, reference_m, strict=True)
    x, y, z = (place - float(point) for place, point in places)
    lead = unit(n * arrangement.phase_deg)
    parts = {
        kind.name: Phasors.of(n, lead * p.forward, np.conj(lead) * p.backward, p.noise)
        for kind, p in own.items()
    }
    if arrangement.reverse:
        parts = {name: _mirror(phasors, EVERY_KIND[name]) for name, phasors in parts.items()}
    turn = unit(arrangement.turn_deg)
    force = turn * parts["force"]
    parts["force"] = force
    parts["moment"] = turn * parts["moment"] + 1j * z * force
    parts["couple"] = parts["couple"] + force.about(x + 1j * y)
    return Spectra(n, None, **{kind.name: add_parts(kind, parts) for kind, _ in own.items()})


def _mirror(phasors: Phasors, kind: Kind) -> Phasors:
    """Return phasors mirrored by a change of sign of y: a force becomes its conjugate; a moment or
    torque also changes its sign.
    """
    sign = 1.0 if kind.dimension == "force" else -1.0
    ahead, against = sign * phasors.forward.conj(), sign * phasors.backward.conj()
    mean = phasors.orders == 0
    forward, backward = np.where(mean, ahead, against), np.where(mean, 0, ahead)
    return Phasors.of(phasors.orders, forward, backward, phasors.noise)


def _add_spectra(one: Spectra, other: Spectra, arrangement: Arrangement) -> Spectra:
    """Return the sum of both engines, with torque and roll as derived in `Combined`."""
    parts = {name: one[name] + other[name] for name in ("force", "moment", "couple")}
    parts["torque"], taken = _gear(one["torque"], other["torque"], arrangement)
    parts["roll"] = parts["couple"] - taken
    if one.gas is not None or other.gas is not None:
        none = 0.0 * one["torque"]
        parts["gas"], taken_of_gas = _gear(one.gas or none, other.gas or none, arrangement)
        parts["torque_total"] = parts["torque"] + parts["gas"]
        parts["roll_total"] = parts["roll"] - taken_of_gas
    found = {name: phasors.drop_noise() for name, phasors in parts.items()}
    return Spectra(one.orders, one.up_deg, **found)


def _gear(one: Phasors, other: Phasors, arrangement: Arrangement) -> tuple[Phasors, Phasors]:
    """Return the torque at the first crank from torques on both, and the torque that the load
    takes, both about z.
    """
    sense = -1.0 if arrangement.reverse else 1.0  # sense of the second crank
    felt = one + sense * other
    taken = {"first": felt, "second": sense * felt, "both": one + other}
    return felt, taken[arrangement.load]


@tell_arguments(phase="phase_deg", at="at_m", turn="turn_deg")
def combine(
    first: Engine,
    second: Engine,
    *,
    phase_deg: float = 0.0,
    at_m: Iterable[float] = (0.0, 0.0, 0.0),
    turn_deg: float = 0.0,
    reverse: bool = False,
    load: Load = "first",
    orders: Iterable[float] | None = None,
) -> Combined:
    """Combine two engines on one frame, geared one to one: H, U and opposed-piston engines.

    Args:
        first: Engine from `load`; both run at its speed.
        second: Engine from `load`.
        phase_deg: Crank angle by which the second engine leads, in its own sense of rotation; with
            gas in a four-stroke engine up to two revolutions.
        at_m: x, y, z of its origin in the first one's axes, m.
        turn_deg: Angle by which it is turned about z.
        reverse: Whether its crank turns against the first one's.
        load: "first", "second" or "both": with `reverse`, the crank that has flywheel and load.
        orders: Orders to show; default: 1, 2 and all that are not negligible.

    Returns:
        `spectra` of both together about the first one's point of reference (N, N m), as in
        `analyze`, and the largest values in `peak`.

    Raises:
        BalcliError: A value is infinite or too large, or a load is unknown or makes no difference.
        TypeError: An argument has a wrong type.

    Example:
        >>> combine(load("i4.toml"), load("i4.toml"), phase_deg=90, at_m=(0.3, 0, 0)).peak.force
    """
    checked = check_engine("combine", first), check_engine("combine", second)
    phase = check_number("phase_deg", phase_deg, "give an angle in degrees")
    turn = check_number("turn_deg", turn_deg, "give an angle in degrees")
    check_type("reverse", reverse, bool, "give True or False")
    check_type("load", load, str, "give first, second or both")
    place = read_position("at_m", at_m)
    return combine_engines(*checked, Arrangement(phase, place, turn, reverse, load), orders)


_GEARED = "Geared one to one, kinetic energies add: the first crank feels T = T1 + T2."
_ROLL = {
    "first": "It drives the load, and the roll is C − T.",
    "second": "The second crank drives the load in the opposite sense: the roll is C + T.",
    "both": "Each crank has its own flywheel and load: the roll is C − T1 + T2.",
}


def rows(result: Combined, system: System) -> Rows:
    """Return the rows of CSV: a line for each figure of both engines together.

    Args:
        result: Both engines together.
        system: System of units.
    """
    header = ("quantity", "order", "figure", "value", "unit")
    return Rows(header, [row[1:] for row in figure_rows(result, system)])


def sheet(result: Combined, system: System) -> Sheet:
    """Return the sheet of both engines: their arrangement, and their forces and moments together.

    Args:
        result: Both engines together.
        system: System of units.
    """
    spectra = result.spectra.with_moment_if(result.moments_known)
    how, pivot = result.arrangement, tell_pivot(result.engines[0])
    roll = f"{_GEARED} {_ROLL[how.load]}" if how.reverse else ""
    parts: tuple[Facts | Grid, ...] = (
        Facts(tuple(_list_facts(result, system))),
        *order_tables(spectra, system, pivot, roll, every=result.every_order),
        peak_facts(result, system, "Largest over a revolution, all orders"),
    )
    return Sheet(" and ".join(engine.name for engine in result.engines), parts)


def _list_facts(result: Combined, system: System) -> Iterator[tuple[str, str]]:
    """Yield facts on the engines and their arrangement."""
    (first, second), how = result.engines, result.arrangement
    named = {"first": first, "second": second}
    for which, engine in named.items():
        yield which, f"{engine.name}, {counted(engine.cylinders.count, 'cylinder')}"
    place = _tell_place(how.at_m, system.length)
    yield "place", f"the second at {place}, turned by {how.turn_deg:g} deg"
    against = ", and turns against the first" if how.reverse else ""
    yield "crank", f"the second leads by {how.phase_deg:g} deg{against}"
    yield "speed", f"both at {tell_speed(first)}, the speed of the first"
    if fired := [which for which, engine in named.items() if engine.gas is not None]:
        yield "gas", f"of the {' and the '.join(fired)}{' alone' * (len(fired) == 1)}"
    if result.assumed:
        yield "assumed", tell_assumed(result.assumed)
    if result.moments_known:
        yield "reference", f"moments about {_tell_place(first.reference_m, system.length)}"
    else:
        yield "reference", "moments are not known: crank.spacing is missing"


def _tell_place(point: Iterable[Figure], unit: ShownUnit) -> str:
    return f"x, y, z = {', '.join(number(unit.of(float(v))) for v in point)} {unit.name}"


RENDERER = Renderer(sheet=sheet, rows=rows)

"""Combine two engines on one frame, geared one to one (`sum`: H, U and opposed-piston engines), and
show the result. A file with [[engine]] can describe the same two engines.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal, get_args

from ..core.records import HIDDEN, INLINE, WrittenAs
from ..engine.engine import Engine, Placed, check_engine, place_in_mm, refuse_geared
from ..engine.placed import gear_engines
from ..errors import Argument, ArgumentError, check_number, check_type
from ..file.assumed import Assumed, join_assumed
from ..file.edit import format_value
from ..file.fields import counted
from ..forces.spectrum import Spectra
from ..limits import FARTHEST_DEG, FARTHEST_M
from ..shell.arguments import read_position
from ..show.engine_facts import tell_pivot, tell_place, tell_reference, tell_speed
from ..show.figures import (
    EngineSize,
    EngineState,
    OrdersAndPeaks,
    Peaks,
    describe_state,
    figure_rows,
    list_orders,
    measure_engine,
)
from ..show.formats import Renderer, Rows
from ..show.result import Result
from ..show.sheet import Facts, Grid, Sheet, tell_assumed
from ..sizing.planes import as_millimetres
from .answer import analyze
from .order_tables import order_tables, peak_facts

if TYPE_CHECKING:
    from ..show.units import System


Load = Literal["first", "second", "both"]
LOADS: tuple[str, ...] = get_args(Load)


@dataclass(frozen=True)
class EngineOfTwo:
    """One of two engines.

    Attributes:
        size: Name and size of the engine.
        gas: Whether the engine's file has gas; left out if neither file has gas.
    """

    size: Annotated[EngineSize, INLINE]
    gas: bool | None = None


def measure_engines(engines: tuple[Engine, ...]) -> tuple[EngineOfTwo, ...]:
    """Return names and sizes of engines and, if any of them has gas, whether each has gas."""
    has_gas = [engine.gas is not None for engine in engines]
    sizes = map(measure_engine, engines)
    return tuple(map(EngineOfTwo, sizes, has_gas if any(has_gas) else [None] * len(has_gas)))


@dataclass(frozen=True)
class Arrangement:
    """Arrangement of the second engine relative to the first, and the load of both.

    Attributes:
        phase_deg: Crank angle by which the second engine leads, in its own direction of rotation.
        at_m: Position of the second engine's origin (crank axis at z = 0) in the axes of the first.
        turn_deg: Angle by which the second engine is turned about z, with all its banks.
        reverse: Whether the second crank turns against the first. The second engine is then a
            mirror image of the engine in its file (y with opposite sign), so that angles in the
            file still count in its own direction of rotation.
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
        """Raise ArgumentError for a value that is infinite or too large, an unknown load, or a load
        that makes no difference.
        """
        for argument, value in (("phase", self.phase_deg), ("turn", self.turn_deg)):
            if not abs(value) <= FARTHEST_DEG:
                raise ArgumentError(
                    "{argument} {value:g}: give up to {farthest:g} degrees",
                    argument=Argument(argument),
                    value=value,
                    farthest=FARTHEST_DEG,
                )
        if not all(abs(value) <= FARTHEST_M for value in self.at_m):
            raise ArgumentError("{at}: give a place up to {farthest:g} m away", farthest=FARTHEST_M)
        if self.load not in LOADS:
            raise ArgumentError(
                '{load} "{crank}": choose from {known}',
                crank=self.load[:60],
                known=", ".join(LOADS),
            )
        if self.load != "first" and not self.reverse:
            raise ArgumentError(
                "{load} {crank}: makes a difference only with {reverse}", crank=self.load
            )

    def place(self, first: Engine, second: Engine) -> tuple[Placed, Placed]:
        """Return both engines with their positions, phases and loads."""
        ratio = -1 if self.reverse else 1
        senses = {"first": (1, 1), "second": (ratio, ratio), "both": (1, ratio)}[self.load]
        leader = Placed(first, "first", load=self.load != "second", load_sense=senses[0])
        stands = ratio, self.phase_deg, self.turn_deg, self.at_m, self.load != "first", senses[1]
        return leader, Placed(second, "second", "", *stands)


@dataclass(frozen=True, kw_only=True, repr=False)
class Combined(OrdersAndPeaks, Result):
    """Forces and moments of two engines on their common frame, about the first engine's point of
    reference.

    Because the cranks are geared one to one, the kinetic energies of both engines add up. The
    inertia torque at the first crank is therefore T1 + T2. T1 is the inertia torque of the first
    engine and T2 that of the second, each positive in the direction of rotation of its own crank,
    whichever way the cranks turn. C is the transverse
    couple of both engines. The torque that the load takes does not act on the frame. With the load
    on the first crank, the roll is therefore C - (T1 + T2). With the load on a second crank that
    turns against the first, the roll is C + (T1 + T2). If each of two such cranks has its own load,
    the roll is C - T1 + T2. Gas torques add in the same way, with the orders of both cycles; an
    engine without gas adds no gas torque.

    Attributes:
        engines: Both engines, in the given order.
        arrangement: Position and phase of the second engine, and the crank with the load.
        state: Speed and point of reference of both engines.
        spectra: Orders shown, sum of both engines.
        assumed: Values that are used because an engine file leaves them out.
        peak: Largest values over a revolution, sum of all orders.
        every_order: Whether the caller chose the orders; if so, all of them are shown.
    """

    format: Literal["balcli.sum/1"] = "balcli.sum/1"
    engines: Annotated[tuple[Engine, Engine], WrittenAs(measure_engines)]
    arrangement: Arrangement
    state: Annotated[EngineState, INLINE]
    spectra: Annotated[Spectra, WrittenAs(list_orders, "orders")]
    assumed: tuple[Assumed, ...] | None = None
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


def combine_engines(
    first: Engine, second: Engine, arrangement: Arrangement, orders: Iterable[float] | None = None
) -> Combined:
    """Return the sum of both engines at the (possibly uneven) speed of the first; with gas if at
    least one engine has gas.

    Args:
        first: One engine, not an array of variants.
        second: One engine, not an array of variants.
        arrangement: Arrangement of the second engine.
        orders: Orders to show; default: as in `analyze`.

    Raises:
        BalcliError: An order is negative or too high; an engine consists of several engines.
    """
    for engine in (first, second):
        refuse_geared(engine)
    analysis = analyze(gear_engines(arrangement.place(first, second)), orders)
    lists = [engine.list_assumed("gas") for engine in (first, second)]
    return Combined(
        engines=(first, second),
        arrangement=arrangement,
        state=describe_state(first),
        spectra=replace(analysis.spectra, up_deg=first.up_deg),
        assumed=join_assumed(("first", "second"), lists) or None,
        peak=analysis.peak,
        every_order=orders is not None,
    )


def sum(  # noqa: A001 - the name of the command
    first: Engine,
    second: Engine,
    *,
    phase: float = 0.0,
    at: Iterable[float] = (0.0, 0.0, 0.0),
    turn: float = 0.0,
    reverse: bool = False,
    load: Load = "first",
    orders: Iterable[float] | None = None,
) -> Combined:
    """Combine two engines on one frame, geared one to one: H, U and opposed-piston engines.

    Args:
        first: Engine from `load`; both engines run at the speed of this one.
        second: Engine from `load`.
        phase: Crank angle by which the second engine leads, deg, in its own direction of
            rotation; with gas in a four-stroke engine up to two revolutions.
        at: Position x, y, z of the second engine's origin in the axes of the first, m.
        turn: Angle by which the second engine is turned about z, deg.
        reverse: Whether the second crank turns against the first.
        load: "first", "second" or "both": with `reverse`, the crank that has flywheel and load.
        orders: Orders to show; default: as in `analyze`.

    Returns:
        Forces and moments of both engines together (N, N m): orders in `spectra`, as for `analyze`,
        and largest values in `peak`. The point of reference is that of the first engine.

    Raises:
        BalcliError: A value is infinite or too large, or a load is unknown or makes no difference.
        TypeError: An argument has a wrong type.

    Example:
        >>> sum(load("i4.toml"), load("i4.toml"), phase=90, at=(0.3, 0, 0)).peak.force
    """
    checked = check_engine("sum", first), check_engine("sum", second)
    phase_deg = check_number("phase", phase, "give an angle in degrees")
    turn_deg = check_number("turn", turn, "give an angle in degrees")
    check_type("reverse", reverse, bool, "give True or False")
    check_type("load", load, str, "give first, second or both")
    arrangement = Arrangement(phase_deg, read_position("at", at), turn_deg, reverse, load)
    return combine_engines(*checked, arrangement, orders)


def describe_file(
    result: Combined, paths: Sequence[str], target: Path, speed_rpm: float | None
) -> str:
    """Return the text of a file with [[engine]] that describes both engines as they are combined.

    Args:
        result: Both engines together.
        paths: Files of the engines.
        target: Path of the new file, in the folder of the engines' files or above it.
        speed_rpm: Speed to write; None: the file has the speed of the first engine.

    Raises:
        BalcliError: An engine file is not in the folder of the new file or below.
    """
    blocks = [f"name = {format_value(' and '.join(one.name for one in result.engines))}\n"]
    if speed_rpm is not None:
        blocks.append(f"[operation]\nspeed = {format_value(speed_rpm)}\n")
    for path, placed in zip(paths, result.arrangement.place(*result.engines), strict=True):
        at = [as_millimetres(float(each)) for each in placed.at_m]
        keys = {"name": placed.name, "file": _name_beside(path, target), "ratio": placed.ratio}
        keys |= {"phase": placed.phase_deg, "at": at, "turn": placed.turn_deg, "load": placed.load}
        lines = (f"{key} = {format_value(value)}\n" for key, value in keys.items())
        blocks.append(f"[[engine]]\n{''.join(lines)}")
    return "\n".join(blocks)


def _name_beside(path: str, target: Path) -> str:
    """Return the path of an engine file relative to the folder of `target`."""
    home = target.parent.resolve()
    place = Path(path).resolve()
    if path == "-" or not place.is_relative_to(home):
        raise ArgumentError(
            "{write} {target}: {path} is not in the folder of {target} or below",
            target=target,
            path=path,
        )
    return place.relative_to(home).as_posix()


_GEARED = "The kinetic energies of geared engines add: torque on the first crank T = T1 + T2."
_ROLL = {
    "first": "The first crank drives the load: the roll is C − T.",
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
    how = result.arrangement
    pivot = tell_pivot(result.engines[0])
    roll = f"{_GEARED} {_ROLL[how.load]}" if how.reverse else ""
    parts: tuple[Facts | Grid, ...] = (
        Facts(tuple(_list_facts(result, system))),
        *order_tables(spectra, system, pivot, roll, every=result.every_order),
        peak_facts(result, system, "Largest over a revolution, all orders"),
    )
    return Sheet(" and ".join(engine.name for engine in result.engines), parts)


def _list_facts(result: Combined, system: System) -> Iterator[tuple[str, str]]:
    """Yield facts on the engines and their arrangement."""
    first, second = result.engines
    how = result.arrangement
    named = {"first": first, "second": second}
    for which, engine in named.items():
        yield which, f"{engine.name}, {counted(engine.cylinders.count, 'cylinder')}"
    place = tell_place(how.at_m, system)
    yield "place", f"the second at {place}, turned by {how.turn_deg:g} deg"
    against = ", and turns against the first" if how.reverse else ""
    yield "crank", f"the second leads by {how.phase_deg:g} deg{against}"
    yield "speed", f"both at {tell_speed(first)}, the speed of the first"
    if fired := [which for which, engine in named.items() if engine.gas is not None]:
        alone = " alone" if len(fired) == 1 else ""
        yield "gas", f"of the {' and the '.join(fired)}{alone}"
    if result.assumed:
        yield "assumed", tell_assumed(result.assumed)
    known = result.moments_known
    yield "reference", tell_reference(first.reference_m, system, known=known)


RENDERER = Renderer(sheet=sheet, rows=rows)

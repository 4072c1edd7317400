"""Silence cylinders of an engine: without gas, or compressing without burning."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from ..engine.build import build
from ..engine.engine import CylinderNumber, Engine, take_model
from ..errors import ArgumentError
from ..file.gas_tables import COMPRESSOR, Gas, GasOf, take_of
from ..file.model import EngineFile, Override
from ..forces.curves import silence
from ..shell.values import parse_cylinder

WORST = "worst"  # instead of a cylinder number: every cylinder in turn


class MisfireAsked(NamedTuple):
    """Request for cylinders that do not fire.

    Attributes:
        cylinders: Their numbers.
        worst: Whether each cylinder misfires in turn, and the worst one is kept.
        compressing: Whether they compress without burning; if not, they have no gas force.
    """

    cylinders: tuple[CylinderNumber, ...] = ()
    worst: bool = False
    compressing: bool = False


ALL_FIRE = MisfireAsked()


def ask_misfire(misfires: Sequence[str | int], compressing: bool) -> MisfireAsked:
    """Return the request that these arguments make.

    Args:
        misfires: Numbers of cylinders, as typed, or the single word "worst".
        compressing: Whether these cylinders still compress.

    Raises:
        BalcliError: "worst" stands beside a number, or `compressing` without a cylinder.
    """
    if compressing and not misfires:
        raise ArgumentError("{compressing}: no cylinder is named; give {misfire} too")
    if WORST not in misfires:
        numbers = tuple(parse_cylinder(str(number)) for number in misfires)
        return MisfireAsked(numbers, compressing=compressing)
    if len(misfires) > 1:
        others = ", ".join(str(number) for number in misfires if number != WORST) or WORST
        raise ArgumentError(
            "{misfire} worst runs every cylinder by itself; leave out {misfire} {others}",
            others=others,
        )
    return MisfireAsked(worst=True, compressing=compressing)


def stop_firing(engine: Engine, number: CylinderNumber, compressing: bool) -> Engine:
    """Return the engine with a cylinder that does not fire.

    Args:
        engine: Engine with gas.
        number: Number of the cylinder.
        compressing: Whether the cylinder compresses and expands its charge, as with `heat = 0`;
            this needs a computed cycle.

    Raises:
        BalcliError: The engine has no gas, no such cylinder, or no computed cycle for one that
            compresses.
    """
    silent = silence(engine, number)  # also refuses engines without gas and unknown cylinders
    if not compressing:
        return silent
    model = take_model(engine)
    if not computes_cycle(model, number):
        raise ArgumentError(
            "{compressing}: cylinder {number} has no computed cycle, so its compression is not "
            "known; give gas.cycle, or leave {compressing} out",
            number=number,
        )
    return _stop_burning(model, [number])


def stop_burning(engine: Engine) -> Engine:
    """Return the engine in which no cylinder burns: all that have a computed cycle compress and
    expand their charge.
    """
    model = take_model(engine)
    numbers = [number for number in list_firing(engine) if computes_cycle(model, number)]
    return _stop_burning(model, numbers)


def _stop_burning(model: EngineFile, numbers: Sequence[CylinderNumber]) -> Engine:
    for number in map(int, numbers):
        gas = model.gas
        if gas is not None and any(number in table.cylinders for table in gas.of):
            of = tuple(_take_heat_out(gas, number))
            model = model.model_copy(update={"gas": gas.model_copy(update={"of": of})})
        else:
            table = model.cylinder.get(number, Override.model_construct())
            cold = table.model_copy(update={"heat": 0.0})
            model = model.model_copy(update={"cylinder": {**model.cylinder, number: cold}})
    return build(model)


def _take_heat_out(gas: Gas, number: int) -> Iterator[GasOf]:
    """Yield the tables [[gas.of]]; one cylinder gets a table of its own, without heat."""
    for table in gas.of:
        if number not in table.cylinders:
            yield table
            continue
        others = tuple(other for other in table.cylinders if other != number)
        if others:
            yield table.model_copy(update={"cylinders": others})
        own = take_of(gas, table)
        keys = own.model_fields_set.intersection(GasOf.model_fields).difference(own.goals)
        kept = {key: getattr(own, key) for key in keys}
        yield GasOf.model_construct(**kept | {"cylinders": (number,), "heat": 0.0})


def computes_cycle(model: EngineFile, number: CylinderNumber) -> bool:
    """Return whether the gas of a cylinder follows from a computed cycle with combustion."""
    gas = model.gas
    own = model.cylinder.get(int(number))
    if gas is None or (own is not None and own.indicator is not None):
        return False
    for table in gas.of:
        if int(number) in table.cylinders:
            gas = take_of(gas, table)
    return gas.cycle not in (None, COMPRESSOR)


def compute_all_cycles(engine: Engine) -> bool:
    """Return whether the gas of every cylinder that may misfire follows from a computed cycle."""
    model = take_model(engine)
    return all(computes_cycle(model, number) for number in list_firing(engine))


def list_firing(engine: Engine) -> tuple[CylinderNumber, ...]:
    """Return the numbers of the cylinders that may misfire, rising: all but dummies."""
    fires = engine.fires_deg or {*engine.numbers}
    return tuple(number for number in engine.rising_numbers if number in fires)

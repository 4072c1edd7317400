"""Tables of an engine file about a locomotive: [locomotive] and [[axle]]. They give the axle that
carries each crank, the balance masses in the wheels, and the speed in km/h.

This module is imported only for files that have one of these tables (`names.CHAPTERS`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from contextlib import suppress
from typing import Annotated

from pydantic import Field, WrapValidator

from ..core.records import Node
from ..errors import InputError, Problem
from .fields import Number, OneOrEach, join_words, shorten
from .table import Angle, Distance, FileTable, Name, Numbers, Place, Size, Switch
from .units import (
    FORCE,
    MASS,
    PLAIN,
    STANDARD_GRAVITY,
    VELOCITY,
    convert,
    read_fraction,
)


class _Factor(Number):
    """A share from 0 to 1: a number, or a fraction or percentage in quotes."""

    def _measure(self, value: object) -> float:
        number = read_fraction(value) if isinstance(value, str) else value
        if isinstance(number, (int, float)) and 1 < number <= 100:
            raise ValueError(f'is above 1; did you mean "{number:g}%" or {number / 100:g}?')
        return super()._measure(number)

    def json(self) -> Node:
        return {"anyOf": [super().json(), {"type": "string"}]}


class _Load(Number):
    """A force; a mass stands for its weight."""

    def _measure(self, value: object) -> float:
        if isinstance(value, str):
            with suppress(ValueError):
                value = convert(value, MASS) * STANDARD_GRAVITY
        return super()._measure(value)


def _read_planes(value: object, read: Callable[[object], tuple[float, ...]]) -> tuple[float, ...]:
    """Return two positions along the axle; raise ValueError if they are not a rising pair."""
    if isinstance(value, (list, tuple)) and len(value) == 2:
        first, second = read(value)
        if first < second:
            return first, second
    message = f"{shorten(value)} is not a pair in ascending order"
    raise ValueError(f"{message}; give two z in mm, such as [-750, 750]")


FACTOR = _Factor(PLAIN, least=0, most=1)
Planes = Annotated[Place, WrapValidator(_read_planes)]
CouplingMasses = Annotated[
    float | tuple[float, ...], OneOrEach(Number(MASS, least=0, most=1e12), 2)
]
WheelLoad = Annotated[float, _Load(FORCE, above=0, most=1e12)]
NO_DIAMETER = Problem.of_missing("locomotive.wheel_diameter", "a speed in km/h needs it")


class Locomotive(FileTable):
    """A steam locomotive: x points along the track, z along the axles, and the wheels carry the
    balance masses.
    """

    factor: Annotated[float | None, FACTOR] = None
    """Share of the reciprocating mass that the wheels balance, also "2/3" or "67%"; left out: no
    balance masses are sized. Example: 0.67"""
    planes: Planes
    """z of the two planes of the balance masses, ascending. Example: [-750,
    750]"""
    radius: Size | None = None
    """Radius of the balance masses; left out: results state unbalances, not masses. Example: 800"""
    wheel_diameter: Size | None = None
    """Diameter of the wheel tread; needed for speeds in km/h. Example: 2000"""
    wheel_load: WheelLoad | None = None
    """Static load of one wheel on its rail, also as a mass ("9.5 t"); needed for the speeds at
    which wheels lift. Example: 40000"""
    speed: Annotated[float | None, Number(VELOCITY, above=0, most=1e9)] = None
    """Speed on the track, in place of operation.speed. Example: 80"""
    coupling_radius: Distance | None = None
    """Radius of the coupling-rod pins; left out: crank radius of cylinder 1. Example: 300"""
    coupling_planes: Planes | None = None
    """z of the two coupling rods, ascending. Example: [-900, 900]"""
    coupling_angles: Annotated[tuple[Angle, ...], Field(min_length=2, max_length=2)] | None = None
    """Angles of the two coupling pins from cylinder 1's crank pin. Example: [180, 270]"""

    def find_rpm(self, km_h: float) -> float:
        """Return the crank speed, rpm, at a speed on the track.

        Raises:
            InputError: The wheel diameter is missing.
        """
        if self.wheel_diameter is None:
            raise InputError([NO_DIAMETER])
        return km_h / (60e-6 * math.pi * self.wheel_diameter)

    def find_km_h(self, rpm: float) -> float | None:
        """Return the speed on the track at a crank speed; None without a wheel diameter."""
        return self.wheel_diameter and rpm * 60e-6 * math.pi * self.wheel_diameter

    def list_axles(self, given: tuple[Axle, ...]) -> tuple[Axle, ...]:
        """Return the coupled axles, front to rear: those of the file, or a single driving axle."""
        return given or (Axle.model_construct(name="driving", driving=True),)

    def find_faults(
        self,
        given: tuple[Axle, ...],
        numbers: Collection[int],
        weights: Iterable[str | None],
        rpm: float | None,
    ) -> Iterator[Problem]:
        """Yield contradictions between this table, [[axle]] and the rest of the file.

        Args:
            given: Axles of the file.
            numbers: Numbers of the cylinders in the file.
            weights: Axle that each counterweight names; None: the counterweight names no axle.
            rpm: Crank speed that the file gives; None: the file gives no crank speed.
        """
        axles = self.list_axles(given)
        if self.speed is not None and rpm is not None:
            message = f"operation.speed gives {rpm:g} rpm as well; keep one"
            yield Problem("locomotive.speed", message)
        elif self.speed is not None:
            yield NO_DIAMETER
        if any(axle.coupling_mass not in (0, (0, 0)) for axle in axles):
            needed = {"coupling_angles": "angles of its pins", "coupling_planes": "z of the rods"}
            for key in (key for key in needed if getattr(self, key) is None):
                message = f"coupling_mass needs the {needed[key]}"
                yield Problem.of_missing(f"locomotive.{key}", message)
        yield from list(_check_axles(axles)) or _check_load(axles, numbers, weights)


class Axle(FileTable):
    """A coupled axle of a locomotive, front to rear."""

    name: Name
    """Name of the axle. Example: 'leading'"""
    driving: Switch = False
    """Whether this axle is the driving axle, which has the cranks; give true for one axle only.
    Example: true"""
    cylinders: Numbers | None = None
    """Numbers of the cylinders whose cranks this axle carries (divided drive); left out: the
    driving axle carries all cranks. Example: [2, 3]"""
    part: Annotated[float, Number(PLAIN, least=0, most=1e9)] = 1.0
    """Share of the balance for reciprocating masses that this axle carries, relative to `part` of
    the other axles. Example: 1"""
    coupling_mass: CouplingMasses = 0.0
    """Revolving mass at each coupling pin: the pin, its boss and its share of the coupling rod; a
    list has a mass for each side. Example: 110"""
    wheel_load: WheelLoad | None = None
    """locomotive.wheel_load of this axle, if it differs. Example: 38000"""

    @property
    def has_cranks(self) -> bool:
        """Whether cranks stand on this axle."""
        return self.driving or self.cylinders is not None


def _check_axles(axles: Sequence[Axle]) -> Iterator[Problem]:
    """Check the axles without the rest of the file: one axle is driving, and names differ."""
    names = [axle.name for axle in axles]
    driving = [k for k, axle in enumerate(axles, 1) if axle.driving]
    if not any(axle.has_cranks for axle in axles):
        message = "no axle is driving; write driving = true for the one with the cranks"
        yield Problem("axle.driving", message)
    for k in driving[1:]:
        message = f'"{names[driving[0] - 1]}" is driving as well; mark one axle'
        yield Problem(f"axle.{k}.driving", message)
    for k, name in enumerate(names, 1):
        if (first := names.index(name) + 1) < k:
            message = f'"{name}" is the name of axle.{first} as well; give another'
            yield Problem(f"axle.{k}.name", message)
    if not any(axle.part for axle in axles):
        yield Problem("axle.1.part", "0 for every axle; give one of them a part above 0")


def _check_load(
    axles: Sequence[Axle], numbers: Collection[int], weights: Iterable[str | None]
) -> Iterator[Problem]:
    """Check that each cylinder and each counterweight stands on one axle."""
    place: dict[int, str] = {}
    cranked = {k: axle for k, axle in enumerate(axles, 1) if axle.has_cranks}
    for k, axle in cranked.items():
        for number in axle.cylinders or numbers:
            if number not in numbers:
                yield Problem(f"axle.{k}.cylinders", f"there is no cylinder {number}")
            elif number in place:
                message = f'cylinder {number} stands on "{place[number]}" as well'
                yield Problem(f"axle.{k}.cylinders", message)
            place[number] = axle.name
    if left := [str(number) for number in numbers if number not in place]:
        yield Problem("axle.cylinders", f"no axle carries cylinder {join_words(left)}")
    names = [axle.name for axle in axles]
    for k, weight in enumerate(weights, 1):
        if weight is None and len(cranked) > 1:
            message = f"several axles have cranks; name one of {join_words(names)}"
            yield Problem.of_missing(f"counterweight.{k}.axle", message)
        elif weight not in (None, *names):
            message = f'there is no axle "{weight}"; there are {join_words(names)}'
            yield Problem(f"counterweight.{k}.axle", message)

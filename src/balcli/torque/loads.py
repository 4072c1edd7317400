"""Loads of crank pins and main bearings over a cycle, at the mean speed."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..core.phasors import Array, Complex
from ..core.piecewise import Extreme, Function, resolved
from ..engine.build import Engine
from ..forces.in_bearings import compute_bearing_loads, find_breaks, place_main_bearings
from ..forces.rod_forces import compute_rod_forces, list_hung_rows

Vectors = Callable[[Array], Complex]  # N at crank angles (deg), shape (places, angles)
KINDS_OF_LOAD = ("pin", "main")


class Load(NamedTuple):
    """Load of one pin or bearing.

    Attributes:
        name: number of the cylinder whose rod turns on the pin, or of the bearing from the free
            end.
        z_m: place along the crank.
        largest: N, and the crank angle (rad) at which it is reached.
        mean: over the cycle, N.
        pressure: largest load over diameter times width, Pa; None: the file does not say these.
    """

    name: int
    z_m: float
    largest: Extreme
    mean: float
    pressure: float | None


class Loads(NamedTuple):
    """What was asked for.

    Attributes:
        pin: of crank pins, by the cylinders whose rods turn on them.
        knuckle: of the knuckle pins in master rods, by their articulated cylinders; None where
            there are none.
        main: of main bearings.
    """

    pin: tuple[Load, ...] | None = None
    knuckle: tuple[Load, ...] | None = None
    main: tuple[Load, ...] | None = None


def analyze_loads(engine: Engine, asked: tuple[str, ...] = KINDS_OF_LOAD) -> Loads:
    """Loads of pins and bearings; names of KINDS_OF_LOAD.

    The main bearings stand half-way between neighbouring throws and as far outside the end ones,
    and the shaft counts as cut in each of them.

    Raises:
        BalcliError: no gas of known pressure; main bearings that `place_main_bearings` refuses.
    """
    if not asked:
        return Loads()
    steady = replace(engine, ripple=())
    breaks = find_breaks(engine)
    sizes = engine.bearings
    pin = knuckle = main = None
    if "pin" in asked:
        z = np.ravel(engine.cylinders.z)
        area = None if sizes is None else sizes.pin_m2
        found = sorted(_measure(find_pin_loads(steady), engine.numbers, z, breaks, area))
        hung = {engine.numbers[row] for rows in list_hung_rows(engine).values() for row in rows}
        pin = tuple(load for load in found if load.name not in hung)
        others = tuple(load._replace(pressure=None) for load in found if load.name in hung)
        knuckle = others or None
    if "main" in asked:
        places, vectors = find_bearing_loads(steady)
        area = None if sizes is None else sizes.main_m2
        main = tuple(_measure(vectors, range(1, len(places) + 1), places, breaks, area))
    return Loads(pin, knuckle, main)


def find_pin_loads(engine: Engine) -> Vectors:
    """Force of each rod on its crank pin or knuckle pin, in the cylinder's frame: u along its axis
    away from the crank, v 90 deg ahead; cylinders in the order of `engine.numbers`.
    """
    return lambda degrees: compute_rod_forces(engine, degrees).pin


def find_bearing_loads(engine: Engine) -> tuple[Array, Vectors]:
    """Places of the main bearings, m, and the force of the shaft on each, x + iy; errors as of
    `place_main_bearings`.
    """
    span = place_main_bearings(engine)
    return span, lambda degrees: compute_bearing_loads(engine, degrees)


def _measure(
    vectors: Vectors, names: Iterable[int], places: Array, breaks: Array, area: float | None
) -> Iterator[Load]:
    """Largest and mean size of each vector over the cycle."""
    for row, (name, z) in enumerate(zip(names, places.tolist(), strict=True)):
        square = resolved(_squared(vectors, row), breaks)
        largest = square.extremes()[1]
        size = float(np.sqrt(largest.value))
        mean = resolved(_sized(vectors, row), breaks).mean
        pressure = None if area is None else size / area
        yield Load(name, z, Extreme(largest.angle, size), mean, pressure)


def _sized(vectors: Vectors, row: int) -> Function:
    """|F| likewise."""
    squared = _squared(vectors, row)
    return lambda angle: np.sqrt(squared(angle))


def _squared(vectors: Vectors, row: int) -> Function:
    """|F|^2 of one vector at crank angles (rad) of any shape: smooth where F passes 0."""

    def at(angle: Array) -> Array:
        found = vectors(np.degrees(angle.reshape(-1)))[row]
        return (found.real**2 + found.imag**2).reshape(angle.shape)

    return at

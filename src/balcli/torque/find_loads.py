"""Loads of crank pins and main bearings over a cycle, at the mean speed."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

import numpy as np

from ..core.phasors import Array, Complex
from ..core.piecewise import Extreme
from ..core.vectors_over_cycle import Vectors, find_panels
from ..engine.build import Engine
from ..forces.in_bearings import (
    NOTHING,
    BearingsUnknownError,
    compute_bearing_loads,
    compute_in_pieces,
    find_breaks,
    place_main_bearings,
)
from ..forces.rod_forces import compute_rod_forces, list_hung_rows
from .loads import KINDS_OF_LOAD, CycleLoad, CycleLoads


def analyze_loads(engine: Engine, asked: tuple[str, ...] = KINDS_OF_LOAD) -> CycleLoads:
    """Loads of pins and bearings; names of KINDS_OF_LOAD.

    The main bearings stand half-way between neighbouring throws and as far outside the end ones,
    and the shaft counts as cut in each of them. Where `place_main_bearings` refuses them, those of
    pins are told without.

    Raises:
        BalcliError: no gas of known pressure; refused main bearings that are asked for alone.
    """
    steady, sizes = replace(engine, ripple=()), engine.bearings
    pin = knuckle = main = None
    obstacle = ""
    if "pin" in asked:
        area = None if sizes is None else sizes.pin_m2
        z = np.ravel(engine.cylinders.z)
        found = sorted(_measure(steady, find_pin_loads(steady), engine.numbers, z, area))
        hung = {engine.numbers[row] for rows in list_hung_rows(engine).values() for row in rows}
        pin = tuple(load for load in found if load.name not in hung)
        others = tuple(load._replace(pressure=None) for load in found if load.name in hung)
        knuckle = others or None
    if "main" in asked:
        area = None if sizes is None else sizes.main_m2
        try:
            places, vectors = find_bearing_loads(steady)
        except BearingsUnknownError as error:
            if pin is None:
                raise
            obstacle = error.reason
        else:
            main = tuple(_measure(steady, vectors, range(1, len(places) + 1), places, area))
    return CycleLoads(pin, knuckle, main, obstacle)


def find_pin_loads(engine: Engine) -> Vectors:
    """Force of each rod on its crank pin or knuckle pin at crank angles (deg), in the cylinder's
    frame: u along its axis away from the crank, v 90 deg ahead; cylinders in the order of
    `engine.numbers`.
    """
    return lambda degrees: compute_rod_forces(engine, degrees).pin


def find_bearing_loads(engine: Engine) -> tuple[Array, Vectors]:
    """Places of the main bearings, m, and the force of the shaft on each at crank angles (deg), x +
    iy; errors as of `place_main_bearings`.
    """
    span = place_main_bearings(engine)
    return span, lambda degrees: compute_bearing_loads(engine, degrees)


def _measure(
    engine: Engine, vectors: Vectors, names: Iterable[int], places: Array, area: float | None
) -> Iterator[CycleLoad]:
    """Largest and mean size of each vector over the cycle; 0 where it is rounding beside others."""

    def compute(angles: Array) -> Complex:
        return compute_in_pieces(engine, vectors, angles)

    panels = find_panels(compute, find_breaks(engine), 1.0)
    every = compute(panels.angles)
    every[np.abs(every).max(axis=1) <= NOTHING * np.abs(every).max()] = 0.0
    for name, z, samples in zip(names, places.tolist(), every, strict=True):
        size, angle, _ = panels.find_largest(samples)
        mean = panels.find_mean_size(samples)
        yield CycleLoad(name, z, Extreme(angle, size), mean, None if area is None else size / area)

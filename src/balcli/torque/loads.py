"""Loads of crank pins and main bearings over a cycle, at the mean speed."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from ..core.phasors import Array, Complex
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

KINDS_OF_LOAD = ("pin", "main")


@dataclass(frozen=True, kw_only=True)
class PinLoad:
    """Load of a crank pin or knuckle pin over the cycle.

    Attributes:
        cylinder: Number of the cylinder whose rod turns on the pin.
        max_N: Largest load.
        max_deg: Crank angle at which it is reached.
        mean_N: Mean load.
        pressure_Pa: Largest load over diameter times width; left out where the file does not say
            these.
    """

    cylinder: int
    max_N: float
    max_deg: float
    mean_N: float
    pressure_Pa: float | None = None


@dataclass(frozen=True, kw_only=True)
class MainLoad:
    """Load of a main bearing over the cycle.

    Attributes:
        bearing: Number from the free end.
        position_mm: Place along the crank.
        max_N: Largest load.
        max_deg: Crank angle at which it is reached.
        mean_N: Mean load.
        pressure_Pa: Largest load over diameter times width; left out where the file does not say
            these.
    """

    bearing: int
    position_mm: float
    max_N: float
    max_deg: float
    mean_N: float
    pressure_Pa: float | None = None


@dataclass(frozen=True, kw_only=True)
class CycleLoads:
    """Loads of pins and bearings, as far as they were asked for.

    Attributes:
        pin: Loads of crank pins, by the cylinders whose rods turn on them.
        knuckle: Loads of the knuckle pins in master rods, by their articulated cylinders.
        main: Loads of main bearings.
        obstacle: Why these are not known, though asked for with others.
    """

    pin: tuple[PinLoad, ...] | None = None
    knuckle: tuple[PinLoad, ...] | None = None
    main: tuple[MainLoad, ...] | None = None
    obstacle: str | None = None


def analyze_loads(engine: Engine, asked: Iterable[str] = KINDS_OF_LOAD) -> CycleLoads:
    """Return loads of pins and bearings.

    The main bearings stand half-way between neighbouring throws and as far outside the end ones,
    and the shaft counts as cut in each of them. Where `place_main_bearings` refuses them, the
    loads of pins come without.

    Args:
        engine: With gas.
        asked: Names of KINDS_OF_LOAD.

    Raises:
        BalcliError: No gas of known pressure; refused main bearings that are asked for alone.
    """
    steady, sizes = replace(engine, ripple=()), engine.bearings
    pin = knuckle = main = obstacle = None
    if "pin" in asked:
        area = None if sizes is None else sizes.pin_m2
        found = _measure(steady, find_pin_loads(steady), area)
        loads = [PinLoad(cylinder=n, **f) for n, f in zip(engine.numbers, found, strict=True)]
        loads.sort(key=lambda load: load.cylinder)
        hung = {engine.numbers[row] for rows in list_hung_rows(engine).values() for row in rows}
        pin = tuple(load for load in loads if load.cylinder not in hung)
        others = [replace(load, pressure_Pa=None) for load in loads if load.cylinder in hung]
        knuckle = tuple(others) or None
    if "main" in asked:
        area = None if sizes is None else sizes.main_m2
        try:
            places, vectors = find_bearing_loads(steady)
        except BearingsUnknownError as error:
            if pin is None:
                raise
            obstacle = error.reason
        else:
            each = enumerate(zip(places.tolist(), _measure(steady, vectors, area), strict=True), 1)
            main = tuple(MainLoad(bearing=k, position_mm=z * 1e3, **f) for k, (z, f) in each)
    return CycleLoads(pin=pin, knuckle=knuckle, main=main, obstacle=obstacle)


def find_pin_loads(engine: Engine) -> Vectors:
    """Return the force of each rod on its crank pin or knuckle pin at crank angles (deg), in the
    cylinder's frame: u along its axis away from the crank, v 90 deg ahead; cylinders in the order
    of `engine.numbers`.
    """
    return lambda degrees: compute_rod_forces(engine, degrees).pin


def find_bearing_loads(engine: Engine) -> tuple[Array, Vectors]:
    """Return places of the main bearings, m, and the force of the shaft on each at crank angles
    (deg), x + iy; errors as of `place_main_bearings`.
    """
    span = place_main_bearings(engine)
    return span, lambda degrees: compute_bearing_loads(engine, degrees)


def _measure(engine: Engine, vectors: Vectors, area: float | None) -> Iterator[dict[str, float]]:
    """Yield the figures of each vector over the cycle; 0 where it is rounding beside others."""

    def compute(angles: Array) -> Complex:
        return compute_in_pieces(engine, vectors, angles)

    breaks = find_breaks(engine)
    panels = find_panels(compute, breaks, 1.0)
    every = compute(panels.angles)
    every[np.abs(every).max(axis=1) <= NOTHING * np.abs(every).max()] = 0.0
    for samples in every:
        size, angle, _ = panels.find_largest(samples)
        at = float(np.degrees(angle)) % float(np.degrees(breaks[-1]))
        found = {"max_N": size, "max_deg": at, "mean_N": panels.find_mean_size(samples)}
        yield found if area is None else found | {"pressure_Pa": size / area}

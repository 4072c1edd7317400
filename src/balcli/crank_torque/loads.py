"""Compute loads of crank pins, knuckle pins and main bearings over a cycle, at the mean speed."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from ..core.piecewise import Vectors, find_panels
from ..core.records import Asked
from ..engine.engine import Engine
from ..forces.loads_with_gas import (
    ROUNDING,
    BearingsUnknownError,
    compute_bearing_loads,
    compute_in_pieces,
    find_breaks,
    place_main_bearings,
)
from ..forces.rod_forces import compute_rod_forces, list_hung_rows
from .rod_loads import RodLoad, measure_rod_loads

KINDS_OF_LOAD = ("pin", "main", "rod")


@dataclass(frozen=True, kw_only=True)
class CycleLoad:
    """Load of a crank pin, knuckle pin or main bearing over the cycle.

    Attributes:
        cylinder: Number of the cylinder whose rod turns on the pin.
        bearing: Number of the main bearing, counted from the free end.
        position_mm: Position of the main bearing along the crank.
        max_N: Largest load.
        max_deg: Crank angle of the largest load.
        mean_N: Mean load.
        pressure_Pa: Largest load divided by diameter times width; left out if the file does not
            give both.
    """

    cylinder: int | None = None
    bearing: int | None = None
    position_mm: float | None = None
    max_N: float
    max_deg: float
    mean_N: float
    pressure_Pa: float | None = None


@dataclass(frozen=True, kw_only=True, eq=False)
class CycleLoads:
    """Requested loads of pins and bearings.

    Attributes:
        pin: Loads of crank pins, by the cylinders whose rods turn on them.
        knuckle: Loads of the knuckle pins in master rods, by the cylinders whose articulated rods
            turn on them.
        main: Loads of main bearings.
        rod: Loads along the piston rods.
        obstacle: Reason why requested loads of main bearings are unknown. It is given only if
            loads of pins were requested as well; otherwise an error states the reason.
    """

    pin: Asked[tuple[CycleLoad, ...]] = Asked('loads=["pin"]')
    knuckle: tuple[CycleLoad, ...] | None = None
    main: Asked[tuple[CycleLoad, ...]] = Asked('loads=["main"]')
    rod: Asked[tuple[RodLoad, ...]] = Asked('loads=["rod"]')
    obstacle: str | None = None


def analyze_loads(engine: Engine, asked: Iterable[str] = ("pin", "main")) -> CycleLoads:
    """Return loads of pins, bearings and piston rods.

    Unless the file gives main bearings, they are assumed half-way between neighbouring throws, and
    the end bearings the same distance outside the end throws. The shaft is treated as cut at each
    bearing. If the positions of bearings are unknown but loads of pins are requested as well, the
    result has the loads of pins and, as `obstacle`, the reason.

    Args:
        engine: Engine with gas.
        asked: Requested loads, names from KINDS_OF_LOAD.

    Raises:
        BalcliError: The gas pressure is unknown, or only main bearings are requested and their
            positions are unknown.
    """
    steady = replace(engine, ripple=())
    sizes = engine.bearings
    pin = knuckle = main = obstacle = None
    rod = measure_rod_loads(steady) if "rod" in asked else None
    if "pin" in asked:
        # forces on crank or knuckle pins; the real part is outward along the cylinder's axis
        area = sizes and sizes.pin_m2
        forces = _measure(steady, lambda at: compute_rod_forces(steady, at).pin, area)
        loads = [replace(f, cylinder=int(n)) for n, f in zip(engine.numbers, forces, strict=True)]
        loads.sort(key=lambda load: load.cylinder or 0)
        hung = {engine.numbers[row] for rows in list_hung_rows(engine).values() for row in rows}
        pin = tuple(load for load in loads if load.cylinder not in hung)
        knuckle = tuple(replace(x, pressure_Pa=None) for x in loads if x.cylinder in hung) or None
    if "main" in asked:
        try:
            places = place_main_bearings(steady)
            vectors = partial(compute_bearing_loads, steady)
        except BearingsUnknownError as error:
            if pin is None and rod is None:
                raise
            obstacle = error.reason
        else:
            forces = _measure(steady, vectors, sizes and sizes.main_m2)
            each = enumerate(zip(places.tolist(), forces, strict=True), 1)
            main = tuple(replace(f, bearing=k, position_mm=z * 1e3) for k, (z, f) in each)
    return CycleLoads(pin=pin, knuckle=knuckle, main=main, rod=rod, obstacle=obstacle)


def _measure(engine: Engine, vectors: Vectors, area: float | None) -> Iterator[CycleLoad]:
    """Yield the load of each pin or bearing over the cycle from its force vectors. Forces that are
    rounding errors compared with the largest force become 0.
    """

    compute = partial(compute_in_pieces, engine, vectors)
    breaks = find_breaks(engine)
    panels = find_panels(compute, breaks, 1.0)
    every = compute(panels.angles)
    every[np.abs(every).max(axis=1) <= ROUNDING * np.abs(every).max()] = 0.0
    for samples in every:
        size, angle, _ = panels.find_largest(samples)
        yield CycleLoad(
            max_N=size,
            max_deg=float(np.degrees(angle)) % float(np.degrees(breaks[-1])),
            mean_N=panels.find_mean_size(samples),
            pressure_Pa=None if area is None else size / area,
        )

"""Loads of crank pins and main bearings over a cycle, at the mean speed."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..core.levers import share_by_lever
from ..core.phasors import Array, Complex, unit
from ..core.piecewise import Extreme, Function, merged_breaks, resolved
from ..engine.build import Engine
from ..errors import BalcliError
from ..forces.crankshaft import is_counterweight, place_bearings
from ..forces.gas import take_gas
from ..forces.rod_forces import compute_rod_forces

Vectors = Callable[[Array], Complex]  # N at crank angles (deg), shape (places, angles)
KINDS_OF_LOAD = ("pin", "main")


class Load(NamedTuple):
    """Load of one pin or bearing.

    Attributes:
        name: number of the cylinder whose rod is on the pin, or of the bearing from the free end.
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
    """What was asked for; `main` is None for a crank whose bearings the file cannot tell."""

    pin: tuple[Load, ...] | None = None
    main: tuple[Load, ...] | None = None


def analyze_loads(engine: Engine, asked: tuple[str, ...] = KINDS_OF_LOAD) -> Loads:
    """Loads of pins and bearings; names of KINDS_OF_LOAD.

    The main bearings stand half-way between neighbouring throws and as far outside the end ones,
    and the shaft counts as cut in each of them.

    Raises:
        BalcliError: no gas of known pressure; articulated or turning cylinders; main bearings of
            throws whose places are not known.
    """
    if not asked:
        return Loads()
    steady = replace(engine, ripple=())
    breaks = _find_breaks(engine)
    sizes = engine.bearings
    pin = main = None
    if "pin" in asked:
        z = np.ravel(engine.cylinders.z)
        area = None if sizes is None else sizes.pin_m2
        found = _measure(find_pin_loads(steady), engine.numbers, z, breaks, area)
        pin = tuple(sorted(found))
    if "main" in asked and (bearings := find_bearing_loads(steady)) is not None:
        places, vectors = bearings
        area = None if sizes is None else sizes.main_m2
        main = tuple(_measure(vectors, range(1, len(places) + 1), places, breaks, area))
    return Loads(pin, main)


def find_pin_loads(engine: Engine) -> Vectors:
    """Force of each rod on its crank pin, in the cylinder's frame: u along its axis away from the
    crank, v 90 deg ahead; cylinders in the order of `engine.numbers`.
    """
    return lambda degrees: compute_rod_forces(engine, degrees).pin


def find_bearing_loads(engine: Engine) -> tuple[Array, Vectors] | None:
    """Places of the main bearings, m, and the force of the shaft on each, x + iy; None for a crank
    with one throw.

    Raises:
        BalcliError: it is not known where the throws stand.
    """
    if not engine.places_known:
        raise BalcliError("main: crank.spacing is missing, so that no bearing is known to stand")
    span = place_bearings(engine.throws_m)
    if span is None:
        return None
    c = engine.cylinders
    counterweights = [device for device in engine.devices if is_counterweight(device)]
    z = np.array([*np.ravel(c.z), *(float(device.z) for device in counterweights)])
    shares, square = share_by_lever(z, span), float(engine.omega) ** 2
    axes = unit(np.ravel(c.axis_of_each_deg))[:, None]
    pins_deg = float(engine.first_axis_deg) + np.ravel(c.pin_deg)[:, None]
    throws = np.array([[float(weighed.share)] for weighed in engine.weighed]) * float(c.radius)
    devices = np.array([[complex(device.forward)] for device in counterweights]).reshape(-1, 1)

    def vectors(degrees: Array) -> Complex:
        on_pins = axes * compute_rod_forces(engine, degrees).pin
        turning = throws * square * unit(degrees + pins_deg)
        of_devices = devices * square * unit(degrees)
        return shares @ np.concatenate([on_pins + turning, of_devices])

    return span, vectors


def _find_breaks(engine: Engine) -> Array:
    gas = take_gas(engine)
    parts = [(cylinder.torque.breaks, cylinder.fires) for cylinder in gas.cylinders]
    return merged_breaks(parts, gas.cycle)


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

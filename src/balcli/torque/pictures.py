"""What pictures of gas, torque and loads show: curves at close angles over one cycle."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple, TypeAlias

import numpy as np

from ..core.phasors import Array, Complex, unit
from ..core.speed_variation import Surplus, surplus
from ..engine.build import Engine
from ..forces.gas import take_gas
from ..forces.rod_forces import compute_rod_forces, list_hung_rows
from .course import find_torque_curves
from .loads import find_bearing_loads

PAGES = ("pressure", "p-v", "torque", "pin", "main")
_STEP = 0.5  # deg
_BESIDE = 1e-7  # deg, on both sides of a jump


class Pressures(NamedTuple):
    """Pressure that counts in cylinder 1 over its cycle, each of shape (angles,).

    Attributes:
        cycle_deg: from one gas-exchange dead centre to the next, 0 at firing.
        pressure: Pa.
        volume: m3; above the smallest volume if the clearance is not known.
        clearance_known: whether the compression ratio is given.
    """

    cycle_deg: Array
    pressure: Array
    volume: Array
    clearance_known: bool


class Torques(NamedTuple):
    """Torque over a cycle, N m, each of shape (angles,), its mean and the surplus above that."""

    crank_deg: Array
    gas: Array
    inertia: Array
    total: Array
    mean: float
    surplus: Surplus


class PinLoads(NamedTuple):
    """Force of the rod on cylinder 1's crank pin, N, shape (angles,).

    Attributes:
        crank_deg: crank angles.
        in_crank: force seen from the crank, real outward along the throw.
        in_rod: force seen from the rod, real towards the piston.
        cylinder: number of the cylinder whose rod it is: 1, or its master rod's.
    """

    crank_deg: Array
    in_crank: Complex
    in_rod: Complex
    cylinder: int


class MainLoads(NamedTuple):
    """Force of the shaft on each main bearing as block and shaft feel it, N, shape (bearings,
    angles).
    """

    crank_deg: Array
    in_block: Complex
    in_shaft: Complex


GasPicture: TypeAlias = Pressures | Torques | PinLoads | MainLoads  # what one of PAGES shows


def compute_picture(engine: Engine, what: str) -> GasPicture:
    """Return what a page of `PAGES` shows, at the mean speed.

    Raises:
        BalcliError: the engine has no gas, or lacks what the page shows.
    """
    compute: dict[str, Callable[[Engine], GasPicture]] = {
        "torque": _find_torques,
        "pin": _find_pin,
        "main": _find_main,
    }
    return compute.get(what, _find_pressures)(replace(engine, ripple=()))


def _find_pressures(engine: Engine) -> Pressures:
    gas = take_gas(engine)
    cylinder = gas.cylinders[engine.numbers.index(1)]
    half = gas.cycle_deg / 2
    angle = _divide(-half, half, np.degrees(cylinder.torque.breaks), gas.cycle_deg)
    at = np.radians(angle)
    known = gas.compression_ratio is not None
    volume = cylinder.piston.volume(at, gas.compression_ratio or math.inf)
    return Pressures(angle, cylinder.find_pressure(at), volume, known)


def _find_torques(engine: Engine) -> Torques:
    curves = find_torque_curves(engine)
    cycle = take_gas(engine).cycle_deg
    angle = _divide(0.0, cycle, np.degrees(curves.gas.breaks), cycle)
    at = np.radians(angle)
    gas, total = curves.gas.at(at), curves.total.at(at)
    return Torques(angle, gas, total - gas, total, curves.total.mean, surplus(curves.total))


def _find_pin(engine: Engine) -> PinLoads:
    first = engine.numbers.index(1)
    on_pin = (master for master, hung in list_hung_rows(engine).items() if first in hung)
    row = next(on_pin, first)
    angle = np.arange(0.0, take_gas(engine).cycle_deg + _STEP / 2, _STEP)
    found = compute_rod_forces(engine, angle)
    pin, number = found.pin[row], engine.numbers[row]
    return PinLoads(angle, pin / found.throw[row], pin / found.lean[row], number)


def _find_main(engine: Engine) -> MainLoads:
    angle = np.arange(0.0, take_gas(engine).cycle_deg + _STEP / 2, _STEP)
    loads = find_bearing_loads(engine)[1](angle)
    return MainLoads(angle, loads, loads * unit(-angle))


def _divide(low: float, high: float, breaks: Array, cycle: float) -> Array:
    """Return angles every half degree, and on both sides of each break."""
    inside = low + np.remainder(breaks - low, cycle)
    every = [np.arange(low, high + _STEP / 2, _STEP), inside - _BESIDE, inside + _BESIDE]
    found = np.sort(np.concatenate(every))
    return found[(found >= low) & (found <= high)]

"""How a charge burns: Otto, Diesel, dual (limited pressure), Wiebe.

Heat Q acts by `d(p V^n) = (n - 1) V^(n-1) dQ`, n the index of expansion. So `p V^n` after the burn
follows from the heat alone, its derivative by the heat is `(n - 1) V^(n-1)` where the last heat
comes, and the pressure under way is a quadrature: nothing is stepped in time.

Sources: the ideal cycles are those of every textbook (Heywood, Internal Combustion Engine
Fundamentals, 1988, 5.4); Wiebe's law is `x = 1 - exp(-6.908 xi^(m+1))` (1956), by which 99.9 % of
the heat are released within the duration.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, NamedTuple, TypeAlias

import numpy as np

from .cylinder_pressure import GasError, GasPiston
from .phasors import Array
from .piecewise import Function, resolved

_BURNT = 6.908  # -ln 0.001


# ---------------------------------------------------------------- what is given
@dataclass(frozen=True)
class Otto:
    """All heat at the dead centre."""

    goals: ClassVar = ("imep", "heat", "max_pressure")


@dataclass(frozen=True)
class Diesel:
    """Heat at the constant pressure that compression reaches."""

    goals: ClassVar = ("imep", "heat", "cut_off")


@dataclass(frozen=True)
class Dual:
    """Heat at the dead centre up to `max_pressure` (Pa), then at that pressure."""

    max_pressure: float
    goals: ClassVar = ("imep", "heat", "cut_off")


@dataclass(frozen=True)
class Wiebe:
    """Heat by Wiebe's law; cycle angles in deg, `shape` is its exponent m >= 0."""

    start_deg: float
    duration_deg: float
    shape: float = 2.0
    goals: ClassVar = ("imep", "heat", "max_pressure")


Burn: TypeAlias = Otto | Diesel | Dual | Wiebe


# ---------------------------------------------------------------- what follows
class PressureLaw(NamedTuple):
    """A law of pressure (Pa at cycle angles, rad), and where it ends."""

    end: float
    law: Function


class Charge(NamedTuple):
    """The compressed gas from which on the index of expansion holds, and what it expands in."""

    pressure: float  # Pa
    volume: float  # m3
    exponent: float  # n
    final: float  # volume when the exhaust opens, m3
    piston: GasPiston
    volume_at: Function  # m3 at cycle angles

    @property
    def constant(self) -> float:
        """p V^n before the burn."""
        return self.pressure * self.volume**self.exponent


class Combustion(NamedTuple):
    """The burn of a charge, by the heat supplied in a cycle, J."""

    least: float  # heat with which the burn is one, J
    most: float
    released: float  # share of the heat
    after: Callable[[float], tuple[float, float]]  # p V^n after the burn, and its rate by the heat
    pieces: Callable[[float], list[PressureLaw]]  # from the charge to the end of the burn
    heat_for: Callable[[float], float]  # of the goal that is neither heat nor imep


def combustion(charge: Charge, burn: Burn) -> Combustion:
    """The burn in this charge.

    Raises:
        GasError: for a `max_pressure` that compression exceeds.
    """
    match burn:
        case Otto():
            return _at_constant_volume(charge)
        case Diesel():
            return _at_limited_pressure(charge, charge.pressure)
        case Dual():
            if burn.max_pressure < charge.pressure:
                raise _too_low(burn.max_pressure, charge.pressure)
            return _at_limited_pressure(charge, burn.max_pressure)
        case Wiebe():
            return _gradual(charge, burn)


def _at_constant_volume(charge: Charge) -> Combustion:
    n, volume = charge.exponent, charge.volume
    unit = (n - 1) * volume ** (n - 1)

    def heat_for(max_pressure: float) -> float:
        if max_pressure < charge.pressure:
            raise _too_low(max_pressure, charge.pressure)
        return (max_pressure - charge.pressure) * volume / (n - 1)

    return Combustion(
        least=0.0,
        most=math.inf,
        released=1.0,
        after=lambda heat: (charge.constant + unit * heat, unit),
        pieces=lambda heat: [],
        heat_for=heat_for,
    )


def _at_limited_pressure(charge: Charge, limit: float) -> Combustion:
    """Heat at constant volume up to the pressure `limit`, the rest at that pressure."""
    n, volume, piston = charge.exponent, charge.volume, charge.piston
    least = (limit - charge.pressure) * volume / (n - 1)
    share = n / (n - 1) * limit  # J that widen the charge by 1 m3

    def last_volume(heat: float) -> float:
        return volume + (heat - least) / share

    def after(heat: float) -> tuple[float, float]:
        last = last_volume(heat)
        return limit * last**n, (n - 1) * last ** (n - 1)

    def pieces(heat: float) -> list[PressureLaw]:
        end = piston.angle_of((last_volume(heat) - volume) / piston.area)
        return [PressureLaw(end, constant(limit))]

    return Combustion(
        least=least,
        most=least + share * (charge.final - volume),
        released=1.0,
        after=after,
        pieces=pieces,
        heat_for=lambda cut_off: least + share * (cut_off - 1) * volume,
    )


def _gradual(charge: Charge, burn: Wiebe) -> Combustion:
    """Heat by Wiebe's law."""
    n, volume_at = charge.exponent, charge.volume_at
    start = math.radians(burn.start_deg)
    end = start + math.radians(burn.duration_deg)
    growth = _growth(charge, start, end, burn.shape)
    unit = (n - 1) * float(growth(np.array(end)))

    def unburnt(angle: Array) -> Array:
        return charge.constant / volume_at(angle) ** n

    def by_heat(angle: Array) -> Array:
        return (n - 1) * growth(angle) / volume_at(angle) ** n

    def heat_for(max_pressure: float) -> float:
        """The pressure is linear in the heat everywhere: the goal is first reached where the least
        heat will do.
        """
        breaks = [start, end] if end >= 0 else [start, end, 0.0]
        highest = max(charge.pressure, resolved(unburnt, breaks).extremes()[1].value)
        if max_pressure <= highest:
            raise _too_low(max_pressure, highest)
        most = resolved(lambda c: by_heat(c) / (max_pressure - unburnt(c)), breaks).extremes()[1]
        return 1 / most.value

    return Combustion(
        least=0.0,
        most=math.inf,
        released=-math.expm1(-_BURNT),
        after=lambda heat: (charge.constant + unit * heat, unit),
        pieces=lambda heat: [
            PressureLaw(start, unburnt),
            PressureLaw(end, lambda angle: unburnt(angle) + heat * by_heat(angle)),
        ],
        heat_for=heat_for,
    )


def _growth(charge: Charge, start: float, end: float, shape: float) -> Function:
    """The integral of V^(n-1) dx from `start` on, at cycle angles.

    By parts it is `x V^(n-1) - (n-1) integral of x V^(n-2) dV`: x is smoother than its rate,
    whatever the exponent.
    """
    n, volume_at, piston = charge.exponent, charge.volume_at, charge.piston

    def burnt(angle: Array) -> Array:
        xi = np.clip((angle - start) / (end - start), 0, 1)
        return -np.expm1(-_BURNT * xi ** (shape + 1))

    def widening(angle: Array) -> Array:
        volume, rate = volume_at(angle), piston.area * piston.rate(angle)
        return (n - 1) * burnt(angle) * volume ** (n - 2) * rate

    lost = resolved(widening, [start, end]).antiderivative()

    def growth(angle: Array) -> Array:
        at = np.clip(angle, start, end)
        return burnt(at) * volume_at(at) ** (n - 1) - lost.within(at)

    return growth


def _too_low(wanted: float, compressed: float) -> GasError:
    return GasError(
        "max_pressure",
        f"is {wanted / 1e5:g} bar, below the {compressed / 1e5:.4g} bar of compression alone",
    )


def constant(pressure: float) -> Function:
    """The law p = const."""
    return lambda angle: np.full(angle.shape, pressure)


def polytrope(volume_at: Function, constant: float, index: float) -> Function:
    """The law p V^n = const."""
    return lambda angle: constant / volume_at(angle) ** index

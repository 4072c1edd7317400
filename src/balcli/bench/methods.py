"""All the ways to the same figures: two-term formula, printed series, closed form, FFT of samples,
time stepping.

Each is written as one would write it, with numpy and without the rest of the program (but for the
closed form, which is it).
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import NamedTuple

import numpy as np

from ..core.mechanisms import closed_form, power_series
from ..core.phasors import Array, Complex
from ..engine.build import Engine
from ..forces.spectrum import compute_spectra

POWERS = (3, 5, 7)  # of lambda, up to which books print the series
POINTS = (8, 16, 32, 64)
SAMPLES = (64, 360, 720, 3600)
EXACT_POWER = 81  # lambda^81 is below 1e-40 at lambda = 0.3

Coefficients = Callable[[list[int], float], Array]


def exact(orders: list[int], lam: float) -> Array:
    """A_n to the last digit: the series in exact fractions, far beyond the last power that
    matters.
    """
    x = Fraction(lam)
    return np.array(
        [
            float(sum(c * x**p for p, c in power_series.piston(n, EXACT_POWER).items()))
            for n in orders
        ]
    )


def two_term(orders: list[int], lam: float) -> Array:
    """`cos psi + lambda cos 2 psi`."""
    return np.array([{1: 1.0, 2: lam}.get(n, 0.0) for n in orders])


def printed(power: int) -> Coefficients:
    """The series that books print, up to a power of lambda."""
    terms = {
        n: [(p, float(c)) for p, c in power_series.piston(n, power).items() if p <= power]
        for n in range(1, 65)
    }

    def evaluate(orders: list[int], lam: float) -> Array:
        return np.array([sum(c * lam**p for p, c in terms[n]) for n in orders])

    return evaluate


def find_closed_form(orders: list[int], lam: float) -> Array:
    """As balcli computes them."""
    return closed_form.piston(orders, lam)


def transformed(points: int) -> Coefficients:
    """The acceleration's formula, sampled and transformed."""

    def evaluate(orders: list[int], lam: float) -> Array:
        psi = 2 * np.pi * np.arange(points) / points
        return _picked(np.fft.rfft(_acceleration(psi, lam)).real * (2 / points), orders)

    return evaluate


def stepped(samples: int) -> Coefficients:
    """The piston's place at equal steps of time, its second differences, and their sums with cos n
    psi.
    """

    def evaluate(orders: list[int], lam: float) -> Array:
        psi = 2 * np.pi * np.arange(samples) / samples
        acceleration = -_second_difference(
            np.cos(psi) + np.sqrt(1 - (lam * np.sin(psi)) ** 2) / lam
        )
        return np.array([2 / samples * float(acceleration @ np.cos(n * psi)) for n in orders])

    return evaluate


def _acceleration(psi: Array, lam: float) -> Array:
    """Of the piston at crank angles (rad), in crank radii by the square of the speed."""
    cosine, sine = np.cos(psi), np.sin(psi)
    cos_beta = np.sqrt(1 - (lam * sine) ** 2)
    return cosine - lam * sine**2 / cos_beta + lam * cosine**2 / cos_beta**3


def _second_difference(place: Array | Complex) -> Array | Complex:
    """By the square of the step, along the last axis, which is one revolution."""
    step = 2 * np.pi / place.shape[-1]
    return (np.roll(place, -1, axis=-1) - 2 * place + np.roll(place, 1, axis=-1)) / step**2


def _picked(spectrum: Array, orders: list[int]) -> Array:
    """The lines of these orders; there is nothing beyond half the number of points."""
    return np.array([spectrum[n] if n < len(spectrum) - 1 else 0.0 for n in orders])


# ------------------------------------------------------------------ one engine
Vectors = Callable[[Engine, list[int]], Complex]


def from_coefficients(find: Coefficients) -> Vectors:
    """Force and moment by order from A_n: phases of every cylinder added up, shape (2, orders, 2):
    kind, order, direction.
    """

    def evaluate(engine: Engine, orders: list[int]) -> Complex:
        mass, turning, axis, phase, z = _columns(engine)
        n = np.array(orders)[:, None]
        c = mass * find(orders, float(engine.cylinders.lam[0]))[:, None] / 2
        ahead = (c + turning * (n == 1)) * np.exp(1j * (axis + n * phase))
        astern = c * np.exp(1j * (axis - n * phase))
        both = np.stack([ahead, astern], axis=-1)
        return np.stack([both.sum(axis=1), 1j * (z[:, None] * both).sum(axis=1)])

    return evaluate


def of_engine(engine: Engine, orders: list[int]) -> Complex:
    """balcli itself."""
    found = compute_spectra(engine, orders, ("force", "moment"))
    return np.array([(p.forward, p.backward) for _, p in found.items()]).transpose(0, 2, 1)


def sampled(points: int) -> Vectors:
    """Force of every cylinder at crank angles, summed and transformed: what one writes first."""

    def evaluate(engine: Engine, orders: list[int]) -> Complex:
        mass, turning, axis, phase, z = _columns(engine)
        psi = 2 * np.pi * np.arange(points) / points + phase[:, None]
        force = (
            mass * _acceleration(psi, engine.cylinders.lam[0]) + turning * np.exp(1j * psi)
        ) * np.exp(1j * axis)[:, None]
        return _of_curves(force.sum(axis=0), 1j * (z[:, None] * force).sum(axis=0), orders)

    return evaluate


def time_stepped(samples: int) -> Vectors:
    """The same from the places of all masses at equal steps of time."""

    def evaluate(engine: Engine, orders: list[int]) -> Complex:
        mass, turning, axis, phase, z = _columns(engine)
        psi = 2 * np.pi * np.arange(samples) / samples + phase[:, None]
        lam = engine.cylinders.lam[0]
        place = mass * (
            np.cos(psi) + np.sqrt(1 - (lam * np.sin(psi)) ** 2) / lam
        ) + turning * np.exp(1j * psi)
        force = -_second_difference(place) * np.exp(1j * axis)[:, None]
        return _of_curves(force.sum(axis=0), 1j * (z[:, None] * force).sum(axis=0), orders)

    return evaluate


class _Columns(NamedTuple):
    """An engine of equal cylinders, as the ways above see it; of each shape (cylinders,)."""

    mass: float  # m_rec r omega^2, N
    turning: float  # m_rot r omega^2, N
    axis: Array  # rad
    phase: Array  # crank angle at crank angle 0, rad
    z: Array  # arm, m


def _columns(engine: Engine) -> _Columns:
    c = engine.cylinders
    scale = c.radius * engine.omega**2
    return _Columns(
        float(c.reciprocating[0] * scale),
        float(c.rotating[0] * scale),
        np.radians(c.axis_of_each_deg),
        np.radians(c.angle_deg),
        c.z - engine.reference_m[2],
    )


def _of_curves(force: Complex, moment: Complex, orders: list[int]) -> Complex:
    """Forward and backward vectors of two curves over a revolution."""
    lines = np.fft.fft(np.stack([force, moment])) / len(force)
    inside = [n if 2 * n < len(force) else None for n in orders]
    return np.array([[(0, 0) if n is None else (row[n], row[-n]) for n in inside] for row in lines])

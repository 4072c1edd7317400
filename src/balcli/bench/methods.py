"""Methods that compute the orders of a piston's acceleration, each as well as numpy allows.

The acceleration is r ω² (cos ψ + sum A_n cos n ψ), with the crank angle ψ from the cylinder's
axis. λ is the crank radius over the rod length. All methods take many λ side by side (variants) and
return the coefficients A_n of the wanted orders.

    series of two terms   cos ψ + λ cos 2ψ, the formula of textbooks
    closed form           what balcli uses (`core.mechanisms.closed_form`)
    FFT of N points       the exact acceleration at N angles, transformed
    time steps            second differences of the position, transformed
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from decimal import Decimal, localcontext
from typing import NamedTuple, TypeAlias

import numpy as np

from ..core.mechanisms import closed_form
from ..core.phasors import Array

POINTS = (16, 32, 64, 128, 256)
STEPS_DEG = (5, 1)
_AT_ONCE = 2000  # variants that are sampled together, so that their samples stay in the cache
_DIGITS = 50  # of the exact values

Find: TypeAlias = Callable[[Array], Array]  # λ (variants,) -> A_n (orders, variants)


class Method(NamedTuple):
    """A method.

    Attributes:
        name: Its name.
        find: Function that returns the coefficients of the orders for which it was made.
    """

    name: str
    find: Find


def list_methods(orders: list[int]) -> Iterator[Method]:
    """Yield all methods for these orders."""
    yield Method("series of two terms", _use_two_terms(orders))
    yield Method("closed form", _use_closed_form(orders))
    for points in POINTS:
        yield Method(f"FFT of {points} points", _sample_acceleration(orders, points))
    for step in STEPS_DEG:
        degrees = "1 degree" if step == 1 else f"{step} degrees"
        yield Method(f"time steps of {degrees}", _difference_position(orders, 360 // step))


def find_exactly(order: int, lam: float) -> float:
    """Return A_n of an even order n above 0, computed with 50 digits and rounded once.

    `A_n = n² c_{n/2}/x` with `x = λ/(1 + sqrt(1 - λ²))` and the coefficients c_m of cos β in
    `core.mechanisms.closed_form`.
    """
    with localcontext() as context:
        context.prec = _DIGITS
        ratio = Decimal(lam)
        x = ratio / (1 + ((1 - ratio) * (1 + ratio)).sqrt())
        m = order // 2
        half = Decimal(1) / 2
        binomial = Decimal(1)
        for k in range(m):
            binomial *= (half - k) / (k + 1)
        total = Decimal(1)
        term = Decimal(1)
        j = 0
        while abs(term) > Decimal(10) ** -_DIGITS:
            term *= (j - half) * (m + j - half) / ((m + 1 + j) * (1 + j)) * x**4
            total += term
            j += 1
        return float(order**2 * binomial * x ** (2 * m - 1) * total)


def _use_two_terms(orders: list[int]) -> Find:
    def find(lam: Array) -> Array:
        coefficients = np.zeros((len(orders), *lam.shape))
        for row, order in enumerate(orders):
            if order == 2:
                coefficients[row] = lam
        return coefficients

    return find


def _use_closed_form(orders: list[int]) -> Find:
    def find(lam: Array) -> Array:
        return closed_form.piston(orders, lam)

    return find


def _sample_acceleration(orders: list[int], points: int) -> Find:
    psi = 2 * np.pi * np.arange(points) / points
    cos = np.cos(psi)
    sin_squared = np.sin(psi) ** 2
    cos_squared = cos**2

    def sample(lam: Array) -> Array:
        secant = 1 / np.sqrt(1 - lam**2 * sin_squared)  # 1 / cos β
        acceleration: Array = cos + lam * secant * (cos_squared * secant**2 - sin_squared)
        return acceleration

    return _transform(sample, orders, points)


def _difference_position(orders: list[int], steps: int) -> Find:
    psi = 2 * np.pi * np.arange(steps) / steps
    cos = np.cos(psi)
    sin_squared = np.sin(psi) ** 2

    def sample(lam: Array) -> Array:
        place = cos + np.sqrt(1 - lam**2 * sin_squared) / lam
        both = np.roll(place, -1, axis=-1) + np.roll(place, 1, axis=-1)
        acceleration: Array = (2 * place - both) / (2 * np.pi / steps) ** 2
        return acceleration

    return _transform(sample, orders, steps)


def _transform(sample: Find, orders: list[int], points: int) -> Find:
    """Return a method that samples the acceleration and transforms it; orders that the points
    cannot tell apart from others are 0.
    """
    resolved = [order for order in orders if 2 * order < points]

    def find(lam: Array) -> Array:
        coefficients = np.zeros((len(orders), *lam.shape))
        for start in range(0, len(lam), _AT_ONCE):
            part = slice(start, start + _AT_ONCE)
            lines = np.fft.rfft(sample(lam[part, None])).real * (2 / points)
            for row, order in enumerate(orders):
                if order in resolved:
                    coefficients[row, part] = lines[:, order]
        return coefficients

    return find

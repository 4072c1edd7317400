"""Methods that compute the orders of a piston's acceleration, each as well as numpy allows.

The acceleration is r ω² (cos ψ + sum A_n cos n ψ), with the crank angle ψ from the cylinder's
axis. λ is the crank radius over the rod length. All methods take many λ side by side (variants) and
return the coefficients A_n of the wanted orders. They take so many variants at once that their
arrays stay in the processor's cache; larger ones would make each of them up to three times slower.
What does not depend on λ, such as the cosines of the angles, is prepared once.

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
from .records import Approach

POINTS = (16, 32, 64, 128, 256)
STEPS_DEG = (5, 1)
_AT_ONCE = 2**15  # numbers of an array: 256 KiB
_DIGITS = 50  # of the exact values

Find: TypeAlias = Callable[[Array], Array]  # λ (variants,) -> A_n (orders, variants)


class Method(NamedTuple):
    """A method.

    Attributes:
        name: Its name.
        approach: How it computes.
        find: Function that returns the coefficients of the orders for which it was made.
    """

    name: str
    approach: Approach
    find: Find


def list_methods(orders: list[int]) -> Iterator[Method]:
    """Yield all methods for these orders."""
    yield Method("series of two terms", "formula", _use_two_terms(orders))
    yield Method("closed form", "exact", _use_closed_form(orders))
    for points in POINTS:
        find = _sample_acceleration(orders, points)
        yield Method(f"FFT of {points} points", "samples", find)
    for step in STEPS_DEG:
        find = _difference_position(orders, 360 // step)
        yield Method(f"time steps of {tell_degrees(step)}", "steps", find)


def tell_degrees(step: float) -> str:
    """Return the words for a step of the crank angle."""
    return "1 degree" if step == 1 else f"{step:g} degrees"


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

    terms = max(orders) // 2 + 1  # of the series of cos β
    return _take_in_parts(find, len(orders), _AT_ONCE // terms)


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
    step = 2 * np.pi / steps
    psi = step * np.arange(-1, steps + 1)  # one more on each side
    cos = np.cos(psi)
    sin_squared = np.sin(psi) ** 2

    def sample(lam: Array) -> Array:
        position = cos + np.sqrt(1 - lam**2 * sin_squared) / lam
        return -np.diff(position, 2, axis=-1) / step**2

    return _transform(sample, orders, steps)


def _transform(sample: Find, orders: list[int], points: int) -> Find:
    """Return a method that samples the acceleration and transforms it; orders that the points
    cannot tell apart from others are 0.
    """

    def find(lam: Array) -> Array:
        coefficients = np.zeros((len(orders), len(lam)))
        lines = np.fft.rfft(sample(lam[:, None])).real * (2 / points)
        for row, order in enumerate(orders):
            if 2 * order < points:
                coefficients[row] = lines[:, order]
        return coefficients

    return _take_in_parts(find, len(orders), _AT_ONCE // points)


def _take_in_parts(find: Find, orders: int, at_once: int) -> Find:
    """Return the same method, which computes this number of variants at once."""

    def find_all(lam: Array) -> Array:
        coefficients = np.empty((orders, len(lam)))
        for start in range(0, len(lam), at_once):
            part = slice(start, start + at_once)
            coefficients[:, part] = find(lam[part])
        return coefficients

    return find_all

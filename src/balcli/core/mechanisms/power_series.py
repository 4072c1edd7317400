"""Compute the power series in lambda of any order of the centred slider-crank, up to any power, in
exact fractions.

The sources are the binomial series of cos beta = sqrt(1 - lam^2 sin^2 psi) and the power series of
beta = arcsin(lam sin psi); powers of the sine are finite Fourier sums. A series is a
dictionary from the power of lambda to its coefficient; powers with the coefficient 0 are omitted.
"""

from __future__ import annotations

from fractions import Fraction
from math import comb
from typing import TypeAlias

Series: TypeAlias = dict[int, Fraction]


def cos_beta_in_sine(power: int) -> Series:
    """Return the coefficients a_p in cos beta = sum a_p (lam sin psi)^p, p = 0, 2, ... up to
    `power`: 1, -1/2, -1/8, ...
    """
    return {2 * j: Fraction(-comb(2 * j, j), 4**j * (2 * j - 1)) for j in range(power // 2 + 1)}


def beta_in_sine(power: int) -> Series:
    """Return the coefficients a_p in beta = sum a_p (lam sin psi)^p, p = 1, 3, ... up to `power`:
    1, 1/6, 3/40, ...
    """
    return {
        2 * j + 1: Fraction(comb(2 * j, j), 4**j * (2 * j + 1)) for j in range((power + 1) // 2)
    }


def cos_beta(order: int, power: int) -> Series:
    """Return the series of C_n in cos beta = sum C_n cos n psi, n even.

    Args:
        order: Order n.
        power: Highest power of lambda.
    """
    return _in_harmonics(cos_beta_in_sine(power), order)


def beta(order: int, power: int) -> Series:
    """Return the series of b_k in beta = sum b_k sin k psi, k odd.

    Args:
        order: Order k.
        power: Highest power of lambda.
    """
    return _in_harmonics(beta_in_sine(power), order)


def piston(order: int, power: int) -> Series:
    """Return the series of A_n in the piston's acceleration, j/(r omega^2) = sum A_n cos n psi. A_1
    is 1; other odd orders are 0.

    Args:
        order: Order n.
        power: Highest power of lambda.
    """
    return _scaled(from_shaft(order, power), order**2)


def rod(order: int, power: int) -> Series:
    """Return the series of D_k in the rod's angular acceleration, beta'' = -sum D_k sin k psi, k
    odd.

    Args:
        order: Order k.
        power: Highest power of lambda.
    """
    return _scaled(beta(order, power), order**2)


def from_shaft(order: int, power: int) -> Series:
    """Return the series of the coefficient of cos n psi in the piston pin's distance from the
    shaft, s/r = cos psi + cos beta/lam.

    Args:
        order: Order n.
        power: Highest power of lambda.
    """
    if order == 1:
        return {0: Fraction(1)}
    return {p - 1: c for p, c in cos_beta(order, power + 1).items()}


def displacement(order: int, power: int) -> Series:
    """Return the series of the coefficient of cos n psi in the travel from top dead centre, x/r = 1
    + 1/lam - s/r.

    Args:
        order: Order n.
        power: Highest power of lambda.
    """
    minus = _scaled(from_shaft(order, power), -1)
    return {0: Fraction(1)} | {p: c for p, c in minus.items() if p >= 0} if order == 0 else minus


def velocity(order: int, power: int) -> Series:
    """Return the series of the coefficient of sin n psi in the velocity v/(r omega), positive away
    from top dead centre.

    Args:
        order: Order n.
        power: Highest power of lambda.
    """
    return _scaled(from_shaft(order, power), order)


def _scaled(series: Series, factor: int) -> Series:
    return {p: factor * c for p, c in series.items()} if factor else {}


def _in_harmonics(in_sine: Series, order: int) -> Series:
    """Return the contribution of each power of the sine to one order."""
    parts = {p: c * _sine_power(p, order) for p, c in in_sine.items()}
    return {p: c for p, c in parts.items() if c}


def _sine_power(power: int, order: int) -> Fraction:
    """Return one coefficient of the Fourier sum of sin^p psi, p being `power`: that of cos n psi if
    p is even, that of sin n psi if p is odd, n being `order`.
    """
    if order > power or (power - order) % 2:
        return Fraction(0)
    sign = (-1) ** (order // 2)
    return Fraction(sign * comb(power, (power - order) // 2) * (1 if order == 0 else 2), 2**power)

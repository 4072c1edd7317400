"""Liang Shoupan, Engine Dynamics, 1948: the worked examples, in inches, pounds and seconds.

An engine of 4 in stroke with a rod of 7 in turns at 4000 rpm; the rod weighs 2.75 lb, its center of
gravity is 2 in from the crank pin; the piston with pin and rings weighs 1 lb.
"""

from __future__ import annotations

from math import floor, log10

import numpy as np

from ..core.mechanisms.slidercrank import rod_acceleration
from ..core.phases import RPM
from ..file import units
from ..file.units import POUND_FORCE, STANDARD_GRAVITY
from .recomputed import Print, Ranges, Table

POUND, FOOT = float(units.POUND), float(12 * units.INCH)  # kg, m
CRANK, ROD = 2 / 12, 7 / 12  # ft
OMEGA = 4000 * RPM
GRAVITY = STANDARD_GRAVITY / FOOT  # ft/s2


def tabulate_liang_examples(printed: Print, ranges: Ranges) -> Table:
    """Exact answers next to the printed ones, in the order of the book."""
    rounded = _round(1.79 * 37400 / 32.2)
    others = (
        ("author's approximation: omega taken as 418 rad/s", 1, _round(_acceleration(418.0))),
        ("follows from the rounded figures 1.79 and 37400, g = 32.2", 2, rounded),
        ("author's approximation: g taken as 32.2 ft/s^2", 7, _second(32.2)[-1]),
    )
    return printed.compare_answers((*_first(), *_second(), *_third()), others)


def _acceleration(omega: float = OMEGA) -> float:
    """Return the acceleration of the piston at top dead center, ft/s^2."""
    return CRANK * omega**2 * (1 + CRANK / ROD)


def _first() -> tuple[float, ...]:
    """Return the answers of section 1-3: reciprocating weight (rod weighed at its ends), its
    greatest acceleration and inertia force.
    """
    mass = 1 + 2.75 * 2 / 7
    return (mass, _acceleration(), mass * _acceleration() * POUND * FOOT / POUND_FORCE)


def _second(gravity: float = GRAVITY) -> tuple[float, ...]:
    """Return the answers of section 1-4, the rod's outline a triangle: hk, q^2, their difference,
    peak of beta''/p, residual couple in ft lb (all at 90 degrees).
    """
    lam, hk, q2 = CRANK / ROD, 1 / 3 * 2 / 3, 1 / 18  # of the length squared
    peak = -float(rod_acceleration(np.pi / 2, lam)) / lam
    couple = 2.75 * ROD**2 * (hk - q2) * peak * lam * OMEGA**2 / gravity
    return (hk, q2, hk - q2, peak, couple)


def _third() -> tuple[float, ...]:
    """Return the answers of section 2-1: rotating weight (throw, big end), reciprocating weight
    (piston, small end); weight at 3.5 in for the first and half of the second at a crank of 3 in.
    """
    rotating, reciprocating = 1.0 + 3.0, 6.0 + 2.0
    return (rotating, reciprocating, (rotating + reciprocating / 2) * 3 / 3.5)


def _round(value: float) -> float:
    """Return three significant digits, as slide rules give them."""
    unit = 10.0 ** (floor(log10(abs(value))) - 2)
    return floor(value / unit + 0.5) * unit

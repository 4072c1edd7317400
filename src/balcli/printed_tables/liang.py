"""Liang Shoupan, Engine Dynamics, 1948: the worked examples, in inches, pounds and seconds."""

from __future__ import annotations

from math import floor, log10
from typing import TYPE_CHECKING

import numpy as np

from ..core.mechanisms.slidercrank import rod_acceleration
from ..enginefile import units
from ..enginefile.units import POUND_FORCE, STANDARD_GRAVITY
from .printed import Print
from .ranges import Ranges
from .recomputed import Explanation, Row, Table

if TYPE_CHECKING:
    from ..engine.build import Engine

POUND, FOOT = float(units.POUND), float(12 * units.INCH)  # kg, m

FIRST = """
crank = { stroke = "4 in" }
rod = { length = "7 in", mass = "2.75 lb", cg = "2 in" }
piston = { mass = "1 lb" }                                  # 0.8 + pin 0.15 + rings 0.05
operation = { speed = 4000 }
"""
SECOND = """                                                # its outline a triangle: q^2 = 1/18, of the length squared
crank = { stroke = "4 in" }
rod = { length = "7 in", mass = "2.75 lb", cg = "7/3 in", inertia = "539/72 lb in^2" }
piston = { mass = "1 lb" }
operation = { speed = 4000 }
"""
THIRD = """
crank = { stroke = "6 in", throw_mass = "1 lb" }
rod = { length = "12 in", small_end = "2 lb", big_end = "3 lb" }    # the length does not matter
piston = { mass = "6 lb" }
"""


def tabulate_liang_examples(printed: Print, ranges: Ranges) -> Table:
    """Exact answers beside the printed ones, in the order of the book."""
    exact = (*_first(), *_second(), *_third())
    margin = [words[:-1] for words in printed.rows]
    rows = [(*words, answer) for words, answer in zip(margin, exact, strict=True)]
    rounded = _three_digits(1.79 * 37400 / 32.2)
    quicker = _three_digits(_acceleration(418.0))
    lighter = _second(32.2 * FOOT)[-1]
    others = (
        ("author's approximation: omega taken as 418 rad/s", 1, quicker),
        ("follows from the rounded figures 1.79 and 37400, g = 32.2", 2, rounded),
        ("author's approximation: g taken as 32.2 ft/s^2", 7, lighter),
    )
    explanations = [Explanation.of_answer(*other, rows) for other in others]
    return printed.compare(printed.columns, rows, stub=4, explanations=explanations)


def _first() -> Row:
    """Section 1-3: reciprocating weight, its greatest acceleration and inertia force; rod weighed
    at its ends.
    """
    mass = float(_engine(FIRST).cylinders.reciprocating[0])
    return (mass / POUND, _acceleration(), mass * _acceleration() * FOOT / POUND_FORCE)


def _acceleration(omega: float | None = None) -> float:
    """At top dead centre, ft/s^2."""
    from ..forces.curves import compute_cylinder_curves

    engine = _engine(FIRST)
    greatest = (
        float(compute_cylinder_curves(engine, 1, np.zeros(1)).values["acceleration_m_per_s2"][0])
        / FOOT
    )
    return greatest if omega is None else greatest * (omega / float(engine.omega)) ** 2


def _second(gravity: float = STANDARD_GRAVITY) -> Row:
    """Section 1-4: hk, q^2, their difference, peak of beta''/p, residual couple in ft lb (all at 90
    degrees).
    """
    from ..forces.curves import compute_engine_curves

    engine = _engine(SECOND)
    lam, c = float(engine.cylinders.lam[0]), engine.cylinders
    hk = 1 / 3 * 2 / 3
    difference = float(c.couple[0]) / (2.75 * POUND * (7 * FOOT / 12) ** 2)  # H/(m l^2)
    couple = float(compute_engine_curves(engine, np.array([90.0])).values["couple_Nm"][0])
    peak = -float(rod_acceleration(np.pi / 2, lam)) / lam
    return (hk, hk - difference, difference, peak, couple / (POUND * gravity * FOOT))


def _third() -> Row:
    """Section 2-1: rotating and reciprocating weight; weight at 3.5 in for the first and half of
    the second.
    """
    c = _engine(THIRD).cylinders
    rotating, reciprocating = float(c.rotating[0]) / POUND, float(c.reciprocating[0]) / POUND
    return (
        rotating,
        reciprocating,
        (rotating + reciprocating / 2) * float(c.radius) / (3.5 * FOOT / 12),
    )


def _engine(text: str) -> Engine:
    from ..engine.build import build
    from ..engine.load import parse

    return build(parse(text, "example"))


def _three_digits(value: float) -> float:
    """Three significant digits, as slide rules give them."""
    unit = 10.0 ** (floor(log10(abs(value))) - 2)
    return floor(value / unit + 0.5) * unit

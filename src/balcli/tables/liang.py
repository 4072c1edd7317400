"""Liang Shoupan, Engine Dynamics, 1948: the worked examples, in inches, pounds and seconds."""
from __future__ import annotations

from math import floor, log10, pi

from ..core import slidercrank as sc
from .options import Options
from .printed import Print
from .table import Cell, Explanation, Row, Table

FOOT = 12.0                                     # inches
GRAVITY = 9.80665 / 0.3048                      # ft/s^2
SPEED = 4000 * 2 * pi / 60                      # rad/s

CRANK, ROD = 2.0, 7.0                           # in; examples 1 and 2
ROD_WEIGHT, PISTON_WEIGHT = 2.75, 0.8 + 0.15 + 0.05                         # lb
LAM = CRANK / ROD


def examples(printed: Print, options: Options) -> Table:
    """Exact answers beside the printed ones, in the order of the book."""
    exact = (*_first(), *_second(GRAVITY), *_third())
    margin = [words[:-1] for words in printed.rows]
    rows = [(*words, answer) for words, answer in zip(margin, exact, strict=True)]
    return printed.table(printed.columns, rows, stub=4, explanations=[
        _instead("author's approximation: omega taken as 418 rad/s", 1, _three_digits(_acceleration(418.0))),
        _instead("follows from the rounded figures 1.79 and 37400, g = 32.2", 2, _three_digits(1.79 * 37400 / 32.2)),
        _instead("author's approximation: g taken as 32.2 ft/s^2", 7, _second(32.2)[-1]),
    ])


def _instead(kind: str, answer: int, value: Cell) -> Explanation:
    """Another value of one answer."""
    blank: Row = (None,) * 4
    return Explanation(kind, tuple((*blank, value if i == answer else None) for i in range(11)))


def _first() -> Row:
    """Section 1-3: reciprocating weight, its greatest acceleration and inertia force; rod weighed at its ends."""
    weight = PISTON_WEIGHT + ROD_WEIGHT * 2.0 / ROD
    return (weight, _acceleration(SPEED), weight * _acceleration(SPEED) / GRAVITY)


def _acceleration(omega: float) -> float:
    """At top dead centre, ft/s^2."""
    return CRANK / FOOT * omega**2 * float(sc.acceleration(0.0, LAM))


def _second(gravity: float) -> Row:
    """Section 1-4: rod of triangular outline; hk, q^2, their difference, peak of beta''/p, residual couple in ft lb.

    The couple is H beta'' omega^2 with H = m l^2 (hk - q^2); beta'' is greatest at 90 degrees.
    """
    hk, q2 = 1 / 3 * 2 / 3, 1 / 18
    peak = -float(sc.rod_acceleration(pi / 2, LAM))
    couple = ROD_WEIGHT / gravity * (ROD / FOOT) ** 2 * (hk - q2) * peak * SPEED**2
    return (hk, q2, hk - q2, peak / LAM, couple)


def _third() -> Row:
    """Section 2-1: rotating and reciprocating weight; weight at 3.5 in for the first and half of the second."""
    rotating, reciprocating = 1.0 + 3.0, 2.0 + 6.0
    return (rotating, reciprocating, (rotating + reciprocating / 2) * 3.0 / 3.5)


def _three_digits(value: float) -> float:
    """Three significant digits, as slide rules give them."""
    unit = 10.0 ** (floor(log10(abs(value))) - 2)
    return floor(value / unit + 0.5) * unit

"""Recompute the worked examples of Liang (exact answers, and values that explain his answers), and
list published problems with balcli's answers.

The examples of Liang Shoupan, Engine Dynamics, 1948, are in inches, pounds and seconds: an engine
with a stroke of 4 in and a rod of 7 in turns at 4000 rpm. The rod weighs 2.75 lb, and its centre of
gravity is 2 in from the crank pin. The piston with pin and rings weighs 1 lb.
"""

from __future__ import annotations

from typing import cast

import numpy as np

from ..core.mechanisms.slidercrank import SliderCrank
from ..core.phases import RPM
from ..file import units
from ..file.units import POUND_FORCE, STANDARD_GRAVITY
from .recomputed import ANSWER, Erratum, ErratumClass, Print, Ranges, Table

POUND = float(units.POUND)
FOOT = float(12 * units.INCH)  # kg, m
CRANK = 2 / 12
ROD = 7 / 12  # ft
OMEGA = 4000 * RPM
GRAVITY = STANDARD_GRAVITY / FOOT  # ft/s2


def tabulate_liang_examples(printed: Print, ranges: Ranges) -> Table:
    """Return exact and printed answers of Liang, in the order of the book.

    Section 1-3: reciprocating weight (with the rod's share by its centre of gravity), greatest
    acceleration and inertia force. Section 1-4: see `_second`. Section 2-1: rotating weight (throw
    and big end), reciprocating weight (piston and small end), and the weight at a radius of 3.5 in
    that balances the rotating and half of the reciprocating weight at a crank radius of 3 in.
    """
    mass = 1 + 2.75 * 2 / 7
    rotating = 1.0 + 3.0
    reciprocating = 6.0 + 2.0
    force = mass * _acceleration() * POUND * FOOT / POUND_FORCE
    balancing = (rotating + reciprocating / 2) * 3 / 3.5
    answers = (mass, _acceleration(), force, *_second(), rotating, reciprocating, balancing)
    rounded = float(f"{1.79 * 37400 / 32.2:.3g}")
    others: list[tuple[ErratumClass, str, int, float]] = [
        ("approximation", "omega taken as 418 rad/s", 1, float(f"{_acceleration(418.0):.3g}")),
        ("rounding", "follows from the rounded figures 1.79 and 37400, g = 32.2", 2, rounded),
        ("approximation", "g taken as 32.2 ft/s^2", 7, _second(32.2)[-1]),
    ]
    return printed.compare_answers(answers, others)


def _acceleration(omega: float = OMEGA) -> float:
    """Return the acceleration of the piston at top dead centre, ft/s^2."""
    return CRANK * omega**2 * (1 + CRANK / ROD)


def _second(gravity: float = GRAVITY) -> tuple[float, ...]:
    """Return the answers of section 1-4 for a rod with a triangular outline. In units of the rod
    length squared: the product h k of the distances h and k of its centre of gravity from the two
    ends, the square q^2 of its radius of gyration, and h k - q^2. At 90 degrees: the rod's angular
    acceleration (its peak), divided by lambda omega^2, and the residual couple, ft lb.

    lambda is crank radius over rod length, and omega the crank speed.
    """
    lam = CRANK / ROD
    hk = 1 / 3 * 2 / 3
    q2 = 1 / 18
    peak = float(SliderCrank(np.pi / 2, lam).spin_rate) / lam
    couple = 2.75 * ROD**2 * (hk - q2) * peak * lam * OMEGA**2 / gravity
    return (hk, q2, hk - q2, peak, couple)


def tabulate_published(printed: Print, ranges: Ranges) -> Table:
    """Return the printed figures of published problems with balcli's figures. Tests recompute
    balcli's figures by the command of each problem.
    """
    wanted = "source", "figure", "unit", "class", "remark", "printed"
    named = [printed.column(name) for name in wanted]
    own = [float(text) for text in printed.column(ANSWER)]
    rows = [(*words[:-1], value) for words, value in zip(printed.rows, own, strict=True)]
    errata = []
    for i, (source, figure, measure, kind, remark, text) in enumerate(zip(*named, strict=True)):
        if kind:
            name = f"{figure}, {measure}" if measure else figure
            label = f"{source}: {name}"
            category = cast("ErratumClass", kind)
            errata.append(Erratum(i, ANSWER, text, own[i], remark, label, category))
    words = tuple((*line[:-1], None) for line in printed.rows)
    return Table(
        name=printed.name,
        title=printed.title,
        source=printed.source,
        columns=printed.columns,
        exact=tuple(rows),
        printed=words,
        errata=tuple(errata),
        stub=len(printed.columns) - 1,
    )

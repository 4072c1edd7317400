"""Recompute worked examples of textbooks on crank torque, flywheels and balancing: exact answers,
and values that explain the authors' answers.

The examples of Liang Shoupan, Engine Dynamics, 1948, are in inches, pounds and seconds: an engine
with a stroke of 4 in and a rod of 7 in turns at 4000 rpm. The rod weighs 2.75 lb, and its centre of
gravity is 2 in from the crank pin. The piston with pin and rings weighs 1 lb.
"""

from __future__ import annotations

from math import floor, log10

import numpy as np

from ..core.mechanisms import slidercrank
from ..core.mechanisms.slidercrank import rod_acceleration
from ..core.phases import RPM
from ..core.phasors import Array
from ..core.piecewise import polyline, resolved
from ..core.speed_ripple import surplus
from ..file import units
from ..file.units import POUND_FORCE, STANDARD_GRAVITY
from .recomputed import ErratumClass, Print, Ranges, Table, as_numbers, load_print


def tabulate_torque_examples(printed: Print, ranges: Ranges) -> Table:
    """Return exact and printed answers on torque: Bevan 12.3, Khurmi 16.12, Uicker 18.1.

    Uicker 18.1 gives the torque (table 18-1) at every 10 degrees of a cycle, integrates it by
    Simpson's rule, and computes the inertia for a fluctuation of 0.025 at 4600 rpm.
    """
    torque = as_numbers(load_print("uicker-18-1").column("torque_Nm"))
    uicker = polyline(np.radians(np.arange(0, 721, 10)), [*torque, torque[0]])
    work = float(np.tile([2, 4], 36) @ torque) * np.pi / 18 / 3
    square = 0.025 * (4600 * RPM) ** 2
    answers = (_bevan(), *_khurmi(), work / (4 * np.pi), surplus(uicker).energy / square)
    whole = "the work of a whole cycle is taken for the fluctuation of energy"
    others: list[tuple[ErratumClass, str, int, float]] = [
        ("approximation", "two terms of the motion", 0, _bevan(two_terms=True)),
        ("method", "the largest while the torque first exceeds the load", 2, _khurmi_zero_side()),
        ("method", whole, 4, work / square),
    ]
    return printed.compare_answers(answers, others)


# ------------------------------------------------------------------ Bevan 12.3
def _bevan(*, two_terms: bool = False) -> float:
    """Return the torque, lbf ft, of a steam engine at 40 degrees: bore 9 in, stroke 24 in, rod 60
    in, piston rod 2 in, pressures 160 and 32 psi.
    """
    force = 160 * np.pi / 4 * 9**2 - 32 * np.pi / 4 * (9**2 - 2**2)  # lbf
    psi, lam = np.radians(40.0), 12 / 60
    exact = float(slidercrank.velocity(psi, lam, 0.0))
    rate = np.sin(psi) + lam / 2 * np.sin(2 * psi) if two_terms else exact
    return float(force * rate)  # the crank radius is 1 ft


# ------------------------------------------------------------------ Khurmi 16.12
def _khurmi() -> tuple[float, float]:
    """Return the fluctuation of energy and the largest acceleration of a flywheel (500 kg, radius
    of gyration 0.4 m) under a torque of 5000 + 600 sin 2t and a load of 5000 + 500 sin t.
    """
    net = resolved(_khurmi_net, [0.0, 2 * np.pi])
    lowest, highest = net.extremes()
    return surplus(net).energy, max(highest.value, -lowest.value) / (500 * 0.4**2)


def _khurmi_net(angle: Array) -> Array:
    return 600 * np.sin(2 * angle) - 500 * np.sin(angle)


def _khurmi_zero_side() -> float:
    """Return the acceleration by the largest excess torque before it first changes its sign."""
    first = resolved(_khurmi_net, [0.0, np.arccos(5 / 12)])
    return first.extremes()[1].value / (500 * 0.4**2)


POUND, FOOT = float(units.POUND), float(12 * units.INCH)  # kg, m
CRANK, ROD = 2 / 12, 7 / 12  # ft
OMEGA = 4000 * RPM
GRAVITY = STANDARD_GRAVITY / FOOT  # ft/s2


def tabulate_liang_examples(printed: Print, ranges: Ranges) -> Table:
    """Return exact and printed answers of Liang, in the order of the book.

    Section 1-3: reciprocating weight (with the rod's share by its centre of gravity), greatest
    acceleration and inertia force. Section 1-4: see `_second`. Section 2-1: rotating weight (throw
    and big end), reciprocating weight (piston and small end), and the weight at 3.5 in that
    balances the former and half of the latter at a crank of 3 in.
    """
    mass, rotating, reciprocating = 1 + 2.75 * 2 / 7, 1.0 + 3.0, 6.0 + 2.0
    force = mass * _acceleration() * POUND * FOOT / POUND_FORCE
    balancing = (rotating + reciprocating / 2) * 3 / 3.5
    answers = (mass, _acceleration(), force, *_second(), rotating, reciprocating, balancing)
    rounded = _round(1.79 * 37400 / 32.2)
    others: list[tuple[ErratumClass, str, int, float]] = [
        ("approximation", "omega taken as 418 rad/s", 1, _round(_acceleration(418.0))),
        ("rounding", "follows from the rounded figures 1.79 and 37400, g = 32.2", 2, rounded),
        ("approximation", "g taken as 32.2 ft/s^2", 7, _second(32.2)[-1]),
    ]
    return printed.compare_answers(answers, others)


def _acceleration(omega: float = OMEGA) -> float:
    """Return the acceleration of the piston at top dead centre, ft/s^2."""
    return CRANK * omega**2 * (1 + CRANK / ROD)


def _second(gravity: float = GRAVITY) -> tuple[float, ...]:
    """Return the answers of section 1-4 for a rod with a triangular outline: hk, q^2, their
    difference, the peak of beta''/p, and the residual couple in ft lb, both at 90 degrees.
    """
    lam, hk, q2 = CRANK / ROD, 1 / 3 * 2 / 3, 1 / 18  # over the length squared
    peak = -float(rod_acceleration(np.pi / 2, lam)) / lam
    couple = 2.75 * ROD**2 * (hk - q2) * peak * lam * OMEGA**2 / gravity
    return (hk, q2, hk - q2, peak, couple)


def _round(value: float) -> float:
    """Return the value with three significant digits, as on a slide rule."""
    unit = 10.0 ** (floor(log10(abs(value))) - 2)
    return floor(value / unit + 0.5) * unit

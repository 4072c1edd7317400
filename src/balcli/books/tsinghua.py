"""Recompute Tables 1-1 to 1-6 of Lu Jiqing, Meng Sizong, Automobile Engine Design, 1990."""

from __future__ import annotations

from collections.abc import Callable
from math import pi
from typing import TypeAlias

import numpy as np

from ..core.mechanisms import slidercrank as sc
from ..core.phasors import Array
from ..errors import ArgumentError
from ..limits import MOST_TABLE_VALUES
from .recomputed import (
    Cell,
    Explanation,
    Print,
    Ranges,
    Row,
    Table,
    as_cells,
    as_numbers,
    parse_number,
)

ByAngle: TypeAlias = Callable[[Array, Array], Array]  # function of crank angle (rad) and lambda


def tabulate_engines(printed: Print, ranges: Ranges) -> Table:
    """Return Table 1-1: lambda = r/l, mean piston speed S n/30 and xi = e/r of given engines (crank
    radius r, rod length l, stroke S in m, speed n in rpm, piston offset e).
    """
    heads = ("r_mm", "l_mm", "e_mm", "stroke_mm", "rated_speed_rpm")
    lines = np.array([as_numbers(printed.column(head)) for head in heads]).T.tolist()
    rows = []
    supposed = []
    for words, (r, length, e, stroke, rpm) in zip(printed.rows, lines, strict=True):
        given = dict(zip(printed.columns, map(_given, words), strict=True))
        exact = {"lambda": r / length, "Cm_m_per_s": stroke * rpm / 30e3, "xi": e / r}
        rows.append(tuple((given | exact).values()))
        supposed.append(tuple((given | {"lambda": r / 280}).values()))
    shorter = Explanation("misprint; the figure fits l = 280 mm", tuple(supposed), "misprint")
    return printed.compare(printed.columns, rows, explanations=[shorter], stub=2)


def tabulate_extremes(printed: Print, ranges: Ranges) -> Table:
    """Return Table 1-4: angle and size of the greatest velocity, by the printed two-term formula
    and exactly.
    """
    headings = ranges.lam or printed.headings()
    lam = as_numbers(headings)
    both = [_extreme(lam, *fastest(lam)) for fastest in (sc.fastest_two_term, sc.fastest)]
    return printed.compare_columns((*headings, *(f"exact {h}" for h in headings)), np.hstack(both))


def tabulate_two_terms(printed: Print, ranges: Ranges) -> Table:
    """Return the errors of the two-term formulas of sections 1.1.1.1 to 1.1.1.3 over a revolution:
    the largest error, its share of the largest value and of the exact value at the same angle; and
    the largest relative error (not for the acceleration, whose relative error has no bound because
    the acceleration has zeros between 0 and 180 degrees).
    """
    headings = ranges.lam or printed.headings()
    lam = as_numbers(headings)
    psi = np.radians(np.arange(1, 3600) / 20)[:, None]  # 0 and 180 degrees are exact
    first = np.cos(psi)
    second = np.cos(2 * psi)
    travel = _find_errors(1 + lam / 4 - first - lam / 4 * second, sc.displacement(psi, lam))
    speed = _find_errors(np.sin(psi) + lam / 2 * np.sin(2 * psi), sc.velocity(psi, lam))
    acceleration = _find_errors(first + lam * second, sc.acceleration(psi, lam))[:-1]
    return printed.compare_columns(headings, [*travel, *speed, *acceleration])


def _find_errors(approximate: Array, exact: Array) -> list[Array]:
    """Return the largest error; this error in percent of the largest exact value; this error in
    percent of the exact value at the same angle (the smallest, if there are several such angles);
    and the largest relative error, percent.

    Args:
        approximate: Approximate values, shape (angles, lambdas).
        exact: Exact values, of the same shape.
    """
    error = np.abs(approximate - exact)
    size = np.abs(exact)
    largest = error.max(axis=0)
    smallest = np.where(error > largest * (1 - 1e-9), size, np.inf).min(axis=0)
    relative = (error / size).max(axis=0)
    return [largest, 100 * largest / size.max(axis=0), 100 * largest / smallest, 100 * relative]


def tabulate_mean_speeds(printed: Print, ranges: Ranges) -> Table:
    """Return Table 1-5: usual ranges, which cannot be recomputed."""
    return printed.compare(printed.columns, [tuple(map(_given, words)) for words in printed.rows])


def tabulate_by_angle(printed: Print, ranges: Ranges, function: ByAngle) -> Table:
    """Return a row for each crank angle and a column for each lambda, with the printed columns of
    signs and of the angles 360 degrees - alpha, where alpha is the crank angle.

    Raises:
        ArgumentError: The table has too many cells.
    """
    headings = ranges.lam or printed.headings()
    stub = ranges.angle or printed.column("alpha_deg")
    if (count := len(stub) * len(headings)) > MOST_TABLE_VALUES:
        raise ArgumentError(
            "{angles} angles by {ratios} crank ratios are {count} figures, and at most {most} are "
            "tabulated: take larger steps of {angle} or {lambda_}",
            angles=len(stub),
            ratios=len(headings),
            count=count,
            most=MOST_TABLE_VALUES,
        )
    angles = as_numbers(stub)
    body = function(np.radians(angles)[:, None], as_numbers(headings)[None, :])
    body = np.where(np.abs(body) < 1e-15, 0.0, body)  # rounding of the speed at 180 degrees
    signs = "sign_left" in printed.columns
    inner = ("sign_left", *headings, "sign_right") if signs else headings
    columns = ("alpha_deg", *inner, "alpha_right_deg")
    rows: list[Row] = []
    for angle, line in zip(angles.tolist(), map(as_cells, body), strict=True):
        left, right = "+-" if angle % 360 <= 180 else "-+"
        rows.append((angle, *((left, *line, right) if signs else line), 360 - angle))
    return printed.compare(columns, rows, printed.align_cells(stub, columns))


def _extreme(lam: Array, psi: Array, value: Array) -> Array:
    """Return the seven lines of Table 1-4, with angles in degrees. `value` is the greatest velocity
    divided by r omega, and psi (rad) the crank angle at which it occurs. The last line is the
    velocity divided by the mean piston speed, (2/pi) r omega.
    """
    alpha = np.degrees(psi)
    beta = np.degrees(np.arctan2(*sc.rod_angle(psi, lam)))
    both = alpha + beta
    return np.array([alpha, 360 - alpha, beta, both, 360 - both, value, value * pi / 2])


def _given(text: str | None) -> Cell:
    """Return the number in a printed text; return other texts unchanged."""
    value = parse_number(text)
    return text if value is None else float(value)

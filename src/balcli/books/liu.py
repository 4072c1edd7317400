"""Recompute Tables 1 to 3 of Liu Xianzhi (received 1979): second-order balance of the flat-plane V8
by two shafts or by sliders.

The second-order force of the engine is the sum of two vectors, where gamma is the bank angle: K
cos(gamma/2) turns with the crank, and K cos(3 gamma/2) turns against it. Two shafts cancel these
vectors without a roll moment if their radii b''' and b'' have the same ratio as the vectors.
Sliders cancel the components Z_x and Z_y.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import cos, radians
from typing import TypeAlias

import numpy as np

from ..core.phasors import Array, unit
from .recomputed import Explanation, Print, Ranges, Row, Table, as_cells, as_numbers, head_rows

Cosine: TypeAlias = Callable[[Array], Array]  # function of an angle in degrees
ROUGH = "cos 45° taken as 0.706"


def _cos(degrees: Array) -> Array:
    return unit(degrees).real


def _rough(degrees: Array) -> Array:
    """Return the cosine with the rounded values by which Tables 1 and 3 were computed: 0.706 for
    cos 45 degrees and 0.258 for cos 75 degrees.
    """
    exact = _cos(degrees)
    for angle, taken in ((45, 0.706), (75, 0.258)):
        near = np.abs(np.abs(exact) - cos(radians(angle))) < 1e-12
        exact = np.where(near, np.sign(exact) * taken, exact)
    return exact


def tabulate_paths(printed: Print, ranges: Ranges) -> Table:
    """Return Table 1: radii of the two shafts over gamma, their derivatives, and the ratios of
    both.
    """
    gamma, stub = as_numbers(printed.headings()), printed.column(printed.columns[0])
    return _compare(printed, lambda cosine: head_rows(stub, _paths(gamma, cosine)))


def _compare(printed: Print, compute: Callable[[Cosine], tuple[Row, ...]], stub: int = 1) -> Table:
    """Return the table of exact rows; rows with the rough cosine explain its errata."""
    rough = Explanation(ROUGH, compute(_rough), "approximation")
    return printed.compare(printed.columns, compute(_cos), explanations=[rough], stub=stub)


def tabulate_vectors(printed: Print, ranges: Ranges) -> Table:
    """Return Table 2: the two rotating vectors."""
    gamma = as_numbers(printed.headings())
    vectors = [_cos(gamma / 2), _cos(3 * gamma / 2)]
    rows = head_rows(printed.column(printed.columns[0]), vectors)
    return printed.compare(printed.columns, rows)


def tabulate_sliders(printed: Print, ranges: Ranges) -> Table:
    """Return Table 3: the sliders' forces over the crank angle alpha, for each gamma."""
    gammas = [float(text) if text else None for text in printed.column("gamma_deg")]
    return _compare(printed, lambda cosine: _sliders(printed, gammas, cosine), stub=2)


def _paths(gamma: Array, cosine: Cosine) -> Array:
    """Return b''/b, b'''/b, their ratio, their derivatives by gamma, and the ratio of the
    derivatives.

    The ratios are computed without division by zero, with x = gamma/2, from -cos 3x/cos x = 3 - 4
    cos^2 x and -3 sin 3x/sin x = 3 - 12 cos^2 x.
    """
    near, far = cosine(gamma / 2), cosine(3 * gamma / 2)
    rates = 1.5 * cosine(3 * gamma / 2 - 90), -0.5 * cosine(gamma / 2 - 90)
    return np.array(
        [-far, near, 3 - 4 * _cos(gamma / 2) ** 2, *rates, 3 - 12 * _cos(gamma / 2) ** 2]
    )


def _sliders(printed: Print, gammas: Sequence[float | None], cosine: Cosine) -> tuple[Row, ...]:
    alpha = as_numbers(printed.headings())
    double, sine = cosine(2 * alpha), cosine(2 * alpha - 90)
    margin = {"2alpha_deg": 2 * alpha, "cos 2alpha": double, "sin 2alpha": sine}

    def line(label: str, gamma: float | None) -> Array:
        if gamma is None:
            return margin[label]
        near, far = cosine(np.array(gamma / 2)), cosine(np.array(3 * gamma / 2))
        return (far - near) * sine if label == "Zx" else (far + near) * double

    return tuple(
        (label, g, *as_cells(line(label, g)))
        for label, g in zip(printed.column("row"), gammas, strict=True)
    )

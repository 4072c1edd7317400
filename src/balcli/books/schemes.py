"""Recompute printed tables of balancing schemes.

Tables 1 to 3 of Liu Xianzhi (received 1979): second-order balance of the flat-plane V8 by two
shafts or by sliders. With the bank angle gamma and the second-order force K of one bank, the
second-order force of the engine is the sum of two vectors: a vector of size K cos(gamma/2) turns
with the crank, and a vector of size K cos(3 gamma/2) turns against it. Two shafts cancel these
vectors without a roll moment if the shafts' distances b'' and b''' from the crank axis are
inversely proportional to the sizes of the vectors. Sliders cancel the force's components Z_x and
Z_y.

Table 1 of Wang Yongding, Methods of balancing single-cylinder engines: a counterweight k m_j r
stands at an angle alpha ahead of the point opposite the crank, where m_j is the reciprocating mass
and r the crank radius. With the crank angle theta, the crank speed omega, lam = crank radius / rod
length and J = m_j r omega^2, the remaining force of orders 1 and 2 is
P = J (cos theta + lam cos 2 theta - k e^{i(theta + alpha)}). The table lists the counterweight for
which the largest |P| is smallest. The author searched k in steps of 0.1, alpha in steps of 5
degrees and theta in steps of 1 degree, but theta only over half a revolution. The best alpha is 0:
the largest |P| is convex in k e^{i alpha}, and changing the sign of alpha only mirrors the curve of
P.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from math import cos, radians
from typing import TypeAlias

import numpy as np

from ..core.peaks import find_least
from ..core.phasors import Array, unit
from ..errors import ArgumentError
from .recomputed import (
    Explanation,
    Print,
    Ranges,
    Row,
    Table,
    Words,
    as_cells,
    as_numbers,
    head_rows,
    identify,
)

Cosine: TypeAlias = Callable[[Array], Array]  # function of an angle in degrees
ROUGH = "cos 45° taken as 0.706"


def _cos(degrees: Array) -> Array:
    return unit(degrees).real


_LENGTHS = ["length of the path of b''/b from g = 0", "length of the path of b'''/b from g = 0"]


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
    """Return Table 1: distances of the two shafts from the crank axis by bank angle gamma, the
    derivatives of these distances, and the ratio of each pair. With other angles than the printed
    ones, two more rows have the lengths of the two paths along which the shafts move while gamma
    grows from 0. For 180 degrees, the text of the source gives these lengths: 3 b and b.
    """
    headings = ranges.angle or printed.headings()
    gamma = as_numbers(headings)
    stub = list(printed.column(printed.columns[0]))
    stub += _LENGTHS if ranges.angle else []
    columns = (printed.columns[0], *headings)

    def compute(cosine: Cosine) -> tuple[Row, ...]:
        return head_rows(stub, _paths(gamma, cosine)[: len(stub)])

    return _compare(printed, columns, compute, printed.align_cells(stub, columns))


def _compare(
    printed: Print,
    columns: Sequence[str],
    compute: Callable[[Cosine], tuple[Row, ...]],
    cells: Sequence[Words],
    stub: int = 1,
) -> Table:
    """Return the table of exact rows; rows computed with `_rough` explain its errata."""
    rough = Explanation(ROUGH, compute(_rough), "approximation")
    return printed.compare(columns, compute(_cos), cells, [rough], stub)


def tabulate_vectors(printed: Print, ranges: Ranges) -> Table:
    """Return Table 2: the two rotating vectors."""
    headings = ranges.angle or printed.headings()
    gamma = as_numbers(headings)
    return printed.compare_columns(headings, [_cos(gamma / 2), _cos(3 * gamma / 2)])


def tabulate_sliders(printed: Print, ranges: Ranges) -> Table:
    """Return Table 3: the sliders' forces over the crank angle alpha, for each gamma."""
    names = [(row[0] or "", row[1]) for row in printed.rows]
    if ranges.angle is not None:
        margins = [name for name in names if name[1] is None]
        names = margins + [(force, gamma) for gamma in ranges.angle for force in ("Zx", "Zy")]
    cells = {(row[0], identify(row[1] or "")): row for row in printed.rows}
    nothing = (None,) * len(printed.columns)
    words = [cells.get((force, identify(gamma or "")), nothing) for force, gamma in names]
    alpha = as_numbers(printed.headings())
    compute = partial(_sliders, names, alpha)
    return _compare(printed, printed.columns, compute, words, stub=2)


def _paths(gamma: Array, cosine: Cosine) -> Array:
    """Return b''/b, b'''/b, their ratio, their derivatives by gamma, the ratio of the derivatives,
    and the lengths of both shafts' paths from gamma = 0, divided by b. Here b is the distance of
    both shafts from the crank axis at gamma = 0.

    The ratios are computed without division by zero, with x = gamma/2, from -cos 3x/cos x = 3 - 4
    cos^2 x and -3 sin 3x/sin x = 3 - 12 cos^2 x.
    """
    near = cosine(gamma / 2)
    far = cosine(3 * gamma / 2)
    rates = 1.5 * cosine(3 * gamma / 2 - 90), -0.5 * cosine(gamma / 2 - 90)
    ratios = 3 - 4 * _cos(gamma / 2) ** 2, 3 - 12 * _cos(gamma / 2) ** 2
    lengths = _walk(3 * gamma / 2), _walk(gamma / 2)
    return np.array([-far, near, ratios[0], *rates, ratios[1], *lengths])


def _walk(angle: Array) -> Array:
    """Return the total variation of the cosine from 0 to an angle (deg): 2 for each half turn."""
    halves, rest = np.divmod(np.abs(angle), 180)
    return np.asarray(2 * halves + 1 - _cos(rest))


def _sliders(
    names: Sequence[tuple[str, str | None]], alpha: Array, cosine: Cosine
) -> tuple[Row, ...]:
    double = cosine(2 * alpha)
    sine = cosine(2 * alpha - 90)
    margin = {"2alpha_deg": 2 * alpha, "cos 2alpha": double, "sin 2alpha": sine}

    def line(label: str, gamma: float | None) -> Array:
        if gamma is None:
            return margin[label]
        near = cosine(np.array(gamma / 2))
        far = cosine(np.array(3 * gamma / 2))
        return (far - near) * sine if label == "Zx" else (far + near) * double

    rows: list[Row] = []
    for label, heading in names:
        gamma = None if heading is None else float(as_numbers([heading])[0])
        rows.append((label, gamma, *as_cells(line(label, gamma))))
    return tuple(rows)


SEARCHED = tuple(
    f"half_cycle_{what}" for what in ("Pmax_min", "k0", "alpha0_deg", "phi0_deg", "theta0_deg")
)
SEARCH = "the search ends at theta = 180 deg; larger forces occur at larger theta"
_MOST_RATIOS = 1000  # limit, because each ratio takes a search of 40,000 forces
FOLLOWED = ("printed_choice_Pmax", "printed_choice_theta_deg")


def tabulate_optimum(printed: Print, ranges: Ranges) -> Table:
    """Return the true optimum, the result of the author's search, and the largest force over the
    whole revolution with the printed counterweight.

    Raises:
        ArgumentError: There are too many crank ratios.
    """
    columns = (*printed.columns, *SEARCHED, *FOLLOWED)
    stub = ranges.lam or printed.column("lambda")
    words = printed.align_cells(stub, columns)
    lams = as_numbers(stub).tolist()
    if len(lams) > _MOST_RATIOS:
        raise ArgumentError(
            "{count} crank ratios are to be searched, and at most {most} can be: take larger steps "
            "of {lambda_}",
            count=len(lams),
            most=_MOST_RATIOS,
        )
    searches = [_half_cycle(lam) for lam in lams]
    rows: list[Row] = []
    for lam, search, (_, _, k0, alpha0, *_) in zip(lams, searches, words, strict=True):
        followed: Row = (None, None)
        if k0 is not None and alpha0 is not None:
            k, alpha = as_numbers((k0, alpha0))
            size, theta = max(_stationary(lam, k * np.exp(1j * np.radians(alpha))))
            followed = (size, theta % 360 % 360)
        rows.append((lam, *_true(lam), *search, *followed))
    rest = (None,) * (len(columns) - 6)
    search_rows = tuple((lam, *search, *rest) for lam, search in zip(lams, searches, strict=True))
    return printed.compare(columns, rows, words, [Explanation(SEARCH, search_rows)])


def _true(lam: float) -> Row:
    """Return the smallest peak of |P|/J with its k and alpha. It is reached at three crank angles;
    also return the direction and crank angle of the one at theta = 0, where P lies along the
    cylinder.

    At theta = 0, P = 1 + lam - k falls with k. The two other maxima, symmetric to the cylinder,
    rise with k. The best k makes all three maxima equal.
    """
    k = find_least(lambda k: max(_stationary(lam, k))[0], 0.0, 1.0, 80)
    return (1 + lam - k, k, 0.0, 0.0, 0.0)


def _stationary(lam: float, weight: complex) -> list[tuple[float, float]]:
    """Return (|P|/J, theta in degrees) at the angles where |P| is stationary; `weight` is
    k e^{i alpha}. There, z = e^{i theta} is a root of the derivative of P conj(P).
    """
    p = np.array([lam / 2, 0.5, 0, 0.5 - weight, lam / 2])  # coefficients of z^-2 ... z^2
    square = np.convolve(p, np.conj(p[::-1]))  # coefficients of z^-4 ... z^4
    z = np.roots((np.arange(-4, 5) * square)[::-1])
    z = z[np.abs(np.abs(z) - 1) < 1e-6]
    z /= np.abs(z)
    sizes = np.abs(sum(c * z**n for c, n in zip(p, range(-2, 3), strict=True)))
    return list(zip(sizes.tolist(), np.degrees(np.angle(z)).tolist(), strict=True))


def _half_cycle(lam: float) -> Row:
    """Return the result of the author's search: the smallest peak of |P|/J, its k and alpha, and
    the angle phi of P and the crank angle theta at this peak.
    """
    k = np.arange(11) / 10
    alpha = np.arange(0.0, 91.0, 5.0)
    theta = np.arange(181.0)
    th = np.radians(theta)
    weights = k[:, None, None] * np.exp(1j * (th + np.radians(alpha[:, None])))
    force = np.cos(th) + lam * np.cos(2 * th) - weights
    peaks = np.abs(force).max(axis=-1)
    i, j = np.unravel_index(peaks.argmin(), peaks.shape)
    at = np.abs(force[i, j]).argmax()
    worst = force[i, j, at]
    phi = np.degrees(np.arctan(worst.imag / worst.real))
    return tuple(as_cells(map(float, (peaks[i, j], k[i], alpha[j], phi, theta[at]))))

"""Recompute Table 1 of Wang Yongding, Methods of balancing single-cylinder engines.

A counterweight k m_j r stands at an angle alpha ahead of the point opposite the crank. The
remaining force of orders 1 and 2 is P = J (cos th + lam cos 2 th - k e^{i(th + alpha)}), and the
table lists the counterweight with the smallest largest |P|. The author searched k in steps of 0.1,
alpha in steps of 5 degrees and theta in steps of 1 degree, but theta only over half a revolution.
The best alpha is 0: the greatest |P| is convex in k e^{i alpha}, and changing the sign of alpha
only mirrors the curve.
"""

from __future__ import annotations

import numpy as np

from ..core.extrema import find_least
from ..errors import BalcliError
from .recomputed import Explanation, Print, Ranges, Row, Table, as_cells, as_numbers

SEARCHED = tuple(
    f"half_cycle_{what}" for what in ("Pmax_min", "k0", "alpha0_deg", "phi0_deg", "theta0_deg")
)
SEARCH = "half-cycle search, theta to 180 deg only: larger forces follow"
_MOST_RATIOS = 1000  # limit, because each ratio takes a search of 40,000 forces
FOLLOWED = ("printed_choice_Pmax", "printed_choice_theta_deg")


def tabulate_optimum(printed: Print, ranges: Ranges) -> Table:
    """Return the true optimum, the result of the printed search, and the largest force over the
    whole revolution with the printed counterweight.

    Raises:
        BalcliError: There are too many crank ratios.
    """
    columns = (*printed.columns, *SEARCHED, *FOLLOWED)
    stub = ranges.lam or printed.column("lambda")
    words = printed.align_cells(stub, columns)
    lams = as_numbers(stub).tolist()
    if len(lams) > _MOST_RATIOS:
        raise BalcliError(
            f"{len(lams)} crank ratios are to be searched, and at most {_MOST_RATIOS} can be: take "
            "larger steps of --lambda"
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
    """Return the smallest peak, its k and alpha, and the direction and crank angle of one of its
    three equal maxima, which is along the cylinder: both angles are 0.

    At theta = 0, P = 1 + lam - k falls with k. The two other maxima, symmetric to the cylinder,
    rise with k. The best k makes all three equal.
    """
    k = find_least(lambda k: max(_stationary(lam, k))[0], 0.0, 1.0, 80)
    return (1 + lam - k, k, 0.0, 0.0, 0.0)


def _stationary(lam: float, weight: complex) -> list[tuple[float, float]]:
    """Return (|P|/J, theta in degrees) at the angles where |P| is stationary. They are the roots z
    = e^{i theta} of the derivative of P conj(P).
    """
    p = np.array([lam / 2, 0.5, 0, 0.5 - weight, lam / 2])  # coefficients of z^-2 ... z^2
    square = np.convolve(p, np.conj(p[::-1]))  # coefficients of z^-4 ... z^4
    z = np.roots((np.arange(-4, 5) * square)[::-1])
    z = z[np.abs(np.abs(z) - 1) < 1e-6]
    z /= np.abs(z)
    sizes = np.abs(sum(c * z**n for c, n in zip(p, range(-2, 3), strict=True)))
    return list(zip(sizes.tolist(), np.degrees(np.angle(z)).tolist(), strict=True))


def _half_cycle(lam: float) -> Row:
    """Return the result of the author's search: P, k, alpha, line phi of the force, and theta."""
    k, alpha, theta = np.arange(11) / 10, np.arange(0.0, 91.0, 5.0), np.arange(181.0)
    th = np.radians(theta)
    weights = k[:, None, None] * np.exp(1j * (th + np.radians(alpha[:, None])))
    force = np.cos(th) + lam * np.cos(2 * th) - weights
    peaks = np.abs(force).max(axis=-1)
    i, j = np.unravel_index(peaks.argmin(), peaks.shape)
    at = np.abs(force[i, j]).argmax()
    worst = force[i, j, at]
    phi = np.degrees(np.arctan(worst.imag / worst.real))
    return tuple(as_cells(map(float, (peaks[i, j], k[i], alpha[j], phi, theta[at]))))

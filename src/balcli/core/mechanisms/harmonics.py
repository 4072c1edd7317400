"""Compute Fourier coefficients of slider-cranks: in closed form if no cylinder has an offset, else
by the FFT of samples over one revolution.

The closed form has a relative error of about 1e-14 in every order, the FFT an absolute error of
about 1e-16. Equal mechanisms are computed once.

Accelerations are sampled directly, not differentiated, so that the error does not grow with the
order.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..phasors import EPS, Array, Complex, Numbers, unit
from . import closed_form
from .closed_form import SERIES, Harmonics, Rows, Series, select_cylinders
from .motion import Motion, Move
from .slidercrank import SliderCrank

HARDEST = 1 << 16  # number of samples of a revolution if lam + |eps| = 1 - 1e-6 (at 1, it locks)
CLOSED_FORM = 4096  # highest order in closed form; higher orders matter only close to locking


def find_distinct(*figures: Numbers) -> tuple[tuple[Numbers, ...], Rows]:
    """Return the figures of all different mechanisms, each of shape (mechanisms,), and the index of
    each cylinder's mechanism, shape (cylinders or 1, *trailing). Mechanisms are in the order of the
    cylinders.

    A cylinder that does not vary along a trailing axis has one mechanism for this whole axis.
    Cylinders with the same figures in every variant share their mechanisms.

    Args:
        figures: Figures of the mechanisms, each of shape (cylinders or 1, *trailing); trailing axes
            broadcast.
    """
    shape = np.broadcast_shapes(*(values.shape for values in figures))
    indices: dict[tuple[object, ...], Rows] = {}  # of mechanisms, by a cylinder's figures
    different: list[list[Numbers]] = []
    which = np.empty(shape, np.intp)
    count = 0
    for row in range(shape[0]):
        narrowed = (narrow(values[row if len(values) > 1 else 0]) for values in figures)
        own = np.broadcast_arrays(*narrowed)
        key = (own[0].shape, *(values.tobytes() for values in own))
        if key not in indices:
            indices[key] = count + np.arange(own[0].size).reshape(own[0].shape)
            different.append([values.ravel() for values in own])
            count += own[0].size
        which[row] = indices[key]
    joined = tuple(np.concatenate(parts) for parts in zip(*different, strict=True))
    return joined, which


def narrow(values: Numbers) -> Numbers:
    """Return the values with length 1 along axes on which they do not vary."""
    for axis, length in enumerate(values.shape):
        if length > 1 and (values == (first := values.take([0], axis))).all():
            values = first
    return values


def find_harmonics(
    orders: ArrayLike, lam: Array, eps: Array, wanted: Collection[str] = SERIES
) -> Harmonics:
    """Return the harmonics of the mechanism of each cylinder.

    Args:
        orders: Orders, not negative, shape (orders,).
        lam, eps: Crank radius and offset over rod length, shape (cylinders or 1, *trailing), with
            lam + |eps| < 1.
        wanted: Names of series (`closed_form.SERIES`).
    """
    few, which = find_distinct_harmonics(orders, lam, eps, wanted)
    return select_cylinders(few, which)


def find_distinct_harmonics(
    orders: ArrayLike, lam: Array, eps: Array, wanted: Collection[str]
) -> tuple[Harmonics, Rows]:
    """Return the harmonics of all different mechanisms, and the index of each cylinder's mechanism.
    If some mechanism has an offset, all are sampled.

    Args:
        orders, lam, eps, wanted: As in `find_harmonics`.
    """
    highest = float(np.max(orders, initial=0))
    if np.any(eps) or highest > CLOSED_FORM:
        figures, which = find_distinct(lam, eps)
        counts = count_samples(figures[0], figures[1], highest)
        return sample_mechanisms(orders, wanted, SliderCrank, figures, counts, highest)[0], which
    (ratios,), which = find_distinct(lam)
    return closed_form.find_harmonics(orders, ratios, wanted), which


def count_all_samples(lam: Array, eps: Array) -> tuple[int, int]:
    """Return the number of different mechanisms, and how many samples of a revolution they need
    together.

    Args:
        lam, eps: Crank radius and offset over rod length, shape (cylinders or 1, *trailing).
    """
    (ratios, offsets), _ = find_distinct(lam, eps)
    return len(ratios), int(count_samples(ratios, offsets).sum())


def count_samples(lam: ArrayLike, eps: ArrayLike, highest: float = np.inf) -> NDArray[np.intp]:
    """Return the number of samples (a power of two) that each mechanism needs so that orders up to
    the highest have no aliases above rounding errors, and no order above rounding errors is
    missing.

    Order n of N samples is mixed with order N - n. Coefficients decay like `x^n`, x =
    tan(arcsin(lam')/2), `lam' = lam / (1 - |eps|)`, because cos beta is analytic in a strip of the
    complex plane.

    Args:
        lam: Crank radius / rod length, any shape.
        eps: Offset / rod length, in the shape of `lam`.
        highest: Highest order that is wanted.
    """
    steep = np.clip(np.asarray(lam) / (1 - np.abs(eps)), 1e-99, 1 - EPS)
    decay = -np.log(steep / (1 + np.sqrt((1 - steep) * (1 + steep))))
    last = -1.2 * np.log(EPS) / decay  # highest order above rounding
    doublings = np.ceil(np.log2(np.maximum(last + np.minimum(highest, last), 16)))
    return np.asarray(1 << doublings.astype(np.intp))


def find_highest_order(lam: Array, eps: Array) -> int:
    """Return the order beyond which the coefficients of these mechanisms are below rounding.

    Args:
        lam: Crank radius / rod length, any shape.
        eps: Offset / rod length, in the shape of `lam`.
    """
    return int(count_samples(lam, eps).max()) // 2


SAMPLING = 16 * EPS  # error of a sampled coefficient, in units of the curve's root mean square
MOST_SAMPLES = 1 << 18
_AT_ONCE = 1 << 16  # number of samples computed together, which fit into the processor's cache
_LIMIT = SAMPLING / 16  # limit of the aliases of a wanted order

_SAMPLED = (
    "piston",
    "rod",
    "kinetic",
    "rod_kinetic",
    "along",
    "across",
    "couple",
    "energy",
    "swirl",
)


def _sample(name: str, m: Motion) -> Array:  # noqa: PLR0911 (one return for each function)
    """Return the values of one of the functions `_SAMPLED` of a motion."""
    match name:
        case "piston":
            return -m.acceleration
        case "rod":
            return m.spin_rate
        case "kinetic":
            return m.velocity**2
        case "rod_kinetic":
            return m.spin**2
        case "along":
            return -m.acceleration_of_mass.real
        case "across":
            return -m.acceleration_of_mass.imag
        case "couple":
            return -m.swirl_rate
        case "energy":
            return m.energy
        case _:
            return m.swirl


_OF_ROD = frozenset({"piston", "rod", "kinetic", "rod_kinetic"})


def sample_mechanisms(
    orders: ArrayLike,
    wanted: Collection[str],
    move: Move,
    figures: Sequence[Numbers],
    counts: NDArray[np.intp],
    highest: float,
) -> tuple[Harmonics, NDArray[np.intp]]:
    """Return the series of many mechanisms by name, each of shape (orders, mechanisms), and the
    number of samples that each mechanism needed, shape (mechanisms,).

    Args:
        orders: Orders, shape (orders,).
        wanted: Names of series (`closed_form.SERIES`).
        move: Function that returns the motion of mechanisms from e^{i psi}, shape (samples, 1), and
            figures of shape (mechanisms,).
        figures: Figures of the mechanisms, each of shape (mechanisms,).
        counts: Samples of a revolution with which each mechanism begins, powers of two, shape
            (mechanisms,); they are doubled until the orders up to `highest` have no aliases above
            rounding.
        highest: Highest order for which the samples must suffice.
    """
    n = np.asarray(orders)
    taken = counts.copy()
    series: Harmonics = {}
    waiting = [(count, np.flatnonzero(counts == count)) for count in set(counts.tolist())]
    while waiting:
        count, rows = waiting.pop()
        most = max(_AT_ONCE // count, 1)
        if len(rows) > most:
            waiting.append((count, rows[most:]))
            rows = rows[:most]
        circle = unit(np.arange(count) * (360 / count))[:, None]
        motion = move(circle, *(values[rows] for values in figures))
        inside = (n % 1 == 0) & (n < count // 2)  # orders below half the samples
        numbers = np.where(inside, n, 0).astype(int)
        scale = (np.where(numbers == 0, 1, 2) * inside)[:, None]
        enough = np.ones(len(rows), bool)
        for name in _OF_ROD.union(_SAMPLED if motion.points else ()).intersection(wanted):
            samples = _sample(name, motion)
            rounding = _amplify_rounding(samples, motion.condition if name in _OF_ROD else 1.0)
            spectrum = np.fft.rfft(samples, axis=0, norm="forward")
            if name not in series:
                shape = len(n), len(counts)
                series[name] = Series(np.zeros(shape, complex), np.zeros(shape[1]))
            series[name].c[:, rows] = spectrum[numbers] * scale
            np.asarray(series[name].noise)[rows] = SAMPLING * rounding
            enough &= _is_enough(spectrum, rounding, highest) | (count >= MOST_SAMPLES)
        taken[rows] = count
        if not enough.all():
            waiting.append((2 * count, rows[~enough]))
    return series, taken


def _amplify_rounding(samples: Array, condition: Array | float) -> Array:
    """Return the error of a coefficient if every sample is rounded, in units of one rounding, shape
    (mechanisms,).

    It is proportional to the root mean square of the samples; if samples have errors of more than a
    few ulp, the mean of their sizes times `condition` is added.
    """
    spread: Array = np.sqrt(2 * np.mean(samples**2, axis=0))
    if np.ndim(condition) == 0:
        return spread
    return spread + np.mean(np.abs(samples) * condition, axis=0)


def _is_enough(spectrum: Complex, rounding: Array, highest: float) -> NDArray[np.bool_]:
    """Return whether the orders up to the highest have no aliases above rounding.

    Order n of N samples is mixed with order N - n, whose size is extrapolated from the upper half
    of the spectrum. From the third to the fourth eighth of the N orders, the largest coefficient
    falls by some factor. It is assumed to fall by the same factor in every further eighth up to
    order N - n; half an eighth is subtracted from this distance as a margin.

    Args:
        spectrum: `rfft` of the samples with norm "forward", shape (N/2 + 1, mechanisms).
        rounding: `_amplify_rounding` of the samples, shape (mechanisms,).
    """
    eighth = (len(spectrum) - 1) / 4
    sizes = np.abs(spectrum[round(2 * eighth) :])
    third = sizes[: round(eighth)].max(axis=0)
    fourth = sizes[round(eighth) :].max(axis=0)
    decay = fourth / np.maximum(third, fourth + 1e-300)
    alias = fourth * decay ** (max(8 - highest / eighth, 4) - 3.5)
    return np.asarray(alias <= _LIMIT * np.maximum(rounding, 1.0))

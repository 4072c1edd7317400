"""Harmonics of many mechanisms, each sampled over a revolution as often as it needs, in blocks that
stay in the processor's cache.

Accelerations are sampled as such, not differentiated, so that no order's error grows.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..phasors import Array, Complex
from .fourier import (
    NONE,
    SAMPLING,
    Curve,
    Harmonics,
    Series,
    amplify_rounding,
    pick_orders,
    unit_circle,
)
from .motion import Motion, Move

MOST_SAMPLES = 1 << 18
_AT_ONCE = 1 << 16  # samples: of fewer, threads hand each other Python's lock; more leave the cache
_LIMIT = SAMPLING / 4  # of the upper half of a spectrum that holds rounding errors alone

_OF_ROD: Mapping[str, Callable[[Motion], Array]] = MappingProxyType(
    {
        "piston": lambda m: -m.acceleration,
        "rod": lambda m: m.spin_rate,
        "kinetic": lambda m: m.velocity**2,
        "rod_kinetic": lambda m: m.spin**2,
    }
)
_OF_MASS: Mapping[str, Callable[[Motion], Array]] = MappingProxyType(
    {
        "along": lambda m: -m.acceleration_of_mass.real,
        "across": lambda m: -m.acceleration_of_mass.imag,
        "couple": lambda m: -m.swirl_rate,
        "energy": lambda m: m.energy,
        "swirl": lambda m: m.swirl,
    }
)


class Sampled(NamedTuple):
    """Series of mechanisms by name, each of shape (orders, mechanisms), and how many samples each
    mechanism took, shape (mechanisms,).
    """

    series: dict[str, Series]
    counts: NDArray[np.intp]

    def as_harmonics(self, turns: float = 0.0) -> Harmonics:
        """The series that there are; `turns` as in `Harmonics`."""
        of_rod = {name: self.series.get(name, NONE) for name in _OF_ROD}
        of_mass = {name: self.series.get(name, NONE) for name in _OF_MASS}
        on_curve = bool(self.series.keys() & of_mass.keys())
        return Harmonics(**of_rod, curve=Curve(**of_mass) if on_curve else None, turns=turns)


class _Room(NamedTuple):
    """For a series of all mechanisms."""

    c: Complex
    noise: Array


def sample_mechanisms(
    orders: ArrayLike,
    wanted: Collection[str],
    move: Move,
    figures: Sequence[NDArray[Any]],
    counts: NDArray[np.intp],
    highest: float | None = None,
) -> Sampled:
    """Series of many mechanisms, each sampled as often as it needs, whatever the others need.

    Args:
        orders: shape (orders,).
        wanted: names of series (`fourier.SERIES`).
        move: the mechanisms in motion, by e^{i psi} of shape (samples, 1) and figures of shape
            (mechanisms,): arrays that run along many mechanisms are quicker than along samples.
        figures: what distinguishes them, each of shape (mechanisms,).
        counts: samples of a revolution that each takes at first, powers of two.
        highest: where given, a mechanism whose samples are too few for orders up to this one takes
            twice as many, and so on; else the counts are enough.
    """
    n = np.asarray(orders)
    found: dict[str, _Room] = {}
    taken = counts.copy()
    # np.unique would import masked arrays, which takes longer than sampling most engines
    waiting = {count: np.flatnonzero(counts == count) for count in set(counts.tolist())}
    while waiting:
        count = min(waiting)
        circle, again = unit_circle(count), []
        for rows in _divide(waiting.pop(count), max(_AT_ONCE // count, 1)):
            motion = move(circle[:, None], *(values[rows] for values in figures))
            enough = np.ones(len(rows), bool)
            for name, samples, condition in _take_samples(motion, wanted):
                rounding = amplify_rounding(samples.T, np.transpose(condition))
                spectrum = np.fft.rfft(samples, axis=0).T
                if name not in found:
                    shape = len(n), len(counts)
                    found[name] = _Room(np.zeros(shape, complex), np.zeros(shape[1]))
                found[name].c[:, rows] = pick_orders(spectrum, n)
                found[name].noise[rows] = SAMPLING * rounding
                if highest is not None and count < MOST_SAMPLES:
                    enough &= _is_enough(spectrum, rounding, highest)
            taken[rows] = count
            again.append(rows[~enough])
        if any(map(len, again)):
            again.append(waiting.get(2 * count, again[0][:0]))
            waiting[2 * count] = np.concatenate(again)
    return Sampled({name: Series(*room) for name, room in found.items()}, taken)


def _divide(rows: NDArray[np.intp], step: int) -> Iterator[NDArray[np.intp]]:
    """So many at a time."""
    return (rows[k : k + step] for k in range(0, len(rows), step))


def _take_samples(
    motion: Motion, wanted: Collection[str]
) -> Iterator[tuple[str, Array, Array | float]]:
    """Name, samples and condition of these of each series that is wanted and there."""
    for name, find in _OF_ROD.items():
        if name in wanted:
            yield name, find(motion), motion.condition
    for name, find in _OF_MASS.items():
        if name in wanted and motion.points:
            yield name, find(motion), 1.0


def _is_enough(spectrum: Complex, rounding: Array, highest: float) -> NDArray[np.bool_]:
    """Whether these samples are enough for orders up to the highest.

    They are where the upper half of the spectrum holds rounding errors alone. Low orders need less:
    order n of N samples is mixed with N - n, and what is there follows from how the
    upper half falls. From one half of it to the other it does so by some factor, and by that factor
    again for every N/8 orders from there on.

    Args:
        spectrum: shape (mechanisms, samples/2 + 1).
        rounding: `amplify_rounding` of the samples, shape (mechanisms,).
    """
    count = 2 * (spectrum.shape[-1] - 1)
    upper = spectrum[:, count // 4 :]
    sizes = np.sqrt(upper.real**2 + upper.imag**2) / count
    before, last = sizes[:, : count // 8].max(axis=-1), sizes[:, count // 8 :].max(axis=-1)
    enough = np.maximum(before, last) <= _LIMIT * np.maximum(rounding, 1.0)
    if highest <= count / 8:
        factor = last / np.maximum(before, last + 1e-300)
        mixed = last * factor ** ((count - highest) / (count / 8) - 3)
        enough |= mixed <= _LIMIT / 16 * rounding
    return np.asarray(enough)

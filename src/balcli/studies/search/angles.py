"""The best value of one angle: a grid for the valleys, then ever finer grids in each."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...core.phasors import Array

STEP = 0.5  # deg
FINER = 20  # times, from one grid to the next
ROUNDS = 6
ROUND = (1.0, 0.1, 0.01, 0.001, 1e-4)  # deg: the roundest angle that is as good is taken


def find_valleys(value: Callable[[Array], Array], low: float, high: float, count: int) -> Array:
    """The lowest places of a function of an angle in [low, high], at most `count`, lowest first,
    deg.

    Args:
        value: of angles in deg, shape (angles,); inf is no value.
    """
    x = np.linspace(low, high, round((high - low) / STEP) + 1)
    y = value(x)
    padded = np.concatenate([[np.inf], y, [np.inf]])
    deep = np.isfinite(y) & (y <= padded[:-2]) & (y <= padded[2:])
    deep[1:] &= ~(deep[:-1] & (y[1:] == y[:-1]))  # a level stretch is one valley
    best = np.flatnonzero(deep)[np.argsort(y[deep], kind="stable")][:count]
    if not len(best):
        return x[best]
    found = np.unique(_refine(value, x[best], low, high))
    return found[np.argsort(value(found), kind="stable")]


def _refine(value: Callable[[Array], Array], x: Array, low: float, high: float) -> Array:
    """The lowest place within a step beside each of these angles."""
    width = STEP
    for _ in range(ROUNDS):
        around = np.clip(x[:, None] + np.linspace(-width, width, 2 * FINER + 1), low, high)
        y = value(around.ravel()).reshape(around.shape)
        x = around[np.arange(len(x)), y.argmin(axis=1)]
        width /= FINER
    return _round_off(value, x)


def _round_off(value: Callable[[Array], Array], x: Array) -> Array:
    """The same angles, or rounder ones that are as good but for rounding errors."""
    y = value(x)
    slack = 1e-9 * np.abs(y) + 1e-9 * value(np.clip(x + STEP, None, x.max(initial=0) + STEP))
    for grain in reversed(ROUND):
        rounder = np.round(x / grain) * grain
        x = np.where(value(rounder) <= y + slack, rounder, x)
    return x

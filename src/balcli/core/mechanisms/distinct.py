"""Which of many mechanisms differ: equal ones are computed once, whether they are cylinders of one
engine or stand still while others vary.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray


class Distinct(NamedTuple):
    """Mechanisms that differ, one after the other.

    Attributes:
        figures: each figure that tells them apart, shape (mechanisms,).
        which: number of the mechanism that each cylinder has, shape (cylinders or 1, *trailing).
    """

    figures: tuple[NDArray[Any], ...]
    which: NDArray[np.intp]


def find_distinct(*figures: NDArray[Any]) -> Distinct:
    """The mechanisms that differ in some figure, in the order in which cylinders have them.

    A cylinder that does not vary along an axis has one mechanism there; cylinders with the same
    figures at every variant have the same mechanisms.

    Args:
        figures: each of shape (cylinders or 1, *trailing); trailing axes broadcast.
    """
    if all(values.size == 1 for values in figures):  # most engines
        axes = max(values.ndim for values in figures)
        return Distinct(tuple(values.ravel() for values in figures), np.zeros((1,) * axes, np.intp))
    if figures[0].ndim == 1:
        return _find_distinct_of_one(figures)
    shape = np.broadcast_shapes(*(values.shape for values in figures))
    starts: dict[tuple[tuple[tuple[int, ...], bytes], ...], int] = {}
    different: list[list[NDArray[Any]]] = []
    which = np.empty(shape, np.intp)
    found = 0
    for row in range(shape[0]):
        own = [narrow(values[row if len(values) > 1 else 0]) for values in figures]
        key = tuple((values.shape, values.tobytes()) for values in own)
        own_shape = np.broadcast_shapes(*(values.shape for values in own))
        count = math.prod(own_shape)
        if key not in starts:
            starts[key] = found
            different.append([np.broadcast_to(values, own_shape).ravel() for values in own])
            found += count
        which[row] = starts[key] + np.arange(count).reshape(own_shape)
    joined = tuple(np.concatenate(parts) for parts in zip(*different, strict=True))
    return Distinct(joined, which)


def _find_distinct_of_one(figures: Sequence[NDArray[Any]]) -> Distinct:
    """Those of one engine, each figure of shape (cylinders or 1,)."""
    count = max(map(len, figures))
    rows = [values.tolist() * (count if len(values) == 1 else 1) for values in figures]
    each = list(zip(*rows, strict=True))
    place = {one: k for k, one in enumerate(dict.fromkeys(each))}
    which = np.array([place[one] for one in each])
    return Distinct(tuple(map(np.array, zip(*place, strict=True))), which)


def narrow(values: NDArray[Any]) -> NDArray[Any]:
    """The same without repetition: axes along which nothing changes get length 1."""
    for axis, length in enumerate(values.shape):
        if length > 1 and (values == (first := values.take([0], axis))).all():
            values = first
    return values

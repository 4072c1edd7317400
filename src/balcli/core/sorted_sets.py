"""Sets of numbers as ascending arrays.

`numpy.unique`, `numpy.median` and their like import masked arrays, which takes longer than most of
what balcli computes.
"""

from __future__ import annotations

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

T = TypeVar("T", bound=np.generic)


def sort_distinct(values: NDArray[T]) -> NDArray[T]:
    """The different ones of numbers of any shape, ascending."""
    ascending = np.sort(values, axis=None)
    new = np.ones(len(ascending), bool)
    new[1:] = ascending[1:] != ascending[:-1]
    return ascending[new]


def find_middle(values: NDArray[T]) -> T:
    """The middle one of numbers of any shape, at least one; of two the larger."""
    ascending: NDArray[T] = np.sort(values, axis=None)
    middle: T = ascending[len(ascending) // 2]
    return middle


def sort_others(values: NDArray[T], known: NDArray[T]) -> NDArray[T]:
    """The different ones of numbers of any shape that are not among the known ones, ascending."""
    found = sort_distinct(values)
    return found[~are_among(found, known)]


def are_among(values: NDArray[T], known: NDArray[T]) -> NDArray[np.bool_]:
    """Whether each number is one of the known ones, of the shape of `values`."""
    if not known.size:
        return np.zeros(values.shape, bool)
    ascending = np.sort(known, axis=None)
    place = np.minimum(np.searchsorted(ascending, values), len(ascending) - 1)
    return np.asarray(ascending[place] == values)

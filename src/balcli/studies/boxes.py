"""Boxes of a grid: which variants of a sweep are computed together."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import product
from typing import NamedTuple, TypeAlias

import numpy as np

Box: TypeAlias = tuple[slice, ...]
JOINED = 1 << 20  # variants in a box that is computed in tiles, at most: their figures are kept
_TILES = 8  # in such a box, at most


class BoxSize(NamedTuple):
    """How much is computed at a time.

    Attributes:
        variants: at most.
        side: values of one parameter, at most.
    """

    variants: int
    side: int


def divide_into_boxes(shape: tuple[int, ...], size: BoxSize) -> Iterator[Box]:
    """The boxes of a grid, in the order of rows. Those of one parameter's value alone, or of a few,
    are joined, to be computed in tiles.
    """
    narrow = len(shape) > 1 and shape[-1] * _TILES > size.variants
    joined = max(min(_TILES * size.variants, JOINED), size.variants)
    return divide_grid(shape, joined if narrow else size.variants)


def divide_grid(shape: tuple[int, ...], most: int) -> Iterator[Box]:
    """The grid in boxes of at most `most` variants, in the order of rows: the last axes whole, one
    cut into like parts, the first one by one.
    """
    axis = len(shape) - 1
    while axis > 0 and math.prod(shape[axis:]) <= most:
        axis -= 1
    longest = max(most // math.prod(shape[axis + 1 :]), 1)
    step = math.ceil(shape[axis] / math.ceil(shape[axis] / longest))
    for fixed in np.ndindex(shape[:axis]):
        for start in range(0, shape[axis], step):
            yield (
                *(slice(k, k + 1) for k in fixed),
                slice(start, min(start + step, shape[axis])),
                *(slice(0, n) for n in shape[axis + 1 :]),
            )


def divide_into_tiles(shape: tuple[int, ...], size: BoxSize) -> Iterator[Box]:
    """A box in tiles of this size, which are about as long as wide: so their sides, along which
    most is computed, are short.
    """
    steps = [min(n, size.side) for n in shape]
    while math.prod(steps) > size.variants:
        longest = steps.index(max(steps))
        steps[longest] = (steps[longest] + 1) // 2
    cuts = [range(0, n, step) for n, step in zip(shape, steps, strict=True)]
    for starts in product(*cuts):
        yield tuple(
            slice(k, min(k + step, n)) for k, step, n in zip(starts, steps, shape, strict=True)
        )

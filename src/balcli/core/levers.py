"""Loads along a shaft: carried to given planes by the lever, which leaves their sum and moment as
they are.
"""

from __future__ import annotations

import numpy as np

from .phasors import Array


def share_by_lever(places: Array, planes: Array) -> Array:
    """Share of each load that each plane takes, shape (planes, loads): the two planes on either
    side of it share it, loads beyond the outermost plane hang on the last two (with shares below 0
    and above 1); a single plane takes all of each.

    Args:
        places: of the loads, m, shape (loads,).
        planes: m, shape (planes,), ascending, none twice.
    """
    if len(planes) == 1:
        return np.ones((1, len(places)))
    left = np.clip(np.searchsorted(planes, places, side="right") - 1, 0, len(planes) - 2)
    right_share = (places - planes[left]) / (planes[left + 1] - planes[left])
    shares = np.zeros((len(planes), len(places)))
    loads = np.arange(len(places))
    shares[left, loads] += 1 - right_share
    shares[left + 1, loads] += right_share
    return shares

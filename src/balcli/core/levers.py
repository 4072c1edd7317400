"""Loads along a shaft: carried to given planes by the lever, which leaves their sum and moment as
they are.
"""

from __future__ import annotations

import numpy as np

from .phasors import Array


def share_by_lever(places: Array, planes: Array) -> Array:
    """Return the share of each load that each plane takes, shape (planes, loads): the two planes on
    either side of it share it, loads beyond the outermost plane hang on the last two (with shares
    below 0 and above 1); a single plane takes all of each.

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


def find_ahead(z: Array, sections: Array) -> Array:
    """Return 1 for places on the free-end side of each section, else 0, shape (sections, places).

    Args:
        z: Axial places, m, shape (places,).
        sections: Axial positions of the sections, m, shape (sections,).
    """
    return (z <= sections[:, None]).astype(float)


def find_arms(z: Array, sections: Array) -> Array:
    """Return the arms about each section of the places on its free-end side, m, shape (sections,
    places).

    Args:
        z: Axial places, m, shape (places,).
        sections: Axial positions of the sections, m, shape (sections,).
    """
    return find_ahead(z, sections) * (z - sections[:, None])


def bound_arms(z: Array, sections: Array) -> Array:
    """Return the sizes that `find_arms` subtracts from one another, m, which bound the rounding of
    arms, shape (sections, places).

    Args:
        z: Axial places, m, shape (places,).
        sections: Axial positions of the sections, m, shape (sections,).
    """
    return find_ahead(z, sections) * (np.abs(z) + np.abs(sections[:, None]))

"""A body as pictures show it: an even block of its mass and moments of inertia, seen askew."""

from __future__ import annotations

from itertools import product

import numpy as np

from ..core.rigid_body import Body
from ..core.vibration import Real

_FLATTEST = 0.05  # square of a side, of the largest, below which a block is not drawn
# On the page x of the engine is up, z runs to the right, y to the left and towards the reader.
PROJECTION = np.array([[0.0, -0.62, 0.86], [1.0, -0.34, -0.28]])


def find_corners(body: Body) -> Real:
    """(8, 3) m, about the centre of gravity; those whose numbers differ in one bit share an edge.

    Sides lie along the engine's axes; products of inertia are left out.
    """
    moments = np.diagonal(body.inertia)
    squares = 1.5 * (moments.sum() - 2 * moments) / body.mass
    half = np.sqrt(np.maximum(squares, _FLATTEST * squares.max()))
    return np.array(list(product((-1.0, 1.0), repeat=3))) * half

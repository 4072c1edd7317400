"""S. S. Rao: Mechanical Vibrations, sixth edition in SI units, problem 1.116.

No printed answer was seen; the figures are those of the 24 points by themselves. A table of equal
steps, joined by straight lines, has them times (sin x/x)^2, x = pi n/24.
"""

import numpy as np
import pytest

from balcli.core.piecewise import polyline

# fmt: off
TORQUE = [
    770, 810, 850, 910, 1010, 1170, 1370, 1610, 1890, 1750, 1630, 1510,
    1390, 1290, 1190, 1110, 1050, 990, 930, 890, 850, 810, 770, 750,
]
# fmt: on
EXPECTED = {1: (-414.947233, 150.3162382), 2: (28.6004234, -146.17199), 3: (35.72504807, 55.15313849)}


def test_problem_1_116():
    """The first point is at 0.5 ms; the period is 24 steps, not the 23 of a solution in circulation."""
    angle = 2 * np.pi * np.arange(1, 26) / 24
    found = polyline(angle, [*TORQUE, TORQUE[0]]).harmonics(np.arange(4))
    assert found[0] == pytest.approx(1137.5, rel=1e-14)
    for order, (cosine, sine) in EXPECTED.items():
        straight = np.sinc(order / 24) ** 2
        assert found[order] / straight == pytest.approx(cosine - 1j * sine, rel=1e-9)

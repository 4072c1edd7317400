"""J. J. Uicker, G. R. Pennock and J. E. Shigley: Theory of Machines and Mechanisms, problem 18.1 and
its printed solution.

The mean torque is right for the table as it is printed, by Simpson's rule. The flywheel is not: the
solution takes the work of a whole cycle for the fluctuation of energy, which is more than twice as
large. 430 and 440 deg break the table's symmetry about 360 deg (190 and 324 expected).
"""

import numpy as np
import pytest

from balcli.core.piecewise import polyline
from balcli.core.speed_ripple import needed_inertia, small_fluctuation, surplus

# fmt: off
TORQUE = [  # N m, every 10 deg
    0, 17, 812, 963, 1016, 937, 774, 641, 697, 849, 1031, 1027, 902, 712, 607, 594, 544, 345,
    0, -344, -540, -576, -570, -638, -785, -879, -814, -571, -324, -190, -203, -235, -164, -7, 150, 145,
    0, -145, -150, 7, 164, 235, 203, 490, 424, 571, 814, 879, 785, 638, 570, 576, 540, 344,
    0, -344, -540, -577, -572, -643, -793, -893, -836, -605, -379, -264, -300, -368, -334, -198, -56, -2,
]
# fmt: on
SPEED, WANTED = 4600 * np.pi / 30, 0.025


def torque(mended=False):
    values = [*TORQUE, TORQUE[0]]
    if mended:
        values[43:45] = 190, 324
    return polyline(np.radians(np.arange(0, 721, 10)), values)


def simpson():
    weights = np.tile([2, 4], 36)
    return float(weights @ TORQUE) * np.pi / 18 / 3


def test_mean_torque():
    assert round(simpson(), 1) == 890.7
    assert round(simpson() / (4 * np.pi), 2) == 70.88
    assert torque().integral == pytest.approx(simpson(), rel=0.03)


@pytest.mark.parametrize(("mended", "energy"), [(False, 1963.42), (True, 1979.65)])
def test_surplus_energy(mended, energy):
    curve = torque(mended)
    found = surplus(curve)
    assert found.energy == pytest.approx(energy, abs=0.005)
    assert found.energy > 2 * curve.integral


def test_flywheel():
    """0.154 kg m2 are printed; 0.339 are needed."""
    assert round(simpson() / (WANTED * SPEED**2), 3) == 0.154
    needed = needed_inertia(torque(), SPEED, WANTED)
    assert needed == pytest.approx(0.3386195734, rel=2e-3)
    assert small_fluctuation(1963.42, needed, SPEED) == pytest.approx(WANTED, rel=1e-3)

"""Chains whose frequencies have a closed form, and textbook examples of a single one."""

import numpy as np
import pytest

from balcli.core.vibration import scale_shapes
from balcli.torsion.chain import ChainShaft, join_chain
from balcli.torsion.modes import find_chain_modes


def hollow(diameter, bore=0.0):
    """Polar second moment of area."""
    return np.pi * (diameter**4 - bore**4) / 32


@pytest.mark.parametrize(("count", "inertia", "stiffness"), [(5, 20, 125), (1, 2, 8), (40, 3, 7e9)])
def test_equal_discs_one_end_fixed(count, inertia, stiffness):
    """w_i = 2 sqrt(k/J) sin((2i - 1) pi/(2 (2n + 1))): classical."""
    shafts = [ChainShaft(i, i + 1, stiffness) for i in range(count)]
    modes = find_chain_modes(join_chain([inertia] * (count + 1), shafts, clamped=[0]))
    i = np.arange(1, count + 1)
    closed = 2 * np.sqrt(stiffness / inertia) * np.sin((2 * i - 1) * np.pi / (2 * (2 * count + 1)))
    assert modes.omega == pytest.approx(closed, rel=1e-14, abs=0)
    if count == 5:  # n = 5, J = 20, k = 125 recomputed
        assert modes.omega == pytest.approx([0.7115741914, 2.077075065, 3.27430367, 4.206267664, 4.797464868], rel=1e-9)


def test_equal_discs_both_ends_free():
    """w_i = 2 sqrt(k/J) sin(i pi/(2n)), shapes cos(i pi (2m - 1)/(2n)): classical."""
    n, i = 8, np.arange(8)[:, None]
    modes = find_chain_modes(join_chain([0.3] * n, [ChainShaft(m, m + 1, 5e4) for m in range(n - 1)]))
    assert modes.omega == pytest.approx(2 * np.sqrt(5e4 / 0.3) * np.sin(i[:, 0] * np.pi / (2 * n)), rel=1e-14)
    shapes = np.cos(i * np.pi * (2 * np.arange(1, n + 1) - 1) / (2 * n))
    assert scale_shapes(modes.shapes) == pytest.approx(scale_shapes(shapes), abs=1e-13)


def test_two_rotors_on_a_stepped_shaft():
    """Bevan, The Theory of Machines, chapter 15, example 8 (p. 570), as recomputed in the FOSSEE
    Python Textbook Companions: 1500 and 1000 lb ft^2, five lengths in a row, C = 12e6 lb/in^2.

    The companion prints 23.8 Hz: its whole-number division (3/5 and 3/7 become 0) drops three of
    the five lengths. All five make 22.256 Hz.
    """
    inertia = np.array([1500, 1000]) * 144 / (32.2 * 12)  # lb in s^2
    lengths, diameters = np.array([11, 10, 15, 4, 10]), np.array([3, 5, 3.5, 7, 5])
    pieces = 12e6 * hollow(diameters) / lengths
    steps = [ChainShaft(i, i + 1, k) for i, k in enumerate(pieces)]
    modes = find_chain_modes(join_chain([inertia[0], 0, 0, 0, 0, inertia[1]], steps))
    assert modes.omega / (2 * np.pi) == pytest.approx([0, 22.25625042], rel=1e-9)
    rest = 12e6 * hollow(3) / (11 + 15 * (3 / 3.5) ** 4)
    companion = find_chain_modes(join_chain(inertia, [ChainShaft(0, 1, rest)]))
    assert round(companion.omega[1] / (2 * np.pi), 1) == 23.8


def test_three_rotors():
    """Bevan, chapter 15, example 9 (p. 572), in the same companion: 2.5, 7.5 and 3 ton ft^2, 9.5 and
    25 ft apart on a shaft of 8.5 in, C = 11.8e6 lb/in^2.

    Printed 961 and 1784 a minute; the second from the first rounded to 16 a second: 1787.5.
    """
    inertia = np.array([2.5, 7.5, 3]) * 2240 * 144 / (32.2 * 12)
    shafts = [ChainShaft(i, i + 1, 11.8e6 * hollow(8.5) / (12 * ft)) for i, ft in enumerate([9.5, 25])]
    _, first, second = find_chain_modes(join_chain(inertia, shafts)).omega * 60 / (2 * np.pi)
    assert round(first) == 961
    assert second * 16 * 60 / first == pytest.approx(1784, rel=0.002)


def test_flywheel_on_a_cantilever():
    """Bevan, chapter 15, example 1 (p. 535): 0.3 ton at a radius of gyration of 15 in on a shaft of
    3 in by 36 in, C = 12e6 lb/in^2: 786 torsional vibrations a minute.
    """
    inertia = 0.3 * 2240 * 15**2 / (32.2 * 12)
    chain = join_chain([0, inertia], [ChainShaft(0, 1, 12e6 * hollow(3) / 36)], clamped=[0])
    per_minute = find_chain_modes(chain).omega[0] * 60 / (2 * np.pi)
    assert round(per_minute) == 786
    assert per_minute == pytest.approx(785.9517306, rel=1e-9)

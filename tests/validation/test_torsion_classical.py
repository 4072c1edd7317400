"""Chains whose frequencies have a closed form, and textbook examples of a single one."""

import numpy as np
import pytest

from balcli.core.vibration import scale_shapes
from balcli.torsional_vibration.chain import ChainShaft, join_chain
from balcli.torsional_vibration.modes import find_chain_modes


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
    n = 8
    i = np.arange(8)[:, None]
    modes = find_chain_modes(join_chain([0.3] * n, [ChainShaft(m, m + 1, 5e4) for m in range(n - 1)]))
    assert modes.omega == pytest.approx(2 * np.sqrt(5e4 / 0.3) * np.sin(i[:, 0] * np.pi / (2 * n)), rel=1e-14)
    shapes = np.cos(i * np.pi * (2 * np.arange(1, n + 1) - 1) / (2 * n))
    assert scale_shapes(modes.shapes) == pytest.approx(scale_shapes(shapes), abs=1e-13)

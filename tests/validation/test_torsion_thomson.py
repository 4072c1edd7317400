"""Thomson, Theory of Vibration with Applications, Example 12.4-1, Table 12.4-1, p. 389: Holzer's
table of three discs at two trial frequencies.
"""

import pytest

from balcli.core.vibration import scale_shapes
from balcli.torsion.chain import ChainShaft, join_chain
from balcli.torsion.modes import find_chain_modes, tabulate_holzer

CHAIN = join_chain([5, 11, 22], [ChainShaft(0, 1, 1e5), ChainShaft(1, 2, 2e5)])


@pytest.mark.parametrize(
    ("trial", "angle", "last_place", "torque"),
    [
        (20.0, [1, 0.98, 0.9484], 1e-4, [2.000e3, 6.312e3, 14.66e3]),
        (40.0, [1, 0.92, 0.799], 1e-3, [8.00e3, 24.19e3, 52.32e3]),
    ],
)
def test_table_as_printed(trial, angle, last_place, torque):
    table = tabulate_holzer(CHAIN, trial)
    assert table.angle == pytest.approx(angle, abs=last_place / 2)
    assert table.total == pytest.approx(torque, abs=5)
    assert table.residual == table.total[-1]


def test_natural_frequencies():
    """Only in a figure of the book; recomputed: 123.666 and 202.658 rad/s."""
    modes = find_chain_modes(CHAIN)
    assert modes.omega == pytest.approx([0, 123.6658001, 202.6583486], rel=1e-9)
    shapes = scale_shapes(modes.shapes)
    assert shapes[1] == pytest.approx([1, 0.2353384945, -0.3449419745], rel=1e-9)
    assert shapes[2] / shapes[2, 0] == pytest.approx([1, -1.053520313, 0.2994874291], rel=1e-9)

"""Friswell, Penny, Garvey and Lees, Dynamics of Rotating Machines, chapter 9, as set in the tests of
openTorsion (Aalto-Arotor/openTorsion, opentorsion/tests/tests.py): natural frequencies in Hz as
printed, beside those recomputed to ten figures.
"""

import numpy as np
import pytest
from support.cases import cases

from balcli.torsion.chain import ChainShaft, join_chain
from balcli.torsion.modes import find_chain_modes

INF = np.inf


def shaft_stiffness(length, diameter, shear_modulus=68e9):
    return shear_modulus * np.pi * diameter**4 / 32 / length


CHAINS = {
    "TWO_DISCS": join_chain([211.4, 8.3], [ChainShaft(0, 1, 9.775e6)]),
    "THREE_CYLINDERS": join_chain(
        [0.0035, 0.0035, 0.0035, 0.15, 0.05],
        [ChainShaft(0, 1, 12e3), ChainShaft(1, 2, 12e3), ChainShaft(2, 3, 14e3), ChainShaft(3, 4, 10e3)],
    ),
    "PAIR_OF_GEARS": join_chain(
        [0.0004, 2.5e-5, 2.5e-5, 0.0007, 0.0007],
        [ChainShaft(0, 1, 10e3), ChainShaft(1, 2, INF, -1), ChainShaft(2, 3, 5e3), ChainShaft(1, 4, 5e3)],
    ),
    "BRANCHES": join_chain(
        [3200, 200, 200, 800, 800, 450, 450],
        [
            ChainShaft(0, 1, shaft_stiffness(2.5, 0.2)),
            ChainShaft(1, 2, INF, -1),
            ChainShaft(1, 3, INF, -0.5 / 0.8),
            ChainShaft(2, 4, INF, -0.5 / 0.8),
            ChainShaft(3, 5, shaft_stiffness(3.5, 0.25)),
            ChainShaft(4, 6, shaft_stiffness(3.5, 0.25)),
        ],
    ),
}


@cases("validation/torsion_friswell", "natural_frequencies", **CHAINS)
def test_natural_frequencies(chain, printed, places, recomputed):
    hertz = find_chain_modes(chain).omega / (2 * np.pi)
    assert hertz[0] == 0
    assert np.round(hertz, places).tolist() == printed
    assert hertz[1:] == pytest.approx(recomputed, rel=1e-9)

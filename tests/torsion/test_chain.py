"""How nodes hang together, and chains that cannot be."""

from __future__ import annotations

import numpy as np
import pytest

from balcli.torsion.chain import (
    ChainShaft,
    find_pieces,
    follow_gears,
    incidence,
    join_chain,
    rigid_motions,
)


def test_pieces_that_hang_together():
    chain = join_chain([1, 1, 1, 1], [ChainShaft(2, 0, 5, 4.0), ChainShaft(1, 3, 5)])
    pieces = find_pieces(chain)
    assert pieces.first.tolist() == [0, 1, 0, 1]
    assert pieces.pace.tolist() == [1, 1, 0.25, 1]
    assert not pieces.locked.any()
    assert find_pieces(chain, np.array([False, True])).first.tolist() == [0, 1, 2, 1]


def test_contradicting_ratios_of_a_loop_lock_its_piece():
    loop = [ChainShaft(0, 1, 5), ChainShaft(1, 2, 5), ChainShaft(0, 2, 5, 2.0)]
    chain = join_chain([1, 1, 1, 1], loop)
    assert find_pieces(chain).locked.tolist() == [True, True, True, False]
    assert rigid_motions(chain).tolist() == [[0, 0, 0, 1]]


def test_rigid_motions_turn_at_the_ratios_and_angles_follow_gears():
    shafts = [ChainShaft(0, 1, np.inf, -2), ChainShaft(1, 2, 7, 1.5)]
    chain = join_chain([1, 1, 1], shafts)
    assert rigid_motions(chain).tolist() == [[1, -2, -3]]
    assert incidence(chain) @ [1, -2, -3] == pytest.approx([0, 0])
    follow, independent = follow_gears(join_chain([1, 1, 1, 1], [*shafts, ChainShaft(2, 3, 7)], [3]))
    assert independent.tolist() == [0, 2]
    assert follow.tolist() == [[1, 0], [-2, 0], [0, 1], [0, 0]]

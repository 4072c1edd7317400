"""How nodes hang together; dampers as complex inertias, against the same dampers as nodes."""

import numpy as np
import pytest
from support.chains import no_damping

from balcli.torsional_vibration.chain import (
    ChainShaft,
    Damping,
    best_viscous_damping,
    find_pieces,
    follow_gears,
    incidence,
    join_chain,
    pendulum_inertia,
    pendulum_swing,
    rigid_motions,
    viscous_inertia,
)
from balcli.torsional_vibration.motion import respond_chain


def test_pieces_that_hang_together():
    chain = join_chain([1, 1, 1, 1], [ChainShaft(2, 0, 5, 4.0), ChainShaft(1, 3, 5)])
    pieces = find_pieces(chain)
    assert pieces.first.tolist() == [0, 1, 0, 1]
    assert pieces.pace.tolist() == [1, 1, 0.25, 1]
    assert find_pieces(chain, np.array([False, True])).first.tolist() == [0, 1, 2, 1]


def test_rigid_motions_turn_at_the_ratios_and_angles_follow_gears():
    shafts = [ChainShaft(0, 1, np.inf, -2), ChainShaft(1, 2, 7, 1.5)]
    chain = join_chain([1, 1, 1], shafts)
    assert rigid_motions(chain).tolist() == [[1, -2, -3]]
    assert incidence(chain) @ [1, -2, -3] == pytest.approx([0, 0])
    follow, independent = follow_gears(join_chain([1, 1, 1, 1], [*shafts, ChainShaft(2, 3, 7)], [3]))
    assert independent.tolist() == [0, 2]
    assert follow.tolist() == [[1, 0], [-2, 0], [0, 1], [0, 0]]


# ------------------------------------------------------------------ dampers
W = np.array([50.0, 300, 1000])
LOAD = np.array([1.0, -2j, 0.5])
CHAIN = join_chain([0.1, 0.2, 2], [ChainShaft(0, 1, 1e5), ChainShaft(1, 2, 2e5)])
DAMPING = Damping(np.full(2, 0.02), np.zeros(2), np.zeros(3))


def test_viscous_ring_is_a_node_on_a_dashpot():
    """The same chain with the damper as a fourth node on a shaft of its own."""
    attached = np.zeros((len(W), 3), complex)
    attached[:, 0] = viscous_inertia(0.05, 12.0, W)
    found = respond_chain(CHAIN, DAMPING, W, LOAD, attached)
    shafts = [ChainShaft(0, 1, 1e5), ChainShaft(1, 2, 2e5), ChainShaft(0, 3, 0)]
    damping = Damping(np.array([0.02, 0.02, 0]), np.array([0, 0, 12.0]), np.zeros(4))
    expected = respond_chain(join_chain([0.1, 0.2, 2, 0.05], shafts), damping, W, np.append(LOAD, 0))
    assert found.angle == pytest.approx(expected.angle[:, :3], rel=1e-12)
    assert found.torque == pytest.approx(expected.torque[:, :2], rel=1e-12)


def test_limits_of_dampers():
    """A ring that sticks is inertia, one that slips is none; between them it takes energy."""
    assert viscous_inertia(0.05, 1e12, W) == pytest.approx(np.full(3, 0.05))
    assert abs(viscous_inertia(0.05, 1e-12, W)) == pytest.approx(np.zeros(3), abs=1e-12)
    assert np.all(viscous_inertia(0.05, 12.0, W).imag < 0)
    assert pendulum_inertia(2.0, 0.1, 0.025, np.zeros(1)) == pytest.approx([2 * 0.125**2])


def test_a_pendulum_swings_as_its_equation_of_motion_says():
    """For a point mass at R + L on a disc that turns at 1 + small: L y'' + R y = -(R + L) x'', y
    the pendulum's angle against the disc.

    With y = (R + L) n^2 x/(R - L n^2), the disc feels m (R + L) ((R + L) x'' + L y'').
    """
    mass = 0.5
    radius = 0.08
    length = 0.02
    order = 1.5
    y = (radius + length) * order**2 / (radius - length * order**2)
    felt = mass * (radius + length) * (radius + length + length * y)
    assert pendulum_inertia(mass, radius, length, np.array(order)) == pytest.approx(felt)
    assert pendulum_swing(radius, length, np.array(order)) == pytest.approx(y)


@pytest.mark.parametrize("ratio", [0.1, 0.5, 1.0])
def test_the_best_viscous_damper_magnifies_by_1_plus_2_over_its_ratio(ratio):
    """Den Hartog, Houdaille damper: the highest peak at w^2 = 2/(2 + ratio), and with any other
    damping it is higher.
    """
    chain = join_chain([1.0, 1.0], [ChainShaft(0, 1, 1.0)], clamped=[0])
    w = np.append(np.linspace(0.05, 2, 4000), np.sqrt(2 / (2 + ratio)))

    def peak(damping):
        attached = np.zeros((len(w), 2), complex)
        attached[:, 1] = viscous_inertia(ratio, damping, w)
        return abs(respond_chain(chain, no_damping(chain), w, np.array([0, 1]), attached).angle[:, 1])

    best = best_viscous_damping(ratio, ratio, 1.0)
    assert peak(best).max() == pytest.approx(1 + 2 / ratio, rel=1e-9)
    assert peak(best)[-1] == pytest.approx(1 + 2 / ratio, rel=1e-12)
    assert peak(1.1 * best).max() > 1.001 * (1 + 2 / ratio)
    assert peak(best / 1.1).max() > 1.001 * (1 + 2 / ratio)

"""Natural modes of torsional chains against 50 digits and the laws that hold for every chain."""

import numpy as np
import pytest
from support.chains import KINDS, chain_matrices, chain_of, exact_frequencies, random_chain, random_damping

import balcli
from balcli.core.vibration import modal_loss, scale_shapes
from balcli.torsional_vibration.chain import ChainShaft, Damping, follow_gears, incidence, join_chain, rigid_motions
from balcli.torsional_vibration.modes import chain_loss, find_chain_modes, locate_nodes
from balcli.torsional_vibration.poles import find_chain_poles

MODES = 1e-13  # relative error of every frequency; the contract says 1e-12
OF_LARGEST = 1e-15  # error of a low frequency in parts of the highest


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("spread", [1, 5])
def test_frequencies_against_50_digits(kind, seed, spread):
    chain = random_chain(kind, seed, spread)
    found = find_chain_modes(chain)
    exact = exact_frequencies(chain)
    noise = OF_LARGEST * exact.max()
    assert found.omega[found.rigid :] == pytest.approx(exact[found.rigid :], rel=MODES, abs=noise)
    assert found.omega[: found.rigid].tolist() == [0] * (0 if "clamped" in kind else 1)


def test_frequencies_that_spread_over_5e5():
    """Light inertias on stiff shafts and heavy ones on soft shafts, in one chain with a branch."""
    shafts = [ChainShaft(0, 1, 1e9), ChainShaft(1, 2, 1e2), ChainShaft(2, 3, 1e7, 4.0), ChainShaft(1, 4, 3e3)]
    chain = join_chain([1e-4, 3e-3, 70, 2000, 5e2], shafts)
    found = find_chain_modes(chain).omega
    exact = exact_frequencies(chain)
    assert exact[-1] > 5e5 * exact[1]
    assert found[1:] == pytest.approx(exact[1:], rel=1e-14, abs=OF_LARGEST * exact[-1])


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(4))
def test_modes_are_orthogonal_and_keep_momentum(kind, seed):
    chain = random_chain(kind, seed)
    modes = find_chain_modes(chain)
    weighted = modes.shapes * chain.inertia
    assert weighted @ modes.shapes.T == pytest.approx(np.eye(len(modes.omega)), abs=1e-12)
    twist = incidence(chain) @ modes.shapes.T
    assert twist[:, : modes.rigid] == pytest.approx(np.zeros((len(twist), modes.rigid)), abs=1e-13)
    for motion in rigid_motions(chain):
        momenta = weighted[modes.rigid :] * motion
        share = np.abs(momenta.sum(axis=1)) / np.abs(momenta).sum(axis=1)
        assert np.all(share < 1e-12)


@pytest.mark.parametrize("ratio", [1, -1, 0.4, -2.5])
def test_rigid_gears_are_one_inertia(ratio):
    """A wheel on another is an inertia ratio^2 times its own."""
    geared = join_chain(
        [0.2, 0.1, 0.3, 0.5], [ChainShaft(0, 1, 1e5), ChainShaft(1, 2, np.inf, ratio), ChainShaft(2, 3, 2e5)]
    )
    single = chain_of([0.2, 0.1 + 0.3 * ratio**2, 0.5 * ratio**2], [1e5, 2e5 * ratio**2])
    found = find_chain_modes(geared)
    expected = find_chain_modes(single)
    assert found.omega == pytest.approx(expected.omega, rel=1e-14)
    shapes = expected.shapes[:, [0, 1, 1, 2]] * [1, 1, ratio, ratio]
    assert np.abs(found.shapes) == pytest.approx(np.abs(shapes), abs=1e-12)


def test_a_clamp_holds_all_that_meshes_with_it():
    chain = join_chain([1, 2, 3], [ChainShaft(0, 1, np.inf, 2), ChainShaft(1, 2, 12)], clamped=[0])
    assert find_chain_modes(chain).omega == pytest.approx([2])
    assert find_chain_modes(chain).shapes[0].tolist()[:2] == [0, 0]
    assert find_chain_modes(chain_of([1, 2], [5], clamped=[0, 1])).omega.size == 0


def test_a_massless_node_moves_with_its_shafts():
    """Of two shafts in line the twist divides as their flexibilities; a dangling one does not count."""
    chain = join_chain([2, 0, 3, 0], [ChainShaft(0, 1, 30), ChainShaft(1, 2, 60), ChainShaft(2, 3, 5)])
    modes = find_chain_modes(chain)
    assert modes.omega == pytest.approx([0, np.sqrt(20 * (1 / 2 + 1 / 3))])
    left, middle, right, end = modes.shapes[1]
    assert middle == pytest.approx((left + 2 * right) / 3)
    assert end == pytest.approx(right)


def test_shafts_without_stiffness_join_nothing():
    """A ring that a fluid drags along turns freely: two rigid modes."""
    chain = chain_of([1, 2, 3], [8, 0])
    modes = find_chain_modes(chain)
    assert modes.rigid == 2
    assert modes.omega == pytest.approx([0, 0, np.sqrt(12)])


def count_nodes(chain):
    modes = find_chain_modes(chain)
    located = [locate_nodes(chain, shape, omega) for shape, omega in zip(modes.shapes, modes.omega, strict=True)]
    return [sum(map(len, nodes)) for nodes in located]


@pytest.mark.parametrize("seed", range(4))
def test_the_rth_mode_of_a_chain_has_r_nodes(seed):
    chain = random_chain("plain", seed, 0.5)
    assert count_nodes(chain) == list(range(len(chain.inertia)))


@pytest.mark.parametrize("throws", [5, 8, 20])
@pytest.mark.parametrize("stiffness", [742.0, 0.742])
def test_angles_behind_soft_shafts_keep_their_signs(throws, stiffness):
    """The angles of the highest modes fall to 1e-12 of the largest, or far below its rounding error."""
    chain = chain_of([0.006, *[0.017] * throws, 0.15], [2.5e5, *[stiffness] * (throws - 1), 8e5])
    assert count_nodes(chain) == list(range(throws + 2))


def test_a_branch_on_a_node_at_rest_is_at_rest():
    """Two equal discs swing against each other about a hub; shafts behind the hub have no node."""
    shafts = [ChainShaft(0, 1, 1e4), ChainShaft(0, 2, 1e4), ChainShaft(0, 3, 5e3), ChainShaft(3, 4, 2e3)]
    chain = join_chain([1.0, 0.1, 0.1, 3.0, 2.0], shafts)
    modes = find_chain_modes(chain)
    [swinging] = np.flatnonzero(np.isclose(modes.omega, np.sqrt(1e4 / 0.1)))
    in_shafts, at_nodes = locate_nodes(chain, modes.shapes[swinging], modes.omega[swinging])
    assert (in_shafts.tolist(), at_nodes.tolist()) == ([], [0])


def test_a_node_at_rest_hides_no_node_of_vibration_and_gears_that_reverse_are_none():
    assert count_nodes(chain_of([1, 2, 1], [5, 5])) == [0, 1, 2]
    reversing = join_chain([1, 2], [ChainShaft(0, 1, 5, -1.5)])
    assert scale_shapes(find_chain_modes(reversing).shapes)[0] == pytest.approx([-1 / 1.5, 1])
    assert count_nodes(reversing) == [0, 1]


@pytest.mark.parametrize("kind", KINDS)
def test_loss_of_modes(kind):
    """From the matrices; of a damper, from its complex inertia."""
    chain = random_chain(kind, 6)
    damping = random_damping(chain, 6)
    modes = find_chain_modes(chain)
    matrices = chain_matrices(chain, damping)
    _, independent = follow_gears(chain)
    expected = modal_loss(modes._replace(shapes=modes.shapes[:, independent]), matrices.stiffness, matrices.damping)
    assert chain_loss(chain, damping, modes) == pytest.approx(expected, rel=1e-10)
    assert np.all(expected[modes.rigid :] > 0)
    ring = np.zeros(len(chain.inertia), complex)
    ring[0] = 0.3 - 0.2j
    added = chain_loss(chain, damping, modes, ring) - chain_loss(chain, damping, modes)
    assert added[modes.rigid :] == pytest.approx(0.2 * modes.shapes[modes.rigid :, 0] ** 2)


def test_poles_of_two_inertias_and_a_massless_node():
    """Loss, dashpot and massless node, by hand: `s^2 + (k (1 + i loss) + s c)(1/J1 + 1/J2) = 0`,
    springs of 2 k in series; a loss factor is meant for `Im s > 0` alone.
    """
    chain = join_chain([2.0, 0.0, 3.0], [ChainShaft(0, 1, 2e5), ChainShaft(1, 2, 2e5), ChainShaft(0, 2, 0.0)])
    loss = np.array([0.02, 0.02, 0.0])
    oil = np.array([0.0, 0.0, 5.0])
    poles = find_chain_poles(chain, Damping(loss, oil, np.zeros(3)))
    per_inertia = 1 / 2 + 1 / 3
    exact = np.roots([1, 5 * per_inertia, 1e5 * (1 + 0.02j) * per_inertia])
    elastic = poles[np.abs(poles) > 1]
    assert np.sort_complex(elastic) == pytest.approx(np.sort_complex(exact), rel=1e-10)
    assert len(poles) == 4, "two more, of the rigid motion"


def test_work_is_that_of_harmonic_torques_on_a_harmonic_motion_of_the_worst_phase():
    """Torques Re(T e^{i wt}) on angles Re(B shape e^{i wt}), |B| = 1: integrated over a cycle in
    time, for the phase of B at which they do most.
    """
    found = balcli.torsion(balcli.load_example("i6_diesel"))
    system = found.system
    modes = {mode.number: mode for mode in found.modes}
    turn = np.exp(2j * np.pi * np.arange(64) / 64)
    for critical in found.criticals[:12]:
        mode = modes[critical.mode]
        k = list(system.excitation.orders).index(critical.order)
        torques = system.excitation.at(np.full(len(system.excitation.orders), mode.omega / critical.order))[k, k]
        shape = mode.shape[system.excitation.nodes]
        rates = np.multiply.outer(np.exp(1j * np.linspace(0, 2 * np.pi, 721)), 1j * turn).real
        power = (torques[:, None] * turn).real * shape[:, None]
        assert critical.work == pytest.approx((rates @ power.sum(axis=0)).max() * 2 * np.pi / 64, rel=1e-4)

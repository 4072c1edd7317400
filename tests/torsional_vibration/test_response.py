"""Forced vibration of torsional chains against 50 digits and the laws that hold for every chain."""

import numpy as np
import pytest
from support.chains import KINDS, balance_power, chain_of, exact_response, no_damping, random_chain, random_damping

from balcli.core.vibration import UndampedResonanceError, find_resonances
from balcli.torsional_vibration.chain import ChainShaft, Damping, join_chain
from balcli.torsional_vibration.modes import chain_loss, find_chain_modes
from balcli.torsional_vibration.motion import respond_chain

RESPONSE = 1e-11  # relative error of every angle, and of torques against the largest; contract: 1e-10


def compared(chain, damping, w, load, attached=0.0):
    """Asserts that every angle and torque agrees with 50 digits."""
    twist = respond_chain(chain, damping, w, load, attached)
    for at in np.ndindex(w.shape):
        here = np.broadcast_to(attached, (*w.shape, len(chain.inertia)))[at]
        angle, torque = exact_response(chain, damping, w[at], load[at], here)
        assert twist.angle[at] == pytest.approx(angle, rel=RESPONSE, abs=0)
        assert twist.torque[at] == pytest.approx(torque, rel=RESPONSE, abs=RESPONSE * biggest(torque))
    return twist


def biggest(values):
    return float(np.abs(values).max())


def random_load(chain, seed, *shape):
    rng = np.random.default_rng(seed)
    parts = rng.normal(size=(2, *shape, len(chain.inertia)))
    return 1000 * (parts[0] + 1j * parts[1])


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(3))
def test_response_against_50_digits(kind, seed):
    chain = random_chain(kind, seed)
    damping = random_damping(chain, seed)
    w = np.multiply.outer([0.5, 3, 9], [60.0, 250])
    compared(chain, damping, w, random_load(chain, seed, 3, 2))


def test_response_with_complex_inertias():
    chain = random_chain("branched", 5)
    w = np.multiply.outer([0.5, 3], [60.0, 250])
    attached = np.random.default_rng(3).uniform(0, 0.3, (2, 2, len(chain.inertia))) * (1 - 0.4j)
    compared(chain, random_damping(chain, 1), w, random_load(chain, 1, 2, 2), attached)


@pytest.mark.parametrize("kind", ["plain", "branched", "clamped", "looped"])
def test_response_without_damping(kind):
    chain = random_chain(kind, 2)
    compared(chain, no_damping(chain), np.array([40.0, 900, 4321]), random_load(chain, 4, 3))


@pytest.mark.parametrize("off", [0, 1e-14, 1e-9, 1e-4, 1e-2])
def test_near_the_resonance_of_a_branch_by_itself(off):
    """The end of a chain as an absorber: 0.5 on 2e4 is tuned to 200 rad/s."""
    chain = chain_of([2, 1, 0.5], [1e5, 2e4])
    w = np.array([200 * (1 + off)])
    twist = compared(chain, no_damping(chain), w, np.array([[3.0, 1, 2]]))
    if off == 0:
        assert twist.angle[0, 1] == pytest.approx(-2 / 2e4)


def test_stiff_shafts_twist_as_exactly_as_soft_ones():
    """1e18 N m/rad: the angles agree to the last figure, the torque between them is as exact."""
    chain = chain_of([0.3, 0.7, 2], [1e18, 1e18])
    compared(chain, no_damping(chain), np.array([25.0]), random_load(chain, 2, 1))


def test_rigid_shafts_share_the_load_as_their_inertias():
    """The limit of stiff shafts: chapter A's speed fluctuation, x = -sum t/(w^2 sum J)."""
    chain = chain_of([0.3, 0.7, 2], [np.inf, np.inf])
    load = np.array([10.0, -4, 1])
    twist = respond_chain(chain, no_damping(chain), 25.0, load)
    acceleration = load.sum() / chain.inertia.sum()
    assert twist.angle == pytest.approx(np.full(3, -acceleration / 25.0**2), rel=1e-14)
    carried = np.cumsum(load - chain.inertia * acceleration)[:2]
    assert twist.torque == pytest.approx(carried, rel=1e-13)


def test_one_speed_is_a_thousand():
    chain = random_chain("plain", 1)
    damping = random_damping(chain, 1)
    orders = np.arange(1, 25) / 2
    speeds = np.linspace(50, 300, 40)
    load = random_load(chain, 1, 24, 1)
    nodes = len(chain.inertia)
    many = respond_chain(chain, damping, np.multiply.outer(orders, speeds), load)
    assert (many.angle.shape, many.torque.shape) == ((24, 40, nodes), (24, 40, nodes - 1))
    one = respond_chain(chain, damping, orders[4] * speeds[7], load[4, 0])
    assert one.angle == pytest.approx(many.angle[4, 7], rel=1e-14)
    assert one.torque == pytest.approx(many.torque[4, 7], rel=1e-14)


@pytest.mark.parametrize("kind", KINDS)
def test_power_fed_is_power_lost_and_torques_are_reciprocal(kind):
    """What a torque at one node does at another is what it does the other way round."""
    chain = random_chain(kind, 7)
    damping = random_damping(chain, 7)
    w = np.multiply.outer([1, 4], [80.0, 170])
    load = random_load(chain, 7, 2, 2)
    attached = np.zeros(len(chain.inertia), complex)
    attached[-1] = 0.2 - 0.1j
    angle = respond_chain(chain, damping, w, load, attached).angle
    power = balance_power(chain, damping, w, load, angle, attached)
    assert np.all(power.shafts >= 0)
    assert np.all(power.nodes >= 0)
    assert power.fed == pytest.approx(power.shafts.sum(-1) + power.nodes.sum(-1), rel=1e-10)
    assert np.all(power.fed > 0)
    nodes = len(attached)
    moved = respond_chain(chain, damping, np.full(nodes, 333.0), np.eye(nodes)).angle
    assert moved == pytest.approx(moved.T, rel=1e-10, abs=1e-13 * biggest(moved))


MESHED = [ChainShaft(0, 1, np.inf, -3), ChainShaft(1, 2, 9)]
THREE = chain_of([1, 2, 1], [5, 5])  # symmetric: omega^2 = 5 and 10


@pytest.mark.parametrize(
    ("chain", "w", "load", "angle", "torque"),
    [
        # a motor 1 drives 4 through 1:-2, rigidly: the mesh passes on what the wheel needs
        (join_chain([1, 4], [ChainShaft(0, 1, np.inf, -2.0)]), 1.0, [17.0, 0], [-1, 2], [-8]),
        # a mean torque with its load twists a free chain
        (chain_of([1, 2, 3], [10, 20]), 0.0, [5, 2, -7], None, [5, 7]),
        # a mode that is not driven may be met: at the middle, the mode with a node there
        (THREE, 5**0.5, [0, 1, 0], [-0.1, 0, -0.1], [-0.5, 0.5]),
        # nodes held at both ends of a shaft
        (chain_of([1, 1, 1], [4, 9], clamped=[0, 1]), 1.0, [1, 1, 16.0], [0, 0, 2], [0, -18]),
        # a mesh with a clamped gear holds, and carries what the other passes on
        (join_chain([1, 1, 1], MESHED, [0]), 1.0, [3, 1, 16.0], [0, 0, 2], [-19, -18]),
        (join_chain([1, 1, 1], MESHED, [1]), 1.0, [3, 1, 16.0], [0, 0, 2], [-1, -18]),
        # pieces vibrate by themselves
        (join_chain([1, 2, 4], [ChainShaft(0, 2, 5)]), 2.0, [0, 8.0, 0], [0, -1, 0], [0]),
    ],
)
def test_chains_by_hand(chain, w, load, angle, torque):
    twist = respond_chain(chain, no_damping(chain), w, np.array(load))
    assert twist.torque == pytest.approx(torque, abs=1e-12)
    assert angle is None or twist.angle == pytest.approx(angle, abs=1e-12)


def test_a_mean_torque_without_its_load_has_no_steady_motion():
    chain = chain_of([1, 2], [10])
    with pytest.raises(UndampedResonanceError, match="at 0 rad/s"):
        respond_chain(chain, no_damping(chain), 0.0, np.array([5, 2]))


def test_undamped_resonances_are_refused_and_found_between_the_speeds():
    modes = find_chain_modes(THREE)
    load = np.array([0, 1, 3])
    with pytest.raises(UndampedResonanceError) as at:
        respond_chain(THREE, no_damping(THREE), modes.omega[1:], load)
    assert at.value.frequency == pytest.approx(5**0.5)
    loss = chain_loss(THREE, no_damping(THREE), modes)
    found = find_resonances(modes, loss, np.array([1.0]), np.array([2.0, 4]), load)
    assert [(r.mode, r.speed) for r in found] == [(1, pytest.approx(5**0.5)), (2, pytest.approx(10**0.5))]


def test_meshes_with_a_clamped_gear_agree_with_50_digits():
    shafts = [ChainShaft(2, 0, 5.0), ChainShaft(0, 1, np.inf, -3), ChainShaft(1, 3, np.inf, 0.5)]
    chain = join_chain([1, 2, 3, 4], shafts, clamped=[1])
    load = np.array([1, 2 + 1j, 3, 4j])
    twist = respond_chain(chain, no_damping(chain), [0.5, 2.0], load)
    for k, w in enumerate([0.5, 2.0]):
        angle, torque = exact_response(chain, no_damping(chain), w, load)
        assert twist.angle[k] == pytest.approx(angle, abs=1e-13)
        assert twist.torque[k] == pytest.approx(torque, abs=1e-13)
    assert not twist.angle[:, [0, 1, 3]].any()


def test_a_dashpot_alone_at_rest():
    chain = chain_of([1, 1], [0])
    damping = Damping(np.zeros(1), np.ones(1), np.zeros(2))
    said = "^a shaft that is only a dashpot carries no torque at a frequency of 0$"
    with pytest.raises(ValueError, match=said):
        respond_chain(chain, damping, np.array([0.0, 1]), np.ones(2))
    assert respond_chain(chain, damping, 1.0, np.array([1, -1])).torque[0] != 0

"""A rigid body on mounts: geometry, statics, modes and response against laws and 50 digits."""

import re

import numpy as np
import pytest
from support import high_precision
from support.rigid_bodies import apply_couplings, respond_body

from balcli.core.vibration import frequencies
from balcli.mounts.rigid_body import (
    Body,
    Mounts,
    carry_points,
    complete_axes,
    damping_matrix,
    describe_free_motion,
    elastic_centre,
    find_body_modes,
    find_free_motions,
    load_at_centre,
    mass_matrix,
    roll_axis,
    settle_body,
    share_energy,
    stiffness_matrix,
    turn_axes,
)

CENTRE = np.array([0.01, -0.02, 0.3])
BODY = Body(150.0, CENTRE, np.array([[9.0, -0.8, 0.5], [-0.8, 4.0, 1.2], [0.5, 1.2, 8.0]]))


def mounts_of(count, seed=1, loss=0.0, damping=0.0):
    rng = np.random.default_rng(seed)
    axes = [turn_axes(*rng.uniform(-1, 1, 3)) for _ in range(count)]
    return Mounts(
        rng.uniform(-0.5, 0.5, (count, 3)),
        np.array(axes),
        rng.uniform(1e5, 5e5, (count, 3)),
        np.full((count, 3), loss),
        np.full((count, 3), damping),
    )


def random_load(seed, *shape):
    rng = np.random.default_rng(seed)
    return rng.normal(size=(*shape, 6)) + 1j * rng.normal(size=(*shape, 6))


# ------------------------------------------------------------------ geometry
def test_axes_from_two_or_from_angles():
    given = complete_axes([0, 2, 0], [-3, 0, 0])
    assert given == pytest.approx(np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]]))
    assert turn_axes(0, 0, np.pi / 2) == pytest.approx(given)
    assert turn_axes(np.pi / 2, 0, 0) @ [0, 1, 0] == pytest.approx([0, 0, 1])
    assert turn_axes(0, np.pi / 2, 0) @ [0, 0, 1] == pytest.approx([1, 0, 0])
    one_by_one = turn_axes(0, 0, 0.3) @ turn_axes(0, 0.2, 0) @ turn_axes(0.1, 0, 0)
    assert turn_axes(0.1, 0.2, 0.3) == pytest.approx(one_by_one)


def test_points_move_with_the_body_and_their_forces_are_its_load():
    motion, point = np.array([1, 2, 3, 0.1, 0.2, 0.3]), CENTRE + np.eye(3)[0]
    assert apply_couplings(carry_points([point], CENTRE), motion)[0] == pytest.approx([1, 2 + 0.3, 3 - 0.2])
    points, forces = np.random.default_rng(2).normal(size=(2, 3, 3))
    load = np.einsum("pij,pi->j", carry_points(points, CENTRE), forces)
    moments = np.cross(points - CENTRE, forces)
    assert load == pytest.approx(np.concatenate([forces.sum(0), moments.sum(0)]))
    moved = load_at_centre(np.array([[0, 0, 2.0]]), np.array([[1.0, 0, 0]]), [0, 3, 0], [0, 0, 0])
    assert moved == pytest.approx(np.array([[0, 0, 2, 1 + 6, 0, 0]]))


# ------------------------------------------------------------------ free motions
@pytest.mark.parametrize(("count", "free"), [(3, 0), (2, 1), (1, 3)])
def test_motions_that_no_mount_holds(count, free):
    mounts = mounts_of(count)
    motions = find_free_motions(BODY, mounts)
    assert motions.shape == (free, 6)
    for motion in motions:
        moved = apply_couplings(carry_points(mounts.at, CENTRE), motion)
        assert moved == pytest.approx(np.zeros((count, 3)), abs=1e-12)
    assert len(find_free_motions(BODY, mounts._replace(stiffness=np.zeros((count, 3))))) == 6


def test_the_axis_of_a_motion_is_named():
    """Two mounts leave a turn about the line between them; where nothing turns, the way is named."""
    mounts = mounts_of(2)
    told = describe_free_motion(find_free_motions(BODY, mounts)[0])
    direction = np.array(re.findall(r"-?[\d.]+", told), float)
    assert np.cross(direction, mounts.at[1] - mounts.at[0]) == pytest.approx(np.zeros(3), abs=1)
    assert describe_free_motion(np.array([0, -2, 5, 0, 0, 1.0])) == "turning about z"
    assert describe_free_motion(np.array([0, -2, 0, 0, 0, 0.0])) == "moving along y"


# ------------------------------------------------------------------ modes
@pytest.mark.parametrize("count", [3, 4, 6])
def test_modes_against_50_digits(count):
    mounts = mounts_of(count, count)
    modes = find_body_modes(BODY, mounts)
    values, turned = np.linalg.eigh(BODY.inertia)
    assert BODY.inertia @ turned == pytest.approx(turned * values)
    travel = np.swapaxes(mounts.axes, 1, 2) @ carry_points(mounts.at, CENTRE)
    travel[..., 3:] = travel[..., 3:] @ turned
    exact = high_precision.angular_frequencies(
        travel.reshape(-1, 6), mounts.stiffness.ravel(), np.append([BODY.mass] * 3, values)
    )
    assert modes.omega == pytest.approx(exact, rel=1e-13)
    mass = mass_matrix(BODY)
    assert modes.shapes @ mass @ modes.shapes.T == pytest.approx(np.eye(6), abs=1e-12)
    assert share_energy(modes, BODY).sum(axis=1) == pytest.approx(np.ones(6))
    plain = BODY._replace(inertia=np.diag([9.0, 4, 8]))
    shares = share_energy(find_body_modes(plain, mounts), plain)
    assert shares.sum(axis=0) == pytest.approx(np.ones(6))
    assert np.all(shares >= 0)


def test_stiffness_is_energy():
    mounts, motion = mounts_of(3), random_load(1)[:6].real
    stretch = np.einsum("mji,mj->mi", mounts.axes, apply_couplings(carry_points(mounts.at, CENTRE), motion))
    energy = np.sum(mounts.stiffness * stretch**2) / 2
    assert motion @ stiffness_matrix(BODY, mounts).real @ motion / 2 == pytest.approx(energy)


def test_roll_axis():
    """A torque about the crankshaft turns a free body about it; in principal axes about itself."""
    axis = roll_axis(BODY)
    assert BODY.inertia @ axis == pytest.approx([0, 0, (BODY.inertia @ axis)[2]], abs=1e-14)
    assert np.linalg.norm(axis) == pytest.approx(1)
    plain = BODY._replace(inertia=np.diag([9.0, 4, 8]))
    assert roll_axis(plain, [0, 1, 0]).tolist() == [0, 1, 0]


# ------------------------------------------------------------------ elastic centre
def test_elastic_centre():
    """That of four equal mounts is their middle; about any other point of a body moments are larger."""
    at = CENTRE + np.array([[1, 2, -0.5], [1, -2, -0.5], [-1, 2, -0.5], [-1, -2, -0.5]])
    axes, k = np.tile(np.eye(3), (4, 1, 1)), np.tile([1e5, 2e5, 3e5], (4, 1))
    stiffness = stiffness_matrix(BODY, Mounts(at, axes, k, 0 * k, 0 * k)).real
    assert elastic_centre(stiffness, CENTRE) == pytest.approx(CENTRE - [0, 0, 0.5])
    stiffness = stiffness_matrix(BODY, mounts_of(3)).real
    centre = elastic_centre(stiffness, CENTRE)

    def moments(point):
        """About a point, of the forces of three displacements that take a unit force each."""
        shift = np.linalg.inv(stiffness[:3, :3])
        about_centre = (stiffness[3:, :3] @ shift).T
        return about_centre - np.cross(point - CENTRE, np.eye(3))

    least = np.sum(moments(centre) ** 2)
    for off in np.vstack([np.eye(3), -np.eye(3)]) * 1e-4:
        assert np.sum(moments(centre + off) ** 2) > least


# ------------------------------------------------------------------ statics
def test_statics_balance():
    """Forces on the mounts carry the load, and no more."""
    mounts, load = mounts_of(3), np.array([10.0, -1471, 5, 20, 30, -250])
    forces, travel = settle_body(BODY, mounts, load)
    moments = np.cross(mounts.at - CENTRE, forces)
    carried = np.concatenate([forces.sum(axis=0), moments.sum(axis=0)])
    assert carried == pytest.approx(load)
    own = np.einsum("mji,mj->mi", mounts.axes, travel) * mounts.stiffness
    assert np.einsum("mij,mj->mi", mounts.axes, own) == pytest.approx(forces)
    assert respond_body(BODY, mounts, 0.0, load).forces == pytest.approx(forces), "a slow load is a static one"


# ------------------------------------------------------------------ response
def test_response_against_50_digits():
    mounts = mounts_of(3, loss=0.1, damping=40.0)
    w = frequencies([0.5, 1, 6], [80.0, 300])
    load = random_load(4, 3, 2)
    response = respond_body(BODY, mounts, w, load)
    for at in np.ndindex(3, 2):
        k, c = stiffness_matrix(BODY, mounts), damping_matrix(BODY, mounts)
        dynamic = k + 1j * w[at] * c - w[at] ** 2 * mass_matrix(BODY)
        exact = high_precision.solve(high_precision.to_matrix(dynamic), high_precision.to_matrix(load[at][:, None]))
        assert response.motion[at] == pytest.approx(exact, rel=1e-11)


@pytest.mark.parametrize(("loss", "damping"), [(0.1, 0.0), (0.0, 50.0), (0.05, 20.0)])
def test_forces_balance_and_power_too(loss, damping):
    """Load = inertia + what the mounts carry; what the load feeds is what the mounts lose."""
    mounts = mounts_of(4, 2, loss, damping)
    w, load = np.array([30.0, 100, 400]), random_load(5, 3)
    motion, forces = respond_body(BODY, mounts, w, load)
    moments = np.cross(mounts.at - CENTRE, forces)
    carried = np.concatenate([forces.sum(axis=1), moments.sum(axis=1)], axis=-1)
    inertia = -(w[:, None] ** 2) * (motion @ mass_matrix(BODY))
    assert carried + inertia == pytest.approx(load, abs=1e-11 * np.abs(inertia).max())
    fed = w / 2 * np.sum(load * motion.conj(), axis=-1).imag
    travel = apply_couplings(carry_points(mounts.at, CENTRE), motion)
    lost = w / 2 * np.sum(forces * travel.conj(), axis=(1, 2)).imag
    assert fed == pytest.approx(lost, rel=1e-9)
    assert np.all(lost > 0)

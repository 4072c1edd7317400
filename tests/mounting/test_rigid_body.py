"""A rigid body on mounts: statics and modes against laws and 50 digits; `test_response` has the rest."""

import re

import numpy as np
import pytest
from support import high_precision

from balcli.mounting.rigid_body import (
    Body,
    Mounts,
    carry_points,
    describe_free_motion,
    elastic_centre,
    find_body_modes,
    find_free_motions,
    load_at_centre,
    mass_matrix,
    settle_body,
    stiffness_matrix,
    turn_axes,
)

CENTRE = np.array([0.01, -0.02, 0.3])
BODY = Body(150.0, CENTRE, np.array([[9.0, -0.8, 0.5], [-0.8, 4.0, 1.2], [0.5, 1.2, 8.0]]))


def mounts_of(count, seed=1):
    rng = np.random.default_rng(seed)
    axes = [turn_axes(*rng.uniform(-1, 1, 3)) for _ in range(count)]
    return Mounts(
        rng.uniform(-0.5, 0.5, (count, 3)),
        np.array(axes),
        rng.uniform(1e5, 5e5, (count, 3)),
        np.zeros((count, 3)),
        np.zeros((count, 3)),
    )


def test_a_load_is_that_about_the_centre_of_gravity():
    moved = load_at_centre(np.array([[0, 0, 2.0]]), np.array([[1.0, 0, 0]]), [0, 3, 0], [0, 0, 0])
    assert moved == pytest.approx(np.array([[0, 0, 2, 1 + 6, 0, 0]]))


@pytest.mark.parametrize(("count", "free"), [(3, 0), (2, 1), (1, 3)])
def test_motions_that_no_mount_holds(count, free):
    mounts = mounts_of(count)
    motions = find_free_motions(BODY, mounts)
    assert motions.shape == (free, 6)
    for motion in motions:
        assert carry_points(mounts.at, CENTRE) @ motion == pytest.approx(np.zeros((count, 3)), abs=1e-12)
    assert len(find_free_motions(BODY, mounts._replace(stiffness=np.zeros((count, 3))))) == 6


def test_the_axis_of_a_motion_is_named():
    """Two mounts leave a turn about the line between them."""
    mounts = mounts_of(2)
    told = describe_free_motion(find_free_motions(BODY, mounts)[0])
    direction = np.array(re.findall(r"-?[\d.]+", told), float)
    assert np.cross(direction, mounts.at[1] - mounts.at[0]) == pytest.approx(np.zeros(3), abs=1)


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
    assert modes.shapes @ mass_matrix(BODY) @ modes.shapes.T == pytest.approx(np.eye(6), abs=1e-12)


def test_elastic_centre():
    """About any other point of a body moments are larger."""
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


def test_statics_balance():
    """Forces on the mounts carry the load, and no more."""
    mounts = mounts_of(3)
    load = np.array([10.0, -1471, 5, 20, 30, -250])
    forces, travel = settle_body(BODY, mounts, load)
    moments = np.cross(mounts.at - CENTRE, forces)
    carried = np.concatenate([forces.sum(axis=0), moments.sum(axis=0)])
    assert carried == pytest.approx(load)
    own = np.einsum("mji,mj->mi", mounts.axes, travel) * mounts.stiffness
    assert np.einsum("mij,mj->mi", mounts.axes, own) == pytest.approx(forces)

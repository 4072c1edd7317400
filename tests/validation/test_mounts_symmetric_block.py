"""A block on four equal mounts in a plane below its centre of gravity: upright motion and turning
about the upright axis are alone, the rest are two pairs (Den Hartog, Mechanical Vibrations; Harris
and Crede, Shock and Vibration Handbook).
"""

import numpy as np
import pytest

from balcli.mounting.rigid_body import Body, Mounts, elastic_centre, find_body_modes, stiffness_matrix

MASS = 200.0
INERTIA = np.array([8.0, 12.0, 14.0])
STIFFNESS = np.array([2e5, 1.5e5, 4e5])
X = 0.4
Y = 0.3
DROP = 0.2
AT = np.array([[X, Y, -DROP], [X, -Y, -DROP], [-X, Y, -DROP], [-X, -Y, -DROP]])
BODY = Body(MASS, np.zeros(3), np.diag(INERTIA))
EACH = np.ones((4, 3))
MOUNTS = Mounts(AT, np.tile(np.eye(3), (4, 1, 1)), STIFFNESS * EACH, 0 * EACH, 0 * EACH)


def pair(sideways, turning, inertia):
    """Squares of both frequencies of a displacement coupled with a turn by the drop of the mounts:
    stiffnesses `sideways` and `turning` about the mounts' plane.
    """
    a = sideways / MASS
    b = (turning + sideways * DROP**2) / inertia
    coupling = (sideways * DROP) ** 2 / (MASS * inertia)
    root = np.sqrt((a - b) ** 2 / 4 + coupling)
    return [(a + b) / 2 - root, (a + b) / 2 + root]


def test_six_frequencies_in_closed_form():
    kx, ky, kz = 4 * STIFFNESS
    squares = [kz / MASS, (kx * Y**2 + ky * X**2) / INERTIA[2]]
    squares += pair(kx, kz * X**2, INERTIA[1]) + pair(ky, kz * Y**2, INERTIA[0])
    assert find_body_modes(BODY, MOUNTS).omega == pytest.approx(np.sqrt(np.sort(squares)), rel=1e-14)


def test_elastic_centre_lies_in_the_plane_of_the_mounts():
    centre = elastic_centre(stiffness_matrix(BODY, MOUNTS).real, BODY.centre)
    assert centre == pytest.approx([0, 0, -DROP], abs=1e-15)

"""Three-mount powertrain (SAIPA Quick): energy shares and torque roll axis, from hojjatkarami/NVHteam
(SavedResults/file1_res.mat, KEF_cal.m, TRA_finder.m).

Its crankshaft lies along y; the hydraulic part of mount 1 adds 1e5 N/m along its third axis. All
stored figures are right; `tests/published` has the natural frequencies.
"""

import numpy as np
import pytest

from balcli.mounting.rigid_body import Body, Mounts, find_body_modes, roll_axis, share_energy, turn_axes

BODY = Body(163.9, np.zeros(3), np.array([[9.91, -0.813, -0.472], [-0.813, 4.12, 1.34], [-0.472, 1.34, 9.09]]))
NONE = np.zeros((3, 3))
MOUNTS = Mounts(
    np.array([[-0.066446, 0.463093, 0.1561], [-0.00359, -0.455997, 0.100907], [0.250721, -0.044715, -0.200543]]),
    np.array([turn_axes(0, 0, np.pi / 2), np.eye(3), turn_axes(0, np.radians(-10), 0)]),
    np.array([[349.5e3, 370.5e3, 553e3], [141e3, 57e3, 367.5e3], [640.5e3, 450e3, 225e3]]),
    NONE,
    NONE,
)
COLUMNS = [5, 4, 3, 0, 1, 2]  # of the stored energies: modes by rising frequency
STORED_PERCENT = """
0.4181211281226241 0.07973621637816433 34.70942308662941 29.71370270305016 17.613709759464005 17.46530710635544
0.022112271356765013 1.3840616623216808 2.2147506823148895 27.501222259505997 68.40324501719415 0.474608107306522
0.037044953563965796 1.0808843517748077 12.27066693747295 2.16760566864558 4.680075923307384 79.76372216523563
49.9235940751269 37.21827420610421 6.802197063869025 2.4709896068250985 1.9157750092352561 1.6691700388395982
39.98308465872512 11.734043849814546 22.356794731736557 18.6937606382562 6.611387036057524 0.6209290854099526
9.616042913104621 48.502999713606584 21.646167497977164 19.452719123716953 0.775807254741677 0.006263496852868388
"""


def figures(text):
    return np.array(text.split(), float)


def test_energy_shares_as_stored():
    """Rows are the motions x, y, z, rx, ry, rz, columns the modes in an order of the file's own."""
    percent = 100 * share_energy(find_body_modes(BODY, MOUNTS), BODY)
    stored = figures(STORED_PERCENT).reshape(6, 6)
    assert pytest.approx(stored, rel=1e-9) == percent[COLUMNS].T


def test_torque_roll_axis():
    assert roll_axis(BODY, [0, 1, 0]) == pytest.approx([0.07423512013, 0.9871275941, -0.1416624862], rel=1e-9)

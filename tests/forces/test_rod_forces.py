"""Gas on each piston of an engine whose cylinders are in part equal."""

import numpy as np
from support.engines import build_text
from support.gas_engines import WIEBE
from support.paths import ENGINES

from balcli.forces.rod_forces import compute_rod_forces

DEGREES = np.linspace(0.0, 720.0, 97)


def test_each_cylinder_has_its_own_pressure_at_its_own_time():
    """With a master rod the mechanisms differ; in cylinder 4 the gas presses by half."""
    text = (ENGINES / "radial7_articulated.toml").read_text(encoding="utf-8")
    found = build_text(f"{text}\n{WIEBE}\n[cylinder.4]\ngas = 0.5\n")
    forces = compute_rod_forces(found, DEGREES)
    assert len(found.gas.group_equal()) > 1
    for row, cylinder in enumerate(found.gas.cylinders):
        at = np.radians(DEGREES) - cylinder.fires
        np.testing.assert_allclose(forces.pressure[row], cylinder.torque.pressure.at(at), rtol=1e-14)
        gas = cylinder.share * cylinder.torque.force_under(cylinder.torque.pressure.at(at))
        np.testing.assert_allclose(forces.gas[row], gas, rtol=1e-13, atol=1e-9)

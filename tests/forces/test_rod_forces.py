"""Gas on each piston of an engine whose cylinders are in part equal."""

import numpy as np
import pytest
from support.engines import GOOD, build_text
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


@pytest.mark.parametrize(
    ("apart", "whole"),
    [
        ("[crosshead]\nmass = 2\n", "[cylinder.2]\npiston_mass = 2.5\n"),
        ("[cylinder.2]\ncrosshead_mass = 2\n", "[cylinder.2]\npiston_mass = 2.5\n"),
        ("[crosshead]\nmass = 5\n[cylinder.2]\ncrosshead_mass = 2\n", "[cylinder.2]\npiston_mass = 2.5\n"),
        ("[cylinder.2]\npiston_mass = 0.7\ncrosshead_mass = 2\n", "[cylinder.2]\npiston_mass = 2.7\n"),
    ],
)
def test_a_crosshead_presses_on_the_rod_as_part_of_the_piston(apart, whole):
    """Piston and crosshead weighed apart load the rod of cylinder 2 as one piston with both masses."""
    forces = [compute_rod_forces(build_text(f"{GOOD}\n{WIEBE}\n{tables}"), DEGREES) for tables in (apart, whole)]
    for name in ("thrust", "rod", "pin"):
        with_crosshead, in_one_piece = (getattr(each, name)[1] for each in forces)
        np.testing.assert_allclose(with_crosshead, in_one_piece, rtol=1e-12, atol=1e-8)
